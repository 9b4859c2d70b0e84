/// The panel's states: who may move the device, what stops it, and how soon.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "device_desk.hpp"

namespace sinew::server::device {
namespace device_panel_test {

struct Row {
  const char* what;
  std::function<void(PanelDesk&)> before;
  std::function<std::string(PanelDesk&)> command;
  const char* code;
};

std::string pressed(PanelDesk& desk, Activity activity) {
  return desk.code(desk.panel.press(activity, desk.secret, true, desk.now, 1));
}

TEST(DevicePanel, EachCommandHasItsConditions) {
  const auto nothing = [](PanelDesk&) {};
  const auto control = [](PanelDesk& d) { d.take_control(); };
  const auto armed = [](PanelDesk& d) { make_ready(d); };
  const auto press = [](Activity activity) {
    return [activity](PanelDesk& d) { return pressed(d, activity); };
  };
  const auto arm = [](PanelDesk& d) { return d.arm(); };
  const auto after = [](const std::function<void(PanelDesk&)>& first,
                        const std::function<void(PanelDesk&)>& then) {
    return [=](PanelDesk& d) {
      first(d);
      then(d);
      d.run(0.2);
    };
  };
  const auto silent = [](PanelDesk& d) { d.link.is_silent = true; };
  const auto tight = [](PanelDesk& d) { d.link.extra_tension[4] = 25; };
  const auto inserted = [](PanelDesk& d) { d.link.positions[15] = 20'000; };
  const auto held = [](PanelDesk& d) {
    d.press(Activity::moving);
    d.run(0.1);
    d.panel.hold(d.now);
  };
  const Row rows[] = {
      {"without a lease nobody arms", nothing, arm, "not_yours"},
      {"or moves", nothing, press(Activity::moving), "not_yours"},
      {"or relaxes", nothing, press(Activity::relax), "not_yours"},
      {"but anybody holds", nothing, [](PanelDesk& d) { return d.code(d.panel.hold(d.now)); }, ""},
      {"one lease at a time", control, [](PanelDesk& d) { return d.take_control(); }, "lease_taken"},
      {"a lease alone moves nothing", control, press(Activity::moving), "not_armed"},
      {"but relaxes", control, press(Activity::relax), ""},
      {"and homes", control, press(Activity::homing), ""},
      {"and arms", control, arm, ""},
      {"armed moves", armed, press(Activity::moving), ""},
      {"straightens", armed, press(Activity::straighten), ""},
      {"advances", armed, press(Activity::advance), ""},
      {"retracts", armed, press(Activity::retract), ""},
      {"not while inserted", after(inserted, armed), press(Activity::straighten), "inserted"},
      {"a silent line moves nothing", after(control, silent), press(Activity::relax), "no_link"},
      {"an over-tensioned section neither", after(control, tight), arm, "over_tension"},
      {"but it is relaxed", after(control, tight), press(Activity::relax), ""},
      {"after Hold a button is pressed anew", after(armed, held), press(Activity::moving), "release_first"},
      {"a foreign secret is none", [](PanelDesk& d) { d.take_control(), d.secret = "x"; }, arm, "not_yours"},
      {"a bend beyond the limit is no target", armed, [](PanelDesk& d) { return d.go_to(bent(0.5)); },
       "out_of_limits"},
      {"nor is a stage", armed, [](PanelDesk& d) { return d.go_to(bent(0.1), 9.0); }, "out_of_limits"},
  };
  for (const Row& row : rows) {
    PanelDesk desk;
    row.before(desk);
    EXPECT_EQ(row.command(desk), row.code) << row.what << "; disarmed because: " << desk.panel.why();
  }
}

TEST(DevicePanel, WhatIsNotHomedIsNotArmed) {
  PanelDesk desk(false);
  desk.take_control();
  EXPECT_EQ(desk.arm(), "not_homed");
  EXPECT_EQ(desk.panel.mode(), Mode::control);
  EXPECT_EQ(pressed(desk, Activity::moving), "not_armed");
}

TEST(DevicePanel, AForeignTableIsSeenAndNothingIsAsked) {
  PanelDesk desk;
  desk.link.told().hash ^= 1;
  desk.link.unplug();
  desk.run(0.1);
  desk.link.plug();
  desk.link.verbs.clear();
  desk.run(0.2);
  EXPECT_EQ(desk.link.verbs, "");
  desk.take_control();
  EXPECT_EQ(desk.arm(), "wrong_table");
  EXPECT_EQ(desk.panel.frame(desk.now)["link"], "wrong_table");
}

TEST(DevicePanel, MovesAtTheJogSpeedAndStopsWithin100MsOfTheRelease) {
  PanelDesk desk;
  make_ready(desk);
  EXPECT_EQ(desk.press(Activity::moving), "");
  desk.link.fastest = 0;
  desk.run(0.5);
  EXPECT_NEAR(desk.link.moved, desk.now, 0.01);
  EXPECT_GT(desk.link.fastest, 1e-3);
  EXPECT_LT(desk.link.fastest, 2.3e-3);  // [m/s], of 2: a set-point that is late is caught up
  desk.let_go();
  const double released = desk.now;
  desk.run(0.3);
  EXPECT_LT(desk.link.moved - released, 0.1);
  desk.press(Activity::moving);
  desk.run(4);
  const Bends there = desk.link.bends();
  EXPECT_NEAR(there[1][0], 0.2, 1e-3);
  EXPECT_NEAR(there[1][1], -0.1, 1e-3);
}

/// Measurements are always due then, and so are set-points.
TEST(DevicePanel, ASlowLineMovesAllTheSame) {
  for (const double latency : {0.012, 0.025, 0.05}) {
    PanelDesk desk;
    desk.link.latency = latency;
    desk.run(0.5);
    make_ready(desk);
    desk.press(Activity::moving);
    desk.link.fastest = 0;
    desk.run(6);
    EXPECT_NEAR(desk.link.bends()[1][0], 0.2, 1e-3) << latency;
    EXPECT_LT(desk.link.fastest, 3e-3) << latency;
    EXPECT_EQ(desk.panel.mode(), Mode::armed) << desk.panel.why();
  }
}

TEST(DevicePanel, TheLimitItselfIsNearItAndNotBeyond) {
  PanelDesk desk;
  make_ready(desk);
  desk.code(desk.panel.set_speed(desk.secret, 20e-3, desk.now));
  Bends most(5, Bend(0, 0));
  for (Bend& bend : most)
    bend = Bend(test_arm().robot().sections[0].limit, -test_arm().robot().sections[0].limit);
  EXPECT_EQ(desk.go_to(most), "");
  desk.press(Activity::moving);
  desk.run(4);
  const auto frame = desk.panel.frame(desk.now);
  for (const auto& section : frame["sections"]) {
    EXPECT_EQ(section["word"], "EXACT");
    EXPECT_TRUE(section["near_limit"]);
    EXPECT_NEAR(section["measured"][0].get<double>(), most[0][0], 1e-3);
  }
}

TEST(DevicePanel, SilenceOfThePageStopsItIn300MsAndDisarmsIn2S) {
  PanelDesk desk;
  make_ready(desk);
  desk.press(Activity::moving);
  desk.run(0.25);
  desk.is_renewing = false;  // the page is gone, without a word
  const double silent = desk.now;
  desk.run(1.8);
  EXPECT_LT(desk.link.moved - silent, 0.35);
  EXPECT_EQ(desk.panel.mode(), Mode::armed);
  desk.run(0.3);
  EXPECT_EQ(desk.panel.mode(), Mode::view_only);
  EXPECT_EQ(desk.link.mode, DriveMode::disarmed);
  EXPECT_EQ(desk.panel.why(), "the page fell silent");
}

/// Its words may have waited on the way while the finger left the button.
TEST(DevicePanel, AButtonThatWasSilentForTooLongIsPressedAnew) {
  for (const double stall : {0.35, 1.0, 1.9}) {
    PanelDesk desk;
    make_ready(desk);
    desk.press(Activity::moving);
    desk.run(0.25);
    desk.is_renewing = false;
    const double silent = desk.now;
    desk.run(stall);
    EXPECT_LT(desk.link.moved - silent, 0.35);
    desk.is_renewing = true;  // with the button as it was
    desk.run(1);
    EXPECT_LT(desk.link.moved - silent, 0.35) << stall;
    EXPECT_EQ(desk.last, "release_first");
    EXPECT_EQ(desk.panel.mode(), Mode::armed);
    desk.let_go();
    EXPECT_EQ(desk.press(Activity::moving), "");
    desk.run(0.3);
    EXPECT_NEAR(desk.link.moved, desk.now, 0.01);
  }
}

/// Of several connections the first may be the last to arrive.
TEST(DevicePanel, LateWordsOfAReleasedButtonMoveNothing) {
  PanelDesk desk;
  make_ready(desk);
  const auto say = [&](bool is_held, long number) {
    desk.code(desk.panel.press(Activity::moving, desk.secret, is_held, desk.now, 0, number));
    desk.run(0.1);
    return desk.last;
  };
  EXPECT_EQ(say(true, 1), "");
  say(false, 1);
  const double released = desk.now;
  EXPECT_EQ(say(true, 1), "release_first");
  desk.run(0.2);
  EXPECT_LT(desk.link.moved, released + 1e-9);
  EXPECT_EQ(say(true, 2), "");
  EXPECT_EQ(desk.panel.activity(), Activity::moving);
  EXPECT_EQ(say(true, 1), "release_first") << "of an older one";
  EXPECT_EQ(desk.panel.activity(), Activity::moving);
  EXPECT_EQ(say(false, 1), "");
  EXPECT_EQ(desk.panel.activity(), Activity::moving) << "nor does its end";
  desk.panel.hold(desk.now);
  EXPECT_EQ(say(true, 2), "release_first");
  EXPECT_EQ(say(true, 3), "") << "pressed anew, whether or not a release was heard";
}

TEST(DevicePanel, AStallOfHomingLetsTheDrivesGo) {
  PanelDesk desk(false);
  desk.take_control();
  EXPECT_EQ(desk.press(Activity::homing), "");
  desk.run(0.5);
  EXPECT_EQ(desk.link.mode, DriveMode::armed);
  desk.held.reset();
  desk.run(0.4);
  EXPECT_EQ(desk.link.mode, DriveMode::disarmed);
  EXPECT_EQ(desk.panel.why(), "no word from the page");
  EXPECT_EQ(desk.press(Activity::homing), "release_first");
}

TEST(DevicePanel, ANewPageNeedNotReleaseTheButtonOfTheOneBefore) {
  PanelDesk desk;
  make_ready(desk);
  desk.press(Activity::moving);
  desk.run(0.2);
  desk.is_renewing = false;
  desk.run(2.5);
  desk.is_renewing = true;
  desk.held.reset();
  make_ready(desk);
  EXPECT_EQ(desk.press(Activity::moving), "");
}

TEST(DevicePanel, AButtonThatMayNotBePressedKeepsNoOtherDown) {
  PanelDesk desk;
  desk.link.positions[15] = 20'000;
  desk.run(0.1);
  make_ready(desk);
  desk.press(Activity::moving);
  desk.run(0.1);
  desk.held = Activity::straighten;  // inserted: refused each time
  const double changed = desk.now;
  desk.run(0.2);
  EXPECT_EQ(desk.last, "inserted");
  desk.run(0.8);
  EXPECT_LT(desk.link.moved - changed, 0.36);
}

TEST(DevicePanel, HoldOfAnotherPageWinsOverAHeldButton) {
  PanelDesk desk;
  make_ready(desk);
  desk.press(Activity::moving);
  desk.run(0.3);
  desk.panel.hold(desk.now);
  const double held = desk.now;
  desk.run(0.5);  // the button is still held
  EXPECT_LT(desk.link.moved - held, 0.1);
  EXPECT_EQ(desk.panel.activity(), Activity::holding);
  EXPECT_EQ(desk.last, "release_first");
  desk.let_go();
  EXPECT_EQ(desk.press(Activity::moving), "");
}

TEST(DevicePanel, DisarmsAfterAMinuteAtRest) {
  PanelDesk desk;
  make_ready(desk);
  desk.press(Activity::moving);
  desk.run(3);
  desk.let_go();
  desk.run(59.5);
  EXPECT_EQ(desk.panel.mode(), Mode::armed);
  desk.run(1);
  EXPECT_EQ(desk.panel.mode(), Mode::control);
  EXPECT_EQ(desk.link.mode, DriveMode::disarmed);
}

TEST(DevicePanel, EveryFaultOfTheLineDisarms) {
  const std::pair<std::function<void(PlayedLink&)>, const char*> faults[] = {
      {[](PlayedLink& link) { link.damage(); }, "a line failed its checksum"},
      {[](PlayedLink& link) { link.is_silent = true; }, "the controller did not answer for 0.15 s"},
      {[](PlayedLink& link) { link.unplug(); }, "unplugged"},
      {[](PlayedLink& link) { link.plug(); }, "the controller was reset"},
      {[](PlayedLink& link) { link.mode = DriveMode::lost; }, "the controller has let go by itself"},
      {[](PlayedLink& link) { link.extra_tension[3] = 30; }, "over-tension"}};
  for (const auto& [fault, why] : faults) {
    PanelDesk desk;
    make_ready(desk);
    desk.press(Activity::moving);
    desk.run(0.3);
    fault(desk.link);
    const double broken = desk.now;
    desk.run(0.5);
    EXPECT_EQ(desk.panel.mode(), Mode::control) << why;
    EXPECT_EQ(desk.panel.why(), why);
    EXPECT_LT(desk.link.moved - broken, 0.25) << why;
    EXPECT_NE(desk.link.mode, DriveMode::armed) << why;
  }
}

TEST(DevicePanel, WhatIsUnpluggedShowsNoDataAndComesBack) {
  PanelDesk desk;
  desk.link.unplug();
  desk.run(0.3);
  auto frame = desk.panel.frame(desk.now);
  EXPECT_EQ(frame["link"], "gone");
  EXPECT_EQ(frame["sections"][0]["word"], "NO DATA");
  EXPECT_EQ(frame["alarm"]["word"], "NO DATA");
  desk.link.plug();
  desk.run(0.7);
  frame = desk.panel.frame(desk.now);
  EXPECT_EQ(frame["link"], "ok");
  EXPECT_EQ(frame["sections"][0]["word"], "EXACT");
  EXPECT_TRUE(frame["alarm"].is_null());
}

TEST(DevicePanel, StatesAreShownAfter100MsAndClearedAfter500) {
  PanelDesk desk;
  const auto word = [&] { return desk.panel.frame(desk.now)["sections"][3]["word"].get<std::string>(); };
  for (const std::size_t i : {9u, 10u, 11u}) desk.link.positions[i] += 1000;  // paid out
  desk.run(0.06);
  EXPECT_EQ(word(), "EXACT");
  desk.run(0.1);
  EXPECT_EQ(word(), "SLACK");
  const auto frame = desk.panel.frame(desk.now);
  EXPECT_EQ(frame["sections"][3]["advice"], "Take in tendons 1, 2 and 3 by 0.49 mm");
  EXPECT_TRUE(frame["sections"][4]["conditional"]);
  EXPECT_EQ(frame["alarm"]["section"], 3);
  for (const std::size_t i : {9u, 10u, 11u}) desk.link.positions[i] -= 1000;
  desk.run(0.4);
  EXPECT_EQ(word(), "SLACK");
  desk.run(0.2);
  EXPECT_EQ(word(), "EXACT");
}

TEST(DevicePanel, RelaxNeedsTheLeaseAloneOnlyPaysOutAndEndsJustSlack) {
  PanelDesk desk;
  for (const std::size_t i : {9u, 10u, 11u}) desk.link.positions[i] -= 1434;  // 0.7 mm
  desk.run(0.3);
  const auto before = desk.link.positions;
  auto frame = desk.panel.frame(desk.now);
  EXPECT_EQ(frame["alarm"]["word"], "OVER-TENSIONED");
  EXPECT_EQ(frame["alarm"]["next"], "Hold Relax S4 for 1 s.");
  EXPECT_NEAR(frame["sections"][3]["over_tension"], 0.7e-3, 1e-5);
  EXPECT_TRUE(frame["sections"][0]["locked"]);
  desk.take_control();
  EXPECT_EQ(desk.press(Activity::relax, 3), "");
  desk.run(1);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (i / 3 == 3) {
      EXPECT_GT(desk.link.positions[i], before[i]);
      EXPECT_LT(desk.link.positions[i], 300) << "just slack, to 0.15 mm";
    } else {
      EXPECT_EQ(desk.link.positions[i], before[i]);
    }
  }
  EXPECT_EQ(desk.link.mode, DriveMode::disarmed);
  desk.let_go();
  desk.run(0.8);
  EXPECT_EQ(desk.arm(), "");
}

TEST(DevicePanel, RelaxGoesOnWhereOneTendonHangsAndOthersPull) {
  PanelDesk desk;
  desk.link.extra_tension[9] = -5;
  desk.run(0.3);
  EXPECT_EQ(desk.panel.frame(desk.now)["sections"][3]["word"], "PARTLY SLACK");
  desk.take_control();
  EXPECT_EQ(desk.press(Activity::relax, 3), "");
  desk.run(1);
  for (const std::size_t i : {9u, 10u, 11u}) EXPECT_GT(desk.link.positions[i], 0) << i;
  desk.let_go();
  desk.run(0.3);
  EXPECT_EQ(desk.panel.frame(desk.now)["sections"][3]["word"], "SLACK");
}

// A page may go on after the one, not after the other.
TEST(DevicePanel, WhatIsDoneSaysSoUnlessSomebodyHeldIt) {
  PanelDesk desk;
  for (const std::size_t i : {9u, 10u, 11u}) desk.link.positions[i] -= 1434;
  desk.run(0.3);
  desk.take_control();
  EXPECT_EQ(desk.press(Activity::relax, 3), "");
  desk.run(1);
  EXPECT_EQ(desk.press(Activity::relax, 3), "done");
  desk.let_go();
  EXPECT_EQ(desk.press(Activity::relax, 2), "");
  desk.run(0.05);
  EXPECT_FALSE(desk.panel.hold(desk.now));
  EXPECT_EQ(desk.press(Activity::relax, 2), "release_first");
}

/// Held until it is done or has failed; [s] that it took.
double home(PanelDesk& desk) {
  const double start = desk.now;
  EXPECT_EQ(desk.press(Activity::homing), "");
  desk.run(0.1);
  while (desk.panel.activity() == Activity::homing && desk.now < start + 200) desk.run(0.1);
  desk.let_go();
  return desk.now - start;
}

PanelDesk& unhomed(PanelDesk& desk) {
  for (std::size_t i = 0; i < 15; ++i) desk.link.zeros[i] = 1e-3 * (static_cast<double>(i % 4) - 2);
  desk.link.positions[15] = 4000;
  desk.take_control();
  return desk;
}

/// A quarter of the limit of 20 N, by tendons of 2 N/mm.
void expect_pretension(const PanelDesk& desk) {
  for (const double zero : desk.link.zeros) EXPECT_NEAR(zero, 5 / PlayedLink::stiffness, 1e-4);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_NEAR(desk.link.positions[i], 0, 2);
}

/// What is kept of a homing; it is the only one.
nlohmann::json kept_homing(PanelDesk& desk) {
  desk.recording.wait(std::chrono::seconds(5));
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(desk.place))
    if (entry.path().extension() == ".json") found.push_back(entry.path());
  EXPECT_EQ(found.size(), 1u);
  const std::string told = desk.panel.frame(desk.now)["homed_at"]["file"];
  EXPECT_EQ(found.empty() ? "" : found[0].filename().string(), told);
  std::ifstream file(desk.place / told);
  return nlohmann::json::parse(file, nullptr, false);
}

TEST(DevicePanel, HomingSetsZerosAtThePretensionAndKeepsThem) {
  PanelDesk desk(false);
  unhomed(desk);
  desk.press(Activity::homing);
  desk.run(1);
  EXPECT_FALSE(desk.panel.frame(desk.now)["homing"].is_null());
  EXPECT_TRUE(desk.panel.frame(desk.now)["homed_at"].is_null());
  home(desk);
  EXPECT_TRUE(desk.panel.is_homed()) << desk.now << desk.panel.why();
  expect_pretension(desk);
  EXPECT_NEAR(desk.link.positions[15], 4000, 1) << "the stage keeps its count";
  const auto file = kept_homing(desk);
  EXPECT_EQ(file["pretension"], 5);
  ASSERT_EQ(file["tendons"].size(), 15u);
  for (const auto& tendon : file["tendons"]) {
    EXPECT_NEAR(tendon["tension"].get<double>(), 5, 0.2);
    EXPECT_NEAR(tendon["taken_in"].get<double>(), 5 / PlayedLink::stiffness, 1e-4);
  }
  EXPECT_EQ(desk.panel.frame(desk.now)["homed_at"]["date"], "2026-01-02 10:41:07");
  desk.run(0.8);
  EXPECT_EQ(desk.arm(), "");
}

TEST(DevicePanel, HomingThatWasInterruptedGoesOnWithItsTendon) {
  PanelDesk desk(false);
  unhomed(desk);
  int times = 0;
  for (; !desk.link.homed[8] && desk.now < 200; ++times) {  // let go again and again, at any step
    EXPECT_EQ(desk.press(Activity::homing), "");
    desk.run(1.9);
    desk.let_go();
    desk.run(0.2);
    EXPECT_EQ(desk.link.mode, DriveMode::disarmed);
  }
  EXPECT_GT(times, 5);
  home(desk);
  EXPECT_TRUE(desk.panel.is_homed());
  expect_pretension(desk);
  const auto file = kept_homing(desk);
  ASSERT_EQ(file["tendons"].size(), 15u);
  for (const auto& tendon : file["tendons"]) EXPECT_NEAR(tendon["tension"].get<double>(), 5, 0.2) << tendon;
}

TEST(DevicePanel, WhatIsHomedIsHomedAnew) {
  PanelDesk desk;
  desk.take_control();
  EXPECT_GT(home(desk), 5);
  EXPECT_EQ(kept_homing(desk)["tendons"].size(), 15u);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_NEAR(desk.link.positions[i], 0, 2);
}

TEST(DevicePanel, HomingSaysWhichTendonDoesNotPull) {
  for (const double tension : {-1e3, 1.0}) {  // cut, and of a sensor that is off
    PanelDesk desk(false);
    desk.link.extra_tension[4] = tension;
    if (tension > 0) desk.link.zeros[4] = 1;
    unhomed(desk);
    if (tension > 0) desk.link.zeros[4] = 1;
    desk.link.told().tension_limit = 0;
    home(desk);
    EXPECT_FALSE(desk.panel.is_homed());
    EXPECT_EQ(desk.link.mode, DriveMode::disarmed);
    std::string said;
    for (const LogEntry& entry : desk.panel.take_log())
      if (entry.text.starts_with("homing stopped")) said = entry.text;
    EXPECT_EQ(said, tension > 0 ? "homing stopped: S2 tendon 2 still pulls, however far it is paid out"
                                : "homing stopped: S2 tendon 2 does not pull, however far it is taken in");
  }
}

TEST(DevicePanel, RetractGoesBackTheWayItCame) {
  PanelDesk desk;
  make_ready(desk);
  desk.code(desk.panel.set_speed(desk.secret, 10e-3, desk.now));
  const std::pair<Bends, double> way[] = {{bent(0, 4), 0.01}, {bent(0.2, 4), 0.02}, {bent(0.1, 3), 0.03}};
  for (const auto& [bends, stage] : way) {
    desk.go_to(bends, stage);
    desk.press(Activity::moving);
    desk.run(4);
    desk.let_go();
  }
  EXPECT_EQ(pressed(desk, Activity::straighten), "inserted");
  desk.run(0.4);
  double last = 1, off = 0;
  desk.press(Activity::retract);
  for (int i = 0; i < 300 && desk.link.positions[15] > 10; ++i) {
    desk.run(0.05);
    const double stage = desk.link.positions[15] / 2.048e6;
    EXPECT_LE(stage, last + 1e-6);
    last = stage;
    if (std::abs(stage - 0.01) < 2e-4) off = std::max(off, std::abs(desk.link.bends()[4][0]));
  }
  EXPECT_LT(last, 1e-4);
  EXPECT_LT(off, 0.02) << "at 10 mm it was straight";
}

TEST(DevicePanel, AdvanceLeadsTheTipAndTheBodyFollows) {
  PanelDesk desk;
  make_ready(desk);
  desk.code(desk.panel.set_speed(desk.secret, 20e-3, desk.now));
  Bends lead(5, Bend(0, 0));
  lead[4] = Bend(0.1, 0);
  desk.go_to(lead);
  desk.press(Activity::advance);
  while (desk.link.positions[15] < 2.048e6 * 0.06 && desk.now < 40) desk.run(0.1);
  const Bends bends = desk.link.bends();
  EXPECT_NEAR(bends[4][0], 0.1, 5e-3) << "on the curve that it drew itself";
  EXPECT_NEAR(bends[3][0], 0.1 * (0.06 - 0.035) / 0.035, 0.01) << "what it lies on";
  EXPECT_NEAR(bends[2][0], 0, 1e-3);
}

}  // namespace device_panel_test
}  // namespace sinew::server::device
