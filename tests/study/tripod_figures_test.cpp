/// Figs. 4 to 7 of the rigid tripod: the numbers against the paper's equations written out here once more,
/// and against differences of them; the findings and the files.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "math/linalg.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "study/reproduce.hpp"
#include "study/tripod/contour.hpp"
#include "study/tripod/example.hpp"
#include "study_folder.hpp"
#include "thorough.hpp"

namespace tripod_figures_test {

using namespace sinew;
using namespace sinew::test;
namespace fs = std::filesystem;
using std::numbers::pi, std::numbers::sqrt3;

constexpr double degree = pi / 180;
constexpr double r_A = 0.25, L = 0.35, r = 0.125;

/// One item, made once for all tests that only read.
struct Made {
  Folder folder;
  Reproduction reproduction;
  Table table;

  explicit Made(const std::string& name) {
    auto made = reproduce("3pfs/" + name, folder.path);
    EXPECT_TRUE(made) << to_string(made.error());
    reproduction = made.value();
    table = read_csv(folder.path / "3pfs" / (name + ".csv")).value();
  }
  double value(const char* column, std::size_t k) const { return table.find(column)->values.at(k); }
};

const Made& made(const std::string& name) {
  static std::map<std::string, Made> all;
  return all.try_emplace(name, name).first->second;
}

// ---------------------------------------------------------------- the paper's equations

Eigen::Vector3d outwards(int leg) {  // (7), (12) over their radii
  const double angle = (90 + 120 * leg) * degree;
  return {std::cos(angle), std::sin(angle), 0};
}

Eigen::Vector3d hinge(int leg) {  // (8)
  if (leg == 0) return {1, 0, 0};
  return {leg == 1 ? -0.5 : 0.5, 0.5 * sqrt3, 0};
}

Eigen::Matrix3d rotation(double e0, double e1, double e2, double e3) {  // (3)
  Eigen::Matrix3d R;
  R << e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3, 2 * (e1 * e2 - e0 * e3), 2 * (e1 * e3 + e0 * e2),  //
      2 * (e1 * e2 + e0 * e3), e0 * e0 - e1 * e1 + e2 * e2 - e3 * e3, 2 * (e2 * e3 - e0 * e1),   //
      2 * (e1 * e3 - e0 * e2), 2 * (e2 * e3 + e0 * e1), e0 * e0 - e1 * e1 - e2 * e2 + e3 * e3;
  return R;
}

/// Pose by (10) at a height, and the slides below it by (11).
struct ByHand {
  Eigen::Vector3d p;
  Eigen::Matrix3d R;
  std::array<double, 3> slides;

  ByHand(double e1, double e2, double z = 0.5) {
    p = {-2 * r * e1 * e2, -r * (e1 * e1 - e2 * e2), z};
    R = rotation(std::sqrt(1 - e1 * e1 - e2 * e2), e1, e2, 0);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d b = p + R * (r * outwards(i));
      const double off = b.dot(outwards(i)) - r_A;
      slides[static_cast<std::size_t>(i)] = b.z() - std::sqrt(L * L - off * off);
    }
  }

  /// Half of |bᵢ − cᵢ|² − L² of (11), then (2), of a platform moved from here by a twist.
  Eigen::Matrix<double, 6, 1> residuals(const Eigen::Matrix<double, 6, 1>& twist) const {
    const double turn = twist.tail<3>().norm();
    const Eigen::Matrix3d turned =
        turn > 0 ? Eigen::AngleAxisd(turn, twist.tail<3>() / turn) * R : Eigen::Matrix3d(R);
    Eigen::Matrix<double, 6, 1> g;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d b = p + twist.head<3>() + turned * (r * outwards(i));
      const Eigen::Vector3d c =
          r_A * outwards(i) + Eigen::Vector3d(0, 0, slides[static_cast<std::size_t>(i)]);
      g[i] = 0.5 * ((b - c).squaredNorm() - L * L);
      g[3 + i] = b.dot(hinge(i));
    }
    return g;
  }

  /// The left matrix of (17), by central differences.
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> jacobian() const {
    constexpr double h = 1e-5;
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> J;
    for (int k = 0; k < 6; ++k) {
      const Eigen::Matrix<double, 6, 1> step = h * Eigen::Matrix<double, 6, 1>::Unit(k);
      J.col(k) = (residuals(step) - residuals(-step)) / (2 * h);
    }
    return J;
  }
};

