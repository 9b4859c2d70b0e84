/// Plans that are followed: what is refused, where it stops, and that set-points lie on the path.
#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "device_desk.hpp"
#include "device_way.hpp"
#include "server/device/plan_body.hpp"

namespace sinew::server::device {
namespace device_plan_test {

using Json = nlohmann::json;

/// In by half a millimetre a step, while two sections bend.
DrivePlan winding(std::size_t count = 41, double first_bend = 0) {
  DrivePlan plan{"winding", {}, {}};
  for (std::size_t k = 0; k < count; ++k) {
    const double s = static_cast<double>(k);
    Posture step{Bends(5, Bend(0, 0)), 5e-4 * s};
    step.bends[4] = Bend(first_bend + 0.006 * s, 0.1 * std::sin(0.2 * s));
    step.bends[2] = Bend(-0.002 * s, 0.05 * (1 - std::cos(0.1 * s)));
    plan.steps.push_back(step);
    plan.clearance.push_back(1e-3 * (1 + s));
  }
  return plan;
}

struct PlanDesk : PanelDesk {
  PlanDesk() { asked = DrivePlan{}; }
  std::string load(DrivePlan plan) {
    asked = plan;
    link.asked = [this](const Posture& posture) {
      last_asked = posture;
      worst = std::max(worst, share_off(posture, asked.steps));
    };
    return code(panel.load_plan(secret, std::move(plan), now));
  }
  void make_ready(DrivePlan plan = winding()) {
    ASSERT_EQ(take_control(), "");
    ASSERT_EQ(arm(), "");
    ASSERT_EQ(panel.mode(), Mode::armed) << panel.why();
    ASSERT_EQ(load(std::move(plan)), "");
  }
  nlohmann::ordered_json told() { return panel.frame(now)["plan"]; }
  double at() { return told()["step"].get<double>() + told()["fraction"].get<double>(); }
  void follow(double seconds, Activity activity = Activity::follow) {
    EXPECT_EQ(press(activity), "");
    run(seconds);
    let_go();
  }
  bool has_logged(const std::string& text) {
    for (LogEntry& entry : panel.take_log()) logged += entry.text + '\n';
    return logged.find(text) != std::string::npos;
  }
  double off_now() { return share_off(link.posture(), asked.steps); }

