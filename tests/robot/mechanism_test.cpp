/// Rods and closing legs on one platform, against the rigid robot, differences and balances.
#include <gtest/gtest.h>

#include <cmath>

#include "rod_robots.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {
namespace mechanism_test {

Robot builtin(const char* name) { return load(name).value(); }

/// Legs of one robot beside rods around it, each as often as it is named.
Robot beside(const Robot& closing, std::span<const std::size_t> kept, std::span<const RodLeg> rods,
             const SpatialPose& home) {
  std::vector<AnySpatialLeg> legs;
  closing.spatial()->for_each_closing_leg([&](const auto& leg, const LegPlace&, int i) {
    for (auto left = std::ranges::count(kept, static_cast<std::size_t>(i)); left > 0; --left)
      legs.push_back(AnySpatialLeg{leg});
  });
  for (const RodLeg& rod : rods)
    legs.insert(legs.begin() + static_cast<std::ptrdiff_t>(legs.size() / 2), {rod});
  return Robot("mixed", SpatialRobot(legs, home, 0.1));
}

/// @param ahead of the platform point's azimuth before that of the guide
RodLeg rod_at(double azimuth, double base_radius, double platform_radius, bool is_clamped = false,
              double ahead = 0) {
  const auto out = [](double angle) { return Vec3<double>(std::cos(angle), std::sin(angle), 0); };
  RodLeg leg = rod_leg(base_radius * out(azimuth), platform_radius * out(azimuth + ahead), 0.05);
  leg.is_clamped = is_clamped;
  return leg;
}

SpatialWrench load() {
  SpatialWrench wrench;
  wrench << 1, -0.5, -4, 0.02, 0.05, -0.03;
  return wrench;
}

double distance(const SpatialPose& a, const SpatialPose& b) {
  const SE3<double> p = SE3<double>::from(a), q = SE3<double>::from(b);
  return (p.p - q.p).norm() + p.R.inverse().compose(q.R).log().norm();
}

/// All six freedoms are held by struts: rods and load do not move the platform, which is where that of the
/// rigid robot is.
TEST(Mechanism, RodsDoNotMoveARigidTripod) {
  const Robot rigid = builtin("3prs");
  const SpatialPose home = std::get<SpatialPose>(sinew::home(rigid));
  const std::size_t all[] = {0, 1, 2};
  const RodLeg rods[] = {rod_at(0.5, 0.2, 0.1, true)};
  const Robot mixed = beside(rigid, all, rods, home);
  ASSERT_TRUE(bears_load(mixed));
  Workspace work(mixed), other(rigid);
  RodRandom random(3);
  for (int k = 0; k < 10; ++k) {
    std::vector<double> slides(3), inputs;
    for (double& slide : slides) slide = random.uniform(0.15, 0.2);
    const Forward expected = forward(rigid, slides, {}, other);
    ASSERT_TRUE(expected.report.ok());
    const SE3<double> platform = SE3<double>::from(std::get<SpatialPose>(expected.pose));
    const double chord = (platform.point(rods[0].platform_point) - rods[0].base.p).norm();
    inputs = {slides[0], 1.01 * chord, slides[1], slides[2]};  // the rod stands second
    EquilibriumOptions options;
    options.wrench = load();
    const Equilibrium found = equilibrium(mixed, inputs, options, work);
    ASSERT_TRUE(found.is_solved()) << found.report.message.view();
    EXPECT_LT(distance(found.pose, std::get<SpatialPose>(expected.pose)), 1e-10);
    EXPECT_EQ(analyse_equilibrium(mixed, work).unstable_directions, 0);
  }
}

/// Struts that stand twice, eight and twelve rows of a platform of six freedoms: what the others hold they
/// hold again, and the twins share the force.
TEST(Mechanism, RowsMayForbidTheSame) {
  const Robot rigid = builtin("3prs");
  const SpatialPose home = std::get<SpatialPose>(sinew::home(rigid));
  const std::size_t once[] = {0, 1, 2}, one_twice[] = {0, 0, 1, 2}, all_twice[] = {0, 0, 1, 1, 2, 2};
  const RodLeg rods[] = {rod_at(0.5, 0.2, 0.1, true)};
  const double chord = (SE3<double>::from(home).point(rods[0].platform_point) - rods[0].base.p).norm();
  Workspace other(rigid);
  const Inverse at_home = inverse(rigid, sinew::home(rigid), {}, other);
  ASSERT_TRUE(at_home.ok());
  const auto solved = [&](std::span<const std::size_t> kept, RodAnalysis& analysis) {
    const Robot robot = beside(rigid, kept, rods, home);
    std::vector<double> inputs;
    for (const std::size_t leg : kept) inputs.push_back(at_home.inputs[leg]);
    inputs.insert(inputs.begin() + static_cast<std::ptrdiff_t>(kept.size() / 2), 1.02 * chord);
    EquilibriumOptions options;
    options.wrench = load();
    Workspace work(robot);
    const Equilibrium found = equilibrium(robot, inputs, options, work);
    EXPECT_TRUE(found.is_solved()) << found.report.message.view();
    EXPECT_LT(distance(found.pose, home), 1e-10);
    analysis = analyse_equilibrium(robot, work);
    inputs[0] += 0.01;  // twins that are fed differently cannot both close
    if (kept.size() > 3) {
      EXPECT_FALSE(equilibrium(robot, inputs, options, work).is_solved());
    }
  };
  RodAnalysis single, twin, twins;
  solved(once, single);
  solved(one_twice, twin);
  solved(all_twice, twins);
  const auto half = [](const Vec3<double>& twice, const Vec3<double>& whole) {
    return (2 * twice - whole).norm() / whole.norm();
  };
  EXPECT_LT((twin.closing_forces[0] - twin.closing_forces[1]).norm(), 1e-9);
  EXPECT_LT(half(twin.closing_forces[0], single.closing_forces[0]), 1e-9);
  EXPECT_LT((twin.closing_forces[2] - single.closing_forces[1]).norm(), 1e-9);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_LT(half(twins.closing_forces[k], single.closing_forces[k / 2]), 1e-9);
}

struct Case {
  const char* name;
  Robot robot;
  std::vector<double> inputs;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  const Robot tripod = builtin("3prs"), arcs = builtin("6-ufs");
  const std::size_t two[] = {0, 1}, one[] = {2};
  const SpatialPose home = std::get<SpatialPose>(sinew::home(tripod));
  const std::vector<RodLeg> pair{rod_at(5.4, 0.25, 0.125), rod_at(5.9, 0.25, 0.12, true)};
  all.push_back({"two struts and two rods", beside(tripod, two, pair, home), {0.17, 0.52, 0.53, 0.18}});
  std::vector<RodLeg> five;
  for (int k = 0; k < 5; ++k) five.push_back(rod_at(1.2 * k, 0.1, 0.1, k % 2 == 0, k % 2 == 0 ? 0.7 : -0.7));
  five[1].link.density = 6000;
  SpatialPose above = std::get<SpatialPose>(sinew::home(arcs));
  Workspace work(arcs);
  const Inverse legs = inverse(arcs, above, {}, work);
  const double height = above.position[2] * 1.1;
  all.push_back({"an arc and five rods", beside(arcs, one, five, above), std::vector<double>(6)});
  std::vector<double>& inputs = all.back().inputs;
  const auto named = inputs_of(all.back().robot);
  for (std::size_t k = 0; k < inputs.size(); ++k)
    inputs[k] = named[k].name == "length" ? height * (1 + 0.01 * static_cast<double>(k)) : legs.inputs[2];
  return all;
}

EquilibriumOptions loaded(const Robot&) {
  EquilibriumOptions options;
  options.wrench = 0.3 * load();
  options.gravity = Vec3<double>(0, 0, -9.81);
  return options;
}

/// Forces of all legs and the load are in balance, with what the platform feels of each at its point; struts
/// pull along themselves and their hinges.
TEST(Mechanism, LegsAndLoadAreInBalance) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    Workspace work(one.robot);
    EquilibriumOptions options = loaded(one.robot);
    const Equilibrium found = equilibrium(one.robot, one.inputs, options, work);
    ASSERT_TRUE(found.is_solved()) << found.report.message.view();
    EXPECT_LT(found.report.residual, 1e-12);
    const RodAnalysis analysis = analyse_equilibrium(one.robot, work);
    const SE3<double> platform = SE3<double>::from(found.pose);
    Vec3<double> force = Vec3<double>::Zero(), moment = Vec3<double>::Zero();
    const auto add = [&](const Vec3<double>& point, const Vec3<double>& pull, const Vec3<double>& turn) {
      force += pull;
      moment += cross(platform.rotate(point), pull) + turn;
    };
    std::size_t rod = 0, closing = 0;
    one.robot.spatial()->for_each_leg([&]<class L>(const L& leg, const LegPlace&, int) {
      if constexpr (BearsLoad<L>) {
        add(leg.platform_point, analysis.rods[rod].force, analysis.rods[rod].moment);
        ++rod;
      } else {
        add(leg.platform_point, analysis.closing_forces[closing++], Vec3<double>::Zero());
      }
    });
    EXPECT_LT((force - options.wrench.head<3>()).norm(), 1e-9);
    EXPECT_LT((moment - options.wrench.tail<3>()).norm(), 1e-9);
    EXPECT_GT(analysis.closing_forces[0].norm(), 1e-3);
  }
}

