#include "sinew/kinematics/forward.hpp"

#include "kinematics/closing.hpp"
#include "kinematics/four_bars.hpp"
#include "kinematics/reaches.hpp"
#include "robot/pose.hpp"
#include "sinew/kinematics/planar_modes.hpp"

namespace sinew::inline v0 {
namespace {

void explain(Report& report, const Reduced& at_end) {
  if (report.status == Status::left_domain) {
    report.message.append("the start is not a number, or too far away to be squared");
    return;
  }
  if (report.status == Status::unreachable) {
    report.message.append("no pose closes the legs with these inputs; at the nearest one found legs[");
    append_number(report.message, at_end.worst_leg);
    report.message.append("] misses by ");
    append_mm(report.message, at_end.closure_error);
    return;
  }
  report.message.append("the legs do not close from this start; legs[");
  append_number(report.message, at_end.worst_leg);
  report.message.append("] misses by ");
  append_mm(report.message, at_end.closure_error);
  report.message.append(report.status == Status::iteration_limit
                            ? "; allow more iterations or start nearer"
                            : "; these inputs may have no pose, or another start finds it");
}

void warn_of_freedom(Report& report, Eigen::Index rows, int dof) {
  report.message.append("the legs hold ");
  append_number(report.message, static_cast<int>(rows));
  report.message.append(" of the platform's ");
  append_number(report.message, dof);
  report.message.append(" freedoms: this is one pose of a continuum, the one the start leads to");
}

/// Where Newton's method fails in the plane the sextic knows better: every pose there is, or that there is
/// none. The nearest to the start is then the answer.
void ask_all_modes(std::span<const Reach<2>> reaches, const PlanarPose& start, double radius,
                   PlanarPose& pose, Report& report) {
  if (report.status != Status::stalled && report.status != Status::iteration_limit) return;
  const PlanarModes modes = planar_modes(reaches);
  if (modes.report.status == Status::unreachable) report.status = Status::unreachable;
  if (!modes.ok() || modes.count == 0) return;
  std::size_t best = 0;
  for (std::size_t k = 1; k < static_cast<std::size_t>(modes.count); ++k)
    if (gap(modes.poses[k], start, radius) < gap(modes.poses[best], start, radius)) best = k;
  pose = modes.poses[best];
  report.status = Status::converged;
  report.residual = modes.residual[best];
}
// In space assembly_modes can, but takes memory and its time.
void ask_all_modes(std::span<const Reach<3>>, const SpatialPose&, double, SpatialPose&, Report&) {}

template <class LegT>
Forward forward_robot(const ParallelRobot<LegT>& robot, const AnyRobot& any, const ForwardOptions& options,
                      Workspace& work) {
  using Space = typename LegT::Space;
  const auto reaches = reaches_of(robot, work.coordinates);
  const Closing<Space> closing(reaches.view());
  const typename Space::Pose start = options.start ? in_space<Space>(*options.start) : robot.home;
  auto platform = Space::frame(start);
  Report report = newton(closing, platform,
                         {.tolerance = 1e-14 * closing.size(),
                          .max_iterations = options.max_iterations,
                          .trace = options.trace});
  typename Space::Pose pose = pose_of(platform);
  // constraints beyond the freedoms need not fit to rounding
  if (closing.rows() > Space::dof && report.residual <= 1e-9 * closing.size())
    report.status = Status::converged;
  // fewer iterations than usual are asked for to see Newton's method
  if (options.max_iterations >= ForwardOptions{}.max_iterations)
    ask_all_modes(reaches.view(), start, robot.platform_radius, pose, report);
  Forward answer{report, pose, work.coordinates};
  if (answer.ok() && closing.rows() < Space::dof) warn_of_freedom(answer.report, closing.rows(), Space::dof);
  if (!answer.ok() && !are_torn(reaches.view(), answer.report))
    explain(answer.report, assemble(any, answer.pose, work.coordinates, work));
  return answer;
}

}  // namespace

Forward forward(const AnyRobot& robot, Numbers inputs, const ForwardOptions& options, Workspace& work) {
  const Report commanded = command(robot, inputs, work);
  if (!commanded.ok()) return {commanded, options.start.value_or(home(robot)), work.coordinates};
  return std::visit([&](const auto& r) { return forward_robot(r, robot, options, work); }, robot.model);
}

}  // namespace sinew::inline v0
