/// Platforms in the plane on legs of sections: every leg alone as an arm in space, derivatives against
/// differences, Euler's loads of columns that lean, the same robot in space, and what is out of the plane.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "kinematics/arm_legs/group/arm_group.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::test::planar_arm_legs_test {

constexpr ArmOptions sharp{.accuracy = 0, .tolerance = 1e-12};

/// Sections with a tendon on either side.
Arm flat_arm(int sections) {
  Arm arm;
  arm.name = "leg";
  const Material nitinol{.young = 54e9, .shear = 20.8e9, .density = 6450};
  for (int m = 0; m < sections; ++m) {
    ArmSection& section = arm.sections.emplace_back();
    section.length = 0.2 / sections;
    section.start = section.end = round_section(nitinol, 1.4e-3);
    section.discs = {.count = 5, .mass = 1e-3};
    for (const double angle : {0.0, std::numbers::pi}) {
      ArmTendon& tendon = arm.tendons.emplace_back();
      tendon.routes.assign(static_cast<std::size_t>(m + 1), TendonRoute{6e-3, 6e-3, angle, angle});
      tendon.compliance = 1e-4;
      tendon.pretension = 0.2;
    }
  }
  return arm;
}

SO3<double> along(double direction) {
  const double c = std::cos(direction), s = std::sin(direction);
  Mat<double, 3, 3> axes;
  axes << s, 0, c, -c, 0, s, 0, -1, 0;
  return SO3<double>::from(axes);
}

/// A leg from a base point that reaches its point of the platform at rest, or nearly.
ArmLeg leg_between(const Vec3<double>& from, const Vec3<double>& to, const std::string& closure) {
  ArmLeg leg;
  leg.arm = flat_arm(2);
  const double way = std::atan2(to.y() - from.y(), to.x() - from.x());
  leg.is_clamped = closure == "clamp";
  leg.turns_at_base = closure == "chord";
  leg.strut = closure == "strut" ? 0.06 : 0;
  leg.base = {from, along(closure == "strut" ? way + 0.3 : way)};
  leg.mount = leg.base.R;
  leg.platform_point = to;
  return leg;
}

/// Three legs at thirds of a circle.
ArmLegs robot_of(const std::string& closure) {
  ArmLegs robot;
  robot.name = closure;
  robot.is_planar = true;
  robot.gravity = {0.5, -3, 0};
  robot.platform_mass = 0.02;
  for (int k = 0; k < 3; ++k) {
    const SO3<double> turn = SO3<double>::exp({0, 0, 2 * std::numbers::pi * k / 3});
    const double far = closure == "strut" ? 0.26 : 0.21;
    robot.legs.push_back(leg_between(turn.rotate({far, 0.05, 0}), turn.rotate({0.01, 0.05, 0}), closure));
  }
  return robot;
}
ArmLegs mixed_robot() {
  ArmLegs robot = robot_of("chord");
  for (std::size_t k = 0; const char* closure : {"strut", "pin", "chord"}) {
    const ArmLeg leg = robot.legs[k];
    robot.legs[k++] = leg_between(leg.base.p, leg.platform_point, closure);
  }
  return robot;
}
std::vector<ArmLegs> every_robot() {
  std::vector<ArmLegs> robots{mixed_robot()};
  for (const char* closure : {"chord", "strut", "pin", "clamp"}) robots.push_back(robot_of(closure));
  return robots;
}

std::vector<TendonCommand> tensions(double share = 1) {
  std::vector<TendonCommand> commands;
  for (const double value : {1.5, .0, .3, .9, .0, 1.2, .5, .2, 1.1, .1, .0, .8})
    commands.push_back({TendonHeld::tension, share * value});
  return commands;
}
/// Some changes, of which one leaves its tendon slack.
std::vector<TendonCommand> mixed() {
  auto commands = tensions();
  commands[0] = {TendonHeld::change, -1e-3};
  commands[1] = {TendonHeld::change, 4e-3};
  commands[7] = {TendonHeld::change, -5e-4};
  commands[10] = {TendonHeld::change, -1e-3};
  return commands;
}
const ArmLegsLoad pushed{.wrench = {0.1, -0.05, 0, 0, 0, 0.003}};
constexpr std::array<std::size_t, 3> in_plane{0, 1, 5}, out_of_plane{2, 3, 4};

