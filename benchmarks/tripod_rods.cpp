/// Flexible 3PFS: warm forward kinematics and batches, each on every instruction set this machine has.
/// Run: build/dev/bin/bench_tripod_rods. Cold starts: bench_tripod_campaign.
/// The baseline is the paper's own way: 37 unknowns, rods by RK4 with 40 steps, Jacobian by differences. A
/// row of its own says what is saved where each difference integrates only the rod that owns the unknown.
#include <fmt/format.h>

#include <hwy/highway.h>

#include <algorithm>
#include <memory>
#include <random>

#include "reference_3pfs.hpp"
#include "report.hpp"
#include "shooting_3pfs.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::bench {
namespace {

namespace paper = sinew::test::shooting;

struct Set {
  const char *name, *file;
  double range;  ///< of the walk about home [m]
};
constexpr Set sets[] = {{"G1", "3pfs-g1", 0.012}, {"G2", "3pfs-g2", 0.030}};

struct InstructionSet {
  const char* name;
  std::int64_t target;
};
constexpr InstructionSet instruction_sets[] = {
    {"AVX-512", HWY_AVX3}, {"AVX2", HWY_AVX2}, {"SSSE3", HWY_SSSE3}};

/// Lengths that wander about home in steps of one size, a new direction every 50 steps.
struct Walk {
  Robot robot;
  Workspace work;
  double home;
  std::vector<std::array<double, 3>> lengths;
  std::size_t at = 0;

  Walk(const Set& set, double stride)
      : robot(load(set.file).value()),
        work(robot),
        home(paper::reference(set.name)["L_home"].get<double>()) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::array<double, 3> offset{}, direction{};
    for (int k = 0; k < 4096; ++k) {
      if (k % 50 == 0) {
        for (double& d : direction) d = uniform(random);
        const double norm = std::hypot(direction[0], direction[1], direction[2]);
        for (double& d : direction) d *= stride / norm;
      }
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(offset[i] + direction[i]) > set.range) direction[i] = -direction[i];
        offset[i] += direction[i];
      }
      lengths.push_back({home + offset[0], home + offset[1], home + offset[2]});
    }
    // there and back, so that it may be walked round and round
    lengths.insert(lengths.end(), lengths.rbegin(), lengths.rend());
  }
  Equilibrium next() {
    at = (at + 1) % lengths.size();
    return equilibrium(robot, lengths[at], {.warm_start = true, .check_stability = false}, work);
  }
};

/// Largest difference of the warm poses from cold ones, in metres and as quaternions; mean iterations.
std::string judge(const std::shared_ptr<Walk>& walk) {
  Workspace cold(walk->robot);
  double worst = 0, iterations = 0;
  int failures = 0;
  for (std::size_t k = 0; k < walk->lengths.size(); ++k) {
    const Equilibrium warm = walk->next();
    iterations += warm.report.iterations / static_cast<double>(walk->lengths.size());
    failures += !(warm.report.ok() && warm.report.residual <= 1e-12);
    if (k % 64 != 0) continue;
    const Equilibrium exact = equilibrium(walk->robot, walk->lengths[walk->at], {}, cold);
    worst = std::max(worst, (warm.pose.position - exact.pose.position).norm());
    for (std::size_t c = 0; c < 4; ++c)
      worst = std::max(worst, std::abs(warm.pose.quaternion[c] - exact.pose.quaternion[c]));
  }
  return fmt::format("pose to {:.0e}, {:.1f} iterations, {} failures", worst, iterations, failures);
}

/// The paper's Newton on the same walk, warm.
struct PaperWalk {
  paper::Tripod tripod;
  paper::Solution state;
  std::shared_ptr<Walk> walk;
  paper::Options how;
  std::size_t at = 0;

  PaperWalk(const Set& set, std::shared_ptr<Walk> same, bool by_blocks = false)
      : tripod(paper::tripod(paper::reference(set.name))),
        walk(std::move(same)),
        how(paper::baseline) {
    how.by_blocks = by_blocks;
    const auto home = lengths(0);
    state = paper::solve(tripod, home, {}, paper::first_guess(tripod, home), how);
  }
  paper::PerRod<double> lengths(std::size_t k) const {
    const auto& l = walk->lengths[k];
    return {l[0], l[0], l[1], l[1], l[2], l[2]};
  }
  void next() {
    at = (at + 1) % walk->lengths.size();
    state = paper::solve(tripod, lengths(at), {}, state.v, how);
  }
};

