/// Newton's step of all equations at once, with the matrix of all unknown forces and the platform. At a
/// prescribed pose each leg is by itself.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/arm_legs/group/regular_lu.hpp"
#include "solve/contraction.hpp"

namespace sinew::inline v1 {

/// By which the unknown forces of all legs, and then the platform's motion, count alike.
ArmGroup::Vector ArmGroup::units() const {
  int all = 6;
  double energy = 0, size = 0;
  for (const Leg& leg : legs_) {
    all += leg.unknowns();
    energy = std::max(energy, rod(leg).model().energy_scale);
    size = std::max(size, leg.own->arm.length());
  }
  Vector unit(all);
  Eigen::Index next = 0;
  for (const Leg& leg : legs_) {
    unit.segment(next, leg.unknowns()) = units_of(leg);
    next += leg.unknowns();
  }
  unit.tail(6) << size, size, size, 1, 1, 1;
  unit.tail(6) /= std::sqrt(energy);
  return unit;
}

ArmGroup::Matrix ArmGroup::whole(std::span<const SymmetricPart> parts) const {
  const Vector unit = units();
  const auto size = unit.size();
  Matrix whole = Matrix::Zero(size, size);
  whole.bottomRightCorner(6, 6) = following_curvature();
  Eigen::Index next = 0;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const Leg& leg = legs_[k];
    const int all = leg.unknowns();
    whole.block(next, next, all, all) = parts.empty() ? -leg.D : -parts[k].D;
    whole.block(next, size - 6, all, 6) = leg.X;
    whole.block(size - 6, next, 6, all) = leg.X.transpose();
    whole.bottomRightCorner(6, 6) += curvature(leg);
    next += all;
  }
  whole = (unit.asDiagonal() * whole * unit.asDiagonal()).eval();
  constrain_to_plane(whole, {1, 1});
  return whole;
}

/// The change of a leg's shape in the planned step, as an angle [rad].
double ArmGroup::planned_bend(const Leg& leg) {
  return (leg.y0 - leg.HB * leg.du).norm() / std::sqrt(rod(leg).model().energy_scale);
}

bool ArmGroup::plan() {
  const Vector unit = units();
  const auto lu = regular_lu(whole());
  if (!lu) return false;
  Vector side(unit.size());
  Eigen::Index next = 0;
  for (const Leg& leg : legs_) {
    side.segment(next, leg.unknowns()) = -leg.r;
    next += leg.unknowns();
  }
  side.tail(6) = balance_;
  side = unit.asDiagonal() * side;
  const Vector answer = unit.asDiagonal() * lu->solve(side).eval();
  if (!answer.allFinite()) return false;
  planned_ = answer.tail(6);
  planned_size_ = planned_.tail<3>().norm();
  next = 0;
  for (Leg& leg : legs_) {
    leg.du = answer.segment(next, leg.unknowns());
    next += leg.unknowns();
    planned_size_ = worse(planned_size_, planned_bend(leg));
    planned_size_ = worse(planned_size_, planned_.head<3>().norm() / leg.own->arm.length());
  }
  return true;
}

/// By `du`. @param after the platform; by_input changes of this leg's own inputs, or none
void ArmGroup::advance(Leg& leg, const Frame& after, Numbers by_input) {
  Vector step = leg.y0 - leg.HB * leg.du;
  for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
    Tendon& tendon = leg.tendons[i];
    tendon.tension += tendon.relief;
    if (tendon.is_taut)
      tendon.tension += leg.du[tendon.place];
    else if (tendon.command.held == TendonHeld::tension && !by_input.empty())
      step -= leg.HL.col(tendon.place) * by_input[i];
  }
  std::vector<double>& y = rod(leg).work().y;
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += step[static_cast<Eigen::Index>(i)];
  Vec<double, 6> change = Vec<double, 6>::Zero();
  for (int i = 0; i < leg.closed; ++i) change[leg.components[at(i)]] = leg.du[leg.taut + i];
  leg.force += change.head<3>();
  if (!leg.own->is_clamped) return;
  // The forces that make the moment kept their directions while the platform turned.
  const Mat<double, 3, 3> turned =
      (after.R.compose(leg.own->mount)).matrix().transpose() * mount_of(leg).R.matrix();
  leg.moment = 0.5 * (turned.trace() * Mat<double, 3, 3>::Identity() - turned.transpose()) *
               (leg.moment + change.tail<3>());
}

void ArmGroup::move_as_planned() {
  const Frame after = platform_.displaced(planned_);
  for (Leg& leg : legs_) advance(leg, after, {});
  platform_ = after;
}

bool ArmGroup::plan_at_prescribed_pose() {
  planned_.setZero();
  planned_size_ = 0;
  for (Leg& leg : legs_) {
    if (!factor_compliance(leg)) return false;
    leg.du = leg.D_inverse * leg.r;
    planned_size_ = worse(planned_size_, planned_bend(leg));
  }
  return std::isfinite(planned_size_);
}

}  // namespace sinew::inline v1
