// Sweeps: the same data whoever computes them, and however often they are interrupted.
#include "sinew/study/sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "study_support.hpp"

namespace sweep_test {

using namespace sinew;
using test::bytes;
using test::column;
using test::Folder;
using test::sweep_to;

const std::string poses = R"(sinew: 1
title: poses
robot: 3-rfr
query: {query: velocity, pose: {x: $x, y: $y, phi: $phi}}
axes:
  y: {from: -60 mm, to: 60 mm, count: 41}
  x: {from: -60 mm, to: 60 mm, count: 43}
  phi: {from: -60 deg, to: 60 deg, count: 31}
outputs: {condition: indices.condition_homogenised, determinant: determinant}
)";
const std::string rods = R"(sinew: 1
robot: 3pfs-g2
query: {query: forward, inputs: [$a, $b, $c]}
axes:
  a: {from: 400 mm, to: 460 mm, count: 27}
  b: {from: 400 mm, to: 460 mm, count: 29}
  c: {from: 400 mm, to: 460 mm, count: 31}
)";
const std::string queries = R"(sinew: 1
robot: 3-frr
query: {query: inverse, pose: {x: $x, y: $y, phi: 0.1}}
axes:
  y: {from: -30 mm, to: 30 mm, count: 31}
  x: {from: -30 mm, to: 30 mm, count: 33}
)";
const std::string at_random = R"(sinew: 1
robot: 3-rfr
random: {count: 3000, seed: 4}
query: {query: inverse, pose: {x: $x, y: $y, phi: $phi}}
axes: {x: {from: -30 mm, to: 30 mm}, y: {mean: 0 mm, deviation: 10 mm}, phi: {from: 0, to: 1}}
)";

TEST(Sweep, GivesTheSameBytesForAnyNumberOfThreads) {
  const Folder folder;
  for (const std::string& text : {poses, rods, queries, at_random,
                                  poses + "reduce: {over: [x], columns: {a: {mean: condition}, b: {max: "
                                          "determinant}, c: part, d: {rms: condition}}}\n"})
    for (const char* ending : {".h5", ".csv"}) {
      std::string first;
      for (const int threads : {1, 2, 5}) {
        const std::string name = "out" + std::to_string(threads) + ending;
        const auto done = sweep_to(folder, text, name, {.threads = threads});
        ASSERT_TRUE(done) << to_string(done.error());
        EXPECT_TRUE(done->is_complete);
        EXPECT_FALSE(std::filesystem::exists(folder.path / (name + ".log")));
        if (threads == 1) first = bytes(folder.path / name);
        EXPECT_EQ(bytes(folder.path / name), first) << threads;
      }
    }
}

/// Whatever a thread computed before, a chunk is computed alike: also behind samples that have no solution.
/// Each word's samples are those of the study that has it written out.
TEST(Sweep, WordsGoIntoTheQuery) {
  const Folder folder;
  const auto text = [](const std::string& model, const std::string& axis) {
    return "sinew: 1\nrobot: two-segment\nquery: {query: forward, model: " + model +
           ", tensions: [[$t, 0, 0], [0, 1, 0]]}\naxes:\n" + axis +
           "  t: [1 N, 2 N, 3 N]\npath: anew\noutputs:\n  x: tip.position[0]\n  z: tip.position[2]\n";
  };
  const auto all = sweep_to(folder, text("$m", "  m: [rod, cc, prb]\n"), "all.csv");
  ASSERT_TRUE(all) << to_string(all.error());
  EXPECT_NE(bytes(folder.path / "all.csv").find("# m: 0 rod, 1 cc, 2 prb\n"), std::string::npos);
  const Table together = read_csv(folder.path / "all.csv").value();
  for (const std::size_t m : {0U, 1U, 2U}) {
    const char* names[] = {"rod", "cc", "prb"};
    ASSERT_TRUE(sweep_to(folder, text(names[m], ""), std::string(names[m]) + ".csv"));
    const Table one = read_csv(folder.path / (std::string(names[m]) + ".csv")).value();
    for (std::size_t k = 0; k < 3; ++k)
      for (const char* name : {"x", "z"})
        EXPECT_EQ(together.find(name)->values[3 * m + k], one.find(name)->values[k]) << names[m];
  }
}