double determinant_by_hand(double radius, double direction) {
  auto J = ByHand(radius * std::cos(direction), radius * std::sin(direction)).jacobian();
  return determinant(MatrixView(J.data(), 6, 6));
}

/// Rows of a table spread over all of it.
std::vector<std::size_t> some_rows(const Table& table, std::size_t count) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < count; ++k) rows.push_back(k * (table.row_count() - 1) / (count - 1));
  return rows;
}

// ---------------------------------------------------------------- figure 4

TEST(TripodFig4, PlatformPointsStayInTheirPlanes) {  // @verifies 3PFS (2), (9)-(10)
  const Made& fig = made("fig4");
  ASSERT_GT(fig.table.row_count(), 7000U);
  for (std::size_t k = 0; k < fig.table.row_count(); ++k) {
    const double e0 = fig.value("e0", k), e1 = fig.value("e1", k), e2 = fig.value("e2", k);
    EXPECT_NEAR(e0 * e0 + e1 * e1 + e2 * e2, 1, 1e-14);
    const Eigen::Vector3d p(fig.value("x", k), fig.value("y", k), 0.5);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR((p + rotation(e0, e1, e2, 0) * outwards(i)).dot(hinge(i)), 0, 1e-14) << e1 << ' ' << e2;
  }
}

TEST(TripodFig4, OnlyTheRemarkOnHalfTurnsFails) {
  const Reproduction& found = made("fig4").reproduction;
  ASSERT_EQ(found.findings.size(), 13U);
  for (const Finding& finding : found.findings)
    EXPECT_EQ(finding.verdict == "fails", finding.quantity.starts_with("where e_0")) << finding.quantity;
}

// ---------------------------------------------------------------- figure 5

TEST(TripodFig5, OnTheInverseLocusALeftSideIsARightSide) {  // @verifies 3PFS (19)
  const Made& fig = made("fig5");
  ASSERT_EQ(fig.table.row_count(), 360U);
  for (std::size_t k = 0; k < 360; ++k) {
    const double radius = fig.value("inverse", k), direction = static_cast<double>(k) * degree;
    const double e1 = radius * std::cos(direction), e2 = radius * std::sin(direction);
    const double least = std::min({1 - 3 * e1 * e1 + e2 * e2, 1 + 2 * sqrt3 * e1 * e2 - 2 * e2 * e2,
                                   1 - 2 * sqrt3 * e1 * e2 - 2 * e2 * e2});
    EXPECT_NEAR(least, (r_A - L) / r, 1e-14) << k;
    EXPECT_NEAR(fig.value("inverse_tilt", k), 2 * std::asin(radius) / degree, 1e-12);
  }
  EXPECT_NEAR(fig.value("inverse", 0), std::sqrt(0.6), 1e-15);
  EXPECT_NEAR(fig.value("inverse", 30), std::sqrt(0.9), 1e-15);
}

TEST(TripodFig5, TheDeterminantOfDifferencesChangesItsSignOnTheForwardLocus) {  // @verifies 3PFS (17)
  const Made& fig = made("fig5");
  const double home = determinant_by_hand(0, 0);
  int none = 0;
  for (std::size_t k = 0; k < 360; ++k) {
    const double radius = fig.value("forward", k), direction = static_cast<double>(k) * degree;
    if (std::isnan(radius)) {
      ++none;
      EXPECT_GT(determinant_by_hand((1 - 1e-9) * fig.value("inverse", k), direction) / home, 0) << k;
      continue;
    }
    EXPECT_LT(radius, fig.value("inverse", k));
    const double before = determinant_by_hand(radius - 1e-7, direction) / home;
    const double after = determinant_by_hand(radius + 1e-7, direction) / home;
    EXPECT_GT(before, 0) << k;
    EXPECT_LT(after, 0) << k;
    EXPECT_GT(determinant_by_hand(0.5 * radius, direction) / home, 0) << k;
  }
  EXPECT_EQ(none, 27);  // 4 degrees to either side of three directions
}

