/// @file three_circles.hpp
/// Three hinged legs: each platform point moves on a circle about its hinge, and the platform fits where the
/// three points are as far apart as on it. Theory: docs/theory/tripod_rigid.md
#pragma once
#include <array>
#include <span>

#include "leg/platform_constraint.hpp"
#include "sinew/math/se3.hpp"
#include "solve/newton.hpp"

namespace sinew::inline v1 {

/// Where the three points are on their circles, (cos, sin) each.
using CircleAngles = std::array<Vec2<double>, 3>;

/// The three sides of the platform as a function of the three angles: a problem for Newton's method with half
/// the unknowns of the pose.
class ThreeCircles {
 public:
  using Point = CircleAngles;
  static constexpr int unknowns = 3;

  /// Whether the legs are three with a plane each.
  static bool fit(std::span<const PlatformConstraint<3>> legs) {
    const auto is_circle = [](const PlatformConstraint<3>& leg) {
      return leg.distance > 0 && leg.has_plane();
    };
    return legs.size() == 3 && is_circle(legs[0]) && is_circle(legs[1]) && is_circle(legs[2]);
  }

  /// @param size of the robot [m]: a length to compare errors with
  /// @param towards where the angles count from: each towards the platform point there
  ThreeCircles(std::span<const PlatformConstraint<3>> legs, double size, const SE3<double>& towards)
      : size_(size) {
    for (std::size_t i = 0; i < 3; ++i) {
      const PlatformConstraint<3>& leg = legs[i];
      const Vec3<double>& u = leg.normal;
      const Vec3<double> w = towards.point(leg.platform_point) - leg.anchor;
      Vec3<double> side = w - dot(u, w) * u;
      double square = squared_norm(side);
      if (!(square > 1e-12 * squared_norm(w))) {  // on the axis of the hinge: any direction
        side = std::abs(u.z()) < 0.9 ? Vec3<double>(-u.y(), u.x(), 0) : Vec3<double>(0, -u.z(), u.y());
        square = squared_norm(side);
      }
      centre_[i] = leg.anchor;
      x_[i] = side * (leg.distance / std::sqrt(square));
      y_[i] = cross(u, x_[i]);
      body_[i] = leg.platform_point;
    }
    for (std::size_t k = 0; k < 3; ++k) forms_[k] = side_form(k, legs[k].distance, legs[next(k)].distance);
  }

  /// The angles of the platform that the circles were made towards.
  static Point start() { return {Vec2<double>(1, 0), Vec2<double>(1, 0), Vec2<double>(1, 0)}; }

  Vec3<double> point(std::size_t i, const Vec2<double>& at) const {
    return centre_[i] + x_[i] * at[0] + y_[i] * at[1];
  }

  /// The platform with its points there, exactly where its sides fit.
  SE3<double> platform(const Point& at) const {
    const std::array<Vec3<double>, 3> points{point(0, at[0]), point(1, at[1]), point(2, at[2])};
    const SO3<double> R = SO3<double>::from(Mat<double, 3, 3>(triad(points) * triad(body_).transpose()));
    const Vec3<double> middle = (points[0] + points[1] + points[2]) * (1.0 / 3),
                       own = (body_[0] + body_[1] + body_[2]) * (1.0 / 3);
    return {middle - R.rotate(own), R};
  }

  bool linearise(const Point& at, Linearised<3>& system) const {
    system.residual.resize(3);
    system.jacobian.resize(3, 3);
    system.error = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Side side = side_at(k, at);
      const auto row = static_cast<Eigen::Index>(k), other = static_cast<Eigen::Index>(next(k));
      system.residual[row] = side.g;
      system.jacobian(row, row) = side.by_own;
      system.jacobian(row, other) = side.by_next;
      system.jacobian(row, 3 - row - other) = 0;
      const double length = std::sqrt(std::max(0.0, forms_[k].square + 2 * side.g));
      system.error = std::max(system.error, std::abs(2 * side.g) / (length + std::sqrt(forms_[k].square)));
    }
    return true;
  }

