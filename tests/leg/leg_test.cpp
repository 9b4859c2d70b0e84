/// One suite for every kind of leg of this build: a new link or closure is tested by being in `PlanarLegs` or
/// `SpatialLegs`.
#include <gtest/gtest.h>

#include "check_jacobian.hpp"
#include "leg/leg_curvature.hpp"
#include "leg/project.hpp"
#include "random_leg.hpp"
#include "robot/catalog.hpp"

namespace sinew::test {
namespace leg_test {

template <class First, class Second>
struct AsTypes;
template <class... P, class... S>
struct AsTypes<TypeList<P...>, TypeList<S...>> {
  using type = testing::Types<P..., S...>;
};

template <class LegT>
struct EveryLeg : testing::Test {
  using Space = typename LegT::Space;
  using Frame = typename LegT::Frame;
  using Coordinates = typename LegT::Coordinates;
  static constexpr int dof = Space::dof, Q = LegT::coordinates, R = LegT::rows;

  std::mt19937 random{20261121};

  Frame platform() { return random_frame<Space>(random, 0.1); }
  /// A platform whose point is where a hinge may hold it.
  Frame platform(const LegT& leg) {
    Frame any = platform();
    if constexpr (LegT::has_plane) {
      const Vec3<double> axis = leg.base.rotate(Vec3<double>(1, 0, 0));
      any.p -= axis * dot(axis, any.point(leg.platform_point) - leg.base.p);
    }
    return any;
  }
  /// Wide enough for every solution of such legs and platforms.
  static double range(const LegT& leg) { return HasSlide<typename LegT::Link> ? 2 : leg.domain(); }
  static auto at(const LegT& leg, const Frame& platform, const Coordinates& q) {
    return leg.template blocks<double>(platform, leg.template tip<double>(q));
  }
};
using AllLegs = AsTypes<PlanarLegs, SpatialLegs>::type;
TYPED_TEST_SUITE(EveryLeg, AllLegs);

/// (small motion of the platform, q) → g.
template <class LegT>
struct Residual {
  static constexpr int dof = LegT::Space::dof, Q = LegT::coordinates;
  const LegT& leg;
  typename LegT::Frame platform;
  template <class S>
  Vec<S, LegT::rows> operator()(const Vec<S, dof + Q>& z) const {
    const Vec<S, dof> motion = z.template head<dof>();
    const Vec<S, Q> q = z.template tail<Q>();
    const auto moved = LegT::Space::template cast<S>(platform).displaced(motion);
    return leg.template blocks<S>(moved, leg.template tip<S>(q)).g;
  }
};

TYPED_TEST(EveryLeg, BlocksAreTheDerivativesOfTheResidual) {
  // @verifies TDPCR (3), (5)-(6), (18)-(20), (56)-(58), (64)
  // @verifies 3PFS (1)-(2), (11), (13), (15)-(16)
  double worst_exact = 0, worst_differences = 0;
  for (int sample = 0; sample < 2000; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto platform = this->platform();
    const auto q = random_coordinates(this->random, leg);
    const auto blocks = this->at(leg, platform, q);
    Mat<double, TypeParam::rows, Residual<TypeParam>::dof + Residual<TypeParam>::Q> jacobian;
    jacobian << blocks.g_x, blocks.g_q;
    Vec<double, Residual<TypeParam>::dof + Residual<TypeParam>::Q> z;
    z << Vec<double, Residual<TypeParam>::dof>::Zero(), q;
    const Residual<TypeParam> residual{leg, platform};
    worst_exact = std::max(worst_exact, jacobian_error(jacobian, complex_step_jacobian(residual, z)));
    worst_differences = std::max(worst_differences, jacobian_error(jacobian, central_jacobian(residual, z)));
  }
  EXPECT_LT(worst_exact, 1e-13);
  EXPECT_LT(worst_differences, 1e-8);
}

/// (small motion of the platform, change of q) → the wrench of multipliers.
template <class LegT>
struct WrenchOfRows {
  static constexpr int dof = LegT::Space::dof, Q = LegT::coordinates;
  const LegT& leg;
  typename LegT::Frame platform;
  Vec<double, LegT::rows> multipliers;
  template <class S>
  Vec<S, dof> operator()(const Vec<S, dof + Q>& z) const {
    const Vec<S, dof> motion = z.template head<dof>();
    const Vec<S, Q> q = z.template tail<Q>();
    const auto moved = LegT::Space::template cast<S>(platform).displaced(motion);
    const auto g_x = leg.template blocks<S>(moved, leg.template tip<S>(q)).g_x;
    return g_x.transpose() * multipliers.template cast<S>();
  }
};

TYPED_TEST(EveryLeg, CurvatureIsTheDerivativeOfTheWrench) {
  double worst = 0;
  for (int sample = 0; sample < 2000; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto platform = this->platform();
    Vec<double, WrenchOfRows<TypeParam>::dof + WrenchOfRows<TypeParam>::Q> z;
    z << Vec<double, WrenchOfRows<TypeParam>::dof>::Zero(), random_coordinates(this->random, leg);
    Vec<double, TypeParam::rows> multipliers;
    for (double& one : multipliers) one = std::normal_distribution()(this->random);
    const auto change = leg_curvature(
        leg, platform, typename TypeParam::Coordinates(z.template tail<WrenchOfRows<TypeParam>::Q>()),
        multipliers);
    Mat<double, WrenchOfRows<TypeParam>::dof, WrenchOfRows<TypeParam>::dof + WrenchOfRows<TypeParam>::Q>
        jacobian;
    jacobian << change.by_platform, change.by_coordinates;
    const WrenchOfRows<TypeParam> wrench{leg, platform, multipliers};
    worst = std::max(worst, jacobian_error(jacobian, complex_step_jacobian(wrench, z)));
  }
  EXPECT_LT(worst, 1e-13);
}

TYPED_TEST(EveryLeg, InputsAndCoordinatesUndoEachOther) {  // @verifies TDPCR (65)-(66)
  for (int sample = 0; sample < 500; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto q = random_coordinates(this->random, leg);
    const auto a = leg.inputs_of(q);
    const auto back = leg.coordinates_of(std::span<const double>(a.data(), TypeParam::inputs));
    EXPECT_LT((back - q).norm(), 1e-11 * (1 + q.norm()));
    const auto of_inputs = [&](const Vec<double, TypeParam::inputs>& input) {
      return leg.coordinates_of(std::span<const double>(input.data(), TypeParam::inputs));
    };
    EXPECT_LT(check_jacobian_real(of_inputs, a, leg.input_rate()), 1e-7);
  }
}

TYPED_TEST(EveryLeg, SolutionsCloseTheLeg) {
  int solved = 0;
  for (int sample = 0; sample < 2000; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto platform = this->platform(leg);
    const SolutionPreference wish{.near = random_branch(this->random, leg)};
    std::array<typename TypeParam::Coordinates, 8> roots;
    const int count = leg.solutions_at(platform, wish, roots);
    ASSERT_LE(count, 8);
    solved += count > 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(count, 0)); ++i) {
      EXPECT_LT(std::abs(this->at(leg, platform, roots[i]).error), 1e-13) << sample;
      EXPECT_TRUE(leg.in_domain(roots[i]));
      if (i > 0) {
        EXPECT_GE(leg.link.branch(roots[i]), leg.link.branch(roots[i - 1]));
      }
    }
  }
  EXPECT_GT(solved, 200);
}

