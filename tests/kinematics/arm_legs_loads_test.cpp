/// Loads on the legs of a platform on arms, dead and following ones: every leg alone as an arm under the same
/// loads, what bases bear against a sum over all loads, a platform on one leg against an arm, the potential
/// by the places where forces act, weight as a load along legs, derivatives against differences, loads that
/// move, every question, and bad input.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "kinematics/arm_legs/legs_work.hpp"
#include "tripods.hpp"

namespace sinew::test::arm_legs_loads_test {

using namespace tripods;

constexpr ArmOptions sharp{.accuracy = 0, .tolerance = 1e-12};
constexpr std::array every_model{ArmModel::subsegment_rod, ArmModel::rod, ArmModel::subsegment_cc,
                                 ArmModel::cc, ArmModel::prb};

/// Between discs, at one, at a tip, and two at one place.
const ArmLegsLoad on_legs{.wrench = pushed.wrench,
                          .along = {0.3, -0.2, 0.1},
                          .points = {{0, 0.033, {0.1, 0.05, -0.02}},
                                     {0, 0.1, {-0.05, 0, 0.03}},
                                     {2, 0.2, {0, 0.06, -0.1}},
                                     {2, 0.151, {0.02, -0.04, 0}},
                                     {2, 0.151, {0.02, 0, 0}}}};

/// The same with what turns with the robot, and with moments: without a potential.
ArmLegsLoad turning() {
  ArmLegsLoad load = on_legs;
  load.points.push_back({0, 0.051, {0, 0, 0, 1e-3, -2e-3, 1e-3}});
  load.points.push_back({0, 0.1, {-0.05, 0.02, 0.03, 0, 1e-3, 2e-3}, true});
  load.points.push_back({2, 0.2, {0, 0.06, -0.1, 1e-3, 0, 2e-3}, true});
  load.following = {0.03, -0.02, 0.04, 2e-3, 1e-3, -2e-3};
  load.following_along = {0.2, -0.1, 0.15};
  return load;
}

/// The load of a leg as its arm has it, in the axes of its base.
ArmLoad own_load(const ArmLegs& robot, const ArmLegsState& state, const ArmLegsLoad& load, std::size_t k,
                 const SE3<double>& base) {
  const auto back = [&](const double* v) { return base.rotate_back(Vec3<double>(v[0], v[1], v[2])); };
  ArmLoad own;
  const auto& tip = state.tip_loads[k];
  const Vec3<double> force = back(tip.data()), moment = back(tip.data() + 3), along = back(load.along.data()),
                     g = back(load.gravity.value_or(robot.gravity).data());
  own.wrench = {force[0], force[1], force[2], moment[0], moment[1], moment[2]};
  own.along = {along[0], along[1], along[2]};
  own.gravity = {g[0], g[1], g[2]};
  for (const ArmLegsPointLoad& point : load.points) {
    if (point.leg != k) continue;
    PointLoad& on_arm = own.points.emplace_back();
    on_arm.place = point.place;
    on_arm.wrench = point.wrench;
    if (on_arm.following = point.following; point.following) continue;
    const Vec3<double> f = back(point.wrench.data()), m = back(point.wrench.data() + 3);
    on_arm.wrench = {f[0], f[1], f[2], m[0], m[1], m[2]};
  }
  own.following_along = load.following_along;
  return own;
}

/// @param near each arm begins at the leg's shape; where the arm leaves it, since without the platform it
/// does not hold there, it is not compared
/// @return how many arms were compared
int expect_alone(const ArmLegs& robot, const ArmLegsState& state, const ArmLegsLoad& load,
                 std::span<const TendonCommand> commands, ArmOptions options, const ArmLegsWorkspace& work,
                 double by, bool near = false) {
  Vec<double, 6> sum = Vec<double, 6>::Zero();
  int compared = 0;
  for (std::size_t first = 0, k = 0; k < robot.legs.size(); ++k) {
    const ArmLeg& leg = robot.legs[k];
    const Arm& arm = leg.arm;
    const double ends[] = {0, arm.length()};
    const auto frames = arm_frames(arm, ends, arm_legs_shape(work, k));
    ArmWorkspace alone(arm);
    const auto curvatures = arm_curvatures(arm, 20, arm_legs_shape(work, k));
    if (near) options.from_curvatures = curvatures;
    const ArmState one = arm_forward(arm, commands.subspan(first, arm.tendons.size()),
                                     own_load(robot, state, load, k, frames[0]), options, alone);
    const double off = (frames[0].compose(one.tip).p - frames[1].p).norm();
    const bool is_compared = !near || (one.report.ok() && off < 1e-3);
    const Vec3<double> point = state.platform.point(leg.platform_point);
    EXPECT_NEAR((point - frames[1].p).norm(), leg.strut, by);
    if (is_compared) {
      ++compared;
      EXPECT_TRUE(one.report.ok()) << robot.name << k << one.report.message.view();
      EXPECT_LT(off, by) << robot.name << k;
      EXPECT_LT(frames[0].compose(one.tip).R.compose(frames[1].R.inverse()).log().norm(), 100 * by);
    }
    for (std::size_t i = 0; i < arm.tendons.size() && is_compared; ++i) {
      EXPECT_NEAR(one.tensions[i], state.tensions[first + i], 1e-5) << robot.name << k;
      EXPECT_NEAR(one.changes[i], state.changes[first + i], by) << robot.name << k;
    }
    const auto& tip = state.tip_loads[k];
    const Vec3<double> force(tip[0], tip[1], tip[2]), moment(tip[3], tip[4], tip[5]);
    sum.head<3>() += force;
    sum.tail<3>() += moment + cross(Vec3<double>(point - state.platform.p), force);
    first += arm.tendons.size();
  }
  const auto& with = load.following;
  sum.head<3>() -= state.platform.rotate(Vec3<double>(with[0], with[1], with[2]));
  sum.tail<3>() -= state.platform.rotate(Vec3<double>(with[3], with[4], with[5]));
  for (int i = 0; i < 6; ++i) {
    if (robot.is_planar && i > 1 && i < 5) continue;
    const double weight = i < 3 ? robot.platform_mass * robot.gravity[static_cast<std::size_t>(i)] : 0;
    EXPECT_NEAR(sum[i], load.wrench[static_cast<std::size_t>(i)] + weight, 1e-8);
  }
  return compared;
}

/// What is least, with the motors that hold tensions [J].
double whole_energy(const ArmLegsState& state, std::span<const TendonCommand> commands) {
  double sum = state.energy;
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (commands[i].held == TendonHeld::tension) sum += state.tensions[i] * state.changes[i];
  return sum;
}

TEST(ArmLegsLoads, EveryLegAloneBearsThem) {
  for (const bool is_clamped : {false, true})
    for (const ArmLegsLoad& load : {on_legs, turning()})
      for (const auto& commands : {uneven, mixed()}) {
        const ArmLegs robot = tripod(is_clamped);
        ArmLegsWorkspace work(robot);
        const ArmLegsState state = arm_legs_forward(robot, commands, load, sharp, work);
        ASSERT_TRUE(state.report.ok()) << state.report.message.view();
        EXPECT_TRUE(state.stable);
        expect_alone(robot, state, load, commands, sharp, work, 1e-8);
      }
}

TEST(ArmLegsLoads, EveryLegAloneBearsAnyOfThem) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> between(-1, 1);
  const auto any = [&](double size) { return size * between(random); };
  const auto wrench = [&](double force) {
    std::array<double, 6> numbers;
    for (std::size_t i = 0; i < 6; ++i) numbers[i] = any(i < 3 ? force : 0.02 * force);
    return numbers;
  };
  int solved = 0;
  for (int round = 0; round < 10; ++round) {
    ArmLegs robot = tripod(round % 2 == 0);
    for (ArmLeg& leg : robot.legs) {
      leg.platform_point += Vec3<double>(any(0.02), any(0.02), any(0.01));
      leg.base.R = leg.base.R.compose(SO3<double>::exp({any(0.2), any(0.2), any(1)}));
      leg.mount = leg.base.R;
    }
    ArmLegsLoad load{.wrench = wrench(0.1)};
    load.following = wrench(0.1);
    for (std::size_t i = 0; i < 3; ++i) load.along[i] = any(0.3), load.following_along[i] = any(0.3);
    for (int k = 0; k < 4; ++k) {
      const auto leg = static_cast<std::size_t>(k) % 3;
      load.points.push_back({leg, 0.1 + any(0.099), wrench(0.1), between(random) > 0});
    }
    std::vector<TendonCommand> commands = mixed();
    for (TendonCommand& command : commands)
      if (command.held == TendonHeld::tension) command.value = std::abs(any(1));
    ArmLegsWorkspace work(robot);
    const ArmLegsState state = arm_legs_forward(robot, commands, load, sharp, work);
    if (!state.report.ok()) continue;
    solved += expect_alone(robot, state, load, commands, sharp, work, 1e-8, true);
  }
  EXPECT_GE(solved, 20);  // of 30 legs
}