/// What analysis says of inputs and loads is what solved poses do.
TEST(Mechanism, SensitivitiesAgainstDifferences) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    Workspace work(one.robot);
    const EquilibriumOptions options = loaded(one.robot);
    const auto pose_at = [&](const std::vector<double>& inputs) {
      const Equilibrium found = equilibrium(one.robot, inputs, options, work);
      EXPECT_TRUE(found.is_solved()) << found.report.message.view();
      return SE3<double>::from(found.pose);
    };
    pose_at(one.inputs);
    const RodAnalysis analysis = analyse_equilibrium(one.robot, work);
    const std::size_t count = one.inputs.size();
    const double step = 1e-6;
    for (std::size_t k = 0; k < count; ++k) {
      auto ahead = one.inputs, back = one.inputs;
      ahead[k] += step;
      back[k] -= step;
      const SE3<double> a = pose_at(ahead), b = pose_at(back);
      Vec<double, 6> slope;
      slope << (a.p - b.p) / (2 * step), a.R.compose(b.R.inverse()).log() / (2 * step);
      for (std::size_t r = 0; r < 6; ++r)
        EXPECT_NEAR(analysis.sensitivity[r * count + k], slope[static_cast<Eigen::Index>(r)],
                    2e-6 * (1 + slope.norm()))
            << r << ", " << k;
    }
    // J U = K on the motions that are left
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t r = 0; r < 6; ++r) {
        double sum = 0, largest = 0;
        for (std::size_t c = 0; c < 6; ++c) {
          const double part = analysis.stiffness[6 * r + c] * analysis.sensitivity[c * count + k];
          sum += part;
          largest = std::max(largest, std::abs(part));
        }
        EXPECT_NEAR(sum, analysis.feed[r * count + k], 1e-9 * (1 + largest));
      }
  }
}

