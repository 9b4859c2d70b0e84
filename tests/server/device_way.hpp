/// @file device_way.hpp
/// How far a posture is from the polyline of a plan, without the panel's own search.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "server/device/panel/plan.hpp"

namespace sinew::server::device {

/// Of what an arm on the path may be off, by the worst of its bends and its stage; the least along the
/// polyline.
inline double share_off(const Posture& posture, const std::vector<Posture>& steps) {
  const auto off = [&](std::size_t k, double t) {
    const Posture &p = steps[k], &q = steps[k + 1];
    double worst = std::abs(posture.stage - p.stage - t * (q.stage - p.stage)) / OffPath::max_stage;
    for (std::size_t m = 0; m < p.bends.size(); ++m) {
      const Bend point = p.bends[m] + t * (q.bends[m] - p.bends[m]);
      worst = std::max(worst, (posture.bends[m] - point).norm() / OffPath::max_bend);
    }
    return worst;
  };
  double best = 1e9;
  for (std::size_t k = 0; k + 1 < steps.size(); ++k) {
    const auto [least, most] = std::minmax(steps[k].stage, steps[k + 1].stage);
    if (std::abs(posture.stage - std::clamp(posture.stage, least, most)) > best * OffPath::max_stage)
      continue;
    double low = 0, high = 1;  // a convex function of t
    for (int i = 0; i < 25; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (off(k, a) < off(k, b) ? high : low) = off(k, a) < off(k, b) ? b : a;
    }
    best = std::min(best, off(k, (low + high) / 2));
  }
  return best;
}

/// What fixed-point bends round, as a share of what may be off.
inline constexpr double rounding = 0.01;

}  // namespace sinew::server::device
