#include "sinew/link/spatial_rod.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "link/rod_steps.hpp"
#include "sinew/base/assert.hpp"

namespace sinew::inline v0 {
namespace {

using rod_steps::stages;
using Stage = rod_steps::Stage<double>;
using Walk = rod_steps::Walk<double>;

/// One number's derivatives by the eight columns of RodTangent.
using Row = Eigen::Array<double, 8, 1>;
template <std::size_t N>
using Rows = std::array<Row, N>;

Rows<3> times(const Mat<double, 3, 3>& a, const Rows<3>& x) {
  Rows<3> out;
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i)] = a(i, 0) * x[0] + a(i, 1) * x[1] + a(i, 2) * x[2];
  return out;
}

Rows<3> cross_rows(const Rows<3>& a, const Vec3<double>& b) {
  return {Row(a[1] * b[2] - a[2] * b[1]), Row(a[2] * b[0] - a[0] * b[2]), Row(a[0] * b[1] - a[1] * b[0])};
}

/// φ of δq = ½ φ ∘ q, a vector and the change of |q|²: δ(R x) = φ₀ R x + φ × R x for the R of |q|².
struct Turn {
  Turn(const Vec<double, 4>& q, const Rows<4>& dq) {
    const double f = 2 / q.squaredNorm(), w = f * q[0], x = f * q[1], y = f * q[2], z = f * q[3];
    scale = w * dq[0] + x * dq[1] + y * dq[2] + z * dq[3];
    vector = {Row(w * dq[1] - x * dq[0] - z * dq[2] + y * dq[3]),
              Row(w * dq[2] - y * dq[0] - x * dq[3] + z * dq[1]),
              Row(w * dq[3] - z * dq[0] - y * dq[1] + x * dq[2])};
  }

  /// δ(R x), plus `own`.
  Rows<3> turned(const Vec3<double>& x, const Rows<3>& own) const {
    const Rows<3> side = cross_rows(vector, x);
    return {Row(own[0] + scale * x[0] + side[0]), Row(own[1] + scale * x[1] + side[1]),
            Row(own[2] + scale * x[2] + side[2])};
  }
  /// R δ(Rᵀx), plus `own`.
  Rows<3> turned_back(const Vec3<double>& x, const Rows<3>& own) const {
    const Rows<3> side = cross_rows(vector, x);
    return {Row(own[0] + scale * x[0] - side[0]), Row(own[1] + scale * x[1] - side[1]),
            Row(own[2] + scale * x[2] - side[2])};
  }

  Row scale;
  Rows<3> vector;
};

struct Columns {
  Rows<4> q;
  Rows<3> m, p;
};

template <std::size_t N>
void add(Rows<N>& to, const Rows<N>& rate, double factor) {
  for (std::size_t i = 0; i < N; ++i) to[i] += factor * rate[i];
}

/// Derivatives of the steps of a walk.
class Tangents {
 public:
  Tangents(const RodState<double>& base, double length) : length_(length) {
    for (Row& row : y_.q) row.setZero();
    for (Row& row : y_.m) row.setZero();
    for (Row& row : y_.p) row.setZero();
    for (std::size_t i = 0; i < 3; ++i) y_.m[i][RodTangent::moment + static_cast<int>(i)] = 1;
    const auto& [w, v] = base.R;  // ½ q ∘ e₃
    const std::array<double, 4> spin = {-0.5 * v[2], 0.5 * v[1], -0.5 * v[0], 0.5 * w};
    for (std::size_t i = 0; i < 4; ++i) y_.q[i][RodTangent::spin] = spin[i];
  }

  void step(const Walk& walk) {
    for (std::size_t i = 0; i < stages; ++i) {
      Columns at{y_.q, y_.m, {}};
      rod_steps::sum_stages(rod_steps::coupling[i], i, rate_, [&](const Columns& k, double a) {
        add(at.q, k.q, walk.h * a);
        add(at.m, k.m, walk.h * a);
      });
      const double s = (walk.taken - 1 + rod_steps::node[i]) * walk.h;
      differentiate(walk.law, walk.stage[i], s, at, rate_[i]);
    }
    rod_steps::sum_stages(rod_steps::weight, stages, rate_, [&](const Columns& k, double b) {
      add(y_.q, k.q, walk.h * b);
      add(y_.m, k.m, walk.h * b);
      add(y_.p, k.p, walk.h * b);
    });
  }