/// The moment at a base, as its curvature tells, is what all loads of the leg and the platform put there.
TEST(ArmLegsLoads, BasesBearAllThatActs) {
  for (const bool is_clamped : {false, true}) {
    ArmLegs robot = tripod(is_clamped, false);
    const std::vector<TendonCommand> loose(18);
    const ArmLegsLoad load = turning();
    const ArmOptions options{.model = ArmModel::rod, .order = 6, .elements = 40, .tolerance = 1e-12};
    ArmLegsWorkspace work(robot);
    const ArmLegsState state = arm_legs_forward(robot, loose, load, options, work);
    ASSERT_TRUE(state.report.ok()) << state.report.message.view();
    for (std::size_t k = 0; k < 3; ++k) {
      const Arm& arm = robot.legs[k].arm;
      const ArmWorkspace& shape = arm_legs_shape(work, k);
      constexpr std::size_t count = 400;
      std::vector<double> places;
      for (std::size_t n = 0; n <= count; ++n)
        places.push_back(arm.length() * static_cast<double>(n) / count);
      const auto frames = arm_frames(arm, places, shape);
      const Vec3<double> base = frames[0].p;
      Vec3<double> moment(0, 0, 0);
      const auto add = [&](const SE3<double>& at, const std::array<double, 6>& wrench, bool following) {
        Vec3<double> force(wrench[0], wrench[1], wrench[2]), own(wrench[3], wrench[4], wrench[5]);
        if (following) force = at.rotate(force), own = at.rotate(own);
        moment += own + cross(Vec3<double>(at.p - base), force);
      };
      add(frames.back(), state.tip_loads[k], false);
      for (const ArmLegsPointLoad& point : load.points)
        if (point.leg == k) {
          const double place[] = {point.place};
          add(arm_frames(arm, place, shape)[0], point.wrench, point.following);
        }
      for (std::size_t n = 0; n <= count; ++n) {  // Simpson's rule
        const double share = (n == 0 || n == count ? 1 : n % 2 ? 4 : 2) * arm.length() / (3.0 * count);
        std::array<double, 6> dead{}, following{};
        for (std::size_t i = 0; i < 3; ++i)
          dead[i] = share * load.along[i], following[i] = share * load.following_along[i];
        add(frames[n], dead, false);
        add(frames[n], following, true);
      }
      const double start[] = {0};
      const auto strain = arm_strains(arm, start, shape)[0];
      const CrossSection& section = arm.sections[0].start;
      const Vec3<double> bears = frames[0].rotate(Vec3<double>(
          section.bending_x * strain[3], section.bending_y * strain[4], section.torsion * strain[5]));
      EXPECT_LT((bears - moment).norm(), 1e-5 * moment.norm()) << is_clamped << k;
    }
  }
}

