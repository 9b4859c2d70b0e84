#include "robot/controller.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sinew/io/robot_file.hpp"
#include "sinew/kernel/controller.h"
#include "sinew/kernel/crc32.h"
#include "sinew/kernel/exact_table.h"
#include "sinew/kernel/polar.h"

namespace sinew {
namespace controller_test {

using kernel::Fixed;
using kernel::Stored;

/// What an exported header does: a kernel's table from a controller's.
template <class S>
typename Stored<S>::type stored(double value) {
  if constexpr (std::is_floating_point_v<S>)
    return static_cast<S>(value);
  else
    return static_cast<typename S::Raw>(fixed_point(value, S::fraction, S::bits));
}

template <class Table>
void fill_shares(Table& filled, const ControllerTable& table) {
  if constexpr (requires { filled.shares.share; })
    for (std::size_t m = 0; m < table.sections.size(); ++m) {
      using Share = typename std::remove_reference_t<decltype(filled.shares)>::Share;
      filled.shares.share[m] = stored<Share>(table.sections[m].share);
      filled.shares.inverse[m] = stored<Share>(1 / table.sections[m].share);
    }
}

template <std::size_t M, std::size_t n, class Format, bool Alike>
kernel::LinearTable<M, n, Format, Alike> linear(const ControllerTable& table) {
  kernel::LinearTable<M, n, Format, Alike> filled{};
  fill_shares(filled, table);
  for (std::size_t m = 0; m < M; ++m)
    for (std::size_t i = 0; i < n; ++i)
      for (const std::size_t axis : {0u, 1u}) {
        filled.rows[m][i][axis] = stored<typename Format::Row>(table.sections[m].rows[i][axis]);
        filled.back[m][i][axis] = stored<typename Format::Back>(table.sections[m].back[i][axis]);
      }
  return filled;
}

template <std::size_t M, std::size_t n, class Format, bool Alike, std::size_t Terms>
kernel::ExactTable<M, n, Format, Alike, Terms> exact(const ControllerTable& table) {
  kernel::ExactTable<M, n, Format, Alike, Terms> filled{};
  filled.linear = linear<M, n, Format, Alike>(table);
  for (std::size_t m = 0; m < M; ++m) {
    const ControllerSection& section = table.sections[m];
    auto& chords = filled.chords[Alike ? 0 : m];
    chords.backbone = section.backbone;
    chords.half_length = stored<typename Format::Half>(section.half_length);
    for (std::size_t k = 0; k < std::min(Terms, section.series.size()); ++k)
      chords.series[k] = stored<typename Format::Loss>(section.series[k]);
  }
  return filled;
}

template <class S>
double value(S number) {
  return static_cast<double>(number);
}

/// Bends within the limits, in steps of the format; at times all sections at their limits alike.
template <std::size_t M, class Angle>
void draw(const SerialRobot& robot, std::mt19937& random, kernel::Bend<Angle> (&bends)[M]) {
  std::uniform_real_distribution<double> share(-1, 1), turn(-3.1, 3.1);
  const bool is_extreme = random() % 16 == 0;
  const double x_share = share(random) < 0 ? -1 : 1, y_share = share(random) < 0 ? -1 : 1,
               direction = turn(random);
  for (std::size_t m = 0; m < M; ++m) {
    const double limit = robot.sections[m].limit * 0.999, x = limit * (is_extreme ? x_share : share(random)),
                 y = limit * (is_extreme ? y_share : share(random)),
                 phi = is_extreme ? direction : turn(random);
    bends[m] = robot.sections[m].is_twin()
                   ? kernel::Bend<Angle>{Angle(x), Angle(y)}
                   : kernel::Bend<Angle>{Angle(x * std::cos(phi)), Angle(x * std::sin(phi))};
  }
}

/// The changes in millimetres by the maps of the library.
template <std::size_t M, std::size_t n, class Angle>
void changes_of(const SerialRobot& robot, kernel::Model model, const kernel::Bend<Angle> (&bends)[M],
                double (&changes)[M][n]) {
  kernel::Pull<double> sum{0, 0, 0};
  for (std::size_t m = 0; m < M; ++m) {
    const Section& section = robot.sections[m];
    sum =
        sum + kernel::pull(model, section.map(), kernel::Bend<double>{value(bends[m].x), value(bends[m].y)});
    for (std::size_t i = 0; i < n; ++i)
      changes[m][i] = 1e3 * kernel::tendon_change(sum, section.direction(static_cast<int>(i)));
  }
}

template <class Table, std::size_t M, std::size_t n>
double worst(const Table& table, const SerialRobot& robot, kernel::Model model) {
  std::mt19937 random(7);
  double most = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    kernel::Bend<typename Table::Angle> bends[M];
    typename Table::Length changes[M][n];
    double expected[M][n];
    draw(robot, random, bends);
    table.changes(bends, changes);
    changes_of(robot, model, bends, expected);
    for (std::size_t m = 0; m < M; ++m)
      for (std::size_t i = 0; i < n; ++i)
        most = std::max(most, std::abs(value(changes[m][i]) - expected[m][i]));
  }
  return most;
}

SerialRobot prototype() { return load_serial("nottingham-tpcj").value(); }

/// Sections of two kinds, sizes and limits.
SerialRobot mixed() {
  SerialRobot robot = prototype();
  robot.sections.resize(3);
  robot.sections[1].tendon_radius *= 0.6;
  robot.sections[2].backbone = kernel::Backbone::neutral;
  robot.sections[2].tendon_radius *= 1.5;
  robot.sections[2].limit = 1.2;
  return robot;
}

using Short = kernel::ShortFormat<13, 8, 18>;
using Q15_16 = kernel::PlainFormat<Fixed<32, 16>>;
using Floats = kernel::PlainFormat<float>;

TEST(ControllerTable, ChoosesTheFormatsOfThePrototype) {
  const ControllerTable table = make_controller_table(prototype()).value();
  EXPECT_EQ(table.bits.angle, 13);
  EXPECT_EQ(table.bits.length, 8);
  EXPECT_EQ(table.bits.row, 11);
  EXPECT_EQ(table.bits.back, 18);
  EXPECT_TRUE(table.alike);
  EXPECT_EQ(table.sections[0].series.size(), 2u);
}

/// @verifies LSK (11)
TEST(ControllerTable, ChangesAreThoseOfLsk) {
  const SerialRobot robot = prototype();
  const ControllerTable table = make_controller_table(robot).value();
  EXPECT_LT((worst<kernel::LinearTable<5, 3, Short>, 5, 3>(linear<5, 3, Short, true>(table), robot,
                                                           kernel::Model::linear)),
            table.rounding());
  EXPECT_LT((worst<kernel::LinearTable<5, 3, Q15_16>, 5, 3>(linear<5, 3, Q15_16, true>(table), robot,
                                                            kernel::Model::linear)),
            5e-5);
  EXPECT_LT((worst<kernel::LinearTable<5, 3, Floats>, 5, 3>(linear<5, 3, Floats, true>(table), robot,
                                                            kernel::Model::linear)),
            1e-5);
}

/// @verifies LSK (2)
TEST(ControllerTable, ExactChangesAreThoseOfPcc) {
  const SerialRobot robot = prototype();
  const ControllerTable table = make_controller_table(robot).value();
  EXPECT_LT((worst<kernel::ExactTable<5, 3, Floats>, 5, 3>(exact<5, 3, Floats, true, 2>(table), robot,
                                                           kernel::Model::exact)),
            1.5e-5);
  EXPECT_LT((worst<kernel::ExactTable<5, 3, Q15_16>, 5, 3>(exact<5, 3, Q15_16, true, 2>(table), robot,
                                                           kernel::Model::exact)),
            8e-4);
  EXPECT_LT((worst<kernel::ExactTable<5, 3, Short>, 5, 3>(exact<5, 3, Short, true, 2>(table), robot,
                                                          kernel::Model::exact)),
            1.2e-2);
}

TEST(ControllerTable, SquaresOfLargeBendsFit) {
  const SerialRobot robot = load_serial("nottingham-neutral").value();
  const ControllerTable table = make_controller_table(robot).value();
  ASSERT_EQ(table.bits.angle, 10);
  ASSERT_EQ(table.bits.length, 7);
  ASSERT_EQ(table.bits.back, 16);
  using Format = kernel::ShortFormat<10, 7, 16>;
  const double off = worst<kernel::ExactTable<5, 3, Format>, 5, 3>(exact<5, 3, Format, true, 2>(table), robot,
                                                                   kernel::Model::exact);
  EXPECT_LT(off, 5e-2);
}

TEST(ControllerTable, SectionsMayDiffer) {
  const SerialRobot robot = mixed();
  const ControllerTable table = make_controller_table(robot).value();
  EXPECT_FALSE(table.alike);
  ASSERT_EQ(table.bits.angle, 14);
  ASSERT_EQ(table.bits.length, 9);
  ASSERT_EQ(table.bits.back, 18);
  using Format = kernel::ShortFormat<14, 9, 18>;
  EXPECT_LT((worst<kernel::LinearTable<3, 3, Format, false>, 3, 3>(linear<3, 3, Format, false>(table), robot,
                                                                   kernel::Model::linear)),
            table.rounding());
  EXPECT_LT((worst<kernel::ExactTable<3, 3, Floats, false, 3>, 3, 3>(exact<3, 3, Floats, false, 3>(table),
                                                                     robot, kernel::Model::exact)),
            1.5e-5);
}

template <std::size_t M, class Format, class Table>
void expect_bends_come_back(const SerialRobot& robot, const Table& table, double tolerance) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 500; ++trial) {
    kernel::Bend<typename Format::Angle> bends[M], found[M];
    typename Format::Length changes[M][3];
    draw(robot, random, bends);
    table.changes(bends, changes);
    table.bends(changes, found);
    for (std::size_t m = 0; m < M; ++m) {
      EXPECT_NEAR(value(found[m].x), value(bends[m].x), tolerance);
      EXPECT_NEAR(value(found[m].y), value(bends[m].y), tolerance);
    }
  }
}

