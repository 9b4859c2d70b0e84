#include "sinew/kinematics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "kinematics/chains/questions.hpp"
#include "kinematics/load_problem.hpp"
#include "kinematics/rods/batch.hpp"
#include "kinematics/rods/inverse.hpp"
#include "kinematics/rods/lengths_for_pose.hpp"
#include "kinematics/rods/question.hpp"
#include "kinematics/rods/start.hpp"
#include "kinematics/rods/trace.hpp"
#include "kinematics/rods/verdict.hpp"
#include "kinematics/spread.hpp"
#include "math/linalg.hpp"
#include "robot/arguments.hpp"

namespace sinew::inline v1 {
namespace {

Equilibrium refused(const Report& report) {
  Equilibrium answer;
  answer.report = report;
  return answer;
}

Equilibrium refused(const Robot& robot) {
  Equilibrium answer;
  answer.report.status = Status::unsupported;
  answer.report.message.append(
      has_chains(robot)
          ? "on chains a pose is held with all its coordinates: give a SpatialPose"
          : "the legs of this robot bear no load by its model; arcs do as robot.as(Model::prb)");
  return answer;
}

/// The state of the system into the workspace, and what is seen of it.
Equilibrium answer_of(const Report& report, const RodGroup& system, Workspace& work, bool with_coordinates) {
  Equilibrium answer;
  answer.report = report;
  answer.pose = spatial_pose(system.platform());
  for (int k = 0; k < system.feeds(); ++k) work.inputs[at(system.input_of(k))] = system.held(k);
  if (with_coordinates) system.get_closing(work.coordinates);
  for (int k = 0; k < system.limbs(); ++k) {
    if (with_coordinates)
      system.get_rod(k,
                     std::span(work.coordinates).subspan(at(system.coordinate_of(k)), RodLeg::coordinates));
  }
  answer.inputs = work.inputs;
  if (with_coordinates) answer.coordinates = work.coordinates;
  return answer;
}

/// Calls `solve(rods, home, question)` and answers with what it found.
template <class Solve>
Equilibrium solved(const Robot& robot, const EquilibriumOptions& options, Workspace& work, Solve&& solve) {
  if (!has_rods(robot)) return refused(robot);
  if (const Report fits = check_workspace(robot, work); !fits.ok()) return refused(fits);
  RodWork& rods = rods_of(work);
  const Report report = solve(rods, home_of(robot), question_of(robot, options, rods));
  return answer_of(report, *rods.system, work, options.check_stability);
}

}  // namespace

Equilibrium equilibrium(const Robot& robot, Numbers inputs, const EquilibriumOptions& options,
                        Workspace& work) {
  if (has_chains(robot)) return equilibrium_of_chains(robot, inputs, options, work);
  return solved(robot, options, work,
                [&](RodWork& rods, const SE3<double>& home, const RodQuestion& question) {
                  return solve_rods(rods, home, inputs, question);
                });
}

Equilibrium inverse_equilibrium(const Robot& robot, const IndependentPose& wanted,
                                const EquilibriumOptions& options, Workspace& work) {
  return solved(robot, options, work,
                [&](RodWork& rods, const SE3<double>& home, const RodQuestion& question) {
                  return solve_rods_at(rods, home, wanted, question);
                });
}

Equilibrium inverse_equilibrium(const Robot& robot, const SpatialPose& wanted,
                                const EquilibriumOptions& options, Workspace& work) {
  if (has_chains(robot)) return inverse_equilibrium_of_chains(robot, wanted, options, work);
  return solved(robot, options, work,
                [&](RodWork& rods, const SE3<double>& home, const RodQuestion& question) {
                  return lengths_for_pose(rods, home, SE3<double>::from(wanted), question);
                });
}

bool has_equilibrium_batch(const Robot& robot) { return robot.is_within_limits() && is_elastica(robot); }

void equilibrium_batch(const Robot& robot, Numbers rows, const SpatialWrench& wrench,
                       std::span<SpatialPose> poses, std::span<Status> statuses, Workspace& work,
                       bool check_stability, std::span<double> residuals, RowStart start) {
  std::ranges::fill(residuals, not_a_number);
  std::fill(statuses.begin(), statuses.end(),
            has_rods(robot) || has_chains(robot) ? Status::bad_input : Status::unsupported);
  const std::size_t inputs = at(input_count(robot));
  if (!(has_rods(robot) || has_chains(robot)) || !check_workspace(robot, work).ok() ||
      statuses.size() != poses.size() || rows.size() != poses.size() * inputs ||
      (!residuals.empty() && residuals.size() != poses.size()))
    return;
  if (has_rods(robot) && rods_of(work).system->elastica()) {
    RodWork& rods = rods_of(work);
    const SpatialWrench whole = question_of(robot, {.wrench = wrench}, rods).wrench;
    go_home(rods, home_of(robot));  // whatever was solved before does not show
    RodBatch batch(rods, home_of(robot));
    if (start == RowStart::home)
      batch.solve_from_home(rows, whole, check_stability, {poses, statuses, residuals});
    else
      batch.solve(rows, whole, check_stability, {poses, statuses, residuals});
    return;
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {  // one after the other
    if (work.stop.stop_requested()) {
      std::fill(statuses.begin() + static_cast<std::ptrdiff_t>(k), statuses.end(), Status::stopped);
      return;
    }
    const bool goes_on = start == RowStart::row_before;
    EquilibriumOptions options{.wrench = wrench, .warm_start = goes_on, .check_stability = check_stability};
    const Numbers row = rows.subspan(k * inputs, inputs);
    Equilibrium found = equilibrium(robot, row, options, work);
    if (check_stability && goes_on && found.report.status == Status::unstable) {
      options.warm_start = false;
      const SpatialPose from = found.pose;
      found = equilibrium(robot, row, options, work);
      options.start = from;
      if (found.report.status != Status::converged)
        found = equilibrium(robot, row, options, work);  // back to where the path is
    }
    poses[k] = found.pose;
    if (!residuals.empty() && found.is_solved()) residuals[k] = found.report.residual;
    statuses[k] = found.is_solved() && !check_stability ? Status::converged : found.report.status;
  }
}

namespace {

/// Along which the platform's stiffness is negative.
std::vector<std::array<double, 6>> unstable_twists(const RodGroup& system) {
  std::vector<std::array<double, 6>> twists;
  std::array<double, 6> values;
  std::array<double, 36> vectors;
  symmetric_eigenvalues(system.stiffness(), values, vectors);
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(values[k] < 0)) continue;
    SpatialWrench twist(vectors.data() + 6 * k);
    if (system.closes()) twist = system.free_motion(twist).normalized();
    std::ranges::copy(twist, twists.emplace_back().begin());
  }
  return twists;
}

double energy_of(std::span<const RodResult> rods) {
  double energy = 0;
  for (const RodResult& rod : rods) energy += rod.energy;
  return energy;
}

RodAnalysis reading_of(const Robot& robot, RodWork& work) {
  RodGroup& system = *work.system;
  RodAnalysis analysis;
  if (!work.signs) {
    system.evaluate();
    system.linearise();
  }
  for (int k = 0; k < system.closing_legs(); ++k) analysis.closing_forces.push_back(system.closing_force(k));
  analysis.rods = system.readings();
  for_each_rod(robot, [&, k = std::size_t{0}](const RodLeg& leg, const LegPlace&, int) mutable {
    const RodResult& rod = analysis.rods[k++];
    const double strain =
        leg.link.is_round() ? rod.largest_curvature * leg.link.diameter / 2 : rod.largest_strain;
    analysis.largest_strain = std::max(analysis.largest_strain, strain);
  });
  analysis.energy = energy_of(analysis.rods);
  analysis.potential = system.potential(analysis.energy);
  return analysis;
}

RodAnalysis analysis_of(const Robot& robot, RodWork& work) {
  RodAnalysis analysis = reading_of(robot, work);
  RodGroup& system = *work.system;
  const LimbSigns signs = count_unstable_rods(work);
  const Eigen::Matrix<double, 6, 6, Eigen::RowMajor> stiffness = system.platform_stiffness();
  std::copy_n(stiffness.data(), 36, analysis.stiffness.begin());
  const SmallLu<6>& factors = system.factors();
  const auto inputs = at(system.inputs());
  analysis.sensitivity.resize(6 * inputs);
  analysis.feed.resize(6 * inputs);
  for (std::size_t k = 0; k < inputs; ++k) {
    const SpatialWrench moving = -system.input_wrench_jacobian(static_cast<int>(k));
    const SpatialWrench feed = -system.platform_feed(static_cast<int>(k));
    std::array<double, 6> twist;
    factors.solve(moving.data(), twist.data());
    for (std::size_t r = 0; r < 6; ++r) {
      analysis.sensitivity[r * inputs + k] = twist[r];
      analysis.feed[r * inputs + k] = feed[static_cast<Eigen::Index>(r)];
    }
  }
  if (signs.unstable > signs.own) analysis.unstable = unstable_twists(system);
  analysis.unstable_directions = signs.unstable;
  analysis.unstable_rods = work.unstable_rods;
  analysis.smallest_pivot = factors.smallest_pivot();
  return analysis;
}

}  // namespace

