#include "sinew/kinematics/equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/chains/questions.hpp"
#include "kinematics/rods/question.hpp"
#include "kinematics/rods/sense.hpp"
#include "kinematics/rods/verdict.hpp"
#include "robot/arguments.hpp"

namespace sinew::inline v1 {
namespace {

/// From the state the rods are in, at other inputs at once: as neighbour of the last answer. False, with the
/// state as it was, where that does not lead there.
bool resume_sensing(RodWork& rods, Numbers inputs, RodSensing& sensing, Report& report) {
  RodGroup& system = *rods.system;
  if (!rods.is_solved || inputs.size() != at(system.inputs())) return false;
  for (int k = 0; k < system.feeds(); ++k)
    if (!system.in_domain(k, inputs[at(system.input_of(k))])) return false;
  system.save(rods.before);
  system.set_inputs(inputs);
  report = sense_rods(rods, sensing);
  if (report.ok()) return true;
  system.restore(rods.before);
  system.evaluate();
  rods.is_solved = system.linearise();
  return false;
}

}  // namespace

SensedWrench sense_wrench(const Robot& robot, Numbers inputs, Numbers axial, Numbers deviations,
                          const EquilibriumOptions& options, Workspace& work) {
  if (has_chains(robot)) return sense_wrench_of_chains(robot, inputs, axial, deviations, options, work);
  SensedWrench sensed{};
  const auto is_number = [](double x) { return std::isfinite(x); };
  const bool has_six = robot.rod_count() == 6 && leg_count(robot) == 6;
  if (!has_six || axial.size() != 6 || deviations.size() != 6 || !std::ranges::all_of(axial, is_number) ||
      !std::ranges::all_of(deviations, is_number)) {
    sensed.report = failed(has_six ? Status::bad_input : Status::unsupported);
    sensed.report.message.append("a wrench has six parts: six rods are needed, with a force of each");
    return sensed;
  }
  if (const Report fits = check_workspace(robot, work); !fits.ok()) {
    sensed.report = fits;
    return sensed;
  }
  RodWork& rods = rods_of(work);
  EquilibriumOptions unloaded = options;
  unloaded.wrench.setZero();
  const SpatialWrench weight = question_of(robot, unloaded, rods).wrench;
  RodSensing sensing;
  std::ranges::copy(axial, sensing.axial.begin());
  sensing.max_iterations = options.max_iterations.value_or(sensing.max_iterations);
  sensing.truncation = coarse_truncation;
  if (options.warm_start && resume_sensing(rods, inputs, sensing, sensed.report)) {
    sensed.report = settle(rods, sensed.report, sensing.truncation);
  } else {
    unloaded.warm_start = false;
    const Equilibrium begun = equilibrium(robot, inputs, unloaded, work);
    sensed.report = begun.report;
    if (!begun.is_solved()) return sensed;
    sensing.truncation = rods.system->traits().best_truncation;
    sensed.report = sense_rods(rods, sensing);
    if (sensed.report.ok()) sensed.report = settle(rods, sensed.report, sensing.truncation);
  }
  rods.is_solved = sensed.report.is_solved();
  if (!rods.is_solved) return sensed;
  sensed.pose = spatial_pose(rods.system->platform());
  sensed.wrench = rods.system->wrench() - weight;
  std::copy_n(sensing.rows.data(), 36, sensed.sensitivity.begin());
  std::copy_n(covariance_of<6>(sensing.rows, deviations).data(), 36, sensed.covariance.begin());
  return sensed;
}

}  // namespace sinew::inline v1
