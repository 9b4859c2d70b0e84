/// Figs. 9 to 13 and (36) of the flexible tripod: samples against poses solved one by one, the paper's
/// polynomial against its symmetry, the findings and the files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "study/reproduce.hpp"
#include "study/tripod/equation36.hpp"
#include "study/tripod/swept.hpp"
#include "study_folder.hpp"

namespace tripod_parasitic_test {

using namespace sinew;
using namespace sinew::test;
namespace fs = std::filesystem;

/// Studies are run once, and the items find them there.
const fs::path& folder() {
  static const Folder all;
  return all.path;
}

/// One item, made once for all tests that only read.
struct Made {
  Reproduction reproduction;

  explicit Made(const std::string& item) {
    auto made = reproduce("3pfs/" + item, folder());
    EXPECT_TRUE(made) << to_string(made.error());
    if (made) reproduction = *made;
  }
  const Finding& finding(const std::string& start) const {
    static const Finding none;
    const auto found = std::ranges::find_if(reproduction.findings,
                                            [&](const Finding& f) { return f.quantity.starts_with(start); });
    EXPECT_NE(found, reproduction.findings.end()) << start;
    return found == reproduction.findings.end() ? none : *found;
  }
};

const Made& made(const std::string& item) {
  static std::map<std::string, Made> all;
  return all.try_emplace(item, item).first->second;
}

const tripod::Swept& study(const std::string& name) {
  static std::map<std::string, tripod::Swept> all;
  if (!all.contains(name)) all.emplace(name, tripod::swept(name, folder() / "3pfs").value());
  return all.at(name);
}

class FlexibleFigure : public testing::TestWithParam<const char*> {};

TEST_P(FlexibleFigure, IsMadeWithItsFiles) {
  const Made& item = made(GetParam());
  EXPECT_GT(item.reproduction.findings.size(), 5u);
  for (const Finding& finding : item.reproduction.findings) {
    EXPECT_NE(finding.verdict, "fails") << finding.quantity << ": " << finding.ours;
    EXPECT_EQ(finding.ours.find("nan"), std::string::npos) << finding.quantity;
  }
  for (const fs::path& file : item.reproduction.files) EXPECT_GT(fs::file_size(file), 100u) << file;
  for (const char* ending : {".svg", ".png", ".gp", ".md"})
    EXPECT_TRUE(fs::exists(folder() / "3pfs" / (GetParam() + std::string(ending)))) << ending;
}

INSTANTIATE_TEST_SUITE_P(All, FlexibleFigure,
                         testing::Values("fig9", "fig10", "fig11", "fig12", "fig13", "equation36"));

TEST(FlexibleFigures, TurnsAreThePapersWithinFivePercent) {
  const double printed[] = {0.0132, 0.0095, 0.0065};
  const char* heights[] = {"0.2", "0.4", "0.6"};
  for (int i = 0; i < 3; ++i) {
    const Finding& finding =
        made("fig11").finding(std::string("RMSE of e_3, G1, h = ") + heights[i] + " m, 61 poses");
    EXPECT_NEAR(std::stod(finding.ours), printed[i], 0.05 * printed[i]);
    EXPECT_EQ(finding.verdict, "agrees");
  }
}

/// The preset's inputs at three heights, on the hexagon of 61.
TEST(FlexibleFigures, SamplesAreEquilibriaOfTheirInputs) {
  for (const char* name : {"3pfs-g1-parasitic", "3pfs-g2-parasitic"}) {
    const tripod::Swept& swept = study(name);
    ASSERT_EQ(swept.size(), 183u);
    EXPECT_EQ(swept.converged(), 183u);
    const Robot robot = load(std::string(name).substr(0, 7)).value();
    Workspace work(robot);
    for (std::size_t k = 0; k < swept.size(); k += 9) {
      const double sum = swept["L1"][k] + swept["L2"][k] + swept["L3"][k];
      EXPECT_NEAR(sum, 3 * swept["L0"][k], 1e-12);
      const Equilibrium one =
          equilibrium(robot, std::array{swept["L1"][k], swept["L2"][k], swept["L3"][k]}, {}, work);
      ASSERT_TRUE(one.is_solved());
      EXPECT_NEAR(swept["x"][k], one.pose.position.x(), 1e-10);
      EXPECT_NEAR(swept["y"][k], one.pose.position.y(), 1e-10);
      EXPECT_NEAR(swept["e3"][k], one.pose.quaternion[3], 1e-10);
    }
  }
}

TEST(FlexibleFigures, HeightIsKeptByTheInputsFound) {
  const tripod::Swept& swept = study("3pfs-g1-height");
  const Robot robot = load("3pfs-g1").value();
  Workspace work(robot);
  ASSERT_EQ(swept.converged(), swept.size());
  for (std::size_t k = 0; k < swept.size(); k += 41) {
    const Equilibrium one =
        equilibrium(robot, std::array{swept["L1"][k], swept["L2"][k], swept["L3"][k]}, {}, work);
    ASSERT_TRUE(one.is_solved());
    EXPECT_NEAR(one.pose.position.z(), swept["h"][k], 1e-10);
    EXPECT_NEAR(one.pose.quaternion[1], swept["e1"][k], 1e-9);
    EXPECT_NEAR(one.pose.quaternion[2], swept["e2"][k], 1e-9);
  }
}

/// A third of a turn, and the mirror x → −x, which turns e₂ and e₃ about.
/// @verifies 3PFS (36)
TEST(Equation36, LowTermsHaveTheTripodsSymmetry) {
  const double c = -0.5, s = std::sqrt(0.75);
  for (const double size : {0.01, 0.1, 0.25})
    for (int k = 0; k < 12; ++k) {
      const double e1 = size * std::cos(0.3 + k), e2 = size * std::sin(0.3 + k);
      const tripod::Coefficients36 low{1.6, 0.077, 0.24, 0.64, 0, 0, 0};
      const auto one = tripod::equation_36(low, e1, e2), mirrored = tripod::equation_36(low, e1, -e2),
                 turned = tripod::equation_36(low, c * e1 - s * e2, s * e1 + c * e2);
      EXPECT_NEAR(turned.e3, one.e3, 1e-15);
      EXPECT_NEAR(mirrored.e3, -one.e3, 1e-15);
      EXPECT_NEAR(mirrored.x, -one.x, 1e-15);
      EXPECT_NEAR(mirrored.y, one.y, 1e-15);
      // terms of the fifth power that stand with c₂ and c₃ are not symmetric
      const double fifth = 2 * std::pow(size, 4);
      EXPECT_NEAR(turned.x, c * one.x - s * one.y, fifth);
      EXPECT_NEAR(turned.y, s * one.x + c * one.y, fifth);
    }
}

/// The study writes the polynomial as text, the figure as code.
TEST(Equation36, IsTheSameInTheStudyAndInTheFigure) {
  const tripod::Swept& swept = study("3pfs-equation-36");
  for (const auto& [name, literal] : {std::pair{"paper", false}, {"literal", true}}) {
    double x = 0, y = 0;
    for (std::size_t k = 0; k < swept.size(); ++k) {
      const auto at = tripod::equation_36(tripod::printed_36, swept["e1"][k], swept["e2"][k], literal);
      x += (swept["x"][k] - at.x) * (swept["x"][k] - at.x);
      y += (swept["y"][k] - at.y) * (swept["y"][k] - at.y);
    }
    const auto fit = std::ranges::find(swept.summary.fits, name, &FittedTerms::name);
    ASSERT_NE(fit, swept.summary.fits.end());
    EXPECT_NEAR(fit->columns[0].rms, std::sqrt(x / 61), 1e-14);
    EXPECT_NEAR(fit->columns[1].rms, std::sqrt(y / 61), 1e-14);
  }
  const auto turn = std::ranges::find(swept.summary.fits, "paper_turn", &FittedTerms::name);
  EXPECT_LT(turn->columns[0].relative, 0.05);
  const auto paper = std::ranges::find(swept.summary.fits, "paper", &FittedTerms::name);
  EXPECT_LT(paper->columns[0].relative, 0.12);
  EXPECT_LT(paper->columns[1].relative, 0.12);
}

}  // namespace tripod_parasitic_test
