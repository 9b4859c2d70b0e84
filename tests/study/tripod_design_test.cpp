/// 3pfs/design: rows of its tables against tripods solved here tilt by tilt, and measured by other formulas;
/// the findings and the files.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sanitizers.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "study/reproduce.hpp"
#include "study_folder.hpp"

namespace tripod_design_test {

using namespace sinew;
using namespace sinew::test;
namespace fs = std::filesystem;

constexpr double degree = std::numbers::pi / 180;

/// Made once, for all tests that only read.
struct Made {
  Folder folder;
  Reproduction reproduction;
  Table design, diameter;

  Made() {
    auto made = reproduce("3pfs/design", folder.path);
    EXPECT_TRUE(made) << to_string(made.error());
    if (!made) return;
    reproduction = *made;
    design = read_csv(folder.path / "3pfs" / "design.csv").value();
    diameter = read_csv(folder.path / "3pfs" / "diameter.csv").value();
  }
};

const Made& made() {
  static const Made once;
  return once;
}

/// The row where these columns have these values.
std::size_t row_of(const Table& table, const std::vector<std::pair<const char*, double>>& wanted) {
  for (std::size_t k = 0; k < table.row_count(); ++k)
    if (std::ranges::all_of(wanted,
                            [&](const auto& at) { return table.find(at.first)->values[k] == at.second; }))
      return k;
  ADD_FAILURE() << "no such row";
  return 0;
}

// ---------------------------------------------------------------- by hand

/// Tilts, and where the platform came to rest.
struct Solved {
  Eigen::MatrixX2d tilts, shifts;
  Eigen::VectorXd e3;
};

Solved solve(const Robot& robot, double height, const SpatialWrench& wrench = SpatialWrench::Zero()) {
  Workspace work(robot);
  Solved all{Eigen::MatrixX2d(49, 2), Eigen::MatrixX2d(49, 2), Eigen::VectorXd(49)};
  Eigen::Index n = 0;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      const double e1 = 0.0425 * i, e2 = 0.0425 * j;
      if (std::hypot(e1, e2) > std::sin(10 * degree)) continue;
      const Equilibrium found =
          inverse_equilibrium(robot, IndependentPose{height, e1, e2}, {.wrench = wrench}, work);
      EXPECT_TRUE(found.report.ok()) << e1 << ' ' << e2;
      if (n == 49) return ADD_FAILURE() << "more tilts than in the study", all;
      all.tilts.row(n) << e1, e2;
      all.shifts.row(n) << found.pose.position.x(), found.pose.position.y();
      all.e3[n++] = found.pose.quaternion[3];
    }
  EXPECT_EQ(n, 49);
  return all;
}

/// A row of either table has the measures of these poses.
void expect_measures(const Table& table, std::size_t row, const Solved& solved) {
  const Eigen::ArrayXd e1 = solved.tilts.col(0), e2 = solved.tilts.col(1);
  Eigen::MatrixX2d rigid(49, 2);  // (10), r = 125 mm
  rigid.col(0) = -0.25 * e1 * e2;
  rigid.col(1) = -0.125 * (e1.square() - e2.square());
  Eigen::Matrix<double, 98, 2> terms;
  terms.col(0) << e2, -e1;
  terms.col(1) << 2 * e1 * e2, e1.square() - e2.square();
  const Eigen::Vector2d c = terms.colPivHouseholderQr().solve(solved.shifts.reshaped());

  const double turn = solved.e3.norm() / 7, shift = solved.shifts.norm() / 7;  // of 49
  const double distance = (solved.shifts - rigid).norm() / 7;
  const auto expect = [&](const char* column, double value) {
    EXPECT_NEAR(table.find(column)->values[row], value, 1e-9 * std::abs(value)) << column << ", row " << row;
  };
  expect("e3", turn);
  expect("twist", 2 * std::asin(turn) / degree);
  expect("shift", 1e3 * shift);
  expect("distance", 1e3 * distance);
  expect("relative", distance / (rigid.norm() / 7));
  expect("drift", 1e3 * c[0]);
  expect("square", 1e3 * c[1]);
  expect("poses", 49);
}

Robot changed(const std::string& name, const std::vector<std::pair<std::string, double>>& settings) {
  Document document = read_robot_file(name).value();
  for (const auto& [path, value] : settings) document = with(document, path, make_node(value)).value();
  return read_robot(document).value();
}

void expect_presets() {
  const Table& table = made().design;
  ASSERT_EQ(table.row_count(), 220U);
  expect_measures(table, row_of(table, {{"base_radius", 175}, {"height", 200}, {"pair_angle", 3}}),
                  solve(load("3pfs-g1").value(), 0.2));
  expect_measures(table, row_of(table, {{"base_radius", 250}, {"height", 400}, {"pair_angle", 30}}),
                  solve(load("3pfs-g2").value(), 0.4));
}

