/// Least squares with bounds, against the conditions of Karush, Kuhn and Tucker and against all active sets.
#include "kinematics/arms/tensions/bounded_least_squares.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "thorough.hpp"
#include "uniform.hpp"

namespace sinew::test::bounded_least_squares_test {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

struct Problem {
  Matrix A;
  Vector b, centre;
  double most = 1;

  Vector solve() const {
    const auto list = [](const auto& matrix) {
      return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
    };
    const std::vector<double> x = bounded_least_squares(list(A), list(b), list(centre), most);
    EXPECT_EQ(static_cast<Eigen::Index>(x.size()), centre.size());
    return Eigen::Map<const Vector>(x.data(), static_cast<Eigen::Index>(x.size()));
  }
  double squares(const Vector& x) const { return (A * x - b).squaredNorm(); }
};

Vector any_vector(std::mt19937& random, Eigen::Index size, double low, double high) {
  Vector vector(size);
  for (double& x : vector) x = uniform(random, low, high);
  return vector;
}

/// Of few numbers, with columns that are 0, or one another's multiples, and places that bounds are met at.
Problem any_problem(std::mt19937& random) {
  const auto rows = static_cast<Eigen::Index>(1 + random() % 6),
             columns = static_cast<Eigen::Index>(1 + random() % 6);
  Problem problem;
  problem.A.resize(rows, columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    const auto kind = random() % 6;
    if (kind == 0)
      problem.A.col(i).setZero();
    else if (kind == 1 && i > 0)
      problem.A.col(i) = uniform(random, -2, 2) * problem.A.col(static_cast<Eigen::Index>(random()) % i);
    else
      problem.A.col(i) = any_vector(random, rows, -1, 1);
  }
  problem.most = random() % 8 == 0 ? 0 : random() % 8 == 1 ? infinity : uniform(random, 0.1, 3);
  problem.centre = any_vector(random, columns, -0.5, 2);
  problem.b = random() % 2 == 0
                  ? any_vector(random, rows, -2, 2)
                  : Vector(problem.A * any_vector(random, columns, 0, std::min(problem.most, 2.0)));
  return problem;
}

/// With some of x free and the others at one of their bounds, each way: least squares of A x = side of the
/// free ones, those nearest to `from`. What is within the bounds goes to `look`.
template <class Look>
void for_all_active_sets(const Problem& problem, const Vector& side, const Vector& from, const Look& look) {
  const Eigen::Index n = problem.A.cols();
  for (int set = 0, all = static_cast<int>(std::lround(std::pow(3, n))); set < all; ++set) {
    Vector x = Vector::Zero(n);
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0, rest = set; i < n; ++i, rest /= 3) {
      if (rest % 3 == 0) free.push_back(i);
      if (rest % 3 == 2) x[i] = problem.most;
    }
    if (!x.allFinite()) continue;
    if (!free.empty()) {
      const Matrix columns = problem.A(Eigen::all, free);
      const Vector near = from(free), left = side - problem.A * x - columns * near;
      x(free) = near + Vector(columns.completeOrthogonalDecomposition().solve(left));
    }
    if (x.minCoeff() >= -1e-9 && x.maxCoeff() <= problem.most + 1e-9) look(x);
  }
}

double least_squares(const Problem& problem) {
  double least = infinity;
  for_all_active_sets(problem, problem.b, problem.centre,
                      [&](const Vector& x) { least = std::min(least, problem.squares(x)); });
  return least;
}

/// Of all that have the same A x, and so the same squares, the one nearest to the centre.
std::optional<Vector> nearest(const Problem& problem, const Vector& same) {
  std::optional<Vector> best;
  const Vector side = problem.A * same;
  for_all_active_sets(problem, side, problem.centre, [&](const Vector& x) {
    if ((problem.A * x - side).norm() <= 1e-7 * (1 + side.norm()) &&
        (!best || (x - problem.centre).norm() < (*best - problem.centre).norm()))
      best = x;
  });
  return best;
}