/// A platform without weight, clamped to the tip of one leg, is that tip.
TEST(ArmLegsLoads, APlatformOnOneLegIsTheTipOfAnArm) {
  ArmLegs robot;
  robot.name = "one leg";
  robot.home.position = {0, 0, 0.2};
  robot.legs.emplace_back().arm = leg_of_sections();
  robot.legs[0].is_clamped = true;
  const Arm& arm = robot.legs[0].arm;
  const auto commands = tensions({1, 0, 0.3, 0, 0.5, 0});
  ArmLegsLoad load{.wrench = {0.03, 0.02, -0.05, 0, 1e-3, 1e-3}};
  load.following = {0.02, -0.04, -0.1, 1e-3, -2e-3, 3e-3};
  load.following_along = {0.1, 0.1, -0.1};
  load.points = {{0, 0.12, {0.05, 0, 0, 0, 2e-3, 0}, true}};
  const ArmLoad own{.wrench = load.wrench,
                    .following = load.following,
                    .following_along = load.following_along,
                    .points = {{0.12, load.points[0].wrench, true}}};
  ArmLegsWorkspace work(robot);
  ArmWorkspace alone(arm);
  const ArmLegsState state = arm_legs_forward(robot, commands, load, sharp, work);
  const ArmState tip = arm_forward(arm, commands, own, sharp, alone);
  ASSERT_TRUE(state.report.ok() && tip.report.ok()) << state.report.message.view();
  EXPECT_LT(distance(state.platform, tip.tip), 1e-9);
  const ArmLegsRates rates = arm_legs_rates(robot, work);
  const ArmRates of_arm = arm_rates(arm, alone);
  for (std::size_t i = 0; i < 36; ++i)
    EXPECT_NEAR(rates.compliance[i], of_arm.compliance[i], 1e-6 * std::abs(of_arm.compliance[i]) + 1e-7) << i;
  // where the symmetric part is no longer definite the arm's margin is used up
  const std::array<double, 6> direction{0, 0, 0, 0, 0, 1};
  const ArmLegsLoadPath path = arm_legs_follow_load(robot, direction, 10, work);
  ASSERT_GT(path.definite_until, 0) << static_cast<int>(path.end);
  EXPECT_GE(path.load, path.definite_until);
  ArmLoad more = own;
  ArmOptions from_last = sharp;
  from_last.from_last = true;
  for (int k = 1; k <= 10; ++k) {
    more.wrench[5] = own.wrench[5] + 0.1 * k * path.definite_until;
    ASSERT_TRUE(arm_forward(arm, commands, more, from_last, alone).report.ok()) << k;
  }
  EXPECT_NEAR(arm_rates(arm, alone).margin, 0, 1e-6);
}