TEST(Sweep, NoChunkShowsWhatWasComputedBefore) {
  const Folder folder;
  for (const std::string& text :
       {std::string("sinew: 1\nrobot: 3pfs-g2\nquery: {query: forward, inputs: [$a, $b, $c]}\naxes:\n"
                    "  a: {from: 300 mm, to: 700 mm, count: 14}\n  b: {from: 300 mm, to: 700 mm, count: 15}\n"
                    "  c: {from: 300 mm, to: 700 mm, count: 41}\n"),
        std::string("sinew: 1\nrobot: 3pfs-g1\nquery: {query: forward, inputs: [$a, $b, $c]}\naxes:\n"
                    "  a: {from: 150 mm, to: 300 mm, count: 14}\n  b: {from: 150 mm, to: 300 mm, count: 15}\n"
                    "  c: {from: 150 mm, to: 300 mm, count: 21}\n"),
        std::string(
            "sinew: 1\nrobot: hexapod\nquery: {query: forward, inputs: [$a, 0.4, $b, 0.4, 0.4, 0.4]}\naxes:\n"
            "  a: {from: 330 mm, to: 470 mm, count: 20}\n  b: {from: 330 mm, to: 470 mm, count: 21}\n")}) {
    std::string first;
    for (const int threads : {1, 2, 3, 1}) {
      const auto done = sweep_to(folder, text, "out.h5", {.threads = threads});
      ASSERT_TRUE(done) << to_string(done.error());
      const std::string now = bytes(folder.path / "out.h5");
      if (first.empty()) first = now;
      EXPECT_TRUE(now == first) << threads << " threads, " << text;
    }
  }
}

TEST(Sweep, SmallQuantitiesAreFittedToo) {
  const Folder folder;
  const auto done = sweep_to(
      folder, queries + "outputs: {l0: \"inputs[0]\"}\nfits: {l0: {terms: [1, x, x^6]}}\n", "out.h5");
  ASSERT_TRUE(done) << to_string(done.error());
  for (const double coefficient : done->fits[0].coefficients) EXPECT_TRUE(std::isfinite(coefficient));
  EXPECT_GE(done->fits[0].largest, done->fits[0].rms);
}

TEST(Sweep, StoppedAgainAndAgainGivesTheSameBytes) {
  const Folder folder;
  for (const std::string& text : {rods, queries}) {
    ASSERT_TRUE(sweep_to(folder, text, "whole.h5"));
    int runs = 0;
    for (bool is_complete = false; !is_complete; ++runs) {
      ASSERT_LT(runs, 200);
      int ticks = 0;
      const auto done = sweep_to(folder, text, "parts.h5",
                                 {.resume = true, .threads = 2, .progress = [&](const SweepProgress& now) {
                                    EXPECT_LE(now.done, now.total);
                                    return runs > 20 || ticks++ > 0 || now.resumed > now.total / 2;
                                  }});
      ASSERT_TRUE(done) << to_string(done.error());
      is_complete = done->is_complete;
    }
    EXPECT_EQ(bytes(folder.path / "parts.h5"), bytes(folder.path / "whole.h5"));
    const auto again = sweep_to(folder, text, "parts.h5", {.resume = true});
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->was_complete);
    std::filesystem::remove(folder.path / "parts.h5");
  }
}

/// Take long enough to be stopped.
const std::string many_queries = R"(sinew: 1
robot: 3-rfr
query: {query: forward, inputs: [$a, $b, 0.2]}
axes:
  a: {from: 195 mm, to: 205 mm, count: 121}
  b: {from: 195 mm, to: 205 mm, count: 123}
)";
const std::string many_at_random = R"(sinew: 1
robot: 3-rfr
query: {query: forward, inputs: [$a, $b, $c]}
random: {count: 15000, seed: 3}
axes:
  a: {from: 195 mm, to: 205 mm}
  b: {from: 195 mm, to: 205 mm}
derived: {c: "0.5 a + 0.5 b"}
)";