/// What the squares' slope is off at x: of those that are free, and of those at bounds where it leads
/// inwards.
double off_stationary(const Problem& problem, const Vector& x) {
  const Vector slope = problem.A.transpose() * (problem.A * x - problem.b);
  const double near = 1e-9 * (1 + std::min(problem.most, 1.0));
  double off = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (x[i] > near) off = std::max(off, slope[i]);
    if (x[i] < problem.most - near) off = std::max(off, -slope[i]);
  }
  return off;
}

TEST(BoundedLeastSquares, LeastOfAllActiveSetsAndNearestToTheCentre) {
  std::mt19937 random(11);
  for (int k = 0, all = count_of(600, 6000); k < all; ++k) {
    const Problem problem = any_problem(random);
    const Vector x = problem.solve();
    ASSERT_TRUE(x.allFinite()) << k;
    EXPECT_GE(x.minCoeff(), 0) << k;
    EXPECT_LE(x.maxCoeff(), problem.most) << k;
    const double size = 1 + problem.b.norm();
    EXPECT_LT(off_stationary(problem, x), 1e-8 * size) << k;
    EXPECT_NEAR(problem.squares(x), least_squares(problem), 1e-8 * size * size) << k;
    const auto near = nearest(problem, x);
    ASSERT_TRUE(near) << k;
    EXPECT_LT((x - *near).norm(), 1e-5 * size)
        << k << "\nx " << x.transpose() << "\nnearest " << near->transpose();
  }
}

/// As of a robot: many more columns than rows. A target far beyond what they reach binds most of them.
TEST(BoundedLeastSquares, ManyTensionsAreStationary) {
  std::mt19937 random(12);
  for (int k = 0, all = count_of(60, 600); k < all; ++k) {
    Problem problem;
    const auto columns = static_cast<Eigen::Index>(6 + random() % 30);
    problem.A = Matrix::NullaryExpr(6, columns, [&] { return uniform(random, -1, 1); });
    problem.most = uniform(random, 0.5, 5);
    problem.centre = any_vector(random, columns, 0, problem.most);
    problem.b = any_vector(random, 6, -10, 10);
    const Vector x = problem.solve();
    EXPECT_GE(x.minCoeff(), 0) << k;
    EXPECT_LE(x.maxCoeff(), problem.most) << k;
    EXPECT_LT(off_stationary(problem, x), 1e-7) << k;
  }
}

TEST(BoundedLeastSquares, WithoutRowsOrRoomTheCentreOrTheBoundsAreTaken) {
  EXPECT_EQ(bounded_least_squares({}, {}, {0.2, -1, 5}, 2), (std::vector<double>{0.2, 0, 2}));
  EXPECT_EQ(bounded_least_squares({0, 0}, {1}, {0.2, 0.4}, 2), (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(bounded_least_squares({1, 2}, {1}, {0.2, 0.4}, 0), (std::vector<double>{0, 0}));
  EXPECT_TRUE(bounded_least_squares({}, {1}, {}, 1).empty());
}

TEST(BoundedLeastSquares, WithoutABoundAboveNoneIsMet) {
  const std::vector<double> x = bounded_least_squares({0.1, 0, 0, 1}, {500, -1}, {0, 0}, infinity);
  EXPECT_NEAR(x[0], 5000, 1e-3);
  EXPECT_EQ(x[1], 0);
}

/// What is not finite has no answer that looks like one.
TEST(BoundedLeastSquares, WhatIsNotFiniteIsNotAnswered) {
  std::mt19937 random(13);
  for (int k = 0; k < 200; ++k) {
    Problem problem = any_problem(random);
    const double wrong = std::array{nan, infinity, -infinity}[static_cast<std::size_t>(k % 3)];
    const auto put = [&](auto& matrix) {
      matrix.data()[random() % static_cast<std::size_t>(matrix.size())] = wrong;
    };
    switch (random() % 4) {
      case 0:
        put(problem.A);
        break;
      case 1:
        put(problem.b);
        break;
      case 2:
        put(problem.centre);
        break;
      default:
        problem.most = nan;
    }
    EXPECT_TRUE(problem.solve().array().isNaN().all()) << k << ' ' << wrong;
  }
}

}  // namespace sinew::test::bounded_least_squares_test
