/// Figs. 8 and 10 of the example of section 5.1: the findings, the tables and the files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "reference_file.hpp"
#include "sinew/io/table.hpp"
#include "study/compare.hpp"
#include "study/reproduce.hpp"
#include "study/tdpcr/example51.hpp"
#include "study_folder.hpp"

namespace tdpcr_figures_test {

using namespace sinew;
namespace fs = std::filesystem;

using namespace sinew::test;

/// One item, made once for all tests that only read.
struct Made {
  Reproduction reproduction;
  Table table;
};

Made make(const std::string& name) {
  const Folder folder;
  auto made = reproduce("tdpcr/" + name, folder.path);
  EXPECT_TRUE(made) << to_string(made.error());
  return {made.value(), read_csv(folder.path / "tdpcr" / (name + ".csv")).value()};
}

const Made& fig8() {
  static const Made made = make("fig8");
  return made;
}

const Made& fig10() {
  static const Made made = make("fig10");
  return made;
}

double value(const Made& made, const char* column, std::size_t leg) {
  return made.table.find(column)->values.at(leg);
}

nlohmann::json reference(std::size_t k) {
  for (const auto& row : test::reference_file("data/tdpcr/example51.json")["CC"])
    if (row["k"] == k) return row;
  return {};
}

void expect_good(const Reproduction& made, std::size_t findings) {
  EXPECT_EQ(made.findings.size(), findings);
  for (const Finding& finding : made.findings)
    EXPECT_TRUE(finding.verdict == "agrees" || finding.verdict == "holds" ||
                finding.verdict == "for information")
        << finding.quantity << ": " << finding.ours << ", " << finding.difference << ": " << finding.verdict;
}

TEST(Fig8, EveryClaimThatCanBeCheckedHolds) { expect_good(fig8().reproduction, 15); }

TEST(Fig8, LegsEqualTheReference) {
  const auto start = reference(0);
  ASSERT_EQ(fig8().table.row_count(), 3U);
  for (std::size_t leg = 0; leg < 3; ++leg) {
    EXPECT_NEAR(value(fig8(), "curvature", leg), start["kappa"][leg].get<double>(), 1e-11) << leg;
    EXPECT_NEAR(value(fig8(), "tendon_1", leg), start["l1"][leg].get<double>(), 1e-14) << leg;
  }
}

TEST(Fig8, TheTwoTendonsOfALegAreTogetherTwiceItsBackbone) {
  for (std::size_t leg = 0; leg < 3; ++leg)
    EXPECT_NEAR(value(fig8(), "tendon_1", leg) + value(fig8(), "tendon_2", leg), 0.4, 1e-15) << leg;
}

TEST(Fig10, EveryClaimThatCanBeCheckedHolds) { expect_good(fig10().reproduction, 11); }

TEST(Fig10, EveryLinePassesThroughTheMeetingPoint) {
  const Vec2<double> met = example51::meeting_point();
  ASSERT_EQ(fig10().table.row_count(), 3U);
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const double x = value(fig10(), "direction_x", leg), y = value(fig10(), "direction_y", leg);
    EXPECT_NEAR(std::hypot(x, y), 1, 1e-15) << leg;
    EXPECT_NEAR(met.x() * y - met.y() * x, value(fig10(), "moment", leg), 1e-15) << leg;
  }
}

TEST(Fig10, LegsHaveTheLengthsOfTheLastPose) {  // ρ = (2/κ) sin(κℓ/2), TDPCR (9) before its derivative
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const double curvature = value(fig10(), "curvature", leg);
    EXPECT_NEAR(2 / curvature * std::sin(curvature * 0.1), value(fig10(), "chord", leg), 1e-14) << leg;
  }
}

class TdpcrFigure : public testing::TestWithParam<const char*> {};

const Made& fig11() {
  static const Made made = make("fig11");
  return made;
}

TEST(Fig11, CurvesAreTheirs) {
  ASSERT_EQ(fig11().table.row_count(), 60U);
  for (const auto& row : test::reference_file("data/tdpcr/example51.json")["PRB"]) {
    const std::size_t k = row["k"];
    const double condition = row["cond"], position = row["Up"], rotation = row["Ur"];
    EXPECT_NEAR(value(fig11(), "condition", k), condition, 1e-9 * condition) << k;
    EXPECT_NEAR(value(fig11(), "position", k), position, 1e-9 * position) << k;
    EXPECT_NEAR(value(fig11(), "rotation", k), rotation, 1e-9 * rotation) << k;
    EXPECT_NEAR(value(fig11(), "theta_24", k), row["theta"][1][2].get<double>(), 1e-13) << k;
  }
  EXPECT_TRUE(std::isnan(value(fig11(), "rotation", 59)));
}

