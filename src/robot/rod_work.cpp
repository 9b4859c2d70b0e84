#include "robot/rod_work.hpp"

#include <algorithm>

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

std::vector<ClosingLeg> closing_legs_of(const AnyRobot& robot) {
  std::vector<ClosingLeg> closing;
  std::visit(
      [&](const auto& whole) {
        whole.for_each_leg([&]<class L>(const L& leg, const LegPlace& place, int i) {
          if constexpr (!BearsLoad<L> && L::dimension == 3) closing.push_back({AnySpatialLeg{leg}, place, i});
        });
      },
      robot.model);
  return closing;
}

namespace {

using Kind = decltype(RodWorks::kind);

Kind make_work(const AnyRobot& robot) {
  const ParallelRobot<RodLeg> rods = rods_of(robot);
  const Vec3<double>& gravity = robot.weight.gravity;
  const bool is_torque_free = std::ranges::all_of(rods.legs, &RodLeg::is_torque_free);
  auto closing = closing_legs_of(robot);
  if (closing.empty() && bend_in_planes(rods)) return Kind(std::in_place_type<RodWork>, rods);
  return is_torque_free ? Kind(std::in_place_type<TangentWork>, rods, gravity, std::move(closing))
                        : Kind(std::in_place_type<GeneralWork>, rods, gravity, std::move(closing));
}

}  // namespace

RodWorks::RodWorks(const AnyRobot& robot) : kind(make_work(robot)) {}

}  // namespace sinew::inline v0
