/// The whole way: the panel, the firmware on a simulated controller, and the simulated arm. Whether it is
/// where it says it is.
#include <gtest/gtest.h>

#include "device_board.hpp"
#include "simulator/drives.hpp"
#include "simulator/simulated_arm.hpp"
#include "sinew/io/robot_file.hpp"
#include "thorough.hpp"

namespace sinew::server::device {
namespace device_arm_test {

/// Drives that a simulated arm hangs on.
class ArmDrives {
 public:
  explicit ArmDrives(firmware::Controller& controller) : drives_(controller, 16, 15) {
    drives_.follow_at_once = false;
  }
  void advance() {
    arm.advance(1e-3, drives_.setpoints, drives_.are_enabled());
    for (std::size_t i = 0; i < arm.drive_count(); ++i) drives_.positions[i] = arm.count(i);
    for (std::size_t i = 0; i < arm.tendon_count(); ++i)
      drives_.tensions[i] = static_cast<std::uint16_t>(std::min(256 * arm.tension(i) + 0.5, 65535.0));
  }
  firmware::SimulatedArm arm{load_serial("nottingham-tpcj").value(), {.seed = seed}};
  static inline unsigned seed = 1;  ///< of the slack with which tendons begin

 private:
  firmware::Drives drives_;
};

struct Desk {
  Desk() {
    board.seen = [this] {
      board.drives.advance();
      for (std::size_t i = 0; i < 15; ++i) most = std::max(most, board.drives.arm.tension(i));
      if (board.now() < next) return;
      next = board.now() + 0.1;
      int number = 0;
      if (!secret.empty()) board.panel.lease(secret, number, board.now());
      if (held) board.panel.press(*held, secret, true, board.now());
    };
    board.run(0.7);
    int number = 0;
    board.panel.lease(secret, number, board.now());
  }
  /// Held until nothing moves any more.
  double hold(Activity activity, double longest = 60) {
    const double start = board.now();
    const Outcome no = board.panel.press(activity, secret, true, start);
    EXPECT_FALSE(no) << no->message;
    held = activity;
    do {
      board.run(0.1);
    } while (board.panel.activity() == activity && board.now() < start + longest);
    let_go();
    return board.now() - start;
  }
  void let_go() {
    if (held) board.panel.press(*held, secret, false, board.now());
    held.reset();
  }
  void go_to(const Bends& bends) {
    ASSERT_FALSE(board.panel.set_target(secret, bends, {}, board.now()));
    hold(Activity::moving, 6);
    board.run(0.8);
  }
  /// How far the true bends are off these [rad].
  double off(const Bends& bends) {
    double max_off = 0;
    for (std::size_t m = 0; m < bends.size(); ++m)
      max_off = std::max(max_off, (board.drives.arm.bends()[m] - bends[m]).cwiseAbs().maxCoeff());
    return max_off;
  }
  double least() {
    double tension = 1e9;
    for (std::size_t i = 0; i < 15; ++i) tension = std::min(tension, board.drives.arm.tension(i));
    return tension;
  }
  std::string words() {
    std::string all;
    const auto frame = board.panel.frame(board.now());
    for (const auto& section : frame["sections"])
      all += section["word"].get<std::string>() + " " + section["class"].get<std::string>() + ", ";
    return all;
  }

  BoardOf<ArmDrives> board;
  std::string secret;
  std::optional<Activity> held;
  double next = 0, most = 0;
};

const std::string all_exact = "EXACT exact, EXACT exact, EXACT exact, EXACT exact, EXACT exact, ";

void home_move_and_home_anew(unsigned seed) {
  ArmDrives::seed = seed;
  Desk desk;
  const double took = desk.hold(Activity::homing);
  desk.board.run(0.8);
  ASSERT_TRUE(desk.board.panel.is_homed()) << desk.board.panel.why();
  const Bends straight(5, Bend(0, 0));
  std::printf("homed in %.1f s; off by %.4f rad, tensions from %.2f N, never above %.2f N\n", took,
              desk.off(straight), desk.least(), desk.most);
  EXPECT_LT(took, 18);
  EXPECT_EQ(desk.words(), all_exact);
  EXPECT_LT(desk.off(straight), 0.005);
  EXPECT_GT(desk.least(), 4);
  EXPECT_LT(desk.most, 8);

  ASSERT_FALSE(desk.board.panel.arm(desk.secret, desk.board.now()));
  desk.board.run(0.1);
  desk.board.panel.set_speed(desk.secret, 10e-3, desk.board.now());
  const std::vector<Bends> moderate = {
      {Bend(0.2, 0.1), Bend(-0.15, 0.2), Bend(0.2, 0.2), Bend(0.1, -0.2), Bend(-0.2, 0.15)},
      {Bend(-0.2, 0.2), Bend(-0.2, 0.2), Bend(-0.2, 0.2), Bend(-0.2, 0.2), Bend(-0.2, 0.2)},
      {Bend(0.2, -0.2), Bend(-0.2, 0.2), Bend(0.2, -0.2), Bend(-0.2, 0.2), Bend(0.2, -0.2)},
      straight};
  for (const Bends& bends : moderate) {
    desk.go_to(bends);
    std::printf("off by %.4f rad, tensions from %.2f N\n", desk.off(bends), desk.least());
    EXPECT_EQ(desk.words(), all_exact);
    EXPECT_LT(desk.off(bends), 0.015);
  }
  std::printf("never above %.2f N\n", desk.most);
  EXPECT_LT(desk.most, 18);
  EXPECT_GT(desk.least(), 3);

  const double again = desk.hold(Activity::homing);
  desk.board.run(0.8);
  std::printf("homed anew in %.1f s; off by %.4f rad, tensions from %.2f N\n", again, desk.off(straight),
              desk.least());
  EXPECT_EQ(desk.words(), all_exact);
  EXPECT_LT(desk.off(straight), 0.005);

  desk.board.drives.arm.cut(6);
  desk.board.run(0.5);
  EXPECT_EQ(desk.board.panel.frame(desk.board.now())["sections"][2]["word"], "PARTLY SLACK");
}

TEST(DeviceArm, IsTautAfterHomingAndWhereItSaysThatItIs) {
  for (int seed = 1; seed <= test::count_of(1, 6); ++seed)
    home_move_and_home_anew(static_cast<unsigned>(seed));
}

/// At the speed at which tendons are sought for, a wall in the place of a tendon.
TEST(DeviceArm, ATendonThatIsStuckStopsTheHomingNearTheLimit) {
  Desk desk;
  desk.board.drives.arm.stick(4);
  desk.hold(Activity::homing);
  std::printf("%s; never above %.2f N\n", desk.board.panel.why().c_str(), desk.most);
  EXPECT_LT(desk.most, 23);
  EXPECT_FALSE(desk.board.panel.is_homed() && desk.words() == all_exact);
}

}  // namespace device_arm_test
}  // namespace sinew::server::device
