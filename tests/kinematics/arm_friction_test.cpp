/// Arms whose tendons rub, followed along paths (docs/theory/tendon_friction.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "arms.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::test {
namespace arm_friction_test {

/// One section of so many discs (0: channels) with tendons on opposite sides.
Arm two_tendons(int discs, double friction, double compliance = 5e-5, double outside = 0.2) {
  Arm arm;
  ArmSection section;
  section.length = 0.2;
  section.start = section.end = round_section({54e9, 54e9 / 2.6, 0}, 0.0014);
  section.discs.count = discs;
  arm.sections = {section};
  for (const double angle : {0.3, 0.3 + std::numbers::pi}) {
    arm.tendons.push_back(tendon_at(0, 0.01, angle, compliance));
    arm.tendons.back().friction = friction;
    arm.tendons.back().outside = outside;
  }
  return arm;
}
/// Of tip and tendon along the path.
double distance(const SE3<double>& a, const SE3<double>& b) { return (a.p - b.p).norm(); }
double sum(const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0); }

/// The first tendon goes through these values, the second is held by a tension.
std::vector<ArmStep> pulls(const std::vector<double>& values, TendonHeld held = TendonHeld::change,
                           double other = 0) {
  std::vector<ArmStep> steps;
  for (const double value : values) steps.push_back({{{held, value}, {TendonHeld::tension, other}}, {}});
  return steps;
}
/// From a to b in so many steps, a left out.
std::vector<double> ramp(double a, double b, int count) {
  std::vector<double> values;
  for (int k = 1; k <= count; ++k) values.push_back(a + (b - a) * k / count);
  return values;
}
void expect_all_found(const std::vector<ArmPathPoint>& points, std::size_t count) {
  ASSERT_EQ(points.size(), count) << to_string(points.back().state.report);
  for (const ArmPathPoint& point : points)
    ASSERT_TRUE(point.state.report.ok()) << to_string(point.state.report);
}

TEST(ArmFriction, APulledTendonLosesTensionByCapstanLaw) {
  for (const int discs : {0, 10})
    for (const TendonHeld held : {TendonHeld::change, TendonHeld::tension})
      for (const double friction : {0.05, 0.3, 0.8}) {
        const Arm arm = two_tendons(discs, friction);
        ArmWorkspace work(arm);
        const auto values = held == TendonHeld::change ? ramp(0, -0.012, 12) : ramp(0, 12, 12);
        const auto points = arm_follow(
            arm, pulls(values, held),
            {.model = discs > 0 ? ArmModel::subsegment_rod : ArmModel::rod, .tolerance = 1e-12}, work);
        expect_all_found(points, 12);
        for (const ArmPathPoint& point : points) {
          const auto& T = point.tensions[0];
          EXPECT_NEAR(T.back() / T.front() / std::exp(-friction * sum(point.angles[0])), 1, 1e-9);
          EXPECT_EQ(T.front(), point.state.tensions[0]);
        }
        EXPECT_GT(sum(points.back().angles[0]), 0.5);
      }
}

/// A tendon that is held by no tension at all hangs loose in every span.
TEST(ArmFriction, PulledTendonsAreLetGoAltogether) {
  for (const int discs : {0, 8})
    for (const double compliance : {0.0, 5e-5}) {
      const Arm arm = two_tendons(discs, 0.3, compliance);
      ArmWorkspace work(arm);
      const auto points =
          arm_follow(arm, pulls({4, 0, 4, 1, 0}, TendonHeld::tension),
                     {.model = discs > 0 ? ArmModel::subsegment_rod : ArmModel::rod, .accuracy = 0}, work);
      expect_all_found(points, 5);
      for (const std::size_t k : {1U, 4U}) {
        EXPECT_LT((points[k].state.tip.p - Vec3<double>(0, 0, 0.2)).norm(), 1e-9);
        for (const double tension : points[k].tensions[0]) EXPECT_EQ(tension, 0);
      }
      EXPECT_LT(distance(points[2].state.tip, points[0].state.tip), 1e-9);
    }
}

/// Where a path turns within a step, trapezoids over all of it would have friction give energy.
TEST(ArmFriction, CoarseStepsStillLose) {
  const Arm arm = two_tendons(10, 0.3);
  const ArmOptions options{.accuracy = 0, .tolerance = 1e-12};
  double exact = 0;
  for (const int divisions : {100, 10, 2, 1}) {
    ArmWorkspace work(arm);
    auto steps = pulls({8, 1, 8, 1, 8}, TendonHeld::tension);
    for (ArmStep& step : steps) step.divisions = divisions;
    const auto points = arm_follow(arm, steps, options, work);
    expect_all_found(points, static_cast<std::size_t>(5 * divisions));
    double loss = 0;
    for (const ArmPathPoint& point : points) {
      EXPECT_GT(point.friction_loss, -1e-9) << divisions;
      loss += point.friction_loss;
    }
    if (divisions == 100) exact = loss;
    EXPECT_NEAR(loss / exact, 1, divisions > 2 ? 0.02 : 0.3) << divisions;
  }
}