/// Six inputs hold a pose, of struts and arcs too; let go, the platform stays there.
TEST(Mechanism, HoldsAPoseAndLetsItGo) {
  const Case one = cases()[1];
  Workspace work(one.robot);
  SpatialPose wanted = std::get<SpatialPose>(sinew::home(one.robot));
  wanted.position += Vec3<double>(0.004, -0.003, 0.002);
  const EquilibriumOptions options = loaded(one.robot);
  const Equilibrium held = inverse_equilibrium(one.robot, wanted, options, work);
  ASSERT_TRUE(held.is_solved()) << held.report.message.view();
  EXPECT_LT(distance(held.pose, wanted), 1e-14);
  const std::vector<double> inputs(held.inputs.begin(), held.inputs.end());
  const Equilibrium free = equilibrium(one.robot, inputs, options, work);
  ASSERT_TRUE(free.is_solved()) << free.report.message.view();
  EXPECT_LT(distance(free.pose, wanted), 1e-9);
}

/// Resumed steps, curves and folds are those of any robot on rods.
TEST(Mechanism, FollowsPathsAndCurves) {
  const Robot robot = builtin("2prs-1pfs");
  Workspace work(robot), other(robot);
  const auto begin = [&] { return inverse_equilibrium(robot, IndependentPose{0.5, 0.02, 0.01}, {}, work); };
  const Equilibrium begun = begin();
  ASSERT_TRUE(begun.is_solved()) << begun.report.message.view();
  std::vector<double> inputs(begun.inputs.begin(), begun.inputs.end());
  EquilibriumOptions options;
  options.warm_start = true;
  for (int k = 0; k < 20; ++k) {
    inputs[0] += 5e-4;
    inputs[2] += 3e-4;
    const Equilibrium warm = equilibrium(robot, inputs, options, work);
    ASSERT_TRUE(warm.is_solved());
    EXPECT_LT(warm.report.iterations, 8);
  }
  const SpatialPose walked = equilibrium(robot, inputs, options, work).pose;
  const Equilibrium cold = equilibrium(robot, inputs, {}, other);
  ASSERT_TRUE(cold.is_solved());
  EXPECT_LT(distance(walked, cold.pose), 1e-9);

  SpatialWrench down = SpatialWrench::Zero();
  down[2] = -1;
  ASSERT_TRUE(begin().is_solved());
  const LoadPath path = follow_load(robot, down, 600, work);
  ASSERT_EQ(path.end, LoadEnd::fold);
  ASSERT_TRUE(begin().is_solved());
  CurveOptions how;
  how.added_wrench = 600 * down;
  const auto curves = equilibrium_curves(robot, how, work);
  const auto fold = std::ranges::find(curves.at(0).points, CurveEvent::fold, &CurvePoint::event);
  ASSERT_NE(fold, curves[0].points.end());
  EXPECT_NEAR(600 * fold->parameter, path.load, 1e-5 * path.load);
}

