#include "math/polynomial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace sinew {
namespace polynomial_test {

/// Π (x − r) times a factor.
std::vector<double> with_roots(const std::vector<double>& roots, std::vector<double> p = {1}) {
  for (const double r : roots) {
    p.push_back(0);
    for (std::size_t k = p.size() - 1; k > 0; --k) p[k] = p[k - 1] - r * p[k];
    p[0] *= -r;
  }
  return p;
}

double nearest(const PolynomialRoots& roots, double x) {
  double best = 1e300;
  for (const PolynomialRoot& root : roots) best = std::min(best, std::abs(root.x - x));
  return best;
}

TEST(Polynomial, EveryRootIsFound) {
  std::mt19937 random{1};
  for (int sample = 0; sample < 20000; ++sample) {
    std::vector<double> truth(1 + random() % 6);
    for (double& x : truth) x = std::uniform_real_distribution<double>(-2, 2)(random);
    const auto roots = real_roots(with_roots(truth), {.low = -3, .high = 3});
    for (const double x : truth) EXPECT_LT(nearest(roots, x), 1e-3);
    std::sort(truth.begin(), truth.end());
    bool apart = true;
    for (std::size_t i = 1; i < truth.size(); ++i) apart &= truth[i] - truth[i - 1] > 0.1;
    if (!apart) continue;
    ASSERT_EQ(roots.count, static_cast<int>(truth.size()));
    for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_NEAR(roots.root[i].x, truth[i], 1e-9);
  }
}

TEST(Polynomial, RootsOutsideTheIntervalAndComplexOnesAreNot) {
  EXPECT_EQ(real_roots(with_roots({-5, 0.5, 7}), {}).count, 1);
  EXPECT_EQ(real_roots(std::array{1.0, 0.0, 1.0}, {.low = -9, .high = 9}).count, 0);
  EXPECT_EQ(real_roots(with_roots({0.25}, {1, 0, 1, 0, 1}), {}).count, 1);
}

TEST(Polynomial, AMultipleRootIsToldEvenWhereRoundingLiftsIt) {
  for (const double lift : {0.0, 1e-14, -1e-14}) {
    auto p = with_roots({0.3, 0.3, -0.7});
    p[0] += lift;
    const auto roots = real_roots(p, {});
    EXPECT_LT(nearest(roots, 0.3), 1e-6);
    EXPECT_LT(nearest(roots, -0.7), 1e-12);
    EXPECT_TRUE(std::any_of(roots.begin(), roots.end(), [](const auto& root) { return root.touches; }));
  }
  EXPECT_LT(nearest(real_roots(std::array{0.0, 0.0, 1.0}, {}), 0), 1e-9);  // where Σ|cₖ xᵏ| vanishes too
  EXPECT_LT(nearest(real_roots(with_roots({0.1, 0.1, 0.1, 0.1, 0.1, 0.1}), {}), 0.1), 2e-3);
}

TEST(Polynomial, NothingComesOfNothing) {
  EXPECT_EQ(real_roots(std::array{1.0}, {}).count, 0);
  EXPECT_EQ(real_roots(std::array{1.0, std::nan("")}, {}).count, 0);
  EXPECT_EQ(real_roots(std::array{0.5, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, {}).count, 1);  // a line of degree six
  EXPECT_LE(real_roots(std::array<double, 7>{}, {}).count, 63);
}

}  // namespace polynomial_test
}  // namespace sinew