/// As an arm in space under what its tip bears; of a leg with a strut that is the bar's force at the arm's
/// tip.
TEST(PlanarArmLegs, EveryLegAloneIsTheArmInSpaceUnderItsForce) {
  for (const ArmLegs& robot : every_robot())
    for (const auto& commands : {tensions(), mixed()}) {
      ArmLegsWorkspace work(robot);
      const ArmLegsState state = arm_legs_forward(robot, commands, pushed, {.accuracy = 0}, work);
      ASSERT_TRUE(state.report.ok()) << robot.name << ' ' << state.report.message.view();
      Vec<double, 6> sum = Vec<double, 6>::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const ArmLeg& leg = robot.legs[k];
        Arm arm = leg.arm;
        const double ends[] = {0, arm.length()};
        const auto frames = arm_frames(arm, ends, arm_legs_shape(work, k));
        const SE3<double>& base = frames[0];
        EXPECT_LT((base.p - leg.base.p).norm(), 1e-14);
        if (!leg.turns_at_base) {
          EXPECT_LT(base.R.compose(leg.base.R.inverse()).log().norm(), 1e-12);
        }
        const auto& load = state.tip_loads[k];
        const Vec3<double> force(load[0], load[1], load[2]), moment(load[3], load[4], load[5]),
            point = state.platform.point(leg.platform_point), g(robot.gravity[0], robot.gravity[1], 0);
        sum.head<3>() += force;
        sum.tail<3>() += moment + cross(Vec3<double>(point - state.platform.p), force);
        const Vec3<double> f = base.rotate_back(force), m = base.rotate_back(moment),
                           own = base.rotate_back(g);
        arm.gravity = {own[0], own[1], own[2]};
        ArmLoad tip;
        tip.wrench = {f[0], f[1], f[2], m[0], m[1], m[2]};
        ArmWorkspace alone(arm);
        const ArmState one =
            arm_forward(arm, std::span(commands).subspan(4 * k, 4), tip, {.accuracy = 0}, alone);
        ASSERT_TRUE(one.report.ok()) << robot.name << one.report.message.view();
        const SE3<double> end = base.compose(one.tip);
        EXPECT_LT((end.p - frames[1].p).norm(), 1e-7) << robot.name << k;
        const Vec3<double> bar = point - end.p;
        if (leg.strut > 0) {  // which bears along itself alone
          EXPECT_NEAR(bar.norm(), leg.strut, 1e-7);
          EXPECT_NEAR(cross(bar, force).norm(), 0, 1e-8);
        } else {
          EXPECT_LT(bar.norm(), 1e-7);
        }
        if (leg.turns_at_base) {  // where the base turns nothing holds it
          double about_base = cross(Vec3<double>(point - base.p), force)[2] + moment[2];
          const auto& rod = arm_legs_shape(work, k).impl().rod();
          for (std::size_t n = 1; n < rod.work().frames.size(); ++n) {
            const auto& frame = rod.work().frames[n];
            const auto& share = rod.model().masses[n];
            const double x = share.amount * (frame.p[0] - base.p[0]) + frame.R[2] * share.moment[2],
                         y = share.amount * (frame.p[1] - base.p[1]) + frame.R[5] * share.moment[2];
            about_base += x * g[1] - y * g[0];
          }
          EXPECT_NEAR(about_base, 0, 1e-9) << robot.name;
        }
        if (leg.is_clamped) {
          EXPECT_LT((state.platform.R.compose(leg.mount)).compose(end.R.inverse()).log().norm(), 1e-6);
        }
        for (std::size_t i = 0; i < 4; ++i) {
          EXPECT_NEAR(one.tensions[i], state.tensions[4 * k + i], 1e-5);
          EXPECT_NEAR(one.changes[i], state.changes[4 * k + i], 1e-8);
          EXPECT_NEAR(one.slack[i], state.slack[4 * k + i], 1e-8);
        }
      }
      const double weighs = robot.platform_mass;
      EXPECT_NEAR(sum[0], pushed.wrench[0] + weighs * robot.gravity[0], 1e-8);
      EXPECT_NEAR(sum[1], pushed.wrench[1] + weighs * robot.gravity[1], 1e-8);
      EXPECT_NEAR(sum[5], pushed.wrench[5], 1e-9);
      EXPECT_EQ(state.platform.p[2], 0);
    }
}

