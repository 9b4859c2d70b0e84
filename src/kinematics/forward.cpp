#include "sinew/kinematics/forward.hpp"

#include "kinematics/closing.hpp"
#include "kinematics/modes/four_bars.hpp"
#include "kinematics/modes/hinged_modes.hpp"
#include "kinematics/modes/planar_modes.hpp"
#include "kinematics/modes/three_circles.hpp"
#include "kinematics/reaches.hpp"
#include "robot/arguments.hpp"
#include "robot/pose.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {
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

/// Newton's method from `platform`; of three hinged legs in their angles, half as many unknowns.
Report solve(const Closing<Planar>& closing, std::span<const PlatformConstraint<2>>,
             const NewtonOptions& options, SE2<double>& platform) {
  return newton(closing, platform, options);
}
Report solve(const Closing<Spatial>& closing, std::span<const PlatformConstraint<3>> reaches,
             const NewtonOptions& options, SE3<double>& platform) {
  // a start that is no number is Newton's to refuse
  if (!ThreeCircles::fit(reaches) || !Spatial::is_finite(platform)) return newton(closing, platform, options);
  const ThreeCircles circles(reaches, closing.size(), platform);
  CircleAngles angles = ThreeCircles::start();
  Report report;
  const bool is_plain = options.trace.empty() && options.max_iterations >= ForwardOptions{}.max_iterations;
  if (is_plain) report.iterations = circles.close_from_near(angles);
  if (report.iterations > 0) {
    const SE3<double> reached = circles.platform(angles);
    report.residual = closing.error(reached);
    if (report.residual <= 100 * options.tolerance) {
      platform = reached;
      return report;
    }
  }
  angles = ThreeCircles::start();
  report = newton(circles, angles, options);
  if (report.status == Status::left_domain) return report;
  const SE3<double> reached = circles.platform(angles);
  if (report.iterations > 0 || report.ok()) platform = reached;
  report.residual = closing.error(platform);
  return report;
}

/// Where Newton's method fails there is who knows better, the sextic in the plane, of three hinged legs the
/// polynomial of their circles: every pose there is, or that there is none. The nearest to the start is then
/// the answer.
template <class Modes, class Pose>
void take_nearest(const Modes& modes, const Pose& start, double radius, Pose& pose, Report& report) {
  if (modes.report.status == Status::unreachable) report.status = Status::unreachable;
  if (!modes.ok() || modes.count == 0) return;
  std::size_t best = 0;
  for (std::size_t k = 1; k < static_cast<std::size_t>(modes.count); ++k)
    if (gap(modes.poses[k], start, radius) < gap(modes.poses[best], start, radius)) best = k;
  pose = modes.poses[best];
  report.status = Status::converged;
  report.residual = modes.residual[best];
}

void ask_all_modes(std::span<const PlatformConstraint<2>> reaches, const PlanarPose& start, double radius,
                   PlanarPose& pose, Report& report) {
  if (report.status != Status::stalled && report.status != Status::iteration_limit) return;
  take_nearest(planar_modes(reaches), start, radius, pose, report);
}
// Of other legs in space assembly_modes can, but takes memory and its time.
void ask_all_modes(std::span<const PlatformConstraint<3>> reaches, const SpatialPose& start, double radius,
                   SpatialPose& pose, Report& report) {
  if (report.status != Status::stalled && report.status != Status::iteration_limit) return;
  if (are_hinged(reaches)) take_nearest(hinged_modes(reaches), start, radius, pose, report);
}

template <class LegT>
Forward forward_robot(const ParallelRobot<LegT>& robot, const Robot& any, const ForwardOptions& options,
                      Workspace& work) {
  using Space = typename LegT::Space;
  const auto reaches = reaches_of(robot, work.coordinates);
  const Closing<Space> closing(reaches.view());
  const typename Space::Pose start = options.start ? in_space<Space>(*options.start) : robot.home;
  auto platform = Space::frame(start);
  Report report = solve(
      closing, reaches.view(),
      {.tolerance = 1e-14 * closing.size(), .max_iterations = options.max_iterations, .trace = options.trace},
      platform);
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

/// Rods, or chains, without a load on the platform.
Forward forward_loaded(const Robot& robot, Numbers inputs, const ForwardOptions& options, Workspace& work) {
  EquilibriumOptions unloaded;
  if (options.start)
    unloaded.start =
        robot.planar() ? in_space(in_space<Planar>(*options.start)) : in_space<Spatial>(*options.start);
  const Equilibrium found = equilibrium(robot, inputs, unloaded, work);
  const AnyPose pose = robot.planar() ? AnyPose(in_plane(found.pose)) : AnyPose(found.pose);
  return {found.report, pose, found.coordinates};
}

}  // namespace

Forward forward(const Robot& robot, Numbers inputs, const ForwardOptions& options, Workspace& work) {
  const AnyPose start = options.start.value_or(home(robot));
  if (const Report fits = check_arguments(robot, start, work, "start"); !fits.ok())
    return {fits, home(robot), {}};
  if (bears_load(robot)) return forward_loaded(robot, inputs, options, work);
  const Report commanded = coordinates_from_inputs(robot, inputs, work);
  if (!commanded.ok()) return {commanded, start, work.coordinates};
  return with_legs(robot, [&](const auto& legs) { return forward_robot(legs, robot, options, work); });
}

}  // namespace sinew::inline v1