TEST(TripodFig5, LociHaveTheSymmetryOfTheRobot) {
  const Made& fig = made("fig5");
  for (std::size_t k = 0; k < 360; ++k)
    for (const std::size_t image : {(k + 120) % 360, (360 - k) % 360}) {
      EXPECT_NEAR(fig.value("inverse", k), fig.value("inverse", image), 1e-14) << k;
      const double here = fig.value("forward", k), there = fig.value("forward", image);
      EXPECT_EQ(std::isnan(here), std::isnan(there)) << k;
      if (std::isnan(here)) continue;
      EXPECT_NEAR(here, there, 1e-12) << k;
    }
}

TEST(TripodFig5, AreasAreThoseOfTheCurves) {
  const tripod::Areas areas = tripod::areas(tripod::printed);
  const auto area_of = [](const Series& curve) {
    double twice = 0;
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      const std::size_t next = (k + 1) % curve.x.size();
      twice += curve.x[k] * curve.y[next] - curve.x[next] * curve.y[k];
    }
    return 0.5 * twice;
  };
  EXPECT_NEAR(areas.inverse, 1.8 * sqrt3 * std::numbers::ln2, 1e-14);
  EXPECT_NEAR(areas.inverse, area_of(tripod::inverse_curve(tripod::printed, Mark::outline, 1)), 2e-4);
  EXPECT_NEAR(areas.first, area_of(tripod::first_curve(tripod::printed)), 2e-4);
}

TEST(TripodFig5, ClaimsThatFailAreThoseOfTheForwardLocus) {
  const Reproduction& found = made("fig5").reproduction;
  ASSERT_EQ(found.findings.size(), 15U);
  std::set<std::string> failed;
  for (const Finding& finding : found.findings) {
    EXPECT_NE(finding.verdict, "differs") << finding.quantity;
    if (finding.verdict == "fails") failed.insert(finding.quantity);
  }
  EXPECT_EQ(failed, (std::set<std::string>{"what limits the tilt, going out from home",
                                           "of it reached from home before FK is singular"}));
}

TEST(TripodFig5, ALocusOfAnotherTripodIsItsOwn) {  // the closed form against the search, other sizes
  for (const TripodSize& size : {TripodSize{0.2, 0.15, 0.3}, TripodSize{0.3, 0.2, 0.25}})
    for (int k = 0; k < 60; k += 7)
      EXPECT_NEAR(tripod::inverse_radius(size, k * degree), inverse_locus(size, k * degree).value_or(0),
                  1e-13);
}

// ---------------------------------------------------------------- figures 6 and 7

TEST(TripodFig6, RisesAreThoseOfTheStruts) {  // @verifies 3PFS (18)
  const Made& fig = made("fig6");
  ASSERT_GT(fig.table.row_count(), 5000U);
  for (const std::size_t k : some_rows(fig.table, 200)) {
    const ByHand at(fig.value("e1", k), fig.value("e2", k));
    double squares = 0, least = 1, most = 0;
    for (int i = 0; i < 3; ++i) {
      const double rise = (at.p + at.R * (r * outwards(i))).z() - at.slides[static_cast<std::size_t>(i)];
      EXPECT_NEAR(fig.value(("rise_" + std::to_string(i + 1)).c_str(), k), rise, 1e-13);
      squares += rise * rise;
      least = std::min(least, rise);
      most = std::max(most, rise);
    }
    EXPECT_NEAR(fig.value("frobenius", k), std::sqrt(squares), 1e-13);
    EXPECT_NEAR(fig.value("largest", k), most, 1e-13);
    EXPECT_NEAR(fig.value("smallest", k), least, 1e-13);
  }
}

TEST(TripodFig7, TheMatrixIsThatOfDifferences) {  // @verifies 3PFS (15)-(17)
  const Made& fig = made("fig7");
  for (const std::size_t k : some_rows(fig.table, 100)) {
    auto J = ByHand(fig.value("e1", k), fig.value("e2", k)).jacobian();
    EXPECT_NEAR(fig.value("frobenius", k), J.norm(), 1e-10);
    EXPECT_NEAR(fig.value("determinant", k), determinant(MatrixView(J.data(), 6, 6)), 1e-13);
  }
}