TEST(Mechanism, SaysWhatItCannotDo) {
  const Robot robot = builtin("2prs-1pfs");
  Workspace work(robot);
  const std::vector<double> none{0.17, 0.17, -0.5}, backward{-2, 0.17, 0.52};
  EXPECT_EQ(equilibrium(robot, none, {}, work).report.status, Status::left_domain);
  const Equilibrium far = equilibrium(robot, backward, {}, work);  // a slide may be negative, this is too far
  EXPECT_FALSE(far.is_solved());
  EXPECT_FALSE(far.report.message.view().empty());
  const std::vector<double> short_rods{0.15, 0.18, 0.01};
  EXPECT_NE(equilibrium(robot, short_rods, {}, work)
                .report.message.view()
                .find("legs[2] and legs[3] are too short"),
            std::string_view::npos);
  // six inputs, but the struts hold motions that none drives
  const Robot tripod = builtin("3prs");
  const std::size_t two[] = {0, 1};
  const RodLeg four[] = {rod_at(5.2, 0.25, 0.125), rod_at(5.4, 0.25, 0.12), rod_at(5.7, 0.25, 0.12),
                         rod_at(5.9, 0.25, 0.11)};
  const Robot six = beside(tripod, two, four, std::get<SpatialPose>(sinew::home(tripod)));
  Workspace sixth(six);
  const Equilibrium refused = inverse_equilibrium(six, std::get<SpatialPose>(sinew::home(six)), {}, sixth);
  EXPECT_EQ(refused.report.status, Status::unsupported);
  EXPECT_NE(refused.report.message.view().find("no input drives"), std::string_view::npos);
  SpatialRobot beyond = *robot.spatial();
  beyond.home.position = Vec3<double>(0.5, 0, 0.5);
  const Robot unreachable("beyond", beyond);
  Workspace other(unreachable);
  const Equilibrium nowhere = equilibrium(unreachable, std::vector<double>{0.17, 0.17, 0.52}, {}, other);
  EXPECT_EQ(nowhere.report.status, Status::singular);
  EXPECT_NE(nowhere.report.message.view().find("cannot"), std::string_view::npos);
}

}  // namespace mechanism_test
}  // namespace sinew::test