TEST(ArmLegsLoads, EveryModelBearsThem) {
  for (const int discs : {5, 0})
    for (const ArmModel model : every_model) {
      ArmLegs robot = tripod(false);
      for (ArmLeg& leg : robot.legs)
        for (ArmSection& section : leg.arm.sections) section.discs.count = discs;
      ArmOptions options = sharp;
      options.model = model;
      ArmLegsWorkspace work(robot);
      const ArmLegsState state = arm_legs_forward(robot, uneven, on_legs, options, work);
      ASSERT_TRUE(state.report.ok()) << static_cast<int>(model) << state.report.message.view();
      expect_alone(robot, state, on_legs, uneven, options, work, 1e-8);
    }
}

TEST(ArmLegsLoads, WeightIsALoadAlongTheLegs) {
  ArmLegs robot = tripod(true);
  robot.platform_mass = 0;
  for (ArmLeg& leg : robot.legs)
    for (ArmSection& section : leg.arm.sections) {
      section.discs.mass = 0;
      section.start.mass = section.end.mass = 0.05;
    }
  ArmLegsWorkspace work(robot), other(robot);
  const ArmLegsState heavy = arm_legs_forward(robot, mixed(), pushed, sharp, work);
  ArmLegsLoad load = pushed;
  load.gravity = std::array<double, 3>{0, 0, 0};
  load.along = {0, 0, -0.05 * 9.81};
  const ArmLegsState same = arm_legs_forward(robot, mixed(), load, sharp, other);
  ASSERT_TRUE(heavy.report.ok() && same.report.ok());
  EXPECT_LT(distance(heavy.platform, same.platform), 1e-11);
  EXPECT_NEAR(heavy.energy, same.energy, 1e-12);
  const ArmLegsRates a = arm_legs_rates(robot, work), b = arm_legs_rates(robot, other);
  for (std::size_t i = 0; i < 36; ++i) EXPECT_NEAR(a.stiffness[i], b.stiffness[i], 1e-6);
}