/// A sweep stopped somewhere, with the file that its rows are in.
void stop_midway(const Folder& folder, const std::string& text) {
  const auto goes_on = [](const SweepProgress& now) { return now.done < now.total / 5; };
  for (int attempt = 0; attempt < 20; ++attempt) {
    const auto done = sweep_to(folder, text, "parts.h5", {.resume = true, .threads = 1, .progress = goes_on});
    ASSERT_TRUE(done) << to_string(done.error());
    if (!done->is_complete) return;
    std::filesystem::remove(folder.path / "parts.h5");
  }
  GTEST_SKIP() << "too quick to be stopped";
}

/// A machine that lost power has the log's last records, and not all of what they speak of.
TEST(Sweep, WhatIsNoLongerInTheFileIsComputedAgain) {
  const Folder folder;
  for (const std::string& text : {many_queries, many_at_random}) {
    ASSERT_TRUE(sweep_to(folder, text, "whole.h5"));
    const std::string whole = bytes(folder.path / "whole.h5");
    for (const double part : {0.1, 0.6}) {
      stop_midway(folder, text);
      if (testing::Test::IsSkipped()) return;
      std::string file = bytes(folder.path / "parts.h5.part");
      ASSERT_EQ(file.size(), whole.size());
      const auto at = static_cast<std::size_t>(part * static_cast<double>(file.size()));
      std::fill_n(file.begin() + static_cast<std::ptrdiff_t>(at), 5000, '\0');
      std::ofstream(folder.path / "parts.h5.part", std::ios::binary) << file;
      ASSERT_TRUE(sweep_to(folder, text, "parts.h5", {.resume = true}));
      EXPECT_TRUE(bytes(folder.path / "parts.h5") == whole) << part;
      std::filesystem::remove(folder.path / "parts.h5");
    }
  }
}

TEST(Sweep, BeginsAnewWhereTheFileIsGoneOrNone) {
  const Folder folder;
  ASSERT_TRUE(sweep_to(folder, many_queries, "whole.h5"));
  for (const bool is_gone : {true, false}) {
    stop_midway(folder, many_queries);
    if (testing::Test::IsSkipped()) return;
    if (is_gone)
      std::filesystem::remove(folder.path / "parts.h5.part");
    else
      std::ofstream(folder.path / "parts.h5.part") << "no HDF5";
    const auto done = sweep_to(folder, many_queries, "parts.h5", {.resume = true});
    ASSERT_TRUE(done) << to_string(done.error());
    EXPECT_EQ(done->resumed, 0U);
    EXPECT_EQ(bytes(folder.path / "parts.h5"), bytes(folder.path / "whole.h5"));
    std::filesystem::remove(folder.path / "parts.h5");
  }
}

TEST(Sweep, GoesOnAsItWasBegun) {
  const Folder folder;
  stop_midway(folder, many_queries);
  if (testing::Test::IsSkipped()) return;
  const auto other = sweep_to(folder, many_queries, "parts.h5", {.resume = true, .compression = 4});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().front().code, "other_options");
  // killed between giving the file its name and removing the log
  const std::string log = bytes(folder.path / "parts.h5.log");
  ASSERT_TRUE(sweep_to(folder, many_queries, "parts.h5", {.resume = true}));
  std::ofstream(folder.path / "parts.h5.log", std::ios::binary) << log;
  const auto again = sweep_to(folder, many_queries, "parts.h5", {.resume = true});
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(again->was_complete);
  EXPECT_FALSE(std::filesystem::exists(folder.path / "parts.h5.log"));
}

TEST(Sweep, HasEveryColumnWithItsUnitInBothFormats) {
  const Folder folder;
  ASSERT_TRUE(sweep_to(folder, poses, "out.h5"));
  ASSERT_TRUE(sweep_to(folder, poses, "out.csv"));
  const auto h5 = read_result(folder.path / "out.h5"), csv = read_result(folder.path / "out.csv");
  ASSERT_TRUE(h5) << to_string(h5.error());
  ASSERT_TRUE(csv) << to_string(csv.error());
  ASSERT_EQ(h5->columns.size(), csv->columns.size());
  for (std::size_t c = 0; c < h5->columns.size(); ++c) {
    const Column &one = h5->columns[c], &other = csv->columns[c];
    EXPECT_EQ(one.heading(), other.heading());
    ASSERT_EQ(one.values.size(), 41U * 43 * 31);
    for (std::size_t k = 0; k < one.values.size(); ++k)
      ASSERT_TRUE(one.values[k] == other.values[k] ||
                  (std::isnan(one.values[k]) && std::isnan(other.values[k])))
          << one.name << k;
  }
  EXPECT_EQ(h5->columns[0].heading(), "y[m]");
  EXPECT_EQ(h5->columns[2].heading(), "phi[rad]");
  EXPECT_EQ(h5->columns.back().name, "status");
}

