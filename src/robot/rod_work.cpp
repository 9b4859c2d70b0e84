#include "robot/rod_work.hpp"

#include <algorithm>

namespace sinew::inline v0 {

namespace {

using Kind = decltype(RodWorks::kind);

Kind make_work(const Robot& robot) {
  const SpatialRobot& legs = *robot.spatial();
  const std::vector<RodLeg> rods = legs_of<RodLeg>(legs).legs;
  const Vec3<double>& gravity = robot.weight().gravity;
  if (rods.size() == legs.legs.size() && std::ranges::all_of(rods, &RodLeg::is_elastica))
    return Kind(std::in_place_type<RodWork>, legs);
  if (std::ranges::all_of(rods, &RodLeg::is_torque_free))
    return Kind(std::in_place_type<TangentWork>, legs, gravity);
  return Kind(std::in_place_type<GeneralWork>, legs, gravity);
}

}  // namespace

RodWorks::RodWorks(const Robot& robot) : kind(make_work(robot)) {}

}  // namespace sinew::inline v0
