#include <gtest/gtest.h>

#include <filesystem>

#include "command.hpp"

namespace sinew::test {
namespace plan_figure_test {

/// Two rows of a plan of nottingham-tpcj, straight on.
std::string straight_plan() {
  std::string names = "stage[m]", zeros;
  for (int m = 0; m < 5; ++m)
    for (int c = 1; c <= 2; ++c) {
      names += ",S" + std::to_string(m) + "_beta_" + std::to_string(c) + "[rad]";
      zeros += ",0";
    }
  return names + "\n0" + zeros + "\n0.001" + zeros + "\n";
}

class PlanFigure : public testing::Test {
 protected:
  void SetUp() override {
    write_text(here.path() / "plan.csv", straight_plan());
    write_text(here.path() / "wall.yaml", run_command({"new", "scene"}, here.path()).out);
  }
  Outcome plot(std::vector<std::string> more) {
    std::vector<std::string> words{"plot", "wall.yaml", "--along", "plan.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return run_command(words, here.path());
  }
  Scratch here;
};

#ifdef SINEW_WITH_PLAN
TEST_F(PlanFigure, IsDrawnAsPhasesOrCurves) {
  for (const char* kind : {"phases", "line"}) {
    const Outcome outcome = plot({"--as", kind, "-o", std::string(kind) + ".svg", "--title", "in"});
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    EXPECT_GT(std::filesystem::file_size(here.path() / (std::string(kind) + ".svg")), 5000U);
  }
}

TEST_F(PlanFigure, RefusesWhatItCannotDraw) {
  EXPECT_NE(plot({"--as", "map", "-o", "f.svg"}).err.find("phases"), std::string::npos);
  EXPECT_NE(plot({"--x", "a", "-o", "f.svg"}).err.find("no_effect"), std::string::npos);
  EXPECT_NE(plot({"-o", "f.txt"}).err.find("f.txt"), std::string::npos);
  write_text(here.path() / "plan.csv", "a\n1\n");
  EXPECT_NE(plot({"-o", "f.svg"}).err.find("missing_column"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(here.path() / "f.svg"));
}

TEST_F(PlanFigure, TheItemOfThePaperHolds) {
  const Outcome outcome = run_command({"reproduce", "lsk/fig12", "-o", "made"}, here.path());
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("fails"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("differs"), std::string::npos) << outcome.out;
  for (const char* file : {"fig12.csv", "fig12.md", "fig12.svg", "fig12_curves.png"})
    EXPECT_TRUE(std::filesystem::exists(here.path() / "made" / "lsk" / file)) << file;
}
#else
TEST_F(PlanFigure, SaysWhatToInstall) {
  EXPECT_NE(plot({"-o", "f.svg"}).err.find("libfcl-dev"), std::string::npos);
  const Outcome outcome = run_command({"reproduce", "lsk/fig12", "-o", "made"}, here.path());
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_NE(outcome.err.find("libfcl-dev"), std::string::npos);
}
#endif

}  // namespace plan_figure_test
}  // namespace sinew::test
