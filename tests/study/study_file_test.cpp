// What a study file says, and every way it can be wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "study/sweep/samples.hpp"
#include "study/sweep/terms.hpp"
#include "study_support.hpp"

namespace study_file_test {

using namespace sinew;
using test::Folder;
using test::study_of;

const std::string good = R"(sinew: 1
robot: 3-rfr
query: {query: inverse, pose: {x: $x, y: $y, phi: 0}}
axes:
  y: {from: -20 mm, to: 20 mm, count: 5}
  x: [0 mm, 5 mm, 7.5 mm]
)";

/// The text with a part replaced.
std::string with_part(std::string text, const std::string& part, const std::string& other) {
  return text.replace(text.find(part), part.size(), other);
}

std::string code_of(const std::string& text) {
  const Folder folder;
  const auto study = study_of(folder, text);
  return study ? "" : study.error().front().code;
}

TEST(StudyFile, AxesHaveUnitsAndTheLastRunsFastest) {
  const Folder folder;
  const auto study = study_of(folder, good);
  ASSERT_TRUE(study) << to_string(study.error());
  EXPECT_EQ(study->samples, 15U);
  EXPECT_EQ(study->axes[0].unit, "m");
  for (std::size_t k = 0; k < 5; ++k)
    EXPECT_NEAR(study->axes[0].values[k], -0.02 + 0.01 * static_cast<double>(k), 1e-17);
  EXPECT_EQ(study->axes[0].values[2], 0);  // exactly, as the ends are
  std::vector<double> values(2 * 15);
  axis_values(*study, {0, 15}, false, values);
  EXPECT_EQ(values[15 + 1], 0.005);
  EXPECT_EQ(values[3], study->axes[0].values[1]);
}

TEST(StudyFile, BareNumbersTakeTheUnitOfTheirAxis) {
  const Folder folder;
  const auto study =
      study_of(folder, with_part(good, "[0 mm, 5 mm, 7.5 mm]", "{from: 0, to: 10, count: 3, unit: mm}"));
  ASSERT_TRUE(study) << to_string(study.error());
  EXPECT_EQ(study->axes[1].values, (std::vector<double>{0, 0.005, 0.01}));
  EXPECT_EQ(study->axes[1].unit, "m");
}

TEST(StudyFile, WordsAreNumbered) {
  const Folder folder;
  const std::string words = with_part(with_part(good, "x: $x", "x: 0"), "phi: 0}", "phi: 0}, model: $m");
  const auto study = study_of(folder, with_part(words, "x: [0 mm, 5 mm, 7.5 mm]", "m: [cc, prb]"));
  ASSERT_TRUE(study) << to_string(study.error());
  EXPECT_EQ(study->axes[1].words, (std::vector<std::string>{"cc", "prb"}));
  EXPECT_EQ(study->axes[1].values, (std::vector<double>{0, 1}));
  EXPECT_EQ(code_of(with_part(words, "x: [0 mm, 5 mm, 7.5 mm]", "m: [cc, cc]")), "duplicate_word");
  EXPECT_EQ(code_of(with_part(words, "x: [0 mm, 5 mm, 7.5 mm]", "m: [cc, \"c c\"]")), "bad_word");
  EXPECT_EQ(code_of(with_part(words, "x: [0 mm, 5 mm, 7.5 mm]", "m: [cc, 5 mm]")), "not_a_number");
}

