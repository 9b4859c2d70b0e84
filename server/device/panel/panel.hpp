/// @file panel.hpp
/// Who may move the device, and how: view only, control (a lease), armed. It knows no HTTP, no port and no
/// clock: time is handed in, the line is an interface. Rules: docs/server.md, "A device".
///
/// Drives get set-points here in four ways only: moving while armed, homing, relaxing, and holding where they
/// are. Each of the first three ends when the page has not said for a while that the button is held.
#pragma once
#include <deque>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arm.hpp"
#include "homing.hpp"
#include "judge.hpp"
#include "motion.hpp"
#include "outcome.hpp"
#include "plan.hpp"
#include "server/device/recording.hpp"
#include "server/device/times.hpp"
#include "server/device/wire/link.hpp"
#include "watch.hpp"

namespace sinew::server::device {

enum class Mode { view_only, control, armed };
enum class Activity {
  rest,
  moving,
  straighten,
  retract,
  advance,
  relax,
  homing,
  holding,
  follow,
  follow_back
};

struct LogEntry {
  double time;
  std::string clock, kind, text;
};

class Panel {
 public:
  /// Time of day, as `10:41:07`, a name for a recording, and date with time.
  struct Clock {
    std::function<std::string()> time_of_day, recording_name, date;
  };
  Panel(Arm arm, Judge judge, Link& link, Recording& recording, Clock clock);

  /// @name Commands; `now` [s] as for `tick`
  /// @{
  /// A new lease, its secret; or the one that has it renewed.
  Outcome lease(std::string& secret, int& number, double now);
  Outcome release(std::string_view secret, double now);
  Outcome arm(std::string_view secret, double now);
  Outcome disarm(std::string_view secret, double now);
  Outcome hold(double now);  ///< anybody
  Outcome set_target(std::string_view secret, const std::optional<Bends>& bends, std::optional<double> stage,
                     double now);
  Outcome set_speed(std::string_view secret, double speed, double now);
  /// A button that moves: while it is held this comes again and again.
  /// @param number grows with each press; 0: not told
  Outcome press(Activity activity, std::string_view secret, bool is_held, double now, std::size_t section = 0,
                long number = 0);
  void acknowledge();
  /// A picture, kept beside the recording; anybody.
  /// @param extension `jpg` or `png`
  /// @param name of its file
  Outcome keep_picture(std::string bytes, std::string_view extension, std::string_view text,
                       std::string& name);
  /// A plan to be followed, in place of the one before. It is checked before anything moves.
  Outcome load_plan(std::string_view secret, DrivePlan plan, double now);
  Outcome drop_plan(std::string_view secret, double now);
  /// The server ends: nothing is wanted of the drives any more.
  void shut_down() { disarm("the server ends"); }
  /// @}

  /// All that time and the line ask for. To be called when bytes have come, and each few milliseconds.
  void tick(double now);

  nlohmann::ordered_json frame(double now);
  /// The plan as it was loaded, or null.
  nlohmann::ordered_json plan() const;
  std::vector<LogEntry> take_log();
  void log(std::string_view kind, std::string_view text);

  Mode mode() const { return mode_; }
  Activity activity() const { return activity_; }
  bool is_homed() const { return state_ && state_->all_homed(); }
  const Hello* hello() const { return link_.hello(); }
  const Arm& robot() const { return arm_; }
  double stage_limit() const;
  const std::string& why() const { return why_; }

 private:
  Outcome check_lease(std::string_view secret, double now);
  Outcome check_line() const;
  Outcome check_calm() const;
  Outcome check_recording() const;
  Outcome check_press(long number);
  Outcome may(Activity activity, std::size_t section) const;
  Outcome may_go(Activity activity) const;
  Outcome begin_recording();

  void disarm(std::string_view why);
  void stop(Activity next = Activity::rest);
  void let_go();
  void miss_the_page();
  void lapse(double now);

  void take(const LinkEvent& event, double now);
  void take_answer(const LinkEvent& event, double now);
  void take_refusal(const LinkEvent& event);
  void take_state(std::string_view payload, double now);
  void see_sections(double now);
  void see_recording();
  void record_row();
  void record_event(std::string_view kind, std::string_view text);
  std::string record_columns() const;
  std::string recorded_states() const;
  Posture recorded_setpoints() const;

