/// The frame: all that a page shows of a device.
#include <fmt/format.h>

#include <algorithm>

#include "panel.hpp"

namespace sinew::server::device {
namespace {

using Json = nlohmann::ordered_json;

constexpr double recently = 1;  // [s] that a damaged line is told

Json pair(const Bend& bend) { return {bend[0], bend[1]}; }

template <class Values>
Json slice(const Values& values, std::size_t first, std::size_t count) {
  Json list = Json::array();
  for (std::size_t i = first; i < first + count && i < values.size(); ++i) list.push_back(values[i]);
  return list;
}

}  // namespace

std::string_view Panel::link_word(double now) const {
  if (link_.figures().is_gone) return "gone";
  if (knows_controller_ && !fits_) return "wrong_table";
  if (now - damaged_at_ < recently) return "bad_checksum";
  return age(now) > times::answer ? "silent" : "ok";
}

std::string Panel::link_message(double now) const {
  const std::string_view word = link_word(now);
  const LinkFigures& figures = link_.figures();
  if (word == "gone") return "the device is not there: check cable and supply";
  if (word == "wrong_table") {
    const Hello* hello = link_.hello();
    return hello && hello->version < 3 ? "the firmware speaks an older protocol: flash the panel's"
                                       : "the firmware has another robot's table";
  }
  if (word == "bad_checksum" && figures.damaged_line > 0)
    return fmt::format("line {} of {} failed its checksum", figures.damaged_line, figures.lines);
  if (word == "bad_checksum") return "the drives answer nonsense";
  return word == "silent" ? "the controller does not answer" : "";
}

Json Panel::recording_json() const {
  if (!recording_.is_on() && recording_.error().empty()) return nullptr;
  return {{"name", recording_.name()}, {"rows", recording_.rows()}, {"error", recording_.error()}};
}

Json Panel::alarm_json(double now) const {
  if (!alarm_) return nullptr;
  return {
      {"section", alarm_->section},   {"word", name_of(alarm_->word, shown_[alarm_->section].is_partial())},
      {"since", now - alarm_->since}, {"sentence", alarm_->sentence},
      {"did", alarm_->did},           {"next", alarm_->next},
      {"more", alarm_->more},         {"acknowledged", alarm_->is_acknowledged}};
}

Json Panel::section_json(std::size_t m) {
  const SectionState& state = sections_[m];
  const ShownState& shown = shown_[m];
  const std::size_t count = arm_.tendons(), first = m * count;
  Json json = Json::object();
  // As the library answers, but for what it says of the query.
  for (const auto& [key, value] : state.diagram.items())
    if (key != "id" && key != "query" && key != "robot" && key != "status" && key != "message")
      json[key] = value;
  json["near_limit"] = state.is_near_limit;
  json["amount"] = state.amount;
  json["word"] = name_of(shown.word(), shown.is_partial());
  bool is_locked = false;
  for (std::size_t k = 0; k < shown_.size(); ++k)
    is_locked = is_locked || (k != m && shown_[k].word() == Word::over_tensioned);
  json["locked"] = is_locked;
  const Posture now = measured(), set = motion_ && is_driving() ? motion_->set() : now;
  json["commanded"] = pair(set.bends[m]);
  json["target"] = pair(target(set).bends[m]);
  json["measured"] = pair(now.bends[m]);
  json["changes"] = slice(lengths_, first, count);
  json["set"] = has_setpoints_ ? slice(arm_.lengths(setpoints_), first, count) : json["changes"];
  if (state_ && !state_->tension.empty()) json["tension"] = slice(state_->tension, first, count);
  json["advice"] = state.advice;
  return json;
}

Json Panel::frame(double now) {
  const LinkFigures& figures = link_.figures();
  const Posture place = measured();
  const bool is_new = state_time_ > 0;
  Json json{{"time", now},
            {"age", is_new ? Json(age(now)) : Json(nullptr)},
            {"link", link_word(now)},
            {"message", link_message(now)},
            {"round_trip", figures.round_trip},
            {"rate", age(now) < recently ? rate_ : 0},
            {"errors", figures.errors + spi_damaged_}};
  json["model"] = arm_.model() == kernel::Model::exact ? "pcc" : "lsk";
  json["control"] = {{"holder", mode_ == Mode::view_only ? Json(nullptr) : Json(number_)},
                     {"since", mode_ == Mode::view_only ? "" : since_}};
  json["state"] = name_of(mode_);
  json["activity"] = name_of(activity_);
  json["armed_left"] = mode_ == Mode::armed ? std::max(0.0, armed_until_ - now) : 0;
  json["why"] = why_;
  json["homed"] = is_homed();
  json["homing"] = homing_json();
  json["homed_at"] = kept_json();
  json["stage"] = place.stage;
  json["insertion"] = std::max(0.0, place.stage);
  json["stage_target"] = target(place).stage;
  json["speed"] = speed_;
  json["recording"] = recording_json();
  const Vec3<double> tip = arm_.tip(place.bends);
  json["tip"] = {tip[0], tip[1], tip[2]};
  json["sections"] = Json::array();
  for (std::size_t m = 0; m < arm_.sections(); ++m) json["sections"].push_back(section_json(m));
  json["alarm"] = alarm_json(now);
  json["plan"] = plan_json();
  return json;
}

}  // namespace sinew::server::device
