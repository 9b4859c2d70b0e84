#include "sinew/kinematics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinematics/rods/batch.hpp"
#include "kinematics/rods/energy.hpp"
#include "kinematics/rods/hold.hpp"
#include "kinematics/rods/inverse.hpp"
#include "kinematics/rods/question.hpp"

namespace sinew::inline v0 {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Equilibrium refused() {
  Equilibrium answer;
  answer.report.status = Status::left_domain;
  answer.report.message.append("the legs of this robot bear no load: it has no equilibrium to find");
  return answer;
}

/// The state of the system into the workspace, and what is seen of it.
template <class System>
Equilibrium answer_of(const Report& report, const System& system, Workspace& work, bool with_coordinates) {
  Equilibrium answer;
  answer.report = report;
  answer.pose = spatial_pose(system.platform());
  for (int k = 0; k < system.feeds(); ++k) work.inputs[at(system.input_of(k))] = system.length(k);
  if constexpr (requires { system.closing_legs(); })
    if (with_coordinates) system.get_closing(work.coordinates);
  for (int k = 0; k < system.rods(); ++k) {
    if (with_coordinates)
      system.get_rod(k,
                     std::span(work.coordinates).subspan(at(system.coordinate_of(k)), RodLeg::coordinates));
  }
  answer.inputs = work.inputs;
  if (with_coordinates) answer.coordinates = work.coordinates;
  return answer;
}

/// Of three rows.
double largest_singular_value(const double* rows, int columns) {
  std::array<double, 3> sigma;
  singular_values(MatrixView(rows, 3, columns), std::span(sigma).first(at(std::min(3, columns))));
  return sigma[0];
}

/// Calls `solve(rods, home, question)` and answers with what it found.
template <class Solve>
Equilibrium solved(const AnyRobot& robot, const EquilibriumOptions& options, Workspace& work, Solve&& solve) {
  if (!bears_load(robot)) return refused();
  return with_rods(work, [&](auto& rods) {
    const Report report = solve(rods, home_of(robot), question_of(robot, options, rods));
    return answer_of(report, rods.system, work, options.judge);
  });
}

}  // namespace

Equilibrium equilibrium(const AnyRobot& robot, Numbers inputs, const EquilibriumOptions& options,
                        Workspace& work) {
  return solved(robot, options, work, [&](auto& rods, const SE3<double>& home, const RodQuestion& question) {
    return solve_rods(rods, home, inputs, question);
  });
}

Equilibrium inverse_equilibrium(const AnyRobot& robot, const IndependentPose& wanted,
                                const EquilibriumOptions& options, Workspace& work) {
  return solved(robot, options, work, [&](auto& rods, const SE3<double>& home, const RodQuestion& question) {
    return solve_rods_at(rods, home, {wanted.z, wanted.e1, wanted.e2}, question);
  });
}

Equilibrium inverse_equilibrium(const AnyRobot& robot, const SpatialPose& wanted,
                                const EquilibriumOptions& options, Workspace& work) {
  return solved(robot, options, work, [&](auto& rods, const SE3<double>& home, const RodQuestion& question) {
    return hold_rods(rods, home, SE3<double>::from(wanted), question);
  });
}

bool has_equilibrium_batch(const AnyRobot& robot) {
  if (!bears_load(robot)) return false;
  const Workspace work(robot);
  return std::holds_alternative<RodWork>(work.rods->kind);
}

