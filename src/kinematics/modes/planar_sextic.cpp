#include "kinematics/modes/planar_sextic.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::inline v1 {
namespace {

using V = Vec2<double>;

template <std::size_t N>
using Coefficients = std::array<double, N>;

template <std::size_t N, std::size_t M>
Coefficients<N + M - 1> operator*(const Coefficients<N>& a, const Coefficients<M>& b) {
  Coefficients<N + M - 1> product{};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < M; ++j) product[i + j] += a[i] * b[j];
  return product;
}

/// g₀ + g_c cos φ + g_s sin φ, times 1 + T².
Coefficients<3> quadratic(double g0, double gc, double gs) { return {g0 + gc, 2 * gs, g0 - gc}; }

constexpr int compass_points = 8;  // more than the six zeros of F
constexpr double diagonal = 0.70710678118654752;
const std::array<V, compass_points> compass = {
    V(1, 0),  V(diagonal, diagonal),   V(0, 1),  V(-diagonal, diagonal),
    V(-1, 0), V(-diagonal, -diagonal), V(0, -1), V(diagonal, -diagonal)};

}  // namespace

Sextic::Sextic(double length, const PlatformConstraint<2>& second, const PlatformConstraint<2>& third)
    : length_(length),
      leg_{second, third} {
  double largest = -1, terms = 0;
  for (const V& direction : compass) {
    const SE2<double> turn{V(0, 0), direction.x(), direction.y()};
    const V w2 = w(0, turn), w3 = w(1, turn);
    const double e2 = e(0, w2), e3 = e(1, w3), rod = 2 * length_ * cross(w2, w3);
    const double f = std::abs(squared_norm(V(e2 * w3 - e3 * w2)) - rod * rod);
    const double whole = (e2 * e2 + rod * rod) * squared_norm(w3) + (e3 * e3) * squared_norm(w2);
    terms = std::max(terms, whole + 4 * length_ * length_ * squared_norm(w2) * squared_norm(w3));
    if (!(f > largest)) continue;
    largest = f;
    origin_c_ = -direction.x();
    origin_s_ = -direction.y();
  }
  strength_ = terms > 0 ? largest / terms : 0;
}

SE2<double> Sextic::at(double T) const {
  const double scale = 1 / (1 + T * T), c = (1 - T) * (1 + T) * scale, s = 2 * T * scale;
  return {V(0, 0), origin_c_ * c - origin_s_ * s, origin_s_ * c + origin_c_ * s};
}

/// F(φ) = |e₂w₃ − e₃w₂|² − 4 L₁² (w₂ × w₃)², times (1 + T²)³.
std::array<double, 7> Sextic::coefficients() const {
  const SE2<double> origin{V(0, 0), origin_c_, origin_s_};
  const V a2 = leg_[0].anchor, a3 = leg_[1].anchor;
  const V b2 = origin.rotate(leg_[0].platform_point), b3 = origin.rotate(leg_[1].platform_point);
  const auto w2w2 = quadratic(squared_norm(a2) + squared_norm(b2), -2 * dot(a2, b2), 2 * cross(a2, b2));
  const auto w3w3 = quadratic(squared_norm(a3) + squared_norm(b3), -2 * dot(a3, b3), 2 * cross(a3, b3));
  const auto w2w3 =
      quadratic(dot(a2, a3) + dot(b2, b3), -dot(a2, b3) - dot(a3, b2), cross(a2, b3) + cross(a3, b2));
  const auto area =
      quadratic(cross(a2, a3) + cross(b2, b3), -cross(b2, a3) - cross(a2, b3), dot(b2, a3) - dot(a2, b3));
  const auto e_of = [&](Coefficients<3> e, double distance) {
    const double more = (length_ - distance) * (length_ + distance);
    e[0] += more;
    e[2] += more;
    return e;
  };
  const auto e2 = e_of(w2w2, leg_[0].distance), e3 = e_of(w3w3, leg_[1].distance);
  const auto p = e2 * e2 * w3w3, q = e2 * e3 * w2w3, u = e3 * e3 * w2w2;
  const auto v = area * area * Coefficients<3>{1, 0, 1};
  Coefficients<7> sum;
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = p[k] - 2 * q[k] + u[k] - 4 * length_ * length_ * v[k];
  return sum;
}