TEST(StudyFile, SaysWhatIsWrong) {
  EXPECT_EQ(code_of(good), "");
  EXPECT_EQ(code_of(with_part(good, "$x", "$q")), "unknown_axis");
  EXPECT_EQ(code_of(with_part(good, "$x", "0")), "unused_axis");
  EXPECT_EQ(code_of(with_part(good, "-20 mm", "-20 deg")), "wrong_dimension");
  EXPECT_EQ(code_of(with_part(good, "count: 5", "count: 0")), "out_of_range");
  EXPECT_EQ(code_of(with_part(good, "count: 5", "step: 5")), "missing_key");
  EXPECT_EQ(code_of(with_part(good, "sinew: 1", "sinew: 2")), "wrong_version");
  EXPECT_EQ(code_of(with_part(good, "3-rfr", "none.yaml")), "file_missing");
  EXPECT_EQ(code_of(with_part(with_part(good, "  x:", "  1x:"), "$x", "$1x")), "bad_name");
  EXPECT_EQ(code_of(good + "colour: red\n"), "unknown_key");
  EXPECT_EQ(code_of(good + "outputs: {x: \"inputs[0]\"}\n"), "duplicate_column");
  EXPECT_EQ(code_of(good + "outputs: {status: \"inputs[0]\"}\n"), "bad_name");
  EXPECT_EQ(code_of(good + "reduce: {over: [z], columns: {a: part}}\n"), "unknown_axis");
  EXPECT_EQ(code_of(good + "reduce: {over: [x], columns: {a: {max: b}}}\n"), "unknown_column");
  EXPECT_EQ(code_of(good + "random: {count: 10}\n"), "unknown_key");
  EXPECT_EQ(code_of(good + "fits: {a: {of: x, terms: [y^]}}\n"), "bad_term");
  EXPECT_EQ(code_of(good + "fits: {a: {of: b, terms: [1]}}\n"), "unknown_column");
  EXPECT_EQ(code_of(good + "set: {no.such.path: 1}\n"), "unknown_path");
  EXPECT_EQ(code_of("- a list\n"), "wrong_type");
  EXPECT_EQ(code_of(good + "outputs: {provenance: \"inputs[0]\"}\n"), "bad_name");
  EXPECT_EQ(code_of(good + "outputs: {l: {path: \"inputs[0]\", unit: \"a,b\"}}\n"), "bad_unit");
  EXPECT_EQ(code_of(good + "outputs: {l: \"inputs[0]\"}\nreduce: {over: [x], columns: {y: {max: l}}}\n"),
            "duplicate_column");
  EXPECT_EQ(code_of(good + "outputs: {l: \"inputs[0]\"}\nreduce: {over: [x], columns: {}}\n"), "empty_map");
  EXPECT_EQ(code_of(good + "outputs: {l: \"inputs[0]\"}\nreduce: {over: [], columns: {m: {max: l}}}\n"),
            "empty_list");
  EXPECT_EQ(code_of(good + "fits: {x: {terms: []}}\n"), "empty_list");
}

TEST(StudyFile, WhatTheRobotRefusesIsRefusedBeforeTheSweep) {
  const Folder folder;
  for (const auto& [text, code] : {std::pair{with_part(good, "phi: 0", "phi: 0 mm"), "wrong_dimension"},
                                   {with_part(good, "query: inverse", "query: invert"), "unknown_choice"},
                                   {good + "outputs: {a: \"input[0]\"}\n", "unknown_output"},
                                   {good + "outputs: {a: status}\n", "unknown_output"}}) {
    const auto done = test::sweep_to(folder, text, "out.csv");
    ASSERT_FALSE(done) << text;
    EXPECT_EQ(done.error().front().code, code) << to_string(done.error());
  }
}

TEST(StudyFile, AListOfSamplesIsATableBesideIt) {
  const Folder folder;
  std::ofstream(folder.path / "list.csv") << "# from elsewhere\nx[mm],y[m]\n1,0.002\n2,0.003\n";
  const auto study = study_of(
      folder,
      "sinew: 1\nrobot: 3-rfr\nlisted: list.csv\nquery: {query: inverse, pose: {x: $x, y: $y, phi: 0}}\n");
  ASSERT_TRUE(study) << to_string(study.error());
  EXPECT_EQ(study->samples, 2U);
  EXPECT_EQ(study->axes[0].values, (std::vector<double>{0.001, 0.002}));
  EXPECT_EQ(study->axes[0].unit, "m");
}

TEST(StudyFile, RandomValuesHaveTheirDistribution) {
  const Folder folder;
  const auto study = study_of(folder, R"(sinew: 1
robot: 3-rfr
random: {count: 100000, seed: 3}
axes: {x: {from: -20 mm, to: 40 mm}, y: {mean: 5 mm, deviation: 2 mm}}
query: {query: inverse, pose: {x: $x, y: $y, phi: 0}}
)");
  ASSERT_TRUE(study) << to_string(study.error());
  const std::size_t n = study->samples;
  std::vector<double> values(2 * n), again(2 * 10);
  axis_values(*study, {0, n}, false, values);
  const auto [low, high] =
      std::minmax_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n));
  EXPECT_GE(*low, -0.02);
  EXPECT_LT(*high, 0.04);
  double sum = 0, squares = 0, mean = 0;
  for (std::size_t k = 0; k < n; ++k) {
    mean += values[k] / static_cast<double>(n);
    sum += values[n + k] / static_cast<double>(n);
    squares += (values[n + k] - 0.005) * (values[n + k] - 0.005) / static_cast<double>(n);
  }
  EXPECT_NEAR(mean, 0.01, 4 * 0.06 / std::sqrt(12.0 * static_cast<double>(n)));
  EXPECT_NEAR(sum, 0.005, 4 * 0.002 / std::sqrt(static_cast<double>(n)));
  EXPECT_NEAR(std::sqrt(squares), 0.002, 4 * 0.002 / std::sqrt(2.0 * static_cast<double>(n)));
  axis_values(*study, {77, 10}, false, again);  // wherever a chunk begins
  EXPECT_EQ(again[3], values[80]);
  EXPECT_EQ(again[10 + 3], values[n + 80]);
}