/// ∂(least potential)/∂(force) is less the place where it acts. What acts on a base does no work and is left
/// out.
TEST(ArmLegsLoads, ThePotentialFallsByThePlacesOfForces) {
  const ArmLegs robot = tripod(true);
  const auto commands = mixed();
  ArmLegsWorkspace work(robot), other(robot);
  ASSERT_TRUE(arm_legs_forward(robot, commands, on_legs, sharp, work).report.ok());
  const auto energy_by = [&](const auto& change) {
    ArmLegsLoad up = on_legs, down = on_legs;
    for (std::size_t k = 0; k < 3; ++k) up.wrench[k + 3] = down.wrench[k + 3] = 0;
    change(up, 1e-4);
    change(down, -1e-4);
    const ArmLegsState a = arm_legs_forward(robot, commands, up, sharp, other),
                       b = arm_legs_forward(robot, commands, down, sharp, work);
    EXPECT_TRUE(a.report.ok() && b.report.ok());
    return (whole_energy(a, commands) - whole_energy(b, commands)) / 2e-4;
  };
  ArmLegsLoad middle = on_legs;
  for (std::size_t k = 0; k < 3; ++k) middle.wrench[k + 3] = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const std::size_t at : {0U, 1U, 2U}) {
      const double by = energy_by([&](ArmLegsLoad& load, double step) { load.points[at].wrench[i] += step; });
      arm_legs_forward(robot, commands, middle, sharp, work);
      const double places[] = {on_legs.points[at].place};
      const std::size_t leg = on_legs.points[at].leg;
      const Vec3<double> p = arm_frames(robot.legs[leg].arm, places, arm_legs_shape(work, leg))[0].p;
      EXPECT_NEAR(by, -p[static_cast<int>(i)], 1e-6) << at << i;
    }
    const double by = energy_by([&](ArmLegsLoad& load, double step) { load.along[i] += step; });
    arm_legs_forward(robot, commands, middle, sharp, work);
    double sum = 0;  // Simpson's rule between discs
    for (std::size_t leg = 0; leg < 3; ++leg) {
      std::vector<double> places;
      for (int n = 0; n <= 200; ++n) places.push_back(0.001 * n);
      const auto frames = arm_frames(robot.legs[leg].arm, places, arm_legs_shape(work, leg));
      for (std::size_t n = 0; n <= 200; ++n)
        sum += (n == 0 || n == 200 ? 1 : n % 2 ? 4 : 2) * frames[n].p[static_cast<int>(i)] * 0.001 / 3;
      const auto& foot = arm_legs_shape(work, leg).impl().levels.front()->model.lengths.front();
      const Vec3<double> share = foot.amount * frames[0].p + frames[0].rotate({0, 0, foot.moment[2]});
      sum -= share[static_cast<int>(i)];
    }
    EXPECT_NEAR(by, -sum, 1e-6) << i;
  }
}

