/// Commands of the panel: who may what.
#include "panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/secret.hpp"

namespace sinew::server::device {
namespace {

constexpr double slowest = 5e-4, fastest = 20e-3;  // [m/s]
constexpr double outside = 5e-4;                   // [m] of the stage that do not count as inserted

Refused refused(std::string_view code, std::string message) {
  return {std::string(code), std::move(message)};
}

}  // namespace

Panel::Panel(Arm arm, Judge judge, Link& link, Recording& recording, Clock clock)
    : arm_(std::move(arm)),
      judge_(std::move(judge)),
      link_(link),
      recording_(recording),
      clock_(std::move(clock)),
      bends_(arm_.sections(), Bend(0, 0)),
      sections_(arm_.sections()),
      shown_(arm_.sections()) {}

std::string_view name_of(Mode mode) {
  constexpr std::string_view names[] = {"view_only", "control", "armed"};
  return names[static_cast<std::size_t>(mode)];
}

std::string_view name_of(Activity activity) {
  constexpr std::string_view names[] = {"rest",  "moving", "straighten", "retract", "advance",
                                        "relax", "homing", "holding",    "follow",  "follow_back"};
  return names[static_cast<std::size_t>(activity)];
}

void Panel::log(std::string_view kind, std::string_view text) {
  LogEntry entry{now_, clock_.time_of_day(), std::string(kind), std::string(text)};
  record_event(kind, text);
  log_.push_back(std::move(entry));
  constexpr std::size_t most = 1000;
  if (log_.size() > most) log_.pop_front();
}

std::vector<LogEntry> Panel::take_log() {
  std::vector<LogEntry> entries(std::make_move_iterator(log_.begin()), std::make_move_iterator(log_.end()));
  log_.clear();
  return entries;
}

Outcome Panel::check_lease(std::string_view secret, double now) {
  lapse(now);
  if (mode_ == Mode::view_only || secret != secret_)
    return refused("not_yours", "take control first: only who has the lease may do this");
  renewed_ = now;
  return {};
}

/// Whether the device can be moved at all.
Outcome Panel::check_line() const {
  const bool is_there = knows_controller_ && !link_.figures().is_gone;
  if (is_there && !fits_)
    return refused("wrong_table",
                   "the firmware has another robot's table; flash this robot's, or open its file");
  if (!is_there || age(now_) > times::answer)
    return refused("no_link", "the controller does not answer; check the cable and its supply");
  return {};
}

Outcome Panel::check_calm() const {
  for (std::size_t m = 0; m < sections_.size(); ++m) {
    if (sections_[m].word == Word::over_tensioned || shown_[m].word() == Word::over_tensioned)
      return refused("over_tension",
                     fmt::format("locked: S{0} is over-tensioned; hold Relax S{0} first", m + 1));
  }
  return {};
}

Outcome Panel::check_recording() const {
  if (recording_.error().empty()) return {};
  return refused("recording", "motion is held, the recording cannot be written (" + recording_.error() +
                                  "); make room, disarm, and arm again");
}

Outcome Panel::lease(std::string& secret, int& number, double now) {
  lapse(now);
  if (mode_ != Mode::view_only && secret != secret_)
    return refused("lease_taken", "another page controls since " + since_ + "; Hold works from here, too");
  if (mode_ == Mode::view_only) {
    if (!secret.empty()) {
      return refused("not_yours", "this lease is over; take control again");
    }
    secret_ = make_secret();
    ++number_;
    since_ = clock_.time_of_day().substr(0, 5);
    mode_ = Mode::control;
    needs_release_ = false;  // whoever held a button is not this page
    pressed_ = released_ = 0;
    log("info", fmt::format("page {} controls", number_));
  }
  renewed_ = now;
  secret = secret_;
  number = number_;
  return {};
}

Outcome Panel::release(std::string_view secret, double now) {
  if (auto no = check_lease(secret, now)) return no;
  disarm("control was given back");
  mode_ = Mode::view_only;
  log("info", fmt::format("page {} gives control back", number_));
  return {};
}

Outcome Panel::arm(std::string_view secret, double now) {
  if (auto no = check_lease(secret, now)) return no;
  if (mode_ == Mode::armed || is_arming_) return {};
  if (auto no = check_line()) return no;
  if (!is_homed()) return refused("not_homed", "its zeros are not set: hold Home until all tendons are done");
  if (auto no = check_calm()) return no;
  for (std::size_t m = 0; m < sections_.size(); ++m)
    if (shown_[m].word() == Word::unreachable)
      return refused("unreachable", fmt::format("S{} is beyond its limit: home the arm anew", m + 1));
  if (auto no = begin_recording()) return no;
  stop();
  is_arming_ = true;
  asked_arm_ = now;
  return {};
}

Outcome Panel::disarm(std::string_view secret, double now) {
  if (auto no = check_lease(secret, now)) return no;
  disarm("you disarmed");
  return {};
}

/// From armed, or from what needs the drives without: to control. It moves nothing, and the drives let go.
void Panel::disarm(std::string_view why) {
  const bool was_driving = mode_ == Mode::armed || is_arming_ || wants_drives();
  stop();
  if (plan_) plan_->leave();
  is_arming_ = false;
  is_freezing_ = false;
  if (mode_ == Mode::armed) mode_ = Mode::control;
  if (!was_driving) return;
  why_ = why;
  log("info", "disarmed: " + why_);
  recorded_until_ = now_ + times::tail;
}

void Panel::stop(Activity next) {
  if (is_motion()) needs_release_ = true;
  pause_plan();
  is_done_ = false;
  activity_ = next;
  is_in_gap_ = false;
}

/// The button was released. What moved without being armed lets the drives go, too.
void Panel::let_go() {
  if (mode_ != Mode::armed) disarm("released");
  stop();
  needs_release_ = false;
}

Outcome Panel::hold(double now) {
  lapse(now);
  stop(Activity::holding);
  if (plan_) plan_->leave();
  needs_release_ = true;
  constexpr double once = 0.1;  // [s]: a second one while the first is under way changes nothing
  if (is_driving() && mode_ == Mode::armed && now_ - frozen_at_ > once) {
    is_freezing_ = true;
    frozen_at_ = next_state_ = now_;
  }
  log("info", "held");
  return {};
}

Outcome Panel::set_target(std::string_view secret, const std::optional<Bends>& bends,
                          std::optional<double> stage, double now) {
  if (auto no = check_lease(secret, now)) return no;
  if (bends && !arm_.is_within_limits(*bends))
    return refused("out_of_limits", "a section would bend beyond its limit, or their number is wrong");
  if (stage && !(*stage >= 0 && *stage <= stage_limit()))
    return refused("out_of_limits", fmt::format("the stage goes from 0 to {:.4g} m", stage_limit()));
  if (bends) target_bends_ = bends;
  if (stage) target_stage_ = stage;
  return {};
}

Outcome Panel::set_speed(std::string_view secret, double speed, double now) {
  if (auto no = check_lease(secret, now)) return no;
  if (!(speed >= slowest && speed <= fastest))
    return refused("out_of_limits", "the jog speed is from 0.5 to 20 mm/s");
  speed_ = speed;
  return {};
}

bool Panel::is_inserted() const { return hello() && hello()->stages > 0 && measured().stage > outside; }

Outcome Panel::may(Activity activity, std::size_t section) const {
  if (auto no = check_line()) return no;
  if (needs_release_ && is_done_) return refused("done", "it is done: release the button");
  if (needs_release_)
    return refused("release_first", "motion was stopped: release the button, then hold it again");
  if (activity == Activity::relax) {
    if (section >= arm_.sections()) return refused("out_of_limits", "there is no such section");
    return {};
  }
  if (auto no = check_calm()) return no;
  if (activity == Activity::homing) {
    if (!hello()->needs_homing)
      return refused("no_homing", "this firmware keeps no zeros: there is nothing to home");
    if (!hello()->has_tension)
      return refused("no_tension", "its drives measure no tension: set the zeros by hand");
    return {};
  }
  return may_go(activity);
}

/// Motions that need more than the lease.
Outcome Panel::may_go(Activity activity) const {
  if (mode_ != Mode::armed) return refused("not_armed", "arm first");
  if (!is_homed()) return refused("not_homed", "its zeros are not set: hold Home until all tendons are done");
  if (auto no = check_recording()) return no;
  const bool has_stage = hello()->stages > 0;
  if (activity == Activity::follow || activity == Activity::follow_back) return may_follow();
  if (activity == Activity::moving && !target_bends_ && !target_stage_)
    return refused("no_target", "set a target first");
  if (activity == Activity::straighten && is_inserted())
    return refused("inserted",
                   fmt::format("locked: inserted {:.0f} mm; retract first", 1e3 * measured().stage));
  if ((activity == Activity::retract || activity == Activity::advance) && !has_stage)
    return refused("no_stage", "this device has no stage to move it along");
  if (activity == Activity::retract && path_.is_empty())
    return refused("no_path", "no way in was recorded: draw the stage back by Move");
  return {};
}

/// Words come in any order, over several connections: of what has been released they count for nothing.
Outcome Panel::check_press(long number) {
  if (number == 0) return {};
  if (number <= released_ || number < pressed_)
    return refused("release_first", "this button has been released: hold it again");
  if (number > pressed_) needs_release_ = false;  // the one before is over, though nobody said so
  pressed_ = number;
  return {};
}

Outcome Panel::press(Activity activity, std::string_view secret, bool is_held, double now,
                     std::size_t section, long number) {
  if (auto no = check_lease(secret, now)) return no;
  if (!is_held) {
    released_ = std::max(released_, number);
    if (number > 0 && number < pressed_) return {};
    if (activity_ == activity) let_go();
    needs_release_ = false;
    return {};
  }
  if (auto no = check_press(number)) return no;
  if (auto no = may(activity, section)) return no;
  held_ = now;  // not by a button that may not be pressed: it would keep another one down
  if (activity_ == activity && (activity != Activity::relax || section == relaxed_section_)) return {};
  if (activity == Activity::homing && !wants_drives())
    if (auto no = begin_recording()) return no;
  pause_plan();
  activity_ = activity;
  relaxed_section_ = section;
  relaxed_ = 0;
  is_in_gap_ = true;
  if (activity == Activity::homing) begin_homing();
  if (mode_ != Mode::armed) asked_arm_ = now;
  motion_.emplace(arm_, stage_limit());
  motion_->begin(measured(), activity == Activity::advance);
  if (plan_) enter_plan();
  log("info", fmt::format("{}{}", name_of(activity),
                          activity == Activity::relax ? fmt::format(" S{}", section + 1) : ""));
  return {};
}

void Panel::acknowledge() {
  if (alarm_) alarm_->is_acknowledged = true;
}

double Panel::stage_limit() const {
  return hello() && hello()->stages > 0 ? arm_.stage_length(hello()->stage_limit) : 0;
}

/// A word that comes after all may have waited on the way, or in a page that stalled, while the finger left
/// the button. It cannot be told from one of a finger that is still there: so the button has to be pressed
/// anew.
void Panel::miss_the_page() {
  log("info", "stopped: no word from the page");
  if (mode_ != Mode::armed) disarm("no word from the page");
  stop();
}

/// What the page has not renewed in time is over.
void Panel::lapse(double now) {
  now_ = std::max(now_, now);
  if (mode_ != Mode::view_only && now_ - renewed_ > times::lease) {
    disarm("the page fell silent");
    mode_ = Mode::view_only;
    log("info", fmt::format("page {} lost control", number_));
  }
  if (is_motion() && mode_ == Mode::armed) armed_until_ = now_ + times::armed;
  if (is_motion() && now_ - held_ > times::button) miss_the_page();
  if (mode_ == Mode::armed && now_ >= armed_until_) disarm("60 s without motion");
}

}  // namespace sinew::server::device
