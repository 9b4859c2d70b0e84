/// The operations whose speed is never to get worse, one at a time, for a script that compares two builds:
///
///     bench_operations               their names
///     bench_operations NAME COUNT    runs one so many times; prints the processor's time of one [ns]
///
/// tools/old_and_new.py runs those of two builds in turn. What an operation needs is made before its time is
/// taken, and none is judged here: how exact they are is told by the other benchmarks.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "kinematics/chains/chain.hpp"
#include "robot/parallel.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "sinew/study/sweep.hpp"

namespace {

using namespace sinew;
using Operation = std::function<double()>;  ///< a number that hangs on its result

constexpr int walk_length = 256;
double turn(int step) { return 2 * std::numbers::pi * step / walk_length; }

/// A closed walk of poses, and what belongs to each.
struct Walk {
  Robot robot;
  Workspace work;
  std::vector<AnyPose> poses;
  std::vector<std::vector<double>> inputs, coordinates;
  std::size_t at = 0;

  Walk(const char* name, const std::function<AnyPose(const Robot&, double)>& pose_at)
      : robot(load(name).value()),
        work(robot) {
    for (int k = 0; k < walk_length; ++k) {
      const AnyPose pose = pose_at(robot, turn(k));
      if (!inverse(robot, pose, {}, work).ok()) continue;
      poses.push_back(pose);
      inputs.emplace_back(work.inputs);
      coordinates.emplace_back(work.coordinates);
    }
  }
  std::size_t next() { return at = (at + 1) % poses.size(); }
  std::size_t last() const { return (at + poses.size() - 1) % poses.size(); }
};
std::shared_ptr<Walk> planar_walk() {
  return std::make_shared<Walk>("3-rfr", [](const Robot&, double t) -> AnyPose {
    return PlanarPose{0.015 * std::cos(t), 0.015 * std::sin(t) - 0.01, 0.1 * std::sin(t)};
  });
}
std::shared_ptr<Walk> spatial_walk() {
  return std::make_shared<Walk>("6-ufs", [](const Robot& robot, double t) -> AnyPose {
    return Spatial::moved(std::get<SpatialPose>(home(robot)),
                          Vec<double, 6>(0.03 * std::cos(t), 0.03 * std::sin(t), 0.01 * std::sin(2 * t),
                                         0.2 * std::cos(t), 0.2 * std::sin(t), 0.3 * std::sin(t)));
  });
}

Operation jacobians(const std::shared_ptr<Walk>& walk) {
  return [walk] {
    const std::size_t k = walk->next();
    return assemble(walk->robot, walk->poses[k], walk->coordinates[k], walk->work).closure_error;
  };
}
Operation warm_forward(const std::shared_ptr<Walk>& walk) {
  return [walk] {
    const std::size_t k = walk->next();
    return forward(walk->robot, walk->inputs[k], {.start = walk->poses[walk->last()]}, walk->work)
        .report.residual;
  };
}
Operation warm_inverse(const std::shared_ptr<Walk>& walk) {
  return [walk] {
    const std::size_t k = walk->next();
    return inverse(walk->robot, walk->poses[k], {.curvature = walk->coordinates[walk->last()]}, walk->work)
        .report.residual;
  };
}
Operation all_modes(const std::shared_ptr<Walk>& walk) {
  return [walk] {
    return static_cast<double>(
        assembly_modes(walk->robot, walk->inputs[walk->next()], walk->work).poses.size());
  };
}

/// Lengths of a 3PFS about home, neighbours 1 mm apart.
std::vector<double> tripod_lengths(int count) {
  std::vector<double> lengths;
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < 3; ++i)
      lengths.push_back(0.43 + 0.012 * std::sin(2 * std::numbers::pi * k / 75 + 2.1 * i));
  return lengths;
}
struct Tripod {
  Robot robot = load("3pfs-g2").value();
  Workspace work{robot};
  std::vector<double> lengths;
  std::vector<SpatialPose> poses;
  std::vector<Status> statuses;
  std::size_t at = 0;

  explicit Tripod(int count)
      : lengths(tripod_lengths(count)),
        poses(lengths.size() / 3),
        statuses(poses.size()) {
    equilibrium(robot, std::span(lengths).first(3), {}, work);
  }
};
Operation warm_tripod() {
  auto one = std::make_shared<Tripod>(75);
  return [one] {
    one->at = (one->at + 1) % one->poses.size();
    return equilibrium(one->robot, std::span(one->lengths).subspan(3 * one->at, 3),
                       {.warm_start = true, .check_stability = false}, one->work)
        .report.residual;
  };
}
Operation cold_tripod() {
  auto one = std::make_shared<Tripod>(75);
  return [one] {
    one->at = (one->at + 1) % one->poses.size();
    return equilibrium(one->robot, std::span(one->lengths).subspan(3 * one->at, 3), {}, one->work)
        .report.residual;
  };
}
Operation tripod_batch() {
  auto one = std::make_shared<Tripod>(1024);
  return [one] {
    equilibrium_batch(one->robot, one->lengths, SpatialWrench::Zero(), one->poses, one->statuses, one->work);
    return one->poses.back().position[2];
  };
}
Operation warm_hexapod() {
  struct Case {
    Robot robot = load("hexapod").value();
    Workspace work{robot};
    int step = 0;
    double next() {
      const double t = turn(++step);
      SpatialPose pose;
      pose.position = {0.04 * std::cos(t), 0.04 * std::sin(t), 0.45 + 0.02 * std::sin(2 * t)};
      return inverse_equilibrium(robot, pose, {.warm_start = step > 1, .check_stability = false}, work)
          .report.residual;
    }
  };
  return [one = std::make_shared<Case>()] { return one->next(); };
}

