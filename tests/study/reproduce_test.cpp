#include "study/reproduce.hpp"
#include "reference_file.hpp"
#include "study_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>

#include "paths.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study/tdpcr/example51.hpp"

namespace reproduce_test {

using namespace sinew;
namespace fs = std::filesystem;

using namespace sinew::test;

/// Made once, for all tests that only read.
const Table& fig9() {
  static const Table table = [] {
    const Folder folder;
    const auto made = reproduce("tdpcr/fig9", folder.path);
    EXPECT_TRUE(made) << to_string(made.error());
    return read_csv(folder.path / "tdpcr" / "fig9.csv").value();
  }();
  return table;
}

double value(const char* column, std::size_t k) { return fig9().find(column)->values.at(k); }

const nlohmann::json& reference() { return test::reference_file("data/tdpcr/example51.json"); }

void expect_relative(double ours, double theirs, double tolerance, const std::string& what) {
  EXPECT_LE(std::abs(ours - theirs), tolerance * std::abs(theirs)) << what << ": " << ours << ", " << theirs;
}

TEST(Fig9, CurvesEqualTheReference) {  // @verifies TDPCR (68)-(70)
  const nlohmann::json& example = reference();
  ASSERT_EQ(example["CC"].size(), 30U);
  for (const auto& row : example["CC"]) {
    const auto k = row["k"].get<std::size_t>();
    const double tolerance = k <= 55 ? 1e-10 : 1e-9;
    const std::string at = " at k = " + std::to_string(k);
    expect_relative(value("condition", k), row["cond"], tolerance, "condition" + at);
    expect_relative(value("position", k), row["Up"], tolerance, "position" + at);
    expect_relative(value("rotation", k), row["Ur"], tolerance, "rotation" + at);
    expect_relative(value("determinant", k), row["det"], tolerance, "determinant" + at);
    EXPECT_EQ(value("x", k), row["pose"][0].get<double>()) << at;
    EXPECT_NEAR(value("phi", k), row["pose"][2].get<double>(), 1e-15) << at;
    for (const std::size_t leg : {1U, 2U, 3U}) {
      const std::string number = std::to_string(leg);
      expect_relative(value(("tendon_" + number).c_str(), k), row["l1"][leg - 1], 1e-12,
                      "tendon" + number + at);
      expect_relative(value(("curvature_" + number).c_str(), k), row["kappa"][leg - 1], 1e-12,
                      "curvature" + at);
    }
  }
}

TEST(Fig9, TheSingularPoseHasNoIndices) {
  ASSERT_EQ(fig9().row_count(), 60U);
  for (const char* index : {"condition", "condition_homogenised", "position", "rotation"}) {
    EXPECT_TRUE(std::isnan(value(index, 59))) << index;
    EXPECT_TRUE(std::isfinite(value(index, 58))) << index;
  }
  EXPECT_LT(std::abs(value("determinant", 59)), 1e-17);
  EXPECT_TRUE(std::isfinite(value("tendon_3", 59)));
}

TEST(Example51, DivergenceRatesEqualTheReference) {
  const auto robot = load(std::string(source_folder) + "/robots/3-rfr.yaml");
  ASSERT_TRUE(robot);
  Workspace work(*robot);
  const auto rates = example51::rates(example51::sample(*robot, 1, work).value());
  const auto& divergence = reference()["divergence"];
  expect_relative(rates.condition, divergence["cond"], 1e-12, "condition");
  expect_relative(rates.position, divergence["Up"], 1e-12, "position");
  expect_relative(rates.rotation, divergence["Ur"], 1e-12, "rotation");
}

TEST(Example51, IndicesApproachTheirRatesToFirstOrder) {
  const auto robot = load(std::string(source_folder) + "/robots/3-rfr.yaml");
  Workspace work(*robot);
  const auto rates = example51::rates(example51::sample(*robot, 1, work).value());
  for (const double left : {1e-3, 1e-4, 1e-5}) {
    const auto near_end = example51::sample(*robot, 1 - left, work).value();
    const double angle = std::numbers::pi / 3 - near_end.pose.phi;
    expect_relative(near_end.indices.condition * angle, rates.condition, 2 * left, "condition");
    expect_relative(near_end.indices.position * angle, rates.position, 2 * left, "position");
    expect_relative(near_end.indices.rotation * angle, rates.rotation, 2 * left, "rotation");
  }
}

TEST(Example51, ClosedFormOfTheDeterminantHoldsOffTheTrajectory) {
  const auto robot = load(std::string(source_folder) + "/robots/3-rfr.yaml");
  Workspace work(*robot);
  for (const PlanarPose pose : {PlanarPose{0.01, -0.02, 0.3}, {-0.02, 0.015, 1.4}, {0.005, 0.01, -0.2}}) {
    const double determinant = velocity(*robot, pose, {0.0, 0.0, 0.0}, work).determinant;
    EXPECT_NEAR(determinant, example51::determinant(pose), 1e-17);
  }
}

TEST(Reproduce, EveryClaimThatCanBeCheckedHolds) {
  const Folder folder;
  const auto made = reproduce("tdpcr/fig9", folder.path);
  ASSERT_TRUE(made) << to_string(made.error());
  EXPECT_EQ(made->id, "tdpcr/fig9");
  ASSERT_EQ(made->findings.size(), 17U);
  for (const Finding& finding : made->findings)
    EXPECT_TRUE(finding.verdict == "agrees" || finding.verdict == "holds" ||
                finding.verdict == "for information")
        << finding.quantity << ": " << finding.ours << ", " << finding.difference << ": " << finding.verdict;
}

TEST(Reproduce, FilesAreValidAndTheSameBytesTheSecondTime) {
  const Folder folder;
  const auto made = reproduce("tdpcr/fig9", folder.path);
  ASSERT_TRUE(made) << to_string(made.error());
  std::vector<std::string> first;
  for (const fs::path& file : made->files) first.push_back(bytes(file));
  const fs::path at = folder.path / "tdpcr";
  EXPECT_EQ(made->files, (std::vector<fs::path>{at / "fig9.csv", at / "fig9.md", at / "fig9.gp",
                                                at / "fig9.svg", at / "fig9.png", at / "fig9-poses.gp",
                                                at / "fig9-poses.svg", at / "fig9-poses.png"}));
  for (const char* name : {"fig9.png", "fig9-poses.png"}) {
    const std::string png = bytes(at / name);
    ASSERT_GT(png.size(), 50000U) << name;
    EXPECT_TRUE(png.starts_with("\x89PNG\r\n\x1a\n"));
    EXPECT_GE(256 * static_cast<unsigned char>(png[18]) + static_cast<unsigned char>(png[19]), 1200);
  }
  for (const char* name : {"fig9.svg", "fig9-poses.svg"}) {
    const std::string svg = bytes(at / name);
    EXPECT_GT(svg.size(), 10000U) << name;
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
  }
  ASSERT_TRUE(reproduce("tdpcr/fig9", folder.path));
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(bytes(made->files[i]), first[i]) << made->files[i];
}

TEST(Reproduce, WithoutGnuplotTheTableTheFindingsAndTheScriptsStay) {
  const Folder folder;
  const EmptyPath nothing;
  const auto made = reproduce("tdpcr/fig9", folder.path);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().front().code, "gnuplot_missing");
  EXPECT_NE(to_string(made.error()).find("gnuplot is not installed: apt-get install gnuplot-nox"),
            std::string::npos);
  for (const char* name : {"fig9.csv", "fig9.md", "fig9.gp", "fig9-poses.gp"})
    EXPECT_GT(fs::file_size(folder.path / "tdpcr" / name), 1000U) << name;
  EXPECT_FALSE(fs::exists(folder.path / "tdpcr" / "fig9.png"));
}

