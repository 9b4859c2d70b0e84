/// Equilibria under commands and loads, of a free platform and at a prescribed pose.
#include <algorithm>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/question_check.hpp"
#include "kinematics/arm_legs/search/search.hpp"

namespace sinew::inline v1 {

const ArmLegsState& arm_legs_forward(const ArmLegs& robot, std::span<const TendonCommand> commands,
                                     const ArmLegsLoad& load, const ArmOptions& options,
                                     ArmLegsWorkspace& work) {
  if (const Report misfit = legs_misfit(robot, commands, load, options, work); !misfit.ok())
    return refuse_question(misfit, work);
  solve_legs(robot, {robot, commands, load}, options, work);
  return work.impl().state;
}

ArmLegsHeld arm_legs_hold(const ArmLegs& robot, const SE3<double>& pose,
                          std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                          const ArmOptions& options, ArmLegsWorkspace& work) {
  ArmLegsHeld answer;
  Report misfit = legs_misfit(robot, commands, load, options, work);
  if (const auto text = pose_misfit(robot, pose, "the pose"); misfit.ok() && !text.empty())
    misfit = {Status::bad_input, 0, 0, FixedText<240>(text)};
  if (!misfit.ok()) {
    answer.state = refuse_question(misfit, work);
    return answer;
  }
  LegsProblem problem(robot, commands, load);
  problem.prescribed_pose = pose;
  solve_legs(robot, problem, options, work);
  answer.state = work.impl().state;
  if (!answer.state.report.ok()) return answer;
  const ArmGroup::Wrench wrench = work.impl().group().wrench() - problem.wrench;
  std::copy(wrench.begin(), wrench.end(), answer.wrench.begin());
  return answer;
}

}  // namespace sinew::inline v1
