/// @file any_robot.hpp
/// The one variant at the edge: any robot of this build, its name, and the pose types of both spaces.
#pragma once
#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "sinew/math/se3.hpp"
#include "sinew/robot/catalog.hpp"
#include "sinew/robot/parallel.hpp"

namespace sinew::inline v0 {

namespace detail {
template <class Planars, class Spatials>
struct RobotsOf;
template <class... P, class... S>
struct RobotsOf<TypeList<P...>, TypeList<S...>> {
  using PlanarLeg = AnyLeg<P...>;
  using SpatialLeg = AnyLeg<S...>;
  using LoadedLeg = AnyLeg<RodLeg, S...>;
  using Model = std::variant<ParallelRobot<P>..., ParallelRobot<PlanarLeg>, ParallelRobot<S>...,
                             ParallelRobot<SpatialLeg>, ParallelRobot<RodLeg>, ParallelRobot<LoadedLeg>>;
};
}  // namespace detail

using AnyPlanarLeg = detail::RobotsOf<PlanarLegs, SpatialLegs>::PlanarLeg;
using AnySpatialLeg = detail::RobotsOf<PlanarLegs, SpatialLegs>::SpatialLeg;
using AnyLoadedLeg = detail::RobotsOf<PlanarLegs, SpatialLegs>::LoadedLeg;
using RobotModel = detail::RobotsOf<PlanarLegs, SpatialLegs>::Model;

/// A pose of the robot's space.
using AnyPose = std::variant<PlanarPose, SpatialPose>;

/// What weighs on a robot whose legs bear load.
struct Weight {
  Vec3<double> gravity = Vec3<double>::Zero();  ///< [m/s²], base axes
  double platform_mass = 0;                     ///< at the platform's reference point [kg]
};

/// Any robot: what files load to and what every query is put to.
struct AnyRobot {
  std::string name;
  Weight weight;
  bool geometry_inferred =
      false;  ///< the source does not print the geometry; it was inferred from its results
  RobotModel model;
  /// One for a robot and its copies; by it a workspace knows the robot that it was made for.
  std::shared_ptr<const char> identity = std::make_shared<const char>();

  AnyRobot() = default;
  template <class LegT>
  AnyRobot(std::string robot_name, ParallelRobot<LegT> robot)
      : name(std::move(robot_name)),
        model(std::move(robot)) {}
};

/// Calls `use(leg, place, i)` with each rod of a robot, in the order of its legs.
template <class Use>
void for_each_rod(const AnyRobot& robot, Use&& use) {
  std::visit(
      [&](const auto& r) {
        r.for_each_leg([&]<class L>(const L& leg, const LegPlace& place, int i) {
          if constexpr (BearsLoad<L>) use(leg, place, i);
        });
      },
      robot.model);
}

inline int rod_count(const AnyRobot& robot) {
  int count = 0;
  for_each_rod(robot, [&](const RodLeg&, const LegPlace&, int) { ++count; });
  return count;
}

/// Whether legs of this robot bear load: it then has equilibria (kinematics/equilibrium.hpp).
inline bool bears_load(const AnyRobot& robot) {
  return std::visit([]<class LegT>(const ParallelRobot<LegT>&) { return BearsLoad<LegT>; }, robot.model);
}

/// Whether gravity does anything to it.
inline bool has_weight(const AnyRobot& robot) {
  bool has = robot.weight.platform_mass > 0;
  for_each_rod(robot, [&](const RodLeg& leg, const LegPlace&, int) { has = has || leg.link.density > 0; });
  return has;
}

/// Calls `use` with the robot behind `robot` if its legs close on the platform, and `otherwise()` if some
/// bear load.
template <class Use, class Otherwise>
decltype(auto) visit_closing(const AnyRobot& robot, Use&& use, Otherwise&& otherwise) {
  using Answer = std::invoke_result_t<Otherwise>;
  return std::visit(
      [&]<class LegT>(const ParallelRobot<LegT>& r) -> Answer {
        if constexpr (BearsLoad<LegT>)
          return otherwise();
        else
          return use(r);
      },
      robot.model);
}

/// Legs that are all alike take the static path, unlike legs go through one variant of legs.
/// @param tied for each leg the earlier leg whose actuators it shares, or −1
SINEW_API RobotModel make_robot(const std::vector<AnyPlanarLeg>& legs, std::span<const int> tied,
                                PlanarPose home, double platform_radius);
SINEW_API RobotModel make_robot(const std::vector<AnySpatialLeg>& legs, std::span<const int> tied,
                                SpatialPose home, double platform_radius);
SINEW_API RobotModel make_robot(const std::vector<AnyLoadedLeg>& legs, std::span<const int> tied,
                                SpatialPose home, double platform_radius);

}  // namespace sinew::inline v0