TYPED_TEST(EveryLeg, NoSolutionIsMissed) {
  for (int sample = 0; sample < 500; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto platform = this->platform(leg);
    std::array<typename TypeParam::Coordinates, 8> roots;
    const int count = leg.solutions_at(platform, {}, roots);
    if constexpr (TypeParam::coordinates == 1) {  // sign changes of g on a fine grid over the whole domain
      int changes = 0;
      double before = 0;
      for (int k = 0; k <= 4000; ++k) {
        const double q = this->range(leg) * (-1 + 2 * (k + 0.37) / 4001);
        const double g = this->at(leg, platform, typename TypeParam::Coordinates(q)).g[0];
        changes += k > 0 && (g < 0) != (before < 0);
        before = g;
      }
      EXPECT_GE(count, changes) << sample;
      EXPECT_LE(count - changes, 2) << sample;  // a pair may hide between two grid points
    } else {  // Newton from anywhere ends on none where none is told, and a pin's on those that are
      for (int start = 0; start < 20; ++start) {
        auto q = random_coordinates(this->random, leg);
        if (!project(leg, platform, 1e-14, q).ok) continue;
        EXPECT_GT(count, 0) << sample;
        if (TypeParam::is_redundant) continue;
        double nearest = 1;
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
          nearest = std::min(nearest, std::abs(leg.link.branch(q) - leg.link.branch(roots[i])));
        EXPECT_LT(nearest, 1e-4) << sample;
      }
    }
  }
}

