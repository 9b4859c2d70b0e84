// Derived values: read, put into queries, written, and what lies outside their limits left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "study/sweep/left_out.hpp"
#include "study/sweep/samples.hpp"
#include "study_support.hpp"

namespace derived_test {

using namespace sinew;
using test::bytes;
using test::column;
using test::Folder;
using test::study_of;
using test::sweep_to;

const std::string good = R"(sinew: 1
robot: 3-rfr
query: {query: inverse, pose: {x: $x, y: $y, phi: $s}}
axes:
  y: {from: -20 mm, to: 20 mm, count: 5}
  x: [0 mm, 5 mm, 7.5 mm]
)";
const std::string sum = "derived: {s: x + y}\n";

std::string code_of(const std::string& text) {
  const Folder folder;
  const auto study = study_of(folder, text);
  return study ? "" : study.error().front().code;
}

TEST(Derived, ArePolynomialsOfAxesAndOfThoseAbove) {
  const Folder folder;
  const auto study = study_of(folder, good + "derived: {s: 0.03 - x - y, t: s^2 + 2 x*y, u: 3}\n");
  ASSERT_TRUE(study) << to_string(study.error());
  std::vector<double> values(5 * 15);
  axis_values(*study, {0, 15}, false, values);
  for (std::size_t k = 0; k < 15; ++k) {
    const double y = values[k], x = values[15 + k], s = 0.03 - x - y;
    EXPECT_EQ(values[30 + k], s);
    EXPECT_EQ(values[45 + k], s * s + 2 * x * y);
    EXPECT_EQ(values[60 + k], 3);
  }
}

TEST(Derived, HaveTheUnitOfTheirAxesOrTheOneGiven) {
  const Folder folder;
  const auto study = study_of(folder, good + R"(derived:
  s: 0.01 - 2 x - y
  area: x*y
  angle: {is: 1e1 x, unit: rad, to: 10 deg}
  limited: {is: 4 x^2, from: 1 N}
  again: s + x
)");
  ASSERT_TRUE(study) << to_string(study.error());
  for (const auto& [name, unit] :
       {std::pair{"s", "m"}, {"area", ""}, {"angle", "rad"}, {"limited", "N"}, {"again", "m"}})
    EXPECT_EQ(study->column_unit(*study->find_variable(name)), unit) << name;
  EXPECT_NEAR(study->derived[2].high, 10 * std::acos(-1.0) / 180, 1e-15);
}

TEST(Derived, SayWhatIsWrong) {
  EXPECT_EQ(code_of(good + sum), "");
  EXPECT_EQ(code_of(good), "unknown_axis");
  for (const auto& [derived, code] : {std::pair{"{s: x + z}", "unknown_column"},
                                      {"{s: x + l}", "unknown_column"},  // an output is known only afterwards
                                      {"{s: x, x: y}", "duplicate_column"},
                                      {"{s: x, l: y}", "duplicate_column"},
                                      {"{s: x + s}", "later_column"},
                                      {"{s: x + t, t: y}", "later_column"},
                                      {"{s: x +}", "bad_term"},
                                      {"{s: {is: x + y, to: 1 deg}}", "wrong_dimension"},
                                      {"{s: {is: x*y, to: 1 mm}}", "wrong_dimension"},
                                      {"{s: {is: x, unit: mm}}", "unknown_unit"},
                                      {"{e3: x, s: 1e3 x}", "bad_term"},  // 1000 x, or e3 x
                                      {"{e3: x, s: 1e3}", "bad_term"},
                                      {"{s: (x)}", "bad_term"},
                                      {"{s: [x]}", "wrong_type"},
                                      {"{s: {from: 0}}", "missing_key"},
                                      {"{s: {is: x, from: 2 mm, to: 1 mm}}", "out_of_range"},
                                      {"{s: {is: x, from: 2 deg}}", "wrong_dimension"},
                                      {"{s: {is: x, unit: ells}}", "unknown_unit"},
                                      {"{s: {is: x, colour: red}}", "unknown_key"},
                                      {"{s: x, 1s: x}", "bad_name"},
                                      {"{s: x, status: x}", "bad_name"},
                                      {"[s]", "unknown_axis"}})
    EXPECT_EQ(code_of(good + "outputs: {l: \"inputs[0]\"}\nderived: " + derived + "\n"), code) << derived;
}

