/// @file distance_closing.hpp
/// The closures |p + R b − A| = D of all legs as a problem for Newton's method.
#pragma once
#include <span>

#include "sinew/leg/reach.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/solve/newton.hpp"

namespace sinew::inline v0::detail {

class DistanceClosing {
 public:
  using Point = SE3<double>;
  static constexpr int unknowns = 6;

  /// @param size a length of the robot, by which steps are limited [m]
  DistanceClosing(std::span<const Reach<3>> legs, double size) : legs_(legs), size_(size) {}

  bool linearise(const Point& pose, Linearised<6>& system) const {
    const auto rows = static_cast<Eigen::Index>(legs_.size());
    system.residual.resize(rows);
    system.jacobian.resize(rows, 6);
    system.error = 0;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Reach<3>& leg = legs_[static_cast<std::size_t>(i)];
      const Vec3<double> arm = pose.rotate(leg.platform_point), strut = pose.p + arm - leg.anchor;
      const double reached = strut.norm(), miss = reached - leg.distance;
      system.residual[i] = 0.5 * miss * (reached + leg.distance);
      system.jacobian.row(i) << strut.transpose(), cross(arm, strut).transpose();
      system.error = std::max(system.error, std::abs(miss));
    }
    return true;
  }

  Point moved(const Point& pose, const Vec<double, 6>& step) const { return pose.displaced(step); }
  double shortened(const Vec<double, 6>& step) const {
    return 1 / std::max({1.0, 2 * step.tail<3>().norm(), 2 * step.head<3>().norm() / size_});
  }

 private:
  std::span<const Reach<3>> legs_;
  double size_;
};

}  // namespace sinew::inline v0::detail
