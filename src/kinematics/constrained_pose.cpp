#include "sinew/kinematics/inverse.hpp"

#include <array>
#include <cmath>

#include "base/limits.hpp"
#include "robot/parallel.hpp"
#include "robot/pose.hpp"
#include "solve/newton.hpp"

namespace sinew::inline v1 {
namespace {

/// A plane of the base and the platform point that stays in it.
struct Plane {
  Vec3<double> through, normal, point;
};

struct Planes {
  std::array<Plane, max_rows> data;
  std::size_t count = 0;
  double size = 0;  ///< of the robot [m]

  std::span<const Plane> view() const { return {data.data(), count}; }
};

/// The planes of a robot do not depend on its inputs: a hinge is square to its rail.
Planes planes_of(const Robot& robot) {
  Planes planes;
  if (!robot.is_within_limits()) return planes;
  if (const SpatialRobot* legs = robot.spatial())
    legs->for_each_leg([&]<class L>(const L& leg, const LegPlace&, int) {
      if constexpr (L::has_plane) {
        const auto reach = leg.reach(L::Coordinates::Zero());
        planes.data[planes.count++] = {reach.anchor, reach.normal, reach.platform_point};
        planes.size = std::max(planes.size, leg.size());
      }
    });
  return planes;
}

/// The planes as a function of x, y and an angle ψ by which e₀ and e₃ share what e₁ and e₂ leave.
class Dependent {
 public:
  using Point = Vec3<double>;
  static constexpr int unknowns = 3;

  Dependent(const Planes& planes, const IndependentPose& given)
      : planes_(planes),
        given_(given),
        share_(std::sqrt(std::max(0.0, 1 - given.e1 * given.e1 - given.e2 * given.e2))) {}

  SE3<double> pose(const Point& at) const {
    return {Vec3<double>(at[0], at[1], given_.z),
            {share_ * std::cos(at[2]), Vec3<double>(given_.e1, given_.e2, share_ * std::sin(at[2]))}};
  }

  bool linearise(const Point& at, Linearised<3>& system) const {
    const auto rows = static_cast<Eigen::Index>(planes_.count);
    system.residual.resize(rows);
    system.jacobian.resize(rows, 3);
    system.error = 0;
    const SE3<double> platform = pose(at);
    const double w_rate = -platform.R.v[2];
    const Vec3<double>&v = platform.R.v, v_rate(0, 0, platform.R.w);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Plane& plane = planes_.data[static_cast<std::size_t>(i)];
      const Vec3<double> side = cross(v, plane.point), side_rate = cross(v_rate, plane.point);
      const Vec3<double> turning =  // of R b, with R b = b + 2w v×b + 2v×(v×b)
          2 * (w_rate * side + platform.R.w * side_rate + cross(v_rate, side) + cross(v, side_rate));
      system.residual[i] = dot(plane.normal, platform.point(plane.point) - plane.through);
      system.jacobian.row(i) << plane.normal[0], plane.normal[1], dot(plane.normal, turning) / planes_.size;
      system.error = std::max(system.error, std::abs(system.residual[i]));
    }
    return true;
  }

  Point moved(const Point& from, const Vec3<double>& step) const {
    return {from[0] + step[0], from[1] + step[1], from[2] + step[2] / planes_.size};
  }
  /// At most half a radian a step.
  double shortened(const Vec3<double>& step) const {
    return 1 / std::max(1.0, 2 * std::abs(step[2]) / planes_.size);
  }

 private:
  const Planes& planes_;
  IndependentPose given_;
  double share_;
};

/// The planes as a function of the whole pose.
class Settling {
 public:
  using Point = SE3<double>;
  static constexpr int unknowns = 6;
  explicit Settling(const Planes& planes) : planes_(planes) {}

  bool linearise(const Point& platform, Linearised<6>& system) const {
    const auto rows = static_cast<Eigen::Index>(planes_.count);
    system.residual.resize(rows);
    system.jacobian.resize(rows, 6);
    system.error = 0;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Plane& plane = planes_.data[static_cast<std::size_t>(i)];
      const Vec3<double> b = platform.rotate(plane.point);
      system.residual[i] = dot(plane.normal, platform.p + b - plane.through);
      system.jacobian.row(i) = Spatial::line(plane.normal, b);
      system.jacobian.row(i).tail<3>() /= arm();
      system.error = std::max(system.error, std::abs(system.residual[i]));
    }
    return true;
  }

  Point moved(const Point& platform, Vec<double, 6> step) const {
    step.tail<3>() /= arm();
    return platform.displaced(step);
  }
  /// At most half a radian and half the robot a step.
  double shortened(const Vec<double, 6>& step) const {
    return 1 / std::max({1.0, 2 * step.head<3>().norm() / planes_.size, 2 * step.tail<3>().norm() / arm()});
  }

 private:
  /// A turn counts as if it moved a point this far out: shifts come first.
  double arm() const { return 1e3 * planes_.size; }

  const Planes& planes_;
};

ConstrainedPose refused(std::string_view why) {
  ConstrainedPose answer;
  answer.report.status = Status::left_domain;
  answer.report.message.append(why);
  return answer;
}

}  // namespace

ConstrainedPose constrained_pose(const Robot& robot, const IndependentPose& independent, OperationMode mode) {
  const Planes planes = planes_of(robot);
  if (planes.count != 3)
    return refused(
        "z, e1 and e2 determine the pose of a platform that three hinges hold in planes, and no other");
  if (!std::isfinite(independent.z)) return refused("z is not a finite number");
  if (!(independent.e1 * independent.e1 + independent.e2 * independent.e2 <= 1))
    return refused("e1 and e2 are components of a unit quaternion: their squares sum up to 1 at most");
  const Dependent problem(planes, independent);
  Vec3<double> at(0, 0, mode == OperationMode::tilt ? 0 : std::numbers::pi / 2);
  ConstrainedPose answer;
  answer.report = newton(problem, at, {.tolerance = 1e-16 * planes.size});
  // e₁ and e₂ as asked for: of a half turn, rounding would choose the sign of the quaternion
  const auto [p, R] = problem.pose(at);
  answer.pose = {p, {R.w, R.v[0], R.v[1], R.v[2]}};
  if (!answer.ok()) {
    answer.report.status = Status::stalled;
    answer.report.message.append(
        "no pose found with these z, e1 and e2 that keeps every platform point in the plane of its hinge");
  }
  return answer;
}

AnyPose project_to_constraints(const Robot& robot, const AnyPose& pose) {
  if (plane_count(robot) == 0 || !std::holds_alternative<SpatialPose>(pose)) return pose;
  const Planes planes = planes_of(robot);
  SE3<double> platform = SE3<double>::from(in_space<Spatial>(pose));
  newton(Settling(planes), platform, {.tolerance = 1e-16 * planes.size, .max_iterations = 50});
  return spatial_pose(platform);
}

}  // namespace sinew::inline v1