/// @verifies LSK (10)
TEST(ControllerTable, BendsComeBack) {
  using Other = kernel::ShortFormat<14, 9, 18>;
  const ControllerTable one = make_controller_table(prototype()).value(),
                        other = make_controller_table(mixed()).value();
  // two roundings of a change: 3.9 um of 9.8 mm each
  expect_bends_come_back<5, Short>(prototype(), linear<5, 3, Short, true>(one), 8e-4);
  expect_bends_come_back<5, Q15_16>(prototype(), linear<5, 3, Q15_16, true>(one), 3e-4);
  expect_bends_come_back<5, Floats>(prototype(), linear<5, 3, Floats, true>(one), 2e-6);
  expect_bends_come_back<3, Other>(mixed(), linear<3, 3, Other, false>(other), 1.2e-3);
}

TEST(ControllerTable, BendsOfExactChangesComeBack) {
  using Other = kernel::ShortFormat<14, 9, 18>;
  using Round = kernel::ShortFormat<10, 7, 16>;
  const SerialRobot neutral = load_serial("nottingham-neutral").value();
  const ControllerTable one = make_controller_table(prototype()).value(),
                        other = make_controller_table(mixed()).value(),
                        round = make_controller_table(neutral).value();
  expect_bends_come_back<5, Short>(prototype(), exact<5, 3, Short, true, 2>(one), 1.2e-3);
  expect_bends_come_back<5, Q15_16>(prototype(), exact<5, 3, Q15_16, true, 2>(one), 4e-4);
  expect_bends_come_back<5, Floats>(prototype(), exact<5, 3, Floats, true, 2>(one), 3e-6);
  expect_bends_come_back<5, Round>(neutral, exact<5, 3, Round, true, 2>(round), 1.2e-2);
  expect_bends_come_back<5, Floats>(neutral, exact<5, 3, Floats, true, 2>(round), 2e-5);
  expect_bends_come_back<3, Other>(mixed(), exact<3, 3, Other, false, 3>(other), 2e-3);
  expect_bends_come_back<3, Floats>(mixed(), exact<3, 3, Floats, false, 3>(other), 5e-6);
}

