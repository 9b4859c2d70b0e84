#include "math/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "thorough.hpp"

namespace sinew {
namespace polygon_test {

constexpr double pi = std::numbers::pi;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec2<double> towards(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Half-planes with the origin inside, in random directions; some are redundant.
std::vector<HalfPlane> around_origin(std::mt19937& random, int count) {
  std::vector<HalfPlane> all;
  for (int k = 0; k < count; ++k)
    all.push_back({towards(uniform(random, -pi, pi)), -uniform(random, 0.1, 1)});
  return all;
}

bool is_convex(const Polygon& p) {
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Vec2<double>&a = p[k], &b = p[(k + 1) % p.size()], &c = p[(k + 2) % p.size()];
    if (p.size() > 2 && cross(b - a, c - b) <= 0) return false;
  }
  return true;
}

/// Area of a star around the origin by its extent in each direction, midpoint rule.
template <class Extent>
double area_by_rays(const Extent& extent, int rays = 200000) {
  double sum = 0;
  for (int k = 0; k < rays; ++k) {
    const double r = extent(towards(2 * pi * (k + 0.5) / rays));
    sum += r * r;
  }
  return sum * pi / rays;
}

double extent(const std::vector<HalfPlane>& lines, const Vec2<double>& way) {
  double least = 1e9;
  for (const HalfPlane& h : lines)
    if (const double fall = dot(h.normal, way); fall < 0) least = std::min(least, h.offset / fall);
  return least;
}

TEST(Polygon, VerticesAreThoseOfTheCommonPart) {
  std::mt19937 random(1);
  const int samples = test::count_of(400, 2000);
  int bounded = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const auto lines = around_origin(random, 3 + sample % 6);
    const auto found = intersection(lines);
    bool leaves = false;  // in some direction no line is ever met
    for (int k = 0; k < 2000; ++k) leaves |= extent(lines, towards(2 * pi * k / 2000)) > 1e8;
    EXPECT_TRUE(!leaves || !found);
    if (!found) continue;
    ++bounded;
    EXPECT_TRUE(is_convex(*found));
    EXPECT_GE(found->size(), 3u);
    for (const auto& x : *found) {
      int on = 0;
      for (const HalfPlane& h : lines) {
        EXPECT_GT(h.depth(x), -1e-12 * (1 + x.norm()));
        on += std::abs(h.depth(x)) < 1e-12 * (1 + x.norm());
      }
      EXPECT_GE(on, 2);
    }
  }
  EXPECT_GT(bounded, samples / 2);
}

TEST(Polygon, AreaIsThatOfTheCommonPart) {
  std::mt19937 random(2);
  for (int sample = 0; sample < test::count_of(5, 20); ++sample) {
    const auto lines = around_origin(random, 7);
    const auto found = intersection(lines);
    if (!found || area(*found) > 10) continue;
    EXPECT_NEAR(area(*found), area_by_rays([&](const auto& way) { return extent(lines, way); }), 1e-6);
  }
}

TEST(Polygon, WhatIsThinnerThanRoundingIsAPointOrASegment) {
  for (const double gap : {0.0, 1e-17, -1e-17}) {
    std::vector<HalfPlane> triangle, strip;
    for (int k = 0; k < 3; ++k) {
      const Vec2<double> u = towards(0.3 + 2 * pi * k / 3);
      triangle.push_back({u, dot(u, Vec2<double>(0.2, -0.1)) - gap});
    }
    ASSERT_EQ(intersection(triangle)->size(), 1u);
    EXPECT_LT(((*intersection(triangle))[0] - Vec2<double>(0.2, -0.1)).norm(), 1e-15);
    for (int k = 0; k < 4; ++k) strip.push_back({towards(0.3 + pi * k / 2), k % 2 == 0 ? -0.5 : -gap});
    ASSERT_EQ(intersection(strip)->size(), 2u);
    EXPECT_NEAR(((*intersection(strip))[0] - (*intersection(strip))[1]).norm(), 1, 1e-15);
    EXPECT_EQ(area(*intersection(strip)), 0);
  }
}

TEST(Polygon, EmptyAndUnboundedAreTold) {
  const HalfPlane right{{1, 0}, 0.1}, left{{-1, 0}, 0.1}, up{{0, 1}, 0};
  EXPECT_TRUE(intersection(std::array{right, left})->empty());
  EXPECT_TRUE(intersection(std::array{right, left, up})->empty());
  EXPECT_FALSE(intersection(std::array{right, up}));
  EXPECT_FALSE(intersection(std::array{HalfPlane{{1, 0}, -1}, HalfPlane{{-1, 0}, -1}, up}));
  EXPECT_FALSE(intersection({}));
  std::vector<HalfPlane> apart;
  for (int k = 0; k < 3; ++k) apart.push_back({towards(2 * pi * k / 3), 0.1});
  EXPECT_TRUE(intersection(apart)->empty());
}

TEST(Polygon, HullHoldsAllPointsAndHasNoIdleVertex) {
  std::mt19937 random(3);
  for (int sample = 0; sample < 300; ++sample) {
    Polygon points;
    for (int k = 0; k < 1 + sample % 20; ++k)
      points.push_back({uniform(random, -1, 1), uniform(random, -1, 1)});
    const Polygon found = hull(points, 1e-14);
    EXPECT_TRUE(is_convex(found));
    if (found.size() < 3) continue;
    for (const auto& x : points)
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_GT(cross(found[(k + 1) % found.size()] - found[k], x - found[k]), -1e-13);
  }
  const Polygon line{{0, 0}, {0.3, 0.1}, {0.6, 0.2}, {0.9, 0.3}, {0.3, 0.1}};
  EXPECT_EQ(hull(line, 1e-15).size(), 2u);
}

TEST(Polygon, DifferenceHasTheSupportOfBoth) {
  std::mt19937 random(4);
  for (int sample = 0; sample < 200; ++sample) {
    Polygon a, b;
    for (int k = 0; k < 3 + sample % 3; ++k) a.push_back({uniform(random, -1, 1), uniform(random, -1, 1)});
    for (int k = 0; k < 1 + sample % 4; ++k) b.push_back({uniform(random, -1, 1), uniform(random, -1, 1)});
    a = hull(a, 0), b = hull(b, 0);
    const Polygon all = difference(a, b);
    const auto support = [](const Polygon& p, const Vec2<double>& u) {
      double most = -1e9;
      for (const auto& x : p) most = std::max(most, dot(x, u));
      return most;
    };
    for (int k = 0; k < 60; ++k) {
      const Vec2<double> u = towards(uniform(random, -pi, pi));
      EXPECT_NEAR(support(all, u), support(a, u) + support(b, -u), 1e-14);
    }
    EXPECT_LE(all.size(), a.size() + b.size());
  }
}

TEST(Polygon, TriangleMinusALikeTriangleIsAHexagon) {
  const auto triangle = [](double size, const Vec2<double>& at) {
    return Polygon{at + size * towards(0.4), at + size * towards(0.4 + 2 * pi / 3),
                   at + size * towards(0.4 + 4 * pi / 3)};
  };
  const Polygon hexagon = difference(triangle(0.3, {1, 2}), triangle(0.2, {0.5, 0.1}));
  EXPECT_EQ(hexagon.size(), 6u);
  const double own = std::sqrt(27.0) / 4;                             // area of a triangle of circumradius 1
  EXPECT_NEAR(area(hexagon), own * (0.09 + 0.04 + 4 * 0.06), 1e-15);  // A(a) + A(b) + 2 A(a, −b)
}

TEST(DiscCut, AreaIsExactWithItsSegments) {
  std::mt19937 random(5);
  const int samples = test::count_of(15, 60);
  int round = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const auto lines = around_origin(random, 4);
    const auto polygon = intersection(lines);
    if (!polygon) continue;
    const double radius = uniform(random, 0.05, 1.5);
    const DiscCut cut = cut_with_disc(*polygon, radius);
    const auto rays = area_by_rays([&](const auto& way) { return std::min(radius, extent(lines, way)); });
    EXPECT_NEAR(area(cut), rays, 2e-6);
    round += std::any_of(cut.arc.begin(), cut.arc.end(), [](double angle) { return angle > 0; });
    const Polygon points = boundary(cut, 1e-7);
    EXPECT_NEAR(area(points), area(cut), 1e-6);
    EXPECT_LE(area(points), area(cut) + 1e-15);
    for (const auto& x : points) {
      EXPECT_LE(x.norm(), radius * (1 + 1e-14));
      for (const HalfPlane& h : lines) EXPECT_GT(h.depth(x), -1e-13);
    }
  }
  EXPECT_GT(round, samples / 6);
}

