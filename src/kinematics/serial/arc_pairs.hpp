/// Pairs of pieces, one of the first and one of the last arc's curve: whether the middle arc can join them.
/// Theory: docs/theory/three_arcs.md
#pragma once
#include "kinematics/serial/chord_curve.hpp"
#include "kinematics/serial/three_arcs.hpp"
#include "sinew/math/se3.hpp"

namespace sinew::inline v1 {
namespace detail {

/// A robot of total length 1 and the pose its tip is to take.
struct ThreeArcPose {
  std::array<double, 3> lengths;
  double limit;
  SE3<double> tip;

  /// What the first bend satisfies, and what the last.
  ChordCurve first_curve() const;
  ChordCurve last_curve() const;
  double lowest_cosine() const;  ///< of half the tilt of an arc bent to the limit
  /// Both hold for every bend: a continuum of bends reaches the pose wherever any do.
  bool has_free_circle() const;
};

/// A joint guess of the two outer bends. `sign` ±1 tells which of the tip's two quaternions the three arcs
/// make up.
struct OuterBends {
  Vec2<double> first, last;
  int sign;
};

enum class Verdict {
  empty,  ///< no solution in this pair
  open,
  single  ///< not more than one solution in the pair doubled about its middle
};

/// A vector and its derivatives by the four coordinates of a pair.
template <int N>
struct Fourfold {
  Vec<double, N> at;
  std::array<Vec<double, N>, 4> rate;
};

/// What is the same for both signs.
struct PairBounds {
  Vec3<double> gap;  ///< what the middle chord lacks: first chord + last chord − tip
  double twist;      ///< the middle arc's twist, zero for a solution
  std::array<double, 4> twist_rate;
  /// Quaternion [x, u] of the middle arc in base axes up to sign: x is the cosine of its half tilt, u the
  /// direction of its chord.
  Fourfold<4> middle;
  double second_order;  ///< of any component of a product of the outer unit vectors
  bool is_empty = false;
  bool is_too_large = false;  ///< for bounds to tell anything more
};
PairBounds pair_bounds(const ThreeArcPose& pose, const Piece& first, const Piece& last);

/// With `single`, where Newton's first step leads.
struct PairAnswer {
  Verdict verdict;
  OuterBends guess;
};
PairAnswer classify_pair(const ThreeArcPose& pose, const Piece& first, const Piece& last,
                         const PairBounds& bounds, int sign);

/// The middle bend that turns the end of the first arc into the start of the last one.
Vec2<double> middle_bend(const ThreeArcPose& pose, const OuterBends& outer);

}  // namespace detail
}  // namespace sinew::inline v1
