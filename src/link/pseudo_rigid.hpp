/// @file pseudo_rigid.hpp
/// Pseudo-rigid-body link in its bending plane: equal rigid links on torsion springs, with two tendons. Base
/// at the origin, first link along +y where the base is pinned, base tangent along +y where it is clamped;
/// joint angles are counter-clockwise, so a positive curvature (bends towards +x) has negative ones. No heap.
/// Theory: docs/theory/pseudo_rigid.md
#pragma once
#include <algorithm>
#include <array>
#include <span>

#include "base/assert.hpp"
#include "base/limits.hpp"
#include "sinew/link/state.hpp"
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// A joint without a spring at the base: the first link turns freely, and the chain's frame with it.
enum class ChainBase { pinned, clamped };

/// What a tendon's length loses or gains at one joint, with its derivatives by that joint's angle.
template <Scalar S>
struct TendonBend {
  S change;     ///< of the length, against the straight chain [m]
  S rate;       ///< [m/rad]
  S curvature;  ///< second derivative [m/rad²]
};

template <Scalar S>
struct ChainTip {
  Vec2<S> position;                            ///< u [m]
  std::array<Vec2<S>, max_chain_joints> rate;  ///< ∂u/∂θⱼ [m/rad]
  S turn_of_tip;                               ///< direction of the last link against +y [rad]

  /// ∂²u/∂θⱼ∂θₖ [m/rad²]: the joint nearer to the tip turns what the other one moved.
  Vec2<S> rate_rate(int j, int k) const {
    const Vec2<S>& outer = rate[static_cast<std::size_t>(std::max(j, k))];
    return {-outer[1], outer[0]};
  }
};

struct PseudoRigid {
  double length = 0;  ///< backbone length ℓ [m], > 0
  int links = 6;      ///< 1 to `max_chain_joints`; of a pinned base at least 2
  ChainBase base = ChainBase::pinned;
  PrbDiscretisation model = PrbDiscretisation::weighted;

  /// Sprung joints: between links, and where the base is clamped at the base too.
  int joints() const { return base == ChainBase::pinned ? links - 1 : links; }
  double link_length() const { return length / links; }  ///< ℓ_s [m]

  /// Tip and its derivatives by the angles of the sprung joints.  @implements TDPCR (33)
  template <Scalar S>
  ChainTip<S> tip(std::span<const S> angles) const {
    using std::cos, std::sin;
    SINEW_EXPECTS(static_cast<int>(angles.size()) == joints());
    const S step(link_length());
    ChainTip<S> tip{};
    Vec2<S> end(S(0), base == ChainBase::pinned ? step : S(0));
    S turn(0);
    for (std::size_t j = 0; j < angles.size(); ++j) {
      tip.rate[j] = end;  // where the joint is, for now
      turn += angles[j];
      end += step * Vec2<S>(-sin(turn), cos(turn));
    }
    for (std::size_t j = 0; j < angles.size(); ++j) {
      const Vec2<S> arm = end - tip.rate[j];
      tip.rate[j] = {-arm[1], arm[0]};
    }
    tip.position = end;
    tip.turn_of_tip = turn;
    return tip;
  }

  /// Stiffness of a joint as a multiple of EI/ℓ_s.
  double spring(int joint) const {
    if (model != PrbDiscretisation::weighted) return 1;
    if (is_first(joint) && base == ChainBase::clamped) return 2;  // of half a link's length
    return turn_weight(joint);
  }

  /// How much of the backbone's turn goes with a joint's: what ends bend by beyond the outermost joints is
  /// half as much again; the only joint of two links has both ends.
  double turn_weight(int joint) const {
    const double first = is_first(joint) && base == ChainBase::pinned ? free_end() : 0;
    return 1 + first + (joint == joints() - 1 ? free_end() : 0);
  }

  /// Turn of the backbone from end to end, counter-clockwise [rad].
  template <Scalar S>
  S turn(std::span<const S> angles) const {
    S sum(0);
    for (std::size_t j = 0; j < angles.size(); ++j) sum += S(turn_weight(static_cast<int>(j))) * angles[j];
    return sum;
  }

  /// By how much of that the first link is turned from the backbone's base, and its tip from the last link.
  template <Scalar S>
  std::array<S, 2> end_turns(std::span<const S> angles) const {
    const double first = base == ChainBase::clamped ? 1 : free_end();
    return {S(first) * angles.front(), S(free_end()) * angles.back()};
  }

  /// Of tendon 1 where `side` is 1, of tendon 2 where it is −1: on the side of +x and of −x.
  /// @param offset d of the tendon from the backbone [m]
  template <Scalar S>
  TendonBend<S> tendon_bend(int joint, const S& angle, double offset, int side) const {
    using std::cos, std::sin, std::sqrt;
    const double d = side * offset, h = 0.5 * link_length();
    if (model != PrbDiscretisation::discs) {
      const S arm(d * turn_weight(joint));
      return {arm * angle, arm, S(0)};
    }
    if (is_first(joint) && base == ChainBase::clamped) {
      // from a hole beside the base joint to one on the first link: (d, 0) and R (d, h)
      const S along = S(2 * d * d) * (S(1) - cos(angle)) + S(2 * d * h) * sin(angle) + S(h * h);
      const S along_rate = S(2 * d * d) * sin(angle) + S(2 * d * h) * cos(angle);
      const S along_curvature = S(2 * d * d) * cos(angle) - S(2 * d * h) * sin(angle);
      const S span = sqrt(along), rate = along_rate / (S(2) * span);
      return {span - S(h), rate, (S(0.5) * along_curvature - rate * rate) / span};
    }
    const S half = S(0.5) * angle, c = cos(half), s = sin(half), quarter = sin(S(0.25) * angle);
    return {S(2 * d) * s - S(4 * h) * quarter * quarter, S(d) * c - S(h) * s,
            -S(0.5 * d) * s - S(0.5 * h) * c};
  }

  /// Length of a tendon [m].
  template <Scalar S>
  S tendon_length(std::span<const S> angles, double offset, int side) const {
    S sum(length);
    for (std::size_t j = 0; j < angles.size(); ++j)
      sum += tendon_bend(static_cast<int>(j), angles[j], offset, side).change;
    return sum;
  }

 private:
  static bool is_first(int joint) { return joint == 0; }
  /// What a free end bends by beyond its joint, of that joint's angle: half a link's turn.
  double free_end() const { return model == PrbDiscretisation::weighted ? 0.5 : 0; }
};

}  // namespace sinew::inline v1