namespace {

/// Of three rows of a matrix of six.
double largest_singular_value(std::span<const double> rows) {
  if (rows.empty()) return 0;
  const std::size_t columns = rows.size() / 3;
  std::array<double, 3> sigma;
  singular_values(MatrixView(rows.data(), 3, static_cast<Eigen::Index>(columns)),
                  std::span(sigma).first(std::min<std::size_t>(3, columns)));
  return sigma[0];
}

}  // namespace

double RodAnalysis::position_index() const {
  return largest_singular_value(std::span(sensitivity).first(sensitivity.size() / 2));
}

double RodAnalysis::rotation_index() const {
  return largest_singular_value(std::span(sensitivity).last(sensitivity.size() / 2));
}

Equilibrium held_equilibrium(const Robot& robot, Workspace& work) {
  if (has_chains(robot)) return held_equilibrium_of_chains(robot, work);
  if (!has_rods(robot)) return refused(robot);
  if (const Report fits = check_workspace(robot, work); !fits.ok()) return refused(fits);
  if (!work.rods->is_solved) {
    Report none = failed(Status::bad_input);
    say(none, "the workspace holds no equilibrium");
    return refused(none);
  }
  return answer_of({}, *work.rods->system, work, true);
}

RodAnalysis analyse_equilibrium(const Robot& robot, Workspace& work) {
  if (has_chains(robot)) return analyse_equilibrium_of_chains(robot, work);
  if (!has_rods(robot) || !check_workspace(robot, work).ok() || !work.rods->is_solved) return {};
  work.rods->stop = work.stop;
  return analysis_of(robot, *work.rods);
}

