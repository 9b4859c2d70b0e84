/// @file any_robot.hpp
/// The one variant at the edge: any robot of this build, its name, and the pose types of both spaces.
#pragma once
#include <string>
#include <utility>
#include <variant>

#include "sinew/math/se3.hpp"
#include "sinew/robot/catalog.hpp"
#include "sinew/robot/parallel.hpp"

namespace sinew::inline v0 {

namespace detail {
template <class List>
struct RobotsOf;
template <class... Legs>
struct RobotsOf<TypeList<Legs...>> {
  using Leg = AnyLeg<Legs...>;
  using Model = std::variant<ParallelRobot<Legs>..., ParallelRobot<AnyLeg<Legs...>>>;
};
}  // namespace detail

using AnyPlanarLeg = detail::RobotsOf<PlanarLegs>::Leg;
using RobotModel = detail::RobotsOf<PlanarLegs>::Model;

/// A pose of the robot's space.
using AnyPose = std::variant<PlanarPose, SpatialPose>;

/// Any robot: what files load to and what every query is put to.
struct AnyRobot {
  std::string name;
  bool geometry_inferred =
      false;  ///< the source does not print the geometry; it was inferred from its results
  RobotModel model;

  AnyRobot() = default;
  template <class LegT>
  AnyRobot(std::string robot_name, ParallelRobot<LegT> robot)
      : name(std::move(robot_name)),
        model(std::move(robot)) {}
};

/// Legs that are all alike take the static path, unlike legs go through one variant of legs.
SINEW_API RobotModel make_robot(std::vector<AnyPlanarLeg> legs, std::vector<int> input_of_leg,
                                PlanarPose home, double platform_radius);

}  // namespace sinew::inline v0
