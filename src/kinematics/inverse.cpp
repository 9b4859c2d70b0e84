#include "sinew/kinematics/inverse.hpp"

#include <cmath>

#include "robot/pose.hpp"

namespace sinew::inline v0 {
namespace {

constexpr auto per_leg = static_cast<std::size_t>(Workspace::max_solutions);

std::span<double> solutions_of(Workspace& work, std::size_t leg) {
  return std::span(work.solutions).subspan(leg * per_leg, per_leg);
}

Report name_leg(std::size_t leg) {
  Report report;
  report.status = Status::unreachable;
  report.message.append("legs[");
  append_number(report.message, static_cast<int>(leg));
  report.message.append("] ");
  return report;
}

Report not_finite() {
  Report report;
  report.status = Status::left_domain;
  report.message.append("the pose is not a finite number in every coordinate");
  return report;
}

/// Why leg i has no solution: `count` 0 or -1 as its search ended.
template <class LegT, class Frame>
Report without_solution(const LegT& leg, const Frame& platform, std::size_t i, int count) {
  Report report = name_leg(i);
  if (count < 0) {
    report.status = Status::stalled;
    report.message.append("has sizes so unlike each other that its solutions cannot be told apart");
  } else {
    leg.explain_unreachable(platform, report.message);
  }
  return report;
}

/// All solutions of each leg into the workspace; the report names the first leg that has none.
template <class LegT>
Report solve_all(const ParallelRobot<LegT>& robot, const AnyPose& pose, Workspace& work) {
  using Space = typename LegT::Space;
  const auto platform = Space::frame(in_space<Space>(pose));
  if (!Space::is_finite(platform)) return not_finite();
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const int count = work.solution_count[i] = robot.legs[i].coordinates_at(platform, solutions_of(work, i));
    if (count <= 0) return without_solution(robot.legs[i], platform, i, count);
  }
  return {};
}

/// The wanted solution of each leg into work.coordinates.
template <class LegT>
Report solve_wanted(const ParallelRobot<LegT>& robot, const AnyPose& pose, const InverseOptions& options,
                    Workspace& work) {
  using Space = typename LegT::Space;
  const auto platform = Space::frame(in_space<Space>(pose));
  if (!Space::is_finite(platform)) return not_finite();
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const double target = options.curvature.empty() ? 0 : options.curvature[i];
    const int sign = options.bending.empty() ? 0 : options.bending[i];
    const NearestRoot nearest = robot.legs[i].coordinate_near(platform, target, sign);
    work.coordinates[i] = nearest.root;
    if (nearest.count > 0) continue;
    if (sign == 0 || robot.legs[i].coordinate_near(platform, target, 0).count <= 0)
      return without_solution(robot.legs[i], platform, i, nearest.count);
    Report report = name_leg(i);
    report.message.append(sign > 0 ? "has no solution of positive curvature at this pose"
                                   : "has no solution of negative curvature at this pose");
    return report;
  }
  return {};
}

Report solve(const AnyRobot& robot, const AnyPose& pose, const InverseOptions& options, Workspace& work) {
  Report report =
      std::visit([&](const auto& r) { return solve_wanted(r, pose, options, work); }, robot.model);
  if (report.ok()) report = inputs_of(robot, work.coordinates, work);
  if (report.ok()) report.residual = assemble(robot, pose, work.coordinates, work).closure_error;
  return report;
}

}  // namespace

Inverse inverse(const AnyRobot& robot, const AnyPose& pose, const InverseOptions& options, Workspace& work) {
  return {solve(robot, pose, options, work), work.inputs, work.coordinates};
}

WorkingModes working_modes(const AnyRobot& robot, const AnyPose& pose, Workspace& work) {
  WorkingModes modes{std::visit([&](const auto& r) { return solve_all(r, pose, work); }, robot.model),
                     work.solutions, work.solution_count, 0};
  if (!modes.report.ok()) return modes;
  modes.count = 1;
  for (const int n : work.solution_count) modes.count *= static_cast<std::size_t>(n);
  return modes;
}

void WorkingModes::mode(std::size_t k, std::span<double> coordinates) const {
  for (std::size_t leg = coordinates.size(); leg-- > 0;) {
    const auto n = static_cast<std::size_t>(solution_count[leg]);
    coordinates[leg] = solutions[leg * per_leg + k % n];
    k /= n;
  }
}

}  // namespace sinew::inline v0
