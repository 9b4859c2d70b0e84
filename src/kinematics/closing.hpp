/// What is left of a robot once its links are shaped, as a problem for Newton's method.
#pragma once
#include <span>

#include "leg/platform_constraint.hpp"
#include "leg/space.hpp"
#include "solve/newton.hpp"

namespace sinew::inline v1 {

/// The closures as a function of the platform pose. The links are shaped by the inputs alone: of each leg a
/// reach is left. The unknowns are lengths, turns times the robot's size: so the answer does not depend on
/// the unit of length, also where the shortest of many steps is taken.
template <class Space>
class Closing {
 public:
  using Point = typename Space::template Frame<double>;
  static constexpr int unknowns = Space::dof;
  static constexpr int D = Space::dimension;

  explicit Closing(std::span<const PlatformConstraint<D>> reaches) : reaches_(reaches) {
    for (const PlatformConstraint<D>& leg : reaches) {
      size_ = std::max(size_, leg.anchor.norm() + leg.platform_point.norm() + 2 * leg.distance);
      rows_ += leg.rows();
    }
  }

  bool linearise(const Point& platform, Linearised<unknowns>& system) const {
    system.residual.resize(rows_);
    system.jacobian.resize(rows_, unknowns);
    system.error = 0;
    Eigen::Index row = 0;
    for (const PlatformConstraint<D>& leg : reaches_) {
      const Vec<double, D> b = platform.rotate(leg.platform_point);
      const Vec<double, D> n = platform.p + b - leg.anchor;
      system.error = std::max(system.error, leg.closure_error(n));
      leg.with_rows(n, [&](const auto& held) {
        for (Eigen::Index k = 0; k < held.g.size(); ++k, ++row) {
          const double unit = k > 0 && leg.has_plane() ? size_ : 1;  // of the size of the others
          system.residual[row] = unit * held.g[k];
          system.jacobian.row(row) = unit * Space::line(Vec<double, D>(held.direction.col(k)), b);
          system.jacobian.row(row).template tail<unknowns - D>() /= size_;
        }
      });
    }
    return true;
  }

  /// Largest distance by which a leg fails to close [m].
  double error(const Point& platform) const {
    double worst = 0;
    for (const PlatformConstraint<D>& leg : reaches_)
      worst = std::max(worst, leg.closure_error(platform.point(leg.platform_point) - leg.anchor));
    return worst;
  }

  Point moved(const Point& platform, Vec<double, unknowns> step) const {
    step.template tail<unknowns - D>() /= size_;
    return platform.displaced(step);
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
  std::span<const PlatformConstraint<D>> reaches_;
  Eigen::Index rows_ = 0;
  double size_ = 0;
};

}  // namespace sinew::inline v1