/// What the paper concludes of its curves hangs on units, and is said so.
TEST(Fig11, SaysWhatIsTrueOfTheClaim) {
  const auto& findings = fig11().reproduction.findings;
  ASSERT_EQ(findings.size(), 12U);
  EXPECT_NE(findings[11].ours.find("-0.377 to -0.056 N"), std::string::npos) << findings[11].ours;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(findings[i].verdict, "holds") << findings[i].quantity;
  EXPECT_EQ(findings[6].verdict, "agree");
  EXPECT_EQ(findings[7].verdict, "unit artefact");
  EXPECT_EQ(findings[8].verdict, "a factor of units");
  EXPECT_EQ(findings[9].verdict, "fails");
  EXPECT_NE(findings[8].ours.find("73.09 → 71.59"), std::string::npos) << findings[8].ours;
  EXPECT_NE(findings[9].ours.find("55.23 against × 54.10"), std::string::npos) << findings[9].ours;
}

TEST(Fig12, LastPoseIsTypeTwo) {
  const Made made = make("fig12");
  ASSERT_EQ(made.table.row_count(), 21U);  // three legs of a base point, five joints and a tip
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(made.reproduction.findings[i].verdict, "holds");
  for (std::size_t row = 0; row < 20; ++row) {  // links of 1/30 m
    if (row % 7 == 6) continue;
    EXPECT_NEAR(std::hypot(value(made, "x", row + 1) - value(made, "x", row),
                           value(made, "y", row + 1) - value(made, "y", row)),
                0.2 / 6, 1e-15);
  }
}

TEST(Chains, ApproachTheElasticaAtTheirOrders) {
  const Made made = make("chains");
  EXPECT_EQ(made.reproduction.findings.size(), 12U);
  for (const Finding& finding : made.reproduction.findings)
    EXPECT_EQ(finding.verdict, "holds") << finding.quantity << ": " << finding.ours;
}

INSTANTIATE_TEST_SUITE_P(Both, TdpcrFigure, testing::Values("fig8", "fig10", "fig11", "fig12", "chains"),
                         [](const auto& given) { return std::string(given.param); });

TEST_P(TdpcrFigure, FilesAreValidAndTheSameBytesTheSecondTime) {
  const Folder folder;
  const std::string name = GetParam();
  const fs::path at = folder.path / "tdpcr";
  const auto made = reproduce("tdpcr/" + name, folder.path);
  ASSERT_TRUE(made) << to_string(made.error());
  EXPECT_EQ(made->id, "tdpcr/" + name);
  EXPECT_EQ(made->files,
            (std::vector<fs::path>{at / (name + ".csv"), at / (name + ".md"), at / (name + ".gp"),
                                   at / (name + ".svg"), at / (name + ".png")}));
  const std::string png = bytes(at / (name + ".png")), svg = bytes(at / (name + ".svg"));
  ASSERT_GT(png.size(), 50000U);
  EXPECT_TRUE(png.starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  std::vector<std::string> first;
  for (const fs::path& file : made->files) first.push_back(bytes(file));
  ASSERT_TRUE(reproduce("tdpcr/" + name, folder.path));
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(bytes(made->files[i]), first[i]) << made->files[i];
}

TEST_P(TdpcrFigure, WithoutGnuplotTheTableTheFindingsAndTheScriptStay) {
  const Folder folder;
  const EmptyPath nothing;
  const std::string name = GetParam();
  const auto made = reproduce("tdpcr/" + name, folder.path);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().front().code, "gnuplot_missing");
  for (const char* ending : {".csv", ".md", ".gp"})
    EXPECT_GT(fs::file_size(folder.path / "tdpcr" / (name + ending)), 500U) << ending;
  EXPECT_FALSE(fs::exists(folder.path / "tdpcr" / (name + ".png")));
}

TEST_P(TdpcrFigure, AFolderThatCannotBeWrittenIsAnError) {
  const Folder folder;
  std::ofstream(folder.path / "file") << "no folder";
  const auto made = reproduce(std::string("tdpcr/") + GetParam(), folder.path / "file");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().front().code, "file_unwritable");
}

TEST(Compare, AVerdictFollowsFromTheDistance) {
  EXPECT_EQ(compare::printed("q", 0.19, 0.19, "m").verdict, "agrees");
  EXPECT_EQ(compare::printed("q", 0.19, 0.19 + 1e-15, "m").verdict, "differs");
  EXPECT_EQ(compare::given("q", "a", "b", 1e-16, 1e-15, "m").verdict, "agrees");
  EXPECT_EQ(compare::given("q", "a", "b", 1e-14, 1e-15, "m").verdict, "differs");
  EXPECT_EQ(compare::claimed("q", "a", "b", 1e-16, 1e-15, "m").verdict, "holds");
  EXPECT_EQ(compare::claimed("q", "a", "b", 1e-14, 1e-15, "m").verdict, "fails");
}

TEST(Compare, WhatIsNotANumberFails) {
  EXPECT_EQ(compare::claimed("q", "a", "b", std::nan(""), 1, "").verdict, "fails");
  EXPECT_EQ(compare::given("q", "a", "b", std::nan(""), 1, "").verdict, "differs");
  EXPECT_EQ(compare::printed("q", 1, std::nan(""), "m").verdict, "differs");
}

}  // namespace tdpcr_figures_test
