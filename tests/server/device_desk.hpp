/// @file device_desk.hpp
/// A panel with a controller played at its line: drives with set-points, ramps, zeros and tensions, time that
/// goes when a test says so.
#pragma once
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/document/parse.hpp"
#include "server/device/panel/panel.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::server::device {

inline Document arm_document(const std::string& motor = "{lead: 2 mm, counts: 4096}") {
  return parse_yaml(read_robot_text("nottingham-tpcj").value() + "\nmotor: " + motor + "\n", "robot").value();
}
inline Arm test_arm(const std::string& motor = "{lead: 2 mm, counts: 4096}") {
  return Arm::read(arm_document(motor)).value();
}

/// A folder that no other device of this test, or of one beside it, records in.
inline std::filesystem::path another_place() {
  static int count = 0;
  return std::filesystem::temp_directory_path() /
         ("sinew-device-" + std::to_string(::getpid()) + '-' + std::to_string(++count));
}

/// `test`, `test-2`, ...: a recording each.
inline std::function<std::string()> another_name(const std::string& name) {
  return [name, count = 0]() mutable { return ++count > 1 ? name + '-' + std::to_string(count) : name; };
}

/// What a controller of protocol 3 with one stage does, by its description in firmware/README.md.
class PlayedLink : public Link {
 public:
  explicit PlayedLink(bool is_homed = true) : arm_(test_arm()) {
    const auto table = make_controller_table(arm_.robot(), kernel::Model::linear).value();
    told_.version = 3;
    told_.sections = 5;
    told_.tendons = 3;
    told_.stages = 1;
    told_.angle_fraction = table.bits.angle;
    told_.length_fraction = table.bits.length;
    told_.hash = table.hash();
    told_.stage_limit = 8'388'607;
    told_.has_tension = told_.needs_homing = true;
    told_.tension_limit = 20;
    positions.assign(told_.drives(), 0);
    homed.assign(told_.drives(), is_homed);
    extra_tension.assign(told_.tendon_drives(), 0);
    zeros.assign(told_.tendon_drives(), is_homed ? 0.5 / stiffness : 0);
    arm_.fits(told_);
  }

  std::vector<LinkEvent> poll(double now) override {
    advance(now);
    std::vector<LinkEvent> events = std::move(events_);
    events_.clear();
    if (!has_said_hello_ && !figures_.is_gone) {
      has_said_hello_ = true;
      events.push_back({LinkEvent::Kind::found, 'H', mode});
    }
    if (waiting_ && now >= waiting_->second && !is_silent) {
      events.push_back(waiting_->first);
      if (waiting_->first.kind == LinkEvent::Kind::answer) figures_.heard = now;
      waiting_.reset();
    } else if (waiting_ && now >= asked_at_ + times::answer) {
      ++figures_.errors;
      waiting_.reset();
      events.push_back({LinkEvent::Kind::lost});
    }
    return events;
  }
  bool is_free() const override { return !waiting_ && !figures_.is_gone; }
  void ask(char verb, std::string_view payload, double now) override {
    verbs += verb;
    asked_at_ = now;
    LinkEvent answer{LinkEvent::Kind::answer, verb};
    if (is_silent) {
      waiting_.emplace(answer, now);
      return;
    }
    spoke_ = now;
    answer.error = obey(verb, payload, answer.payload, now);
    answer.mode = mode;
    waiting_.emplace(answer, now + latency);
  }
  const Hello* hello() const override { return has_said_hello_ ? &told_ : nullptr; }
  const LinkFigures& figures() const override { return figures_; }

  void damage() { events_.push_back({LinkEvent::Kind::damaged}); }
  void unplug() {
    figures_.is_gone = true;
    events_.push_back({LinkEvent::Kind::gone});
  }
  void plug() {
    figures_.is_gone = false;
    has_said_hello_ = false;
  }
  Hello& told() { return told_; }
  Posture posture() { return {bends(), arm_.stage_length(positions_counts().back())}; }
  Bends bends() {
    std::vector<double> lengths = arm_.lengths(positions_counts());
    lengths.pop_back();
    SerialWorkspace work(arm_.robot());
    bends_of_changes(arm_.robot(), Numbers(lengths), kernel::Model::linear, work);
    return work.bends;
  }
  std::vector<double> tensions() {
    std::vector<double> changes = arm_.lengths(positions_counts());
    const std::vector<double> needed = arm_.changes(is_homed() ? bends() : Bends(5, Bend(0, 0)));
    std::vector<double> result;
    for (std::size_t i = 0; i < needed.size(); ++i)
      result.push_back(std::max(0.0, extra_tension[i] + stiffness * (needed[i] + zeros[i] - changes[i])));
    return result;
  }
  bool is_homed() const {
    return std::ranges::all_of(homed, [](bool one) { return one; });
  }

