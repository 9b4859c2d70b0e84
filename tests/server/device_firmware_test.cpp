/// The panel at the real firmware: whatever is asked of it in whatever order, no drive moves that may not.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "device_board.hpp"
#include "device_way.hpp"

namespace sinew::server::device {
namespace device_firmware_test {

using Random = std::mt19937;

double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}
bool happens(Random& random, double share) { return uniform(random, 0, 1) < share; }

/// Two pages that press whatever they like, and what the first of all rules says of it.
class Fuzz {
 public:
  explicit Fuzz(Random& random) : random_(random) {
    board_.seen = [this] { look(); };
    board_.run(0.2);
  }

  void set_zeros() {
    EXPECT_TRUE(board_.set_zeros());
    board_.run(0.05);
    positions_ = board_.drives.positions;
  }
  void order() {
    const double now = board_.now();
    if (happens(random_, 0.6)) renew(now);
    switch (random_() % 14) {
      case 0:
        if (std::string secret = happens(random_, 0.5) ? secret_ : "";
            !board_.panel.lease(secret, number_, now))
          secret_ = secret;
        break;
      case 1:
        if (happens(random_, 0.02) && !board_.panel.release(any_secret(), now)) stops(now);
        break;
      case 2:
      case 3:
        board_.panel.arm(any_secret(), now);
        break;
      case 4:
        if (happens(random_, 0.03) && !board_.panel.disarm(any_secret(), now)) stops(now);
        break;
      case 5:
        if (happens(random_, 0.05) && !board_.panel.hold(now)) stops(now);
        break;
      case 6:
        set_target(now);
        break;
      case 7:
        board_.panel.set_speed(any_secret(), uniform(random_, 0, 0.025), now);
        break;
      case 8:
        fault();
        break;
      case 9:
      case 10:
        set_plan(now);
        break;
      default:
        press(now);
    }
    board_.run(happens(random_, 0.002) ? 0.45 : uniform(random_, 0, 0.007));
  }
  long moved = 0, wrong = 0, orders = 0, armed = 0, plans = 0, followed = 0;
  Board& board() { return board_; }

 private:
  std::string any_secret() { return happens(random_, 0.95) ? secret_ : "0123"; }
  void renew(double now) {
    std::string secret = secret_;
    if (!secret.empty()) board_.panel.lease(secret, number_, now);
  }
  void set_target(double now) {
    Bends bends;
    for (int m = 0; m < 5; ++m)
      bends.emplace_back(uniform(random_, -0.45, 0.45), uniform(random_, -0.4, 0.4));
    board_.panel.set_target(any_secret(), bends, uniform(random_, -0.01, 0.1), now);
  }
  /// From where the arm is, or from anywhere; or none.
  void set_plan(double now) {
    if (!happens(random_, 0.05)) return;
    if (happens(random_, 0.1)) {
      board_.panel.drop_plan(any_secret(), now);
      return;
    }
    const auto frame = board_.panel.frame(now);
    DrivePlan plan{"random", {{Bends(5, Bend(0, 0)), frame["stage"]}}, {}};
    for (std::size_t m = 0; m < 5; ++m)
      if (const auto& measured = frame["sections"][m]["measured"]; measured.is_array())
        plan.steps[0].bends[m] = Bend(measured[0], measured[1]);
    for (int k = 0; k < 50; ++k) {
      Posture next = plan.steps.back();
      next.stage += uniform(random_, -1e-4, 1e-3);
      for (Bend& bend : next.bends)
        bend += Bend(uniform(random_, -0.03, 0.03), uniform(random_, -0.03, 0.03));
      if (happens(random_, 0.001)) next.stage = 100;
      plan.steps.push_back(next);
    }
    plans += !board_.panel.load_plan(any_secret(), plan, now);
  }
  void press(double now) {
    constexpr Activity buttons[] = {Activity::moving,  Activity::straighten, Activity::retract,
                                    Activity::advance, Activity::relax,      Activity::homing,
                                    Activity::follow,  Activity::follow,     Activity::follow_back};
    if (now < silent_until_) return;  // fingers off, without a word; the page goes on
    if (happens(random_, 0.02)) silent_until_ = now + 0.5;
    // Fingers stay on a button for a while.
    if (happens(random_, 0.03)) button_ = buttons[random_() % std::size(buttons)];
    const bool is_held = !happens(random_, 0.03);
    const Activity before = board_.panel.activity();
    const std::string secret = any_secret();
    const Outcome outcome = board_.panel.press(button_, secret, is_held, now, random_() % 6);
    if (outcome) return;
    if (is_held) {
      const bool needs_arms = button_ != Activity::relax && button_ != Activity::homing;
      EXPECT_TRUE(secret == secret_ && !secret.empty());
      EXPECT_TRUE(!needs_arms || (board_.panel.mode() == Mode::armed && board_.drives.are_enabled() &&
                                  board_.panel.is_homed()));
      allowed_until_ = now + 0.3 + settle;
      return;
    }
    if (before == button_) stops(now);
  }
  void stops(double now) { allowed_until_ = std::min(allowed_until_, now + 0.1); }
  void fault() {
    if (!happens(random_, 0.02)) return;
    switch (random_() % 5) {
      case 0:
        damage_ = 1;
        board_.controller.line = [this](std::uint8_t byte) { return damage_-- == 1 ? byte ^ 8 : byte; };
        break;
      case 1:
        board_.controller.reset();
        break;
      case 2:
        board_.is_plugged = false;
        board_.run(0.1);
        board_.is_plugged = true;
        board_.run(0.6);
        break;
      case 3:
        board_.drives.tension[random_() % 15] = 25;
        break;
      default:
        std::ranges::fill(board_.drives.tension, 0.5);
    }
  }
  void look() {
    armed += board_.panel.mode() == Mode::armed;
    if (positions_ == board_.drives.positions) return;
    positions_ = board_.drives.positions;
    ++moved;
    followed += board_.panel.activity() == Activity::follow;
    const bool may = board_.now() <= allowed_until_;
    wrong += !may;
    if (!may && wrong < 4)
      ADD_FAILURE() << "moved at " << board_.now() << ", allowed until " << allowed_until_ << ", "
                    << name_of(board_.panel.activity());
  }

