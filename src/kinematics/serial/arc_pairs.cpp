#include "kinematics/serial/arc_pairs.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sinew::inline v1 {
namespace detail {
namespace {

constexpr double rounding = 1e-12;
using Quaternion = Vec<double, 4>;

/// S(x) = sinc(arccos x), the chord of an arc of length 1 whose half tilt has this cosine, S′ and a bound on
/// |S″| for all larger cosines. S = 1 − Σ cₙ((1 − x)/2)ⁿ with cₙ ≥ 0: concave, and |S″| falls with x.
struct ChordOfCosine {
  double value, rate, bend;

  explicit ChordOfCosine(double x) {
    x = std::clamp(x, -1.0, 1.0);
    const double h = std::max(std::acos(x), 1e-8), s = std::max(std::sqrt((1 - x) * (1 + x)) / h, 1e-300);
    const double slope = h < 0.5 ? sinc_slope(h) : (s - x) / (h * h);
    value = h < 1e-6 ? 1 : s;
    rate = slope / s;
    bend = h < 0.5 ? at_half : slope * slope / (s * s * s) + (s - 3 * slope) / (h * h * s * s);
  }

 private:
  static constexpr double at_half = 0.0504;  // -S'' where h = 0.5, not less
};

using Halves = std::array<double, 4>;

Halves halves(const Piece& first, const Piece& last) {
  return {first.half[0], first.half[1], last.half[0], last.half[1]};
}

/// `last` is the direction of the last chord, `turned` and `turned_z` the products of Piece.
Quaternion middle(const Vec3<double>& last, const Quaternion& turned, const Quaternion& turned_z) {
  const Vec3<double> y = turned.tail<3>(), v = turned_z.tail<3>();
  const Vec3<double> u = cross(v, last) - turned_z[0] * last;
  Quaternion m;
  m << dot(last, y), u;
  return m;
}
Fourfold<4> middle(const Piece& first, const Piece& last) {
  Fourfold<4> m;
  m.at = middle(last.direction.at, first.turned.at, first.turned_z.at);
  for (std::size_t k = 0; k < 2; ++k) {
    m.rate[k] = middle(last.direction.at, first.turned.rate[k], first.turned_z.rate[k]);
    m.rate[k + 2] = middle(last.direction.rate[k], first.turned.at, first.turned_z.at);
  }
  return m;
}

/// The position equation over a pair: |F(δ) − F − F′δ| ≤ second_order.
struct PositionBound {
  Fourfold<3> F;
  Fourfold<1> x;  ///< cosine of the middle arc's half tilt
  double lean;    ///< how far that gets from the one in the middle, to first order
  double second_order;
};

/// S over an interval about x is value + rate·(x′ − x), give or take `sag`.
struct LinearChord {
  double value, rate, sag;

  LinearChord(double x, double change) {
    if (const ChordOfCosine lowest(x - change); x - change > -0.9) {
      const ChordOfCosine S(x);
      value = S.value;
      rate = S.rate;
      sag = lowest.bend * change * change / 2;
      return;
    }
    // Near a full turn S″ has no bound. S, concave, rises over its secant by twice what it does half way, or
    // less. The secant is wide enough for rounding to leave its slope alone.
    const double wide = change + 1e-9, low = std::max(x - wide, -1.0), high = std::min(x + wide, 1.0);
    const double lowest = ChordOfCosine(low).value, highest = ChordOfCosine(high).value;
    rate = (highest - lowest) / (high - low);
    sag = ChordOfCosine((low + high) / 2).value - (lowest + highest) / 2;
    value = lowest + rate * (x - low) + sag;
  }
};

PositionBound position_bound(const ThreeArcPose& pose, const Piece& first, const Piece& last,
                             const PairBounds& bounds, int sign) {
  const Fourfold<4>& m = bounds.middle;
  const Halves half = halves(first, last);
  const Vec3<double> u = sign * m.at.tail<3>();
  PositionBound bound;
  const double x = bound.x.at[0] = sign * m.at[0], length = pose.lengths[1];
  bound.lean = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    bound.x.rate[k][0] = sign * m.rate[k][0];
    bound.lean += std::abs(m.rate[k][0]) * half[k];
  }
  const double curl = bounds.second_order, travel = first.travel + last.travel;
  const double change = std::min(bound.lean + curl, travel);
  const LinearChord S(x, change);
  bound.F.at = bounds.gap + length * S.value * u;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3<double> outer = k < 2 ? first.chord.rate[k] : last.chord.rate[k - 2];
    bound.F.rate[k] =
        outer + length * (S.rate * bound.x.rate[k][0] * u + sign * S.value * m.rate[k].tail<3>());
  }
  bound.second_order = first.chord_bulge + last.chord_bulge + rounding +
                       length * (std::abs(S.value) * curl + S.rate * (curl + change * travel) + S.sag);
  return bound;
}