TEST(ControllerTable, BendsOfLargeChordsComeBack) {
  SerialRobot robot = prototype();
  for (Section& section : robot.sections) section.limit = 1.9;
  const ControllerTable table = make_controller_table(robot).value();
  expect_bends_come_back<5, Floats>(robot, exact<5, 3, Floats, true, 9>(table), 5e-4);
}

TEST(ControllerTable, WhateverWasMeasuredSaturates) {
  const auto table = linear<5, 3, Short, true>(make_controller_table(prototype()).value());
  std::mt19937 random(5);
  std::uniform_int_distribution<int> any(-32768, 32767);
  for (int trial = 0; trial < 20000; ++trial) {
    Short::Length changes[5][3];
    for (auto& section : changes)
      for (auto& change : section)
        change = Short::Length::from_raw(static_cast<std::int16_t>(trial % 3         ? any(random)
                                                                   : any(random) < 0 ? -32768
                                                                                     : 32767));
    kernel::Bend<Short::Angle> bends[5];
    kernel::TendonState states[5][3];
    table.bends(changes, bends);
    table.states(changes, Short::Length::from_raw(13), states);
    double sum_x = 0;  // of doubles, cut off where integers end
    for (std::size_t m = 0; m < 5; ++m) {
      double x = 0;
      for (std::size_t i = 0; i < 3; ++i) x += table.back[m][i][0] / 262144.0 * value(changes[m][i]);
      x = std::clamp(x, -4.0, 4.0);
      EXPECT_NEAR(value(bends[m].x), std::clamp(x - sum_x, -4.0, 4.0), 3e-4);
      sum_x = x;
    }
  }
}

