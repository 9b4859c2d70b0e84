/// @file tip_gaps.hpp
/// What the end of a rod misses of where it is held, dimensionless, and its derivatives: position over the
/// length; of a ball the moment in EI/L, of a clamp the turn, of a tangent two parts of the turn and the
/// torque. Theory: docs/theory/spatial_rod.md
#pragma once
#include "shooting_rod/rod_bvp.hpp"

namespace sinew::inline v1 {

struct TipGaps {
  RodEnds::Tip kind;
  SE3<double> tip;  ///< where it is held; its third axis is the tangent
  double length, moment_unit;
  Vec3<double> moment = Vec3<double>::Zero();  ///< wanted of a ball, in EI/L

  Vec<double, 6> gap(const RodState<double>& at) const {
    Vec<double, 6> out;
    out.head<3>() = (at.p - tip.p) / length;
    if (kind == RodEnds::Tip::ball) {
      out.tail<3>() = at.m / moment_unit - moment;
    } else if (kind == RodEnds::Tip::clamp) {
      out.tail<3>() = turn(at);
    } else {  // 2 tan(angle/2): zero at the wanted direction, but not at its opposite
      const Mat<double, 3, 3> axes = tip.R.matrix();
      const Vec3<double> t = at.tangent();
      const double cosine = 1 + dot(t, axes.col(2));
      out[3] = 2 * dot(t, axes.col(0)) / cosine;
      out[4] = 2 * dot(t, axes.col(1)) / cosine;
      out[5] = dot(at.m, axes.col(2)) / moment_unit;
    }
    return out;
  }

  /// Its derivative from that of the section there, rows of RodTangent.
  template <int columns>
  Mat<double, 6, columns> rows(const RodState<double>& at, const Mat<double, 12, columns>& rate) const {
    Mat<double, 6, columns> out;
    const auto turned = rate.template middleRows<3>(RodTangent::rotation);
    const auto moved = rate.template middleRows<3>(RodTangent::tip_moment);
    out.template topRows<3>() = rate.template middleRows<3>(RodTangent::position) / length;
    if (kind == RodEnds::Tip::ball) {
      out.template bottomRows<3>() = moved / moment_unit;
    } else if (kind == RodEnds::Tip::clamp) {
      out.template bottomRows<3>() = SO3<double>::left_jacobian_inverse(turn(at)) * turned;
    } else {
      const Mat<double, 3, 3> axes = tip.R.matrix();
      const Vec3<double> t = at.tangent();
      const double cosine = 1 + dot(t, axes.col(2));
      for (int i = 0; i < 2; ++i) {
        const Vec3<double> lever =
            (axes.col(i) - axes.col(2) * (dot(t, axes.col(i)) / cosine)) * (2 / cosine);
        out.row(3 + i) = cross(t, lever).transpose() * turned;
      }
      out.row(5) = axes.col(2).transpose() * moved / moment_unit;
    }
    return out;
  }

  /// Its derivative by a motion of `tip` (translation, rotation vector) where there is no gap.
  Mat<double, 6, 6> by_tip(const RodState<double>& at) const {
    Mat<double, 6, 6> out = Mat<double, 6, 6>::Zero();
    out.topLeftCorner<3, 3>() = -Mat<double, 3, 3>::Identity() / length;
    if (kind == RodEnds::Tip::clamp) out.bottomRightCorner<3, 3>() = -Mat<double, 3, 3>::Identity();
    if (kind == RodEnds::Tip::tangent) {
      const Mat<double, 3, 3> axes = tip.R.matrix();
      const Vec3<double> t = axes.col(2);
      for (int i = 0; i < 2; ++i) out.block<1, 3>(3 + i, 3) = cross(Vec3<double>(axes.col(i)), t).transpose();
      out.block<1, 3>(5, 3) = cross(t, at.m).transpose() / moment_unit;
    }
    return out;
  }

 private:
  Vec3<double> turn(const RodState<double>& at) const { return at.R.compose(tip.R.inverse()).log(); }
};

}  // namespace sinew::inline v1
