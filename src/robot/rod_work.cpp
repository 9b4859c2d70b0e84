#include "robot/rod_work.hpp"

namespace sinew::inline v0 {

ParallelRobot<RodLeg> rods_of(const AnyRobot& robot) {
  ParallelRobot<RodLeg> rods;
  for_each_rod(robot, [&](const RodLeg& leg, const LegPlace& place, int) {
    rods.legs.push_back(leg);
    rods.places.push_back(place);
  });
  std::visit(
      [&]<class LegT>(const ParallelRobot<LegT>& whole) {
        if constexpr (LegT::Space::dimension == 3) rods.home = whole.home;
        rods.platform_radius = whole.platform_radius;
        rods.total = whole.total;
      },
      robot.model);
  return rods;
}

namespace {

std::variant<RodWork, TangentWork> make_work(const AnyRobot& robot) {
  const ParallelRobot<RodLeg> rods = rods_of(robot);
  if (bend_in_planes(rods)) return std::variant<RodWork, TangentWork>(std::in_place_type<RodWork>, rods);
  return std::variant<RodWork, TangentWork>(std::in_place_type<TangentWork>, rods, robot.weight.gravity);
}

}  // namespace

RodWorks::RodWorks(const AnyRobot& robot) : kind(make_work(robot)) {}

}  // namespace sinew::inline v0
