/// @file hinged_lanes-inl.hpp
/// Three struts on hinges at carriages on rails (3PRS), in lanes. Included once for each instruction set, as
/// lanes-inl.hpp. Theory: docs/theory/tripod_rigid.md
#if defined(SINEW_ANALYSIS_HINGED_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_ANALYSIS_HINGED_LANES_INL
#undef SINEW_ANALYSIS_HINGED_LANES_INL
#else
#define SINEW_ANALYSIS_HINGED_LANES_INL
#endif

#include <numbers>

#include "analysis/pose_lanes-inl.hpp"
#include "leg/hinged_strut.hpp"
#include "sinew/units.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::velocity_lanes {
namespace HWY_NAMESPACE {

HWY_INLINE Pack along(const std::array<double, 3>& axis, const Pack* x) {
  return plus(plus(all(axis[0]) * x[0], all(axis[1]), x[1]), all(axis[2]), x[2]);
}

/// Poses whose height, e₁ and e₂ are given, by Newton's method as in constrained_pose.cpp. A lane stops with
/// the step that follows a small residual, whatever its neighbours need.
class Constrained {
 public:
  HWY_INLINE Constrained(const HingedRobot& robot, const Place& place, OperationMode mode)
      : robot_(robot),
        e1_(place.load(1)),
        e2_(place.load(2)),
        share_(),
        at_{all(0), all(0), all(mode == OperationMode::tilt ? 0 : std::numbers::pi / 2)},
        z_(place.load(0)) {
    const Pack rest = minus(minus(all(1), e1_, e1_), e2_, e2_);
    is_fit_ = hn::And(hn::Gt(rest, all(rim_margin)), hn::Lt(hn::Abs(z_), all(Range::place().high)));
    share_ = hn::Sqrt(rest);
  }

  HWY_INLINE Turn3 solve() {
    constexpr int max_steps = 8;
    Mask is_open = is_fit_;
    for (int step = 0; step < max_steps && !hn::AllFalse(tag, is_open); ++step) is_open = move(is_open);
    Turn3 pose = here();
    pose.is_fit = hn::AndNot(is_open, is_fit_);
    return pose;
  }

 private:
  HWY_INLINE Turn3 here() const {
    Turn3 pose;
    pose.p[0] = at_[0], pose.p[1] = at_[1], pose.p[2] = z_;
    pose.w = share_ * hn::Cos(tag, at_[2]);
    pose.v[0] = e1_, pose.v[1] = e2_, pose.v[2] = share_ * hn::Sin(tag, at_[2]);
    return pose;
  }

  /// One step; the lanes that need another. Those that stray are left out of `is_fit_`.
  HWY_INLINE Mask move(Mask is_open) {
    const Turn3 pose = here();
    Pack rows[3][3], residual[3], most = all(0);
    for (std::size_t i = 0; i < 3; ++i) {
      const HingedLeg& leg = robot_.legs[i];
      Point<3> b, r;
      pose.reach(leg, b, r);
      residual[i] = along(leg.hinge, r.at);
      most = hn::Max(most, hn::Abs(residual[i]));
      rows[i][0] = all(leg.hinge[0]), rows[i][1] = all(leg.hinge[1]);
      rows[i][2] = turning(pose, leg);
    }
    const Pack scale = all(1) / determinant(rows);
    for (std::size_t c = 0; c < 3; ++c) {  // Cramer's rule
      Pack replaced[3][3];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) replaced[i][j] = j == c ? residual[i] : rows[i][j];
      const Pack step = determinant(replaced) * scale;
      // beyond it the steps of constrained_pose are shortened, and may lead elsewhere; false for NaN
      if (c == 2) is_fit_ = hn::And(is_fit_, hn::Or(hn::Not(is_open), hn::Lt(hn::Abs(step), all(0.4))));
      at_[c] = hn::IfThenElse(is_open, at_[c] - step, at_[c]);
    }
    return hn::And(hn::And(is_open, is_fit_), hn::Gt(most, all(1e-9 * robot_.size)));
  }

  /// e·∂(R b)/∂ψ, the angle by which e₀ and e₃ share what e₁ and e₂ leave: R b = b + 2w v×b + 2v×(v×b).
  static HWY_INLINE Pack turning(const Turn3& pose, const HingedLeg& leg) {
    const Pack point[3] = {all(leg.point[0]), all(leg.point[1]), all(leg.point[2])};
    const Pack spin[3] = {hn::Neg(point[1]), point[0], all(0)};  // k×b
    Pack side[3];                                                // v×b
    cross(pose.v, point, side);
    Pack twice[3];  // v×(k×b)
    cross(pose.v, spin, twice);
    const Pack upright[3] = {hn::Neg(side[1]), side[0], all(0)};  // k×(v×b)
    Pack rate[3];                                                 // with w′ = −v₃, v′ = w k
    for (std::size_t i = 0; i < 3; ++i)
      rate[i] = all(2) * (minus(pose.w * (pose.w * spin[i] + upright[i] + twice[i]), pose.v[2], side[i]));
    return along(leg.hinge, rate);
  }