/// Largest singular value of three rows from `first`.
double norm_of(const Eigen::Matrix<double, 6, 3>& U, int first) {
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block = U.middleRows<3>(first);
  std::array<double, 3> sigma{};
  singular_values(MatrixView(block.data(), 3, 3), sigma);
  return sigma[0];
}

TEST(TripodFig7, SensitivitiesAreThoseOfForwardKinematics) {  // poses of slides a little off
  const Made& fig = made("fig7");
  const Robot robot = load("3prs").value();
  Workspace work(robot);
  constexpr double h = 1e-6;
  int compared = 0;
  for (const std::size_t k : some_rows(fig.table, 120)) {
    if (!(fig.value("position", k) < 3)) continue;  // not beside the forward locus
    ++compared;
    const ByHand at(fig.value("e1", k), fig.value("e2", k));
    const Eigen::Quaterniond q(at.R);
    const SpatialPose start{at.p, {q.w(), q.x(), q.y(), q.z()}};
    const auto pose_at = [&](std::size_t slide, double by) {
      std::array<double, 3> slides = at.slides;
      slides[slide] += by;
      const Forward found = forward(robot, slides, {.start = start}, work);
      EXPECT_TRUE(found.ok());
      return SE3<double>::from(std::get<SpatialPose>(found.pose));
    };
    Eigen::Matrix<double, 6, 3> U;
    for (std::size_t slide = 0; slide < 3; ++slide) {
      const auto ahead = pose_at(slide, h), behind = pose_at(slide, -h);
      const auto column = static_cast<Eigen::Index>(slide);
      U.col(column).head<3>() = (ahead.p - behind.p) / (2 * h);
      U.col(column).tail<3>() = ahead.R.compose(behind.R.inverse()).log() / (2 * h);
    }
    EXPECT_NEAR(fig.value("position", k) / norm_of(U, 0), 1, 1e-7);
    EXPECT_NEAR(fig.value("rotation", k) / norm_of(U, 3), 1, 1e-7);
  }
  EXPECT_GT(compared, 80);
}

class TripodNorms : public testing::TestWithParam<std::pair<const char*, std::size_t>> {};

INSTANTIATE_TEST_SUITE_P(Both, TripodNorms, testing::Values(std::pair{"fig6", 9U}, std::pair{"fig7", 12U}),
                         [](const auto& given) { return std::string(given.param.first); });

TEST_P(TripodNorms, EveryClaimThatCanBeCheckedHolds) {
  const auto& [name, count] = GetParam();
  const Reproduction& found = made(name).reproduction;
  EXPECT_EQ(found.findings.size(), count);
  for (const Finding& finding : found.findings)
    EXPECT_TRUE(finding.verdict == "holds" || finding.verdict == "for information")
        << finding.quantity << ": " << finding.ours << ", " << finding.difference;
}

// ---------------------------------------------------------------- files

class TripodFigure : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(All, TripodFigure, testing::Values("fig4", "fig5", "fig6", "fig7"),
                         [](const auto& given) { return std::string(given.param); });

TEST_P(TripodFigure, FilesAreValidAndTheSameBytesTheSecondTime) {
  const std::string name = GetParam();
  const Made& first = made(name);
  const fs::path at = first.folder.path / "3pfs";
  EXPECT_EQ(first.reproduction.files,
            (std::vector<fs::path>{at / (name + ".csv"), at / (name + ".md"), at / (name + ".gp"),
                                   at / (name + ".svg"), at / (name + ".png")}));
  const std::string png = bytes(at / (name + ".png")), svg = bytes(at / (name + ".svg"));
  ASSERT_GT(png.size(), 50000U);
  EXPECT_TRUE(png.starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  // of the others table, findings and script are compared below, and pictures thoroughly
  if (name != "fig4" && !is_thorough()) return;
  const Made second(name);
  ASSERT_EQ(second.reproduction.files.size(), first.reproduction.files.size());
  for (std::size_t i = 0; i < first.reproduction.files.size(); ++i)
    EXPECT_EQ(bytes(second.reproduction.files[i]), bytes(first.reproduction.files[i])) << i;
}

TEST_P(TripodFigure, WithoutGnuplotTheTableTheFindingsAndTheScriptStay) {
  const Folder folder;
  const EmptyPath nothing;
  const std::string name = GetParam();
  const auto without = reproduce("3pfs/" + name, folder.path);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().front().code, "gnuplot_missing");
  for (const char* ending : {".csv", ".md", ".gp"})
    EXPECT_EQ(bytes(folder.path / "3pfs" / (name + ending)),
              bytes(made(name).folder.path / "3pfs" / (name + ending)))
        << ending;
  EXPECT_FALSE(fs::exists(folder.path / "3pfs" / (name + ".png")));
}