  bool ask_next(double now);
  bool ask_set(double now);
  bool ask_motion(double now);
  bool ask_gap(double way, double now);
  void begin_homing();
  bool ask_homing(double now);
  void take_zero();
  void keep_homing();
  bool ask_relax(double way, double now);
  void finish(std::string_view text);
  void ask_counts(std::vector<std::int32_t> counts, double now, int milliseconds);
  void ask_pose(double now);
  bool step_motion(double way);
  bool step_plan(bool is_back, double way);
  void record_way();

  Outcome may_follow() const;
  Outcome off_path() const;
  void enter_plan();
  void pause_plan();
  void keep_on_path();
  void forget_plan(std::string_view why);
  void look_at_plan();

  bool wants_drives() const;
  bool is_driving() const;
  bool is_motion() const { return activity_ != Activity::rest && activity_ != Activity::holding; }
  bool is_over() const;
  bool is_inserted() const;
  double age(double now) const { return now - state_time_; }
  Posture measured() const;
  Posture target(const Posture& otherwise) const;
  std::string_view link_word(double now) const;
  std::string link_message(double now) const;
  nlohmann::ordered_json section_json(std::size_t section);
  nlohmann::ordered_json homing_json() const;
  nlohmann::ordered_json kept_json() const;
  nlohmann::ordered_json recording_json() const;
  nlohmann::ordered_json alarm_json(double now) const;
  nlohmann::ordered_json plan_json() const;

  Arm arm_;
  Judge judge_;
  Link& link_;
  Recording& recording_;
  Clock clock_;

  Mode mode_ = Mode::view_only;
  Activity activity_ = Activity::rest;
  std::string secret_, since_, why_;
  int number_ = 0;
  double renewed_ = 0, held_ = -1e9, armed_until_ = 0, now_ = 0;
  bool is_arming_ = false;
  long pressed_ = 0, released_ = 0;  ///< numbers of the last presses
  bool needs_release_ = false;       ///< stopped by another thing than a release: to be pressed anew
  bool is_done_ = false;             ///< namely because there is nothing left to do

  bool fits_ = false;  ///< the controller has our robot's table
  bool knows_controller_ = false;
  DriveMode drives_ = DriveMode::disarmed;
  bool was_state_ = false;  ///< asked last
  bool is_freezing_ = false, is_new_state_ = false, has_setpoints_ = false;
  std::optional<DriveState> state_;
  double state_time_ = -1e9, next_state_ = -1e9, next_set_ = -1e9, last_set_ = -1e9, asked_arm_ = -1e9,
         frozen_at_ = -1e9;
  double damaged_at_ = -1e9, rate_ = 0;
  int spi_damaged_ = 0;

  std::vector<std::int32_t> setpoints_, expected_;  ///< [counts] as the controller has them
  std::vector<std::int32_t> asked_counts_;
  Homing::Step asked_zero_;
  std::optional<Bends> target_bends_;  ///< none: as they are
  std::optional<double> target_stage_;
  bool is_in_gap_ = false;
  double speed_ = 2e-3;  ///< of a tendon [m/s]
  double relaxed_ = 0;   ///< [m] paid out
  std::size_t relaxed_section_ = 0;
  std::optional<Motion> motion_;
  std::optional<Homing> homing_;
  /// The last that was finished.
  struct KeptHoming {
    std::string date, file, error;
    double pretension = 0;  ///< [N]
  };
  std::optional<KeptHoming> kept_;
  Path path_;
  std::optional<FollowedPlan> plan_;
  int plan_number_ = 0;      ///< how many there were: another one has another number
  bool is_on_plan_ = false;  ///< what moves follows it

  Bends bends_;                  ///< measured
  std::vector<double> lengths_;  ///< measured changes and stage [m]
  std::vector<SectionState> sections_;
  std::vector<ShownState> shown_;
  std::optional<Alarm> alarm_;
  std::deque<LogEntry> log_;
  std::string recorded_error_;
  double recorded_until_ = 0;
};

std::string_view name_of(Mode mode);
std::string_view name_of(Activity activity);

}  // namespace sinew::server::device