TEST(Derived, KnowTheirAxesWhenAReductionOrdersThem) {
  const Folder folder;
  const auto study = study_of(
      folder,
      good + "derived: {s: 2 x - y}\noutputs: {l: \"inputs[0]\"}\nreduce: {over: [y], columns: {p: part}}\n");
  ASSERT_TRUE(study) << to_string(study.error());
  ASSERT_EQ(study->axes[0].name, "x");
  std::vector<double> values(3 * 15);
  axis_values(*study, {0, 15}, false, values);
  for (std::size_t k = 0; k < 15; ++k) EXPECT_EQ(values[30 + k], 2 * values[k] - values[15 + k]);
}

TEST(Derived, AValueWithinRoundingOfALimitIsWithin) {
  const Folder folder;
  const auto study = study_of(folder, R"(sinew: 1
robot: 3pfs-g2
query: {query: forward, inputs: [$a, $b, $c]}
axes: {a: {from: 0.40, to: 0.46, count: 61, unit: m}, b: {from: 0.40, to: 0.46, count: 61, unit: m}}
derived: {c: {is: 1.29 - a - b, from: 0.40, to: 0.46}}
)");
  ASSERT_TRUE(study) << to_string(study.error());
  std::size_t kept = 0, expected = 0;
  std::vector<double> values(3);
  for (std::size_t k = 0; k < study->samples; ++k) {
    axis_values(*study, {k, 1}, false, values);
    kept += !is_left_out(*study, values);
    const std::size_t steps = k / 61 + k % 61;  // of 1 mm above 2 · 400 mm
    expected += steps >= 30 && steps <= 90;
  }
  EXPECT_EQ(kept, expected);
}

const std::string poses = R"(sinew: 1
robot: 3-rfr
query: {query: velocity, pose: {x: $x, y: $y, phi: $turn}}
axes:
  y: {from: -60 mm, to: 60 mm, count: 41}
  x: {from: -60 mm, to: 60 mm, count: 43}
  phi: {from: -60 deg, to: 60 deg, count: 31}
outputs: {condition: indices.condition_homogenised, determinant: determinant}
derived: {turn: {is: phi + x^2, unit: rad})";
const std::string disc = ", r2: {is: x^2 + y^2, to: 0.002}}\n";
const std::string rods = R"(sinew: 1
robot: 3pfs-g2
query: {query: forward, inputs: [$a, $b, $c]}
axes: {a: {from: 400 mm, to: 460 mm, count: 61}, b: {from: 400 mm, to: 460 mm, count: 59}}
derived: {c: {is: 1.29 - a - b, from: 0.40, to: 0.46}}
)";
const std::string queries = R"(sinew: 1
robot: 3-frr
query: {query: inverse, pose: {x: $x, y: $y, phi: $p}}
axes: {y: {from: -30 mm, to: 30 mm, count: 31}, x: {from: -30 mm, to: 30 mm, count: 33}}
derived: {p: {is: 2 x - 3 y, unit: rad, from: -0.05, to: 0.08}}
)";
const std::string at_random = R"(sinew: 1
robot: 3-rfr
random: {count: 3000, seed: 4}
query: {query: inverse, pose: {x: $x, y: $y, phi: $phi}}
axes: {x: {from: -30 mm, to: 30 mm}, y: {mean: 0 mm, deviation: 10 mm}, phi: {from: 0, to: 1}}
derived: {s: {is: x + y, from: 0 mm}}
)";

TEST(Derived, GiveTheSameBytesForAnyNumberOfThreads) {
  const Folder folder;
  for (const std::string& text :
       {poses + disc, rods, queries, at_random,
        poses + disc + "reduce: {over: [x], columns: {a: {mean: condition}, c: part}}\n"})
    for (const char* ending : {".h5", ".csv"}) {
      std::string first;
      for (const int threads : {1, 2, 5}) {
        const std::string name = "out" + std::to_string(threads) + ending;
        const auto done = sweep_to(folder, text, name, {.threads = threads});
        ASSERT_TRUE(done) << to_string(done.error());
        if (threads == 1) first = bytes(folder.path / name);
        EXPECT_EQ(bytes(folder.path / name), first) << threads;
      }
    }
}

