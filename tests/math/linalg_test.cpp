#include "math/linalg.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/SVD>
#include <random>
#include <vector>

#include "base/limits.hpp"
#include "sanitizers.hpp"
#include "sinew/math/se3.hpp"

namespace sinew {
namespace linalg_test {

using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

MatrixView view(const Dense& a) { return {a.data(), a.rows(), a.cols()}; }

Dense random_matrix(std::uint32_t seed, int rows, int columns) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return Dense::NullaryExpr(rows, columns, [&] { return normal(engine); });
}

int size_from(std::uint32_t seed, int shift) { return 1 + static_cast<int>((seed >> shift) % max_rows); }

RC_GTEST_PROP(Linalg, SvdComposesTheMatrixFromOrthogonalParts, (std::uint32_t seed)) {
  const Dense a = random_matrix(seed, size_from(seed, 3), size_from(seed, 13));
  const Svd parts = svd(view(a));
  Dense sigma = Dense::Zero(a.rows(), a.cols());
  for (int i = 0; i < parts.count(); ++i) sigma(i, i) = parts.sigma()[static_cast<std::size_t>(i)];
  const Dense u = parts.u(), v = parts.v();
  RC_ASSERT((u * sigma * v.transpose() - a).norm() < 1e-13 * a.norm());
  RC_ASSERT((u.transpose() * u - Dense::Identity(a.rows(), a.rows())).norm() < 1e-13);
  RC_ASSERT((v.transpose() * v - Dense::Identity(a.cols(), a.cols())).norm() < 1e-13);
  std::vector<double> alone(static_cast<std::size_t>(parts.count()));
  singular_values(view(a), alone);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    RC_ASSERT(std::abs(alone[i] - parts.sigma()[i]) < 1e-14 * alone[0]);
    RC_ASSERT((i == 0 || alone[i] <= alone[i - 1]));  // RapidCheck's || does not stop early: parentheses
  }
}

RC_GTEST_PROP(Linalg, SolveUndoesAProduct, (std::uint32_t seed)) {
  const int n = size_from(seed, 3), m = size_from(seed, 13);
  const Dense j = random_matrix(seed, n, n) + 5 * Dense::Identity(n, n), x = random_matrix(seed + 1, n, m),
              b = j * x;
  Dense found(n, m);
  RC_ASSERT(solve(view(j), view(b), {found.data(), static_cast<std::size_t>(found.size())}));
  std::vector<double> sigma(static_cast<std::size_t>(n));
  singular_values(view(j), sigma);
  RC_ASSERT((found - x).norm() < 1e-14 * n * sigma.front() / sigma.back() * x.norm());
}

TEST(Linalg, SolveSaysSingular) {
  Dense j(3, 3), b(3, 1), x(3, 1);
  b << 1, 2, 3;
  const std::span<double> out(x.data(), 3);
  j << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  EXPECT_FALSE(solve(view(j), view(b), out));
  EXPECT_FALSE(solve(view(Dense::Zero(3, 3)), view(b), out));
  j(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solve(view(j), view(b), out));
  j << 1, 0, 0, 0, 1e-12, 0, 0, 0, 1e3;  // badly scaled, but every digit is there
  EXPECT_TRUE(solve(view(j), view(b), out));
  EXPECT_DOUBLE_EQ(x(1), 2e12);
}

/// Eigen's SVD in long double: 1e-14 of σ₃ at condition 1e5.
std::array<double, 3> reference_3x3(const Dense& a) {
  using Wide = Eigen::Matrix<long double, 3, 3>;
  const Wide wide = a.cast<long double>();
  const Eigen::JacobiSVD<Wide> svd(wide);
  const auto& s = svd.singularValues();
  return {static_cast<double>(s[0]), static_cast<double>(s[1]), static_cast<double>(s[2])};
}

RC_GTEST_PROP(Linalg, SingularValues3x3KeepTheirDigitsNearASingularity, (std::uint32_t seed)) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> exponent(-5, 0), angle(-3, 3);
  const auto turn = [&] { return SO3<double>::exp({angle(engine), angle(engine), angle(engine)}).matrix(); };
  const double two = std::pow(10, exponent(engine)), three = std::min(two, std::pow(10, exponent(engine)));
  const Dense a = 0.37 * (turn() * Vec3<double>(1, two, three).asDiagonal() * turn());
  std::array<double, 3> found;
  singular_values(view(a), found);
  const auto want = reference_3x3(a);
  for (std::size_t i = 0; i < 3; ++i) RC_ASSERT(std::abs(found[i] / want[i] - 1) < 1e-13);
}

TEST(Linalg, SingularValuesOfConditionTenToTheEighth) {
  Dense a(3, 3);
  a << 1, 1, 0, 1, 1 + 0x1p-27, 0, 0, 0, 4;  // block of trace t = 2 + h, determinant h = 2⁻²⁷
  std::array<double, 3> found;
  singular_values(view(a), found);
  const long double h = 0x1p-27L, t = 2 + h, large = (t + std::sqrt(t * t - 4 * h)) / 2;
  EXPECT_DOUBLE_EQ(found[0], 4.0);
  EXPECT_NEAR(found[1] / static_cast<double>(large), 1.0, 1e-15);
  EXPECT_NEAR(found[2] / static_cast<double>(h / large), 1.0, 1e-15);
}

