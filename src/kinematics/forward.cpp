#include "sinew/kinematics/forward.hpp"

#include <array>
#include <cmath>

#include "kinematics/four_bars.hpp"
#include "kinematics/reaches.hpp"
#include "robot/pose.hpp"
#include "sinew/kinematics/planar_modes.hpp"
#include "sinew/solve/newton.hpp"

namespace sinew::inline v0 {
namespace {

/// The closures as a function of the platform pose. The links are shaped by the inputs alone: of each leg a
/// reach is left. The unknowns are lengths, turns times the robot's size: so the answer does not depend on
/// the unit of length, also where the shortest of many steps is taken.
template <class Space>
class Closing {
 public:
  using Point = typename Space::Pose;
  static constexpr int unknowns = Space::dof;
  static constexpr int D = Space::dimension;

  explicit Closing(std::span<const Reach<D>> reaches) : reaches_(reaches) {
    for (const Reach<D>& leg : reaches) {
      size_ = std::max(size_, leg.anchor.norm() + leg.platform_point.norm() + 2 * leg.distance);
      rows_ += leg.distance > 0 ? 1 : D;
    }
  }

  bool linearise(const Point& pose, Linearised<unknowns>& system) const {
    const auto platform = Space::frame(pose);
    system.residual.resize(rows_);
    system.jacobian.resize(rows_, unknowns);
    system.error = 0;
    Eigen::Index row = 0;
    for (const Reach<D>& leg : reaches_) {
      const Vec<double, D> b = platform.rotate(leg.platform_point);
      const Vec<double, D> n = platform.p + b - leg.anchor;
      const double length = n.norm();
      const auto put = [&](double residual, const Vec<double, D>& direction) {
        system.residual[row] = residual;
        system.jacobian.row(row) = Space::line(direction, b);
        system.jacobian.row(row++).template tail<unknowns - D>() /= size_;
      };
      system.error = std::max(system.error, std::abs(length - leg.distance));
      if (leg.distance > 0) {
        put(0.5 * (length - leg.distance) * (length + leg.distance), n);
      } else {
        for (int k = 0; k < D; ++k) put(n[k], Vec<double, D>(Vec<double, D>::Unit(k)));
      }
    }
    return true;
  }

  Point moved(const Point& pose, Vec<double, unknowns> step) const {
    step.template tail<unknowns - D>() /= size_;
    return Space::moved(pose, step);
  }

  /// At most half a radian and half the robot a step: Newton's model of the closures holds no further.
  double shortened(const Vec<double, unknowns>& step) const {
    const double shift = step.template head<D>().norm();
    const double turn = step.template tail<unknowns - D>().norm() / size_;
    return 1 / std::max({1.0, 2 * turn, 2 * shift / size_});
  }

  double size() const { return size_; }
  Eigen::Index rows() const { return rows_; }

 private:
  std::span<const Reach<D>> reaches_;
  Eigen::Index rows_ = 0;
  double size_ = 0;
};

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
void ask_all_modes(std::span<const Reach<2>> reaches, const PlanarPose& start, double size, PlanarPose& pose,
                   Report& report) {
  if (report.status != Status::stalled && report.status != Status::iteration_limit) return;
  const PlanarModes modes = planar_modes(reaches);
  if (modes.report.status == Status::unreachable) report.status = Status::unreachable;
  if (!modes.ok() || modes.count == 0) return;
  std::size_t best = 0;
  const auto gap = [&](std::size_t k) {
    const PlanarPose& mode = modes.poses[k];
    return std::hypot(mode.x - start.x, mode.y - start.y, size * wrap_angle(mode.phi - start.phi));
  };
  for (std::size_t k = 1; k < static_cast<std::size_t>(modes.count); ++k)
    if (gap(k) < gap(best)) best = k;
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
  typename Space::Pose pose = start;
  Report report = newton(closing, pose,
                         {.tolerance = 1e-14 * closing.size(),
                          .max_iterations = options.max_iterations,
                          .trace = options.trace});
  // constraints beyond the freedoms need not fit to rounding
  if (closing.rows() > Space::dof && report.residual <= 1e-9 * closing.size())
    report.status = Status::converged;
  // fewer iterations than usual are asked for to see Newton's method
  if (options.max_iterations >= ForwardOptions{}.max_iterations)
    ask_all_modes(reaches.view(), start, robot.platform_radius, pose, report);
  Forward answer{report, Space::tidy(pose), work.coordinates};
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
