#include "sinew/kinematics/forward.hpp"

#include <array>
#include <cmath>

#include "robot/pose.hpp"
#include "sinew/solve/newton.hpp"

namespace sinew::inline v0 {
namespace {

/// The closures as a function of the platform pose. The links are shaped by the inputs alone, so their tips
/// are computed once.
template <class LegT>
class Closing {
 public:
  using Space = typename LegT::Space;
  using Point = typename Space::Pose;
  using Tip = decltype(std::declval<const LegT&>().tip(0.0));
  static constexpr int unknowns = Space::dof;

  Closing(const ParallelRobot<LegT>& robot, Numbers coordinates) : robot_(robot) {
    for (std::size_t i = 0; i < robot.legs.size(); ++i) {
      tips_[i] = robot.legs[i].tip(coordinates[i]);
      const double extent = with_leg(robot.legs[i], [&](const auto& leg) {
        return leg.base.p.norm() + leg.platform_point.norm() + tips_[i].position.norm() +
               std::sqrt(2 * leg.closure.anchor(tips_[i]).half_square);
      });
      size_ = std::max(size_, extent);
    }
  }

  bool linearise(const Point& pose, Linearised<unknowns>& system) const {
    const auto platform = Space::frame(pose);
    system.residual.resize(robot_.row_count());
    system.jacobian.resize(robot_.row_count(), unknowns);
    system.error = 0;
    for (std::size_t i = 0; i < robot_.legs.size(); ++i) {
      const auto blocks = with_leg(
          robot_.legs[i], [&](const auto& leg) { return leg.template blocks<double>(platform, tips_[i]); });
      const auto row = static_cast<Eigen::Index>(i);
      system.residual[row] = blocks.g;
      system.jacobian.row(row) = blocks.g_x;
      system.error = std::max(system.error, std::abs(blocks.error));
    }
    return true;
  }

  Point moved(const Point& pose, const Vec<double, unknowns>& step) const { return Space::moved(pose, step); }

  /// At most half a radian and half the robot a step: Newton's model of the closures holds no further.
  double shortened(const Vec<double, unknowns>& step) const {
    const double shift = step.template head<Space::dimension>().norm();
    const double turn = step.template tail<unknowns - Space::dimension>().norm();
    return 1 / std::max({1.0, 2 * turn, 2 * shift / size_});
  }

  double size() const { return size_; }

 private:
  const ParallelRobot<LegT>& robot_;
  std::array<Tip, max_rows> tips_;
  double size_ = 0;
};

/// Anchor A, distance D and platform point of each leg: what the inputs leave of it.
struct Reach {
  Vec2<double> anchor;
  double distance;
  Vec2<double> platform_point;
};

template <class LegT>
Reach reach_of(const LegT& any, double q) {
  return with_leg(any, [&](const auto& leg) {
    const auto anchor = leg.closure.anchor(leg.tip(q));
    return Reach{leg.base.point(anchor.position), std::sqrt(2 * anchor.half_square), leg.platform_point};
  });
}

/// Two legs and the platform between them are a chain of four bars from anchor to anchor: it closes only if
/// no bar is longer than the other three together. True, with the reason, where two legs prove that no pose
/// exists.
template <class LegT>
bool is_unreachable(const ParallelRobot<LegT>& robot, Numbers coordinates, Report& report) {
  for (std::size_t j = 1; j < robot.legs.size(); ++j) {
    const Reach b = reach_of(robot.legs[j], coordinates[j]);
    for (std::size_t i = 0; i < j; ++i) {
      const Reach a = reach_of(robot.legs[i], coordinates[i]);
      const double base = (b.anchor - a.anchor).norm(), bar = (b.platform_point - a.platform_point).norm();
      const double longest = std::max({base, bar, a.distance, b.distance});
      const double excess = 2 * longest - (base + bar + a.distance + b.distance);
      if (excess <= 1e-12 * longest) continue;
      report.status = Status::unreachable;
      report.message.append("no pose closes legs[");
      append_number(report.message, static_cast<int>(i));
      report.message.append("] and legs[");
      append_number(report.message, static_cast<int>(j));
      report.message.append("] together: with these inputs a gap of ");
      append_mm(report.message, excess);
      report.message.append(" always remains");
      return true;
    }
  }
  return false;
}

void explain(Report& report, const Reduced& at_end) {
  if (report.status == Status::left_domain) {
    report.message.append("the start is not a number, or too far away to be squared");
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

template <class LegT>
Forward forward_robot(const ParallelRobot<LegT>& robot, const AnyRobot& any, const ForwardOptions& options,
                      Workspace& work) {
  using Space = typename LegT::Space;
  const Closing<LegT> closing(robot, work.coordinates);
  typename Space::Pose pose = options.start ? in_space<Space>(*options.start) : robot.home;
  Forward answer{newton(closing, pose,
                        {.tolerance = 1e-14 * closing.size(),
                         .max_iterations = options.max_iterations,
                         .trace = options.trace}),
                 Space::tidy(pose), work.coordinates};
  if (!answer.ok() && !is_unreachable(robot, work.coordinates, answer.report))
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
