/// Whatever is wanted, the command shows what there is.
#include <gtest/gtest.h>

#include "command.hpp"

namespace sinew::test {
namespace cli_wants_test {

Outcome run(const std::string& line) {
  std::istringstream words(line);
  std::vector<std::string> command{command_path};
  for (std::string word; words >> word;) command.push_back(word);
  const Scratch scratch;
  return run_program(command, scratch.path());
}

/// As the question says it, and as lists of pairs do.
TEST(Lists, SayNothingOfWhatTheOtherListHolds) {
  const std::string line = "forward tendon-rod --tensions 3,null,-,1 --changes null,0.01,0.01,- --json";
  const Outcome ran = run(line);
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.out.find("\"tensions\":[[3.0,"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find(",0.01,0.01,"), std::string::npos) << ran.out;
  const Outcome both = run("forward tendon-rod --tensions 3,2,-,1 --changes -,0.01,0.01,-");
  EXPECT_EQ(both.exit, 2);
  EXPECT_NE(both.err.find("tendon 1 has a tension and a change"), std::string::npos) << both.err;
  const Outcome third = run("forward tendon-rod --tensions null,null,3_N");
  EXPECT_EQ(third.exit, 2);
  EXPECT_NE(third.err.find("--tensions, value 3"), std::string::npos) << third.err;
  const Outcome serial = run("forward nottingham-neutral --changes null,0,0");
  EXPECT_EQ(serial.exit, 2) << serial.out << serial.err;
}

/// A new robot is a row: every command that takes a robot alone takes this one.
TEST(Robots, AreDrawnCheckedAndShown) {
  const Scratch scratch;
  for (const auto& file :
       std::filesystem::directory_iterator(std::filesystem::path(source_folder) / "robots")) {
    const std::string robot = file.path().string();
    const Outcome plotted =
        run_program({command_path, "plot", robot, "-o", "robot.svg", "-q"}, scratch.path());
    EXPECT_EQ(plotted.exit, 0) << robot << '\n' << plotted.err;
    EXPECT_NE(read_text(scratch.path() / "robot.svg").find("</svg>"), std::string::npos) << robot;
    const Outcome checked = run_program({command_path, "check", robot}, scratch.path());
    EXPECT_EQ(checked.exit, 0) << robot << '\n' << checked.err;
    const Outcome solid =
        run_program({command_path, "plot", robot, "--as", "3d", "-o", "robot.svg", "-q"}, scratch.path());
    EXPECT_TRUE(solid.exit == 0 || solid.err.find("moves in a plane") != std::string::npos) << robot;
  }
}

TEST(Wants, AreShownWhateverTheyLeaveOut) {
  const char* lines[] = {
      "forward 3-rfr --inputs 0.19,0.19,0.188",
      "forward 3-rfr --inputs 0.19,0.19,0.188 --all",
      "forward 3-rfr --model prb --inputs 0.19,0.19,0.188",
      "forward 3pfs-g2 --inputs 0.44,0.42,0.41",
      "forward 3prs --inputs 0.17,0.17,0.17",
      "forward nottingham-neutral --configuration 0.2,0.1",
      "inverse 3-rfr --pose 0,0,0",
      "inverse 3-rfr --model prb --pose 0.01,0,0.1",
      "inverse 3pfs-g2 --independent 0.39,0.1,0.05",
      "inverse hexapod --pose 0,0,0.4,0,0,0",
      "analyse 3-rfr --pose 0.01,0,0.1",
      "analyse 3-rfr --model prb --pose 0.01,0,0.1",
      "analyse 3pfs-g2 --inputs 0.44,0.42,0.41",
      "statics 3-rfr --set-at 0.01,0,0.3 --wrench 0,-0.01,0",
      "statics hexapod --inputs 0.41,0.41,0.405,0.405,0.405,0.405 --axial-forces 0.1,-0.2,0,0,0.1,0",
  };
  for (const char* line : lines)
    for (const char* want : {"pose", "legs", "pose,legs", "velocity", "shape", "stiffness", "stability",
                             "margins", "sensitivity", "lines", "modes"}) {
      const Outcome ran = run(std::string(line) + " --want " + want);
      EXPECT_TRUE(ran.exit == 0 || ran.exit == 3) << line << " --want " << want << ": " << ran.exit << '\n'
                                                  << ran.err;
      EXPECT_TRUE(ran.exit != 0 || !ran.out.empty()) << line << " --want " << want;
    }
}

TEST(Wants, OfVelocityHaveTheirTable) {
  const Outcome ran = run("forward 3-rfr --inputs 0.19,0.19,0.188 --want velocity --twist 1,0,0");
  EXPECT_NE(ran.out.find("rate"), std::string::npos) << ran.out;
}

}  // namespace cli_wants_test
}  // namespace sinew::test