void equilibrium_batch(const AnyRobot& robot, Numbers rows, const SpatialWrench& wrench,
                       std::span<SpatialPose> poses, std::span<Status> statuses, Workspace& work,
                       bool judge) {
  std::fill(statuses.begin(), statuses.end(), Status::left_domain);
  const std::size_t inputs = at(input_count(robot));
  if (!bears_load(robot) || statuses.size() != poses.size() || rows.size() != poses.size() * inputs) return;
  if (auto* plane = std::get_if<RodWork>(&work.rods->kind)) {
    std::vector<SE3<double>> found(poses.size());
    const SpatialWrench whole = question_of(robot, {.wrench = wrench}, *plane).wrench;
    RodBatch(*plane, home_of(robot)).solve(rows, whole, judge, found, statuses);
    std::transform(found.begin(), found.end(), poses.begin(), spatial_pose);
    return;
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {  // one after the other
    EquilibriumOptions options{.wrench = wrench, .resume = true, .judge = judge};
    const Numbers row = rows.subspan(k * inputs, inputs);
    Equilibrium found = equilibrium(robot, row, options, work);
    if (judge && found.report.status == Status::unstable) {
      options.resume = false;
      const SpatialPose from = found.pose;
      found = equilibrium(robot, row, options, work);
      options.start = from;
      if (found.report.status != Status::converged)
        found = equilibrium(robot, row, options, work);  // back to where the path is
    }
    poses[k] = found.pose;
    statuses[k] = found.is_solved() && !judge ? Status::converged : found.report.status;
  }
}

namespace {

template <class System>
RodAnalysis analysis_of(const AnyRobot& robot, System& system) {
  RodAnalysis analysis;
  system.evaluate();
  system.linearise();
  const Eigen::Matrix<double, 6, 6, Eigen::RowMajor> stiffness = system.platform_stiffness();
  std::copy_n(stiffness.data(), 36, analysis.stiffness.begin());
  if constexpr (requires { system.closing_legs(); })
    for (std::size_t k = 0; k < system.closing_legs().size(); ++k)
      analysis.closing_forces.push_back(system.closing_force(static_cast<int>(k)));
  const Lu6 factors = system.factors();
  const auto inputs = at(system.inputs());
  analysis.sensitivity.resize(6 * inputs);
  analysis.feed.resize(6 * inputs);
  for (std::size_t k = 0; k < inputs; ++k) {
    const SpatialWrench moving = -system.feed_wrench(static_cast<int>(k));
    const SpatialWrench feed = -system.platform_feed(static_cast<int>(k));
    std::array<double, 6> twist;
    factors.solve(moving.data(), twist.data());
    for (std::size_t r = 0; r < 6; ++r) {
      analysis.sensitivity[r * inputs + k] = twist[r];
      analysis.feed[r * inputs + k] = feed[static_cast<Eigen::Index>(r)];
    }
  }
  std::array<double, 6> values;
  std::array<double, 36> vectors;
  symmetric_eigenvalues(system.stiffness(), values, vectors);
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(values[k] < 0)) continue;
    analysis.unstable.emplace_back();
    SpatialWrench twist(vectors.data() + 6 * k);
    if constexpr (requires { system.free_motion(twist); }) twist = system.free_motion(twist).normalized();
    std::ranges::copy(twist, analysis.unstable.back().begin());
  }
  analysis.unstable_directions = unstable_directions(system);
  analysis.rods = readings_of(system);
  for (int k = 0; k < system.rods(); ++k) analysis.unstable_rods.push_back(system.unstable_with_tip_held(k));
  for_each_rod(robot, [&, k = std::size_t{0}](const RodLeg& leg, const LegPlace&, int) mutable {
    const RodReading& rod = analysis.rods[k++];
    const double strain =
        leg.link.is_round() ? rod.largest_curvature * leg.link.diameter / 2 : rod.largest_strain;
    analysis.largest_strain = std::max(analysis.largest_strain, strain);
  });
  analysis.position_index = largest_singular_value(&analysis.sensitivity[0], system.inputs());
  analysis.rotation_index = largest_singular_value(&analysis.sensitivity[3 * inputs], system.inputs());
  analysis.energy = energy_of(system);
  analysis.potential = potential_of(system);
  analysis.smallest_pivot = factors.smallest_pivot();
  return analysis;
}

}  // namespace