  Mat<double, 12, 8> rate(const Walk& walk) const {
    const Turn turn(walk.y.q, y_.q);
    const Rows<3> force = force_rate(walk.law.load, length_);
    Mat<double, 12, 8> rate;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      rate.row(RodTangent::position + i) = y_.p[k].matrix();
      rate.row(RodTangent::rotation + i) = turn.vector[k].matrix();
      rate.row(RodTangent::tip_force + i) = force[k].matrix();
      rate.row(RodTangent::tip_moment + i) = y_.m[k].matrix();
    }
    return rate;
  }

 private:
  /// δn at s: n = n(0) − s f, and s grows with the length.
  Rows<3> force_rate(const Vec3<double>& load, double s) const {
    Rows<3> rate;
    for (int i = 0; i < 3; ++i) {
      Row& row = rate[static_cast<std::size_t>(i)];
      row.setZero();
      row[RodTangent::force + i] = 1;
      row[RodTangent::length] = -load[i] * s / length_;
    }
    return rate;
  }

  void differentiate(const rod_steps::Law<double>& law, const Stage& on, double s, const Columns& at,
                     Columns& rate) const {
    const Turn turn(on.q, at.q);
    const Mat<double, 3, 3> bend = law.bend.asDiagonal() * on.R.transpose();
    const Rows<3> u = times(bend, turn.turned_back(on.m, at.m));
    Rows<4> half;
    rod_steps::half_product(at.q, on.u, rate.q);
    rod_steps::half_product(on.q, u, half);
    add(rate.q, half, 1);

    const Rows<3> n = force_rate(law.load, s);
    const Rows<3> none = {Row(Row::Zero()), Row(Row::Zero()), Row(Row::Zero())};
    rate.p = turn.turned(on.rate.p, none);
    if (law.stretches) {
      const Mat<double, 3, 3> stretch = on.R * law.stretch.asDiagonal() * on.R.transpose();
      add(rate.p, times(stretch, turn.turned_back(on.n, n)), 1);
    }
    const Rows<3> by_force = cross_rows(n, on.rate.p), by_tangent = cross_rows(rate.p, on.n);
    for (std::size_t i = 0; i < 3; ++i) rate.m[i] = by_force[i] - by_tangent[i];
    feed(on, rate);
  }

  /// The steps are the length's: h′ = h/L.
  void feed(const Stage& on, Columns& rate) const {
    const double share = 1 / length_;
    for (std::size_t i = 0; i < 4; ++i)
      rate.q[i][RodTangent::length] += on.rate.q[static_cast<int>(i)] * share;
    for (std::size_t i = 0; i < 3; ++i) {
      rate.m[i][RodTangent::length] += on.rate.m[static_cast<int>(i)] * share;
      rate.p[i][RodTangent::length] += on.rate.p[static_cast<int>(i)] * share;
    }
  }

  double length_;
  Columns y_;
  std::array<Columns, stages> rate_;
};

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

RodTip walked(const SpatialRod& rod, double length, const RodState<double>& base, int steps) {
  Walk walk(rod, length, base, steps);
  for (int i = 0; i < steps; ++i) walk.step();
  RodTip tip;
  tip.steps = steps;
  tip.state = walk.state(base);
  tip.energy = walk.y.energy - length * rod.load.dot(walk.y.p);
  const bool finite = tip.state.p.allFinite() && tip.state.m.allFinite() && std::isfinite(tip.state.R.w) &&
                      std::isfinite(tip.energy);
  tip.status = finite ? Status::converged : Status::left_domain;
  return tip;
}

double distance(const RodTip& a, const RodTip& b, double length) {
  const double turn = a.state.R.compose(b.state.R.inverse()).log().norm();
  return std::max((a.state.p - b.state.p).norm() / length, turn);
}

/// The fewest steps, more or less, that meet the tolerance: against half as many, order 8 leaves 1/255 of
/// the difference.
RodTip refined(const SpatialRod& rod, double length, const RodState<double>& base, double tolerance) {
  int steps = steps_for(rod, length, base, tolerance);
  double before = INFINITY;
  for (;;) {
    RodTip tip = walked(rod, length, base, steps);
    const RodTip coarse = walked(rod, length, base, steps / 2);
    tip.error = distance(tip, coarse, length) / 255;
    if (tip.status == Status::converged && tip.error <= tolerance) return tip;
    if (steps == max_rod_steps || tip.error > before / 2) {  // more steps do not help: rounding
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

SpatialRod SpatialRod::round(double youngs_modulus, double shear_modulus, double diameter, RodLaw law) {
  const double area = std::numbers::pi * diameter * diameter / 4, inertia = area * diameter * diameter / 16;
  SpatialRod rod;
  rod.bending_stiffness = Vec2<double>::Constant(youngs_modulus * inertia);
  rod.torsion_stiffness = shear_modulus * 2 * inertia;
  if (law == RodLaw::cosserat) {
    rod.shear_compliance = Vec2<double>::Constant(1 / (shear_modulus * area));
    rod.extension_compliance = 1 / (youngs_modulus * area);
  }
  return rod;
}

bool SpatialRod::is_valid() const {
  return bending_stiffness.allFinite() && std::isfinite(torsion_stiffness) && shear_compliance.allFinite() &&
         std::isfinite(extension_compliance) && precurvature.allFinite() && load.allFinite() &&
         bending_stiffness.minCoeff() > 0 && torsion_stiffness > 0 && shear_compliance.minCoeff() >= 0 &&
         extension_compliance >= 0;
}

bool SpatialRod::is_isotropic() const {
  return bending_stiffness[0] == bending_stiffness[1] && shear_compliance[0] == shear_compliance[1] &&
         precurvature[0] == 0 && precurvature[1] == 0;
}

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
  Tangents columns(base, length);
  for (int i = 0; i < tangent.tip.steps; ++i) {
    walk.step();
    columns.step(walk);
  }
  tangent.rate = columns.rate(walk);
  if (how.steps > 0) {
    tangent.tip.state = walk.state(base);
    tangent.tip.energy = walk.y.energy - length * rod.load.dot(walk.y.p);
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

}  // namespace sinew::inline v0
