/// @file every_robot.hpp
/// What tests that run on every robot of the library need of it, planar or spatial.
#pragma once
#include <stdexcept>

#include "io/robots/serial_file.hpp"
#include "planar_robots.hpp"
#include "random_leg.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {

/// The built-in robots with a platform, but those whose legs are arms: these have no coordinates of legs.
inline std::vector<std::string_view> parallel_robot_names() {
  std::vector<std::string_view> names = builtin_robot_names();
  std::erase_if(names, [](std::string_view name) {
    return is_serial(read_robot_file(std::string(name)).value()) ||
           load(std::string(name)).value().arm_legs();
  });
  return names;
}

/// The built-in robots whose legs close on the platform, or those whose legs bear load.
inline std::vector<std::string> builtin_robots(bool loaded) {
  std::vector<std::string> names;
  for (const std::string_view name : parallel_robot_names())
    if (bears_load(load(std::string(name)).value()) == loaded) names.emplace_back(name);
  return names;
}

/// A pose near home.
inline AnyPose pose_near_home(const Robot& robot, std::mt19937& random, double shift = 0.04,
                              double turn = 0.6) {
  const auto any = [&](double size) { return uniform(random, -size, size); };
  if (const AnyPose start = home(robot); const auto* planar = std::get_if<PlanarPose>(&start))
    return PlanarPose{planar->x + any(shift), planar->y + any(shift), planar->phi + any(turn)};
  else
    return Spatial::moved(std::get<SpatialPose>(start), Vec<double, 6>(any(shift), any(shift), any(shift),
                                                                       any(turn), any(turn), any(turn)));
}

/// A pose near home that every leg reaches, and that hinges allow.
inline AnyPose reachable_pose(const Robot& robot, std::mt19937& random, Workspace& work) {
  for (int tries = 0; tries < 10000; ++tries) {
    const AnyPose pose = project_to_constraints(robot, pose_near_home(robot, random));
    if (inverse(robot, pose, {}, work).ok()) return pose;
  }
  throw std::runtime_error(robot.name() + " reaches no pose near home");
}

/// The pose after a small motion in base axes.
inline AnyPose moved(const AnyPose& pose, const Eigen::VectorXd& step) {
  if (const auto* planar = std::get_if<PlanarPose>(&pose)) return Planar::moved(*planar, step);
  return Spatial::moved(std::get<SpatialPose>(pose), step);
}

/// The small motion from one pose to the other, in base axes.
inline Eigen::VectorXd motion(const AnyPose& from, const AnyPose& to) {
  if (const auto* a = std::get_if<PlanarPose>(&from)) {
    const auto& b = std::get<PlanarPose>(to);
    return Eigen::Vector3d(b.x - a->x, b.y - a->y, wrap_angle(b.phi - a->phi));
  }
  const auto a = SE3<double>::from(std::get<SpatialPose>(from)),
             b = SE3<double>::from(std::get<SpatialPose>(to));
  Eigen::VectorXd step(6);
  step << b.p - a.p, b.R.compose(a.R.inverse()).log();
  return step;
}

}  // namespace sinew::test
