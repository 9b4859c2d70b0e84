/// Potential energy of the legs and of the whole, and whether what acts has one.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <algorithm>

#include "base/at.hpp"

namespace sinew::inline v1 {

bool ArmGroup::platform_has_potential() const {
  return std::ranges::all_of(loads_.following, [](double x) { return x == 0; }) &&
         (robot_->is_planar || wrench_.tail<3>().isZero(0));
}

bool ArmGroup::loads_have_potential() const {
  ArmLoad on_legs;
  on_legs.following_along = loads_.following_along;
  for (const ArmLegsPointLoad& point : loads_.points) {
    PointLoad& own = on_legs.points.emplace_back();
    own.wrench = point.wrench;
    own.following = point.following;
  }
  return platform_has_potential() && load_has_potential(on_legs, robot_->is_planar);
}

bool ArmGroup::has_potential() const {
  return platform_has_potential() &&
         std::ranges::all_of(legs_, [](const Leg& leg) { return leg.has_potential; });
}

double ArmGroup::energy() const {
  double sum = 0;
  for (const Leg& leg : legs_) {
    const std::vector<double>& strains = rod(leg).work().y;
    for (const double y : strains) sum += 0.5 * y * y;
    for (const int pivot : leg.pivots()) sum -= 0.5 * strains[at(pivot)] * strains[at(pivot)];
  }
  return sum;
}

double ArmGroup::potential() const {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    sum -= (wrench_[i] + robot_->platform_mass * loads_.gravity[at(i)]) * platform_.p[i];
  for (const Leg& leg : legs_) {
    const strain::RodWork& work = rod(leg).work();
    const strain::NodeLoad& tip = work.loads.back();
    sum += work.energy;
    for (int i = 0; i < 3; ++i) sum += leg.force[i] * work.frames.back().p[i];
    for (int i = 0; i < 9; ++i) sum += (tip.couple[i] - leg.tip.couple[i]) * work.frames.back().R[i];
    for (const Tendon& tendon : leg.tendons) sum += 0.5 * tendon.compliance * tendon.tension * tendon.tension;
  }
  return sum;
}

}  // namespace sinew::inline v1
