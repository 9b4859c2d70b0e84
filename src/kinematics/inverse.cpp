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

/// All solutions of each leg into the workspace; the report names the first leg that has none.
template <class LegT>
Report solve_legs(const ParallelRobot<LegT>& robot, const AnyPose& pose, Workspace& work) {
  using Space = typename LegT::Space;
  const auto platform = Space::frame(in_space<Space>(pose));
  if (!Space::is_finite(platform)) {
    Report report;
    report.status = Status::left_domain;
    report.message.append("the pose is not a finite number in every coordinate");
    return report;
  }
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    work.solution_count[i] = robot.legs[i].coordinates_at(platform, solutions_of(work, i));
    if (work.solution_count[i] > 0) continue;
    Report report = name_leg(i);
    if (work.solution_count[i] < 0) {
      report.status = Status::stalled;
      report.message.append("has sizes so unlike each other that its solutions cannot be told apart");
      return report;
    }
    robot.legs[i].explain_unreachable(platform, report.message);
    return report;
  }
  return {};
}

/// How little a solution is wanted; infinite where it is ruled out.
double cost(double q, std::size_t leg, const InverseOptions& options) {
  if (!options.curvature.empty()) return std::abs(q - options.curvature[leg]);
  if (!options.bending.empty() && q * options.bending[leg] < 0) return std::numeric_limits<double>::infinity();
  return std::abs(q);
}

/// The wanted solution of each leg into work.coordinates.
Report choose(const InverseOptions& options, Workspace& work) {
  for (std::size_t i = 0; i < work.coordinates.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    // Downwards: of ±κ the positive one is met first and kept.
    for (std::size_t k = static_cast<std::size_t>(work.solution_count[i]); k-- > 0;) {
      const double q = work.solutions[i * per_leg + k], c = cost(q, i, options);
      if (!(c < best)) continue;
      best = c;
      work.coordinates[i] = q;
    }
    if (std::isinf(best)) {
      Report report = name_leg(i);
      report.message.append(options.bending[i] > 0 ? "has no solution of positive curvature at this pose"
                                                   : "has no solution of negative curvature at this pose");
      return report;
    }
  }
  return {};
}

Report solve_and_choose(const AnyRobot& robot, const AnyPose& pose, const InverseOptions& options, Workspace& work) {
  Report report = std::visit([&](const auto& r) { return solve_legs(r, pose, work); }, robot.model);
  if (report.ok()) report = choose(options, work);
  if (report.ok()) report = inputs_of(robot, work.coordinates, work);
  if (report.ok()) report.residual = assemble(robot, pose, work.coordinates, work).closure_error;
  return report;
}

}  // namespace

Inverse inverse(const AnyRobot& robot, const AnyPose& pose, const InverseOptions& options, Workspace& work) {
  return {solve_and_choose(robot, pose, options, work), work.inputs, work.coordinates};
}

WorkingModes working_modes(const AnyRobot& robot, const AnyPose& pose, Workspace& work) {
  WorkingModes modes{std::visit([&](const auto& r) { return solve_legs(r, pose, work); }, robot.model),
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