/// Divisions are the steps that one would write down.
TEST(ArmFriction, DivisionsAreStepsOfTheirOwn) {
  const Arm arm = two_tendons(4, 0.2);
  const ArmOptions options{.accuracy = 0, .tolerance = 1e-12};
  ArmLoad load;
  load.wrench = {0.02, -0.01, 0, 0, 0, 0};
  ArmWorkspace one(arm), other(arm);
  std::vector<ArmStep> few{{{{TendonHeld::tension, 4}, {TendonHeld::tension, 0}}, {}, 4},
                           {{{TendonHeld::change, 0}, {TendonHeld::tension, 1}}, load, 5}};
  const auto points = arm_follow(arm, few, options, one);
  expect_all_found(points, 9);
  auto many = pulls(ramp(0, 4, 4), TendonHeld::tension);
  const double begin = points[3].state.changes[0];
  for (int k = 1; k <= 5; ++k) {
    ArmStep step{{{TendonHeld::change, begin * (1 - k / 5.0)}, {TendonHeld::tension, k / 5.0}}, load};
    for (double& number : step.load.wrench) number *= k / 5.0;
    many.push_back(step);
  }
  const auto same = arm_follow(arm, many, options, other);
  expect_all_found(same, 9);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_LT(distance(points[k].state.tip, same[k].state.tip), 1e-10) << k;
    EXPECT_NEAR(points[k].motor_work, same[k].motor_work, 1e-10);
  }
  few[1].divisions = 0;
  const auto refused = arm_follow(arm, few, options, one);
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(refused[0].state.report.status, Status::bad_input);
}

TEST(ArmFriction, WithoutItAPathIsReversibleAndThatOfArmForward) {
  for (const ArmModel model :
       {ArmModel::subsegment_rod, ArmModel::rod, ArmModel::subsegment_cc, ArmModel::cc, ArmModel::prb}) {
    const Arm arm = two_sections(5, 1e-4);
    ArmOptions options{.model = model, .accuracy = 0, .tolerance = 1e-12};
    std::mt19937 gen(4);
    std::uniform_real_distribution<double> any(0, 1);
    std::vector<ArmStep> steps;
    for (int k = 0; k < 8; ++k) {
      ArmStep step;
      for (int i = 0; i < 6; ++i)
        step.commands.push_back(i % 3 == 0 ? TendonCommand{TendonHeld::tension, 3 * any(gen)}
                                           : TendonCommand{TendonHeld::change, 0.002 - 0.005 * any(gen)});
      step.load.wrench = {0.2 * any(gen), -0.1 * any(gen), 0.1 * any(gen)};
      steps.push_back(step);
    }
    for (int k = 6; k >= 0; --k) steps.push_back(steps[static_cast<std::size_t>(k)]);
    ArmWorkspace work(arm), other(arm);
    const auto points = arm_follow(arm, steps, options, work);
    expect_all_found(points, 15);
    for (std::size_t k = 0; k < 15; ++k) {
      const ArmState& alone = arm_forward(arm, steps[k].commands, steps[k].load, options, other);
      ASSERT_TRUE(alone.report.ok());
      EXPECT_LT(distance(points[k].state.tip, alone.tip), 1e-9) << k;
      EXPECT_NEAR(points[k].state.energy, alone.energy, 1e-9) << k;
      EXPECT_LT(distance(points[k].state.tip, points[14 - k].state.tip), 1e-10) << k;
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(points[k].state.tensions[i], alone.tensions[i], 1e-7);
        EXPECT_NEAR(points[k].state.changes[i], alone.changes[i], 1e-9);
        EXPECT_NEAR(points[k].state.slack[i], alone.slack[i], 1e-9);
      }
      EXPECT_NEAR(points[k].friction_loss, 0, 1e-15);
    }
  }
}