/// Poses do not depend on their neighbours: what is kept has the numbers it has without limits, to the bit.
TEST(Derived, WhatIsKeptIsWhatItIsWithoutLimits) {
  const Folder folder;
  const auto limited = sweep_to(folder, poses + disc, "some.h5");
  ASSERT_TRUE(limited) << to_string(limited.error());
  ASSERT_TRUE(sweep_to(folder, poses + "}\n", "all.csv"));
  const auto some = read_result(folder.path / "some.h5"), all = read_result(folder.path / "all.csv");
  ASSERT_TRUE(some && all);
  EXPECT_EQ(column(*some, "r2").unit, "");
  EXPECT_EQ(column(*some, "turn").unit, "rad");
  std::size_t left_out_here = 0;
  for (std::size_t k = 0; k < all->row_count(); ++k) {
    const auto of = [&](const auto& table, const char* name) { return column(*table, name).values[k]; };
    const double x = of(some, "x"), y = of(some, "y");
    ASSERT_EQ(of(some, "r2"), x * x + y * y);
    ASSERT_EQ(of(some, "turn"), of(some, "phi") + x * x);
    const bool is_kept = x * x + y * y <= 0.002;
    left_out_here += !is_kept;
    ASSERT_EQ(of(some, "status"), is_kept ? of(all, "status") : left_out);
    for (const char* name : {"condition", "determinant"}) {
      const bool is_there = is_kept && std::isfinite(of(all, name));
      ASSERT_TRUE(is_there ? of(some, name) == of(all, name) : std::isnan(of(some, name))) << name << k;
    }
  }
  EXPECT_GT(left_out_here, 0U);
  EXPECT_EQ(limited->statuses[left_out], left_out_here);
  EXPECT_EQ(limited->sampler, "poses in lanes");
}

TEST(Derived, RodsOfAPlaneOfLengthsConverge) {
  const Folder folder;
  const auto done = sweep_to(folder, rods, "out.csv");
  ASSERT_TRUE(done) << to_string(done.error());
  EXPECT_EQ(done->sampler, "rods in lanes");
  EXPECT_GT(done->statuses[left_out], 0U);
  EXPECT_EQ(done->statuses[converged] + done->statuses[left_out], done->samples);
}

TEST(Derived, WhatIsLeftOutIsInNoReduction) {
  const Folder folder;
  const std::string reduce = "reduce: {over: [x, phi], columns: {reached: part, high: {max: condition}}}\n";
  ASSERT_TRUE(sweep_to(folder, poses + disc, "all.h5"));
  ASSERT_TRUE(sweep_to(folder, poses + disc + reduce, "few.h5"));
  const auto all = read_result(folder.path / "all.h5"), few = read_result(folder.path / "few.h5");
  ASSERT_TRUE(all && few);
  const std::size_t cell = 43U * 31;
  ASSERT_EQ(few->row_count(), 41U);
  for (std::size_t y = 0; y < 41; ++y) {
    double reached = 0, kept = 0;
    for (std::size_t k = y * cell; k < (y + 1) * cell; ++k) {
      reached += column(*all, "status").values[k] == converged;
      kept += column(*all, "status").values[k] != left_out;
    }
    const double part = column(*few, "reached").values[y];
    if (kept > 0)
      EXPECT_NEAR(part, reached / kept, 1e-15);
    else
      EXPECT_TRUE(std::isnan(part));
  }
  EXPECT_TRUE(std::isnan(column(*few, "reached").values[0]));
  EXPECT_GT(column(*few, "reached").values[20], 0);
}

TEST(Derived, OfAListOfSamples) {
  const Folder folder;
  std::ofstream(folder.path / "list.csv") << "x[mm],y[mm]\n1,2\n2,3\n3,4\n";
  const auto done =
      sweep_to(folder,
               "sinew: 1\nrobot: 3-rfr\nlisted: list.csv\nquery: {query: inverse, pose: {x: $x, y: $s, "
               "phi: 0}}\nderived: {s: {is: x + y, to: 6 mm}}\n",
               "out.csv");
  ASSERT_TRUE(done) << to_string(done.error());
  const auto table = read_result(folder.path / "out.csv");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->columns[2].heading(), "s[m]");
  EXPECT_NEAR(column(*table, "s").values[2], 0.007, 1e-17);
  EXPECT_EQ(column(*table, "status").values, (std::vector<double>{converged, converged, left_out}));
}

TEST(Derived, WhereEverySampleIsLeftOutItSaysSo) {
  const Folder folder;
  const auto done = sweep_to(folder, good + "derived: {s: {is: x + y, from: 1 m}}\n", "out.h5");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().front().code, "all_left_out");
}

/// A parameter of the robot may be one, and its trial is no sample that is left out.
TEST(Derived, StandInSet) {
  const Folder folder;
  const auto done = sweep_to(folder, R"(sinew: 1
robot: 3-rfr
query: {query: velocity, pose: {x: $x, y: 0, phi: 0}, set: {"legs[0].link.length": $l}}
axes: {x: {from: -300 mm, to: 10 mm, count: 32}}
derived: {l: {is: 0.2 + x, unit: m, from: 190 mm}}
outputs: {determinant: determinant}
)",
                             "out.csv");
  ASSERT_TRUE(done) << to_string(done.error());
  EXPECT_EQ(done->statuses[refused], 0U);
  EXPECT_EQ(done->statuses[converged], 3U);
}

}  // namespace derived_test
