#include "robot/rods/rod_group.hpp"

#include <algorithm>
#include <limits>

#include "solve/contraction.hpp"

namespace sinew::inline v1 {

std::vector<RodResult> RodGroup::readings() const {
  std::vector<RodResult> rods;
  for (int k = 0; k < limbs(); ++k) rods.push_back(rod(k));
  return rods;
}

double RodGroup::energy() const {
  double energy = 0;
  for (int k = 0; k < limbs(); ++k) energy += rod(k).energy;
  return energy;
}

double RodGroup::potential(double energy) const {
  const Wrench load = wrench();
  if (load.tail<3>() != Vec3<double>::Zero()) return std::numeric_limits<double>::quiet_NaN();
  return energy + weight_energy() - dot(Vec3<double>(load.head<3>()), platform_.p);
}

bool RodGroup::correct_rods(int& iterations, double& residual, double tolerance) {
  const auto error = [&] {
    evaluate();
    return limb_error();
  };
  const auto step = [&] {
    linearise();  // the platform's stiffness, which may be singular, is not asked for
    move(Twist::Zero());
    return true;
  };
  return contract(error, step, tolerance, rod_rounding, iterations, residual);
}

bool RodGroup::balance(bool once_closed) {
  set_wrench(Wrench::Zero());
  evaluate();
  if (once_closed) linearise();
  set_wrench(-wrench_residual());
  evaluate();
  return linearise();
}

bool RodGroup::settle_rods() {
  int iterations = 0;
  double residual = 0;
  if (!correct_rods(iterations, residual, rod_tolerance)) return false;
  while (!is_finest() && truncation() > coarse_truncation) {
    refine();
    if (!correct_rods(iterations, residual, rod_tolerance)) return false;
  }
  return balance(true);
}

void RodGroup::save_common(LimbState& to, int level, std::size_t most) const {
  Common common;
  common.level = level;
  const Wrench load = wrench();
  std::ranges::copy(platform_.p, common.position);
  std::ranges::copy(platform_.R.v, common.rotation);
  common.rotation[3] = platform_.R.w;
  std::ranges::copy(load, common.wrench);
  to.clear(sizeof(common) + most + static_cast<std::size_t>(inputs()) * sizeof(double));  // of closing legs
  to.put(common);
}

int RodGroup::restore_common(LimbState::Reader& from) {
  const auto common = from.next<Common>();
  const double* v = common.rotation;
  platform_ = {Vec3<double>(common.position), {v[3], Vec3<double>(v)}};
  set_wrench(Wrench(common.wrench));
  return common.level;
}

HeavyRodGroup::HeavyRodGroup(const ParallelRobot<RodLeg>& robot) : RodGroup(robot) {
  for (const RodLeg& leg : robot.legs) {
    mass_.push_back(leg.link.mass_per_length());
    load_.push_back(leg.link.load);
  }
}

bool HeavyRodGroup::set_gravity(const Vec3<double>& gravity) {
  if (gravity == gravity_) return false;
  gravity_ = gravity;
  for (int k = 0; k < limbs(); ++k) {
    const auto rod = static_cast<std::size_t>(k);
    weigh(k, gravity * mass_[rod] + load_[rod]);
  }
  return std::ranges::any_of(mass_, [](double mass) { return mass > 0; });
}

}  // namespace sinew::inline v1