  /// [s] that the last set-point, and the one that was on its way, need.
  static constexpr double settle = 0.07;

  Random& random_;
  Board board_;
  std::string secret_;
  int number_ = 0, damage_ = 0;
  Activity button_ = Activity::moving;
  double allowed_until_ = -1, silent_until_ = -1;
  std::vector<std::int32_t> positions_ = board_.drives.positions;
};

TEST(DeviceFirmware, NoOrderOfCommandsMovesWhatMayNotMove) {
  Random random(7);
  Fuzz fuzz(random);
  fuzz.set_zeros();
  const int orders = 10'000;
  for (int i = 0; i < orders; ++i) {
    fuzz.order();
    if (fuzz.board().panel.mode() == Mode::view_only && !fuzz.board().panel.is_homed() &&
        fuzz.board().link.is_free() && i % 20 == 0)
      fuzz.set_zeros();
  }
  EXPECT_EQ(fuzz.wrong, 0);
  EXPECT_GT(fuzz.moved, orders / 20) << "it has to move at all";
  EXPECT_GT(fuzz.armed, orders / 20);
  EXPECT_GT(fuzz.plans, 10);
  EXPECT_GT(fuzz.followed, 100);
  RecordProperty("moved_ms", static_cast<int>(fuzz.moved));
  std::printf("%d orders, %.0f s, %ld ms armed, %ld ms moving, %ld plans, %ld ms along them\n", orders,
              fuzz.board().now(), fuzz.armed, fuzz.moved, fuzz.plans, fuzz.followed);
}

/// A page that renews its lease and holds a button.
struct Page {
  explicit Page(Board& board) : board(board) {
    board.seen = [this] {
      if (this->board.now() < next || !is_alive) return;
      next = this->board.now() + 0.1;
      int number = 0;
      if (!secret.empty()) this->board.panel.lease(secret, number, this->board.now());
      if (held) this->board.panel.press(*held, secret, true, this->board.now());
    };
  }
  std::string code(const Outcome& outcome) { return outcome ? outcome->code : ""; }
  void let_go() {
    if (held) board.panel.press(*held, secret, false, board.now());
    held.reset();
  }
  void make_ready() {
    board.run(0.2);
    ASSERT_TRUE(board.set_zeros());
    board.run(0.7);
    int number = 0;
    ASSERT_EQ(code(board.panel.lease(secret, number, board.now())), "");
    ASSERT_EQ(code(board.panel.arm(secret, board.now())), "");
    board.run(0.1);
    ASSERT_EQ(board.panel.mode(), Mode::armed) << board.panel.why();
    ASSERT_EQ(code(board.panel.set_target(secret, Bends(5, Bend(0.2, 0.1)), 0.004, board.now())), "");
  }
  Board& board;
  std::string secret;
  std::optional<Activity> held;
  double next = 0;
  bool is_alive = true;
};

TEST(DeviceFirmware, SilenceOfTheHostDisablesTheDrivesIn200Ms) {
  Board board;
  Page page(board);
  page.make_ready();
  page.held = Activity::moving;
  board.run(0.3);
  EXPECT_TRUE(board.drives.are_enabled());
  board.is_host_alive = false;
  board.run(0.19);
  EXPECT_TRUE(board.drives.are_enabled());
  board.run(0.03);
  EXPECT_FALSE(board.drives.are_enabled());
  const long changes = board.drives.changes;
  board.is_host_alive = true;
  board.run(0.3);
  EXPECT_EQ(board.panel.mode(), Mode::control);
  EXPECT_EQ(board.drives.changes, changes);
}

TEST(DeviceFirmware, ReleaseStopsItWithin100Ms) {
  Board board;
  Page page(board);
  page.make_ready();
  page.held = Activity::moving;
  board.run(0.5);
  EXPECT_GT(board.drives.changes, 100);
  page.let_go();
  board.run(0.1);
  const auto there = board.drives.positions;
  board.run(0.5);
  EXPECT_EQ(board.drives.positions, there);
  EXPECT_EQ(board.panel.mode(), Mode::armed);
  board.panel.set_speed(page.secret, 10e-3, board.now());
  page.held = Activity::moving;
  board.run(1.5);
  Arm arm = board.panel.robot();  // by the model of its table
  const auto goal = arm.counts({Bends(5, Bend(0.2, 0.1)), 0.004}, true);
  for (std::size_t i = 0; i < SpringDrives::tendons; ++i)
    EXPECT_NEAR(board.drives.positions[i], goal[i], 40) << i;
}

TEST(DeviceFirmware, OverTensionStopsAndOnlyPayingOutIsLeft) {
  Board board;
  Page page(board);
  page.make_ready();
  page.held = Activity::moving;
  board.run(0.4);
  board.drives.tension[4] = 25;
  board.run(0.04);
  const auto there = board.drives.positions;
  board.run(0.3);
  EXPECT_EQ(board.drives.positions, there);
  EXPECT_FALSE(board.drives.are_enabled());
  const auto frame = board.panel.frame(board.now());
  EXPECT_EQ(frame["sections"][1]["word"], "OVER-TENSIONED");
  EXPECT_EQ(frame["state"], "control");
  EXPECT_EQ(page.code(board.panel.arm(page.secret, board.now())), "over_tension");
}

TEST(DeviceFirmware, NoiseOnTheLineDisarmsAndIsCounted) {
  Board board;
  Page page(board);
  page.make_ready();
  page.held = Activity::moving;
  board.run(0.3);
  int left = 30;
  board.controller.line = [&left](std::uint8_t byte) { return left > 0 && --left == 0 ? byte ^ 0x10 : byte; };
  board.run(0.3);
  EXPECT_EQ(board.panel.mode(), Mode::control);
  EXPECT_FALSE(board.drives.are_enabled());
  EXPECT_EQ(board.link.figures().errors, 1) << board.panel.why();
  EXPECT_EQ(board.panel.frame(board.now())["link"], "bad_checksum");
  board.run(1.2);
  EXPECT_EQ(board.panel.frame(board.now())["link"], "ok");
}

TEST(DeviceFirmware, AnotherRobotsTableIsToldAndNothingIsAsked) {
  Board board("{lead: 2 mm, counts: 2048}");
  board.run(0.3);
  const long lines = board.link.figures().lines;
  board.run(0.3);
  EXPECT_EQ(board.link.figures().lines, lines);
  EXPECT_EQ(board.panel.frame(board.now())["link"], "wrong_table");
  EXPECT_EQ(board.panel.frame(board.now())["message"], "the firmware has another robot's table");
  std::string secret;
  int number = 0;
  board.panel.lease(secret, number, board.now());
  EXPECT_EQ(board.panel.arm(secret, board.now())->code, "wrong_table");
}

TEST(DeviceFirmware, ACutTendonIsToldThoughItsDriveFollows) {
  Board board;
  Page page(board);
  page.make_ready();
  board.drives.tension[7] = 0;
  board.run(0.2);
  const auto section = board.panel.frame(board.now())["sections"][2];
  EXPECT_EQ(section["word"], "PARTLY SLACK");
  EXPECT_EQ(section["class"], "exact") << "as far as encoders see";
  EXPECT_EQ(section["advice"], "Look at tendon 2: no tension");
}

TEST(DeviceFirmware, HomingSetsTheZerosAtThePretension) {
  Board board;
  Page page(board);
  std::vector<double> zeros;  // counts of the drives
  for (std::size_t i = 0; i < SpringDrives::tendons; ++i)
    zeros.push_back(1000.0 * static_cast<double>(i % 4) - 1500);
  const auto fingers = board.seen;
  board.seen = [&] {
    fingers();
    for (std::size_t i = 0; i < zeros.size(); ++i)
      board.drives.tension[i] = std::max(0.0, 1e-3 * (zeros[i] - board.drives.positions[i]));  // 2 N/mm
  };
  board.run(0.7);
  int number = 0;
  ASSERT_EQ(page.code(board.panel.lease(page.secret, number, board.now())), "");
  ASSERT_EQ(page.code(board.panel.set_speed(page.secret, 10e-3, board.now())), "");
  page.held = Activity::homing;
  for (int i = 0; i < 60 && !board.panel.is_homed(); ++i) board.run(1);
  EXPECT_TRUE(board.panel.is_homed()) << board.panel.why();
  board.run(0.3);
  for (std::size_t i = 0; i < zeros.size(); ++i)
    EXPECT_NEAR(board.drives.positions[i], zeros[i] - 5100, 120) << i << ": at 5 N";
  EXPECT_FALSE(board.drives.are_enabled()) << "it was not armed: the drives let go";
  page.let_go();
  EXPECT_EQ(page.code(board.panel.arm(page.secret, board.now())), "");
}

TEST(DeviceFirmware, TheWayInSurvivesALineThatWasAway) {
  Board board;
  Page page(board);
  page.make_ready();
  board.panel.set_speed(page.secret, 10e-3, board.now());
  page.held = Activity::moving;
  board.run(1);
  page.let_go();
  const std::int32_t stage = board.drives.positions[15];
  EXPECT_GT(stage, 2000);
  board.is_plugged = false;
  board.run(0.4);
  EXPECT_EQ(board.panel.why(), "unplugged");
  EXPECT_FALSE(board.drives.are_enabled()) << "by itself";
  board.is_plugged = true;
  board.run(1.5);
  EXPECT_EQ(page.code(board.panel.arm(page.secret, board.now())), "");
  board.run(0.1);
  page.held = Activity::retract;
  board.run(1.5);
  EXPECT_LT(std::abs(board.drives.positions[15]), 20) << board.panel.why();
  EXPECT_LT(std::abs(board.drives.positions[0]), 20);
}

TEST(DeviceFirmware, APlanIsFollowedPausedAndRetracted) {
  Board board;
  Page page(board);
  page.make_ready();
  DrivePlan plan{"bent", {}, {}};
  for (int k = 0; k <= 40; ++k) {
    plan.steps.push_back({Bends(5, Bend(0, 0)), 5e-4 * k});
    plan.steps.back().bends[4] = Bend(0.008 * k, 0.05 * std::sin(0.2 * k));
  }
  ASSERT_EQ(page.code(board.panel.load_plan(page.secret, plan, board.now())), "");
  board.panel.set_speed(page.secret, 10e-3, board.now());
  const auto off = [&] {
    const auto frame = board.panel.frame(board.now());
    Posture measured{{}, frame["stage"]};
    for (const auto& section : frame["sections"])
      measured.bends.emplace_back(section["measured"][0], section["measured"][1]);
    return share_off(measured, plan.steps);
  };
  for (int i = 0; i < 4; ++i) {
    page.held = Activity::follow;
    for (int k = 0; k < 12; ++k) {
      board.run(0.025);
      EXPECT_LT(off(), 0.2) << "while it moves";
    }
    page.held.reset();
    board.panel.press(Activity::follow, page.secret, false, board.now());
    board.run(0.15);
    const auto there = board.drives.positions;
    EXPECT_LT(off(), 2 * rounding) << "paused on the path; rounded when it was asked, and when it was told";
    board.run(0.2);
    EXPECT_EQ(board.drives.positions, there);
  }
  EXPECT_GT(board.drives.positions[15], 5000) << board.panel.why();
  page.held = Activity::retract;
  board.run(4);
  EXPECT_LT(std::abs(board.drives.positions[15]), 20) << board.panel.why();
  EXPECT_LT(off(), 2 * rounding);
}

TEST(DeviceFirmware, AResetForgetsTheZeros) {
  Board board;
  Page page(board);
  page.make_ready();
  board.controller.reset();
  board.run(0.5);
  EXPECT_EQ(board.panel.mode(), Mode::control);
  EXPECT_FALSE(board.panel.is_homed());
  EXPECT_EQ(page.code(board.panel.arm(page.secret, board.now())), "not_homed");
}

}  // namespace device_firmware_test
}  // namespace sinew::server::device