/// Of the second cycle from one change to another and back.
struct Cycle {
  double work = 0, loss = 0, gap = 0;  ///< [J, J, m]: gap between its begin and its end
  double out = 0, back = 0;            ///< the tip's way across at the same change, let go and pulled [m]
};
Cycle cycle(const Arm& arm, double far, double near, int count, const ArmOptions& options) {
  ArmWorkspace work(arm);
  arm_follow(arm, pulls(ramp(0, far, 20)), options, work);
  ArmOptions on = options;
  on.from_last = true;
  const auto across = [](const ArmPathPoint& point) {
    return std::hypot(point.state.tip.p.x(), point.state.tip.p.y());
  };
  Cycle found;
  ArmPathPoint begin;
  for (int round = 0; round < 2; ++round) {
    const auto out = arm_follow(arm, pulls(ramp(far, near, count)), on, work),
               back = arm_follow(arm, pulls(ramp(near, far, count)), on, work);
    EXPECT_EQ(out.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(back.size(), static_cast<std::size_t>(count));
    EXPECT_TRUE(out.back().state.report.ok() && back.back().state.report.ok());
    if (round == 0) {
      begin = back.back();
      continue;
    }
    for (const auto* half : {&out, &back})
      for (const ArmPathPoint& point : *half) {
        found.work += point.motor_work;
        found.loss += point.friction_loss;
      }
    found.gap = distance(begin.state.tip, back.back().state.tip);
    const auto middle = static_cast<std::size_t>(count) / 2 - 1;
    found.out = across(out[middle]);
    found.back = across(back[middle]);
  }
  return found;
}

/// What motors put in over a cycle is what guides lose: both are summed by trapezoids, whose error falls with
/// the square of the step.
TEST(ArmFriction, WorkOfACycleIsWhatGuidesLose) {
  const ArmOptions options{.model = ArmModel::subsegment_cc, .accuracy = 0, .tolerance = 1e-13};
  const Arm arm = two_tendons(3, 0.2);
  double coarse = 0;
  for (const int count : {125, 500, 2000}) {
    const Cycle found = cycle(arm, -0.006, -0.005, count, options);
    const double off = std::abs(found.work - found.loss) / found.work;
    EXPECT_GT(found.loss, 1e-6);
    EXPECT_LT(off, count == 125 ? 1e-6 : coarse / 8);
    coarse = off;
  }
  EXPECT_LT(coarse, 1e-9);
}

TEST(ArmFriction, LoopsOfTheTipCloseInTheSecondCycle) {
  for (const int discs : {0, 6}) {
    const ArmOptions options{
        .model = discs > 0 ? ArmModel::subsegment_rod : ArmModel::rod, .accuracy = 0, .tolerance = 1e-12};
    const Cycle found = cycle(two_tendons(discs, 0.3), -0.008, -0.001, 20, options);
    EXPECT_LT(found.gap, 1e-11);
    EXPECT_GT(found.back, found.out + 1e-3);  // pulled, it bends more near its base
    EXPECT_GT(found.loss, 1e-4);
  }
}

TEST(ArmFriction, MoreOfItBendsLessAndLosesMore) {
  const ArmOptions options{.accuracy = 0, .tolerance = 1e-12};
  double across = 1, loss = -1;
  for (const double friction : {0.0, 0.02, 0.05, 0.1, 0.2, 0.4}) {
    const Arm arm = two_tendons(6, friction);
    ArmWorkspace work(arm);
    const auto points = arm_follow(arm, pulls(ramp(0, 8, 10), TendonHeld::tension, 1), options, work);
    expect_all_found(points, 10);
    const auto& p = points.back().state.tip.p;
    EXPECT_LT(std::hypot(p.x(), p.y()), across);
    across = std::hypot(p.x(), p.y());
    const double lost = cycle(arm, -0.008, -0.001, 20, options).loss;
    EXPECT_GT(lost, loss);
    loss = lost;
  }
}

/// A path in one piece and in two; the other workspace forgets between them.
TEST(ArmFriction, WhatHasSlippedIsRemembered) {
  const Arm arm = two_tendons(6, 0.3);
  ArmOptions options{.elements = 4, .accuracy = 0, .tolerance = 1e-12};
  auto way = ramp(0, -0.008, 10);
  const auto back = ramp(-0.008, -0.003, 10);
  ArmWorkspace one(arm), two(arm), forgets(arm);
  auto whole = way;
  whole.insert(whole.end(), back.begin(), back.end());
  const auto at_once = arm_follow(arm, pulls(whole), options, one);
  arm_follow(arm, pulls(way), options, two);
  arm_follow(arm, pulls(way), options, forgets);
  arm_forward(arm, changes({0, 0}), {}, options, two);  // another question does not disturb it
  const auto anew = arm_follow(arm, pulls(ramp(0, -0.003, 10)), options, forgets);
  options.from_last = true;
  auto steps = pulls(back);
  for (ArmStep& step : steps) step.load.points = {{0.11, {}}};  // its strain may have a kink there
  const auto later = arm_follow(arm, steps, options, two);
  expect_all_found(later, 10);
  EXPECT_LT(distance(at_once.back().state.tip, later.back().state.tip), 1e-7);
  EXPECT_GT(distance(at_once.back().state.tip, anew.back().state.tip), 5e-4);
  EXPECT_FALSE(arm_rates(arm, two).regular);
  EXPECT_LT(distance(arm_frames(arm, std::array{0.2}, two)[0], later.back().state.tip), 1e-12);
  options.model = ArmModel::cc;
  EXPECT_EQ(arm_follow(arm, steps, options, two).back().state.report.status, Status::bad_input);
}

/// Tendons that do not stretch are the limit of those that hardly do.
TEST(ArmFriction, TendonsNeedNotStretch) {
  const ArmOptions options{.model = ArmModel::subsegment_rod, .accuracy = 0, .tolerance = 1e-12};
  auto way = ramp(0, -0.008, 8);
  const auto back = ramp(-0.008, -0.003, 8);
  way.insert(way.end(), back.begin(), back.end());
  std::vector<SE3<double>> tips;
  for (const double compliance : {0.0, 1e-7, 1e-6}) {
    const Arm arm = two_tendons(4, 0.2, compliance);
    ArmWorkspace work(arm);
    const auto points = arm_follow(arm, pulls(way, TendonHeld::change, 1), options, work);
    expect_all_found(points, 16);
    tips.push_back(points.back().state.tip);
  }
  EXPECT_LT(distance(tips[0], tips[1]), 1e-4);
  EXPECT_LT(distance(tips[0], tips[1]), 0.2 * distance(tips[0], tips[2]));
}

TEST(ArmFriction, RandomPathsEndInEquilibriaOrSayNo) {
  std::mt19937 gen(31);
  std::uniform_real_distribution<double> any(0, 1), side(-1, 1);
  int found = 0, all = 0;
  for (int round = 0; round < 200; ++round) {
    Arm arm = two_sections(static_cast<int>(gen() % 5) + 2, 1e-5 * std::pow(20, any(gen)));
    if (round % 10 == 0)
      for (ArmSection& section : arm.sections) section.discs.count = 0;
    const bool rigid = round % 10 == 5;
    for (ArmTendon& tendon : arm.tendons) {
      tendon.friction = gen() % 4 == 0 ? 0 : 0.6 * any(gen);
      tendon.outside = 0.5 * any(gen);
      tendon.pretension = 2 * any(gen);
      if (rigid) tendon.compliance = 0;
      for (TendonRoute& route : tendon.routes) route.end_angle += 0.5 * side(gen);
    }
    arm.gravity = {3 * side(gen), 3 * side(gen), -9.81};
    std::vector<ArmStep> steps;
    std::vector<TendonHeld> held(6);
    for (std::size_t i = 0; i < 6; ++i)
      held[i] = gen() % 2 == 0 || (rigid && i % 3 > 0) ? TendonHeld::tension : TendonHeld::change;
    for (int k = 0; k < 4; ++k) {
      ArmStep step;
      for (std::size_t i = 0; i < 6; ++i) {
        if (gen() % 10 == 0 && !rigid)
          held[i] = held[i] == TendonHeld::tension ? TendonHeld::change : TendonHeld::tension;
        step.commands.push_back(
            {held[i], held[i] == TendonHeld::tension ? 5 * any(gen) : 0.004 * side(gen) - 0.001});
      }
      for (std::size_t i = 0; i < 3; ++i) step.load.wrench[i] = 0.2 * side(gen);
      if (round % 3 == 0)
        step.load.following = {0.1 * side(gen), 0.1 * side(gen), 0, 0, 0, 0.002 * side(gen)};
      steps.push_back(step);
    }
    const ArmOptions options{.model = arm.sections[0].discs.count == 0 ? ArmModel::rod
                                      : round % 2 == 0                 ? ArmModel::subsegment_rod
                                                                       : ArmModel::subsegment_cc,
                             .accuracy = 0};
    ArmWorkspace work(arm);
    const auto points = arm_follow(arm, steps, options, work);
    for (const ArmPathPoint& point : points) {
      ++all;
      const Report& report = point.state.report;
      ASSERT_TRUE(report.ok() || report.status == Status::stalled || report.status == Status::unstable ||
                  report.status == Status::iteration_limit)
          << to_string(report);
      ASSERT_TRUE(std::isfinite(point.state.tip.p.sum()) && std::isfinite(point.state.energy));
      ASSERT_TRUE(report.ok() || !report.message.empty());
      if (report.ok()) ++found;
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t k = 0; k + 1 < point.tensions[i].size(); ++k) {
          const double before = point.tensions[i][k], after = point.tensions[i][k + 1],
                       most = std::exp(arm.tendons[i].friction * point.angles[i][k]);
          ASSERT_TRUE(std::isfinite(before) && std::isfinite(after));
          ASSERT_GE(after, 0);
          if (report.ok()) {
            EXPECT_LE(after, before * most + 1e-9);
            EXPECT_LE(before, after * most + 1e-9);
          }
        }
    }
  }
  EXPECT_GT(found, all * 97 / 100);
  RecordProperty("found", std::to_string(found) + " of " + std::to_string(all));
}

