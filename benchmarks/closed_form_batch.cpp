/// Robots whose legs close in closed form: inverse kinematics and velocity analysis of many poses, one a
/// lane, beside the same pose by pose. Run: build/dev/bin/bench_closed_form_batch
#include <fmt/format.h>

#include <memory>
#include <random>

#include "instruction_sets.hpp"
#include "report.hpp"
#include "robot/parallel.hpp"
#include "sinew/analysis/velocity.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::bench {
namespace {

void choose(const InstructionSet& set) {
  hwy::SetSupportedTargetsForTest(set.target);
  hwy::GetChosenTarget().Update(set.target);
}

enum class Asked { everything, homogenised, determinant, inputs };

/// Random poses that the robot reaches, all that is to be known of them, and one by one the same.
struct Batch {
  static constexpr std::size_t poses = 4096;

  Robot robot;
  Workspace work;
  std::vector<AnyPose> each;
  std::vector<double> axes, inputs, determinant, condition, homogenised, position, rotation;
  std::vector<Status> status = std::vector<Status>(poses);
  VelocityBatch out;
  std::size_t left = 0, next = 0;

  Batch(const std::string& name, Asked asked) : robot(load(name).value()), work(robot) {
    const std::size_t legs = static_cast<std::size_t>(leg_count(robot));
    std::mt19937 random{5};
    while (each.size() < poses) {
      const AnyPose pose = random_pose(random);
      if (inverse(robot, pose, {}, work).ok()) each.push_back(pose);
    }
    put_axes();
    inputs.resize(legs * poses);
    for (auto* numbers : {&determinant, &condition, &homogenised, &position, &rotation})
      numbers->resize(poses);
    ask(asked);
  }

  AnyPose random_pose(std::mt19937& random) const {
    std::uniform_real_distribution<double> shift(-0.04, 0.04), turn(-0.5, 0.5);
    if (dof(robot) == 3) return PlanarPose{shift(random), shift(random), turn(random)};
    if (plane_count(robot) == 3)
      return constrained_pose(robot, {0.5 + shift(random), turn(random), turn(random)}).pose;
    Vec<double, 6> step;
    for (int k = 0; k < 6; ++k) step[k] = k < 3 ? shift(random) : turn(random);
    return Spatial::moved(std::get<SpatialPose>(home(robot)), step);
  }

  void put_axes() {
    axes.resize((dof(robot) == 3 ? 3 : 7) * poses);
    for (std::size_t k = 0; k < poses; ++k) {
      const auto put = [&](std::size_t axis, double value) { axes[axis * poses + k] = value; };
      if (const auto* planar = std::get_if<PlanarPose>(&each[k])) {
        put(0, planar->x), put(1, planar->y), put(2, planar->phi);
      } else {
        const auto& pose = std::get<SpatialPose>(each[k]);
        for (std::size_t a = 0; a < 3; ++a) put(a, pose.position[static_cast<int>(a)]);
        for (std::size_t a = 0; a < 4; ++a) put(3 + a, pose.quaternion[a]);
      }
    }
  }

  void ask(Asked asked) {
    out.inputs = inputs;
    if (asked == Asked::inputs) return;
    out.status = status;
    out.determinant = determinant;
    if (asked == Asked::determinant) return;
    out.condition_homogenised = homogenised;
    if (asked == Asked::homogenised) return;
    out.condition = condition;
    out.position = position;
    out.rotation = rotation;
  }

  void run() { left = velocity_batch(robot, {axes}, out, work); }

  Inverse one_inverse() {
    next = (next + 1) % poses;
    return inverse(robot, each[next], {}, work);
  }
  Velocity one() {
    const Inverse solved = one_inverse();
    return velocity(robot, each[next], solved.coordinates, work);
  }

  /// What the batch got right of what was asked.
  std::string accuracy() {
    run();
    double length = 0, index = 0;
    for (std::size_t count = 0; count < poses; ++count) {
      const Velocity at = one();
      for (std::size_t i = 0; i < work.inputs.size(); ++i)
        length = std::max(length, std::abs(inputs[i * poses + next] - work.inputs[i]));
      const auto compare = [&](std::span<double> found, double expected) {
        if (!found.empty()) index = std::max(index, std::abs(found[next] / expected - 1));
      };
      compare(out.determinant, at.determinant);
      compare(out.condition, at.indices.condition);
      compare(out.condition_homogenised, at.indices.condition_homogenised);
      compare(out.position, at.indices.position);
      compare(out.rotation, at.indices.rotation);
    }
    return fmt::format("inputs to {:.0e} m, indices to {:.0e}, {} of {} poses left", length, index, left,
                       poses);
  }
};

void compare_batch(const std::string& name, Asked asked, const char* what, const InstructionSet& set) {
  if (!set.is_there()) return;
  choose(set);
  auto batch = std::make_shared<Batch>(name, asked);
  const std::string accuracy = batch->accuracy();
  hwy::SetSupportedTargetsForTest(0);
  compare({fmt::format("{} {} {}", name, what, set.name),
           asked == Asked::inputs ? "inverse" : "inverse, velocity",
           [batch, set] {
             choose(set);
             batch->run();
             benchmark::DoNotOptimize(batch->inputs.data());
             benchmark::ClobberMemory();
           },
           [batch, asked] {
             if (asked == Asked::inputs)
               benchmark::DoNotOptimize(batch->one_inverse().inputs.data());
             else
               benchmark::DoNotOptimize(batch->one().determinant);
           },
           accuracy, Batch::poses});
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew::bench;
  for (const InstructionSet& set : instruction_sets)
    for (const char* name : {"3-rfr", "6-ufs", "3prs"})
      compare_batch(name, Asked::everything, "everything", set);
  const InstructionSet& widest = instruction_sets[0];
  compare_batch("3-rfr", Asked::homogenised, "one condition", widest);
  compare_batch("3-rfr", Asked::determinant, "determinant", widest);
  compare_batch("3-rfr", Asked::inputs, "inputs", widest);
  return sinew::bench::main(argc, argv);
}
