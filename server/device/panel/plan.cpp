#include "plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "motion.hpp"

namespace sinew::server::device {
namespace {

constexpr double to_degrees = 180 / std::numbers::pi, to_millimetres = 1e3;

OffPath off_between(const Posture& a, const Posture& b) {
  OffPath off{0, 0, std::abs(a.stage - b.stage)};
  for (std::size_t m = 0; m < a.bends.size(); ++m)
    if (const double bend = (a.bends[m] - b.bends[m]).norm(); bend > off.bend) {
      off.bend = bend;
      off.section = m;
    }
  return off;
}

/// In which a bend and a stage that are as far off as they may be count alike.
double product(const Posture& a, const Posture& b, const Posture& origin, const Posture& end) {
  constexpr double per_stage = 1 / (OffPath::max_stage * OffPath::max_stage),
                   per_bend = 1 / (OffPath::max_bend * OffPath::max_bend);
  double sum = per_stage * (a.stage - b.stage) * (end.stage - origin.stage);
  for (std::size_t m = 0; m < a.bends.size(); ++m)
    sum += per_bend * (a.bends[m] - b.bends[m]).dot(end.bends[m] - origin.bends[m]);
  return sum;
}

/// Of the straight line between two steps the share at which a posture is nearest to it.
double nearest_share(const Posture& posture, const Posture& from, const Posture& to) {
  const double length = product(to, from, from, to);
  return length > 0 ? std::clamp(product(posture, from, from, to) / length, 0.0, 1.0) : 0.0;
}

Outcome check_step(const Posture& step, std::size_t k, const Arm& arm, double stage_limit) {
  if (step.bends.size() != arm.sections())
    return Refused{"out_of_limits", fmt::format("step {}: {} bends, the robot has {} sections", k,
                                                step.bends.size(), arm.sections())};
  if (const Report report = check_limits(arm.robot(), step.bends); !report.ok())
    return Refused{"unreachable", fmt::format("step {}: {}", k, report.message.view())};
  if (step.stage >= 0 && step.stage <= stage_limit) return {};
  if (stage_limit <= 0)
    return Refused{"no_stage", fmt::format("step {}: stage {:.4g} mm; this device has none", k,
                                           to_millimetres * step.stage)};
  return Refused{"out_of_limits", fmt::format("step {}: stage {:.4g} mm; it goes from 0 to {:.4g} mm", k,
                                              to_millimetres * step.stage, to_millimetres * stage_limit)};
}

}  // namespace

Outcome check_plan(const DrivePlan& plan, const Arm& arm, double stage_limit) {
  const std::size_t count = plan.steps.size();
  if (count < 2 || count > max_steps)
    return Refused{"out_of_limits", fmt::format("{} steps; a plan has 2 to {}", count, max_steps)};
  if (!plan.clearance.empty() && plan.clearance.size() != count)
    return Refused{"out_of_limits", fmt::format("{} clearances of {} steps; give one a step, or none",
                                                plan.clearance.size(), count)};
  for (std::size_t k = 0; k < count; ++k) {
    if (auto no = check_step(plan.steps[k], k, arm, stage_limit)) return no;
    if (k == 0) continue;
    const OffPath by = off_between(plan.steps[k - 1], plan.steps[k]);
    if (by.bend <= max_bend_step && by.stage <= max_stage_step) continue;
    return Refused{
        "too_far",
        fmt::format(
            "step {}: {:.3g} mm and {:.3g}° (S{}) from the one before; at most {:.3g} mm and {:.3g}°: "
            "sinew plan makes steps of half a millimetre",
            k, to_millimetres * by.stage, to_degrees * by.bend, by.section + 1,
            to_millimetres * max_stage_step, to_degrees * max_bend_step)};
  }
  return {};
}

Posture FollowedPlan::posture(double at) const {
  const auto k = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(k);
  return share > 0 ? between(plan_.steps[k], plan_.steps[k + 1], share) : plan_.steps[k];
}

void FollowedPlan::look(const Posture& measured) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < plan_.steps.size(); ++k) {
    const double share = nearest_share(measured, plan_.steps[k], plan_.steps[k + 1]);
    const Posture point = between(plan_.steps[k], plan_.steps[k + 1], share);
    const double at = static_cast<double>(k) + share, square = product(measured, point, point, measured);
    // A path may come twice through one place: then it is where it was.
    const bool is_nearer_along = std::abs(at - at_) < std::abs(nearest_ - at_);
    if (square > least + 1e-6 || (square > least - 1e-6 && !is_nearer_along)) continue;
    least = square;
    nearest_ = at;
    off_ = off_between(measured, point);
  }
  off_here_ = off_between(measured, posture(at_));
}

double FollowedPlan::at() const {
  return is_entered_ || off_here_.share() <= 1 || !is_on_path() ? at_ : nearest_;
}

Posture FollowedPlan::here() const { return posture(at()); }

std::optional<double> FollowedPlan::clearance() const {
  if (plan_.clearance.empty()) return {};
  const double place = at();
  return std::min(plan_.clearance[static_cast<std::size_t>(std::floor(place))],
                  plan_.clearance[static_cast<std::size_t>(std::ceil(place))]);
}

void FollowedPlan::enter() {
  at_ = at();
  is_entered_ = true;
}

bool FollowedPlan::go(Motion& motion, bool is_back, double way) {
  const double before = at_;
  while (way > 0 && (is_back ? at_ > 0 : at_ < last())) {
    const double next = is_back ? std::ceil(at_) - 1 : std::floor(at_) + 1;
    const double left = motion.distance(posture(at_), posture(next));
    at_ = left <= way ? next : at_ + (next - at_) * way / left;
    way -= left;
  }
  motion.begin(posture(at_), false);
  return at_ != before;
}

}  // namespace sinew::server::device
