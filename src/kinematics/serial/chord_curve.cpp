#include "kinematics/serial/chord_curve.hpp"

#include <cmath>
#include <limits>
#include <tuple>

namespace sinew::inline v1 {
namespace detail {
namespace {

constexpr double curve_rounding = 1e-14;  // of f, where lengths are of the size of 1
constexpr double limit_rounding = 1e-12;  // of a bend at its limit [rad]

double cross_2d(const Vec2<double>& a, const Vec2<double>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// f and its gradient.
struct Value {
  double at;
  Vec2<double> gradient;
};
Value value(const ChordCurve& curve, const Vec2<double>& bend) {
  const ChordOfBend chord = chord_of(bend);
  Value f{dot(curve.slope, chord.direction.at) - curve.pull * chord.factor.at[0], {}};
  for (int j = 0; j < 2; ++j) {
    const auto k = static_cast<std::size_t>(j);
    f.gradient[j] = dot(curve.slope, chord.direction.rate[k]) - curve.pull * chord.factor.rate[k][0];
  }
  return f;
}

void set_radius(Piece& piece) { piece.radius = std::hypot(piece.half[0], piece.half[1]); }

/// Bounds of a polygon in the axes of a strip.
struct Box {
  Vec2<double> low, high;
  bool is_empty() const { return !(low[0] <= high[0]); }
  double centre(int i) const { return (low[i] + high[i]) / 2; }
  double half(int i) const { return (high[i] - low[i]) / 2; }
  double area() const { return 4 * half(0) * half(1); }
};

/// What the strip |across| ≤ width along a line leaves of a rectangle. The corners of the cut are corners of
/// the rectangle and points where its sides cross the strip's.
Box strip_in(const Piece& piece, const Vec2<double>& origin, const Vec2<double>& along, double width) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Box box{{infinite, infinite}, {-infinite, -infinite}};
  const auto take = [&](const Vec2<double>& p) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  };
  std::array<Vec2<double>, 4> corner;
  for (std::size_t i = 0; i < 4; ++i) {
    const double a = i == 0 || i == 3 ? -1 : 1, b = i < 2 ? -1 : 1;
    const Vec2<double> p = piece.point(a * piece.half[0], b * piece.half[1]) - origin;
    corner[i] = {dot(along, p), cross_2d(along, p)};
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2<double>&p = corner[i], &q = corner[(i + 1) % 4];
    if (std::abs(p[1]) <= width) take(p);
    for (const double side : {-width, width})
      if ((p[1] < side) != (q[1] < side))
        take({p[0] + (q[0] - p[0]) * ((side - p[1]) / (q[1] - p[1])), side});
  }
  return box;
}

}  // namespace

ChordOfBend chord_of(const Vec2<double>& bend) {
  const double half = bend.norm() / 2;
  const SincPair<double> pair = sinc_pair(half);
  const double s = pair.value, slope = sinc_slope(half);
  ChordOfBend chord;
  chord.direction.at = Vec3<double>(s / 2 * bend[0], s / 2 * bend[1], pair.cos);
  chord.factor.at[0] = s;
  for (int j = 0; j < 2; ++j) {
    const auto k = static_cast<std::size_t>(j);
    Vec3<double>& rate = chord.direction.rate[k];
    rate = Vec3<double>(bend[0], bend[1], 0) * (-slope / 8 * bend[j]);
    rate[j] += s / 2;
    rate[2] = -s / 4 * bend[j];
    chord.factor.rate[k][0] = -slope / 4 * bend[j];
  }
  return chord;
}

ChordBend chord_bend(const Vec2<double>& bend, const Vec2<double>& d, const Vec2<double>& e) {
  const double half = bend.norm() / 2, s = sinc(half), slope = sinc_slope(half), w = half * half;
  const double slope_rate = half < 1e-3 ? -1.0 / 60 : (s - 3 * slope) / (4 * w);  // by b·b/2
  const double along_d = dot(bend, d), along_e = dot(bend, e), de = dot(d, e);
  const double factor = -(slope * de + slope_rate * along_d * along_e) / 4;
  const Vec2<double> side = bend * (factor / 2) - (d * along_e + e * along_d) * (slope / 8);
  return {Vec3<double>(side[0], side[1], slope / 16 * along_d * along_e - s / 4 * de), factor};
}

// n and s are integrals of cosines of |b|/2 and less, so by Bernstein's inequality their k-th derivatives are
// at most 2⁻ᵏ and 2⁻ᵏ/(k+1); that of the chord, an integral of tangents, L/(k+1).
double ChordCurve::bulge(const Vec2<double>& bend, double radius) const {
  const Vec2<double> x(1, 0), y(0, 1);
  double squares = 0;
  for (const auto& [d, e, times] : {std::tuple{x, x, 1}, {x, y, 2}, {y, y, 1}}) {
    const ChordBend second = chord_bend(bend, d, e);
    const double f = dot(slope, second.direction) - pull * second.factor;
    squares += times * f * f;
  }
  const double steep = slope.norm(), strong = std::abs(pull);
  const double here = std::sqrt(squares) + (steep / 8 + strong / 32) / 3 * radius;
  return std::min(here, steep / 4 + strong / 12) / 2 * radius * radius;
}

void ChordCurve::fill_bulges(Piece& piece, const ChordOfBend& chord) const {
  const std::array<Vec2<double>, 2> axis{piece.along, piece.across()};
  const double radius = piece.radius, s = chord.factor.at[0];
  double turned = 0, moved = 0, speed = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    speed += piece.direction.rate[i].norm() * piece.half[i];
    for (std::size_t j = 0; j < 2; ++j) {
      const ChordBend second = chord_bend(piece.middle, axis[i], axis[j]);
      const auto factor_rate = [&](std::size_t k) {
        return chord.factor.rate[0][0] * axis[k][0] + chord.factor.rate[1][0] * axis[k][1];
      };
      const Vec3<double> bend = axes * second.direction;
      const Vec3<double> chord_bend = second.factor * piece.direction.at + s * bend +
                                      factor_rate(i) * piece.direction.rate[j] +
                                      factor_rate(j) * piece.direction.rate[i];
      turned += bend.norm() * piece.half[i] * piece.half[j];
      moved += chord_bend.norm() * piece.half[i] * piece.half[j];
    }
  }
  const double square = radius * radius;
  piece.bulge = std::min(turned + square * radius / 24, square / 4) / 2;
  piece.chord_bulge = length * std::min(moved + square * radius / 12, square / 3) / 2;
  piece.travel = std::min({speed + piece.bulge, radius / 2, 2.0});
}

