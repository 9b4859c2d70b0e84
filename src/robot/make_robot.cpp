#include <algorithm>

#include "sinew/base/assert.hpp"

#include "sinew/robot/any_robot.hpp"

namespace sinew::inline v0 {
namespace {

template <class LegT>
RobotModel alike(const std::vector<AnyPlanarLeg>& legs, std::vector<int> inputs, PlanarPose home,
                 double radius) {
  ParallelRobot<LegT> robot{{}, std::move(inputs), home, radius};
  for (const AnyPlanarLeg& leg : legs) robot.legs.push_back(std::get<LegT>(leg.kind));
  return robot;
}

}  // namespace

RobotModel make_robot(std::vector<AnyPlanarLeg> legs, std::vector<int> inputs, PlanarPose home,
                      double radius) {
  SINEW_EXPECTS(!legs.empty() && inputs.size() == legs.size());
  const auto kind = legs.front().kind.index();
  if (!std::ranges::all_of(legs, [&](const AnyPlanarLeg& leg) { return leg.kind.index() == kind; }))
    return ParallelRobot<AnyPlanarLeg>{std::move(legs), std::move(inputs), home, radius};
  return std::visit(
      [&]<class LegT>(const LegT&) { return alike<LegT>(legs, std::move(inputs), home, radius); },
      legs.front().kind);
}

}  // namespace sinew::inline v0
