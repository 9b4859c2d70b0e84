/// What the panel asks of the controller, and what it makes of the answers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "panel.hpp"

namespace sinew::server::device {
namespace {

constexpr int ramp = 40;    // [ms] of a set-point: two periods, so that a late one leaves no gap and no jerk
constexpr int freeze = 20;  // [ms] of the set-point that holds
constexpr double arm_patience = 1;     // [s]
constexpr double relax_speed = 2e-3;   // [m/s], at most
constexpr double relax_most = 10e-3;   // [m]
constexpr double relaxed_share = 0.1;  // of the limit of a tension

}  // namespace

/// Whether the controller is to be armed.
bool Panel::wants_drives() const {
  return mode_ == Mode::armed || is_arming_ || activity_ == Activity::relax || activity_ == Activity::homing;
}

bool Panel::is_driving() const { return drives_ == DriveMode::armed; }

bool Panel::is_over() const {
  const auto is_shown = [](const ShownState& shown) { return shown.word() == Word::over_tensioned; };
  if (std::ranges::any_of(shown_, is_shown)) return true;
  // What is measured in newtons needs no second look.
  const Hello* hello = link_.hello();
  return hello && hello->tension_limit > 0 && state_ &&
         std::ranges::any_of(state_->tension, [&](double tension) { return tension > hello->tension_limit; });
}

Posture Panel::measured() const {
  const bool has_stage = link_.hello() && link_.hello()->stages > 0 && !lengths_.empty();
  return {bends_, has_stage ? lengths_.back() : 0};
}

/// Where Move goes: what was not asked for stays as it is.
Posture Panel::target(const Posture& otherwise) const {
  const bool has_stage = link_.hello() && link_.hello()->stages > 0;
  return {target_bends_.value_or(otherwise.bends),
          has_stage ? target_stage_.value_or(otherwise.stage) : otherwise.stage};
}

void Panel::tick(double now) {
  now_ = std::max(now_, now);
  for (const LinkEvent& event : link_.poll(now_)) take(event, now_);
  lapse(now_);
  see_sections(now_);
  const bool is_in_use = mode_ == Mode::armed || is_arming_ || activity_ == Activity::homing;
  if (is_in_use && is_over()) disarm("over-tension");
  if (is_arming_ && now_ - asked_arm_ > arm_patience)
    disarm(recording_.is_opening() ? "the disk did not take the recording" : "the controller did not arm");
  see_recording();
  if (is_on_plan_) keep_on_path();
  if (link_.is_free() && fits_) ask_next(now_);
}

void Panel::take(const LinkEvent& event, double now) {
  using Kind = LinkEvent::Kind;
  if (event.kind == Kind::answer) return take_answer(event, now);
  has_setpoints_ = false;
  if (event.kind == Kind::damaged) {
    damaged_at_ = now;
    disarm("a line failed its checksum");
  } else if (event.kind == Kind::lost) {
    disarm(fmt::format("the controller did not answer for {:g} s", times::answer));
  } else if (event.kind == Kind::gone) {
    disarm("unplugged");
    knows_controller_ = false;
    log("no_data", "unplugged");
  } else {
    disarm(event.is_same_session ? "the line was away" : "the controller was reset");
    knows_controller_ = true;
    drives_ = event.mode;
    state_.reset();
    if (!event.is_same_session) {  // its zeros are gone
      path_.forget();
      homing_.reset();
    }
    const Hello& hello = *link_.hello();
    fits_ = hello.version >= 3 && static_cast<std::size_t>(hello.sections) == arm_.sections() &&
            static_cast<std::size_t>(hello.tendons) == arm_.tendons() && arm_.fits(hello);
    log("info", fits_ ? "device found" : "the firmware has another robot's table");
    look_at_plan();
  }
}

void Panel::take_answer(const LinkEvent& event, double now) {
  drives_ = event.mode;
  if (event.error != WireError::none) return take_refusal(event);
  switch (event.verb) {
    case 'S':
      take_state(event.payload, now);
      break;
    case 'A':
      has_setpoints_ = false;  // they are where the drives are: the next measurement says where
      is_new_state_ = false;
      if (is_arming_) {
        mode_ = Mode::armed;
        is_arming_ = false;
        armed_until_ = now + times::armed;
        log("info", "armed");
      }
      break;
    case 'P':
    case 'T':
      setpoints_ = read_setpoints(event.payload, expected_);
      break;
    case 'Z':
      take_zero();
      break;
    default:
      break;
  }
  if (wants_drives() && !is_driving() && event.verb != 'D' && event.verb != 'S')
    disarm("the controller has let go by itself");
  else if (mode_ == Mode::armed && !is_driving())
    disarm("the controller has let go by itself");
}

void Panel::take_refusal(const LinkEvent& event) {
  if (event.error == WireError::moving) return;  // asked again with the next measurement
  if (event.verb == 'S' && event.error == WireError::drives) damaged_at_ = now_;
  disarm(text_of(event.error));
}

void Panel::take_state(std::string_view payload, double now) {
  auto state = read_state(payload, *link_.hello());
  if (!state) {
    disarm("the controller's answer has another shape");
    return;
  }
  const double since = now - state_time_;
  if (since < 1) rate_ += 0.1 * (1 / std::max(since, 1e-3) - rate_);
  spi_damaged_ = state->damaged;
  state_ = std::move(state);
  state_time_ = now;
  is_new_state_ = true;
  lengths_ = arm_.lengths(state_->counts);
  bends_ = arm_.bends(state_->bends, *link_.hello());
  if (!has_setpoints_ && is_driving()) {
    setpoints_ = state_->counts;
    has_setpoints_ = true;
  }
  if (path_.is_empty() && is_homed()) path_.record(measured());
  if (plan_ && is_homed()) plan_->look(measured());
  // While it is homed anew, tendons are where no bends are.
  const bool is_known = is_homed() && activity_ != Activity::homing;
  for (std::size_t m = 0; m < arm_.sections(); ++m)
    sections_[m] =
        judge_.state(m, arm_.model(), lengths_, {state_->tension, link_.hello()->tension_limit}, is_known);
  record_row();
}

/// Shown states and the alarm, also while nothing comes.
void Panel::see_sections(double now) {
  const bool is_known = state_ && fits_ && knows_controller_ && age(now) <= times::answer;
  for (std::size_t m = 0; m < sections_.size(); ++m) {
    const Word word = is_known ? sections_[m].word : Word::no_data;
    const bool is_partial = word == Word::slack && sections_[m].is_partial;
    if (shown_[m].look(word, is_partial, now)) log(kind_of(word), log_line(m, shown_[m], sections_[m]));
  }
  alarm_ = find_alarm(shown_, sections_, alarm_, now);
}

/// The one request that is due most.
bool Panel::ask_next(double now) {
  const auto ask = [&](char verb) {
    link_.ask(verb, {}, now);
    return true;
  };
  if (is_driving() && !wants_drives()) return ask('D');
  if (wants_drives() && !is_driving() && !recording_.is_opening()) {
    has_setpoints_ = false;
    return ask('A');
  }
  // In turns where both are due: on a slow line neither waits for ever.
  const bool is_state_due = now >= next_state_;
  if ((!is_state_due || was_state_) && ask_set(now)) return !(was_state_ = false);
  if (!is_state_due) return false;
  next_state_ = std::max(next_state_ + times::period, now + times::period / 2);
  was_state_ = true;
  return ask('S');
}

/// Set-points that are due.
bool Panel::ask_set(double now) {
  if (is_freezing_ && is_driving() && state_ && state_time_ > frozen_at_) {
    is_freezing_ = false;
    ask_counts(state_->counts, now, freeze);
    return true;
  }
  return ask_motion(now);
}

bool Panel::ask_motion(double now) {
  if (!is_motion() || !is_driving() || !has_setpoints_ || !state_ || now < next_set_) return false;
  const double way = speed_ * std::clamp(now - last_set_, times::period / 2, 2 * times::period);
  next_set_ = std::max(next_set_ + times::period, now + times::period / 2);
  last_set_ = now;
  if (activity_ == Activity::homing) return ask_homing(now);
  if (activity_ == Activity::relax) return ask_relax(way, now);
  if (is_in_gap_ && ask_gap(way, now)) return true;
  if (!step_motion(way)) return false;
  ask_pose(now);
  record_way();
  const bool has_passed_target = activity_ == Activity::retract || activity_ == Activity::advance;
  if (has_passed_target && target_stage_) target_stage_ = motion_->set().stage;  // Move does not undo it
  return true;
}

bool Panel::step_motion(double way) {
  switch (activity_) {
    case Activity::moving:
      return motion_->go_to(target(motion_->set()), way);
    case Activity::straighten:
      return motion_->go_to({Bends(arm_.sections(), Bend(0, 0)), motion_->set().stage}, way);
    case Activity::retract:
      return step_plan(true, way) || motion_->go_back(path_, way);
    case Activity::follow:
    case Activity::follow_back:
      return step_plan(activity_ == Activity::follow_back, way);
    case Activity::advance:
      return motion_->advance(target(motion_->set()).bends, way);
    default:
      return false;
  }
}

/// Set-points that no bends belong to, as after a section was relaxed, come to those that do at the jog
/// speed, too.
bool Panel::ask_gap(double way, double now) {
  const auto goal = arm_.counts(motion_->set(), link_.hello()->stages > 0);
  double most = 0;
  for (std::size_t i = 0; i < goal.size(); ++i) {
    const std::int32_t left = goal[i] - setpoints_[i];
    most = std::max(most,
                    std::abs(i < arm_.tendon_drives() ? arm_.tendon_length(left) : arm_.stage_length(left)));
  }
  is_in_gap_ = most > way;
  if (!is_in_gap_) return false;
  std::vector<std::int32_t> counts = setpoints_;
  for (std::size_t i = 0; i < goal.size(); ++i)
    counts[i] += static_cast<std::int32_t>(std::lround((goal[i] - setpoints_[i]) * way / most));
  ask_counts(std::move(counts), now, ramp);
  return true;
}

bool Panel::ask_relax(double way, double now) {
  const SectionState& section = sections_[relaxed_section_];
  const std::size_t first = relaxed_section_ * arm_.tendons();
  bool is_loose = section.word == Word::slack && !section.is_partial;  // else some tendons still pull
  const double limit = link_.hello()->tension_limit;
  for (std::size_t i = first; i < first + arm_.tendons() && !state_->tension.empty(); ++i)
    is_loose = is_loose && (limit == 0 || state_->tension[i] < relaxed_share * limit);
  if (is_loose || relaxed_ > relax_most) {
    finish(fmt::format("S{} relaxed by {:.2f} mm", relaxed_section_ + 1, 1e3 * relaxed_));
    return false;
  }
  way = std::min(way, relax_speed * 2 * times::period);
  relaxed_ += way;
  std::vector<std::int32_t> counts = setpoints_;
  for (std::size_t i = first; i < first + arm_.tendons(); ++i) counts[i] += arm_.tendon_counts(way);
  ask_counts(std::move(counts), now, ramp);
  return true;
}

/// What is done ends by itself; the button has to be pressed anew for more.
void Panel::finish(std::string_view text) {
  log("info", text);
  const bool was_armed = mode_ == Mode::armed;
  if (!was_armed) disarm("done");
  stop();
  needs_release_ = is_done_ = true;
}

void Panel::ask_counts(std::vector<std::int32_t> counts, double now, int milliseconds) {
  expected_ = std::move(counts);
  link_.ask('T', counts_payload(milliseconds, expected_), now);
}

void Panel::ask_pose(double now) {
  const bool has_stage = link_.hello()->stages > 0;
  expected_ = arm_.counts(motion_->set(), has_stage);
  const auto raw = arm_.raw(motion_->set().bends, *link_.hello());
  std::optional<std::int32_t> stage;
  if (has_stage) stage = std::clamp(arm_.stage_counts(motion_->set().stage), 0, link_.hello()->stage_limit);
  link_.ask('P', pose_payload(ramp, raw, stage), now);
}

}  // namespace sinew::server::device
