#include "math/polygon.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "sinew/kernel/arc.h"

namespace sinew::inline v1 {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();

double largest_offset(std::span<const HalfPlane> half_planes) {
  double largest = 0;
  for (const HalfPlane& h : half_planes) largest = std::max(largest, std::abs(h.offset));
  return largest;
}

/// Whether no direction leads out of all half-planes' depth: their normals leave no gap of half a turn.
bool is_bounded(std::span<const HalfPlane> half_planes) {
  std::vector<double> angle;
  for (const HalfPlane& h : half_planes) angle.push_back(std::atan2(h.normal[1], h.normal[0]));
  if (angle.empty()) return false;
  std::sort(angle.begin(), angle.end());
  double gap = angle.front() + 2 * pi - angle.back();
  for (std::size_t k = 1; k < angle.size(); ++k) gap = std::max(gap, angle[k] - angle[k - 1]);
  return gap < pi - 1e-9;
}

/// Of half-planes whose normals leave such a gap: only two that face each other can have nothing in common.
bool face_away(std::span<const HalfPlane> half_planes) {
  const double tolerance = rounding * largest_offset(half_planes);
  for (const HalfPlane& a : half_planes)
    for (const HalfPlane& b : half_planes)
      if (dot(a.normal, b.normal) < -1 + 1e-15 && a.offset + b.offset > tolerance) return true;
  return false;
}

/// The part of a segment within the disc, as fractions of its way; empty where first > second.
std::pair<double, double> part_in_disc(const Vec2<double>& from, const Vec2<double>& to, double radius) {
  const Vec2<double> way = to - from;
  const double length = way.norm();
  if (!(length > 0)) return from.norm() <= radius ? std::pair(0.0, 1.0) : std::pair(1.0, 0.0);
  const double off = cross(way, from) / length, middle = -dot(way, from) / length;
  const double half = (radius - std::abs(off)) * (radius + std::abs(off));
  if (half < 0) return {1, 0};
  const double root = std::sqrt(half);
  return {std::max(0.0, (middle - root) / length), std::min(1.0, (middle + root) / length)};
}

bool holds(const Polygon& polygon, const Vec2<double>& x) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2<double>& a = polygon[k];
    if (cross(polygon[(k + 1) % polygon.size()] - a, x - a) < 0) return false;
  }
  return polygon.size() > 2;
}

DiscCut cut_thin(const Polygon& polygon, double radius) {
  const Vec2<double> from = polygon.front(), way = polygon.back() - from;
  const auto [first, second] = part_in_disc(from, polygon.back(), radius * (1 + rounding));
  DiscCut cut{radius, {}, {}};
  if (first > second) return cut;
  cut.corners = hull({from + first * way, from + second * way}, rounding * radius);
  cut.arc.assign(cut.corners.size(), 0.0);
  return cut;
}

/// The angle over which the circle leads from one corner to the next, where it is not the polygon that does.
/// Near a full turn the corners are the same but for rounding, and the arc either closes the circle or is
/// none.
double arc_between(const Polygon& polygon, const Vec2<double>& from, const Vec2<double>& to) {
  double angle = std::atan2(cross(from, to), dot(from, to));
  if (angle < 0) angle += 2 * pi;
  if (angle < 6) return angle;
  const double cosine = std::cos(angle / 2), sine = std::sin(angle / 2);
  const Vec2<double> middle(cosine * from[0] - sine * from[1], sine * from[0] + cosine * from[1]);
  return holds(polygon, middle) ? angle : 0;
}

}  // namespace

std::optional<Vec2<double>> crossing(const HalfPlane& a, const HalfPlane& b) {
  const double determinant = cross(a.normal, b.normal);
  if (std::abs(determinant) < 1e-12) return std::nullopt;
  return Vec2<double>(a.offset * b.normal[1] - b.offset * a.normal[1],
                      b.offset * a.normal[0] - a.offset * b.normal[0]) /
         determinant;
}