bool ChordCurve::trim(Piece& piece) const {
  const double margin = curve_rounding;
  for (int i = 0; i < 3; ++i) {
    set_radius(piece);
    if (piece.middle.norm() - piece.radius > limit + limit_rounding) return false;
    const Value f = value(*this, piece.middle);
    const double reach = std::abs(dot(f.gradient, piece.along)) * piece.half[0] +
                         std::abs(dot(f.gradient, piece.across())) * piece.half[1] +
                         bulge(piece.middle, piece.radius) + margin;
    if (std::abs(f.at) > reach) return false;
    const double before = piece.radius;
    const Laid laid = lay_along_curve(piece, margin);
    if (laid == Laid::outside) return false;
    if (laid == Laid::as_it_was || piece.radius > 0.9 * before) return true;
  }
  return true;
}

/// A narrower rectangle along the tangent at the curve's nearest point: what f does there beyond first order
/// bounds how far the curve strays from it.
Laid ChordCurve::lay_along_curve(Piece& piece, double margin) const {
  Vec2<double> near = piece.middle;
  for (int i = 0; i < 2; ++i) {
    const Value f = value(*this, near);
    near -= f.gradient * (f.at / std::max(f.gradient.squaredNorm(), 1e-300));
  }
  const double shift = (near - piece.middle).norm();
  if (!(shift < 2 * piece.radius)) return Laid::as_it_was;
  const Value f = value(*this, near);
  const double steepness = f.gradient.norm(), far = piece.radius + shift;
  if (!(steepness > 0)) return Laid::as_it_was;
  const double stray = (std::abs(f.at) + margin + bulge(near, far)) / steepness;
  const Vec2<double> along = Vec2<double>(-f.gradient[1], f.gradient[0]) / steepness;
  Box box = strip_in(piece, near, along, stray);
  if (box.is_empty()) return Laid::outside;
  if (!(box.area() < 0.9 * 4 * piece.half[0] * piece.half[1])) return Laid::as_it_was;
  piece.along = along;
  piece.middle = near + box.centre(0) * along + box.centre(1) * piece.across();
  piece.half = {box.half(0), box.half(1)};
  set_radius(piece);
  return Laid::narrower;
}

