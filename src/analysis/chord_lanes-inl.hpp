/// @file chord_lanes-inl.hpp
/// Legs that are arcs between free joints, in lanes. In the plane D = 2 and N = 3, in space 3 and 6. Included
/// once for each instruction set, as lanes-inl.hpp.
#if defined(SINEW_ANALYSIS_CHORD_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_ANALYSIS_CHORD_LANES_INL
#undef SINEW_ANALYSIS_CHORD_LANES_INL
#else
#define SINEW_ANALYSIS_CHORD_LANES_INL
#endif

#include "analysis/pose_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::velocity_lanes {
namespace HWY_NAMESPACE {

template <std::size_t Dimension, std::size_t Freedoms>
class ChordLegs {
 public:
  using Robot = ChordRobot;
  static constexpr std::size_t D = Dimension, N = Freedoms, inputs = N;

  HWY_INLINE ChordLegs(const ChordRobot& robot, const VelocityBatch& out, const Place& place)
      : robot_(robot),
        out_(out),
        place_(place) {}

  HWY_INLINE Certain solve(Rows<N>& rows) const {
    using Turn = std::conditional_t<D == 2, Turn2, Turn3>;
    const Turn turn(place_);
    Certain certain{turn.is_fit, hn::Not(hn::FirstN(tag, hn::Lanes(tag)))};
    Pack curvature[N], open = all(0);
    for (std::size_t i = 0; i < N; ++i) {
      const ChordLeg& leg = robot_.legs[i];
      Point<D> b, r;
      turn.reach(leg, b, r);
      rows.size[i] = hn::Sqrt(dot<D>(r.at, r.at));
      const Pack loss = minus(all(1), rows.size[i], all(1 / leg.length));
      const Pack bend = inverse_sinc_of_loss(hn::Min(hn::Max(loss, all(straight_margin)), all(1)));
      const Pack size = bend * all(2 / leg.length);
      narrow_certainty(leg, loss, size, certain);
      curvature[i] = size * all(leg.bending);
      if (!out_.residual.empty()) open = hn::Max(open, gap(leg, bend, rows.size[i]));
      const Pack rate = bend * sinc_slope_of_square(bend * bend);  // −sinc′
      rows.drive[i] = rate * all(leg.bending * 0.5 * leg.length / leg.offset);
      const Pack scale = all(1) / rows.size[i];
      for (std::size_t k = 0; k < D; ++k) rows.line[i][k] = r.at[k] * scale;
      moment(b, rows.line[i], rows.line[i] + D);
      for (std::size_t k = D; k < N; ++k) rows.line[i][k] = rows.line[i][k] * all(1 / robot_.radius);
    }
    certain.unreachable = hn::And(certain.unreachable, turn.is_fit);
    for (std::size_t i = 0; i < N; ++i) put(i, curvature[i], certain.unreachable);
    if (!out_.residual.empty()) place_.store(open, certain.unreachable, out_.residual);
    return certain;
  }

 private:
  /// By how much the chord of the bent arc, sin(b)/b of its length, is not the one wanted [m].
  static HWY_INLINE Pack gap(const ChordLeg& leg, Pack bend, Pack wanted) {
    return hn::Abs(minus(wanted, all(leg.length), hn::Sin(tag, bend) / bend));
  }

  /// A chord that is for certain shorter than the backbone, or longer; a curvature that is short of its
  /// domain, or beyond. All comparisons are false for NaN, which makes it doubtful.
  static HWY_INLINE void narrow_certainty(const ChordLeg& leg, Pack loss, Pack curvature, Certain& certain) {
    const Mask shorter = hn::Gt(loss, all(straight_margin));
    const Mask longer = hn::And(hn::Lt(loss, all(-straight_margin)), hn::Gt(loss, all(-1e100)));
    const Mask within = hn::Lt(curvature, all(leg.domain * (1 - domain_margin)));
    const Mask beyond = hn::And(hn::Gt(curvature, all(leg.domain * (1 + domain_margin))), shorter);
    certain.reached = hn::And(certain.reached, hn::And(shorter, within));
    certain.unreachable = hn::Or(certain.unreachable, hn::Or(longer, beyond));
  }

  HWY_INLINE void put(std::size_t i, Pack curvature, Mask unreachable) const {
    const ChordLeg& leg = robot_.legs[i];
    if (!out_.curvatures.empty()) place_.store(curvature, unreachable, out_.curvatures, i);
    if (!out_.inputs.empty())
      place_.store(all(leg.length) * minus(all(1), all(leg.offset), curvature), unreachable, out_.inputs, i);
  }

  const ChordRobot& robot_;
  const VelocityBatch& out_;
  const Place& place_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::velocity_lanes
HWY_AFTER_NAMESPACE();
#endif