TEST(DiscCut, PartsAwayFromTheOriginAreFoundToo) {
  const Polygon square{{0.5, -1}, {3, -1}, {3, 1}, {0.5, 1}};  // a cap over the angle 2 acos 0.5
  const double angle = 2 * pi / 3;
  EXPECT_NEAR(area(cut_with_disc(square, 1)), 0.5 * (angle - std::sin(angle)), 1e-15);
  const Polygon beyond{{1.5, -1}, {3, -1}, {3, 1}, {1.5, 1}};
  EXPECT_TRUE(cut_with_disc(beyond, 1).corners.empty());
  EXPECT_EQ(area(cut_with_disc(beyond, 1)), 0);
  const Polygon large{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}};
  EXPECT_NEAR(area(cut_with_disc(large, 2)), 4 * pi, 1e-14);
  EXPECT_LT(boundary(cut_with_disc(large, 2), 1e-4).size(), 700u);
  const Polygon small{{-0.1, -0.1}, {0.1, -0.1}, {0, 0.1}};
  EXPECT_EQ(area(cut_with_disc(small, 1)), area(small));
}

TEST(DiscCut, CapsDownToNothingKeepTheirDigits) {
  for (const double height : {1e-2, 1e-4, 1e-6}) {  // ½(α − sin α) = ⅔ √2 h^1.5 (1 − 3h/20 − …)·2
    const Polygon square{{1 - height, -1}, {3, -1}, {3, 1}, {1 - height, 1}};
    const double expected = 4.0 / 3 * std::sqrt(2.0) * std::pow(height, 1.5) * (1 - 0.15 * height);
    EXPECT_NEAR(area(cut_with_disc(square, 1)) / expected, 1, 0.1 * height * height + 1e-9);
  }
}