TEST(Terms, AreSumsOfProductsOfColumns) {
  const std::vector<std::string_view> names{"a", "b", "c_1"};
  const std::array<double, 3> at{2, 3, 5};
  for (const auto& [text, value] : {std::pair{"1", 1.0},
                                    {"a", 2.0},
                                    {"a^2 - b^2", -5.0},
                                    {"2 a*b", 12.0},
                                    {"-a + 0.5*c_1^2", 10.5},
                                    {"a b c_1", 30.0},
                                    {" a ^ 3 ", 8.0},
                                    {"2e-3", 2e-3},
                                    {"1.29 - a - b", 1.29 - 2.0 - 3.0},
                                    {"3", 3.0},
                                    {"a^0", 1.0}}) {
    const auto term = parse_term(text, names, "column");
    ASSERT_TRUE(term) << text << to_string(term.error());
    EXPECT_EQ(value_of(*term, at), value) << text;
  }
  for (const char* text : {"", "a^", "a^-1", "a^99", "(a)", "a + ", "2..5", "a $", "d"})
    EXPECT_FALSE(parse_term(text, names, "column")) << text;
}

TEST(Chunks, CoverEverySampleOnceAndEndWhereRowsDo) {
  for (const std::size_t row : {1U, 7U, 100U, 1000U})
    for (const std::size_t rows : {1U, 3U, 40U})
      for (const std::size_t about : {1U, 64U, 100U, 257U, 5000U}) {
        const Chunks chunks(row * rows, row, row, about);
        std::size_t next = 0;
        for (std::size_t k = 0; k < chunks.count(); ++k) {
          const Chunk chunk = chunks[k];
          EXPECT_EQ(chunk.first, next);
          EXPECT_GT(chunk.count, 0U);
          EXPECT_LE(chunk.count, chunks.largest());
          EXPECT_LE(chunk.count, std::max(about, row <= about ? row : about));
          EXPECT_TRUE(row > about || (chunk.first + chunk.count) % row == 0);
          next += chunk.count;
        }
        EXPECT_EQ(next, row * rows);
      }
}

TEST(Chunks, CutCellsWhereRowsEnd) {
  for (const std::size_t about : {7U, 20U, 37U, 50U, 200U, 741U}) {
    const Chunks chunks(2 * 20 * 37, 20 * 37, 37, about);
    std::size_t next = 0;
    for (std::size_t k = 0; k < chunks.count(); ++k) {
      const Chunk chunk = chunks[k];
      ASSERT_EQ(chunk.first, next);
      EXPECT_TRUE(about < 37 || chunk.first % 37 == 0);
      EXPECT_EQ(chunk.first / (20 * 37), (chunk.first + chunk.count - 1) / (20 * 37));  // of one cell
      next += chunk.count;
    }
    EXPECT_EQ(next, 2U * 20 * 37);
  }
}

TEST(Chunks, ASnakeVisitsNeighbours) {
  const Folder folder;
  const auto study = study_of(folder, good);
  ASSERT_TRUE(study);
  std::vector<double> values(2 * 15), straight(2 * 15);
  const Chunk chunk{0, 15};
  axis_values(*study, chunk, true, values);
  axis_values(*study, chunk, false, straight);
  for (std::size_t k = 1; k < 15; ++k)  // one axis moves by one step
    EXPECT_LE(
        std::abs(values[k] - values[k - 1]) / 0.01 + std::abs(values[15 + k] - values[15 + k - 1]) / 0.005,
        1.0 + 1e-9);
  for (std::size_t a = 0; a < 2; ++a) unwind(chunk, 3, std::span(values).subspan(15 * a, 15));
  EXPECT_EQ(values, straight);
}

}  // namespace study_file_test