TEST(ArmLegsLoads, StiffnessAndRatesMatchDifferences) {
  for (const int round : {0, 1, 2, 3}) {
    const bool is_dead = round < 2;
    const ArmLegs robot = tripod(round % 2 == 1);
    const ArmLegsLoad load = is_dead ? on_legs : turning();
    const auto commands = mixed();
    ArmLegsWorkspace work(robot), other(robot);
    const SE3<double> at = arm_legs_forward(robot, commands, load, sharp, work).platform;
    const ArmLegsRates rates = arm_legs_rates(robot, work);
    ASSERT_TRUE(rates.regular && rates.has_stiffness);
    const auto twist_of = [&](const SE3<double>& to) {
      Vec<double, 6> twist;
      twist << to.p - at.p, to.R.compose(at.R.inverse()).log();
      return twist;
    };
    for (std::size_t i = 0; i < 6; ++i) {
      const double h = i < 3 ? 1e-4 : 1e-5;
      ArmLegsLoad up = load, down = load;
      up.wrench[i] += h, down.wrench[i] -= h;
      const Vec<double, 6> a = twist_of(arm_legs_forward(robot, commands, up, sharp, other).platform),
                           b = twist_of(arm_legs_forward(robot, commands, down, sharp, other).platform);
      Vec<double, 6> column;
      for (std::size_t j = 0; j < 6; ++j) column[static_cast<int>(j)] = rates.compliance[6 * j + i];
      EXPECT_LT(((a - b) / (2 * h) - column).norm(), 1e-4 * column.norm()) << i;
      for (std::size_t j = 0; j < 6; ++j)  // dead loads: it is symmetric but for the platform's moment
        if (is_dead && i < 3 && j < 3) {
          EXPECT_NEAR(rates.stiffness[6 * i + j], rates.stiffness[6 * j + i], 1e-6);
        }
    }
    for (const std::size_t k : {0U, 2U, 9U, 15U}) {
      const double h = commands[k].held == TendonHeld::tension ? 1e-4 : 1e-6;
      auto up = commands, down = commands;
      up[k].value += h, down[k].value -= std::min(h, down[k].value < 0 ? h : down[k].value);
      const Vec<double, 6> a = twist_of(arm_legs_forward(robot, up, load, sharp, other).platform),
                           b = twist_of(arm_legs_forward(robot, down, load, sharp, other).platform);
      Vec<double, 6> column;
      for (std::size_t j = 0; j < 6; ++j) column[static_cast<int>(j)] = rates.J[18 * j + k];
      EXPECT_LT(((a - b) / (up[k].value - down[k].value) - column).norm(), 2e-3 * column.norm() + 1e-8) << k;
    }
  }
}

/// A load that moves along a leg and to another one, from the last equilibrium on.
TEST(ArmLegsLoads, TheyMayMoveAlongLegs) {
  for (const int discs : {5, 0})
    for (const ArmModel model : every_model) {
      ArmLegs robot = tripod(true);
      for (ArmLeg& leg : robot.legs)
        for (ArmSection& section : leg.arm.sections) section.discs.count = discs;
      ArmLegsWorkspace walking(robot), fresh(robot);
      ArmOptions cold;
      cold.model = model;
      if (model != ArmModel::subsegment_rod) cold.accuracy = 0;
      ArmOptions warm = cold;
      warm.from_last = true;
      int of_warm = 0, of_cold = 0;
      for (int k = 0; k < 5; ++k) {
        ArmLegsLoad load;
        load.points = {{static_cast<std::size_t>(k) / 3, 0.043 + 0.031 * k, {0.1, -0.05, 0.04 * k}}};
        const ArmLegsState a = arm_legs_forward(robot, mixed(), load, warm, walking),
                           b = arm_legs_forward(robot, mixed(), load, cold, fresh);
        ASSERT_TRUE(a.report.ok() && b.report.ok()) << static_cast<int>(model) << a.report.message.view();
        EXPECT_TRUE(a.report.message.empty()) << a.report.message.view();
        // other nodes; without polynomials that follow they are other models
        const double by = model == ArmModel::subsegment_rod && discs > 0 ? 2e-6 : 2e-3;
        EXPECT_LT(distance(a.platform, b.platform), by)
            << static_cast<int>(model) << ' ' << discs << ' ' << k;
        std::size_t breaks = 0;
        for (const auto& places : walking.impl().breaks) breaks += places.size();
        EXPECT_LE(breaks, 2U);  // those that are left go
        if (k > 0) of_warm += a.report.iterations, of_cold += b.report.iterations;
      }
      EXPECT_LT(of_warm, of_cold) << static_cast<int>(model) << ' ' << discs;
    }
}

