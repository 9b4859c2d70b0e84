/// A million poses: equilibria of a flexible tripod in the lanes of vector registers and on all cores, and
/// velocity analyses of arcs.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>
#include <vector>

#include "sinew/sinew.hpp"

namespace {

constexpr std::size_t million = 1'000'000;

/// Lengths that go to and fro, under a weight of 5 N. The robot is constant and shared, each thread has a
/// workspace of its own. Pieces do not depend on the threads, so neither do the results.
void rods() {
  const auto robot = sinew::load("3pfs-g2").value();
  std::vector<double> rows;  // three lengths a row [m], neighbouring rows near each other
  rows.reserve(3 * million);
  for (std::size_t i = 0; i < million; ++i) {
    const double part = std::abs(double(i % 20000) / 10000 - 1);
    rows.insert(rows.end(), {0.42 + 0.02 * part, 0.42, 0.42 - 0.02 * part});
  }
  std::vector<sinew::SpatialPose> poses(million);
  std::vector<sinew::Status> statuses(million);
  const sinew::SpatialWrench load = (sinew::SpatialWrench() << 0, 0, -5, 0, 0, 0).finished();

  constexpr std::size_t piece = 10000;
  std::atomic<std::size_t> next = 0;
  const auto walk = [&] {
    sinew::Workspace work(robot);
    for (std::size_t at = next.fetch_add(piece); at < million; at = next.fetch_add(piece))
      sinew::equilibrium_batch(robot, std::span(rows).subspan(3 * at, 3 * piece), load,
                               std::span(poses).subspan(at, piece), std::span(statuses).subspan(at, piece),
                               work);
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < std::thread::hardware_concurrency(); ++i) threads.emplace_back(walk);
  }
  const auto solved = std::ranges::count(statuses, sinew::Status::converged);
  std::printf("%td of %zu equilibria, the first at z = %.3f mm\n", solved, million,
              1e3 * poses[0].position.z());
}

/// Poses of a 3-RFR on its spot, turned from 0 to 1.2 rad. Only the quantities that have a span are computed.
void arcs() {
  const auto robot = sinew::load("3-rfr").value();
  sinew::Workspace work(robot);
  std::vector<double> coordinates(3 * million, 0.0);  // x of all poses, y of all, φ of all
  for (std::size_t i = 0; i < million; ++i) coordinates[2 * million + i] = 1.2 * double(i) / million;
  std::vector<double> condition(million);
  sinew::velocity_batch(robot, {.coordinates = coordinates}, {.condition_homogenised = condition}, work);

  const auto worst = std::ranges::max_element(condition) - condition.begin();
  std::printf("condition number at home %.3f, largest at phi = %.3f rad\n", condition[0],
              coordinates[2 * million + std::size_t(worst)]);
}

}  // namespace

int main() {
  rods();
  arcs();
}

// Prints:
//   1000000 of 1000000 equilibria, the first at z = 383.322 mm
//   condition number at home 1.364, largest at phi = 1.047 rad