/// All tendons let out until none pulls, or all pulled in until the arm buckles between its discs.
TEST(ArmFriction, PathsOfLooseAndOverPulledTendonsAreFollowed) {
  std::mt19937 gen(78);
  std::uniform_real_distribution<double> any(0, 1), side(-1, 1);
  int found = 0, all = 0;
  for (int round = 0; round < 24; ++round) {
    Arm arm = two_sections(static_cast<int>(gen() % 3) + 2, 1e-5 * std::pow(30, any(gen)));
    for (ArmTendon& tendon : arm.tendons) {
      tendon.friction = 0.1 + 0.5 * any(gen);
      tendon.outside = 0.5 * any(gen);
      tendon.pretension = 2 * any(gen);
      if (round % 6 == 5) tendon.compliance = 0;
      for (TendonRoute& route : tendon.routes) route.end_angle += 0.4 * side(gen);
    }
    arm.gravity = {3 * side(gen), 3 * side(gen), -9.81};
    std::vector<ArmStep> steps(4);
    for (ArmStep& step : steps) {
      const auto kind = gen() % 3;
      for (std::size_t i = 0; i < 6; ++i)
        step.commands.push_back({TendonHeld::change, kind == 0   ? 0.004 * any(gen)
                                                     : kind == 1 ? -0.006 * any(gen)
                                                                 : 0.005 * side(gen)});
      for (std::size_t i = 0; i < 3; ++i) step.load.wrench[i] = 0.3 * side(gen);
    }
    const ArmOptions options{.model = round % 3 == 0 ? ArmModel::subsegment_rod : ArmModel::subsegment_cc,
                             .accuracy = 0};
    ArmWorkspace work(arm);
    for (const ArmPathPoint& point : arm_follow(arm, steps, options, work)) {
      found += point.state.report.ok() ? 1 : 0;
      EXPECT_GE(point.friction_loss, -1e-6) << round;
    }
    all += 4;
  }
  EXPECT_GE(found, all * 95 / 100);
  RecordProperty("found", std::to_string(found) + " of " + std::to_string(all));
}