void expect_every_question_takes(const ArmLegsLoad& loaded) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot), other(robot);
  const auto commands = mixed();
  const ArmLegsState there = arm_legs_forward(robot, commands, loaded, {}, work);
  ASSERT_TRUE(there.report.ok());
  EXPECT_LE(there.resolution, 1e-6 * 0.2);
  ArmLegsLoad without = loaded;
  without.wrench = {};
  // until
  const ArmLegsState begun = arm_legs_forward(robot, commands, without, {}, other);
  ASSERT_TRUE(begun.report.ok());
  const ArmLegsLoadPath path = arm_legs_follow_load(robot, loaded.wrench, 1, other);
  ASSERT_EQ(path.end, LoadEnd::limit);
  EXPECT_LT(distance(path.state.platform, there.platform), 2e-6);
  // held there by the wrench, from elsewhere, too
  for (const bool from_last : {false, true}) {
    ArmOptions options;
    options.from_last = from_last;
    if (from_last) {
      ASSERT_TRUE(arm_legs_forward(robot, uneven, {}, {}, other).report.ok());
    }
    const ArmLegsHeld held = arm_legs_hold(robot, there.platform, commands, without, options, other);
    ASSERT_TRUE(held.state.report.ok()) << held.state.report.message.view();
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(held.wrench[i], loaded.wrench[i], 2e-4);
  }
  // sensed by what the tendons pull and the pose
  ArmLegsMeasurement measured{.held = commands, .answers = there.tensions};
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (commands[i].held == TendonHeld::tension) measured.answers[i] = there.changes[i];
  measured.position = std::array<double, 3>{there.platform.p[0], there.platform.p[1], there.platform.p[2]};
  const SO3<double>& turn = there.platform.R;
  measured.quaternion = std::array<double, 4>{turn.w, turn.v[0], turn.v[1], turn.v[2]};
  const ArmLegsSensed sensed = arm_legs_sense(robot, measured, without, false, {}, other);
  ASSERT_TRUE(sensed.report.ok()) << sensed.report.message.view();
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(sensed.wrench[i], loaded.wrench[i], 1e-3);
  // tensions that hold the pose, from an equilibrium without the loads, too
  for (const bool from_last : {false, true}) {
    ArmInverseOptions options;
    options.arm.from_last = from_last;
    if (from_last) {
      ASSERT_TRUE(arm_legs_forward(robot, uneven, {}, {}, other).report.ok());
    }
    const ArmLegsInverse found = arm_legs_inverse(
        robot, {.position = measured.position, .quaternion = measured.quaternion}, loaded, options, other);
    ASSERT_TRUE(found.report.ok()) << found.report.message.view();
    std::vector<TendonCommand> pulled;
    for (const double tension : found.state.tensions) pulled.push_back({TendonHeld::tension, tension});
    const ArmLegsState back = arm_legs_forward(robot, pulled, loaded, {}, other);
    EXPECT_LT(distance(back.platform, there.platform), 5e-6);
  }
  // along a path on which loads come, move and go
  std::vector<ArmLegsStep> steps(4);
  steps[0] = {.commands = commands, .divisions = 1};
  steps[1] = {.commands = commands, .load = loaded, .divisions = 3};
  steps[2] = {.commands = commands, .load = without, .divisions = 2};
  steps[2].load.points = {{1, 0.05, {0.1, 0, 0}}};
  steps[3] = {.commands = commands, .divisions = 2};
  const auto points = arm_legs_track(robot, steps, {}, other);
  ASSERT_EQ(points.size(), 8U) << points.back().report.message.view();
  EXPECT_LT(distance(points[3].platform, there.platform), 2e-6);
  EXPECT_LT(distance(points[5].platform, arm_legs_forward(robot, commands, steps[2].load, {}, work).platform),
            2e-6);
  EXPECT_LT(distance(points[7].platform, points[0].platform), 2e-6);
  ArmLegsLoad half = loaded;  // evenly
  const double share = 1.0 / 3;
  for (double& number : half.wrench) number *= share;
  for (double& number : half.along) number *= share;
  for (double& number : half.following) number *= share;
  for (double& number : half.following_along) number *= share;
  for (ArmLegsPointLoad& point : half.points)
    for (double& number : point.wrench) number *= share;
  EXPECT_LT(distance(points[1].platform, arm_legs_forward(robot, commands, half, {}, work).platform), 2e-6);
  // other equilibria, and a start at one
  const auto all = arm_legs_equilibria(robot, commands, loaded, {}, 5, other);
  ASSERT_FALSE(all.empty());
  double nearest = 1;
  for (const ArmLegsEquilibrium& one : all)
    nearest = std::min(nearest, distance(one.state.platform, there.platform));
  EXPECT_LT(nearest, 2e-6);
  const ArmLegsState again = arm_legs_forward_from(robot, all.front().start, commands, loaded, {}, work);
  ASSERT_TRUE(again.report.ok()) << again.report.message.view();
  EXPECT_LT(distance(again.platform, all.front().state.platform), 2e-6);
}