template <class Table>
void expect_states(const Table& table) {
  const SerialRobot robot = prototype();
  std::mt19937 random(11);
  kernel::Bend<Short::Angle> bends[5];
  Short::Length changes[5][3];
  kernel::TendonState states[5][3];
  for (int trial = 0; trial < 500; ++trial) {
    draw(robot, random, bends);
    table.changes(bends, changes);
    for (auto& change : changes[1]) change = change + Short::Length(0.08);
    for (auto& change : changes[3]) change = change - Short::Length(0.08);
    table.states(changes, Short::Length(0.05), states);
    for (std::size_t m = 0; m < 5; ++m)
      for (const kernel::TendonState state : states[m])
        EXPECT_EQ(state, m == 1   ? kernel::TendonState::slack
                         : m == 3 ? kernel::TendonState::over_tensioned
                                  : kernel::TendonState::exact);
  }
}

TEST(ControllerTable, TendonsAreSlackOrTooShortTogether) {
  const ControllerTable table = make_controller_table(prototype()).value();
  expect_states(linear<5, 3, Short, true>(table));
  expect_states(exact<5, 3, Short, true, 2>(table));
}

TEST(ControllerTable, TheLastTendonFollowsFromTheOthers) {
  const SerialRobot robot = prototype();
  const auto table = linear<5, 3, Short, true>(make_controller_table(robot).value());
  std::mt19937 random(13);
  for (int trial = 0; trial < 500; ++trial) {
    kernel::Bend<Short::Angle> bends[5];
    Short::Length changes[5][3], summed[5][3];
    draw(robot, random, bends);
    table.changes(bends, changes);
    table.changes_by_sum(bends, summed);
    for (std::size_t m = 0; m < 5; ++m) {
      EXPECT_EQ(summed[m][0].raw, changes[m][0].raw);
      EXPECT_EQ(summed[m][0].raw + summed[m][1].raw + summed[m][2].raw, 0);
      EXPECT_NEAR(summed[m][2].raw, changes[m][2].raw, 2);
    }
  }
}

