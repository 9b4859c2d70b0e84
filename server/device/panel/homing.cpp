#include "homing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/device/times.hpp"

namespace sinew::server::device {
namespace {

constexpr double share_of_limit = 0.25, without_limit = 2;  // pretension; [N]
constexpr double hangs = 0.02;                              // [N]: a tendon with less is slack
constexpr double touches = 0.1;                             // [N]: with more it pulls for certain
constexpr double rise = 0.3;                                // [N] over which the line of its pull is read
constexpr std::size_t enough = 4;                           // samples of it
// [m] a step, one for each measurement
constexpr double fast = 8e-3 * times::period;  // in, until it pulls
constexpr double out = 10e-3 * times::period;  // where nothing comes to pull
constexpr double slow = 1e-3 * times::period;  // while it pulls
constexpr double finest = 1e-6, coarsest = 1e-4;
constexpr double min_out = 3e-4, clear = 1e-3, near = 2e-5, longest = 25e-3;  // [m]
constexpr int smooth = 40, prompt = 20;  // [ms]: two periods, so that a late one leaves no gap; one

}  // namespace

Homing::Homing(const Arm& arm, const Hello& hello, const std::vector<bool>& homed)
    : arm_(arm),
      hello_(hello),
      pretension_(hello.tension_limit > 0 ? share_of_limit * hello.tension_limit : without_limit),
      pulls_from_(arm.tendon_drives()),
      tendons_(arm.tendon_drives()) {
  const auto missing = static_cast<std::size_t>(std::ranges::find(homed, false) - homed.begin());
  section_ = missing == homed.size() ? 0 : missing / arm_.tendons();
}

void Homing::resume() {
  failure_.clear();
  if (phase_ == Phase::zero) own_ = 0;  // some of the section count from other zeros now
  enter(section_ < arm_.sections() ? Phase::loosen : Phase::stage);
}

void Homing::enter(Phase phase) {
  phase_ = phase;
  gone_ = before_ = 0;
  way_ = finest;
  samples_.clear();
}

std::string_view Homing::step() const {
  constexpr std::string_view names[] = {"let all hang", "take in", "take in",   "let out", "tighten all",
                                        "tighten all",  "zero",    "the stage", "done"};
  return names[static_cast<std::size_t>(phase_)];
}

void Homing::fail(std::size_t tendon, std::string_view what) {
  failure_ = fmt::format("S{} tendon {} {}", tendon / arm_.tendons() + 1, tendon % arm_.tendons() + 1, what);
}

Homing::Step Homing::go(Counts counts, int milliseconds) {
  Step step;
  step.counts = std::move(counts);
  step.milliseconds = milliseconds;
  return step;
}

std::optional<Homing::Step> Homing::next(const DriveState& state, const Counts& setpoints) {
  if (!failure_.empty()) return {};
  switch (phase_) {
    case Phase::loosen:
      return loosen(state, setpoints);
    case Phase::seek:
      return seek(state, setpoints);
    case Phase::feel:
      return feel(state, setpoints);
    case Phase::let_out:
      return let_out(setpoints);
    case Phase::gather:
      return gather(setpoints);
    case Phase::tighten:
      return tighten(state, setpoints);
    case Phase::zero:
    case Phase::stage:
      return zero(state);
    case Phase::done:
      break;
  }
  return {};
}

/// None may pull while another one is felt for: it would be felt, too.
std::optional<Homing::Step> Homing::loosen(const DriveState& state, Counts counts) {
  bool are_loose = gone_ >= min_out;
  for (std::size_t i = first(); i < arm_.tendon_drives(); ++i) {
    const bool hangs_now = state.tension[i] < hangs;
    if (!hangs_now && gone_ > longest) fail(i, "still pulls, however far it is paid out");
    are_loose = are_loose && hangs_now;
    if (!hangs_now || gone_ < min_out) counts[i] += arm_.tendon_counts(out);
  }
  gone_ += out;
  if (are_loose) enter(own_ < arm_.tendons() ? Phase::seek : Phase::gather);
  return go(std::move(counts), smooth);
}

std::optional<Homing::Step> Homing::seek(const DriveState& state, Counts counts) {
  if (state.tension[tendon()] > touches) {
    enter(Phase::feel);
    return feel(state, std::move(counts));
  }
  gone_ += fast;
  if (gone_ > longest) fail(tendon(), "does not pull, however far it is taken in");
  counts[tendon()] -= arm_.tendon_counts(fast);
  return go(std::move(counts), smooth);
}

/// On while it is seen how the tension rises.
std::optional<Homing::Step> Homing::feel(const DriveState& state, Counts counts) {
  const std::size_t i = tendon();
  samples_.push_back({static_cast<double>(state.counts[i]), state.tension[i]});
  gone_ += slow;
  if (gone_ > longest) fail(i, "does not pull more, however far it is taken in");
  if (samples_.size() >= enough && state.tension[i] > samples_.front().tension + rise) {
    pulls_from_[i] = begin_of_pull();
    enter(Phase::let_out);
    return let_out(std::move(counts));
  }
  counts[i] -= arm_.tendon_counts(slow);
  return go(std::move(counts), prompt);
}

/// Towards the goal by a step; whether it is there.
bool Homing::approach(std::int32_t& count, std::int32_t goal) const {
  const std::int32_t most = std::max(1, arm_.tendon_counts(out));
  count += std::clamp(goal - count, -most, most);
  return count == goal;
}

std::optional<Homing::Step> Homing::let_out(Counts counts) {
  const std::size_t i = tendon();
  if (approach(counts[i], pulls_from_[i] + arm_.tendon_counts(clear))) {
    ++own_;
    enter(own_ < arm_.tendons() ? Phase::seek : Phase::gather);
  }
  return go(std::move(counts), smooth);
}

/// All of a section to just before they pull.
std::optional<Homing::Step> Homing::gather(Counts counts) {
  bool are_there = true;
  for (std::size_t i = first(); i < first() + arm_.tendons(); ++i)
    are_there = approach(counts[i], pulls_from_[i] + arm_.tendon_counts(near)) && are_there;
  if (are_there) enter(Phase::tighten);
  return go(std::move(counts), smooth);
}

/// Each that has less than the pretension a little further in. How stiff they are against one another is not
/// known beforehand: steps grow while the tension hardly rises, and shrink while it rises fast.
std::optional<Homing::Step> Homing::tighten(const DriveState& state, Counts counts) {
  const auto own = state.tension.begin() + static_cast<std::ptrdiff_t>(first());
  const double least = *std::min_element(own, own + static_cast<std::ptrdiff_t>(arm_.tendons()));
  if (least >= pretension_) {
    enter(Phase::zero);
    own_ = 0;
    return {};
  }
  const double by = (least - std::exchange(before_, least)) / pretension_;
  way_ = std::clamp(way_ * (by > 0.04 ? 0.7 : by < 0.02 ? 1.1 : 1), finest, coarsest);
  gone_ += way_;
  for (std::size_t i = first(); i < first() + arm_.tendons(); ++i) {
    if (state.tension[i] >= pretension_) continue;
    if (gone_ > longest) fail(i, fmt::format("does not come to {:.1f} N", pretension_));
    counts[i] -= std::max(1, arm_.tendon_counts(way_));
  }
  return go(std::move(counts), prompt);
}

/// Of tendons where they are; of the stage what its encoder says.
std::optional<Homing::Step> Homing::zero(const DriveState& state) {
  Step step;
  if (phase_ == Phase::stage) {
    step.drive = arm_.tendon_drives();
    if (step.drive >= hello_.drives()) return enter(Phase::done), std::nullopt;
    step.count = std::clamp(state.counts[step.drive], 0, hello_.stage_limit);
    return step;
  }
  step.drive = first() + own_;
  const std::int32_t count = state.counts[step.drive];
  tendons_[step.drive] = {count, arm_.tendon_length(pulls_from_[step.drive] - count),
                          state.tension[step.drive]};
  return step;
}

void Homing::zero_is_set() {
  if (phase_ == Phase::stage) return enter(Phase::done);
  if (++own_ < arm_.tendons()) return;
  ++section_;
  own_ = 0;
  enter(section_ < arm_.sections() ? Phase::seek : Phase::stage);
}

/// Where a straight line through what was felt has no tension.
std::int32_t Homing::begin_of_pull() const {
  double count = 0, tension = 0;
  for (const Sample& sample : samples_) {
    count += sample.count / static_cast<double>(samples_.size());
    tension += sample.tension / static_cast<double>(samples_.size());
  }
  double both = 0, spread = 0;
  for (const Sample& sample : samples_) {
    both += (sample.count - count) * (sample.tension - tension);
    spread += (sample.tension - tension) * (sample.tension - tension);
  }
  const double per_newton = spread > 0 ? both / spread : 0;  // < 0: taking in pulls
  return static_cast<std::int32_t>(std::lround(count - std::min(per_newton, 0.0) * tension));
}

}  // namespace sinew::server::device