/// Half the second derivatives of twist and position anywhere in the doubled pair, along steps that reach
/// across it.
struct SecondOrder {
  double twist, position;
};
SecondOrder order_of_doubled(const ThreeArcPose& pose, const Piece& first, const Piece& last,
                             const PositionBound& bound) {
  const double a = first.radius, b = last.radius, speed = (a + b) / 2, curl = speed * speed / 2;
  const auto steepness = [&](std::size_t k) {
    return std::hypot(bound.x.rate[k][0], bound.x.rate[k + 1][0]);
  };
  const double lean = steepness(0) * a + steepness(2) * b, low = bound.x.at[0] - 2 * lean - 4 * curl;
  if (!(low > -1)) return {curl, std::numeric_limits<double>::infinity()};
  const ChordOfCosine S(low);
  const double change = std::min(lean + 4 * curl, speed);
  return {curl,
          (pose.lengths[0] * a * a + pose.lengths[2] * b * b) / 6 +
              pose.lengths[1] * (curl + S.rate * (change * speed + curl) + S.bend * change * change / 2)};
}

bool is_out_of_reach(const PositionBound& bound, const Halves& half) {
  const double missing = bound.F.at.norm();
  if (missing <= bound.second_order) return false;
  const Vec3<double> direction = bound.F.at / missing;
  double reach = bound.second_order;
  for (std::size_t k = 0; k < 4; ++k) reach += std::abs(dot(direction, bound.F.rate[k])) * half[k];
  return missing > reach;
}

/// Newton's step from the middle and how far the second order can move its end.
PairAnswer linear_answer(const ThreeArcPose& pose, const Piece& first, const Piece& last,
                         const PairBounds& bounds, const PositionBound& bound, int sign) {
  Eigen::Matrix4d J;
  Eigen::Vector4d F;
  F << bounds.twist, bound.F.at;
  for (int k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(k);
    J.col(k) << bounds.twist_rate[i], bound.F.rate[i];
  }
  const Eigen::Matrix4d inverse = J.inverse();
  if (!inverse.allFinite()) return {Verdict::open, {}};
  const Eigen::Vector4d step = -(inverse * F);
  const SecondOrder doubled = order_of_doubled(pose, first, last, bound);
  const Halves half = halves(first, last);
  Halves strain{};
  for (int k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double twist = std::abs(inverse(k, 0)), position = inverse.row(k).tail<3>().norm();
    const double spread = twist * (bounds.second_order + rounding) + position * bound.second_order;
    if (std::abs(step[k]) > half[i] + spread) return {Verdict::empty, {}};
    strain[i] = twist * doubled.twist + position * doubled.position;
  }
  // Inverse times J differs from 1 by at most 4 strain/radius over the doubled pair, 6 where a secant stands
  // for the tangent: below 1, it has one root at most.
  const bool is_single = 7 * std::hypot(strain[0], strain[1]) <= first.radius &&
                         7 * std::hypot(strain[2], strain[3]) <= last.radius;
  if (!is_single) return {Verdict::open, {}};
  return {Verdict::single, {first.point(step[0], step[1]), last.point(step[2], step[3]), sign}};
}

}  // namespace

