/// @file homotopy.hpp
/// Follows a solution x(t) of homogeneous equations H(x, t) = 0 through the complex numbers, and finds its
/// limit where solutions merge. It has never heard of a robot. Theory: docs/theory/spatial_modes.md
#pragma once
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <concepts>
#include <numbers>

#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

using Complex = std::complex<double>;

/// N unknowns, N − 1 equations homogeneous in them: the last row of `jacobian` is left to the path, which
/// closes the system with a patch. H must be analytic in t: paths are followed around points, too.
template <class H>
concept Homotopy = requires(const H& h, const Vec<Complex, H::unknowns>& x, Complex t,
                            Mat<Complex, H::unknowns, H::unknowns>& jacobian,
                            Vec<Complex, H::unknowns>& column) {
  h.linearise(x, t, jacobian, column);                 // ∂H/∂x and H
  h.rate(x, t, column);                                // ∂H/∂t
  { h.finiteness(x) } -> std::convertible_to<double>;  // 0 at infinity, the same for all λx
};

struct PathOptions {
  double tolerance = 1e-3;  ///< prediction error of an accepted step, relative to |x|
  double shortest = 1e-9;   ///< a path that needs a shorter step in t is given up
  int max_steps = 2000;     ///< of one path, all its segments together
};

/// A point x on the curve at time t. x is one of the representatives λx of a projective point: that with
/// u·x = 1 for a fixed patch u, so that solutions at infinity are points like any other.
template <Homotopy H>
class Path {
 public:
  static constexpr int N = H::unknowns;
  using Point = Vec<Complex, N>;

  Path(const H& equations, const Point& start, Complex time, const PathOptions& options = {})
      : equations_(equations),
        options_(options),
        x_(start),
        time_(time) {
    centre();
  }

  const Point& point() const { return x_; }
  Complex time() const { return time_; }
  int steps() const { return steps_; }

  /// The patch on which the present point has norm 1. The past was on another one and is forgotten.
  void centre() {
    x_ /= x_.norm();
    patch_ = x_.conjugate();
    has_tangent_ = has_past_ = false;
  }

  /// Follows the path along a straight line in t; false, with the path where it got to, where steps become
  /// too short or too many.
  bool advance(Complex to) {
    const double shortest = std::min(options_.shortest, 1e-3 * std::abs(to - time_));
    while (time_ != to) {
      if (++steps_ > options_.max_steps || !(stride_ >= shortest)) return false;
      const double left = std::abs(to - time_);
      const bool last = stride_ >= left;
      const Complex ahead = last ? to : time_ + (to - time_) * (stride_ / left);
      if (!has_tangent_ && !find_tangent()) return false;
      if (!step(ahead)) continue;
      if (x_.norm() > 30) centre();
    }
    return true;
  }

  /// Newton at the present time to the last digits; false where the Jacobian is singular within `threshold`
  /// (ratio of smallest to largest pivot) or the iteration does not settle.
  bool refine(double threshold = 1e-9) {
    for (int i = 0; i < 6; ++i) {
      const double correction = newton(x_, time_);
      if (!(pivot_ratio() > threshold)) return false;
      if (correction < 1e-11) return true;  // rounding at an ill-conditioned point is of this order
    }
    return false;
  }

  /// Once around `centre`, from the present time back to it, adding the points met to `sum`.
  bool turn_around(Complex centre, int points, Point& sum) {
    const Complex start = time_, arm = time_ - centre;
    for (int i = 1; i <= points; ++i) {
      sum += x_;
      const double angle = 2 * std::numbers::pi * i / points;
      if (!advance(i == points ? start : centre + arm * std::polar(1.0, angle))) return false;
    }
    return true;
  }

 private:
  using Matrix = Mat<Complex, N, N>;

  /// One Newton correction of x, its length relative to |x|.
  double newton(Point& x, Complex t) {
    Point value;
    equations_.linearise(x, t, jacobian_, value);
    jacobian_.row(N - 1) = patch_.transpose();
    value[N - 1] = (patch_.array() * x.array()).sum() - 1.0;
    lu_.compute(jacobian_);
    const Point correction = lu_.solve(value);
    x -= correction;
    return correction.norm() / x.norm();
  }

  double pivot_ratio() const {
    const auto pivots = lu_.matrixLU().diagonal().cwiseAbs().eval();
    return pivots.minCoeff() / pivots.maxCoeff();
  }

  /// dx/dt with the matrix of the last correction, which is as good as the corrected point's.
  void differentiate(const Point& x, Complex t, Point& tangent) {
    equations_.rate(x, t, tangent);
    tangent[N - 1] = 0;
    tangent = -lu_.solve(tangent).eval();
  }

  bool find_tangent() {
    newton(x_, time_);
    differentiate(x_, time_, tangent_);
    return has_tangent_ = tangent_.allFinite();
  }