/// Loads on legs: each leg is the arm under the same ones, in every closure, and what moves along a leg from
/// the last equilibrium on is what the rest grows into.
TEST(PlanarArmLegs, LegsBearLoadsInThePlane) {
  const auto commands = mixed();
  for (const auto& [discs, turns] : {std::pair{5, false}, {0, false}, {5, true}})
    for (ArmLegs robot : every_robot()) {
      for (ArmLeg& leg : robot.legs)
        for (ArmSection& section : leg.arm.sections) section.discs.count = discs;
      ArmLegsLoad load = pushed;
      load.along = {0.2, -0.3, 0};
      load.points = {{0, 0.033, {0.05, 0.08}}, {2, 0.2, {-0.06, 0.02}}, {1, 0.1, {0, 0.03}}};
      if (turns) {  // a leg's own y axis is square to the plane
        load.points.push_back({0, 0.08, {0.02, 0, 0, 0, 0, 2e-3}});
        load.points.push_back({1, 0.15, {0.04, 0, -0.05, 0, 1e-3, 0}, true});
        load.following = {0.02, -0.05, 0, 0, 0, 1e-3};
        load.following_along = {0.2, 0, -0.1};
      }
      ArmLegsWorkspace work(robot), other(robot);
      const ArmLegsState state = arm_legs_forward(robot, commands, load, {.accuracy = 0}, work);
      ASSERT_TRUE(state.report.ok()) << robot.name << ' ' << state.report.message.view();
      double across[2] = {};
      for (std::size_t k = 0; k < 3; ++k) {
        const ArmLeg& leg = robot.legs[k];
        Arm arm = leg.arm;
        const double ends[] = {0, arm.length()};
        const auto frames = arm_frames(arm, ends, arm_legs_shape(work, k));
        const SE3<double>& base = frames[0];
        const auto back = [&](double x, double y) {
          const Vec3<double> v = base.rotate_back(Vec3<double>(x, y, 0));
          return std::array<double, 3>{v[0], v[1], v[2]};
        };
        const auto& tip = state.tip_loads[k];
        const Vec3<double> moment = base.rotate_back(Vec3<double>(0, 0, tip[5]));
        const auto force = back(tip[0], tip[1]);
        arm.gravity = back(robot.gravity[0], robot.gravity[1]);
        ArmLoad own;
        own.wrench = {force[0], force[1], force[2], moment[0], moment[1], moment[2]};
        own.along = back(load.along[0], load.along[1]);
        for (const ArmLegsPointLoad& point : load.points) {
          if (point.leg != k) continue;
          PointLoad& on_arm = own.points.emplace_back();
          on_arm.place = point.place;
          on_arm.wrench = point.wrench;
          if (on_arm.following = point.following; point.following) continue;
          const auto f = back(point.wrench[0], point.wrench[1]);
          const Vec3<double> m = base.rotate_back(Vec3<double>(0, 0, point.wrench[5]));
          on_arm.wrench = {f[0], f[1], f[2], m[0], m[1], m[2]};
        }
        own.following_along = load.following_along;
        ArmWorkspace alone(arm);
        const ArmState one =
            arm_forward(arm, std::span(commands).subspan(4 * k, 4), own, {.accuracy = 0}, alone);
        ASSERT_TRUE(one.report.ok()) << robot.name << one.report.message.view();
        EXPECT_LT((base.compose(one.tip).p - frames[1].p).norm(), 1e-7) << robot.name << k;
        EXPECT_NEAR((state.platform.point(leg.platform_point) - frames[1].p).norm(), leg.strut, 1e-7);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(one.tensions[i], state.tensions[4 * k + i], 1e-5);
        across[0] += tip[0], across[1] += tip[1];
      }
      const Vec3<double> with = state.platform.rotate(Vec3<double>(load.following[0], load.following[1], 0));
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(across[i],
                    pushed.wrench[i] + robot.platform_mass * robot.gravity[i] + with[static_cast<int>(i)],
                    1e-8);
      if (turns) load.following_along = {}, load.following = {};
      ArmOptions warm;
      warm.from_last = true;
      load.points = {{0, 0.033, {0.05, 0.02}}};
      for (int k = 0; k < 4; ++k) {
        load.points[0].place += 0.04;
        const ArmLegsState a = arm_legs_forward(robot, commands, load, warm, work),
                           b = arm_legs_forward(robot, commands, load, {}, other);
        ASSERT_TRUE(a.report.ok() && b.report.ok()) << robot.name << a.report.message.view();
        if (!a.report.message.empty()) continue;  // of a way that gave way
        EXPECT_LT((a.platform.p - b.platform.p).norm(), discs > 0 ? 2e-6 : 2e-5) << robot.name << k;
      }
    }
}

