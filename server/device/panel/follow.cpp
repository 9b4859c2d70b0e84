/// A plan that is followed: while its button is held, from on its path only, and back by Retract, too.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "panel.hpp"

namespace sinew::server::device {
namespace {

using Json = nlohmann::ordered_json;

constexpr double degrees_of = 180 / std::numbers::pi, millimetres_of = 1e3;

std::string steps_text(const FollowedPlan& plan) {
  return fmt::format("step {:.0f} of {:.0f}", std::floor(plan.at()), plan.last());
}

}  // namespace

Outcome Panel::load_plan(std::string_view secret, DrivePlan plan, double now) {
  if (auto no = check_lease(secret, now)) return no;
  if (auto no = check_line()) return no;
  if (auto no = check_plan(plan, arm_, stage_limit())) return no;
  if (is_on_plan_) stop();
  plan_.emplace(std::move(plan));
  ++plan_number_;
  if (is_homed()) plan_->look(measured());
  log("info", fmt::format("plan {}: {} steps loaded", plan_->plan().name, plan_->plan().steps.size()));
  return {};
}

Outcome Panel::drop_plan(std::string_view secret, double now) {
  if (auto no = check_lease(secret, now)) return no;
  forget_plan("dropped");
  return {};
}

void Panel::forget_plan(std::string_view why) {
  if (!plan_) return;
  if (is_on_plan_) stop();
  log("info", fmt::format("plan {}: {}", plan_->plan().name, why));
  plan_.reset();
}

/// After a reset or another cable: it may be another arm.
void Panel::look_at_plan() {
  if (!plan_) return;
  if (!fits_)
    forget_plan("dropped, the firmware has another robot's table");
  else if (const auto no = check_plan(plan_->plan(), arm_, stage_limit()))
    forget_plan("dropped, " + no->message);
}

/// Where the arm is too far from the path to go along it.
Outcome Panel::off_path() const {
  const OffPath& off = plan_->off();
  const std::string_view way_out =
      is_inserted() ? "hold Retract until it is out, then Move to the first step" : "Move to the first step";
  return Refused{
      "off_path",
      fmt::format("off the path by {:.1f}° in S{} and {:.1f} mm of the stage, it may be {:.1f}° and "
                  "{:.1f} mm: {}",
                  degrees_of * off.bend, off.section + 1, millimetres_of * off.stage,
                  degrees_of * OffPath::max_bend, millimetres_of * OffPath::max_stage, way_out)};
}

Outcome Panel::may_follow() const {
  if (!plan_) return Refused{"no_plan", "load a plan first: Drive… of the screen Trajectory"};
  if (is_on_plan_ || plan_->is_on_path()) return {};
  return off_path();
}

/// A motion begins: whether it goes along the plan.
void Panel::enter_plan() {
  const bool goes_back = activity_ == Activity::retract && plan_->is_on_path() && plan_->at() > 0;
  is_on_plan_ = activity_ == Activity::follow || activity_ == Activity::follow_back || goes_back;
  if (!is_on_plan_) return plan_->leave();
  plan_->enter();
  motion_->begin(plan_->here(), false);
}

void Panel::pause_plan() {
  if (!std::exchange(is_on_plan_, false)) return;
  if (plan_->at() > 0 && plan_->at() < plan_->last())
    log("info", fmt::format("plan {}: paused at {}", plan_->plan().name, steps_text(*plan_)));
}

/// What follows a path and is not on it, or far behind, as with a drive that is stuck, is held.
void Panel::keep_on_path() {
  constexpr double late = 0.3, play = 1e-3;  // [s] of set-points, [m]
  const bool is_behind = motion_->distance(measured(), motion_->set()) > late * speed_ + play;
  if (!plan_->is_lost() && !is_behind) return;
  log("info", fmt::format("plan {}: held, {}", plan_->plan().name,
                          plan_->is_lost() ? off_path()->message : "the drives do not follow"));
  hold(now_);
}

bool Panel::step_plan(bool is_back, double way) {
  if (!is_on_plan_ || !plan_->go(*motion_, is_back, way)) return false;
  target_bends_ = motion_->set().bends;  // Move does not undo it
  target_stage_ = motion_->set().stage;
  if (is_back ? plan_->at() > 0 : plan_->at() < plan_->last()) return true;
  log("info",
      fmt::format("plan {}: {}", plan_->plan().name, is_back ? "back at its first step" : "finished"));
  // From there Retract goes on along the way by which it came to the first step.
  if (activity_ == Activity::retract) {
    is_on_plan_ = false;
    plan_->leave();
  }
  return true;
}

/// The way back out, should the plan be dropped.
void Panel::record_way() {
  if (link_.hello()->stages == 0) return;
  if (activity_ == Activity::follow_back || (activity_ == Activity::retract && is_on_plan_))
    path_.rewind(motion_->set());
  else if (activity_ != Activity::retract)
    path_.record(motion_->set());
}

Json Panel::plan_json() const {
  if (!plan_) return nullptr;
  const double at = plan_->at();
  Json json{{"name", plan_->plan().name},
            {"number", plan_number_},
            {"step", static_cast<int>(at)},
            {"of", static_cast<int>(plan_->last())},
            {"fraction", at - std::floor(at)},
            {"clearance", nullptr},
            {"off_path", nullptr},
            {"done", at >= plan_->last()}};
  const bool is_off = !is_homed() || (!is_on_plan_ && !plan_->is_on_path());
  if (const auto clearance = plan_->clearance(); clearance && !is_off) json["clearance"] = *clearance;
  if (!is_off) return json;
  json["done"] = false;
  const OffPath& off = plan_->off();
  const bool is_seen = is_homed();
  json["off_path"] = {{"bend", is_seen ? Json(off.bend) : Json(nullptr)},
                      {"section", off.section},
                      {"stage", is_seen ? Json(off.stage) : Json(nullptr)},
                      {"to_first", is_seen && !is_inserted()},
                      {"message", is_seen ? off_path()->message : "its zeros are not set"}};
  return json;
}

Json Panel::plan() const {
  if (!plan_) return nullptr;
  const DrivePlan& loaded = plan_->plan();
  Json json{
      {"name", loaded.name}, {"number", plan_number_}, {"steps", Json::array()}, {"clearance", nullptr}};
  for (const Posture& step : loaded.steps) {
    Json bends = Json::array();
    for (const Bend& bend : step.bends) bends.push_back({bend[0], bend[1]});
    json["steps"].push_back({{"bends", std::move(bends)}, {"stage", step.stage}});
  }
  if (!loaded.clearance.empty()) json["clearance"] = loaded.clearance;
  return json;
}

}  // namespace sinew::server::device
