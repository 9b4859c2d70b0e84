/// Equilibria along a path of commands, loads or poses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/question_check.hpp"
#include "kinematics/arm_legs/search/continuation.hpp"
#include "kinematics/arm_legs/search/search.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {
namespace {

/// Commands of tendons that do not pull, of the quantities that the step prescribes.
std::vector<TendonCommand> unpulled(const ArmLegs& robot, const ArmLegsStep& step) {
  std::vector<TendonCommand> commands(robot.tendons());
  if (!step.pose)
    for (std::size_t i = 0; i < commands.size(); ++i) commands[i].held = step.commands[i].held;
  return commands;
}

/// From the workspace's equilibrium to a step.
class WayTo {
 public:
  WayTo(const ArmLegs& robot, const ArmLegsStep& step, const ArmGroup& group)
      : robot_(robot),
        step_(step),
        loads_(group.loads()),
        platform_(group.platform()) {
    const ArmGroup::Wrench wrench = group.wrench();
    std::copy(wrench.begin(), wrench.end(), wrench_.begin());
    for (std::size_t i = 0; i < step.commands.size(); ++i)
      values_.push_back(group.value_of(static_cast<int>(i), step.commands[i].held));
    if (step.pose) way_ = twist_between(platform_, *step.pose);
  }
  ArmLegsLoad load(double share) const {
    ArmLegsLoad load;
    for (std::size_t i = 0; i < 6; ++i) load.wrench[i] = std::lerp(wrench_[i], step_.load.wrench[i], share);
    const LegsLoads to = LegsProblem(robot_, {}, step_.load).loads;
    LegsLoads at_share = mix(loads_, to, share);
    load.gravity = at_share.gravity;
    load.along = at_share.along;
    load.following = at_share.following;
    load.following_along = at_share.following_along;
    load.points = std::move(at_share.points);
    return load;
  }
  std::vector<TendonCommand> commands(double share) const {
    std::vector<TendonCommand> commands = step_.commands;
    for (std::size_t i = 0; i < commands.size(); ++i)
      commands[i].value = std::lerp(values_[i], commands[i].value, share);
    return commands;
  }
  ArmTarget target(double share) const {
    const SE3<double> pose = displaced_by_share(platform_, way_, share);
    return {.position = std::array<double, 3>{pose.p[0], pose.p[1], pose.p[2]},
            .quaternion = spatial_pose(pose).quaternion};
  }

 private:
  const ArmLegs& robot_;
  const ArmLegsStep& step_;
  LegsLoads loads_;
  SE3<double> platform_;
  std::array<double, 6> wrench_{};
  std::vector<double> values_;  ///< of what the step prescribes of each tendon, where the way begins
  Vec<double, 6> way_ = Vec<double, 6>::Zero();
};

/// Of the first step that does not fit.
Report steps_misfit(const ArmLegs& robot, std::span<const ArmLegsStep> steps, const ArmOptions& options,
                    const ArmLegsWorkspace& work) {
  const std::vector<TendonCommand> loose(robot.tendons());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const ArmLegsStep& step = steps[k];
    Report misfit = legs_misfit(robot, step.pose ? loose : step.commands, step.load, options, work);
    const auto bad = [&](std::string_view words) {
      if (misfit.ok() && !words.empty()) misfit = {Status::bad_input, 0, 0, FixedText<240>(words)};
    };
    if (step.divisions < 1) bad("its way has less than one division");
    if (step.pose) bad(pose_misfit(robot, *step.pose, "its pose"));
    if (misfit.ok()) continue;
    misfit.message = FixedText<240>(fmt::format("step {}: {}", k + 1, misfit.message.view()));
    return misfit;
  }
  return {Status::converged, 0, 0, {}};
}

}  // namespace

std::vector<ArmLegsState> arm_legs_track(const ArmLegs& robot, std::span<const ArmLegsStep> steps,
                                         const ArmInverseOptions& options, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  std::vector<ArmLegsState> points;
  const auto end = [&](Report report) {
    points.push_back(impl.state);
    points.back().report = report;
    return points;
  };
  if (const Report misfit = steps_misfit(robot, steps, options.arm, work); !misfit.ok()) {
    refuse_question(misfit, work);
    return end(misfit);
  }
  if (steps.empty()) return points;
  ArmInverseOptions each = options;
  each.starts = 1;
  if (!each.arm.from_last || !impl.has_last()) {
    ArmLegsLoad weight;
    weight.gravity = steps.front().load.gravity;
    each.arm.from_last = false;
    solve_legs(robot, {robot, unpulled(robot, steps.front()), weight}, each.arm, work);
    if (!impl.has_last()) return end(impl.state.report);
  }
  each.arm.from_last = true;
  for (const ArmLegsStep& step : steps) {
    const WayTo way(robot, step, impl.group());
    for (int part = 1; part <= step.divisions; ++part) {
      const double share = static_cast<double>(part) / step.divisions;
      Report report;
      if (step.pose) {
        report = arm_legs_inverse(robot, way.target(share), way.load(share), each, work).report;
      } else {
        solve_legs(robot, {robot, way.commands(share), way.load(share)}, each.arm, work, LegsEnd::on_the_way);
        report = impl.state.report;
      }
      if (!report.ok()) return end(report);
      points.push_back(impl.state);
      points.back().report = report;
    }
  }
  return points;
}

}  // namespace sinew::inline v1