TEST(ArmLegsLoads, EveryQuestionTakesThem) { expect_every_question_takes(on_legs); }
TEST(ArmLegsLoads, EveryQuestionTakesWhatTurns) { expect_every_question_takes(turning()); }

TEST(ArmLegsLoads, BadOnesAreRefusedByName) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  const auto refused = [&](const ArmLegsLoad& load, Status status, std::string_view words) {
    const Report report = arm_legs_forward(robot, uneven, load, {}, work).report;
    EXPECT_EQ(report.status, status) << report.message.view();
    EXPECT_NE(report.message.view().find(words), std::string_view::npos) << report.message.view();
    EXPECT_EQ(arm_legs_inverse(robot, {.position = std::array<double, 3>{0, 0, 0.19}}, load, {}, work)
                  .report.status,
              status);
    EXPECT_EQ(arm_legs_equilibria(robot, uneven, load, {}, 2, work).front().state.report.status, status);
    ArmLegsStep step{.commands = uneven, .load = load};
    EXPECT_EQ(arm_legs_track(robot, std::span(&step, 1), {}, work).back().report.status, status);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto one = [](std::size_t leg, double place, std::array<double, 6> wrench) {
    ArmLegsLoad load;
    load.points = {{leg, place, wrench}};
    return load;
  };
  refused(one(3, 0.1, {1}), Status::bad_input, "leg 3");
  refused(one(std::numeric_limits<std::size_t>::max(), 0.1, {1}), Status::bad_input, "3 legs");
  for (const double place : {0.0, -0.1, 0.21, nan, inf})
    refused(one(1, place, {1}), Status::bad_input, "0.2 m long");
  refused(one(1, 0.1, {nan}), Status::bad_input, "not finite");
  refused(one(1, 0.1, {0, 0, 0, 0, 0, inf}), Status::bad_input, "not finite");
  ArmLegsLoad along;
  along.along = {0, nan, 0};
  refused(along, Status::bad_input, "not finite");
  along.along = {}, along.following_along = {0, 0, inf};
  refused(along, Status::bad_input, "not finite");
  along.following_along = {}, along.following = {0, 0, 0, 0, nan, 0};
  refused(along, Status::bad_input, "not finite");
  // far too much: a status, and no numbers that do not hold
  const Report much = arm_legs_forward(robot, uneven, one(0, 0.1, {1e6, 0, 0}), {}, work).report;
  EXPECT_EQ(much.status, Status::stalled);
  EXPECT_FALSE(much.message.empty());
  // at the base, which bears it
  const SE3<double> without = arm_legs_forward(robot, uneven, {}, {}, work).platform;
  for (const double place : {1e-300, 1e-11})
    EXPECT_LT(distance(arm_legs_forward(robot, uneven, one(0, place, {1}), {}, work).platform, without),
              1e-9);
  // where nothing acts nothing is asked of the rods
  ASSERT_TRUE(arm_legs_forward(robot, uneven, one(1, 0.033, {}), {}, work).report.ok());
  for (const auto& places : work.impl().breaks) EXPECT_TRUE(places.empty());
}

}  // namespace sinew::test::arm_legs_loads_test