  /// Cubic through the last two points and their tangents (t is complex, so a path may turn); a straight
  /// line from the first one.
  Point predicted(Complex ahead) const {
    if (!has_past_) return x_ + tangent_ * (ahead - time_);
    const Complex h = time_ - past_time_, s = (ahead - time_) / h;
    const Point slope = tangent_ * h, past_slope = past_tangent_ * h, gap = x_ - past_;
    return x_ +
           s * (slope + s * ((2.0 * slope + past_slope - 3.0 * gap) + s * (slope + past_slope - 2.0 * gap)));
  }

  /// Predicts and corrects; the step is kept only where Newton contracts at once, so that it cannot have
  /// gone over to a neighbouring path.
  bool step(Complex ahead) {
    Point x = predicted(ahead);
    const double error = newton(x, ahead), again = newton(x, ahead);
    const bool settles = error <= options_.tolerance && again <= 0.1 * error + 1e-9 && again < 1e-6;
    const double order = has_past_ ? 0.25 : 0.5;
    const double growth = 0.8 * std::pow(options_.tolerance / (error + 1e-300), order);
    if (!settles) {
      stride_ = std::abs(ahead - time_) * std::clamp(growth, 0.1, 0.5);
      return false;
    }
    past_ = x_, past_tangent_ = tangent_, past_time_ = time_;
    x_ = x, time_ = ahead;
    differentiate(x_, time_, tangent_);
    stride_ = std::abs(time_ - past_time_) * std::clamp(growth, 0.5, 2.0);
    return has_past_ = true;
  }

  const H& equations_;
  PathOptions options_;
  Point x_, patch_, tangent_ = x_, past_ = x_, past_tangent_ = x_;
  Complex time_, past_time_ = time_;
  double stride_ = 0.01;
  int steps_ = 0;
  bool has_tangent_ = false, has_past_ = false;
  Matrix jacobian_ = Matrix::Identity();
  Eigen::PartialPivLU<Eigen::Matrix<Complex, N, N>> lu_{Eigen::Matrix<Complex, N, N>::Identity()};
};

/// Where a path ends.
template <int N>
struct PathEnd {
  enum class Kind { lost, regular, singular, infinite } kind = Kind::lost;
  Vec<Complex, N> point = Vec<Complex, N>::Zero();
};

namespace detail {

/// Cauchy's formula: x is a power series in the w-th root of t − end if w turns about the end bring it back,
/// and then the mean of its points on these turns is its value at the end. False where it does not come back.
template <class H>
bool mean_around(Path<H>& path, Complex end, typename Path<H>::Point& mean) {
  constexpr int points = 12, max_turns = 8;
  const typename Path<H>::Point start = path.point();
  mean.setZero();
  for (int turn = 1; turn <= max_turns; ++turn) {
    if (!path.turn_around(end, points, mean)) return false;
    if ((path.point() - start).norm() > 1e-5 * start.norm()) continue;
    mean /= points * turn;
    return true;
  }
  return false;
}

/// Tells from a path's points at shrinking distances r from its end whether it goes to infinity: then its
/// finiteness falls like a power of r.
class Fading {
 public:
  bool is_certain(double distance, double finiteness) {
    const double power = std::log(finiteness / finiteness_) / std::log(distance / distance_);
    const bool settled = power > 0.1 && std::abs(power - power_) < 0.1 * power;
    finiteness_ = finiteness, distance_ = distance, power_ = power;
    return settled && finiteness < 1e-8;
  }

 private:
  double finiteness_ = 1, distance_ = 1, power_ = 0;
};

/// Limit of a path at a point where the Jacobian may be singular: means on circles that shrink until two
/// agree; the outermost ones may hold other branch points.
template <class H>
PathEnd<H::unknowns> limit(const H& equations, Path<H> path, Complex end) {
  using End = PathEnd<H::unknowns>;
  typename Path<H>::Point before, mean;
  bool has_before = false;
  Fading fading;
  for (int circle = 0; circle < 8; ++circle) {
    path.centre();  // before and mean are compared as rays
    if (fading.is_certain(std::abs(path.time() - end), equations.finiteness(path.point())))
      return {End::Kind::infinite, path.point()};
    Path<H> around = path;
    const bool found = mean_around(around, end, mean);
    if (found) mean /= mean.norm();
    if (found && has_before && 1 - std::abs(before.dot(mean)) < 1e-14) {
      Path<H> at_end(equations, mean, end);
      if (at_end.refine()) return {End::Kind::regular, at_end.point()};
      return {End::Kind::singular, mean};
    }
    before = mean;
    has_before = found;
    if (!path.advance(end + (path.time() - end) * 0.3)) break;
  }
  return {};
}

}  // namespace detail

/// Follows `path` to `end`. Near it the path is tried straight on; where that meets a singular Jacobian, the
/// limit is taken from the circles around the end.
template <Homotopy H>
PathEnd<H::unknowns> follow(const H& equations, Path<H>& path, Complex end) {
  using End = PathEnd<H::unknowns>;
  const Complex near = end + (path.time() - end) * 0.05;
  if (!path.advance(near)) return {};
  Path<H> straight = path;
  if (straight.advance(end) && straight.refine()) return {End::Kind::regular, straight.point()};
  return detail::limit(equations, path, end);
}

}  // namespace sinew::inline v1