std::optional<Polygon> intersection(std::span<const HalfPlane> half_planes) {
  if (!is_bounded(half_planes)) return face_away(half_planes) ? std::optional(Polygon{}) : std::nullopt;
  const double scale = largest_offset(half_planes);
  Polygon vertices;
  for (std::size_t i = 0; i < half_planes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto x = crossing(half_planes[i], half_planes[j]);
      if (!x) continue;
      const double tolerance = rounding * (scale + x->norm());
      bool kept = true;
      for (std::size_t k = 0; k < half_planes.size() && kept; ++k)
        kept = k == i || k == j || half_planes[k].depth(*x) >= -tolerance;
      if (kept) vertices.push_back(*x);
    }
  return hull(std::move(vertices), 4 * rounding * scale);
}

double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    twice += cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
  return twice / 2;
}

Polygon hull(Polygon points, double tolerance) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1]; });
  Polygon apart;
  for (const Vec2<double>& p : points)
    if (std::none_of(apart.begin(), apart.end(), [&](const auto& q) { return (p - q).norm() <= tolerance; }))
      apart.push_back(p);
  if (apart.size() < 3) return apart;
  Polygon chain;
  const auto wrap = [&](auto begin, auto end) {  // the lower half from left to right, then the upper one back
    const std::size_t start = chain.size();
    for (auto p = begin; p != end; ++p) {
      while (chain.size() > start + 1) {
        const Vec2<double> a = chain[chain.size() - 2], b = chain.back() - a, c = *p - a;
        if (cross(b, c) > tolerance * c.norm()) break;
        chain.pop_back();
      }
      chain.push_back(*p);
    }
    chain.pop_back();
  };
  wrap(apart.begin(), apart.end());
  wrap(apart.rbegin(), apart.rend());
  return chain;
}

Polygon difference(const Polygon& a, const Polygon& b) {
  Polygon sums;
  double scale = 0;
  for (const Vec2<double>& x : a)
    for (const Vec2<double>& y : b) {
      sums.push_back(x - y);
      scale = std::max({scale, x.norm(), y.norm()});
    }
  return hull(std::move(sums), 4 * rounding * scale);
}

DiscCut cut_with_disc(const Polygon& polygon, double radius) {
  if (polygon.empty()) return {radius, {}, {}};
  if (polygon.size() < 3) return cut_thin(polygon, radius);
  DiscCut cut{radius, {}, {}};
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2<double> from = polygon[k], way = polygon[(k + 1) % polygon.size()] - from;
    const auto [first, second] = part_in_disc(from, from + way, radius);
    if (!(first < second)) continue;
    cut.corners.push_back(from + first * way);
    cut.arc.push_back(0);
    if (second < 1) {
      cut.corners.push_back(from + second * way);
      cut.arc.push_back(1);  // its angle is known with the next corner
    }
  }
  if (cut.corners.empty() && holds(polygon, {0, 0})) return {radius, {{radius, 0}}, {2 * pi}};
  for (std::size_t k = 0; k < cut.arc.size(); ++k)
    if (cut.arc[k] > 0)
      cut.arc[k] = arc_between(polygon, cut.corners[k], cut.corners[(k + 1) % cut.corners.size()]);
  return cut;
}

double area(const DiscCut& cut) {
  double sum = area(cut.corners);
  for (const double angle : cut.arc)  // ½r² (α − sin α), where the difference would lose its digits
    sum -= 0.5 * cut.radius * cut.radius * angle * kernel::chord_loss(angle * angle);
  return sum;
}

Polygon boundary(const DiscCut& cut, double deviation) {
  const double ratio = std::clamp(deviation / cut.radius, 1e-10, 1.0);
  const double step = 4 * std::asin(std::sqrt(ratio / 2));
  Polygon points;
  for (std::size_t k = 0; k < cut.corners.size(); ++k) {
    const Vec2<double>& corner = cut.corners[k];
    points.push_back(corner);
    const int pieces = static_cast<int>(std::ceil(cut.arc[k] / step));
    for (int i = 1; i < pieces; ++i) {
      const double angle = cut.arc[k] * i / pieces, cosine = std::cos(angle), sine = std::sin(angle);
      points.push_back({cosine * corner[0] - sine * corner[1], sine * corner[0] + cosine * corner[1]});
    }
  }
  return points;
}

}  // namespace sinew::inline v1