TEST(ArmFriction, RefusesWhatDoesNotFit) {
  const Arm arm = two_tendons(4, 0.1), other = two_tendons(4, 0.1);
  ArmWorkspace work(arm);
  EXPECT_TRUE(arm_follow(arm, {}, {}, work).empty());
  EXPECT_EQ(arm_follow(other, pulls({1}), {}, work)[0].state.report.status, Status::bad_input);
  EXPECT_EQ(arm_follow(arm, pulls({1, -1}, TendonHeld::tension), {}, work)[0].state.report.status,
            Status::bad_input);
  EXPECT_EQ(arm_follow(arm, pulls({1}), {.balance = ArmBalance::projected}, work)[0].state.report.status,
            Status::unsupported);
  work.stop = StopToken();
}

/// One-sided rates against small steps of the path, on and back, held by tensions or changes.
TEST(ArmFriction, RatesAreThoseOfSmallStepsOnAndBack) {
  for (const int discs : {0, 8})
    for (const TendonHeld held : {TendonHeld::tension, TendonHeld::change})
      for (const double compliance : {5e-5, 0.0})
        for (const bool turns : {false, true}) {
          SCOPED_TRACE(testing::Message() << discs << " discs, change " << (held == TendonHeld::change)
                                          << ", compliance " << compliance << ", turned " << turns);
          const Arm arm = two_tendons(discs, 0.3, compliance, compliance > 0 ? 0.2 : 0);
          const bool by_tension = held == TendonHeld::tension;
          const double most = by_tension ? 4 : -0.006, turned = by_tension ? 3.7 : -0.0058;
          std::vector<double> values = ramp(0, most, 4);
          if (turns) values.push_back(turned);  // some guides have slipped back, others not yet
          const ArmOptions options{.model = discs > 0 ? ArmModel::subsegment_rod : ArmModel::rod,
                                   .accuracy = 0,
                                   .tolerance = 1e-13};
          const auto follow_to = [&](double by, ArmWorkspace& work) {
            auto points = arm_follow(arm, pulls(values, held, 1), options, work);
            if (by != 0) {
              ArmOptions on = options;
              on.from_last = true;
              points = arm_follow(arm, pulls({values.back() + by}, held, 1), on, work);
            }
            EXPECT_TRUE(points.back().state.report.ok());
            return points.back().state;
          };
          for (const double sign : {1.0, -1.0}) {
            ArmWorkspace work(arm);
            const ArmState here = follow_to(0, work);
            const ArmPathRates rates = arm_path_rates(arm, std::vector<double>{sign, 0}, work);
            ASSERT_TRUE(rates.regular) << rates.message.view();
            // guides of a tendon that does not stretch begin to slip one by one within a few 1e-8 m
            const double step = by_tension ? 1e-4 : 1e-8;
            ArmWorkspace one(arm), two(arm);
            const ArmState small = follow_to(sign * step, one), large = follow_to(2 * sign * step, two);
            // without the term of first order in the step
            const auto rate = [&](auto value) {
              return (4 * (value(small) - value(here)) - (value(large) - value(here))) / (2 * step);
            };
            for (int k = 0; k < 3; ++k)
              EXPECT_NEAR(rates.twist[static_cast<std::size_t>(k)],
                          rate([&](const ArmState& state) { return state.tip.p[k]; }),
                          2e-4 * (std::abs(rates.twist[0]) + std::abs(rates.twist[1])) + 1e-9)
                  << sign << ' ' << k << ", slipping " << rates.slipping;
            EXPECT_NEAR(rates.changes[0], rate([](const ArmState& state) { return state.changes[0]; }),
                        2e-4 * std::abs(rates.changes[0]) + 1e-9);
            if (!std::isnan(rates.tensions[0])) {
              EXPECT_NEAR(rates.tensions[0], rate([](const ArmState& state) { return state.tensions[0]; }),
                          2e-4 * std::abs(rates.tensions[0]) + 1e-9);
            }
          }
        }
}