RodAnalysis read_rods(const Robot& robot, Workspace& work) {
  if (!has_rods(robot) || !check_workspace(robot, work).ok() || !work.rods->is_solved) return {};
  return reading_of(robot, *work.rods);
}

std::string_view to_string(LoadEnd end) noexcept {
  switch (end) {
    case LoadEnd::limit:
      return "limit";
    case LoadEnd::bifurcation:
      return "bifurcation";
    case LoadEnd::fold:
      return "fold";
    case LoadEnd::stability:
      return "stability";
    case LoadEnd::straight:
      return "straight";
    case LoadEnd::sharp:
      return "sharp";
    case LoadEnd::iterations:
      return "iterations";
    case LoadEnd::stopped:
      return "stopped";
    case LoadEnd::stalled:
      return "stalled";
    case LoadEnd::slack:
      return "slack";
  }
  return "";
}

LoadPath follow_load(const Robot& robot, const SpatialWrench& direction, double limit, Workspace& work) {
  if (has_chains(robot)) return follow_load_of_chains(robot, direction, limit, work);
  LoadPath path;
  path.end = LoadEnd::stalled;
  if (!has_rods(robot) || !check_workspace(robot, work).ok() || !direction.allFinite() ||
      direction == SpatialWrench::Zero() || !(limit > 0))
    return path;
  RodWork& rods = rods_of(work);
  if (!rods.is_solved) return path;
  RodGroup& system = *rods.system;
  system.evaluate();
  system.linearise();
  constexpr int most = 4000;
  const GrownLoad grown =
      grow_load<Spatial>(system, rods.places, direction, limit, rods.stop, {.steps = most});
  constexpr LoadEnd ends[] = {LoadEnd::limit, LoadEnd::fold,    LoadEnd::bifurcation, LoadEnd::stability,
                              LoadEnd::limit, LoadEnd::stalled, LoadEnd::iterations,  LoadEnd::stopped};
  path.end = grown.end == GrowthEnd::lost ? why_stuck<LoadEnd>(system) : ends[static_cast<int>(grown.end)];
  path.load = grown.load;
  path.definite_until = grown.definite_until;
  path.pose = spatial_pose(system.platform());
  path.residual = system.evaluate();
  system.linearise();
  path.unstable_directions = count_unstable_rods(rods).unstable;
  return path;
}

