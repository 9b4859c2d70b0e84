/// What the panel writes down: a row for each measurement, and one for each event.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "panel.hpp"

namespace sinew::server::device {
namespace {

void put(std::string& row, double value) { row += std::isnan(value) ? "," : fmt::format(",{:.7g}", value); }

}  // namespace

std::string Panel::record_columns() const {
  std::string names;
  const auto per_section = [&](std::string_view what, std::string_view unit, std::size_t count) {
    for (std::size_t m = 0; m < arm_.sections(); ++m)
      for (std::size_t i = 1; i <= count; ++i) names += fmt::format(",S{}_{}_{}[{}]", m, what, i, unit);
  };
  per_section("beta", "rad", 2);
  names += ",stage[m],measured_stage[m]";
  per_section("measured_beta", "rad", 2);
  per_section("set_change", "m", arm_.tendons());
  per_section("change", "m", arm_.tendons());
  per_section("tension", "N", arm_.tendons());
  names += ",homed";
  for (std::size_t m = 0; m < arm_.sections(); ++m) names += fmt::format(",S{}_state", m);
  return names + ",event,text";
}

Outcome Panel::begin_recording() {
  recorded_error_.clear();
  recorded_until_ = std::numeric_limits<double>::infinity();
  RecordingHead head{arm_.robot().name, hello()->hash, arm_.model() == kernel::Model::exact ? "pcc" : "lsk",
                     hello()->tension_limit, record_columns()};
  recording_.begin(clock_.recording_name(), head, now_);
  for (std::size_t m = 0; m < shown_.size(); ++m)  // their own events were before it
    if (shown_[m].word() != Word::exact)
      record_event(kind_of(shown_[m].word()), log_line(m, shown_[m], sections_[m]));
  return check_recording();
}

/// What became of the file. Where it cannot be written nothing moves on.
void Panel::see_recording() {
  recording_.poll();
  if (recording_.error() != recorded_error_) {
    recorded_error_ = recording_.error();
    if (!recorded_error_.empty()) {
      hold(now_);
      if (is_arming_) disarm("the recording cannot be written: " + recorded_error_);
      log("info", "the recording stopped: " + recorded_error_);
    }
  }
  if (now_ >= recorded_until_) recording_.end();
}

Posture Panel::recorded_setpoints() const { return motion_ ? motion_->set() : measured(); }

/// As they are shown: what banner and log say is in the file, too.
std::string Panel::recorded_states() const {
  std::string states;
  for (const ShownState& shown : shown_)
    states += fmt::format(",{}", name_of(shown.word(), shown.is_partial()));
  return states;
}

void Panel::record_row() {
  if (!recording_.is_on()) return;
  const std::size_t drives = arm_.tendon_drives();
  const bool has_stage = link_.hello()->stages > 0;
  const Posture set = recorded_setpoints();
  const double none = std::nan("");
  std::string row;
  for (const Bend& bend : set.bends) put(row, bend[0]), put(row, bend[1]);
  put(row, has_stage ? set.stage : none);
  put(row, has_stage ? measured().stage : none);
  for (const Bend& bend : bends_) put(row, bend[0]), put(row, bend[1]);
  for (std::size_t i = 0; i < drives; ++i)
    put(row, arm_.tendon_length(has_setpoints_ ? setpoints_[i] : state_->counts[i]));
  for (std::size_t i = 0; i < drives; ++i) put(row, lengths_[i]);
  for (std::size_t i = 0; i < drives; ++i) put(row, state_->tension.empty() ? none : state_->tension[i]);
  row += is_homed() ? ",1" : ",0";
  recording_.row(state_time_, row + recorded_states() + ",,");
}

/// With set-points and states, as of then; what is measured is in the other rows.
void Panel::record_event(std::string_view kind, std::string_view text) {
  if (!recording_.is_on()) return;
  const Posture set = recorded_setpoints();
  std::string row;
  for (const Bend& bend : set.bends) put(row, bend[0]), put(row, bend[1]);
  put(row, link_.hello() && link_.hello()->stages > 0 ? set.stage : std::nan(""));
  const std::size_t measured_columns = 1 + 2 * arm_.sections() + 3 * arm_.tendon_drives();
  row.append(measured_columns, ',');
  row += is_homed() ? ",1" : ",0";
  recording_.event(now_, row + recorded_states() + fmt::format(",{},{}", kind, quoted(text)));
}

Outcome Panel::keep_picture(std::string bytes, std::string_view extension, std::string_view text,
                            std::string& name) {
  if (!recording_.is_on())
    return Refused{"no_recording", "nothing is recorded now, so there is no place for it: arm first"};
  if (auto no = check_recording()) return no;
  name = recording_.picture(std::move(bytes), extension);
  if (name.empty())
    return Refused{"too_many", "999 pictures are in this recording, or those before are not written yet"};
  log("snapshot",
      fmt::format("{}, table {:08X}{}{}", name, link_.hello()->hash, text.empty() ? "" : ": ", text));
  return {};
}

}  // namespace sinew::server::device