/// A robot on pseudo-rigid chains under a load that wanders, its tendon lengths or tensions held.
template <class Space>
Operation chain_statics(const char* name, const typename Space::Pose& pose, int links, bool holds_lengths) {
  struct Case {
    ChainLegs<Space> robot;
    ChainWork work;
    ChainState<Space> state;
    std::vector<TendonConstraint> hold;
    int step = 0;
  };
  auto one = std::make_shared<Case>();
  one->robot = chains_of<Space>(*load(name)->as(Model::prb, PrbDiscretisation::weighted));
  for (auto& leg : one->robot.legs) leg.chain.links = links;
  const std::vector<double> towards_plus(one->robot.legs.size(), 1.0);
  if (!unloaded_equilibrium(one->robot, pose, towards_plus, holds_lengths, one->state).ok()) std::abort();
  one->hold = one->state.hold;
  return [one] {
    const double t = turn(++one->step);
    Vec<double, Space::dof> wrench = Vec<double, Space::dof>::Zero();
    wrench[0] = 0.02 * std::cos(t), wrench[1] = 0.02 * std::sin(t),
    wrench[Space::dof - 1] = 3e-4 * std::sin(2 * t);
    return equilibrium(one->robot, one->hold, wrench, one->state, one->work).residual;
  };
}
Operation planar_chains(int links, bool holds_lengths) {
  return chain_statics<Planar>("3-rfr", PlanarPose{0.01, 0, 0.35}, links, holds_lengths);
}
Operation spatial_chains() {
  SpatialPose pose;
  pose.position = {0, 0, 0.18};
  return chain_statics<Spatial>("6-ufs", pose, 6, true);
}

/// A whole study, of one thread, into a file.
Operation study(const std::string& text) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("sinew-bench-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "study.yaml") << "sinew: 1\n" << text;
  const std::shared_ptr<void> sweeper(nullptr, [folder](void*) { fs::remove_all(folder); });
  return [folder, sweeper] {
    auto done = sweep(read_study((folder / "study.yaml").string()).value(),
                      {.output = folder / "out.h5", .threads = 1});
    return done ? static_cast<double>(done->samples) : std::nan("");
  };
}
Operation sweep_of_equilibria() {
  std::string text = "robot: 3pfs-g2\nquery: {query: forward, inputs: [$a, $b, $c]}\naxes:\n";
  for (const char* name : {"a", "b", "c"})
    text += std::string("  ") + name + ": {from: 400 mm, to: 460 mm, count: 24}\n";
  return study(text);
}
Operation sweep_of_velocities() {
  return study(R"(robot: 3-rfr
query: {query: velocity, pose: {x: $x, y: $y, phi: $phi}}
axes:
  y: {from: -30 mm, to: 30 mm, count: 40}
  x: {from: -30 mm, to: 30 mm, count: 40}
  phi: {from: -20 deg, to: 40 deg, count: 20}
outputs: {determinant: determinant, condition: indices.condition_homogenised}
)");
}

struct Named {
  const char* name;
  std::function<Operation()> make;
};
const Named operations[] = {
    {"3-rfr-jacobians", [] { return jacobians(planar_walk()); }},
    {"3-rfr-forward-warm", [] { return warm_forward(planar_walk()); }},
    {"3-rfr-inverse-warm", [] { return warm_inverse(planar_walk()); }},
    {"3-rfr-all-modes", [] { return all_modes(planar_walk()); }},
    {"6-ufs-jacobians", [] { return jacobians(spatial_walk()); }},
    {"6-ufs-forward-warm", [] { return warm_forward(spatial_walk()); }},
    {"6-ufs-inverse-warm", [] { return warm_inverse(spatial_walk()); }},
    {"3pfs-warm", warm_tripod},
    {"3pfs-cold", cold_tripod},
    {"3pfs-batch-1024", tripod_batch},
    {"hexapod-inverse-warm", warm_hexapod},
    {"3-rfr-chains-6-tensions", [] { return planar_chains(6, false); }},
    {"3-rfr-chains-6-lengths", [] { return planar_chains(6, true); }},
    {"3-rfr-chains-32-tensions", [] { return planar_chains(32, false); }},
    {"3-rfr-chains-32-lengths", [] { return planar_chains(32, true); }},
    {"6-ufs-chains-6-lengths", spatial_chains},
    {"sweep-of-equilibria", sweep_of_equilibria},
    {"sweep-of-velocities", sweep_of_velocities},
};

int run(const Named& named, long count) {
  const Operation operation = named.make();
  double sum = operation();
  const std::clock_t start = std::clock();
  for (long k = 0; k < count; ++k) sum += operation();
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("%.3f\n", 1e9 * seconds / static_cast<double>(count));
  std::fprintf(stderr, "%g\n", sum);  // or nothing need be computed
  return std::isfinite(sum) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3)
    for (const Named& named : operations)
      if (named.name == std::string(argv[1])) return run(named, std::max(1L, std::atol(argv[2])));
  for (const Named& named : operations) std::puts(named.name);
  return argc == 1 ? 0 : 2;
}
