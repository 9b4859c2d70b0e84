// What every exported core has in common. That its bits are the kernel's, tests/fpga tells.
#include <gtest/gtest.h>

#include "io/export/export.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew {
namespace verilog_test {

std::vector<ExportedFile> exported(const std::string& name) {
  SerialRobot robot = load_serial("nottingham-tpcj").value();
  robot.name = name;
  return controller_verilog(make_controller_table(robot).value());
}

TEST(Verilog, NamesAreIdentifiersAndNoKeywords) {
  const auto file = [](const std::string& robot) { return exported(robot).at(0).name; };
  EXPECT_EQ(file("nottingham-tpcj"), "nottingham_tpcj_core.v");
  EXPECT_EQ(file("wire"), "wire_core.v");
  EXPECT_EQ(file("6 arms, long (2)"), "robot_6_arms_long_2_core.v");
  EXPECT_EQ(file("β"), "robot_core.v");
  EXPECT_EQ(file("../a\nmodule"), "a_module_core.v");
}

TEST(Verilog, ACoreComesWithItsTestbench) {
  const auto files = exported("arm");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[1].name, "arm_core_tb.v");
  EXPECT_NE(files[0].text.find("module arm_core ("), std::string::npos);
  EXPECT_NE(files[1].text.find("arm_core core (.clock(clock)"), std::string::npos);
}

TEST(Verilog, EveryWordIsFilledIn) {
  for (const ExportedFile& file : exported("arm"))
    for (std::size_t at = file.text.find('<'); at != file.text.npos; at = file.text.find('<', at + 1))
      EXPECT_TRUE(file.text[at + 1] == '=' || file.text[at + 1] == ' ') << file.text.substr(at, 40);
}

/// Those that tests/golden/good/export_c_header.txt shows.
TEST(Verilog, NumbersAreThoseOfTheHeader) {
  const std::string core = exported("arm").at(0).text;
  for (const char* number : {"hash 90d7d214", "-16'sd18335", "-16'sd16291", "limit <= 16'sd3431"})
    EXPECT_NE(core.find(number), std::string::npos) << number;
}

}  // namespace verilog_test
}  // namespace sinew
