#include "homing.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::server::device {
namespace {

constexpr double hangs = 0.02;   // [N]: a tendon with less is slack
constexpr double touches = 0.3;  // [N]: with more it pulls for certain
constexpr double begins = 0.06;  // [N]: from there the straight line of its rise is read
constexpr double least_out = 3e-4, back = 4e-4, longest = 25e-3;  // [m]
constexpr double slow = 1.0 / 8;                                  // of the speed, while it is felt for

}  // namespace

void Homing::begin_tendon() {
  phase_ = Phase::pay_out;
  gone_ = 0;
  samples_.clear();
  failure_ = "";
}

std::string_view Homing::step() const {
  switch (phase_) {
    case Phase::pay_out:
    case Phase::back_off:
      return "pay out";
    case Phase::take_in:
    case Phase::feel:
      return "take in";
    default:
      return "zero";
  }
}

void Homing::zero_is_set() {
  phase_ = Phase::settle;
  gone_ = 0;
}

std::optional<Homing::Step> Homing::move(double way, const std::vector<std::int32_t>& setpoints) {
  gone_ += std::abs(way);
  if (gone_ > longest) failure_ = "the tendon does not pull, however far it is taken in";
  std::int32_t counts = arm_.tendon_counts(way);
  if (counts == 0) counts = way > 0 ? 1 : -1;
  return Step{done_, setpoints[done_] + counts};
}

std::optional<Homing::Step> Homing::next(const DriveState& state, const std::vector<std::int32_t>& setpoints,
                                         double fast) {
  while (!is_done() && state.homed[done_] && phase_ != Phase::settle) ++done_;
  if (is_done() || *failure_ != '\0') return {};
  if (done_ >= hello_.tendon_drives())  // the stage: where its encoder says
    return Step{done_, std::clamp(state.counts[done_], 0, hello_.stage_limit), true};
  const double tension = state.tension[done_];
  const auto enter = [&](Phase phase) {
    phase_ = phase;
    gone_ = 0;
  };
  if (phase_ == Phase::pay_out && gone_ >= least_out && tension < hangs) enter(Phase::take_in);
  if (phase_ == Phase::take_in && tension > touches) enter(Phase::back_off);
  if (phase_ == Phase::back_off && gone_ >= back && tension < hangs) {
    enter(Phase::feel);
    samples_.clear();
  }
  if (phase_ == Phase::settle && setpoints[done_] == 0) {
    ++done_;
    begin_tendon();
    return {};
  }
  switch (phase_) {
    case Phase::pay_out:
    case Phase::back_off:
      return move(fast, setpoints);
    case Phase::take_in:
      return move(-fast, setpoints);
    case Phase::feel:
      return feel(state, setpoints, slow * fast);
    case Phase::zero:
      return Step{done_, state.counts[done_] - zero_count(), true};
    case Phase::settle:
      break;
  }
  const std::int32_t most = std::max(1, arm_.tendon_counts(fast));
  return Step{done_, setpoints[done_] - std::clamp(setpoints[done_], -most, most)};
}

std::optional<Homing::Step> Homing::feel(const DriveState& state, const std::vector<std::int32_t>& setpoints,
                                         double way) {
  const double tension = state.tension[done_];
  if (tension > begins) samples_.push_back({static_cast<double>(state.counts[done_]), tension});
  if (tension < touches || samples_.size() < 2) return move(-way, setpoints);
  phase_ = Phase::zero;
  return {};
}

/// Where a straight line through what was felt has no tension.
std::int32_t Homing::zero_count() const {
  double count = 0, tension = 0;
  for (const Sample& sample : samples_) {
    count += sample.count / static_cast<double>(samples_.size());
    tension += sample.tension / static_cast<double>(samples_.size());
  }
  double rise = 0, spread = 0;
  for (const Sample& sample : samples_) {
    rise += (sample.count - count) * (sample.tension - tension);
    spread += (sample.tension - tension) * (sample.tension - tension);
  }
  const double per_newton = spread > 0 ? rise / spread : 0;  // < 0: taking in pulls
  return static_cast<std::int32_t>(std::lround(count - std::min(per_newton, 0.0) * tension));
}

}  // namespace sinew::server::device