void expect_another_tripod() {
  std::vector<std::pair<std::string, double>> settings{{"platform.home.position[2]", 0.3}};
  for (int leg = 0; leg < 6; ++leg) {
    const std::string point = "legs[" + std::to_string(leg) + "].base.point";
    settings.emplace_back(point + ".radius", 0.13);
    settings.emplace_back(point + ".angle", (90 + 120 * (leg / 2) + (leg % 2 ? 10 : -10)) * degree);
  }
  const Table& table = made().design;
  expect_measures(table, row_of(table, {{"base_radius", 130}, {"height", 300}, {"pair_angle", 10}}),
                  solve(changed("3pfs-g2", settings), 0.3));
}

void expect_loaded() {
  const Table& table = made().diameter;
  ASSERT_EQ(table.row_count(), 32U);
  SpatialWrench down = SpatialWrench::Zero(), moment = SpatialWrench::Zero();
  down[2] = -10;
  moment[5] = 0.5;
  expect_measures(table, row_of(table, {{"preset", 2}, {"load", 2}, {"diameter", 4}}),
                  solve(changed("3pfs-g2", {{"defaults.link.diameter", 0.004}}), 0.4, down));
  expect_measures(table, row_of(table, {{"preset", 1}, {"load", 3}, {"diameter", 3}}),
                  solve(load("3pfs-g1").value(), 0.2, moment));
}

/// Without load the tables agree, whatever the diameter.
void expect_same_without_load() {
  const auto& [folder, reproduction, design, diameter] = made();
  const std::size_t g1 = row_of(design, {{"base_radius", 175}, {"height", 200}, {"pair_angle", 3}});
  const std::size_t g2 = row_of(design, {{"base_radius", 250}, {"height", 400}, {"pair_angle", 30}});
  int compared = 0;
  for (std::size_t k = 0; k < diameter.row_count(); ++k) {
    if (diameter.find("load")->values[k] != 0) continue;
    for (const char* column : {"e3", "shift", "distance", "drift", "square"}) {
      const double value = design.find(column)->values[diameter.find("preset")->values[k] == 1 ? g1 : g2];
      EXPECT_NEAR(diameter.find(column)->values[k], value, 1e-9 * std::abs(value)) << column;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 40);
}

TEST(TripodDesign, TablesHaveTheMeasuresOfTripodsSolvedTiltByTilt) {
  expect_presets();
  expect_another_tripod();
  expect_loaded();
  expect_same_without_load();
}

void expect_claims() {
  const auto& findings = made().reproduction.findings;
  ASSERT_EQ(findings.size(), 30U);
  std::size_t held = 0;
  for (const Finding& finding : findings) {
    EXPECT_TRUE(finding.verdict == "holds" || finding.verdict == "for information")
        << finding.quantity << ": " << finding.ours << ", " << finding.difference;
    EXPECT_EQ(finding.ours.find("nan"), std::string::npos) << finding.quantity;
    held += finding.verdict == "holds";
  }
  EXPECT_EQ(held, 17U);
}

/// The advice is that of the table: "from 15°" at r_A = 150 mm, h = 300 mm, within 10 %.
void expect_advice() {
  const auto& findings = made().reproduction.findings;
  const auto advice = std::ranges::find_if(
      findings, [](const Finding& finding) { return finding.quantity.starts_with("r_A = 150 mm: ψ"); });
  ASSERT_NE(advice, findings.end());
  EXPECT_TRUE(advice->ours.ends_with("from 30°, from 15°, from 15°, from 10° (h = 200, 300, 400, 600 mm)"))
      << advice->ours;
  const Table& table = made().design;
  for (const double angle : {10., 15., 20., 30., 40., 50.})
    EXPECT_EQ(
        table.find("relative")
                ->values[row_of(table, {{"base_radius", 150}, {"height", 300}, {"pair_angle", angle}})] <=
            0.1,
        angle >= 15)
        << angle;
}

void expect_files() {
  const fs::path at = made().folder.path / "3pfs";
  std::vector<fs::path> expected;
  for (const char* name :
       {"3pfs-design-samples.h5", "3pfs-g1-diameter-samples.h5", "3pfs-g2-diameter-samples.h5", "design.csv",
        "diameter.csv", "design.md", "design.gp", "design.svg", "design.png"})
    expected.push_back(at / name);
  EXPECT_EQ(made().reproduction.files, expected);
  for (const fs::path& file : expected) EXPECT_GT(fs::file_size(file), 2000U) << file;
  EXPECT_TRUE(bytes(at / "design.png").starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_NE(bytes(at / "design.svg").find("</svg>"), std::string::npos);
}

TEST(TripodDesign, EveryClaimHoldsAdviceFollowsAndFilesAreThere) {
  if (test::addresses_are_checked) GTEST_SKIP() << "minutes of sweeps, which the test above runs too";
  expect_claims();
  expect_advice();
  expect_files();
}

TEST(TripodDesign, AFolderThatCannotBeWrittenIsAnError) {
  const Folder folder;
  std::ofstream(folder.path / "file") << "no folder";
  EXPECT_FALSE(reproduce("3pfs/design", folder.path / "file"));
}

}  // namespace tripod_design_test
