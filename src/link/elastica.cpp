#include "link/elastica.hpp"

#include <numbers>

#include "base/assert.hpp"
#include "sinew/math/se2.hpp"

namespace sinew::inline v1 {
namespace {

/// A number with its derivatives by the two components of the local force.
struct Dual {
  double x, dn = 0, dt = 0;

  explicit Dual(double value, double by_n = 0, double by_t = 0) : x(value), dn(by_n), dt(by_t) {}
};

double real_part(const Dual& a) { return a.x; }
Dual operator+(const Dual& a, const Dual& b) { return Dual(a.x + b.x, a.dn + b.dn, a.dt + b.dt); }
Dual operator-(const Dual& a, const Dual& b) { return Dual(a.x - b.x, a.dn - b.dn, a.dt - b.dt); }
Dual operator*(const Dual& a, const Dual& b) {
  return Dual(a.x * b.x, a.x * b.dn + a.dn * b.x, a.x * b.dt + a.dt * b.x);
}
Dual operator/(const Dual& a, const Dual& b) {
  const double inverse = 1 / b.x, value = a.x * inverse;
  return Dual(value, (a.dn - value * b.dn) * inverse, (a.dt - value * b.dt) * inverse);
}
Dual operator+(const Dual& a, double b) { return Dual(a.x + b, a.dn, a.dt); }
Dual operator+(double a, const Dual& b) { return b + a; }
Dual operator-(double a, const Dual& b) { return Dual(a - b.x, -b.dn, -b.dt); }
Dual operator*(const Dual& a, double b) { return Dual(a.x * b, a.dn * b, a.dt * b); }
Dual operator/(double a, const Dual& b) { return Dual(a) / b; }
Dual atan(const Dual& a) {
  const double rate = 1 / (1 + a.x * a.x);
  return Dual(std::atan(a.x), a.dn * rate, a.dt * rate);
}

using Matrix = Mat<double, 2, 2>;

/// A·B⁻¹, made symmetric: the two off-diagonal elements differ by rounding.
Matrix symmetric_quotient(const Matrix& a, const Matrix& b) {
  Matrix adjugate;
  adjugate << b(1, 1), -b(0, 1), -b(1, 0), b(0, 0);
  Matrix quotient = a * adjugate / cross(b.col(0), b.col(1));
  quotient(0, 1) = quotient(1, 0) = 0.5 * (quotient(0, 1) + quotient(1, 0));
  return quotient;
}

Vec2<double> gradient(const Dual& a) { return {a.dn, a.dt}; }

Matrix rows(const Dual& a, const Dual& b) {
  Matrix m;
  m << a.dn, a.dt, b.dn, b.dt;
  return m;
}

/// The states of one magnitude of force, told apart by χ: θ_tip = χ + φ where the force has the direction φ.
class ForceProblem {
 public:
  explicit ForceProblem(const Vec2<double>& force)
      : magnitude_(std::hypot(force[0], force[1])),
        direction_(std::atan2(force[0] + 0.0, force[1])) {}

  double direction() const { return direction_; }

  void move_to(double chi) {
    chi_ = chi;
    local_ = elastica_local_force(magnitude_, chi);
    tangent_ = elastica_tangent(local_);
  }

  /// χ + φ − θ_tip: how far the base tangent is from where it belongs.
  double residual() const { return chi_ + direction_ - tangent_.state.tip_angle; }
  /// ∂residual/∂χ: 1 of the free rod, 0 where it buckles.
  double rate() const {
    return 1 + tangent_.tip_angle_rate[0] * local_[1] - tangent_.tip_angle_rate[1] * local_[0];
  }
  double chi() const { return chi_; }

  ElasticaTip answer(int iterations, bool found) const {
    // ε in the angle θ(0) moves the tip by ε: the equations have no better measure.
    const bool finite = std::isfinite(residual());
    const Status status = !finite                      ? Status::left_domain
                          : !found                     ? Status::stalled
                          : !(std::abs(rate()) > 1e-9) ? Status::singular
                                                       : Status::converged;
    return {status, iterations, local_, tangent_.state, tangent_.compliance()};
  }

