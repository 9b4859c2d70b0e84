/// Small symmetric systems against dense ones, and how many eigenvalues are negative.
#include "math/symmetric_factors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace sinew::test {
namespace symmetric_factors_test {

constexpr std::size_t most = 5;
using Factors = SymmetricFactors<most>;

/// Of every size, many of them without anything on the diagonal or with eigenvalues of very different sizes.
template <class Use>
void for_random_matrices(Use&& use) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int repeat = 0; repeat < 2000; ++repeat) {
    const auto size = static_cast<Eigen::Index>(1 + repeat % static_cast<int>(most));
    Eigen::MatrixXd matrix(size, size);
    for (Eigen::Index r = 0; r < size; ++r)
      for (Eigen::Index c = 0; c <= r; ++c) matrix(r, c) = matrix(c, r) = part(random);
    if (repeat % 3 == 1 && size > 1) matrix.diagonal().setZero();
    if (repeat % 3 == 2) {
      const Eigen::VectorXd scale =
          Eigen::VectorXd::NullaryExpr(size, [&] { return std::pow(10, 4 * part(random)); });
      matrix = (scale.asDiagonal() * matrix * scale.asDiagonal()).eval();
    }
    Factors::Square given{};
    for (Eigen::Index r = 0; r < size; ++r)
      for (Eigen::Index c = 0; c < size; ++c)
        given[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = matrix(r, c);
    use(matrix, given);
  }
}

TEST(SymmetricFactors, SolveAsLuDoes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-1, 1);
  Factors factors;  // one for all: nothing of a matrix before may stay
  for_random_matrices([&](const Eigen::MatrixXd& matrix, const Factors::Square& given) {
    const auto size = static_cast<std::size_t>(matrix.rows());
    factors.factor(given, size);
    std::array<double, most> x{};
    for (double& number : x) number = part(random);
    const Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(x.data(), matrix.rows());
    factors.solve(x);
    const Eigen::Map<const Eigen::VectorXd> found(x.data(), matrix.rows());
    const double scale = matrix.cwiseAbs().maxCoeff() * found.cwiseAbs().maxCoeff() + 1;
    EXPECT_LT((matrix * found - right).cwiseAbs().maxCoeff(), 1e-13 * scale);
  });
}

TEST(SymmetricFactors, CountNegativeEigenvalues) {  // Sylvester's law of inertia
  Factors factors;
  int seen = 0;
  for_random_matrices([&](const Eigen::MatrixXd& matrix, const Factors::Square& given) {
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
    if (values.cwiseAbs().minCoeff() < 1e-12 * values.cwiseAbs().maxCoeff()) return;  // of either sign
    factors.factor(given, static_cast<std::size_t>(matrix.rows()));
    EXPECT_EQ(factors.negatives(), (values.array() < 0).count()) << matrix;
    ++seen;
  });
  EXPECT_GT(seen, 1800);
}

TEST(SymmetricFactors, OfWhatIsNoNumberGiveNone) {
  Factors::Square matrix{};
  matrix[0][0] = std::nan("");
  matrix[1][1] = 1;
  Factors factors;
  factors.factor(matrix, 2);
  std::array<double, most> x{1, 1};
  factors.solve(x);
  EXPECT_TRUE(std::isnan(x[0]));
  factors.factor({}, 3);
  factors.solve(x);
  EXPECT_FALSE(std::isfinite(x[0]));
}

}  // namespace symmetric_factors_test
}  // namespace sinew::test