TEST(PlanarArmLegs, RatesMatchDifferences) {
  for (const ArmLegs& robot : every_robot()) {
    const auto commands = mixed();
    ArmLegsWorkspace work(robot), other(robot);
    const ArmLegsState at = arm_legs_forward(robot, commands, pushed, sharp, work);
    ASSERT_TRUE(at.report.ok()) << robot.name << at.report.message.view();
    const ArmLegsRates rates = arm_legs_rates(robot, work);
    ASSERT_TRUE(rates.regular && rates.has_stiffness) << robot.name;
    const auto check = [&](const ArmLegsState& up, const ArmLegsState& down, double by,
                           const std::vector<double>& twists, const std::vector<double>& answers,
                           std::size_t columns, std::size_t column) {
      ASSERT_TRUE(up.report.ok() && down.report.ok());
      Vec<double, 6> twist;
      twist << up.platform.p - down.platform.p, up.platform.R.compose(down.platform.R.inverse()).log();
      double largest = 1e-3;  // of a slack tendon rounding is left
      for (std::size_t i = 0; i < 6; ++i) largest = std::max(largest, std::abs(twists[i * columns + column]));
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(twists[i * columns + column], twist[static_cast<int>(i)] / by, 1e-4 * largest)
            << robot.name << i << ' ' << column;
      for (std::size_t i = 0; i < 12; ++i) {
        const bool is_change = commands[i].held == TendonHeld::tension;
        const double a = is_change ? up.changes[i] - down.changes[i] : up.tensions[i] - down.tensions[i],
                     rate = answers[i * columns + column];
        EXPECT_NEAR(rate, a / by, 1e-4 * std::abs(rate) + (is_change ? 1e-7 : 1e-4)) << robot.name << i;
      }
    };
    for (std::size_t k = 0; k < 12; ++k) {
      const double h = commands[k].held == TendonHeld::tension ? 1e-4 : 1e-6;
      if (commands[k].held == TendonHeld::tension && commands[k].value < h) continue;
      auto up = commands, down = commands;
      up[k].value += h, down[k].value -= h;
      check(arm_legs_forward(robot, up, pushed, sharp, other),
            arm_legs_forward(robot, down, pushed, sharp, work), 2 * h, rates.J, rates.answers, 12, k);
    }
    for (const std::size_t k : in_plane) {
      const double h = k < 3 ? 1e-4 : 1e-5;
      ArmLegsLoad up = pushed, down = pushed;
      up.wrench[k] += h, down.wrench[k] -= h;
      check(arm_legs_forward(robot, commands, up, sharp, other),
            arm_legs_forward(robot, commands, down, sharp, work), 2 * h, rates.compliance,
            rates.answers_by_wrench, 6, k);
    }
    for (const std::size_t i : in_plane)  // the stiffness is the compliance's inverse
      for (const std::size_t j : in_plane) {
        double sum = 0;
        for (const std::size_t l : in_plane) sum += rates.stiffness[6 * i + l] * rates.compliance[6 * l + j];
        EXPECT_NEAR(sum, i == j, 1e-7);
      }
    for (const std::size_t i : out_of_plane)
      for (std::size_t j = 0; j < 6; ++j) {
        EXPECT_EQ(rates.stiffness[6 * i + j], 0);
        EXPECT_EQ(rates.compliance[6 * j + i], 0);
      }
  }
}

/// With its legs clamped: a tripod in space of the same legs, pushed in the plane, stays in it.
TEST(PlanarArmLegs, ClampedLegsInSpaceStayInThePlane) {
  const ArmLegs flat = robot_of("clamp");
  ArmLegs space = flat;
  space.is_planar = false;
  for (const ArmModel model : {ArmModel::subsegment_rod, ArmModel::rod, ArmModel::prb, ArmModel::cc}) {
    const ArmOptions options{.model = model, .accuracy = 0};
    ArmLegsWorkspace work(flat), other(space);
    const ArmLegsState a = arm_legs_forward(flat, mixed(), pushed, options, work),
                       b = arm_legs_forward(space, mixed(), pushed, options, other);
    ASSERT_TRUE(a.report.ok() && b.report.ok()) << a.report.message.view() << b.report.message.view();
    EXPECT_LT((a.platform.p - b.platform.p).norm(), 1e-9);
    EXPECT_LT(a.platform.R.compose(b.platform.R.inverse()).log().norm(), 1e-8);
    EXPECT_NEAR(a.energy, b.energy, 1e-9);
  }
}

