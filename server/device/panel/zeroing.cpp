/// Homing as the panel drives it, and what is kept of it.
#include <fmt/format.h>

#include <algorithm>

#include "panel.hpp"

namespace sinew::server::device {

using Json = nlohmann::ordered_json;

void Panel::begin_homing() {
  if (!homing_ || homing_->is_done()) homing_.emplace(arm_, *hello(), state_->homed);
  homing_->resume();
  kept_.reset();
}

bool Panel::ask_homing(double now) {
  if (!is_new_state_) return false;  // a step for each measurement
  const auto step = homing_->next(*state_, setpoints_);
  if (homing_->is_done()) {
    keep_homing();
    finish(fmt::format("homed, {} tendons at {:.1f} N", arm_.tendon_drives(), homing_->pretension()));
    return false;
  }
  if (!homing_->failure().empty()) {
    finish("homing stopped: " + homing_->failure());
    return false;
  }
  if (!step) return false;
  is_new_state_ = false;
  if (!step->counts.empty()) {
    ask_counts(step->counts, now, step->milliseconds);
    return true;
  }
  asked_zero_ = *step;
  link_.ask('Z', zero_payload(step->drive, step->count), now);
  return true;
}

void Panel::take_zero() {
  const std::size_t drive = asked_zero_.drive;
  setpoints_[drive] = asked_zero_.count;
  is_new_state_ = false;
  if (homing_) homing_->zero_is_set();
  log("info",
      drive < arm_.tendon_drives()
          ? fmt::format("S{} tendon {}: zero set", drive / arm_.tendons() + 1, drive % arm_.tendons() + 1)
          : fmt::format("stage: at {:.1f} mm", 1e3 * arm_.stage_length(asked_zero_.count)));
}

/// A file beside the recordings. It is for whoever compares an arm with itself: after a reset the controller
/// counts from anywhere, and no file knows from where.
void Panel::keep_homing() {
  kept_ = KeptHoming{clock_.date(), "", "", homing_->pretension()};
  Json tendons = Json::array();
  for (std::size_t i = 0; i < homing_->tendons().size(); ++i) {
    const HomedTendon& tendon = homing_->tendons()[i];
    tendons.push_back({{"section", i / arm_.tendons()},
                       {"tendon", i % arm_.tendons()},
                       {"count", tendon.count},
                       {"taken_in", tendon.taken_in},
                       {"tension", tendon.tension}});
  }
  const Json json{{"robot", arm_.robot().name},
                  {"table", fmt::format("{:08x}", hello()->hash)},
                  {"date", kept_->date},
                  {"pretension", kept_->pretension},
                  {"tendons", tendons}};
  kept_->file = recording_.homing(json.dump(1) + '\n');
  if (kept_->file.empty()) kept_->error = recording_.error();
  if (!kept_->error.empty()) log("info", "the homing is not kept: " + kept_->error);
}

Json Panel::homing_json() const {
  if (!homing_ || homing_->is_done()) return nullptr;
  const std::size_t drive = std::min(homing_->tendon(), arm_.tendon_drives() - 1);
  return {{"section", drive / arm_.tendons()},
          {"tendon", drive % arm_.tendons()},
          {"step", homing_->step()},
          {"done", std::min(homing_->found(), arm_.tendon_drives())},
          {"of", arm_.tendon_drives()}};
}

Json Panel::kept_json() const {
  if (!kept_ || !is_homed()) return nullptr;
  return {{"date", kept_->date},
          {"pretension", kept_->pretension},
          {"file", kept_->file},
          {"error", kept_->error}};
}

}  // namespace sinew::server::device