/// At the end of a pull all guides slip as it goes on; as it turns they stick, and the tip hardly follows.
TEST(ArmFriction, RatesOnAndBackDiffer) {
  const Arm arm = two_tendons(8, 0.3);
  ArmWorkspace work(arm);
  const std::vector<double> on{1, 0}, back{-1, 0};
  EXPECT_NE(arm_path_rates(arm, on, work).message.view().find("follow one first"), std::string_view::npos);
  arm_follow(arm, pulls({2, 4}, TendonHeld::tension, 1), {.tolerance = 1e-12}, work);
  const ArmPathRates going = arm_path_rates(arm, on, work), turning = arm_path_rates(arm, back, work);
  ASSERT_TRUE(going.regular && turning.regular);
  const auto speed = [](const ArmPathRates& rates) {
    return std::hypot(rates.twist[0], rates.twist[1], rates.twist[2]);
  };
  EXPECT_GT(going.slipping, 2 * turning.slipping);
  EXPECT_GT(speed(going), 2 * speed(turning));
  EXPECT_EQ(going.tensions[0], 1);
  // along one direction they are multiples; and the path, the state and what is remembered stay
  const ArmPathRates twice = arm_path_rates(arm, std::vector<double>{2, 0}, work);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(twice.twist[k], 2 * going.twist[k], 1e-9 * speed(going));
  ArmWorkspace other(arm);
  ArmOptions from_last{.tolerance = 1e-12};
  arm_follow(arm, pulls({2, 4}, TendonHeld::tension, 1), from_last, other);
  from_last.from_last = true;
  const auto asked = arm_follow(arm, pulls({3}, TendonHeld::tension, 1), from_last, work),
             not_asked = arm_follow(arm, pulls({3}, TendonHeld::tension, 1), from_last, other);
  EXPECT_LT(distance(asked.back().state.tip, not_asked.back().state.tip), 1e-13);

  EXPECT_FALSE(arm_path_rates(arm, std::vector<double>{1}, work).regular);
  EXPECT_FALSE(arm_path_rates(arm, std::vector<double>{1, std::nan("")}, work).regular);
  const Arm stranger = two_tendons(8, 0.3);
  EXPECT_FALSE(arm_path_rates(stranger, on, work).regular);
  ArmWorkspace straight(arm);
  arm_follow(arm, pulls({1}, TendonHeld::tension, 1), {}, straight);  // opposite ones pull alike
  EXPECT_NE(arm_path_rates(arm, on, straight).message.view().find("does not turn"), std::string_view::npos);
  ArmWorkspace loose(arm);
  arm_follow(arm, pulls({3}, TendonHeld::tension, 0), {}, loose);
  const ArmPathRates first = arm_path_rates(arm, std::vector<double>{0, 1}, loose);  // from no tension at all
  ASSERT_TRUE(first.regular);
  ArmWorkspace begun(arm);
  const auto from = arm_follow(arm, pulls({3}, TendonHeld::tension, 0), {.tolerance = 1e-13}, begun).back(),
             to = arm_follow(arm, pulls({3}, TendonHeld::tension, 1e-5), from_last, begun).back();
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR((to.state.tip.p[k] - from.state.tip.p[k]) / 1e-5, first.twist[static_cast<std::size_t>(k)],
                1e-3 * speed(first));
  EXPECT_NE(arm_path_rates(arm, std::vector<double>{0, -1}, loose).message.view().find("pull less"),
            std::string_view::npos);
}

