#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "command.hpp"
#include "sinew/io/table.hpp"

namespace sinew::test {
namespace drive_test {

/// A plan of nottingham-tpcj: in by 10 mm a row, with a bend of the last section.
std::string plan(int rows, double bend) {
  std::string text = "stage[m]";
  for (int m = 0; m < 5; ++m)
    for (int c = 1; c <= 2; ++c) text += ",S" + std::to_string(m) + "_beta_" + std::to_string(c) + "[rad]";
  text += '\n';
  for (int k = 0; k < rows; ++k)
    text += std::to_string(0.01 * k) + ",0,0,0,0,0,0,0,0," + std::to_string(bend * k / (rows - 1)) + ",0\n";
  return text;
}

class Drive : public testing::Test {
 protected:
  void SetUp() override { write("plan.csv", plan(4, 0.2)); }
  void write(const std::string& name, const std::string& text) { write_text(here.path() / name, text); }
  Outcome drive(std::vector<std::string> more, const std::string& robot = "nottingham-tpcj",
                const std::string& file = "plan.csv") {
    std::vector<std::string> words{"drive", robot, "--along", file};
    words.insert(words.end(), more.begin(), more.end());
    return run_command(words, here.path());
  }
  Table table(const std::string& name) { return read_csv(here.path() / name).value(); }