  /// Newton's method from a start near by, without a line search: the number of its steps; −1, and `at` left
  /// alone, where it is not quadratic at once.
  int close_from_near(Point& at) const {
    Point here = at;
    double before = 0.04;  // of a first step: within 0.2 rad
    for (int steps = 1; steps < 8; ++steps) {
      const Side s0 = side_at(0, here), s1 = side_at(1, here), s2 = side_at(2, here);
      const double pair = s1.by_own * s2.by_own;
      const double scale = -1 / (s0.by_own * pair + s0.by_next * s1.by_next * s2.by_next);
      const double cross0 = s0.g * pair - s0.by_next * (s1.g * s2.by_own - s1.by_next * s2.g);
      const Vec3<double> step(
          cross0 * scale,
          (s1.g * s2.by_own * s0.by_own - s1.by_next * (s2.g * s0.by_own - s2.by_next * s0.g)) * scale,
          (s2.g * s0.by_own * s1.by_own - s2.by_next * (s0.g * s1.by_own - s0.by_next * s1.g)) * scale);
      const double square = squared_norm(step);
      if (!(square < before)) return -1;
      here = moved(here, step);
      if (square < 1e-15) {  // the next step would be of the size of this one's square
        at = here;
        return steps;
      }
      before = 0.1 * square;
    }
    return -1;
  }

  /// Turned by 2 atan(½ step): by the step to third order, without a sine.
  Point moved(const Point& from, const Vec3<double>& step) const {
    Point to;
    for (std::size_t i = 0; i < 3; ++i) {
      const double t = 0.5 * step[static_cast<Eigen::Index>(i)], scale = 1 / (1 + t * t);
      const double c = (1 - t) * (1 + t) * scale, s = 2 * t * scale;
      to[i] = {c * from[i][0] - s * from[i][1], s * from[i][0] + c * from[i][1]};
    }
    return to;
  }

  /// At most half a radian a step.
  double shortened(const Vec3<double>& step) const {
    return 1 / std::max(1.0, 2 * step.cwiseAbs().maxCoeff());
  }

  double size() const { return size_; }

  /// ½(|Pᵢ − Pⱼ|² − side²) = (1, cᵢ, sᵢ)·M·(1, cⱼ, sⱼ)ᵀ for j after i in the cycle [m²].
  const Mat<double, 3, 3>& form(std::size_t i) const { return forms_[i].M; }

  static constexpr std::size_t next(std::size_t i) { return i == 2 ? 0 : i + 1; }

 private:
  struct Form {
    Mat<double, 3, 3> M;
    double square;  ///< of the platform's side
  };
  /// ½(|Pₖ − Pₖ₊₁|² − side²) and its rates by the two angles.
  struct Side {
    double g, by_own, by_next;
  };

  Side side_at(std::size_t k, const Point& at) const {
    const Mat<double, 3, 3>& M = forms_[k].M;
    const double c = at[k][0], s = at[k][1], cn = at[next(k)][0], sn = at[next(k)][1];
    const double one = M(0, 0) + M(0, 1) * cn + M(0, 2) * sn, by_c = M(1, 0) + M(1, 1) * cn + M(1, 2) * sn,
                 by_s = M(2, 0) + M(2, 1) * cn + M(2, 2) * sn;
    const double by_cn = M(0, 1) + M(1, 1) * c + M(2, 1) * s, by_sn = M(0, 2) + M(1, 2) * c + M(2, 2) * s;
    return {one + by_c * c + by_s * s, by_s * c - by_c * s, by_sn * cn - by_cn * sn};
  }

  Form side_form(std::size_t i, double radius, double next_radius) const {
    const std::size_t j = next(i);
    const Vec3<double> gap = centre_[i] - centre_[j];
    const double square = squared_norm(body_[i] - body_[j]);
    Form form{{}, square};
    form.M << 0.5 * (squared_norm(gap) + radius * radius + next_radius * next_radius - square),
        -dot(gap, x_[j]), -dot(gap, y_[j]),                       //
        dot(gap, x_[i]), -dot(x_[i], x_[j]), -dot(x_[i], y_[j]),  //
        dot(gap, y_[i]), -dot(y_[i], x_[j]), -dot(y_[i], y_[j]);
    return form;
  }

  /// Axes of a triangle: along its first side, in its plane, and normal to it.
  static Mat<double, 3, 3> triad(const std::array<Vec3<double>, 3>& points) {
    const Vec3<double> first = points[1] - points[0], normal = cross(first, points[2] - points[0]);
    const Vec3<double> x = first * (1 / std::sqrt(squared_norm(first))),
                       z = normal * (1 / std::sqrt(squared_norm(normal)));
    Mat<double, 3, 3> axes;
    axes << x, cross(z, x), z;
    return axes;
  }

  std::array<Vec3<double>, 3> centre_, x_, y_, body_;  // x, y: axes of the circles times their radius
  std::array<Form, 3> forms_;
  double size_;
};

}  // namespace sinew::inline v1
