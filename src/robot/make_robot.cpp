#include <algorithm>

#include "sinew/base/assert.hpp"
#include "sinew/robot/any_robot.hpp"

namespace sinew::inline v0 {
namespace {

template <class LegT, class Any, class Pose>
RobotModel alike(const std::vector<Any>& legs, std::span<const int> tied, Pose home, double radius) {
  std::vector<LegT> same;
  for (const Any& leg : legs) same.push_back(std::get<LegT>(leg.kind));
  return ParallelRobot<LegT>(std::move(same), home, radius, tied);
}

template <class Any, class Pose>
RobotModel make(const std::vector<Any>& legs, std::span<const int> tied, Pose home, double radius) {
  SINEW_EXPECTS(!legs.empty() && tied.size() == legs.size());
  const auto kind = legs.front().kind.index();
  if constexpr (std::variant_size_v < decltype(Any::kind) >> 1)
    if (!std::ranges::all_of(legs, [&](const Any& leg) { return leg.kind.index() == kind; }))
      return ParallelRobot<Any>(legs, home, radius, tied);
  return std::visit([&]<class LegT>(const LegT&) { return alike<LegT>(legs, tied, home, radius); },
                    legs.front().kind);
}

}  // namespace

RobotModel make_robot(const std::vector<AnyPlanarLeg>& legs, std::span<const int> tied, PlanarPose home,
                      double radius) {
  return make(legs, tied, home, radius);
}

RobotModel make_robot(const std::vector<AnySpatialLeg>& legs, std::span<const int> tied, SpatialPose home,
                      double radius) {
  return make(legs, tied, home, radius);
}

RobotModel make_robot(const std::vector<AnyLoadedLeg>& legs, std::span<const int> tied, SpatialPose home,
                      double radius) {
  return make(legs, tied, home, radius);
}

}  // namespace sinew::inline v0
