/// The stiffness of the platform on its legs, S = Σ (K + Xᵀ D⁻¹ X), and the step of the platform with it:
/// what any group of limbs does.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <algorithm>

#include "base/at.hpp"

namespace sinew::inline v1 {

/// Of what a leg needs of the platform's wrench, by the platform's twist, its own forces being constant.
Mat<double, 6, 6> ArmGroup::curvature(const Leg& leg) const {
  Mat<double, 6, 6> change = Mat<double, 6, 6>::Zero();
  const Vec3<double> b = platform_.rotate(leg.own->platform_point);
  change.bottomRightCorner<3, 3>() =
      skew<double>(leg.force) * skew<double>(b) - 0.5 * skew<double>(moment_of(leg));
  return change;
}

Mat<double, 6, 6> ArmGroup::following_curvature() const {
  const Wrench wrench = turning_wrench();
  Mat<double, 6, 6> change = Mat<double, 6, 6>::Zero();
  change.topRightCorner<3, 3>() = skew<double>(wrench.head<3>());
  change.bottomRightCorner<3, 3>() = skew<double>(wrench.tail<3>());
  return change;
}

void ArmGroup::constrain_to_plane(Eigen::Ref<Matrix> by_twist, const std::array<double, 2>& units) const {
  if (!robot_->is_planar) return;
  const Eigen::Index first = by_twist.rows() - 6;
  for (const int i : {2, 3, 4}) {
    by_twist.row(first + i).setZero();
    by_twist.col(first + i).setZero();
    by_twist(first + i, first + i) = units[i == 2 ? 0 : 1];
  }
}

bool ArmGroup::linearise() {
  if (!factor_limbs()) return false;
  stiffness_ = following_curvature();
  residual_ = balance_;
  double across = 0, around = 0;
  for (Leg& leg : legs_) {
    const double length = leg.own->arm.length();
    if (!factor_compliance(leg)) return false;
    stiffness_ += curvature(leg) + leg.X.transpose() * leg.D_inverse * leg.X;
    residual_ -= leg.X.transpose() * (leg.D_inverse * leg.r);
    across = std::max(across, force_unit(leg) / length);
    around = std::max(around, rod(leg).model().energy_scale);
  }
  constrain_to_plane(stiffness_, {across, around});
  keep_in_plane(residual_);
  return lu_.factor(stiffness_.data(), radius_);
}

auto ArmGroup::step(bool fresh) -> Twist {
  Twist twist = Twist::Constant(not_a_number);
  if (!fresh && !linearise()) return twist;
  lu_.solve(residual_.data(), twist.data());
  return twist;
}

void ArmGroup::move(const Twist& twist, Numbers by_input) {
  const Frame after = platform_.displaced(twist);
  for (Leg& leg : legs_) {
    Vector side = leg.r + leg.X * twist;
    Numbers own;
    if (!by_input.empty()) {
      own = Numbers(by_input.subspan(at(leg.first_feed), leg.tendons.size()));
      for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
        const Tendon& tendon = leg.tendons[i];
        if (tendon.is_taut)
          side[tendon.place] -= own[i];
        else if (tendon.command.held == TendonHeld::tension)
          side -= leg.B * leg.HL.col(tendon.place) * own[i];
      }
    }
    leg.du = leg.D_inverse * side;
    advance(leg, after, own);
  }
  platform_ = after;
}

auto ArmGroup::input_wrench_jacobian(int input) const -> Wrench {
  const auto [leg, tendon] = find(input);
  if (tendon->is_taut) return -leg->X.transpose() * leg->D_inverse.col(tendon->place);
  if (tendon->command.held != TendonHeld::tension) return Wrench::Zero();  // a slack tendon does nothing
  return -leg->X.transpose() * (leg->D_inverse * (leg->B * leg->HL.col(tendon->place)));
}

double ArmGroup::closing_effort(int feed) const {
  const auto [leg, tendon] = find(feed);
  return tendon->tension + (tendon->is_taut ? leg->D_inverse.row(tendon->place).dot(leg->r) : 0);
}
auto ArmGroup::effort_jacobian(int feed) const -> Twist {
  const auto [leg, tendon] = find(feed);
  if (!tendon->is_taut) return Twist::Zero();
  return (leg->D_inverse.row(tendon->place) * leg->X).transpose();
}

}  // namespace sinew::inline v1
