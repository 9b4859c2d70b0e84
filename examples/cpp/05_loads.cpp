/// A flexible tripod under a load: where it comes to rest, how stiff it is, and how much it bears.
#include <cstdio>

#include "sinew/sinew.hpp"

int main() {
  const auto robot = sinew::load("3pfs-g2").value();
  sinew::Workspace work(robot);
  const double lengths[] = {0.4347, 0.4347, 0.4347};

  // Force [N] and moment [N m] of the world on the platform, about its reference point, in base axes.
  sinew::EquilibriumOptions options;
  options.wrench << 1, 0, -5, 0, 0, 0;
  const auto loaded = sinew::equilibrium(robot, lengths, options, work);
  if (!loaded.is_solved()) return std::puts(sinew::to_string(loaded.report).c_str()), 3;
  std::printf("at rest at x %.3f mm, z %.3f mm, %s\n", 1e3 * loaded.pose.position.x(),
              1e3 * loaded.pose.position.z(), loaded.report.ok() ? "stable" : "unstable");

  const sinew::RodAnalysis analysis = sinew::analyse_equilibrium(robot, work);
  std::printf("stiffness in x %.1f N/m, in z %.1f N/m; largest strain %.2f %%\n", analysis.stiffness[0],
              analysis.stiffness[14], 100 * analysis.largest_strain);

  // The load at which it buckles: a downward newton, times a growing factor.
  sinew::equilibrium(robot, lengths, {}, work);
  const sinew::SpatialWrench newton = (sinew::SpatialWrench() << 0, 0, -1, 0, 0, 0).finished();
  const sinew::LoadPath path = sinew::follow_load(robot, newton, 200, work);
  std::printf("%s at %.1f N\n", std::string(sinew::to_string(path.end)).c_str(), path.load);
}

// Prints:
//   at rest at x 0.515 mm, z 399.811 mm, stable
//   stiffness in x 2938.6 N/m, in z 25545.3 N/m; largest strain 0.39 %
//   bifurcation at 110.9 N
