/// All assembly modes of a robot with six distance legs beside Newton from many starts. Run:
/// build/dev/bin/bench_spatial_modes
/// Newton from 500 starts is what one writes first; how many modes it misses is not known to it.
#include "kinematics/modes/spatial_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>

namespace sinew::bench {
namespace {

using Legs = std::vector<PlatformConstraint<3>>;

/// Base and platform on circles, points in pairs; legs for a pose, at home (turned by 0) or away from it.
Legs hexagons(double turned) {
  const double third = 2.0943951023931953;
  const SE3<double> pose{{0.1 * turned, -0.15 * turned, 1.5},
                         SO3<double>::exp(turned * Vec3<double>(0.1, -0.15, 0.2))};
  Legs legs;
  for (int i = 0; i < 6; ++i) {
    const double side = i % 2 == 0 ? -0.2 : 0.2, base = third * ((i + 1) / 2) + side,
                 platform = third * (i / 2) + third / 2 - side;
    const Vec3<double> anchor(std::cos(base), std::sin(base), 0),
        point(0.6 * std::cos(platform), 0.6 * std::sin(platform), 0);
    legs.push_back({anchor, (pose.point(point) - anchor).norm(), point});
  }
  return legs;
}

Legs general() {
  std::mt19937 random{11};
  const auto number = [&] { return static_cast<double>(random()) / 2147483647.5 - 1; };
  const SE3<double> pose{{0.1, 0.2, 1.5}, SO3<double>::exp(Vec3<double>(0.4, -0.3, 0.5))};
  Legs legs(6);
  for (PlatformConstraint<3>& leg : legs) {
    for (int i = 0; i < 3; ++i) leg.anchor[i] = number();
    for (int i = 0; i < 3; ++i) leg.platform_point[i] = 0.6 * number();
    leg.distance = (pose.point(leg.platform_point) - leg.anchor).norm();
  }
  return legs;
}

/// Median of 15 runs [ms]. One run takes so long that google-benchmark's many add nothing.
double median(const Legs& legs, const SpatialModesOptions& options) {
  std::vector<double> times(15);
  for (double& time : times) {
    const auto start = std::chrono::steady_clock::now();
    const SpatialModes modes = spatial_modes(legs, options);
    time = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  std::ranges::nth_element(times, times.begin() + 7);
  return times[7];
}

void compare_modes(const char* name, const Legs& legs) {
  const SpatialModesOptions newton{.attempts = 0, .newton_starts = 500};
  const SpatialModes all = spatial_modes(legs), some = spatial_modes(legs, newton);
  fmt::print(
      "{:<18} {:10.1f} {:12.1f}  {} real of {} complex, {} at infinity, {} lost, {}; Newton {}; residual "
      "{:.0e} "
      "m\n",
      name, median(legs, {}), median(legs, newton), all.poses.size(), all.complex_count, all.infinite_paths,
      all.lost_paths, all.is_complete() ? "complete" : "a lower bound", some.poses.size(),
      all.report.residual);
}

}  // namespace
}  // namespace sinew::bench

int main() {
  fmt::print("{:<18} {:>10} {:>12}  {}\n", "all modes of", "paths[ms]", "Newton[ms]", "found");
  sinew::bench::compare_modes("hexagons at home", sinew::bench::hexagons(0));
  sinew::bench::compare_modes("hexagons away", sinew::bench::hexagons(1));
  sinew::bench::compare_modes("general six legs", sinew::bench::general());
}