TEST_P(TripodFigure, AFolderThatCannotBeWrittenIsAnError) {
  const Folder folder;
  std::ofstream(folder.path / "file") << "no folder";
  const auto without = reproduce(std::string("3pfs/") + GetParam(), folder.path / "file");
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().front().code, "file_unwritable");
}

// ---------------------------------------------------------------- lines over maps

/// f(x, y) over −1 … 1.
template <class F>
HeatMap map_of(const F& f) {
  std::vector<double> values;
  for (const double y : tripod::places())
    for (const double x : tripod::places()) values.push_back(f(x, y));
  return tripod::map_of(std::move(values), "");
}

TEST(Contour, AValueIsWrittenOnItsLineWhichLeavesRoomForIt) {
  Panel panel = tripod::plane("");
  panel.map = map_of([](double x, double y) { return x + 0 * y; });
  contour::add(panel, {{{-0.5}, {180}}, {{0.5}, {0, 90}}});
  ASSERT_EQ(panel.notes.size(), 2U);  // none upwards
  EXPECT_EQ(panel.notes[0].text, "−0.5");
  EXPECT_NEAR(panel.notes[0].x, -0.5, 1e-3);
  EXPECT_EQ(panel.notes[0].colour, Colour::white);
  EXPECT_EQ(panel.notes[1].colour, Colour::black);
  for (const Series& line : panel.series)
    for (std::size_t k = 0; k < line.x.size(); ++k)
      EXPECT_TRUE(std::isnan(line.x[k]) || std::abs(line.y[k]) > 0.04);
}

TEST(Contour, SpreadKeepsTheMapAndFillsBesideIt) {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  const HeatMap map{.x = {0, 1, 2, 3},
                    .y = {0, 1},
                    .values = {1, 3, missing, missing, 1, 3, missing, missing},
                    .label = {}};
  const HeatMap wider = contour::spread(map, 1);
  EXPECT_EQ(wider.values[1], 3);
  EXPECT_EQ(wider.values[2], 3);
  EXPECT_TRUE(std::isnan(wider.values[3]));
  EXPECT_EQ(contour::spread(map, 2).values[3], 3);
}

TEST(Figure, OutsideOfAMapIsThePage) {
  Panel panel = tripod::plane("");
  panel.series = {tripod::circle(0.5, Mark::outside, Colour::white, 1)};
  const auto script = [&] { return gnuplot_script({.title = {}, .panels = {panel}, .comments = {}}, "it"); };
  EXPECT_EQ(script().find("filledcurves"), std::string::npos);  // no map: nothing to cover
  panel.map = map_of([](double x, double y) { return 2 + x + y; });
  EXPECT_NE(script().find("filledcurves closed lc rgb '#ffffff'"), std::string::npos);
  EXPECT_NE(script().find("\n-1.01 -1.01\n-1.01 1.01\n1.01 1.01\n1.01 -1.01\n-1.01 -1.01\n0.5 0\n"),
            std::string::npos);
  EXPECT_EQ(script().find("set logscale cb"), std::string::npos);
  panel.map->log = true;
  EXPECT_NE(script().find("set logscale cb"), std::string::npos);
  EXPECT_NE(script().find("unset logscale cb"), std::string::npos);
}

}  // namespace tripod_figures_test