  Scratch here;
};

TEST_F(Drive, WritesWhenTheRobotIsWhere) {
  const Outcome outcome = drive({"-o", "drive.csv", "--rate", "100", "--limits", "stage_speed=10 mm/s"});
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("10 mm/s"), std::string::npos) << outcome.out;
  const Table made = table("drive.csv");
  const auto& time = made.find("time")->values;
  const auto& stage = made.find("stage")->values;
  EXPECT_GT(time.back(), 3.0);
  EXPECT_NEAR(stage.back(), 0.03, 1e-12);
  for (std::size_t k = 1; k < time.size(); ++k) {
    EXPECT_GT(time[k], time[k - 1]);
    EXPECT_LE(stage[k] - stage[k - 1], 0.0101 * (time[k] - time[k - 1]) + 1e-9);
  }
}

TEST_F(Drive, OutAgainIsTheWayInBackwards) {
  ASSERT_EQ(drive({"-o", "in.csv", "-q"}).exit, 0);
  ASSERT_EQ(drive({"-o", "out.csv", "-q", "--reverse"}).exit, 0);
  const Table in = table("in.csv"), out = table("out.csv");
  EXPECT_NEAR(in.find("time")->values.back(), out.find("time")->values.back(), 1e-2);
  EXPECT_EQ(in.find("S4_beta_1")->values.back(), out.find("S4_beta_1")->values.front());
  EXPECT_EQ(out.find("stage")->values.back(), 0);
}

TEST_F(Drive, CountsAreWrittenWhereMotorsAreNamed) {
  const std::string motor = R"(motor={"lead": "2 mm", "counts": 4096})";
  for (const char* model : {"lsk", "pcc"}) {
    ASSERT_EQ(drive({"-o", "c.csv", "-q", "--set", motor, "--stage-motor", "{lead: 5 mm, counts: 2000}",
                     "--model", model})
                  .exit,
              0);
    const Table made = table("c.csv");
    const std::string exact = std::string("S4_") + (model[0] == 'l' ? "lsk" : "exact") + "_1";
    EXPECT_EQ(made.find("S4_counts_1")->values.back(),
              std::nearbyint(made.find(exact)->values.back() * 2048e3));
    EXPECT_EQ(made.find("stage_counts")->values.back(), 12000);
  }
}

TEST_F(Drive, WritesHdf5AndRosYaml) {
  ASSERT_EQ(drive({"-o", "d.h5", "-q"}).exit, 0);
  EXPECT_EQ(drive({"-o", "again.csv", "-q"}, "nottingham-tpcj", "d.h5").exit, 0);  // a trajectory is a plan
  ASSERT_EQ(drive({"-o", "d.yaml", "-q"}).exit, 0);
  std::ifstream ros(here.path() / "d.yaml");
  std::string line;
  std::getline(ros, line);
  EXPECT_EQ(line, "# trajectory_msgs/msg/JointTrajectory; m, rad, s");
}

/// The whole way: postures, times, frames on the line, counts of the drives. A thousand a second.
TEST_F(Drive, TheFirmwareFollowsToTheCount) {
  const std::filesystem::path elf =
      std::filesystem::path(command_path).parent_path() / "sinew-firmware-insertion.elf";
  if (!std::filesystem::exists(elf)) GTEST_SKIP() << "the firmware is not built";
  ASSERT_EQ(
      drive({"-o", "d.csv", "-q", "--rate", "1000", "--limits", "stage_speed=20 mm/s, bend_acceleration=10",
             "--set", R"(motor={"lead": "2 mm", "counts": 4096})", "--stage-motor",
             "{lead: 5 mm, counts: 2000}"})
          .exit,
      0);
  const Outcome played = run_shell("sinew-simulate '" + elf.string() + "' --play d.csv", here.path());
  EXPECT_EQ(played.exit, 0) << played.err;
  const std::string rows = std::to_string(table("d.csv").row_count());
  EXPECT_NE(played.out.find(rows + " of " + rows), std::string::npos) << played.out;
}

TEST_F(Drive, ReadsTheUnitsOfColumns) {
  std::string text = plan(4, 0.2);
  ASSERT_EQ(drive({"-o", "si.csv", "-q"}).exit, 0);
  text.replace(text.find("stage[m]"), 8, "stage[cm]");
  write("cm.csv", text);
  ASSERT_EQ(drive({"-o", "cm.out.csv", "-q"}, "nottingham-tpcj", "cm.csv").exit, 0);
  EXPECT_NEAR(100 * table("cm.out.csv").find("stage")->values.back(),
              table("si.csv").find("stage")->values.back(), 1e-12);
  text.replace(text.find("stage[cm]"), 9, "stage[N]");
  write("force.csv", text);
  const Outcome wrong = drive({}, "nottingham-tpcj", "force.csv");
  EXPECT_EQ(wrong.exit, 2);
  EXPECT_NE(wrong.err.find("stage[N]"), std::string::npos) << wrong.err;
}

TEST_F(Drive, RefusesWithAReason) {
  write("far.csv", plan(3, 3));
  write("nan.csv", plan(2, std::nan("")));
  write("none.csv", plan(0, 1));
  write("other.csv", "a,b\n1,2\n");
  const auto refusal = [](const Outcome& outcome, int exit, const std::string& what) {
    EXPECT_EQ(outcome.exit, exit) << what;
    EXPECT_EQ(outcome.out, "") << what;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
  };
  refusal(drive({}, "nottingham-tpcj", "far.csv"), 3, "posture 1: sections[4]");
  EXPECT_NE(drive({"--json"}, "nottingham-tpcj", "far.csv")
                .out.find("{\"status\":\"left_domain\",\"message\":\"posture 1"),
            std::string::npos);
  refusal(drive({}, "nottingham-tpcj", "nan.csv"), 2, "not_a_number");
  refusal(drive({}, "nottingham-tpcj", "none.csv"), 2, "no_rows");
  refusal(drive({}, "nottingham-tpcj", "other.csv"), 2, "missing_column");
  refusal(drive({}, "nottingham-tpcj", "absent.csv"), 2, "file_missing");
  refusal(drive({}, "3-rfr"), 2, "no serial robot");
  refusal(drive({}, "nottingham-neutral"), 2, "S0_theta");
  refusal(drive({"--limits", "stage_sped=1 mm/s"}), 2, "did you mean stage_speed?");
  refusal(drive({"--limits", "stage_speed=1 mm"}), 2, "a speed");
  refusal(drive({"--limits", "stage_speed=0"}), 2, "above 0");
  refusal(drive({"--limits", "stage_speed"}), 2, "NAME=VALUE");
  refusal(drive({"--rate", "0"}), 2, "--rate");
  refusal(drive({"--rate", "fast"}), 2, "--rate");
  refusal(drive({"--rate", "1e6", "--limits", "stage_speed=0.1 um/s"}), 2, "--limits");
  refusal(drive({"--rate", "1e6", "--limits", "stage_speed=0.0001 mm/s"}), 3, "fewer a second");
  refusal(drive({"--model", "exact"}), 2, "--model");
  refusal(drive({"--stage-motor", "{lead: 0, counts: 1}"}), 2, "lead");
  refusal(drive({"--stage-motor", "5"}), 2, "--stage-motor");
  std::string below = plan(3, 0.1);
  below.replace(below.find("\n0.000000"), 9, "\n-0.00100");
  write("below.csv", below);
  refusal(drive({}, "nottingham-tpcj", "below.csv"), 3, "below 0");
  refusal(drive({"-o", "d.yaml", "--model", "pcc"}), 2, "no_effect");
  refusal(drive({"-o", "d.txt"}), 2, "unknown_format");
  refusal(drive({"-o", "nowhere\n/d.csv/"}), 2, "d.csv");
}

}  // namespace drive_test
}  // namespace sinew::test