TEST(Reproduce, FiguresAreOnThePageThatIsAskedForAndEditedScriptsStay) {
  const Folder folder;
  FigureOptions page{.formats = {FigureFormat::svg}, .width = 85};
  const auto made = reproduce("lsk/fig3", folder.path, page);
  ASSERT_TRUE(made) << to_string(made.error());
  const fs::path script = folder.path / "lsk" / "fig3.gp", svg = folder.path / "lsk" / "fig3.svg";
  EXPECT_EQ(made->files, (std::vector<fs::path>{folder.path / "lsk" / "fig3.csv",
                                                folder.path / "lsk" / "fig3.md", script, svg}));
  EXPECT_NE(bytes(svg).find("width=\"85mm\""), std::string::npos);
  std::ofstream(script, std::ios::app) << "# a change\n";
  const auto again = reproduce("lsk/fig3", folder.path, page);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().front().code, "script_edited");
  page.replaces_edited_script = true;
  EXPECT_TRUE(reproduce("lsk/fig3", folder.path, page));
}

TEST(Reproduce, WithoutACrossCompilerFigure8OfLskSaysSo) {
  const Folder folder;
  const EmptyPath nothing;
  const auto made = reproduce("lsk/fig8", folder.path);
  ASSERT_TRUE(made) << to_string(made.error());
  ASSERT_EQ(made->findings.size(), 1U);
  EXPECT_NE(made->findings[0].ours.find("apt-get install gcc-avr avr-libc"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder.path / "lsk" / "fig8.md"));
}

TEST(Reproduce, AFolderThatCannotBeWrittenIsAnError) {
  const Folder folder;
  std::ofstream(folder.path / "file") << "no folder";
  const auto made = reproduce("tdpcr/fig9", folder.path / "file");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().front().code, "file_unwritable");
}

TEST(Reproduce, AnUnknownItemIsAnErrorThatListsTheKnownOnes) {
  const auto made = reproduce("tdpcr/fig99", "nowhere");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().front().code, "unknown_study");
  for (const StudyItem& item : study_items())
    EXPECT_NE(made.error().front().message.find(item.id), std::string::npos) << item.id;
  EXPECT_FALSE(fs::exists("nowhere"));
}

TEST(Reproduce, ABarInAFindingDoesNotEndItsCell) {
  const Reproduction made{"a/b", "title", {{"|x|", "1", "2\n", "1", "differs"}}, {}};
  EXPECT_NE(to_markdown(made).find("| \\|x\\| | 1 | 2  | 1 | differs |\n"), std::string::npos)
      << to_markdown(made);
}

}  // namespace reproduce_test