/// Around a direction in which tendons move rates are linear in inputs and in a wrench: against the one-sided
/// rates of other directions, against the path, and where the same guides end to slip.
TEST(ArmFriction, RatesAreLinearAroundADirection) {
  for (const bool by_change : {false, true}) {
    SCOPED_TRACE(by_change);
    Arm arm = two_sections(4, 5e-5);
    for (ArmTendon& tendon : arm.tendons) tendon.friction = 0.2, tendon.outside = 0.3;
    const std::vector<double> start = by_change ? std::vector<double>{-4e-3, 1e-3, 2e-3, -3e-3, 1e-3, -1e-3}
                                                : std::vector<double>{4, 1, 0.5, 2, 0.7, 1.5},
                              way = by_change ? std::vector<double>{-1, 0.4, 0.3, -0.6, 0.2, -0.4}
                                              : std::vector<double>{1, -0.3, 0.2, 0.5, -0.2, 0.4};
    const auto commands = [&](double by, const std::vector<double>& along) {
      std::vector<double> values = start;
      for (std::size_t i = 0; i < 6; ++i) values[i] += by * along[i];
      return by_change ? changes(values) : tensions(values);
    };
    const ArmOptions options{.accuracy = 0, .tolerance = 1e-13},
        on{.accuracy = 0, .tolerance = 1e-13, .from_last = true};
    ArmStep first;
    first.commands = commands(0, way);
    first.load.wrench = {0.02, -0.01, 0, 0, 0, 0};
    first.divisions = 3;
    const auto follow_to = [&](double by, double pushed, ArmWorkspace& work) {
      auto points = arm_follow(arm, std::vector{first}, options, work);
      ArmStep next = first;
      next.divisions = 1;
      if (by != 0) {
        next.commands = commands(by, way);
        next.load.wrench[1] += pushed * by;
        next.load.wrench[2] -= 0.5 * pushed * by;
        points = arm_follow(arm, std::vector{next}, on, work);
      }
      EXPECT_TRUE(points.back().state.report.ok()) << to_string(points.back().state.report);
      return points.back().state;
    };
    ArmWorkspace work(arm);
    const ArmState here = follow_to(0, 0, work);
    const ArmPathRates rates = arm_path_rates(arm, way, work, true);
    ASSERT_TRUE(rates.regular) << rates.message.view();
    ASSERT_EQ(rates.J.size(), 36U);
    EXPECT_GT(rates.slipping, 10);
    const double speed = std::hypot(rates.twist[0], rates.twist[1], rates.twist[2]);
    const auto by_matrix = [&](const std::vector<double>& matrix, std::size_t line,
                               const std::vector<double>& of) {
      double sum = 0;
      for (std::size_t i = 0; i < of.size(); ++i) sum += matrix[line * of.size() + i] * of[i];
      return sum;
    };
    const auto off = [&](const std::vector<double>& along, const ArmPathRates& there) {
      double most = 0;
      for (std::size_t k = 0; k < 6; ++k) {
        most = std::max(most, std::abs(by_matrix(rates.J, k, along) - there.twist[k]) / speed);
        for (const auto& [matrix, values] : {std::pair(&rates.changes_by_inputs, &there.changes),
                                             std::pair(&rates.tensions_by_inputs, &there.tensions)}) {
          double size = 0;
          for (const double value : *values) size = std::max(size, std::abs(value));
          most = std::max(most, std::abs(by_matrix(*matrix, k, along) - (*values)[k]) / size);
        }
      }
      return most;
    };
    EXPECT_LT(off(way, rates), 1e-9);
    int ends = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_LE(rates.least[i], way[i]);
      EXPECT_GE(rates.most[i], way[i]);
      for (const double end : {rates.least[i], rates.most[i]}) {
        std::vector<double> inside = way, beyond = way;
        const bool is_open = std::isinf(end);
        inside[i] = is_open ? way[i] + std::copysign(5.0, end) : way[i] + 0.98 * (end - way[i]);
        EXPECT_LT(off(inside, arm_path_rates(arm, inside, work)), 1e-8) << i;
        if (is_open) continue;
        beyond[i] = way[i] + 1.2 * (end - way[i]) + std::copysign(0.02, end - way[i]);
        const ArmPathRates there = arm_path_rates(arm, beyond, work);
        if (!there.regular) continue;
        ++ends;
        EXPECT_GT(off(beyond, there), 1e-7) << i;
      }
    }
    EXPECT_GT(ends, 3);
    // inputs and a small wrench at once, along the path
    const double step = by_change ? 1e-6 : 1e-4, pushed = by_change ? 2 : 1e-3;
    ArmWorkspace one(arm), two(arm);
    const ArmState small = follow_to(step, pushed, one), large = follow_to(2 * step, pushed, two);
    const auto rate = [&](auto value) {
      return (4 * (value(small) - value(here)) - (value(large) - value(here))) / (2 * step);
    };
    const std::vector<double> wrench{0, pushed, -0.5 * pushed, 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(by_matrix(rates.J, k, way) + by_matrix(rates.compliance, k, wrench),
                  rate([&](const ArmState& state) { return state.tip.p[static_cast<int>(k)]; }),
                  1e-4 * speed);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(
          by_matrix(rates.tensions_by_inputs, i, way) + by_matrix(rates.tensions_by_wrench, i, wrench),
          rate([&](const ArmState& state) { return state.tensions[i]; }), by_change ? 0.2 : 1e-6);
      EXPECT_NEAR(by_matrix(rates.changes_by_inputs, i, way) + by_matrix(rates.changes_by_wrench, i, wrench),
                  rate([&](const ArmState& state) { return state.changes[i]; }), by_change ? 1e-9 : 1e-7);
    }
    double felt = 0;  // the wrench is not lost beside the inputs
    for (std::size_t k = 0; k < 3; ++k)
      felt = std::max(felt, std::abs(by_matrix(rates.compliance, k, wrench)));
    EXPECT_GT(felt, 1e-3 * speed);
  }
}