 private:
  double magnitude_, direction_, chi_ = 0;
  Vec2<double> local_ = Vec2<double>::Zero();
  ElasticaTangent tangent_;
};

constexpr int max_iterations = 60;
constexpr double angle_tolerance = 1e-13;

}  // namespace

Mat<double, 2, 2> ElasticaTangent::compliance() const { return symmetric_quotient(tip_rate, force_rate); }
Mat<double, 2, 2> ElasticaTangent::stiffness() const { return symmetric_quotient(force_rate, tip_rate); }

ElasticaTangent elastica_tangent(const Vec2<double>& local_force) {
  const auto x = detail::elastica_numbers(Dual(local_force[0], 1, 0), Dual(local_force[1], 0, 1));
  return {{{x.d.x, x.w.x}, {x.force_d.x, x.force_w.x}, x.tip_angle.x, x.base_curvature.x, x.energy.x},
          rows(x.d, x.w),
          rows(x.force_d, x.force_w),
          gradient(x.tip_angle),
          gradient(x.base_curvature),
          gradient(x.energy)};
}

// The turn from force to base is concave in |χ| up to the wanted root (docs/theory/elastica.md), so Newton's
// iterates rise from χ = 0 to the smallest root. The bracket only keeps rounding from throwing them out.
ElasticaTip elastica_under_force(const Vec2<double>& force) {
  ForceProblem problem(force);
  const double side = problem.direction() > 0 ? -1 : 1, whole = std::abs(problem.direction());
  double low = 0, high = whole;  // of |χ|
  problem.move_to(0);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const double chi = side * problem.chi(), gap = side * problem.residual();
    if (!(std::abs(gap) > 4e-16 * whole)) return problem.answer(iteration, true);
    (gap < 0 ? low : high) = chi;
    const double newton = chi - gap / problem.rate();
    const double next = newton > low ? std::fmin(newton, high) : 0.5 * (low + high);
    if (next == chi || !(low < high)) return problem.answer(iteration, std::abs(gap) < angle_tolerance);
    problem.move_to(side * next);
  }
  return problem.answer(max_iterations, std::abs(problem.residual()) < angle_tolerance);
}

ElasticaTip elastica_under_force(const Vec2<double>& force, double near_tip_angle) {
  ForceProblem problem(force);
  // Whole turns are no error.
  const auto wrapped = [](const ForceProblem& p) { return wrap_angle(p.residual()); };
  problem.move_to(near_tip_angle - problem.direction());
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const ForceProblem before = problem;
    const double gap = wrapped(before), error = std::abs(gap);
    if (!(error > 0)) return problem.answer(iteration, true);
    double step = -gap / before.rate();
    step *= 1 / std::fmax(1.0, std::abs(step) / 0.5);  // a tip angle has no scale but the radian
    do {
      problem.move_to(before.chi() + step);
      step *= 0.5;
    } while (!(std::abs(wrapped(problem)) < error) && std::abs(step) > 1e-17);
    if (!(std::abs(wrapped(problem)) < error)) return before.answer(iteration, error < angle_tolerance);
  }
  return problem.answer(max_iterations, std::abs(wrapped(problem)) < angle_tolerance);
}

void elastica_sections(const Vec2<double>& local_force, std::span<const double> s,
                       std::span<ElasticaSection> out) {
  SINEW_EXPECTS(s.size() == out.size());
  const ElasticaState<double> rod = elastica(local_force);
  for (std::size_t i = 0; i < s.size(); ++i) {
    // The piece beyond the section is a rod of its own: its base looks along the section's tangent.
    const double sigma = 1 - s[i];
    const ElasticaState<double> piece = elastica(Vec2<double>(local_force * (sigma * sigma)));
    const double angle = rod.tip_angle - piece.tip_angle, sin = std::sin(angle), cos = std::cos(angle);
    const double d = piece.tip[0], w = piece.tip[1];
    out[i] = {rod.tip - sigma * Vec2<double>(w * sin + d * cos, w * cos - d * sin), angle,
              sigma > 0 ? piece.base_curvature / sigma : 0 * piece.base_curvature};
  }
}

}  // namespace sinew::inline v1