/// Two columns clamped at their feet and one on joints between them, which leans: 2 k = N/L where the
/// cantilevers' stiffness under N is k = N / (tan(x) L/x − L), x = L √(N/EI): tan x = 3 x.
TEST(PlanarArmLegs, ALeaningColumnGivesWayAtItsLoad) {
  ArmLegs robot;
  robot.name = "columns";
  robot.is_planar = true;
  robot.home.position = {0, 0.2, 0};
  for (const double x : {-0.05, 0.0, 0.05}) {
    ArmLeg leg = leg_between({x, 0, 0}, {x, 0.2, 0}, x == 0 ? "chord" : "pin");
    leg.platform_point = {x, 0, 0};
    for (ArmSection& section : leg.arm.sections)
      for (CrossSection* end : {&section.start, &section.end}) end->stretch = end->shear = 1e9;
    robot.legs.push_back(leg);
  }
  double low = 1, high = 1.5;
  while (high - low > 1e-12)
    (std::tan(0.5 * (low + high)) < 3 * 0.5 * (low + high) ? low : high) = 0.5 * (low + high);
  const double euler = 3 * low * low * robot.legs[0].arm.sections[0].start.bending_y / 0.04;
  const std::vector<TendonCommand> loose(12);
  ArmLegsWorkspace work(robot);
  ASSERT_TRUE(arm_legs_forward(robot, loose, {}, {}, work).report.ok());
  const ArmLegsLoadPath path = arm_legs_follow_load(robot, {0, -1, 0, 0, 0, 0}, 2 * euler, work);
  EXPECT_EQ(path.end, LoadEnd::bifurcation);
  EXPECT_NEAR(path.load / euler, 1, 1e-3);
  for (const double share : {0.99, 1.01}) {
    ArmLegsWorkspace anew(robot);
    const ArmLegsState& state =
        arm_legs_forward(robot, loose, {.wrench = {0, -share * euler, 0, 0, 0, 0}}, {}, anew);
    EXPECT_EQ(state.report.ok(), share < 1);
    EXPECT_EQ(state.stable, share < 1);
  }
}

TEST(PlanarArmLegs, InverseHoldSenseAndTrackAgreeWithForward) {
  for (const ArmLegs& robot : every_robot()) {
    // pulled by all of that, legs on struts would snap where the wrench is left out
    const auto pull = tensions(robot.name == "strut" ? 0.4 : 1);
    ArmLegsWorkspace work(robot), other(robot);
    const ArmLegsState asked = arm_legs_forward(robot, pull, pushed, sharp, other);
    ASSERT_TRUE(asked.report.ok());
    const SpatialPose pose = spatial_pose(asked.platform);
    const std::array<double, 3> place{pose.position[0], pose.position[1], 0};

    const ArmTarget target{.position = place, .quaternion = pose.quaternion};
    const ArmLegsInverse found = arm_legs_inverse(robot, target, pushed, {}, work);
    ASSERT_TRUE(found.report.ok()) << robot.name << found.report.message.view();
    EXPECT_LT((found.state.platform.p - asked.platform.p).norm(), 1e-7);
    double least = 0, given = 0;
    for (std::size_t i = 0; i < 12; ++i)
      least += std::pow(found.state.tensions[i], 2), given += std::pow(pull[i].value, 2);
    EXPECT_LE(least, given * 1.001);

    const ArmLegsHeld held = arm_legs_hold(robot, asked.platform, pull, {}, sharp, other);
    ASSERT_TRUE(held.state.report.ok()) << robot.name << held.state.report.message.view();
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(held.wrench[i], pushed.wrench[i], 1e-6) << robot.name;

    ArmLegsMeasurement measured{.held = pull, .position = place, .quaternion = pose.quaternion};
    ArmLegsSensed sensed = arm_legs_sense(robot, measured, {}, false, sharp, other);
    ASSERT_TRUE(sensed.report.ok()) << robot.name << sensed.report.message.view();
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(sensed.wrench[i], pushed.wrench[i], 1e-5) << robot.name;
    EXPECT_GT(sensed.covariance[35], 0);
    EXPECT_EQ(sensed.covariance[14], 0);
    measured.quaternion.reset();
    EXPECT_EQ(arm_legs_sense(robot, measured, {}, false, sharp, other).report.status, Status::bad_input);
    sensed = arm_legs_sense(robot, measured, {.wrench = {0, 0, 0, 0, 0, 0.003}}, true, sharp, other);
    ASSERT_TRUE(sensed.report.ok()) << robot.name << sensed.report.message.view();
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(sensed.wrench[i], pushed.wrench[i], 1e-5) << robot.name;

    const ArmLegsStep first{.commands = pull, .load = pushed, .divisions = 2}, back{.pose = asked.platform};
    const std::vector<ArmLegsStep> steps{first, back};
    const auto points = arm_legs_track(robot, steps, {}, other);
    ASSERT_EQ(points.size(), 3U) << points.back().report.message.view();
    EXPECT_LT((points[1].platform.p - asked.platform.p).norm(), 1e-6);
  }
}