namespace {

/// The k-th of many starts around home: tilted, turned and moved by low-discrepancy numbers.
SE3<double> scattered(const SE3<double>& home, double size, int k) {
  const auto number = [&](int base) { return spread_number(k, base); };
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

/// Known by potential where there is one; a moment leaves none.
double by_energy(const FoundEquilibrium& one) {
  return std::isfinite(one.potential) ? one.potential : one.pose.position[2];
}

/// What the system holds, with the inputs that the workspace then has.
FoundEquilibrium found_equilibrium(const Report& report, RodWork& rods, Workspace& work) {
  const RodGroup& system = *rods.system;
  const Equilibrium answer = answer_of(report, system, work, false);
  const std::vector<RodResult> held = system.readings();
  return {.pose = answer.pose,
          .inputs = {answer.inputs.begin(), answer.inputs.end()},
          .rods = held,
          .residual = report.residual,
          .potential = system.potential(energy_of(held)),
          .unstable_directions = count_unstable_rods(rods).unstable};
}

}  // namespace

std::vector<FoundEquilibrium> equilibria(const Robot& robot, Numbers inputs,
                                         const EquilibriumOptions& options, Workspace& work) {
  if (has_chains(robot)) return equilibria_of_chains(robot, inputs, options, work);
  std::vector<FoundEquilibrium> found;
  if (!has_rods(robot) || !check_workspace(robot, work).ok()) return found;
  const SE3<double> home = home_of(robot);
  const double size = home.p.norm();
  RodWork& rods = rods_of(work);
  constexpr int starts = 160;
  RodQuestion question = question_of(robot, options, rods);
  question.warm_start = false;
  question.start.reset();
  for (int k = -1; k < starts && !rods.stop.stop_requested(); ++k) {
    if (k >= 0) question.start = scattered(home, size, k);
    question.may_stray = k >= 0;  // more are found so
    const Report report = solve_rods(rods, home, inputs, question);
    if (report.is_solved() && is_new(found, rods.system->platform(), size))
      found.push_back(found_equilibrium(report, rods, work));
  }
  std::ranges::sort(found, {}, by_energy);
  return found;
}

std::vector<FoundEquilibrium> inverse_equilibria(const Robot& robot, const SpatialPose& wanted,
                                                 const EquilibriumOptions& options, Workspace& work) {
  if (has_chains(robot)) return inverse_equilibria_of_chains(robot, wanted, options, work);
  std::vector<FoundEquilibrium> found;
  if (!has_rods(robot) || !check_workspace(robot, work).ok()) return found;
  const SE3<double> home = home_of(robot), target = SE3<double>::from(wanted);
  const double size = home.p.norm();
  const auto is_known = [&](const FoundEquilibrium& one) {
    return std::ranges::any_of(found, [&](const FoundEquilibrium& other) {
      return std::ranges::equal(one.inputs, other.inputs,
                                [&](double a, double b) { return std::abs(a - b) < 1e-7 * size; });
    });
  };
  RodWork& rods = rods_of(work);
  constexpr int ways = 60;
  RodQuestion question = question_of(robot, options, rods);
  for (int k = -1; k < ways && !rods.stop.stop_requested(); ++k) {
    question.warm_start = false;
    if (k >= 0) {  // by a pose between
      const Report between = lengths_for_pose(rods, home, scattered(home, size, k), question);
      if (!between.is_solved()) continue;
      question.warm_start = true;
    }
    const Report report = lengths_for_pose(rods, home, target, question);
    if (!report.is_solved()) continue;
    FoundEquilibrium one = found_equilibrium(report, rods, work);
    if (!is_known(one)) found.push_back(std::move(one));
  }
  std::ranges::sort(found, {}, by_energy);
  return found;
}

}  // namespace sinew::inline v1