TEST(DiscCut, ThinAndTouchingOnesDoNoHarm) {
  EXPECT_EQ(cut_with_disc({{0.3, 0.4}}, 1).corners.size(), 1u);
  EXPECT_TRUE(cut_with_disc({{0.8, 0.7}}, 1).corners.empty());
  const DiscCut segment = cut_with_disc({{-3, 0.6}, {0, 0.6}}, 1);
  ASSERT_EQ(segment.corners.size(), 2u);
  EXPECT_NEAR(segment.corners[0][0], -0.8, 2e-14);
  EXPECT_EQ(area(segment), 0);
  EXPECT_TRUE(cut_with_disc({}, 1).corners.empty());
  for (const double r : {1 - 1e-15, 1.0, 1 + 1e-15}) {  // through the vertices, up to rounding
    const Polygon triangle{towards(0.1), towards(0.1 + 2 * pi / 3), towards(0.1 + 4 * pi / 3)};
    EXPECT_NEAR(area(cut_with_disc(triangle, r)), area(triangle), 1e-14);
    const Polygon outer{2 * towards(0.1), 2 * towards(0.1 + 2 * pi / 3), 2 * towards(0.1 + 4 * pi / 3)};
    EXPECT_NEAR(area(cut_with_disc(outer, r)), pi, 1e-13);  // touches the sides
  }
  const Polygon square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  EXPECT_EQ(area(cut_with_disc(square, 0)), 0);
}

}  // namespace polygon_test
}  // namespace sinew