TYPED_TEST(EveryLeg, TheNearestSolutionIsTheNearestOfAll) {
  for (int sample = 0; sample < 3000; ++sample) {
    const auto leg = random_leg<TypeParam>(this->random);
    const auto platform = this->platform(leg);
    const double target = sample % 2 ? 0 : random_branch(this->random, leg);
    const SolutionPreference wish{.near = target,
                                  .bending = HasArc<typename TypeParam::Link> ? sample % 3 - 1 : 0};
    std::array<typename TypeParam::Coordinates, 8> roots;
    const int count = leg.solutions_at(platform, wish, roots);
    double best = 1e9;
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(count, 0)); ++i) {
      const double branch = leg.link.branch(roots[i]);
      if (branch * wish.bending >= 0) best = std::min(best, std::abs(branch - target));
    }
    const auto found = leg.nearest_solution(platform, wish);
    ASSERT_EQ(found.count > 0, best < 1e9) << sample;
    if (found.count > 0) {
      EXPECT_NEAR(std::abs(leg.link.branch(found.q) - target), best, 1e-6) << sample;
      EXPECT_LT(found.closure_error, 1e-13);
    }
  }
}

TYPED_TEST(EveryLeg, LinkFrameCarriesTheBackboneToTheAnchor) {
  if constexpr (!HasArc<typename TypeParam::Link>) {
    GTEST_SKIP() << "it has no backbone";
  } else {
    using Vector = Vec<double, TypeParam::dimension>;
    for (int sample = 0; sample < 500; ++sample) {
      const auto leg = random_leg<TypeParam>(this->random);
      const auto platform = this->platform(leg);
      std::array<typename TypeParam::Coordinates, 8> roots;
      const int count = leg.solutions_at(platform, {}, roots);
      for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(count, 0)); ++i) {
        const auto& arc = leg.link.arc();
        Vector end = Vector::Zero();
        end.template head<2>() = arc.point(leg.link.curvature(roots[i]), arc.length);
        const Vector tip = leg.link_frame(platform, roots[i]).point(end);
        const Vector head = platform.point(leg.platform_point);
        const auto reach = leg.reach(roots[i]);
        EXPECT_NEAR((head - reach.anchor).norm(), reach.distance, 1e-12);
        if (TypeParam::Closure::base_turns || reach.distance == 0) {  // then the tip is the platform point
          EXPECT_LT((head - tip).norm(), 1e-12);
        } else {
          EXPECT_LT((reach.anchor - tip).norm(), 1e-12);
        }
        const LegState state = leg.state(platform, roots[i]);
        EXPECT_NEAR(state.base_tangent.norm(), 1, 1e-14);
      }
    }
  }
}

TYPED_TEST(EveryLeg, RateRateBoundHolds) {
  if constexpr (TypeParam::coordinates == 1 && HasArc<typename TypeParam::Link>) {
    for (int sample = 0; sample < 2000; ++sample) {
      const auto leg = random_leg<TypeParam>(this->random);
      const auto platform = this->platform(leg);
      const double q = 0.99 * random_curvature(this->random, leg.link.length), h = 1e-3;
      const auto g_q = [&](double x) {
        return this->at(leg, platform, typename TypeParam::Coordinates(x)).g_q[0];
      };
      const double pull = this->at(leg, platform, typename TypeParam::Coordinates(q))
                              .g_x.template head<TypeParam::dimension>()
                              .norm() +
                          h * leg.link.bounds().rate;
      const double bound = rate_rate_bound<typename TypeParam::Closure>(pull, leg.link.bounds());
      EXPECT_LE(std::abs(g_q(q + h) - g_q(q - h)) / (2 * h), bound * (1 + 1e-6));
    }
  }
}

using PrsLeg = Leg<Spatial, Rail, SlideDrive, HingedStrut>;

