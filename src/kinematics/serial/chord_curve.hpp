/// The curve on which the bend of an outer arc must lie, and its pieces. Theory: docs/theory/three_arcs.md
#pragma once
#include <array>
#include <vector>

#include "sinew/math/entire.hpp"
#include "sinew/math/se3.hpp"

namespace sinew::inline v1 {
namespace detail {

/// A vector and its derivatives by two coordinates.
template <int N>
struct Moving {
  Vec<double, N> at;
  std::array<Vec<double, N>, 2> rate;

  template <class Map>
  auto mapped(const Map& map) const {
    constexpr int rows = Map::RowsAtCompileTime;
    return Moving<rows>{map * at, {Vec<double, rows>(map * rate[0]), Vec<double, rows>(map * rate[1])}};
  }
};

/// Direction n of an arc's chord and its sinc factor s by the bend: the chord is L s n.
struct ChordOfBend {
  Moving<3> direction;
  Moving<1> factor;
};
ChordOfBend chord_of(const Vec2<double>& bend);

/// Second derivatives of n and s along two directions.
struct ChordBend {
  Vec3<double> direction;
  double factor;
};
ChordBend chord_bend(const Vec2<double>& bend, const Vec2<double>& d, const Vec2<double>& e);

/// A rectangle of bends. What a search reads of it is written by `ChordCurve::piece`.
struct Piece {
  Vec2<double> middle, along;  ///< along: unit; the second axis is a quarter turn ahead of it
  std::array<double, 2> half;  ///< half lengths along both axes
  double radius;               ///< half the diagonal

  Moving<3> direction, chord;  ///< in the robot's base axes, by the rectangle's axes
  Moving<4> turned_z, turned;  ///< of the first arc, quaternions [w, x, y, z]: q k u and q u
  double travel;               ///< how far the direction gets from that in the middle
  double bulge, chord_bulge;   ///< what direction and chord do beyond first order
  int first_part = not_split, second_part = nothing;

  static constexpr int nothing = -1, not_split = -2;

  Vec2<double> across() const { return {-along[1], along[0]}; }
  Vec2<double> point(double a, double b) const { return middle + a * along + b * across(); }
};

enum class Laid { outside, narrower, as_it_was };

/// Bends b, |b| ≤ limit, with  f(b) = slope·n(b) − pull·s(b) = 0.
struct ChordCurve {
  double length, limit;
  Vec3<double> slope;
  double pull;
  Mat<double, 3, 3> axes;  ///< takes n into the robot's base axes
  SO3<double> turn;        ///< of the robot's tip

  /// The rectangle's part that may hold the curve, as a smaller rectangle; false: none.
  bool trim(Piece& piece) const;
  /// Fills in what a search reads.
  void fill(Piece& piece) const;

 private:
  /// Bound on what f does beyond first order within a radius of this point.
  double bulge(const Vec2<double>& bend, double radius) const;
  void fill_bulges(Piece& piece, const ChordOfBend& chord) const;
  Laid lay_along_curve(Piece& piece, double margin) const;
};

/// Pieces made on demand, each split in two: the curve never lies outside the pieces of one level.
class PieceTree {
 public:
  explicit PieceTree(const ChordCurve& curve);

  const Piece& operator[](int i) const { return pieces_[static_cast<std::size_t>(i)]; }
  std::size_t size() const { return pieces_.size(); }
  /// The two parts, `Piece::nothing` where there is no curve.
  std::array<int, 2> parts(int i);

 private:
  int add(Piece piece);

  ChordCurve curve_;
  std::vector<Piece> pieces_;
};

}  // namespace detail
}  // namespace sinew::inline v1
