/// Many poses at once, in the lanes of vector registers: equilibria of rods, and velocity analyses of arcs.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/sinew.hpp"

namespace {

/// 10 000 neighbouring lengths of a flexible tripod, under a weight of 5 N.
void rods() {
  const auto robot = sinew::load("3pfs-g2").value();
  sinew::Workspace work(robot);
  constexpr std::size_t count = 10000;
  std::vector<double> rows;  // three lengths a row, neighbouring rows near each other
  for (std::size_t i = 0; i < count; ++i) {
    const double part = double(i) / count;
    rows.insert(rows.end(), {0.42 + 0.02 * part, 0.42, 0.42 - 0.02 * part});
  }
  std::vector<sinew::SpatialPose> poses(count);
  std::vector<sinew::Status> statuses(count);
  const sinew::SpatialWrench load = (sinew::SpatialWrench() << 0, 0, -5, 0, 0, 0).finished();
  sinew::equilibrium_batch(robot, rows, load, poses, statuses, work);

  const auto solved = std::ranges::count(statuses, sinew::Status::converged);
  std::printf("%td of %zu equilibria, the last at z = %.3f mm\n", solved, count,
              1e3 * poses.back().position.z());
}

/// Tendon lengths and conditions of a 3-RFR at 1000 poses: x of all poses, then y, then φ.
void arcs() {
  const auto robot = sinew::load("3-rfr").value();
  sinew::Workspace work(robot);
  constexpr std::size_t count = 1000;
  std::vector<double> coordinates(3 * count, 0.0);
  for (std::size_t i = 0; i < count; ++i)
    coordinates[2 * count + i] = 1.2 * double(i) / count;  // φ from 0 to 1.2 rad
  std::vector<sinew::Status> statuses(count);
  std::vector<double> condition(count);
  sinew::velocity_batch(robot, {.coordinates = coordinates},
                        {.status = statuses, .condition_homogenised = condition},
                        work);  // only what is asked for

  const auto worst = std::ranges::max_element(condition) - condition.begin();
  std::printf("condition number at home %.3f, largest at phi = %.3f rad\n", condition[0],
              coordinates[2 * count + std::size_t(worst)]);
}

}  // namespace

int main() {
  rods();
  arcs();
}
