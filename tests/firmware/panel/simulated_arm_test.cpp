/// The simulated arm's drives and what can happen to its tendons.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "paths.hpp"
#include "simulator/faults.hpp"
#include "simulator/simulated_arm.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::firmware {
namespace simulated_arm_test {

using Setpoints = std::vector<std::int32_t>;
constexpr double counts_per_metre = 4096 / 2e-3;

struct Bench {
  explicit Bench(const ArmDrives& drives = {}) : arm(*load_serial("nottingham-tpcj"), drives) {}
  void run(double seconds, bool enabled = true) {
    for (int i = 0; i < std::lround(1e3 * seconds); ++i) arm.advance(1e-3, setpoints, enabled);
  }
  nlohmann::json state() const { return nlohmann::json::parse(arm.state()); }
  double paid_out(std::size_t tendon) const { return state()["paid_out"][tendon]; }
  /// All tendons at so much from where the straight arm needs them [m].
  void homed(double beyond) {
    for (std::size_t i = 0; i < 15; ++i)
      setpoints[i] =
          static_cast<std::int32_t>(std::lround((beyond - paid_out(i)) * counts_per_metre)) + arm.count(i);
    run(0.3);
  }

  SimulatedArm arm;
  Setpoints setpoints = Setpoints(16, 0);
};

TEST(SimulatedArm, BeginsStraightWithSlackThatIsSeeded) {
  Bench bench, same;
  ArmDrives other_seed;
  other_seed.seed = 2;
  Bench other(other_seed);
  EXPECT_EQ(bench.arm.state(), same.arm.state());
  EXPECT_NE(bench.arm.state(), other.arm.state());
  for (std::size_t i = 0; i < 15; ++i) {
    EXPECT_GE(bench.paid_out(i), 0.5e-3);
    EXPECT_LE(bench.paid_out(i), 3e-3);
    EXPECT_EQ(bench.arm.count(i), 0);
    EXPECT_EQ(bench.arm.tension(i), 0);
  }
}

TEST(SimulatedArm, MotorsFollowNoFasterThanTheyCanAndOnlyEnabled) {
  ArmDrives drives;
  Bench bench;
  bench.setpoints.assign(16, 1'000'000);
  bench.run(0.05, false);
  EXPECT_EQ(bench.arm.count(3), 0);
  bench.run(0.05);
  EXPECT_NEAR(bench.arm.count(3), 0.05 * drives.speed * counts_per_metre, 1);
  EXPECT_NEAR(bench.arm.count(15), 0.05 * drives.stage_speed * counts_per_metre, 1);
  EXPECT_NEAR(bench.arm.stage(), 0.05 * drives.stage_speed, 1e-6);
  bench.setpoints.assign(16, 100);
  bench.run(1);
  EXPECT_EQ(bench.arm.count(3), 100);
}

TEST(SimulatedArm, BacklashIsLostOnTurningBack) {
  ArmDrives drives;
  Bench bench(drives);
  const double lost = drives.backlash;
  bench.setpoints[0] = 2000;
  bench.run(0.1);
  const double there = bench.paid_out(0);
  bench.setpoints[0] -= static_cast<std::int32_t>(0.9 * lost * counts_per_metre);
  bench.run(0.1);
  EXPECT_EQ(bench.paid_out(0), there);
  bench.setpoints[0] = 0;
  bench.run(0.1);
  EXPECT_NEAR(there - bench.paid_out(0), 2000 / counts_per_metre - lost, 1e-9);
}

TEST(SimulatedArm, TensionRisesWhereSlackEnds) {
  Bench bench;
  const double slack = bench.paid_out(8);
  bench.setpoints[8] = -static_cast<std::int32_t>((slack + 0.005e-3) * counts_per_metre);
  bench.run(0.2);
  EXPECT_EQ(bench.arm.tension(8), 0);  // the backlash is not taken up
  bench.setpoints[8] -= static_cast<std::int32_t>(0.05e-3 * counts_per_metre);
  bench.run(0.2);
  EXPECT_GT(bench.arm.tension(8), 0.01);
}

TEST(SimulatedArm, StuckTendonHoldsTheArmAndNotTheMotor) {
  Bench bench;
  bench.homed(-0.02e-3);
  bench.setpoints[13] -= 4000;
  bench.setpoints[12] += 3000;
  bench.setpoints[14] += 3000;
  bench.run(0.3);
  const Bend bent = bench.arm.bends()[4];
  EXPECT_GT(bent.norm(), 0.1);
  const double tension = bench.arm.tension(13);
  bench.arm.stick(13);
  bench.run(0.01);
  EXPECT_NEAR(bench.arm.tension(13), tension, 1e-3);
  bench.setpoints[13] += 4000;  // pays out, and it does not go
  bench.run(0.3);
  EXPECT_EQ(bench.arm.tension(13), 0);
  EXPECT_LT((bench.arm.bends()[4] - bent).norm(), 0.01);
  bench.setpoints[13] -= 6000;  // pulls against it
  bench.run(0.4);
  EXPECT_GT(bench.arm.tension(13), 20);
  EXPECT_LT((bench.arm.bends()[4] - bent).norm(), 0.01);
  bench.arm.free();
  bench.run(0.1);
  EXPECT_GT((bench.arm.bends()[4] - bent).norm(), 0.02);
}

TEST(SimulatedArm, CutTendonIsSlackUntilMended) {
  Bench bench;
  bench.homed(-0.05e-3);
  EXPECT_GT(bench.arm.tension(14), 1);
  const double straight = bench.arm.bends()[4].norm();
  bench.arm.cut(14);
  bench.run(0.01);
  EXPECT_EQ(bench.arm.tension(14), 0);
  EXPECT_GT(bench.arm.bends()[4].norm(), straight + 3e-3);  // the two others pull
  bench.arm.mend();
  bench.run(0.01);
  EXPECT_GT(bench.arm.tension(14), 0.5);
}

TEST(SimulatedArm, StateIsJson) {
  Bench bench;
  bench.arm.cut(3);
  bench.arm.stick(7);
  const auto state = bench.state();
  EXPECT_EQ(state["bends"].size(), 5u);
  EXPECT_EQ(state["bends"][0].size(), 2u);
  EXPECT_EQ(state["tensions"].size(), 15u);
  EXPECT_EQ(state["counts"].size(), 16u);
  EXPECT_EQ(state["cut"], std::vector<int>{3});
  EXPECT_EQ(state["stuck"], std::vector<int>{7});
  EXPECT_EQ(state["stage"], 0.0);
}

TEST(Faults, LinesAreObeyedOrSayWhatIsWrong) {
  Controller controller(std::string(test::firmware_folder) + "/sinew-firmware-panel.elf");
  Bench bench;
  Faults faults(controller, &bench.arm, std::vector<int>(5, 3));
  EXPECT_EQ(faults.obey("cut 3 1"), "ok");
  EXPECT_EQ(faults.obey("stick 5 3"), "ok");
  EXPECT_EQ(bench.state()["cut"], std::vector<int>{6});
  EXPECT_EQ(bench.state()["stuck"], std::vector<int>{14});
  for (const char* good : {"mend", "free", "noise 0", "unplug", "plug", "reset"})
    EXPECT_EQ(faults.obey(good), "ok");
  EXPECT_EQ(bench.state()["cut"].size() + bench.state()["stuck"].size(), 0u);
  for (const char* bad : {"", "cut", "cut 3", "cut 0 1", "cut 6 1", "cut 1 4", "cut 1 1 1", "cut x y",
                          "noise", "noise 2", "noise -1", "mend 1", "explode"})
    EXPECT_TRUE(faults.obey(bad).starts_with("? ")) << bad;
  EXPECT_FALSE(faults.has_quit());
  EXPECT_EQ(faults.obey("quit"), "ok");
  EXPECT_TRUE(faults.has_quit());
  Faults without(controller, nullptr, {});
  EXPECT_EQ(without.obey("cut 1 1"), "? there is no arm");
}

TEST(Faults, NoiseHasItsShare) {
  Controller controller(std::string(test::firmware_folder) + "/sinew-firmware-panel.elf");
  Faults faults(controller, nullptr, {});
  const std::string bytes(100'000, 'a');
  EXPECT_EQ(faults.on_line(bytes), bytes);
  faults.obey("noise 0.02");
  const std::string noisy = faults.on_line(bytes);
  EXPECT_NEAR(static_cast<double>(100'000 - std::ranges::count(noisy, 'a')), 2000, 200);
  faults.obey("unplug");
  EXPECT_EQ(faults.on_line(bytes), "");
}

}  // namespace simulated_arm_test
}  // namespace sinew::firmware