  static HWY_INLINE void cross(const Pack* a, const Pack* b, Pack* out) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      out[i] = minus(a[j] * b[k], a[k], b[j]);
    }
  }

  const HingedRobot& robot_;
  Pack e1_, e2_, share_;  ///< √(1 − e₁² − e₂²)
  Pack at_[3];            ///< x, y, ψ
  Pack z_;
  Mask is_fit_;
};

class HingedLegs {
 public:
  using Robot = HingedRobot;
  static constexpr std::size_t D = 3, N = 6, inputs = 3;

  HWY_INLINE HingedLegs(const HingedRobot& robot, const VelocityBatch& out, const Place& place)
      : robot_(robot),
        out_(out),
        place_(place) {}

  HWY_INLINE Certain solve(Rows<N>& rows) const {
    const auto mode = place_.part->independent;
    const Turn3 pose = mode ? Constrained(robot_, place_, *mode).solve() : Turn3(place_);
    Certain certain{pose.is_fit, hn::Not(hn::FirstN(tag, hn::Lanes(tag)))};
    Pack slide[3], open = all(0);
    for (std::size_t i = 0; i < 3; ++i) slide[i] = solve_leg(i, pose, rows, certain, open);
    certain.unreachable = hn::And(certain.unreachable, pose.is_fit);
    for (std::size_t i = 0; i < 3 && !out_.inputs.empty(); ++i)
      place_.store(slide[i], certain.unreachable, out_.inputs, i);
    if (!out_.residual.empty()) place_.store(open, certain.unreachable, out_.residual);
    if (mode && !out_.poses.empty()) put(pose);
    return certain;
  }

 private:
  /// The slide; the row of its strut, and that of its plane, which stands with the other planes' behind.
  /// @param open largest of the closure errors of this leg and those before [m]
  HWY_INLINE Pack solve_leg(std::size_t i, const Turn3& pose, Rows<N>& rows, Certain& certain,
                            Pack& open) const {
    const HingedLeg& leg = robot_.legs[i];
    Point<3> b, r;
    pose.reach(leg, b, r);
    const Pack beside = along(leg.hinge, r.at), ahead = along(leg.rail, r.at), off = along(leg.across, r.at);
    const Pack square = plus(beside * beside, off, off), length = all(leg.strut);
    const Pack distance = hn::Sqrt(square);
    const Pack rise = hn::Sqrt(hn::Max((length - distance) * (length + distance), all(0))) * all(leg.elbow);
    narrow_certainty(leg, beside, distance, ahead, certain);
    for (std::size_t k = 0; k < D; ++k) {
      const Pack in_plane = plus(all(leg.hinge[k]) * beside, all(leg.across[k]), off);
      rows.line[i][k] = plus(in_plane, all(leg.rail[k]), rise) * all(1 / leg.strut);
      rows.line[i + 3][k] = all(leg.hinge[k]);
    }
    rows.size[i] = length, rows.size[i + 3] = all(1);
    rows.drive[i] = rise * all(1 / leg.strut), rows.drive[i + 3] = all(0);
    for (const std::size_t row : {i, i + 3}) {
      moment(b, rows.line[row], rows.line[row] + D);
      for (std::size_t k = D; k < N; ++k) rows.line[row][k] = rows.line[row][k] * all(1 / robot_.radius);
    }
    const Pack slide = ahead - rise, left = ahead - slide;
    if (!out_.residual.empty()) {
      const Pack miss = hn::Sqrt(plus(square, left, left)) - length;
      open = hn::Max(open, hn::Sqrt(plus(beside * beside, miss, miss)));
    }
    return slide;
  }

  /// A platform point that is for certain in the plane of its hinge, or beside it; a strut that is longer
  /// than it must be, by so much that it is not square to its rail, or shorter.
  static HWY_INLINE void narrow_certainty(const HingedLeg& leg, Pack beside, Pack distance, Pack ahead,
                                          Certain& certain) {
    constexpr double tolerance = HingedStrut::plane_tolerance;
    const Pack away = hn::Abs(beside);
    const Mask in_plane = hn::Lt(away, all(leg.strut * tolerance / plane_margin));
    const Mask outside = hn::Gt(away, all(leg.strut * tolerance * plane_margin));
    const Mask shorter = hn::Lt(distance, all(leg.strut * (1 - square_margin)));
    const Mask longer = hn::Gt(distance, all(leg.strut * (1 + square_margin)));
    const Mask near = hn::Lt(hn::Abs(ahead), all(far_margin * leg.strut));
    certain.reached = hn::And(certain.reached, hn::And(hn::And(in_plane, shorter), near));
    certain.unreachable = hn::Or(certain.unreachable, hn::Or(outside, longer));
  }

  /// A pose that was found stays one where a strut does not reach.
  HWY_INLINE void put(const Turn3& pose) const {
    for (std::size_t k = 0; k < 3; ++k) {
      place_.store(pose.p[k], out_.poses, k);
      place_.store(pose.v[k], out_.poses, 4 + k);
    }
    place_.store(pose.w, out_.poses, 3);
  }

  const HingedRobot& robot_;
  const VelocityBatch& out_;
  const Place& place_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::velocity_lanes
HWY_AFTER_NAMESPACE();
#endif
