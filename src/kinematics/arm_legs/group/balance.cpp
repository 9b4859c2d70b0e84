/// Residuals of all equations of an equilibrium: of the rods, of the closures between tips and platform, and
/// of the platform's balance.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "solve/contraction.hpp"
#include "strain/rod_frames.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1 {
namespace {

/// Twice the skew part of a matrix, as a vector: of ½ [v] it is v.
Vec3<double> axial(const Mat<double, 3, 3>& m) {
  return {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)};
}

}  // namespace

auto ArmGroup::mount_of(const Leg& leg) const -> Frame {
  return {platform_.point(leg.own->platform_point), platform_.R.compose(leg.own->mount)};
}
Vec3<double> ArmGroup::moment_of(const Leg& leg) const { return mount_of(leg).rotate(leg.moment); }

void ArmGroup::measure_closure(Leg& leg) {
  const Frame mount = mount_of(leg);
  const strain::RodFrame& tip = rod(leg).work().frames.back();
  leg.off.head<3>() = place_of(tip) - mount.p;
  leg.off.tail<3>() = 0.5 * axial(mount.R.matrix().transpose() * turn_of(tip));
  if (!leg.own->is_clamped) leg.off.tail<3>().setZero();
}

bool ArmGroup::clamps_are_aligned() const {
  return std::ranges::all_of(legs_, [&](const Leg& leg) {
    if (!leg.own->is_clamped) return true;
    const Mat<double, 3, 3> turn =
        mount_of(leg).R.matrix().transpose() * turn_of(rod(leg).work().frames.back());
    return turn.trace() > 1;
  });
}

auto ArmGroup::needs(const Leg& leg) const -> Wrench {
  const Vec3<double> b = platform_.rotate(leg.own->platform_point);
  Wrench wrench;
  wrench.head<3>() = leg.force;
  wrench.tail<3>() = cross(b, leg.force) + moment_of(leg);
  keep_in_plane(wrench);
  return wrench;
}
auto ArmGroup::tip_wrench(int limb) const -> Wrench {
  Wrench wrench;
  wrench.head<3>() = legs_[at(limb)].force;
  wrench.tail<3>() = moment_of(legs_[at(limb)]);
  return wrench;
}

double ArmGroup::force_unit(const Leg& leg) const {
  return rod(leg).model().energy_scale / leg.own->arm.length();
}

void ArmGroup::keep_in_plane(Wrench& wrench) const {
  if (robot_->is_planar) wrench.segment<3>(2).setZero();
}

auto ArmGroup::turning_wrench() const -> Wrench {
  const auto& own = loads_.following;
  Wrench wrench;
  wrench.head<3>() = platform_.rotate(Vec3<double>(own[0], own[1], own[2]));
  wrench.tail<3>() = platform_.rotate(Vec3<double>(own[3], own[4], own[5]));
  return share_ * wrench;
}

void ArmGroup::evaluate(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  strain::RodWork& work = rod(leg).work();
  strain::NodeLoad& tip = work.loads.back();
  tip = leg.tip;
  // The moment as dead forces at points of the tip: a potential that is linear in the tip's rotation.
  const Mat<double, 3, 3> couple = 0.5 * mount_of(leg).R.matrix() * skew<double>(leg.moment);
  for (int i = 0; i < 3; ++i) {
    tip.force[i] += leg.force[i];
    for (int j = 0; j < 3; ++j) tip.couple[3 * i + j] += couple(i, j);
  }
  sweep_out(model, work);
  double error = measure_tendons(leg);
  const double size = leg.own->arm.length();
  sweep_back_with_hessian(model, work);
  for (const int pivot : model.pivots) {  // it has no stiffness
    const double y = work.y[at(pivot)];
    work.energy -= 0.5 * y * y;
    work.gradient[at(pivot)] -= y;
  }
  measure_closure(leg);
  const Vec<double, 6> open = leg.off - (1 - share_) * leg.gap;
  error = worse(error, open.head<3>().norm() / size);
  error = worse(error, open.tail<3>().norm());
  double sum = 0;
  for (const double g : work.gradient) sum += g * g;
  limb_error_ = worse(limb_error_, worse(error, std::sqrt(sum / model.energy_scale)));
}

double ArmGroup::evaluate(bool) {
  balance_ = share_ * wrench_ + turning_wrench();
  for (int i = 0; i < 3; ++i) balance_[i] += share_ * robot_->platform_mass * loads_.gravity[at(i)];
  limb_error_ = 0;
  double unit = 0;
  for (Leg& leg : legs_) {
    evaluate(leg);
    balance_ -= needs(leg);
    unit = std::max(unit, force_unit(leg));
  }
  keep_in_plane(balance_);
  const double error = worse(limb_error_, balance_.head<3>().norm() / unit);
  return worse(error, balance_.tail<3>().norm() / (unit * radius_));
}

}  // namespace sinew::inline v1