ChordCurve ThreeArcPose::first_curve() const {
  const SO3<double> G = tip.R.compose({0, Vec3<double>(0, 0, 1)});
  return {lengths[0], limit, G.w * tip.p + cross(tip.p, G.v), lengths[0] * G.w, Mat<double, 3, 3>::Identity(),
          tip.R};
}

ChordCurve ThreeArcPose::last_curve() const {
  const SO3<double> G = tip.R.compose({0, Vec3<double>(0, 0, 1)});
  const Vec3<double> mirror(-1, -1, 1), slope = tip.R.rotate_back(G.w * tip.p + cross(G.v, tip.p));
  const Mat<double, 3, 3> axes = tip.R.matrix() * mirror.asDiagonal();
  return {lengths[2], limit, Vec3<double>(mirror.cwiseProduct(slope)), lengths[2] * G.w, axes, tip.R};
}

double ThreeArcPose::lowest_cosine() const { return std::cos(std::min(limit / 2, std::numbers::pi)); }

bool ThreeArcPose::has_free_circle() const {
  const ChordCurve curve = first_curve();
  return curve.slope.norm() + std::abs(curve.pull) < 1e-9;
}

PairBounds pair_bounds(const ThreeArcPose& pose, const Piece& first, const Piece& last) {
  PairBounds bounds;
  bounds.gap = first.chord.at + last.chord.at - pose.tip.p;
  const double moved = (pose.lengths[0] * first.radius + pose.lengths[2] * last.radius) / 2;
  bounds.second_order = first.bulge + last.bulge + first.travel * last.travel;
  bounds.is_empty = bounds.gap.norm() > pose.lengths[1] + moved + rounding;
  bounds.is_too_large = bounds.second_order > 1;
  if (bounds.is_empty || bounds.is_too_large) return bounds;
  bounds.twist = dot(last.direction.at, first.turned_z.at.tail<3>());
  for (std::size_t k = 0; k < 2; ++k) {
    bounds.twist_rate[k] = dot(last.direction.at, first.turned_z.rate[k].tail<3>());
    bounds.twist_rate[k + 2] = dot(last.direction.rate[k], first.turned_z.at.tail<3>());
  }
  const Halves half = halves(first, last);
  double reach = bounds.second_order + rounding;
  for (std::size_t k = 0; k < 4; ++k) reach += std::abs(bounds.twist_rate[k]) * half[k];
  bounds.is_empty = std::abs(bounds.twist) > reach;
  if (!bounds.is_empty) bounds.middle = middle(first, last);
  return bounds;
}

PairAnswer classify_pair(const ThreeArcPose& pose, const Piece& first, const Piece& last,
                         const PairBounds& bounds, int sign) {
  const PositionBound bound = position_bound(pose, first, last, bounds, sign);
  const bool is_over_limit =
      bound.x.at[0] + bound.lean + bounds.second_order < pose.lowest_cosine() - rounding;
  if (is_over_limit || is_out_of_reach(bound, halves(first, last))) return {Verdict::empty, {}};
  if (first.radius + last.radius > 1)
    return {Verdict::open, {}};  // too large for Newton's step to tell anything
  return linear_answer(pose, first, last, bounds, bound, sign);
}

Vec2<double> middle_bend(const ThreeArcPose& pose, const OuterBends& outer) {
  Piece first{}, last{};
  first.along = last.along = Vec2<double>(1, 0);
  first.middle = outer.first;
  last.middle = outer.last;
  pose.first_curve().fill(first);
  pose.last_curve().fill(last);
  const Quaternion m = outer.sign * middle(last.direction.at, first.turned.at, first.turned_z.at);
  // back into the axes of the middle section: the first arc turns by u z⁻¹
  const SO3<double> turn = SO3<double>{0, first.direction.at}.compose({0, Vec3<double>(0, 0, -1)});
  const Vec3<double> u = turn.rotate_back(m.tail<3>());
  const double side = std::hypot(u[0], u[1]), half = std::atan2(side, u[2]);
  return Vec2<double>(u[0], u[1]) * (2 / sinc(half));
}

}  // namespace detail
}  // namespace sinew::inline v1