TEST(Linalg, SingularValues3x3OfDegenerateMatrices) {
  std::array<double, 3> s;
  singular_values(view(Dense::Zero(3, 3)), s);
  EXPECT_EQ(s, (std::array<double, 3>{0, 0, 0}));
  singular_values(view(Dense::Ones(3, 3)), s);
  EXPECT_DOUBLE_EQ(s[0], 3.0);
  EXPECT_LT(s[1], 1e-15);
  EXPECT_LT(s[2], 1e-15);
  singular_values(view(Dense::Identity(3, 3) * 1e-200), s);
  EXPECT_EQ(s, (std::array<double, 3>{1e-200, 1e-200, 1e-200}));
  Dense bad = Dense::Identity(3, 3);
  bad(0, 1) = std::numeric_limits<double>::quiet_NaN();
  singular_values(view(bad), s);
  EXPECT_TRUE(std::isnan(s[0]));
}

/// More columns than are decomposed: the values are those of the matrix between orthogonal factors.
RC_GTEST_PROP(Linalg, SingularValuesOfWideMatrices, (std::uint32_t seed)) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto any = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }));
  };
  for (const Eigen::Index rows : {3, 6}) {
    const Eigen::MatrixXd left = any(rows, rows).householderQr().householderQ(),
                          right = any(40, 40).householderQr().householderQ();
    Eigen::VectorXd wanted(rows);
    for (Eigen::Index k = 0; k < rows; ++k) wanted[k] = std::pow(10.0, -static_cast<double>(k));
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix =
        left * wanted.asDiagonal() * right.topRows(rows);
    std::vector<double> found(static_cast<std::size_t>(rows));
    singular_values(MatrixView(matrix.data(), rows, 40), found);
    for (Eigen::Index k = 0; k < rows; ++k)
      RC_ASSERT(std::abs(found[static_cast<std::size_t>(k)] - wanted[k]) < 1e-14);
  }
}

TEST(Linalg, RankCountsAgainstTheLargest) {
  EXPECT_EQ(rank(std::array{1e-20, 1e-21, 1e-40}), 2);
  EXPECT_EQ(rank(std::array{0.0, 0.0}), 0);
  EXPECT_EQ(rank(std::array{3.0, 1.0, 0.1}, 0.1), 2);
  EXPECT_EQ(rank({}), 0);
}

TEST(Linalg, LeastNormIsThePseudoInverse) {
  const Dense a = random_matrix(7, 2, 5), b = random_matrix(8, 2, 1);
  Eigen::VectorXd x(5);
  EXPECT_EQ(least_norm(view(a), {b.data(), 2}, {x.data(), 5}), 2);
  EXPECT_LT((a * x - b).norm(), 1e-14);
  const Svd parts = svd(view(a));
  EXPECT_LT((parts.v().rightCols(3).transpose() * x).norm(), 1e-14);  // nothing along the null space
  const Dense singular = Dense::Ones(2, 5);
  EXPECT_EQ(least_norm(view(singular), {b.data(), 2}, {x.data(), 5}), 1);
  EXPECT_LT((x - Eigen::VectorXd::Constant(5, b.mean() / 5)).norm(), 1e-14);
}

TEST(Linalg, DeterminantOfAProduct) {
  const Dense a = random_matrix(1, 6, 6), b = random_matrix(2, 6, 6), ab = a * b;
  EXPECT_NEAR(determinant(view(ab)) / (determinant(view(a)) * determinant(view(b))), 1.0, 1e-12);
  EXPECT_EQ(determinant(view(Dense::Identity(24, 24))), 1.0);
}

/// By the pivots where they are clear, by eigenvalues near a singular matrix: the same count however the rows
/// are scaled, as forces and moments are.
RC_GTEST_PROP(Linalg, NegativeEigenvaluesAreCounted, (std::uint32_t seed)) {
  const int n = 1 + static_cast<int>(seed % 8);
  const Dense turn = random_matrix(seed, n, n).householderQr().householderQ();
  Eigen::VectorXd values = random_matrix(seed + 1, n, 1);
  if (seed % 3 == 0) values = values.cwiseAbs();
  if (seed % 5 == 0) values[0] = seed % 2 == 0 ? 1e-9 : -1e-9;
  const Eigen::VectorXd scale = random_matrix(seed + 2, n, 1).array().exp();
  const Dense skew = random_matrix(seed + 3, n, n);
  const Dense matrix =
      scale.asDiagonal() * turn * values.asDiagonal() * turn.transpose() * scale.asDiagonal() +
      (skew - skew.transpose());  // what is not symmetric does not count
  RC_ASSERT(count_negative_eigenvalues(view(matrix)) == (values.array() < 0).count());
}

TEST(Linalg, NegativeEigenvaluesOfSingularAndOfNoMatrix) {
  EXPECT_EQ(count_negative_eigenvalues(view(Dense::Zero(6, 6))), 0);
  EXPECT_EQ(count_negative_eigenvalues(view(Dense::Ones(6, 6) - 7 * Dense::Identity(6, 6))), 6);
  Dense broken = Dense::Identity(6, 6);
  broken(2, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(count_negative_eigenvalues(view(broken)), 0);
}

TEST(Linalg, LargerThanTheLargestSizeIsRefusedNotWrittenPastTheEnd) {
  if (test::is_asserted) GTEST_SKIP() << "the library ends there";
  const Dense a = Dense::Identity(25, 25);
  Dense out = Dense::Zero(25, 25);
  const std::span<double> room(out.data(), 625);
  singular_values(view(a), room);
  EXPECT_TRUE(std::isnan(out(0, 0)));
  EXPECT_FALSE(solve(view(a), view(a), room));
  EXPECT_EQ(svd(view(a)).count(), 0);
  EXPECT_TRUE(std::isnan(determinant(view(a))));
}

}  // namespace linalg_test
}  // namespace sinew