TEST(PlanarArmLegs, WhatLeavesThePlaneIsRefused) {
  const ArmLegs robot = robot_of("chord");
  ArmLegsWorkspace work(robot);
  for (const std::size_t k : out_of_plane) {
    ArmLegsLoad load;
    load.wrench[k] = 1e-3;
    EXPECT_EQ(arm_legs_forward(robot, tensions(), load, {}, work).report.status, Status::bad_input);
  }
  ArmLegsLoad out;
  out.along = {0, 0, 0.1};
  EXPECT_EQ(arm_legs_forward(robot, tensions(), out, {}, work).report.status, Status::bad_input);
  out.along = {};
  out.points = {{0, 0.1, {0, 0, 0.1}}};
  EXPECT_EQ(arm_legs_forward(robot, tensions(), out, {}, work).report.status, Status::bad_input);
  for (const std::size_t k : {1U, 3U, 5U}) {  // of a leg's own axes y is square to the plane
    out.points = {{0, 0.1, {}, true}};
    out.points[0].wrench[k] = 1e-3;
    EXPECT_EQ(arm_legs_forward(robot, tensions(), out, {}, work).report.status, Status::bad_input);
  }
  out.points = {};
  out.following_along = {0, 0.1, 0};
  EXPECT_EQ(arm_legs_forward(robot, tensions(), out, {}, work).report.status, Status::bad_input);
  out.following_along = {};
  out.following[2] = 0.1;
  EXPECT_EQ(arm_legs_forward(robot, tensions(), out, {}, work).report.status, Status::bad_input);
  const ArmLegsLoad down{.gravity = std::array<double, 3>{0, 0, -9.81}};
  EXPECT_EQ(arm_legs_forward(robot, tensions(), down, {}, work).report.status, Status::bad_input);
  const SE3<double> above{{0, 0, 1e-3}, {}}, tilted{{0, 0, 0}, SO3<double>::exp({0.1, 0, 0})};
  for (const SE3<double>& pose : {above, tilted}) {
    const SpatialPose asked = spatial_pose(pose);
    EXPECT_EQ(arm_legs_hold(robot, pose, tensions(), {}, {}, work).state.report.status, Status::bad_input);
    const ArmTarget target{.position = std::array<double, 3>{0, 0, asked.position[2]},
                           .quaternion = asked.quaternion};
    EXPECT_EQ(arm_legs_inverse(robot, target, {}, {}, work).report.status, Status::bad_input);
    const ArmLegsMeasurement seen{
        .held = tensions(), .position = target.position, .quaternion = target.quaternion};
    EXPECT_EQ(arm_legs_sense(robot, seen, {}, false, {}, work).report.status, Status::bad_input);
    const std::vector<ArmLegsStep> steps{{.pose = pose}};
    EXPECT_EQ(arm_legs_track(robot, steps, {}, work).back().report.status, Status::bad_input);
  }
  EXPECT_EQ(
      arm_legs_inverse(robot, {.direction = std::array<double, 3>{0, 0, 1}}, {}, {}, work).report.status,
      Status::bad_input);
  const ArmLegsState huge = arm_legs_forward(robot, tensions(), {.wrench = {1e9, 0, 0, 0, 0, 0}}, {}, work);
  EXPECT_FALSE(huge.report.ok());
  EXPECT_FALSE(huge.stable);
}

}  // namespace sinew::test::planar_arm_legs_test
