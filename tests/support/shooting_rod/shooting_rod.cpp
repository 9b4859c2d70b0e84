#include "shooting_rod/shooting_rod.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "shooting_rod/rod_tangents.hpp"

namespace sinew::inline v1 {
namespace {

using Walk = rod_steps::Walk<double>;

bool is_answerable(const SpatialRod& rod, double length, const RodState<double>& base) {
  const double quaternion = base.R.w * base.R.w + base.R.v.squaredNorm();
  return rod.is_valid() && std::isfinite(length) && length > 0 && std::abs(quaternion - 1) < 1e-6 &&
         base.p.allFinite() && base.n.allFinite() && base.m.allFinite();
}

/// A first number of steps from how far the section can turn: by its curvature, and what the force adds.
int steps_for(const SpatialRod& rod, double length, const RodState<double>& base, double tolerance) {
  const Vec3<double> moment = base.R.rotate_back(base.m);
  const double softest =
      std::min({rod.bending_stiffness[0], rod.bending_stiffness[1], rod.torsion_stiffness});
  const Vec3<double> stiffness(rod.bending_stiffness[0], rod.bending_stiffness[1], rod.torsion_stiffness);
  const double curvature = (rod.precurvature + moment.cwiseQuotient(stiffness)).norm();
  const double force = base.n.norm() + length * rod.load.norm();
  const double turn = length * (curvature + std::sqrt(force / softest));
  const double steps = turn * 0.06 * std::pow(std::max(tolerance, 1e-15), -1.0 / 8);
  return static_cast<int>(std::clamp(std::ceil(steps), 1.0, 0.5 * max_rod_steps)) * 2;
}

/// The energies of a rod that was walked to its end.
void put_energies(const Walk& walk, double length, RodTip& tip) {
  tip.potential = walk.y.potential - length * walk.law.load.dot(walk.y.p);
  tip.energy = walk.y.energy + tip.potential;
}

RodTip walked(const SpatialRod& rod, double length, const RodState<double>& base, int steps) {
  Walk walk(rod, length, base, steps);
  for (int i = 0; i < steps; ++i) walk.step();
  RodTip tip;
  tip.steps = steps;
  tip.state = walk.state(base);
  put_energies(walk, length, tip);
  const bool finite = tip.state.p.allFinite() && tip.state.m.allFinite() && std::isfinite(tip.state.R.w) &&
                      std::isfinite(tip.energy);
  tip.status = finite ? Status::converged : Status::left_domain;
  return tip;
}

double distance(const RodTip& a, const RodTip& b, double length) {
  const double turn = a.state.R.compose(b.state.R.inverse()).log().norm();
  return std::max((a.state.p - b.state.p).norm() / length, turn);
}

/// The fewest steps, more or less, that meet the tolerance. Order 8 leaves 1/255 of the difference from half
/// as many; 1/64 is for steps so long that the order does not show.
RodTip refined(const SpatialRod& rod, double length, const RodState<double>& base, double tolerance) {
  int steps = steps_for(rod, length, base, tolerance);
  double before = INFINITY;
  for (int idle = 0;;) {
    RodTip tip = walked(rod, length, base, steps);
    const RodTip coarse = walked(rod, length, base, steps / 2);
    tip.error = distance(tip, coarse, length) / 64;
    if (tip.status == Status::converged && tip.error <= tolerance) return tip;
    idle = tip.error > before / 2 ? idle + 1 : 0;
    if (steps == max_rod_steps ||
        idle == 2) {  // more steps do not help: rounding, not long steps by chance alike
      if (tip.status == Status::converged)
        tip.status = steps == max_rod_steps ? Status::iteration_limit : Status::stalled;
      return tip;
    }
    if (std::isfinite(tip.error)) before = tip.error;
    const double more = std::isfinite(tip.error) ? std::pow(tip.error / tolerance, 1.0 / 8) * 1.1 : 2;
    steps =
        std::min(2 * static_cast<int>(std::ceil(0.5 * steps * std::clamp(more, 1.3, 4.0))), max_rod_steps);
  }
}

}  // namespace

RodTip integrate(const SpatialRod& rod, double length, const RodState<double>& base, const RodSteps& how) {
  if (!is_answerable(rod, length, base) || how.steps < 0) return {};
  if (how.steps == 0) return refined(rod, length, base, how.tolerance);
  return walked(rod, length, base, std::min(how.steps, max_rod_steps));
}

RodTangent integrate_tangent(const SpatialRod& rod, double length, const RodState<double>& base,
                             const RodSteps& how) {
  RodTangent tangent;
  tangent.rate.setZero();
  if (how.steps <= 0) {
    tangent.tip = integrate(rod, length, base, how);
    if (tangent.tip.steps == 0) return tangent;
  } else if (is_answerable(rod, length, base)) {
    tangent.tip.steps = std::min(how.steps, max_rod_steps);
  } else {
    return tangent;
  }
  Walk walk(rod, length, base, tangent.tip.steps);
  rod_steps::Tangents<1> columns(base, rod.load, length);
  for (int i = 0; i < tangent.tip.steps; ++i) {
    walk.step();
    columns.step(walk);
  }
  tangent.rate = columns.rate(walk);
  if (how.steps > 0) {
    tangent.tip.state = walk.state(base);
    put_energies(walk, length, tangent.tip);
    tangent.tip.status = tangent.rate.allFinite() ? Status::converged : Status::left_domain;
  }
  return tangent;
}

Status rod_sections(const SpatialRod& rod, double length, const RodState<double>& base,
                    std::span<RodState<double>> out, const RodSteps& how) {
  SINEW_EXPECTS(out.size() >= 2);
  const RodTip tip = integrate(rod, length, base, how);
  const int pieces = static_cast<int>(out.size()) - 1, each = (tip.steps + pieces - 1) / pieces;
  if (each == 0) return tip.status;
  Walk walk(rod, length, base, pieces * each);
  out[0] = base;
  for (std::size_t k = 1; k < out.size(); ++k) {
    for (int i = 0; i < each; ++i) walk.step();
    out[k] = walk.state(base);
  }
  return tip.status;
}

}  // namespace sinew::inline v1