TEST(Sweep, CompressedHoldsTheSameNumbers) {
  const Folder folder;
  ASSERT_TRUE(sweep_to(folder, poses, "plain.h5"));
  ASSERT_TRUE(sweep_to(folder, poses, "small.h5", {.compression = 6}));
  EXPECT_LT(std::filesystem::file_size(folder.path / "small.h5"),
            std::filesystem::file_size(folder.path / "plain.h5") / 2);
  const auto plain = read_result(folder.path / "plain.h5"), small = read_result(folder.path / "small.h5");
  ASSERT_TRUE(plain && small);
  EXPECT_EQ(to_csv(*plain), to_csv(*small));
}

TEST(Sweep, ReductionsAreThoseOfItsSamples) {
  const Folder folder;
  ASSERT_TRUE(sweep_to(folder, poses, "all.h5"));
  const std::string reduce =
      "reduce: {over: [y, phi], columns: {low: {min: condition}, high: {max: condition}, middle: {mean: "
      "determinant}, size: {rms: determinant}, reached: part}}\n";
  ASSERT_TRUE(sweep_to(folder, poses + reduce, "few.h5"));
  const auto all = read_result(folder.path / "all.h5"), few = read_result(folder.path / "few.h5");
  ASSERT_TRUE(all && few);
  ASSERT_EQ(few->row_count(), 43U);
  for (std::size_t cell = 0; cell < 43; ++cell) {
    double low = 1e300, high = -1e300, sum = 0, squares = 0, count = 0, reached = 0, samples = 0;
    for (std::size_t k = 0; k < all->row_count(); ++k) {
      if (column(*all, "x").values[k] != column(*few, "x").values[cell]) continue;
      ++samples;
      reached += column(*all, "status").values[k] == 7;
      const double condition = column(*all, "condition").values[k],
                   determinant = column(*all, "determinant").values[k];
      if (column(*all, "status").values[k] != 7) continue;
      if (std::isfinite(condition)) {
        low = std::min(low, condition);
        high = std::max(high, condition);
      }
      if (!std::isfinite(determinant)) continue;
      ++count;
      sum += determinant;
      squares += determinant * determinant;
    }
    EXPECT_EQ(column(*few, "low").values[cell], low);
    EXPECT_EQ(column(*few, "high").values[cell], high);
    EXPECT_NEAR(column(*few, "middle").values[cell], sum / count, 1e-12 * std::abs(sum / count) + 1e-18);
    EXPECT_NEAR(column(*few, "size").values[cell], std::sqrt(squares / count),
                1e-12 * std::sqrt(squares / count));
    EXPECT_NEAR(column(*few, "reached").values[cell], reached / samples, 1e-15);
  }
}

TEST(Sweep, ACellLargerThanAChunkIsAddedUp) {
  const Folder folder;
  const std::string reduce =
      "reduce: {over: [y, x, phi], columns: {high: {max: condition}, middle: {mean: determinant}, reached: "
      "part}}\n";
  ASSERT_TRUE(sweep_to(folder, poses + reduce, "one.csv"));
  ASSERT_TRUE(sweep_to(folder, poses, "all.h5"));
  const auto one = read_result(folder.path / "one.csv"), all = read_result(folder.path / "all.h5");
  ASSERT_TRUE(one && all) << to_string(one.error());
  ASSERT_EQ(one->row_count(), 1U);
  double high = 0, sum = 0, count = 0;
  for (std::size_t k = 0; k < all->row_count(); ++k) {
    const double condition = column(*all, "condition").values[k],
                 determinant = column(*all, "determinant").values[k];
    if (column(*all, "status").values[k] != 7) continue;
    if (std::isfinite(condition)) high = std::max(high, condition);
    if (std::isfinite(determinant)) sum += determinant, ++count;
  }
  EXPECT_EQ(column(*one, "high").values[0], high);
  EXPECT_NEAR(column(*one, "middle").values[0], sum / count, 1e-12 * std::abs(sum / count));
}

