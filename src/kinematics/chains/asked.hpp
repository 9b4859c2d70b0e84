/// @file asked.hpp
/// What a typed question to a robot by the model prb says in space, as the robot has it in its own: one in
/// the plane lies in the plane z = 0.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "kinematics/chains/arcs.hpp"
#include "kinematics/chains/path.hpp"
#include "math/plane_axes.hpp"
#include "robot/arguments.hpp"
#include "robot/pose.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {

/// The equilibrium that a workspace holds, if it does.
template <class Space>
std::shared_ptr<HeldChains<Space>>& held_in(Workspace& work) {
  return memory_in<Space>(work.chains).held;
}
/// The solvers' memory, which is asked to stop when the workspace is.
inline ChainWork& solver_memory(Workspace& work) {
  work.chains.stop = work.stop;
  return work.chains;
}

/// Which numbers of a twist in space a robot of this space has.
template <class Space>
constexpr std::array<Eigen::Index, static_cast<std::size_t>(Space::dof)> axes_of() {
  if constexpr (Space::dimension == 2)
    return {plane_axes[0], plane_axes[1], plane_axes[2]};
  else
    return {0, 1, 2, 3, 4, 5};
}

inline SpatialPose in_space(const SpatialPose& pose) { return spatial_pose(SE3<double>::from(pose)); }
inline SpatialPose in_space(const AnyPose& pose) {
  return std::visit([](const auto& own) { return in_space(own); }, pose);
}

template <class Space>
Vec<double, Space::dof> own_wrench(const SpatialWrench& wrench) {
  Vec<double, Space::dof> own;
  for (std::size_t k = 0; k < axes_of<Space>().size(); ++k)
    own[static_cast<Eigen::Index>(k)] = wrench[axes_of<Space>()[k]];
  return own;
}

inline Report refusal(Status status, std::string_view why) {
  Report report;
  report.status = status;
  report.message.append(why);
  return report;
}

/// What no robot of this space, or no chain, can be asked.
template <class Space>
Report check_wrench(const SpatialWrench& wrench) {
  if (!wrench.allFinite()) return refusal(Status::bad_input, "the wrench has numbers that are not finite");
  if constexpr (Space::dimension == 2)
    if (wrench[2] != 0 || wrench[3] != 0 || wrench[4] != 0)
      return refusal(Status::bad_input,
                     "the robot is in the plane z = 0: a wrench on it is (fx, fy, 0, 0, 0, m)");
  return {};
}

/// The pose in the robot's own space; of one in the plane it has to lie there.
template <class Space>
Report read_own(const SpatialPose& pose, std::string_view name, AnyPose& own) {
  const auto& q = pose.quaternion;
  const bool finite =
      pose.position.allFinite() && std::ranges::all_of(q, [](double x) { return std::isfinite(x); });
  if (!finite || std::ranges::all_of(q, [](double x) { return x == 0; }))
    return refusal(Status::bad_input, "a pose has finite numbers, and a quaternion other than 0");
  if constexpr (Space::dimension == 3) {
    own = pose;
  } else {
    if (pose.position[2] != 0 || q[1] != 0 || q[2] != 0) {
      Report report = refusal(Status::bad_input, "the robot is in the plane z = 0, ");
      report.message.append(name);
      report.message.append(" is not: z and the quaternion's x and y have to be 0");
      return report;
    }
    own = in_plane(pose);
  }
  return {};
}

template <class Space>
Report check_options(const EquilibriumOptions& options, std::optional<AnyPose>& start) {
  if (options.gravity)
    return refusal(Status::unsupported, "chains have no weight; leave gravity out, or give its wrench");
  if (options.max_iterations && *options.max_iterations < 0)
    return refusal(Status::bad_input, "max_iterations is 0 or more");
  if (const Report report = check_wrench<Space>(options.wrench); !report.ok()) return report;
  if (!options.start) return {};
  AnyPose own;
  const Report report = read_own<Space>(*options.start, "start", own);
  start = own;
  return report;
}

inline ChainOptions chain_options(const EquilibriumOptions& options) {
  ChainOptions how;
  if (options.max_iterations) how.max_iterations = *options.max_iterations;
  return how;
}

}  // namespace sinew::inline v1
