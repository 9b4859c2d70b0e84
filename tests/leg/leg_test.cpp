/// One suite for every kind of leg of this build: a new link or closure is tested by being in `PlanarLegs`.
#include <gtest/gtest.h>

#include "check_jacobian.hpp"
#include "random_leg.hpp"

namespace sinew::test {
namespace {

template <class List>
struct AsTypes;
template <class... Legs>
struct AsTypes<TypeList<Legs...>> {
  using type = testing::Types<Legs...>;
};

template <class LegT>
struct EveryLeg : testing::Test {
  std::mt19937 random{20261121};
};
TYPED_TEST_SUITE(EveryLeg, AsTypes<PlanarLegs>::type);

/// (x, y, φ, q) → (g, closure error).
template <class LegT>
struct Residual {
  const LegT& leg;
  template <class S>
  Vec<S, 1> operator()(const Vec<S, 4>& z) const {
    const auto platform = SE2<S>::from(z[0], z[1], z[2]);
    return Vec<S, 1>(leg.template blocks<S>(platform, leg.tip(z[3])).g);
  }
};

TYPED_TEST(EveryLeg, BlocksAreTheDerivativesOfTheResidual) {  // @verifies TDPCR (3), (5)-(6), (18)-(20)
  double worst_exact = 0, worst_differences = 0;
  for (int sample = 0; sample < 2000; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const PlanarPose pose = random_pose(this->random);
    const double q = random_curvature(this->random, leg.link.length);
    const auto blocks = leg.template blocks<double>(Planar::frame(pose), leg.tip(q));
    Mat<double, 1, 4> jacobian;
    jacobian << blocks.g_x, blocks.g_q;
    const Vec<double, 4> z(pose.x, pose.y, pose.phi, q);
    const Residual<TypeParam> residual{leg};
    worst_exact = std::max(worst_exact, jacobian_error(jacobian, complex_step_jacobian(residual, z)));
    worst_differences = std::max(worst_differences, jacobian_error(jacobian, central_jacobian(residual, z)));
  }
  EXPECT_LT(worst_exact, 1e-13);
  EXPECT_LT(worst_differences, 1e-8);
}

TYPED_TEST(EveryLeg, SolutionsCloseTheLegAndNoneIsMissed) {
  int solved = 0;
  for (int sample = 0; sample < 2000; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const PlanarPose pose = random_pose(this->random);
    const auto platform = Planar::frame(pose);
    std::array<double, 8> roots;
    const int count = leg.coordinates_at(platform, roots);
    ASSERT_LE(count, 8);
    solved += count > 0;
    for (int i = 0; i < count; ++i) {
      const auto blocks = leg.template blocks<double>(platform, leg.tip(roots[static_cast<std::size_t>(i)]));
      EXPECT_LT(std::abs(blocks.error), 1e-13) << sample;
      if (i > 0) {
        EXPECT_GT(roots[static_cast<std::size_t>(i)], roots[static_cast<std::size_t>(i - 1)]);
      }
    }
    // An independent count: sign changes of g on a fine grid over the whole domain.
    const double end = leg.domain();
    int changes = 0;
    double before = 0;
    for (int k = 0; k <= 4000; ++k) {
      const double q = end * (-1 + 2 * (k + 0.37) / 4001);
      const double g = leg.template blocks<double>(platform, leg.tip(q)).g;
      changes += k > 0 && (g < 0) != (before < 0);
      before = g;
    }
    EXPECT_GE(count, changes) << sample;
    EXPECT_LE(count - changes, 2) << sample;  // a pair may hide between two grid points
  }
  EXPECT_GT(solved, 200);
}

TYPED_TEST(EveryLeg, TheNearestSolutionIsTheNearestOfAll) {
  for (int sample = 0; sample < 5000; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto platform = Planar::frame(random_pose(this->random));
    const double target = sample % 2 ? 0 : random_curvature(this->random, leg.link.length);
    const int sign = sample % 3 - 1;
    std::array<double, 8> roots;
    const int count = leg.coordinates_at(platform, roots);
    double best = 1e9;
    for (int i = 0; i < count; ++i) {
      const double q = roots[static_cast<std::size_t>(i)];
      if (q * sign >= 0) best = std::min(best, std::abs(q - target));
    }
    const NearestRoot found = leg.coordinate_near(platform, target, sign);
    ASSERT_EQ(found.count, best < 1e9) << sample;
    if (found.count) {
      EXPECT_NEAR(std::abs(found.root - target), best, 1e-6) << sample;  // double roots are known to 1e-8
    }
  }
}

TYPED_TEST(EveryLeg, BaseFrameCarriesTheTipToTheAnchor) {
  for (int sample = 0; sample < 500; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto platform = Planar::frame(random_pose(this->random));
    std::array<double, 8> roots;
    const int count = leg.coordinates_at(platform, roots);
    for (int i = 0; i < count; ++i) {
      const auto tip = leg.tip(roots[static_cast<std::size_t>(i)]);
      const auto frame = leg.base_frame(platform, tip);
      const auto anchor = leg.closure.anchor(tip);
      const double distance = (platform.point(leg.platform_point) - frame.point(anchor.position)).norm();
      EXPECT_NEAR(distance, std::sqrt(2 * anchor.half_square), 1e-12);
      if constexpr (TypeParam::Closure::base_turns) {  // then the tip itself is the platform point
        EXPECT_LT((platform.point(leg.platform_point) - frame.point(tip.position)).norm(), 1e-12);
      }
    }
  }
}

TYPED_TEST(EveryLeg, RateRateBoundHolds) {
  for (int sample = 0; sample < 2000; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto platform = Planar::frame(random_pose(this->random));
    const double q = 0.99 * random_curvature(this->random, leg.link.length), h = 1e-3;
    const auto blocks_at = [&](double at) { return leg.template blocks<double>(platform, leg.tip(at)); };
    const auto g_q = [&](double at) { return blocks_at(at).g_q[0]; };
    const double pull = blocks_at(q).g_x.template head<2>().norm() + h * leg.link.bounds().rate;
    const double bound = leg.closure.rate_rate_bound(pull, leg.link.bounds());
    EXPECT_LE(std::abs(g_q(q + h) - g_q(q - h)) / (2 * h), bound * (1 + 1e-6));
  }
}

}  // namespace
}  // namespace sinew::test