PolynomialRoots Sextic::roots() const {
  // |F| is at T = ∞ at least 1/2.7 of its maximum, and |F′| ≤ 3 max|F| (Bernstein): no root is within
  // 0.12 rad.
  // The coefficients carry the rounding of the terms that they are the difference of.
  return real_roots(coefficients(), {.low = -17, .high = 17, .touch = 1e-12 + 2e-15 / strength_});
}

/// Where the circle of the first leg meets the line 2 w·s + e = 0 of the leg with the longer w: two
/// directions of s, of which the other leg takes one, or both where all three circles have two points in
/// common.
Sextic::Starts Sextic::directions(const SE2<double>& turn) const {
  Starts starts;
  const auto add = [&](const V& u) { starts.direction[static_cast<std::size_t>(starts.count++)] = u; };
  V line = w(0, turn), other = w(1, turn);
  double e_line = e(0, line), e_other = e(1, other);
  if (squared_norm(line) < squared_norm(other)) {
    std::swap(line, other);
    std::swap(e_line, e_other);
  }
  const double far = line.norm();
  if (far < 1e-2)  // platform nearly congruent with the base: three nearly equal circles
    for (const V& direction : compass) add(direction);
  if (!(far > 0)) return starts;
  const V n = line / far;
  // Not quite tangent, where the closures would not tell Newton which way to go.
  constexpr double most = 1 - 5e-11;
  const double along = std::clamp(-e_line / (2 * far * length_), -most, most);
  const V across = std::sqrt((1 - along) * (1 + along)) * perp(n);
  V left = along * n + across, right = along * n - across;
  const auto miss = [&](const V& u) { return std::abs(2 * length_ * dot(other, u) + e_other); };
  if (miss(right) < miss(left)) std::swap(left, right);
  add(left);
  if (miss(right) < 1e-3) add(right);
  return starts;
}

Sextic::Closure Sextic::closure(const SE2<double>& pose) const {
  Closure at;
  for (std::size_t k = 0; k < 2; ++k) {
    const V arm = pose.rotate(leg_[k].platform_point), gap = pose.p + arm - leg_[k].anchor;
    const double distance = gap.norm(), miss = distance - leg_[k].distance;
    const auto row = static_cast<Eigen::Index>(k);
    at.residual[row] = 0.5 * miss * (distance + leg_[k].distance);
    at.jacobian.row(row) << dot(gap, perp(pose.p)), dot(gap, perp(arm));
    at.error = std::max(at.error, std::abs(miss));
  }
  return at;
}

/// Newton in the direction of s and the platform angle: the first leg stays closed, and a short one does not
/// spoil the scale.
SE2<double> Sextic::closed(SE2<double> pose) const {
  SE2<double> best = pose;
  double least = 1e300;
  for (int i = 0; i < 24; ++i) {
    const Closure here = closure(pose);
    if (!(here.error < least) && least < 1e-12) break;  // the last digits
    if (here.error < least) {
      best = pose;
      least = here.error;
    }
    if (here.error < 2e-16) break;
    const auto& r = here.residual;
    const auto& J = here.jacobian;
    const double det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
    V step((J(0, 1) * r[1] - J(1, 1) * r[0]) / det, (J(1, 0) * r[0] - J(0, 0) * r[1]) / det);
    if (!step.allFinite()) break;
    step *= std::min(1.0, 0.5 / step.cwiseAbs().maxCoeff());
    const SE2<double> swing = SE2<double>::from(0.0, 0.0, step[0]);
    pose = {length_ * swing.rotate(pose.p).normalized(), pose.c, pose.s};
    pose = pose.displaced({0, 0, step[1]});
  }
  return best;
}

}  // namespace sinew::inline v1