  DriveMode mode = DriveMode::disarmed;
  std::vector<double> positions;  ///< [counts]
  std::vector<bool> homed;
  std::vector<double> extra_tension;         ///< [N]
  std::vector<double> zeros;                 ///< [m] at which each tendon of the straight arm begins to pull
  static constexpr double stiffness = 2000;  ///< of a tendon [N/m]
  std::string verbs;                         ///< of all requests
  double moved = -1;                         ///< when a drive last moved
  double fastest = 0;                        ///< [m/s] of a tendon or the stage
  bool is_silent = false, is_stuck = false;
  std::function<void(const Posture&)> asked;  ///< is given each set-point of bends
  double latency = 1e-3;                      ///< of an answer [s]

 private:
  std::vector<std::int32_t> positions_counts() const {
    std::vector<std::int32_t> counts;
    for (const double position : positions)
      counts.push_back(static_cast<std::int32_t>(std::lround(position)));
    return counts;
  }
  static std::vector<double> as_doubles(const std::vector<std::int32_t>& counts) {
    return {counts.begin(), counts.end()};
  }
  static std::int32_t read32(std::string_view bytes, std::size_t at) {
    std::int32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }
  static int read16(std::string_view bytes, std::size_t at) {
    std::int16_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }

  /// Ramps go on; the link watchdog lets go.
  void advance(double now) {
    const double dt = now - time_;
    if (dt <= 0) return;
    time_ = now;
    if (mode == DriveMode::armed && now - spoke_ > 0.2) mode = DriveMode::lost;
    if (mode != DriveMode::armed || goal_.empty() || is_stuck) return;
    const double share = ramp_end_ <= now ? 1 : dt / (ramp_end_ - now + dt);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const double step = (goal_[i] - positions[i]) * share;
      if (std::abs(step) > 1e-9) moved = now;
      if (std::abs(step) > 2) fastest = std::max(fastest, std::abs(step) / 2.048e6 / dt);
      positions[i] += step;
    }
  }
  WireError obey(char verb, std::string_view payload, std::string& reply, double now) {
    const auto put = [&](std::int64_t value, int size) {
      for (int k = 0; k < size; ++k) reply += static_cast<char>(value >> (8 * k) & 0xFF);
    };
    if (verb == 'D') mode = DriveMode::disarmed;
    if (verb == 'A') {
      mode = DriveMode::armed;
      goal_ = positions;
      ramp_end_ = now;
    }
    if (verb == 'S') {
      for (const std::int32_t count : positions_counts()) put(count, 4);
      for (const Bend& bend : bends())
        for (const double x : {bend[0], bend[1]}) put(std::lround(std::ldexp(x, told_.angle_fraction)), 2);
      reply.append(15, 'e');
      put(0, 2);
      for (std::size_t first = 0; first < homed.size(); first += 8) {
        int bits = 0;
        for (std::size_t i = first; i < std::min(first + 8, homed.size()); ++i)
          bits |= homed[i] << (i - first);
        put(bits, 1);
      }
      for (const double tension : tensions()) put(std::lround(std::min(tension, 255.0) * 256), 2);
    }
    if ((verb == 'P' || verb == 'T' || verb == 'Z') && mode != DriveMode::armed) return WireError::not_armed;
    if (verb == 'P' && !is_homed()) return WireError::not_homed;
    if (verb == 'Z') {
      if (ramp_end_ > now) return WireError::moving;
      const auto drive = static_cast<std::size_t>(payload[0]);
      const double shift = read32(payload, 1) - positions[drive];
      positions[drive] += shift;
      goal_[drive] = positions[drive];
      if (drive < zeros.size()) zeros[drive] += arm_.tendon_length(static_cast<std::int32_t>(shift));
      homed[drive] = true;
    }
    if (verb == 'T' || verb == 'P') {
      std::vector<double> goal;
      if (verb == 'T') {
        for (std::size_t i = 0; i < positions.size(); ++i) goal.push_back(read32(payload, 2 + 4 * i));
      } else {
        std::vector<std::int16_t> raw;
        for (std::size_t i = 0; i < 10; ++i)
          raw.push_back(static_cast<std::int16_t>(read16(payload, 2 + 2 * i)));
        const Posture pose{arm_.bends(raw, told_), arm_.stage_length(read32(payload, 22))};
        goal = as_doubles(arm_.counts(pose, true));
        if (asked) asked(pose);
      }
      const auto now_at = tensions();
      for (std::size_t i = 0; i < now_at.size(); ++i)
        if (told_.tension_limit > 0 && now_at[i] > told_.tension_limit && goal[i] < goal_[i])
          return WireError::over_tension;
      goal_ = goal;
      ramp_end_ = now + 1e-3 * read16(payload, 0);
      for (const double count : goal) put(std::lround(count), 2);
    }
    return WireError::none;
  }

  Arm arm_;
  Hello told_;
  LinkFigures figures_{.is_gone = false};
  std::optional<std::pair<LinkEvent, double>> waiting_;
  std::vector<LinkEvent> events_;
  std::vector<double> goal_;
  double asked_at_ = 0, spoke_ = 0, time_ = 0, ramp_end_ = 0;
  bool has_said_hello_ = false;
};