void ChordCurve::fill(Piece& piece) const {
  const ChordOfBend chord = chord_of(piece.middle);
  Mat<double, 2, 2> axes_of_piece;
  axes_of_piece << piece.along, piece.across();
  piece.direction.at = axes * chord.direction.at;
  piece.chord.at = length * chord.factor.at[0] * piece.direction.at;
  for (int j = 0; j < 2; ++j) {
    const Vec2<double> axis = axes_of_piece.col(j);
    const auto k = static_cast<std::size_t>(j);
    piece.direction.rate[k] = axes * (chord.direction.rate[0] * axis[0] + chord.direction.rate[1] * axis[1]);
    const double growth = chord.factor.rate[0][0] * axis[0] + chord.factor.rate[1][0] * axis[1];
    piece.chord.rate[k] =
        length * (growth * piece.direction.at + chord.factor.at[0] * piece.direction.rate[k]);
  }
  const auto product = [](const SO3<double>& q) {  // matrix of u ↦ q u
    Mat<double, 4, 3> m;
    m << -q.v.transpose(), skew(q.v) + q.w * Mat<double, 3, 3>::Identity();
    return m;
  };
  piece.turned = piece.direction.mapped(product(turn));
  piece.turned_z = piece.direction.mapped(product(turn.compose({0, Vec3<double>(0, 0, 1)})));
  fill_bulges(piece, chord);
}

PieceTree::PieceTree(const ChordCurve& curve) : curve_(curve) {
  pieces_.reserve(1000);
  Piece all{};
  all.middle = Vec2<double>(0, 0);
  all.along = Vec2<double>(1, 0);
  all.half = {curve.limit, curve.limit};
  set_radius(all);
  curve_.fill(all);
  pieces_.push_back(all);
}

int PieceTree::add(Piece piece) {
  piece.first_part = Piece::not_split;
  if (!curve_.trim(piece)) return Piece::nothing;
  curve_.fill(piece);
  pieces_.push_back(piece);
  return static_cast<int>(pieces_.size()) - 1;
}

std::array<int, 2> PieceTree::parts(int i) {
  const auto at = static_cast<std::size_t>(i);
  if (pieces_[at].first_part == Piece::not_split) {
    Piece part = pieces_[at];
    const std::size_t longer = part.half[0] >= part.half[1] ? 0 : 1;
    const double quarter = part.half[longer] /= 2;
    const auto centre = [&](double side) {
      return longer == 0 ? part.point(side * quarter, 0) : part.point(0, side * quarter);
    };
    const Vec2<double> low = centre(-1), high = centre(1);
    part.middle = low;
    const int first = add(part);
    part.middle = high;
    const int second = add(part);
    pieces_[at].first_part = first;
    pieces_[at].second_part = second;
  }
  return {pieces_[at].first_part, pieces_[at].second_part};
}

}  // namespace detail
}  // namespace sinew::inline v1