RodAnalysis analyse_equilibrium(const AnyRobot& robot, Workspace& work) {
  if (!bears_load(robot)) return {};
  return with_rods(work, [&](auto& rods) { return analysis_of(robot, rods.system); });
}

std::string_view to_string(LoadEnd end) noexcept {
  switch (end) {
    case LoadEnd::limit:
      return "limit";
    case LoadEnd::bifurcation:
      return "bifurcation";
    case LoadEnd::fold:
      return "fold";
  }
  return "";
}

LoadPath follow_load(const AnyRobot& robot, const SpatialWrench& direction, double limit, Workspace& work) {
  if (!bears_load(robot) || !direction.allFinite() || !(limit > 0)) return {};
  return with_rods(work, [&](auto& rods) -> LoadPath {
    if (!rods.is_solved) return {};
    auto& system = rods.system;
    system.evaluate();
    system.linearise();
    RodTarget target = present(system);
    target.wrench += limit * direction;
    const RodPathEnd end = follow(system, target, {.stop_at_instability = true}, rods.spare);
    const LoadEnd why = end.arrived           ? LoadEnd::limit
                        : end.became_unstable ? LoadEnd::bifurcation
                                              : LoadEnd::fold;
    return {limit * end.progress, why, spatial_pose(system.platform()), system.evaluate()};
  });
}

namespace {

/// The k-th of many starts around home: tilted, turned and moved by low-discrepancy numbers.
SE3<double> scattered(const SE3<double>& home, double size, int k) {
  const auto number = [&](int base) {  // van der Corput, in (−1, 1)
    double value = 0, part = 1;
    for (int n = k + 1; n > 0; n /= base) {
      part /= base;
      value += part * (n % base);
    }
    return 2 * value - 1;
  };
  const Vec3<double> shift = 0.4 * size * Vec3<double>(number(2), number(3), 0.5 * number(5) - 0.3);
  const Vec3<double> turn(number(7), number(11), number(13));
  return {home.p + shift, SO3<double>::exp(turn).compose(home.R)};
}

bool is_new(const std::vector<FoundEquilibrium>& found, const SE3<double>& pose, double size) {
  return std::none_of(found.begin(), found.end(), [&](const FoundEquilibrium& other) {
    const SE3<double> there = SE3<double>::from(other.pose);
    return (there.p - pose.p).norm() < 1e-7 * size && there.R.inverse().compose(pose.R).log().norm() < 1e-7;
  });
}

}  // namespace

std::vector<FoundEquilibrium> equilibria(const AnyRobot& robot, Numbers inputs,
                                         const EquilibriumOptions& options, Workspace& work) {
  std::vector<FoundEquilibrium> found;
  if (!bears_load(robot)) return found;
  const SE3<double> home = home_of(robot);
  const double size = home.p.norm();
  with_rods(work, [&](auto& rods) {
    const auto& system = rods.system;
    const int starts = std::is_base_of_v<GeneralSystem, std::decay_t<decltype(rods.system)>> ? 16 : 160;
    RodQuestion question = question_of(robot, options, rods);
    question.resume = false;
    question.start.reset();
    for (int k = -1; k < starts; ++k) {
      if (k >= 0) question.start = scattered(home, size, k);
      const Report report = solve_rods(rods, home, inputs, question);
      if (!report.ok() && report.status != Status::unstable) continue;
      if (!is_new(found, system.platform(), size)) continue;
      FoundEquilibrium one;
      one.pose = spatial_pose(system.platform());
      one.rods = readings_of(system);
      one.residual = report.residual;
      one.potential = potential_of(system);
      one.unstable_directions = unstable_directions(system);
      found.push_back(std::move(one));
    }
  });
  std::ranges::sort(found, {}, [](const FoundEquilibrium& one) {
    return std::isfinite(one.potential) ? one.potential : one.pose.position[2];
  });
  return found;
}

}  // namespace sinew::inline v0
