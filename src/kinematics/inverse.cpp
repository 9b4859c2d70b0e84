#include "sinew/kinematics/inverse.hpp"

#include <cmath>

#include "robot/pose.hpp"

namespace sinew::inline v0 {
namespace {

constexpr auto per_input = static_cast<std::size_t>(Workspace::max_solutions);
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of the robot's size: within it a leg counts as closed by an input that another leg asked for.
constexpr double common_tolerance = 1e-12;

Report refused(Status status, std::string_view text) {
  Report report;
  report.status = status;
  report.message.append(text);
  return report;
}

Report name(Status status, std::string_view what, std::size_t index) {
  Report report = refused(status, what);
  report.message.append("[");
  append_number(report.message, static_cast<int>(index));
  report.message.append("] ");
  return report;
}

/// Why leg i has no solution: `count` 0 or -1 as its search ended.
template <class LegT, class Frame>
Report without_solution(const LegT& leg, const Frame& platform, std::size_t i, int count) {
  Report report = name(count < 0 ? Status::stalled : Status::unreachable, "legs", i);
  if (count < 0)
    report.message.append("has sizes so unlike each other that its solutions cannot be told apart");
  else
    leg.explain_unreachable(platform, report.message);
  return report;
}

/// The inverse problem of one robot at one pose.
template <class LegT>
class Problem {
 public:
  using Space = typename LegT::Space;

  Problem(const ParallelRobot<LegT>& robot, const AnyPose& pose, Workspace& work)
      : robot_(robot),
        platform_(Space::frame(in_space<Space>(pose))),
        work_(work) {}

  bool is_finite() const { return Space::is_finite(platform_); }

  /// All solutions of every input into the workspace.
  Report solve_all() {
    for (std::size_t j = 0; j < work_.inputs.size(); ++j)
      if (Report report = solve_input(j); !report.ok()) return report;
    return {};
  }

  /// The wanted solution of every input into the workspace.
  Report solve_wanted(const InverseOptions& options) {
    for (std::size_t j = 0; robot_.has_ties() && j < work_.inputs.size(); ++j)
      if (Report report = choose(j, options); !report.ok()) return report;
    for (std::size_t i = 0; !robot_.has_ties() && i < robot_.legs.size(); ++i)
      if (Report report = nearest(i, options); !report.ok()) return report;
    return {};
  }

 private:
  bool moves(std::size_t input, std::size_t leg) const {
    return robot_.input_of_leg[leg] == static_cast<int>(input);
  }

  /// Largest closure error of the legs that input j moves, at its value a.
  double misfit(std::size_t j, double a) const {
    double worst = 0;
    for (std::size_t i = 0; i < robot_.legs.size(); ++i) {
      if (!moves(j, i)) continue;
      const double q = robot_.legs[i].coordinate(a);
      if (!robot_.legs[i].in_domain(q)) return infinity;
      worst = std::max(worst, with_leg(robot_.legs[i], [&](const auto& leg) {
                         const double size =
                             leg.base.p.norm() + leg.platform_point.norm() + leg.link.bounds().reach;
                         return std::abs(leg.template blocks<double>(platform_, leg.tip(q)).error) / size;
                       }));
    }
    return worst;
  }

  /// Puts a among the solutions of input j, unless it is there: two legs may ask for the same input.
  void add(std::size_t j, double a, double scale) {
    int& count = work_.solution_count[j];
    const auto begin = work_.solutions.begin() + static_cast<std::ptrdiff_t>(j * per_input),
               end = begin + count;
    const auto is_same = [&](double other) { return std::abs(other - a) <= 1e-7 * scale; };
    if (count == Workspace::max_solutions || std::any_of(begin, end, is_same)) return;
    *end = a;
    ++count;
  }

  /// All values of input j that close every leg it moves.
  Report solve_input(std::size_t j) {
    std::array<double, per_input> roots;
    std::size_t legs = 0;
    work_.solution_count[j] = 0;
    for (std::size_t i = 0; i < robot_.legs.size(); ++i) {
      if (!moves(j, i)) continue;
      ++legs;
      const auto& leg = robot_.legs[i];
      const int count = leg.coordinates_at(platform_, roots);
      if (count <= 0) return without_solution(leg, platform_, i, count);
      for (int k = 0; k < count; ++k) {
        const double a = leg.input(roots[static_cast<std::size_t>(k)]);
        const bool is_common = !robot_.has_ties() || misfit(j, a) <= common_tolerance;
        if (is_common) add(j, a, robot_.has_ties() ? std::abs(leg.input(0)) : 0);
      }
    }
    if (work_.solution_count[j] > 0) return {};
    Report report = name(Status::unreachable, "inputs", j);
    report.message.append("moves several legs together, and no value of it closes them all at this pose");
    return report;
  }

