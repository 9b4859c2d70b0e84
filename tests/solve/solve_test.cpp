#include <gtest/gtest.h>

#include "solve/newton.hpp"
#include "solve/roots.hpp"

namespace sinew {
namespace solve_test {

/// Intersection of a circle and a line y = height: two roots, one double, or none.
struct CircleAndLine {
  double height;
  using Point = Vec2<double>;
  static constexpr int unknowns = 2;
  bool linearise(const Point& p, Linearised<2>& system) const {
    if (p.x() < -50) return false;
    system.residual.resize(2);
    system.jacobian.resize(2, 2);
    system.residual << squared_norm(p) - 1, p.y() - height;
    system.jacobian << 2 * p.x(), 2 * p.y(), 0, 1;
    system.error = system.residual.cwiseAbs().maxCoeff();
    return true;
  }
  Point moved(const Point& p, const Vec2<double>& step) const { return p + step; }
  double shortened(const Vec2<double>&) const { return 1; }
};

TEST(Newton, ConvergesQuadraticallyAndTellsEveryIterate) {
  Vec2<double> p(2, 2);
  std::array<TraceStep, 20> trace{};
  const Report report = newton(CircleAndLine{0.6}, p, {.trace = trace});
  EXPECT_TRUE(report.ok());
  EXPECT_NEAR(p.x(), 0.8, 1e-14);
  EXPECT_LE(report.iterations, 7);
  EXPECT_EQ(trace[0].step, 0);
  for (int i = 1; i <= report.iterations; ++i) {
    EXPECT_EQ(trace[static_cast<std::size_t>(i)].iteration, i);
    EXPECT_LT(trace[static_cast<std::size_t>(i)].residual, trace[static_cast<std::size_t>(i - 1)].residual);
  }
}

TEST(Newton, LeavesASingularStart) {  // at x = 0 the Jacobian has no inverse
  Vec2<double> p(0, 0.3);
  EXPECT_FALSE(newton(CircleAndLine{0.6}, p, {}).status == Status::left_domain);
  Vec2<double> q(1e-12, 0.3);
  EXPECT_TRUE(newton(CircleAndLine{0.6}, q, {}).ok());
}

TEST(Newton, SaysThatItStallsWhereThereIsNoSolution) {
  Vec2<double> p(0.7, 0.1);
  const Report report = newton(CircleAndLine{1.5}, p, {});
  EXPECT_EQ(report.status, Status::stalled);
  EXPECT_GT(report.residual, 0.1);
  EXPECT_LE(report.iterations, 50);
}

TEST(Newton, StopsAtItsLimitWithTheBestIterate) {
  Vec2<double> p(2, 2);
  const Report report = newton(CircleAndLine{0.6}, p, {.max_iterations = 2});
  EXPECT_EQ(report.status, Status::iteration_limit);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_LT(report.residual, 1);
}

TEST(Newton, StartOutsideTheDomainIsNamed) {
  Vec2<double> p(-60, 0);
  EXPECT_EQ(newton(CircleAndLine{0.6}, p, {}).status, Status::left_domain);
}

TEST(Newton, NanInTheProblemEndsHonestly) {
  Vec2<double> p(std::nan(""), 0);
  EXPECT_FALSE(newton(CircleAndLine{0.6}, p, {}).ok());
}

TEST(Roots, FindsEveryRootOfAPolynomial) {
  const auto f = [](double x) {
    return RootSample{(x + 2) * (x + 1.999) * x * (x - 3),
                      (x + 1.999) * x * (x - 3) + (x + 2) * x * (x - 3) + (x + 2) * (x + 1.999) * (x - 3) +
                          (x + 2) * (x + 1.999) * x,
                      500, 1e-14};
  };
  const RootsOptions all{.low = -5, .high = 5, .stride = 1};
  std::array<double, 8> roots;
  ASSERT_EQ(all_roots(f, all, roots), 4);
  EXPECT_NEAR(roots[0], -2, 1e-12);
  EXPECT_NEAR(roots[1], -1.999, 1e-12);
  EXPECT_NEAR(roots[2], 0, 1e-14);
  EXPECT_NEAR(roots[3], 3, 1e-14);
  EXPECT_NEAR(nearest_root(f, all, 1.6).root, 3, 1e-14);
  EXPECT_NEAR(nearest_root(f, all, 1.4).root, 0, 1e-14);
  EXPECT_NEAR(nearest_root(f, all, 40).root, 3, 1e-14);
  EXPECT_EQ(nearest_root(f, {.low = 1, .high = 2, .stride = 1}, 1.4).count, 0);
}

TEST(Roots, ARootIsToldOnceHoweverFlatAndAMissIsNone) {
  const auto power = [](int n, double shift, double noise) {
    return [=](double x) {
      return RootSample{std::pow(x - 0.3, n) + shift, n * std::pow(x - 0.3, n - 1), 8, noise};
    };
  };
  const RootsOptions options{.low = -1, .high = 1, .stride = 1};
  std::array<double, 8> roots;
  for (const int n : {2, 3}) {
    ASSERT_EQ(all_roots(power(n, 0, 1e-16), options, roots), 1) << n;
    EXPECT_NEAR(roots[0], 0.3, 1.1 * std::pow(1e-16, 1.0 / n)) << n;
  }
  EXPECT_EQ(all_roots(power(2, 1e-9, 1e-16), options, roots), 0);
  EXPECT_EQ(all_roots(power(2, -1e-9, 1e-16), options, roots), 2);
  EXPECT_EQ(all_roots(power(1, 0, 0), options, roots), 1);  // a change of sign tells a root too
  EXPECT_NEAR(roots[0], 0.3, 1e-16);
}

TEST(Roots, NearestPrefersTheLargerOfTwoEquallyNear) {
  const auto f = [](double x) { return RootSample{x * x - 0.25, 2 * x, 2, 1e-16}; };
  EXPECT_EQ(nearest_root(f, {.low = -1, .high = 1, .stride = 1}, 0).root, 0.5);
}

TEST(Roots, NotANumberEndsAtOnce) {
  const auto f = [](double) { return RootSample{std::nan(""), 0, 1, 1e-16}; };
  std::array<double, 8> roots;
  EXPECT_EQ(all_roots(f, {.low = -1, .high = 1, .stride = 1}, roots), -1);
  EXPECT_EQ(nearest_root(f, {.low = -1, .high = 1, .stride = 1}, 0).count, -1);
}

TEST(Report, IsOneLine) {
  Report report;
  report.iterations = 4;
  report.residual = 5e-14;
  EXPECT_EQ(to_string(report), "converged in 4 iterations, residual 5.0e-14");
  report.status = Status::stalled;
  report.message.append("legs[1] misses by 3 mm");
  EXPECT_EQ(to_string(report), "stalled after 4 iterations, residual 5.0e-14: legs[1] misses by 3 mm");
}

}  // namespace solve_test
}  // namespace sinew