  DrivePlan asked;
  Posture last_asked;
  double worst = 0;  ///< of all set-points
  std::string logged;
};

std::string pressed(PlanDesk& desk, Activity activity) {
  return desk.code(desk.panel.press(activity, desk.secret, true, desk.now));
}

TEST(DevicePlan, WhatTheArmCannotDoIsRefusedWithItsStep) {
  struct Row {
    std::function<void(DrivePlan&)> change;
    const char *code, *says;
  };
  const Row rows[] = {
      {[](DrivePlan& p) { p.steps[7].bends[1] = Bend(0.5, 0); }, "unreachable", "step 7: sections[1] bends"},
      {[](DrivePlan& p) { p.steps[7].bends[1] = Bend(1e308, -1e308); }, "unreachable", "step 7"},
      {[](DrivePlan& p) { p.steps[9].bends.pop_back(); }, "out_of_limits", "step 9: 4 bends"},
      {[](DrivePlan& p) { p.steps[9].bends.clear(); }, "out_of_limits", "step 9: 0 bends"},
      {[](DrivePlan& p) { p.steps[0].stage = -1e-9; }, "out_of_limits", "step 0: stage"},
      {[](DrivePlan& p) { p.steps[40].stage = 1e9; }, "out_of_limits", "step 40: stage"},
      {[](DrivePlan& p) { p.steps.resize(1); }, "out_of_limits", "1 steps"},
      {[](DrivePlan& p) { p.steps.clear(); }, "out_of_limits", "0 steps"},
      {[](DrivePlan& p) { p.steps.resize(max_steps + 1, p.steps[0]); }, "out_of_limits", "4001 steps"},
      {[](DrivePlan& p) { p.steps.erase(p.steps.begin() + 5, p.steps.begin() + 20); }, "out_of_limits",
       "41 clearances"},
      {[](DrivePlan& p) { p.steps[12].bends[0][1] += 0.11; }, "too_far", "step 12"},
      {[](DrivePlan& p) {
         for (std::size_t k = 20; k < 41; ++k) p.steps[k].stage += 5e-3;
       },
       "too_far", "step 20: 5.5 mm"}};
  PlanDesk desk;
  desk.take_control();
  for (const Row& row : rows) {
    DrivePlan plan = winding();
    row.change(plan);
    const Outcome no = desk.panel.load_plan(desk.secret, plan, desk.now);
    ASSERT_TRUE(no) << row.says;
    EXPECT_EQ(no->code, row.code);
    EXPECT_EQ(no->message.rfind(row.says, 0), 0u) << no->message;
    EXPECT_TRUE(desk.told().is_null());
  }
  EXPECT_EQ(desk.code(desk.panel.load_plan("another", winding(), desk.now)), "not_yours");
  EXPECT_EQ(desk.load(winding()), "");
  DrivePlan bad = winding();
  bad.steps[3].stage = -1;
  desk.panel.load_plan(desk.secret, bad, desk.now);
  EXPECT_EQ(desk.told()["number"], 1) << "the plan before stays";
  DrivePlan most = winding();
  most.clearance.clear();
  most.steps.assign(max_steps, most.steps[3]);  // all in one place
  EXPECT_EQ(desk.load(most), "");
}

TEST(DevicePlan, BodiesAreReadWithThePlaceOfWhatIsWrong) {
  const Json good{{"lease", "x"},
                  {"robot", "r"},
                  {"name", "n\"a\nme"},
                  {"steps", {{{"bends", {{0, 0.1}}}, {"stage", 0}}, {{"bends", {{0, 0}}}, {"stage", 1}}}}};
  const auto read = read_plan(good);
  ASSERT_TRUE(read && read->plan);
  EXPECT_EQ(read->plan->name, "n a me") << "a line of the log";
  EXPECT_EQ(read->plan->steps[0].bends[0], Bend(0, 0.1));
  for (const char* drop :
       {R"({"lease": "x"})", R"({"lease": "x", "steps": null})", "{}", R"({"steps": null, "name": "x"})"}) {
    const auto dropped = read_plan(Json::parse(drop));
    EXPECT_TRUE(dropped && !dropped->plan) << drop;
  }
  const std::pair<const char*, const char*> rows[] = {
      {R"({"name": "x"})", "steps"},
      {R"({"name": "x", "steps": {}})", "steps"},
      {R"({"name": "x", "steps": 3})", "steps"},
      {R"({"steps": []})", "name"},
      {R"({"name": 3, "steps": []})", "name"},
      {R"({"name": "x", "steps": [null]})", "steps[0]"},
      {R"({"name": "x", "steps": [[]]})", "steps[0]"},
      {R"({"name": "x", "steps": [{"bends": [], "stage": null}]})", "steps[0]"},
      {R"({"name": "x", "steps": [{"bends": [], "stage": "0"}]})", "steps[0]"},
      {R"({"name": "x", "steps": [{"stage": 0}]})", "steps[0]"},
      {R"({"name": "x", "steps": [{"bends": {"0": 1}, "stage": 0}]})", "steps[0]"},
      {R"({"name": "x", "steps": [{"bends": [[0, 0], [0]], "stage": 0}]})", "steps[0].bends[1]"},
      {R"({"name": "x", "steps": [{"bends": [[0, true]], "stage": 0}]})", "steps[0].bends[0]"},
      {R"({"name": "x", "steps": [{"bends": [[0, 0, 0]], "stage": 0}]})", "steps[0].bends[0]"},
      {R"({"name": "x", "steps": [{"bends": [], "stage": 0}], "clearance": 1})", "clearance"},
      {R"({"name": "x", "steps": [{"bends": [], "stage": 0}], "clearance": []})", "clearance"},
      {R"({"name": "x", "steps": [{"bends": [], "stage": 0}], "clearance": [null]})", "clearance[0]"}};
  for (const auto& [text, where] : rows) {
    const auto no = read_plan(Json::parse(text));
    ASSERT_FALSE(no) << text;
    EXPECT_EQ(no.error().where, where) << text;
  }
  Json many{{"name", "x"}, {"steps", Json::array()}};
  for (std::size_t i = 0; i <= max_steps; ++i) many["steps"].push_back(0);
  EXPECT_EQ(read_plan(many).error().code, "too_large");
  many["name"] = std::string(101, 'x');
  EXPECT_FALSE(read_plan(many));
}

TEST(DevicePlan, FollowingHasTheConditionsOfMove) {
  PlanDesk desk;
  EXPECT_EQ(pressed(desk, Activity::follow), "not_yours");
  desk.take_control();
  EXPECT_EQ(pressed(desk, Activity::follow), "not_armed");
  desk.arm();
  EXPECT_EQ(pressed(desk, Activity::follow), "no_plan");
  EXPECT_EQ(pressed(desk, Activity::follow_back), "no_plan");
  desk.load(winding());
  EXPECT_EQ(pressed(desk, Activity::follow), "");
  desk.run(0.2);
  desk.panel.hold(desk.now);
  EXPECT_EQ(pressed(desk, Activity::follow), "release_first");
  PlanDesk tight;
  tight.make_ready();
  tight.press(Activity::follow);
  tight.run(0.3);
  tight.link.extra_tension[4] = 25;
  const double broken = tight.now;
  tight.run(0.3);
  EXPECT_EQ(tight.panel.why(), "over-tension");
  EXPECT_LT(tight.link.moved - broken, 0.1);
  tight.let_go();
  EXPECT_EQ(pressed(tight, Activity::follow), "over_tension");
  PlanDesk unknown;
  unknown.link.is_silent = true;
  unknown.run(0.3);
  unknown.take_control();
  EXPECT_EQ(unknown.load(winding()), "no_link");
}

TEST(DevicePlan, GoesToItsEndAndBackOnThePathAtTheJogSpeed) {
  PlanDesk desk;
  desk.make_ready();
  desk.code(desk.panel.set_speed(desk.secret, 6e-3, desk.now));
  desk.link.fastest = 0;
  EXPECT_EQ(desk.press(Activity::follow), "");
  double before = 0;
  for (int i = 0; i < 300 && !desk.told()["done"].get<bool>(); ++i, before = desk.at()) {
    desk.run(0.1);
    EXPECT_GE(desk.at(), before);
    EXPECT_TRUE(desk.told()["off_path"].is_null());
    EXPECT_LT(desk.off_now(), 0.2) << "between set-points the controller goes straight";
  }
  EXPECT_TRUE(desk.told()["done"]);
  EXPECT_TRUE(desk.has_logged("plan winding: finished"));
  EXPECT_EQ(desk.told()["step"], 40);
  EXPECT_EQ(desk.told()["fraction"], 0);
  EXPECT_DOUBLE_EQ(desk.told()["clearance"], 41e-3);
  EXPECT_LT(desk.worst, rounding);
  EXPECT_GT(desk.link.fastest, 4e-3);
  EXPECT_LT(desk.link.fastest, 7e-3);  // [m/s], of 6: a set-point that is late is caught up
  desk.run(0.2);                       // there is nothing left: it stays
  EXPECT_LT(share_off(desk.link.posture(), {desk.asked.steps[40], desk.asked.steps[40]}), rounding);
  desk.let_go();
  desk.run(0.1);
  desk.press(Activity::follow_back);
  for (int i = 0; i < 300 && desk.at() > 0; ++i) desk.run(0.1);
  EXPECT_TRUE(desk.has_logged("plan winding: back at its first step"));
  desk.run(0.2);
  EXPECT_LT(share_off(desk.link.posture(), {desk.asked.steps[0], desk.asked.steps[0]}), rounding);
  EXPECT_LT(desk.worst, rounding);
  EXPECT_LT(desk.link.fastest, 7e-3);
}

TEST(DevicePlan, AReleaseStopsOnThePathAndItGoesOnFromThere) {
  PlanDesk desk;
  desk.make_ready();
  desk.follow(2);
  const double released = desk.now, there = desk.at();
  desk.run(1);
  EXPECT_LT(desk.link.moved - released, 0.1);
  EXPECT_TRUE(desk.has_logged("plan winding: paused at step "));
  EXPECT_GT(there, 2);
  EXPECT_EQ(desk.at(), there);
  EXPECT_LT(desk.off_now(), rounding) << "it stopped on the path, exactly";
  EXPECT_LT(share_off(desk.last_asked, desk.asked.steps), rounding);
  desk.follow(0.3);
  EXPECT_GT(desk.at(), there);
  for (int i = 0; i < 30; ++i) {  // again and again, before it has come to rest
    desk.follow(0.06, i % 3 == 2 ? Activity::follow_back : Activity::follow);
    desk.run(0.01);
  }
  EXPECT_LT(desk.worst, rounding);
  desk.run(0.3);
  EXPECT_LT(desk.off_now(), rounding);
  EXPECT_GT(desk.at(), there);
}

TEST(DevicePlan, AfterHoldItGoesOnFromTheNearestPoint) {
  PlanDesk desk;
  desk.make_ready();
  desk.code(desk.panel.set_speed(desk.secret, 20e-3, desk.now));
  desk.press(Activity::follow);
  desk.run(0.5);
  desk.panel.hold(desk.now);  // of another page: set-points become what is measured
  desk.run(0.3);
  const double held = desk.at();
  EXPECT_GT(held, 2);
  EXPECT_TRUE(desk.told()["off_path"].is_null());
  desk.let_go();
  desk.run(0.4);
  desk.follow(0.1);
  EXPECT_GT(desk.at(), held);
  EXPECT_LT(desk.at() - held, 10);
  desk.panel.disarm(desk.secret, desk.now);
  desk.run(0.2);
  desk.arm();
  const double armed = desk.at();
  desk.follow(0.1);
  EXPECT_GT(desk.at(), armed);
  EXPECT_LT(desk.worst, rounding);
}

TEST(DevicePlan, OffThePathItWaitsUntilMoveIsAtTheFirstStep) {
  PlanDesk desk;
  desk.make_ready(winding(41, 0.15));
  EXPECT_EQ(pressed(desk, Activity::follow), "off_path");
  const auto told = desk.told();
  EXPECT_NEAR(told["off_path"]["bend"], 0.15, 0.01);
  EXPECT_EQ(told["off_path"]["section"], 4);
  EXPECT_TRUE(told["off_path"]["to_first"]);
  EXPECT_TRUE(told["clearance"].is_null());
  const Outcome no = desk.panel.press(Activity::follow, desk.secret, true, desk.now);
  EXPECT_EQ(no->message,
            "off the path by 8.6° in S5 and 0.0 mm of the stage, it may be 1.1° and 1.0 mm: "
            "Move to the first step");
  desk.run(0.4);
  desk.go_to(desk.asked.steps[0].bends, desk.asked.steps[0].stage);
  desk.press(Activity::moving);
  desk.run(2);
  desk.let_go();
  EXPECT_TRUE(desk.told()["off_path"].is_null());
  EXPECT_EQ(desk.at(), 0);
  desk.worst = 0;
  desk.follow(1);
  EXPECT_GT(desk.at(), 1);
  EXPECT_LT(desk.worst, rounding);
  EXPECT_GT(desk.link.posture().stage, 5e-4);
  desk.panel.disarm(desk.secret, desk.now);
  desk.run(0.1);
  for (std::size_t i = 12; i < 15; ++i) desk.link.positions[i] += i == 12 ? 2000 : -1000;  // by hand
  desk.run(0.3);
  EXPECT_FALSE(desk.told()["off_path"].is_null());
  EXPECT_FALSE(desk.told()["off_path"]["to_first"]) << "inserted";
  desk.arm();
  EXPECT_EQ(pressed(desk, Activity::follow), "off_path");
  EXPECT_NE(desk.panel.press(Activity::follow, desk.secret, true, desk.now)->message.find("Retract"),
            std::string::npos);
}

TEST(DevicePlan, WhatDoesNotFollowIsHeld) {
  PlanDesk desk;
  desk.make_ready();
  desk.press(Activity::follow);
  desk.run(0.5);
  desk.link.is_stuck = true;
  desk.run(1.5);
  EXPECT_EQ(desk.panel.activity(), Activity::holding);
  EXPECT_TRUE(desk.has_logged("plan winding: held, the drives do not follow"));
  PlanDesk pushed;
  pushed.make_ready();
  pushed.press(Activity::follow);
  pushed.run(0.5);
  pushed.link.is_stuck = true;
  for (std::size_t i = 12; i < 15; ++i) pushed.link.positions[i] += i == 12 ? 2000 : -1000;
  const double broken = pushed.now;
  pushed.run(0.3);
  EXPECT_GT(pushed.off_now(), 2);
  EXPECT_EQ(pushed.panel.activity(), Activity::holding) << pushed.told();
  EXPECT_TRUE(pushed.has_logged("plan winding: held, off the path by "));
  EXPECT_LT(pushed.link.moved - broken, 0.1);
}

TEST(DevicePlan, RetractGoesBackAlongItAndThenTheWayBefore) {
  PlanDesk desk;
  desk.make_ready();
  desk.code(desk.panel.set_speed(desk.secret, 10e-3, desk.now));
  DrivePlan inner = winding();
  for (Posture& step : inner.steps) step.stage += 0.01;  // it begins 10 mm in
  desk.load(inner);
  desk.go_to(inner.steps[0].bends, 0.01);
  desk.press(Activity::moving);
  desk.run(2);
  desk.let_go();
  desk.worst = 0;
  desk.follow(60 * 0.05);
  desk.follow(0.5, Activity::follow_back);
  desk.follow(0.5);
  EXPECT_GT(desk.at(), 10);
  desk.run(0.3);
  desk.press(Activity::retract);
  double last = 1;
  for (int i = 0; i < 400 && desk.link.posture().stage > 1e-5; ++i) {
    desk.run(0.05);
    EXPECT_LE(desk.link.posture().stage, last + 1e-6);
    last = desk.link.posture().stage;
    if (last > 0.0101) {
      EXPECT_LT(desk.worst, rounding) << last;
    }
  }
  EXPECT_LT(last, 1e-4);
  for (const Bend& bend : desk.link.bends()) EXPECT_LT(bend.norm(), 2e-3) << "straight, as it came";
}

TEST(DevicePlan, ADroppedPlanLeavesItsWayToRetract) {
  PlanDesk desk;
  desk.make_ready();
  desk.code(desk.panel.set_speed(desk.secret, 10e-3, desk.now));
  desk.follow(1.5);
  desk.follow(0.5, Activity::follow_back);
  desk.follow(0.8);
  const double stage = desk.link.posture().stage;
  EXPECT_GT(stage, 2e-3);
  EXPECT_EQ(desk.code(desk.panel.drop_plan("another", desk.now)), "not_yours");
  EXPECT_EQ(desk.code(desk.panel.drop_plan(desk.secret, desk.now)), "");
  EXPECT_TRUE(desk.told().is_null());
  EXPECT_EQ(pressed(desk, Activity::follow), "no_plan");
  desk.run(0.4);
  desk.worst = 0;
  desk.press(Activity::retract);
  while (desk.link.posture().stage > 1e-5 && desk.now < 60) {
    desk.run(0.05);
    EXPECT_LT(desk.off_now(), 0.5);
  }
  EXPECT_LT(desk.worst, 0.15) << "the way in is kept by straight lines of 2 mrad";
  EXPECT_LT(desk.link.posture().stage, 1e-4);
}

TEST(DevicePlan, APathThatComesTwiceThroughAPlaceIsFollowedOn) {
  DrivePlan plan = winding(21);
  for (std::size_t k = 20; k-- > 0;) plan.steps.push_back(plan.steps[k]);
  plan.clearance.clear();
  PlanDesk desk;
  desk.make_ready(plan);
  desk.code(desk.panel.set_speed(desk.secret, 10e-3, desk.now));
  double before = 0;
  while (!desk.told()["done"].get<bool>() && desk.now < 60) {
    desk.follow(0.2);
    desk.run(0.1);
    EXPECT_GT(desk.at(), before);
    before = desk.at();
  }
  EXPECT_EQ(before, 40);
  EXPECT_TRUE(desk.told()["clearance"].is_null());
}

TEST(DevicePlan, AnotherTableDropsItAResetOfTheSameDoesNot) {
  PlanDesk desk;
  desk.make_ready();
  desk.follow(0.5);
  desk.link.unplug();
  desk.run(0.2);
  desk.link.plug();
  desk.run(0.3);
  EXPECT_FALSE(desk.told().is_null());
  desk.link.unplug();
  desk.run(0.1);
  desk.link.told().stage_limit = 1000;
  desk.link.plug();
  desk.run(0.3);
  EXPECT_TRUE(desk.told().is_null()) << "a shorter stage";
  EXPECT_TRUE(desk.has_logged("dropped, step 1: stage"));
  desk.link.told().stage_limit = 8'388'607;
  desk.link.unplug();
  desk.run(0.1);
  desk.link.plug();
  desk.run(0.3);
  desk.load(winding());
  desk.link.unplug();
  desk.run(0.1);
  desk.link.told().hash ^= 1;
  desk.link.plug();
  desk.run(0.3);
  EXPECT_TRUE(desk.told().is_null());
  EXPECT_EQ(desk.load(winding()), "wrong_table");
}

TEST(DevicePlan, IsToldAsItWasLoaded) {
  PlanDesk desk;
  EXPECT_TRUE(desk.panel.plan().is_null());
  desk.make_ready();
  const auto told = desk.panel.plan();
  EXPECT_EQ(told["steps"].size(), 41u);
  EXPECT_EQ(told["steps"][7]["stage"], 3.5e-3);
  EXPECT_EQ(told["steps"][7]["bends"][4][0], desk.asked.steps[7].bends[4][0]);
  EXPECT_EQ(told["clearance"][3], 4e-3);
}

}  // namespace device_plan_test
}  // namespace sinew::server::device