void compare_warm(const Set& set, double stride, const InstructionSet& isa) {
  auto walk = std::make_shared<Walk>(set, stride);
  hwy::SetSupportedTargetsForTest(isa.target);
  equilibrium(walk->robot, walk->lengths[0], {}, walk->work);
  const std::string accuracy = judge(walk);
  auto baseline = std::make_shared<PaperWalk>(set, walk);
  compare({fmt::format("3pfs {} {:.1f} mm {}", set.name, 1e3 * stride, isa.name), "37 unknowns",
           [walk, isa] {
             hwy::SetSupportedTargetsForTest(isa.target);
             benchmark::DoNotOptimize(walk->next().report.residual);
           },
           [baseline] {
             baseline->next();
             benchmark::DoNotOptimize(baseline->state.residual);
           },
           accuracy});
}

/// Batches of so many poses, one after the other along the walk.
void compare_batch(const Set& set, const InstructionSet& isa, std::size_t batch) {
  auto walk = std::make_shared<Walk>(set, 1e-3);
  auto rows = std::make_shared<std::vector<double>>();
  for (const auto& lengths : walk->lengths) rows->insert(rows->end(), lengths.begin(), lengths.end());
  const std::size_t count = walk->lengths.size();
  auto poses = std::make_shared<std::vector<SpatialPose>>(count);
  auto statuses = std::make_shared<std::vector<Status>>(count);
  auto baseline = std::make_shared<PaperWalk>(set, walk);
  const auto run = [walk, rows, poses, statuses, isa, count, batch, first = std::size_t{0}]() mutable {
    hwy::SetSupportedTargetsForTest(isa.target);
    const std::size_t inputs = rows->size() / count;
    equilibrium_batch(walk->robot, std::span(*rows).subspan(first * inputs, batch * inputs),
                      SpatialWrench::Zero(), std::span(*poses).subspan(first, batch),
                      std::span(*statuses).subspan(first, batch), walk->work);
    first = (first + batch) % count;
  };
  auto once = run;
  for (std::size_t k = 0; k < count; k += batch) once();
  Workspace cold(walk->robot);
  double worst = 0;
  for (std::size_t k = 37; k < count; k += 64)  // none that a lane starts with
    worst = std::max(
        worst,
        ((*poses)[k].position - equilibrium(walk->robot, walk->lengths[k], {}, cold).pose.position).norm());
  const auto failures = static_cast<std::ptrdiff_t>(count) - std::ranges::count(*statuses, Status::converged);
  compare({fmt::format("3pfs {} a pose of {} {}", set.name, batch, isa.name), "37 unknowns", run,
           [baseline] {
             baseline->next();
             benchmark::DoNotOptimize(baseline->state.residual);
           },
           fmt::format("position to {:.0e} m, {} failures", worst, failures), static_cast<double>(batch)});
}

/// The paper's way with less work, beside the paper's.
void compare_blocks(const Set& set) {
  auto walk = std::make_shared<Walk>(set, 1e-3);
  auto blocks = std::make_shared<PaperWalk>(set, walk, true), plain = std::make_shared<PaperWalk>(set, walk);
  const auto next = [](const std::shared_ptr<PaperWalk>& one) {
    return [one] {
      one->next();
      benchmark::DoNotOptimize(one->state.residual);
    };
  };
  double worst = 0;
  for (int k = 0; k < 50; ++k) {
    next(blocks)();
    next(plain)();
    worst = std::max(worst, (blocks->state.v - plain->state.v).cwiseAbs().maxCoeff());
  }
  compare({fmt::format("37 unknowns by blocks {} 1.0 mm", set.name), "37 unknowns", next(blocks), next(plain),
           fmt::format("unknowns differ by {:.0e}", worst)});
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew::bench;
  const auto has = hwy::SupportedTargets();
  for (const InstructionSet& isa : instruction_sets)
    if (has & isa.target)
      for (const Set& set : sets)
        for (const double stride : {0.5e-3, 1e-3, 2e-3}) compare_warm(set, stride, isa);
  for (const InstructionSet& isa : instruction_sets)
    if (has & isa.target)
      for (const Set& set : sets) {
        for (const std::size_t batch : {1024U, 8192U}) compare_batch(set, isa, batch);
      }
  for (const Set& set : sets) compare_blocks(set);
  return sinew::bench::main(argc, argv);
}