  /// How little a value of input j is wanted; infinite where it is ruled out.
  double cost(std::size_t j, double a, const InverseOptions& options) const {
    double worst = 0;
    for (std::size_t i = 0; i < robot_.legs.size(); ++i) {
      if (!moves(j, i)) continue;
      const double q = robot_.legs[i].coordinate(a);
      if (!options.bending.empty() && q * options.bending[i] < 0) return infinity;
      worst = std::max(worst, std::abs(q - (options.curvature.empty() ? 0 : options.curvature[i])));
    }
    return worst;
  }

  /// The wanted one of all values of an input that moves several legs.
  Report choose(std::size_t j, const InverseOptions& options) {
    if (Report report = solve_input(j); !report.ok()) return report;
    double best = infinity;
    for (std::size_t k = static_cast<std::size_t>(work_.solution_count[j]); k-- > 0;) {
      const double a = work_.solutions[j * per_input + k], c = cost(j, a, options);
      if (!(c < best)) continue;
      best = c;
      work_.inputs[j] = a;
    }
    if (std::isinf(best)) {
      Report report = name(Status::unreachable, "inputs", j);
      report.message.append("has no value at this pose that bends its legs as asked");
      return report;
    }
    for (std::size_t i = 0; i < robot_.legs.size(); ++i)
      if (moves(j, i)) work_.coordinates[i] = robot_.legs[i].coordinate(work_.inputs[j]);
    return {};
  }

  /// The wanted solution of a leg that has its input for itself.
  Report nearest(std::size_t i, const InverseOptions& options) {
    const auto& leg = robot_.legs[i];
    const double target = options.curvature.empty() ? 0 : options.curvature[i];
    const int sign = options.bending.empty() ? 0 : options.bending[i];
    const NearestRoot found = leg.coordinate_near(platform_, target, sign);
    work_.coordinates[i] = found.root;
    work_.inputs[static_cast<std::size_t>(robot_.input_of_leg[i])] = leg.input(found.root);
    if (found.count > 0) return {};
    if (sign == 0 || leg.coordinate_near(platform_, target, 0).count <= 0)
      return without_solution(leg, platform_, i, found.count);
    Report report = name(Status::unreachable, "legs", i);
    report.message.append(sign > 0 ? "has no solution of positive curvature at this pose"
                                   : "has no solution of negative curvature at this pose");
    return report;
  }

  const ParallelRobot<LegT>& robot_;
  typename Space::template Frame<double> platform_;
  Workspace& work_;
};

Report check(const AnyRobot& robot, const InverseOptions& options) {
  const auto legs = static_cast<std::size_t>(leg_count(robot));
  const auto fits = [&](std::size_t size) { return size == 0 || size == legs; };
  if (fits(options.bending.size()) && fits(options.curvature.size())) return {};
  return refused(Status::left_domain, "bending and curvature need one value a leg");
}

/// Calls `solve` with the problem, if the pose is one.
template <class Solve>
Report with_problem(const AnyRobot& robot, const AnyPose& pose, Workspace& work, const Solve& solve) {
  return std::visit(
      [&](const auto& r) {
        Problem problem(r, pose, work);
        return problem.is_finite()
                   ? solve(problem)
                   : refused(Status::left_domain, "the pose is not a finite number in every coordinate");
      },
      robot.model);
}

}  // namespace

Inverse inverse(const AnyRobot& robot, const AnyPose& pose, const InverseOptions& options, Workspace& work) {
  Report report = check(robot, options);
  if (report.ok())
    report = with_problem(robot, pose, work, [&](auto& problem) { return problem.solve_wanted(options); });
  if (report.ok()) report.residual = assemble(robot, pose, work.coordinates, work).closure_error;
  return {report, work.inputs, work.coordinates};
}

WorkingModes working_modes(const AnyRobot& robot, const AnyPose& pose, Workspace& work) {
  WorkingModes modes{with_problem(robot, pose, work, [](auto& problem) { return problem.solve_all(); }),
                     work.solutions, work.solution_count, 0};
  if (!modes.report.ok()) return modes;
  modes.count = 1;
  for (const int n : work.solution_count) modes.count *= n;
  return modes;
}

void WorkingModes::mode(std::size_t k, std::span<double> inputs) const {
  for (std::size_t j = inputs.size(); j-- > 0;) {
    const auto n = static_cast<std::size_t>(solution_count[j]);
    inputs[j] = solutions[j * per_input + k % n];
    k /= n;
  }
}

}  // namespace sinew::inline v0