TEST(HingedStrut, ItsAngleTurnsItFromTheRailToThePlatformPoint) {
  std::mt19937 random{5};
  for (int sample = 0; sample < 300; ++sample) {
    const auto leg = random_leg<PrsLeg>(random);
    auto platform = random_frame<Spatial>(random, 0.1);
    const Vec3<double> axis = leg.base.rotate(Vec3<double>(1, 0, 0)),
                       rail = leg.base.rotate(Vec3<double>(0, 1, 0));
    platform.p -= axis * dot(axis, platform.point(leg.platform_point) - leg.base.p);
    std::array<PrsLeg::Coordinates, 8> roots;
    const int count = leg.solutions_at(platform, {}, roots);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      const LegState state = leg.state(platform, roots[i]);
      EXPECT_LT((state.carriage - leg.base.p - rail * roots[i][0]).norm(), 1e-15);
      const Vec3<double> strut = SO3<double>::exp(axis * state.hinge_angle).rotate(rail) * leg.closure.length;
      EXPECT_LT((state.carriage + strut - platform.point(leg.platform_point)).norm(), 1e-14);
      EXPECT_EQ(state.elbow, i == 0 ? 1 : -1);  // the lower slide points ahead
      const auto only = leg.nearest_solution(platform, {.elbow = state.elbow});
      EXPECT_EQ(only.q, roots[i]);
      EXPECT_EQ(leg.reach(roots[i]).rows(), 2);
      EXPECT_LT((leg.reach(roots[i]).anchor - state.carriage).norm(), 1e-15);
      EXPECT_LT((leg.reach(roots[i]).normal - axis).norm(), 1e-15);
    }
  }
}

TEST(HingedStrut, APointBesideItsPlaneOrTooFarFromItsRailHasNoSolution) {
  PrsLeg leg{};
  leg.closure.length = 0.35;
  std::array<PrsLeg::Coordinates, 8> roots;
  const auto at = [&](double beside, double off) {
    return leg.solutions_at(SE3<double>{Vec3<double>(beside, 0.2, off), {}}, {}, roots);
  };
  EXPECT_EQ(at(0, 0.1), 2);
  EXPECT_EQ(at(0, 0.35), 1);  // square to the rail: both are one
  EXPECT_NEAR(roots[0][0], 0.2, 1e-15);
  EXPECT_EQ(at(0, 0.35 + 1e-15), 0);
  EXPECT_EQ(at(1e-10, 0.1), 2);  // within rounding of people's numbers
  EXPECT_EQ(at(1e-9, 0.1), 0);
  EXPECT_EQ(at(std::nan(""), 0.1), 0);
  EXPECT_EQ(at(0, std::nan("")), 0);
}

TEST(UniversalJoint, ItsSecondAxisIsTheNormalOfTheBendingPlane) {  // e = unit(g × r), TDPCR 4.1
  std::mt19937 random{3};
  using UfsLeg = Leg<Spatial, Arc, TendonPair, Chord>;
  for (int sample = 0; sample < 300; ++sample) {
    const auto leg = random_leg<UfsLeg>(random);
    const auto platform = random_frame<Spatial>(random, 0.1);
    const UfsLeg::Coordinates q(random_curvature(random, leg.link.length));
    const Vec3<double> r = leg.offset<double>(platform), g = leg.base.rotate(Vec3<double>(1, 0, 0));
    const Vec3<double> e = cross(g, r).normalized();
    const auto frame = leg.link_frame(platform, q);
    EXPECT_LT((frame.rotate(Vec3<double>(0, 0, 1)) - e).norm(), 1e-12);
    // turned by both angles one after the other, the axes are those of the link
    const auto [first, second] = leg.state(platform, q).joint_angles;
    const auto turned = leg.base.R.compose(SO3<double>::exp(Vec3<double>(first, 0, 0)))
                            .compose(SO3<double>::exp(Vec3<double>(0, 0, second)));
    EXPECT_LT((turned.rotate(Vec3<double>(0, 1, 0)) - leg.state(platform, q).base_tangent).norm(), 1e-13);
    // κ > 0 bends clockwise about e: the tangent leads the chord by half the bend, counter-clockwise
    const Vec3<double> tangent = leg.state(platform, q).base_tangent, chord = r.normalized();
    const double lead = std::atan2(dot(cross(chord, tangent), e), dot(chord, tangent));
    EXPECT_NEAR(std::remainder(lead - q[0] * leg.link.length / 2, 2 * std::numbers::pi), 0, 1e-9);
  }
}

}  // namespace leg_test
}  // namespace sinew::test