TEST(Sweep, FitsAreLeastSquares) {
  const Folder folder;
  const auto done = sweep_to(folder, queries + R"(outputs: {l0: "inputs[0]", l1: "inputs[1]"}
fits:
  exact: {of: l0, terms: [l0, 1]}
  plane: {of: l1, terms: [x, y, 1]}
  double: {of: l1, terms: [x, 2 x]}
)",
                             "out.h5");
  ASSERT_TRUE(done) << to_string(done.error());
  ASSERT_EQ(done->fits.size(), 3U);
  EXPECT_NEAR(done->fits[0].coefficients[0], 1, 1e-12);
  EXPECT_NEAR(done->fits[0].coefficients[1], 0, 1e-13);
  EXPECT_LT(done->fits[0].largest, 1e-14);
  EXPECT_TRUE(std::isnan(done->fits[2].coefficients[0]));  // not determined

  const auto table = read_result(folder.path / "out.h5");
  ASSERT_TRUE(table);
  // normal equations of the plane, on a grid that is symmetric about 0: they decouple
  double xx = 0, xl = 0, yy = 0, yl = 0, l = 0;
  const auto n = static_cast<double>(table->row_count());
  for (std::size_t k = 0; k < table->row_count(); ++k) {
    const double x = column(*table, "x").values[k], y = column(*table, "y").values[k],
                 v = column(*table, "l1").values[k];
    xx += x * x, xl += x * v, yy += y * y, yl += y * v, l += v / n;
  }
  const FittedTerms& plane = done->fits[1];
  EXPECT_NEAR(plane.coefficients[0], xl / xx, 1e-11);
  EXPECT_NEAR(plane.coefficients[1], yl / yy, 1e-11);
  EXPECT_NEAR(plane.coefficients[2], l, 1e-12);
  double squares = 0, largest = 0;
  for (std::size_t k = 0; k < table->row_count(); ++k) {
    const double left = column(*table, "l1").values[k] -
                        plane.coefficients[0] * column(*table, "x").values[k] -
                        plane.coefficients[1] * column(*table, "y").values[k] - plane.coefficients[2];
    squares += left * left;
    largest = std::max(largest, std::abs(left));
  }
  EXPECT_NEAR(plane.rms, std::sqrt(squares / n), 1e-12);
  EXPECT_NEAR(plane.largest, largest, 1e-14);
  EXPECT_NEAR(plane.deviations[0], std::sqrt(squares / (n - 3) / xx), 1e-10);
  EXPECT_EQ(plane.unit, "m");
}

TEST(Sweep, ALogOfAnotherSweepIsNotTouched) {
  const Folder folder;
  const auto stop = [](const SweepProgress&) { return false; };
  const auto first = sweep_to(folder, rods, "out.h5", {.threads = 1, .progress = stop});
  ASSERT_TRUE(first);
  if (first->is_complete) GTEST_SKIP() << "too quick to be stopped";
  const auto other = sweep_to(folder, poses, "out.h5", {.resume = true});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().front().code, "other_sweep");
}

TEST(Sweep, WhereTheFileCannotBeWrittenItSaysSo) {
  const Folder folder;
  for (const auto& [name, code] : {std::pair{"out.txt", "unknown_format"}, {"out", "unknown_format"}}) {
    const auto done = sweep_to(folder, queries, name);
    ASSERT_FALSE(done) << name;
    EXPECT_EQ(done.error().front().code, code);
  }
  std::filesystem::create_directory(folder.path / "out.h5");
  const auto done = sweep_to(folder, queries, "out.h5");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().front().code, "file_unwritable");
  EXPECT_FALSE(std::filesystem::exists(folder.path / "out.h5.log"));
}

TEST(ReadResult, SaysWhatItCannotRead) {
  const Folder folder;
  std::ofstream(folder.path / "text.h5") << "no HDF5";
  EXPECT_EQ(read_result(folder.path / "text.h5").error().front().code, "file_unreadable");
  EXPECT_EQ(read_result(folder.path / "none.h5").error().front().code, "file_missing");
}

}  // namespace sweep_test
