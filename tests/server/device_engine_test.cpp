/// The engine's plan on a device: what the planner found is what is driven, by its own check.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "device_desk.hpp"
#include "device_way.hpp"
#include "io/table/posture_table.hpp"
#include "paths.hpp"
#include "sinew/study/study.hpp"

namespace sinew::server::device {
namespace device_engine_test {

/// What a command prints; it is run in the folder.
std::string run(const std::filesystem::path& folder, const std::string& arguments) {
  const std::string command =
      "cd '" + folder.string() + "' && '" + test::command_path + "' " + arguments + " 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string said;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe.get())) said += part.data();
  return said;
}

std::string row_of(const Posture& posture) {
  std::string row = fmt::format("{:.9g}", posture.stage);
  for (const Bend& bend : posture.bends) row += fmt::format(",{:.9g},{:.9g}", bend[0], bend[1]);
  return row + '\n';
}

TEST(DeviceEngine, IsEnteredAsPlanned) {
#ifndef SINEW_WITH_PLAN
  GTEST_SKIP() << "sinew was built without FCL and assimp: it makes no plans";
#else
  const auto folder = std::filesystem::temp_directory_path() / ("sinew_engine_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  run(folder, "scene compressor -o engine");
  const std::string planned = run(folder, "plan engine/scene.yaml -o plan.csv");
  const auto table = read_result((folder / "plan.csv").string());
  ASSERT_TRUE(table) << planned;
  const auto rows = read_postures(*table, test_arm().robot(), "plan.csv");
  ASSERT_TRUE(rows);
  DrivePlan plan{"engine", {}, {}};
  for (const SerialPosture& row : *rows) plan.steps.push_back({row.bends, row.stage});

  PanelDesk desk;
  desk.take_control();
  desk.arm();
  EXPECT_EQ(desk.code(desk.panel.load_plan(desk.secret, plan, desk.now)), "");
  desk.code(desk.panel.set_speed(desk.secret, 20e-3, desk.now));
  desk.go_to(plan.steps[0].bends, plan.steps[0].stage);
  desk.press(Activity::moving);
  desk.run(1);
  desk.let_go();
  std::string set = "stage[m]";
  for (int m = 0; m < 5; ++m) set += fmt::format(",S{0}_beta_1[rad],S{0}_beta_2[rad]", m);
  set += '\n';
  std::string measured = set;
  double worst_set = 0, worst = 0;
  long points = 0;
  desk.link.asked = [&](const Posture& posture) {
    set += row_of(posture);
    worst_set = std::max(worst_set, share_off(posture, plan.steps));
    ++points;
  };
  const auto is_done = [&] { return desk.panel.frame(desk.now)["plan"]["done"].get<bool>(); };
  for (int i = 0; i < 2000 && !is_done(); ++i) {
    if (i % 50 == 30) desk.let_go();  // paused for a while, now and then
    if (i % 50 == 35) {
      EXPECT_EQ(desk.press(Activity::follow), "") << i;
    }
    if (i == 0) {
      EXPECT_EQ(desk.press(Activity::follow), "");
    }
    desk.run(0.02);
    measured += row_of(desk.link.posture());
    worst = std::max(worst, share_off(desk.link.posture(), plan.steps));
  }
  EXPECT_TRUE(is_done());
  EXPECT_GT(points, 300);
  EXPECT_LT(worst_set, rounding);
  EXPECT_LT(worst, 0.3) << "between set-points the controller goes straight";
  EXPECT_LT(desk.link.fastest, 23e-3);
  std::printf("%ld set-points, off by %.2g of what they may be; the arm by %.2g\n", points, worst_set, worst);
  std::ofstream(folder / "measured.csv") << measured;
  const std::string checked = run(folder, "plan engine/scene.yaml --check measured.csv");
  EXPECT_NE(checked.find("CLEAR"), std::string::npos) << checked;
  EXPECT_EQ(checked.find("TOUCHES"), std::string::npos) << checked;
  EXPECT_EQ(checked.find("LIMIT"), std::string::npos) << checked;
  std::filesystem::remove_all(folder);
#endif
}

}  // namespace device_engine_test
}  // namespace sinew::server::device