/// Without friction the matrices are those of arm_rates(), in every direction.
TEST(ArmFriction, WithoutFrictionMatricesAreThoseOfRates) {
  Arm arm = two_sections(3, 5e-5);
  for (ArmTendon& tendon : arm.tendons) tendon.outside = 0.3, tendon.pretension = 3;
  for (const bool by_change : {false, true}) {
    ArmStep step;
    step.commands =
        by_change ? changes({-6e-4, 2e-4, 3e-4, -5e-4, 3e-4, -1e-4}) : tensions({2, 1, 0.5, 1, 0.7, 1.5});
    const ArmOptions options{.order = 2, .elements = 3, .accuracy = 0, .tolerance = 1e-13};
    ArmWorkspace path(arm), work(arm);
    ASSERT_TRUE(arm_follow(arm, std::vector{step}, options, path).back().state.report.ok());
    const ArmPathRates found = arm_path_rates(arm, std::vector<double>(6, by_change ? -1e-3 : 1), path, true);
    ASSERT_TRUE(arm_forward(arm, step.commands, {}, options, work).report.ok());
    const ArmRates rates = arm_rates(arm, work, false);
    ASSERT_TRUE(found.regular && rates.regular);
    const auto near = [](const std::vector<double>& a, const std::vector<double>& b) {
      double size = 0, apart = 0;
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        size = std::max(size, std::abs(b[i]));
        apart = std::max(apart, std::abs(a[i] - b[i]));
      }
      EXPECT_LT(apart, 1e-7 * size);
    };
    near(found.J, rates.J);
    near(found.compliance, rates.compliance);
    near(by_change ? found.tensions_by_inputs : found.changes_by_inputs, rates.answers);
    near(by_change ? found.tensions_by_wrench : found.changes_by_wrench, rates.answers_by_wrench);
  }
}

}  // namespace arm_friction_test
}  // namespace sinew::test