TEST(ControllerTable, LimitsHold) {
  const kernel::BendLimits<2, Short::Angle> limits{{kernel::Backbone::twin_pivot, kernel::Backbone::neutral},
                                                   {3431, 3431}};
  const auto hold = [&](int x0, int y0, int x1, int y1) {
    const auto angle = [](int raw) { return Short::Angle::from_raw(static_cast<std::int16_t>(raw)); };
    const kernel::Bend<Short::Angle> bends[2]{{angle(x0), angle(y0)}, {angle(x1), angle(y1)}};
    return limits.hold(bends);
  };
  EXPECT_TRUE(hold(3431, -3431, 0, 3431));
  EXPECT_FALSE(hold(3432, 0, 0, 0));
  EXPECT_FALSE(hold(0, -32768, 0, 0));
  EXPECT_TRUE(hold(0, 0, 2426, 2426));
  EXPECT_FALSE(hold(0, 0, 2427, 2427));
  EXPECT_FALSE(hold(0, 0, -32768, -32768));
}

TEST(ControllerTable, CountsOfMotorsComeBack) {
  const kernel::MotorCounts<Short::Length> motor{17 * 65536 + 20000};
  for (int raw = -32768; raw <= 32767; raw += 7) {
    const auto change = Short::Length::from_raw(static_cast<std::int16_t>(raw));
    EXPECT_NEAR(motor.of(change), raw * (17 + 20000 / 65536.0), 0.5);
    EXPECT_EQ(motor.change(motor.of(change)).raw, raw);
  }
  EXPECT_EQ(motor.change(2147483647).raw, 32767);
  EXPECT_EQ(motor.change(-2147483647 - 1).raw, -32768);
}

TEST(ControllerTable, WhatTendonsHaveInCommonFits) {
  SerialRobot robot = prototype();
  for (Section& section : robot.sections)
    section.joint = 0.1, section.limit = 1.5;  // long joints, thin robot
  const ControllerTable table = make_controller_table(robot).value();
  ASSERT_EQ(table.bits.angle, 12);
  ASSERT_EQ(table.bits.length, 6);
  using Format = kernel::ShortFormat<12, 6, 18>;
  ASSERT_EQ(table.bits.back, 18);
  const double off = worst<kernel::ExactTable<5, 3, Format, true, 6>, 5, 3>(
      exact<5, 3, Format, true, 6>(table), robot, kernel::Model::exact);
  EXPECT_LT(off, 0.25);
}

/// What running sums of integers come to at the limits, in the robot where their roundings add up.
TEST(ControllerTable, SumsAtTheLimitsDoNotWrap) {
  SerialRobot robot = load_serial("nottingham-neutral").value();
  robot.sections.resize(3);
  for (std::size_t m = 0; m < 3; ++m) {
    robot.sections[m].segments = 4;
    robot.sections[m].disc_radius = 5e-3;
    robot.sections[m].tendon_radius = m == 0 ? 4e-3 : 1.00025e-3;
    robot.sections[m].limit = m == 0 ? 2.045654298 : 3.906616212;
  }
  const ControllerTable table = make_controller_table(robot).value();
  std::int64_t sum = 0;
  for (const ControllerSection& section : table.sections)
    sum += (table.short_limit(section) * fixed_point(section.share, ShortBits::share) + 4096) >>
           ShortBits::share;
  EXPECT_LE(sum, 32767);
}