/// A page's fingers: a lease that is renewed, and a button that is held.
struct PanelDesk {
  explicit PanelDesk(bool is_homed = true, const std::string& folder = "")
      : link(is_homed),
        place(folder.empty() ? another_place() : std::filesystem::path(folder)),
        recording(place),
        panel(test_arm(), Judge(Session::open(arm_document()).value(), test_arm()), link, recording,
              {[] { return "10:41:07"; }, another_name("test"), [] { return "2026-01-02 10:41:07"; }}) {
    run(0.7);
  }
  ~PanelDesk() {
    std::error_code ignored;
    std::filesystem::remove_all(place, ignored);
  }

  void run(double seconds) {
    for (const double end = now + seconds; now < end - 1e-9; now += 2e-3) {
      if (is_renewing && now >= next_) {
        next_ = now + 0.1;
        int number = 0;
        if (!secret.empty()) panel.lease(secret, number, now);
        if (held) code(panel.press(*held, secret, true, now, section));
      }
      if (recording.is_on() && has_disk)
        recording.wait(std::chrono::seconds(5));  // time here is not the disk's
      panel.tick(now);
    }
  }
  std::string code(const Outcome& outcome) { return last = outcome ? outcome->code : ""; }
  std::string take_control() {
    int number = 0;
    secret.clear();
    return code(panel.lease(secret, number, now));
  }
  std::string arm() {
    code(panel.arm(secret, now));
    const std::string said = last;
    run(0.1);
    return said;
  }
  std::string press(Activity activity, std::size_t of = 0) {
    section = of;
    const std::string said = code(panel.press(activity, secret, true, now, of));
    held = activity;
    next_ = now + 0.1;
    return said;
  }
  void let_go() {
    if (held) panel.press(*held, secret, false, now);
    held.reset();
  }
  std::string go_to(const Bends& bends, std::optional<double> stage = {}) {
    return code(panel.set_target(secret, bends, stage, now));
  }

  PlayedLink link;
  std::filesystem::path place;
  Recording recording;
  Panel panel;
  double now = 1;
  std::string secret, last;
  std::optional<Activity> held;
  std::size_t section = 0;
  bool is_renewing = true;
  bool has_disk = true;  ///< one that is as quick as it is asked

 private:
  double next_ = 0;
};

inline Bends bent(double angle, std::size_t section = 1) {
  Bends bends(5, Bend(0, 0));
  bends[section] = Bend(angle, -angle / 2);
  return bends;
}

/// Armed, with a target.
inline void make_ready(PanelDesk& desk) {
  ASSERT_EQ(desk.take_control(), "");
  ASSERT_EQ(desk.arm(), "");
  ASSERT_EQ(desk.panel.mode(), Mode::armed) << desk.panel.why();
  ASSERT_EQ(desk.go_to(bent(0.2)), "");
}

}  // namespace sinew::server::device