TEST(ControllerTable, LongSectionsHaveExactChangesToo) {
  SerialRobot robot = load_serial("nottingham-neutral").value();
  robot.sections.resize(1);
  robot.sections[0].joint = 0.125;
  robot.sections[0].tendon_radius = 2e-3;
  robot.sections[0].limit = 0.2;
  const ControllerTable table = make_controller_table(robot).value();
  ASSERT_EQ(table.bits.angle, 15);
  ASSERT_EQ(table.bits.length, 13);
  ASSERT_EQ(table.bits.half, 6);
  using Format = kernel::ShortFormat<15, 13, 15, kernel::Native, 6>;
  const double off = worst<kernel::ExactTable<1, 3, Format>, 1, 3>(exact<1, 3, Format, true, 2>(table), robot,
                                                                   kernel::Model::exact);
  EXPECT_LT(off, 0.05);  // 500 mm times a step of the loss, 0.00003
}

TEST(ControllerTable, ExactTendonsAreExactWithoutATolerance) {
  SerialRobot robot = prototype();
  robot.tolerance = 0;
  const ControllerTable constants = make_controller_table(robot).value();
  const auto table = linear<5, 3, Short, true>(constants);
  const auto tolerance = Short::Length::from_raw(static_cast<std::int16_t>(constants.short_tolerance()));
  std::mt19937 random(17);
  for (int trial = 0; trial < 2000; ++trial) {
    kernel::Bend<Short::Angle> bends[5];
    Short::Length changes[5][3];
    kernel::TendonState states[5][3];
    draw(robot, random, bends);
    table.changes(bends, changes);
    table.states(changes, tolerance, states);
    for (const auto& section : states)
      for (const kernel::TendonState state : section) EXPECT_EQ(state, kernel::TendonState::exact);
  }
}

TEST(ControllerTable, HashIsOfTheModelToo) {
  const ControllerTable linear = make_controller_table(prototype()).value(),
                        exact = make_controller_table(prototype(), kernel::Model::exact).value();
  EXPECT_EQ(linear.hash(), 0x90d7d214u);
  EXPECT_NE(exact.hash(), linear.hash());
}

TEST(ControllerTable, SaysWhyThereIsNone) {
  const auto code = [](SerialRobot robot) { return make_controller_table(robot).error().at(0).code; };
  SerialRobot robot = prototype();
  robot.sections[2].limit = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code(robot), "no_limit");
  robot = prototype();
  robot.sections[1].tendons = 4;
  EXPECT_EQ(code(robot), "unlike_tendons");
  robot = prototype();
  robot.sections[1].tendon_radius /= 5;
  EXPECT_EQ(code(robot), "unlike_gains");
  robot = prototype();
  robot.sections[0].backbone = kernel::Backbone::neutral;
  robot.sections[0].max_extension = 1e-3;
  EXPECT_EQ(code(robot), "extensible");
  robot = prototype();
  robot.motor = TendonMotor{1e-9, 1e9, 1};
  EXPECT_EQ(code(robot), "out_of_range");
  robot = prototype();
  for (Section& section : robot.sections) section.tendon_radius *= 1e6;
  EXPECT_EQ(code(robot), "out_of_range");
}

TEST(Crc32, IsZlibs) {
  kernel::Crc32 crc;
  crc.add_text(std::string_view("123456789"));
  EXPECT_EQ(crc.value(), 0xCBF43926u);
}

TEST(PolarBend, IsOfTheAngleAndItsDirection) {
  for (double phi = -3.14; phi < 3.14; phi += 0.01) {
    const auto bend = kernel::polar_bend(Fixed<32, 16>(0.4), Fixed<32, 16>(phi));
    EXPECT_NEAR(value(bend.x), 0.4 * std::cos(phi), 6e-5);
    EXPECT_NEAR(value(bend.y), 0.4 * std::sin(phi), 6e-5);
    const auto coarse = kernel::polar_bend(Fixed<16, 12>(0.4), Fixed<16, 12>(phi));
    EXPECT_NEAR(value(coarse.x), 0.4 * std::cos(phi), 1e-3);
    EXPECT_NEAR(value(coarse.y), 0.4 * std::sin(phi), 1e-3);
    EXPECT_NEAR(value(kernel::polar_bend(0.4f, static_cast<float>(phi)).y), 0.4 * std::sin(phi), 1e-7);
  }
}

}  // namespace controller_test
}  // namespace sinew
