/// The hot paths take no memory. Every malloc of this program is counted. Not built with sanitizers: malloc
/// is theirs.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdlib>

#include "base/limits.hpp"
#include "every_robot.hpp"
#include "math/linalg.hpp"
#include "serial_robots.hpp"
#include "sinew.h"
#include "sinew/analysis/velocity.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/kinematics/serial.hpp"

static std::atomic<long> allocations{0};
static void* volatile kept = nullptr;  // so that the compiler cannot elide the allocation

extern "C" void* __libc_malloc(std::size_t);                 // NOLINT: glibc's name
extern "C" void* __libc_calloc(std::size_t, std::size_t);    // NOLINT
extern "C" void* __libc_memalign(std::size_t, std::size_t);  // NOLINT
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
extern "C" void* calloc(std::size_t n, std::size_t size) {
  ++allocations;
  return __libc_calloc(n, size);
}
extern "C" void* aligned_alloc(std::size_t a, std::size_t size) {
  ++allocations;
  return __libc_memalign(a, size);
}

namespace sinew::test {
namespace no_heap_test {

template <class Work>
long allocations_of(Work&& run) {
  const long before = allocations;
  run();
  return allocations - before;
}

class NoHeap : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const auto allocate = [] {
      kept = std::malloc(100);
      std::free(kept);
    };
    ASSERT_GT(allocations_of(allocate), 0) << "the counter does not count";
    ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
    inputs = values(work.inputs);
    coordinates = values(work.coordinates);
  }
  Robot robot = load(GetParam()).value();
  Workspace work{robot};
  std::mt19937 random{4};
  AnyPose pose = reachable_pose(robot, random, work);
  std::vector<double> inputs, coordinates;
};

TEST_P(NoHeap, Assembly) {
  EXPECT_EQ(allocations_of([&] { assemble(robot, pose, coordinates, work); }), 0);
}
TEST_P(NoHeap, Forward) {
  bool ok = false;
  EXPECT_EQ(allocations_of([&] { ok = forward(robot, inputs, {}, work).ok(); }), 0);
  EXPECT_TRUE(ok);
}
TEST_P(NoHeap, ForwardThatFails) {
  std::vector<double> far = inputs, beyond = inputs;
  far.back() *= 0.9;
  far[far.size() - (far.size() > 3 && dof(robot) == 3 ? 3 : 2)] *= 1.1;
  beyond.back() = 0.9;
  EXPECT_EQ(allocations_of([&] { forward(robot, far, {}, work); }), 0);
  EXPECT_EQ(allocations_of([&] { forward(robot, beyond, {}, work); }), 0);
  EXPECT_EQ(allocations_of([&] { forward(robot, inputs, {.max_iterations = 1}, work); }), 0);
}
TEST_P(NoHeap, Inverse) {
  const AnyPose far = moved(pose, Eigen::VectorXd::Unit(dof(robot), 0));
  EXPECT_EQ(allocations_of([&] { inverse(robot, pose, {}, work); }), 0);
  EXPECT_EQ(allocations_of([&] { working_modes(robot, pose, {}, work); }), 0);
  EXPECT_EQ(allocations_of([&] { inverse(robot, far, {}, work); }), 0);
}
TEST_P(NoHeap, Velocity) {
  EXPECT_EQ(allocations_of([&] { velocity(robot, pose, coordinates, work); }), 0);
  const Velocity v = velocity(robot, pose, coordinates, work);
  const std::vector<double> twist(static_cast<std::size_t>(dof(robot)), 0.1);
  EXPECT_EQ(allocations_of([&] { rates(v, twist, work); }), 0);
}

TEST(NoHeapInBatches, InLanesOrOneByOne) {
  const Robot robot = load("3-rfr").value();
  Workspace work(robot);
  const std::vector<double> poses{0, 0.01, 1, 0, 0, 0, 0, 0, 0.1, 0.2, 0, std::numbers::pi / 3};  // 4
  std::vector<double> inputs(12), position(4);
  std::size_t left = 0;
  EXPECT_EQ(allocations_of([&] {
              left = velocity_batch(robot, {poses}, {.inputs = inputs, .position = position}, work);
            }),
            0);
  EXPECT_EQ(left, 1u);
}

INSTANTIATE_TEST_SUITE_P(Builtin, NoHeap, testing::ValuesIn(builtin_robots(false)),
                         [](const auto& robot) { return "robot_" + std::to_string(robot.index); });

/// The first run makes the memory, the others find it.
TEST(NoHeapOfC, ARowByItself) {
  constexpr std::string_view name = "3-rfr",
                             question = R"({"query": "inverse", "pose": {"x": "$x", "y": "$x", "phi": 0}})";
  sinew_robot* robot = nullptr;
  sinew_batch* batch = nullptr;
  ASSERT_EQ(sinew_open(name.data(), name.size(), SINEW_FILE, &robot, nullptr), SINEW_OK);
  ASSERT_EQ(sinew_prepare(robot, question.data(), question.size(), &batch, nullptr), SINEW_OK);
  const double x = 0.01;
  std::array<double, 4> found{};  // inputs and residual
  std::uint8_t status = 0;
  const sinew_input in{&x, 8, 8};
  const sinew_output out[] = {{found.data(), 24, 8}, {found.data() + 3, 8, 8}};
  const auto run = [&] { sinew_run(batch, 1, &in, out, &status, 1, nullptr); };
  run();
  EXPECT_EQ(allocations_of(run), 0);
  EXPECT_EQ(status, 7);
  sinew_release(batch);
  sinew_release(robot);
}

TEST(NoHeapOfRods, ThatBearTorque) {
  auto rods = legs_of<RodLeg>(load("hexapod").value());
  for (RodLeg& leg : rods.legs) leg.is_spin_held = true;
  const Robot robot("held", rods);
  Workspace work(robot);
  const SpatialPose at_home = std::get<SpatialPose>(home(robot));
  SpatialPose beside = at_home;
  beside.position += Vec3<double>(0.01, 0.02, 0.01);
  const auto none = [&](auto&& run) { EXPECT_EQ(allocations_of(run), 0); };
  none([&] { EXPECT_TRUE(inverse_equilibrium(robot, at_home, {}, work).is_solved()); });
  none([&] { EXPECT_TRUE(inverse_equilibrium(robot, beside, {.warm_start = true}, work).is_solved()); });
  const std::vector<double> inputs = values(work.inputs);
  none([&] {
    EXPECT_TRUE(equilibrium(robot, inputs, {.warm_start = true, .check_stability = false}, work).is_solved());
  });
  none([&] { equilibrium(robot, inputs, {.start = at_home}, work); });
}

TEST(NoHeapOfRods, InEquilibriaThatAreFoundOrNot) {
  for (const std::string& name : builtin_robots(true)) {
    const Robot robot = load(name).value();
    Workspace work(robot);
    const SpatialPose at_home = std::get<SpatialPose>(home(robot));
    const bool is_hexapod = input_count(robot) == 6;
    SpatialPose beside = at_home;
    beside.position += Vec3<double>(0.01, 0.02, 0.03);
    ASSERT_TRUE((is_hexapod
                     ? inverse_equilibrium(robot, at_home, {}, work)
                     : inverse_equilibrium(robot, IndependentPose{at_home.position[2], 0, 0}, {}, work))
                    .is_solved());
    std::vector<double> inputs = values(work.inputs);
    SpatialWrench load = SpatialWrench::Zero(), down = SpatialWrench::Zero();
    load << 1, -0.5, -5, 0.2, 0.1, -0.1;
    if (is_hexapod) load *= 0.02;
    down[2] = -1;
    const auto none = [&](auto&& run) { EXPECT_EQ(allocations_of(run), 0) << name; };
    none([&] { EXPECT_TRUE(equilibrium(robot, inputs, {.wrench = load}, work).is_solved()); });
    inputs[0] += 1e-3;
    none([&] {
      EXPECT_TRUE(equilibrium(robot, inputs, {.wrench = load, .warm_start = true}, work).is_solved());
    });
    const RodAnalysis analysis = analyse_equilibrium(robot, work);
    std::vector<double> rates(inputs.size(), 0.01);
    std::array<double, 6> twist{};
    none([&] { EXPECT_TRUE(rod_twist(analysis, rates, twist).ok()); });
    none([&] { EXPECT_TRUE(rod_rates(analysis, twist, rates).ok()); });
    none([&] { inverse_equilibrium(robot, IndependentPose{0.3, 0.1, 0}, {}, work); });
    none([&] { inverse_equilibrium(robot, beside, {}, work); });
    none([&] { inverse_equilibrium(robot, at_home, {.warm_start = true, .check_stability = false}, work); });
    none([&] { equilibrium(robot, inputs, {.start = std::get<SpatialPose>(home(robot))}, work); });
    none([&] { follow_load(robot, down, 500, work); });
    none([&] { equilibrium(robot, inputs, {.wrench = 1000 * down}, work); });
    inputs[1] = 0.005;  // of a tripod out of reach
    bool is_solved = false;
    none([&] { is_solved = equilibrium(robot, inputs, {}, work).is_solved(); });
    EXPECT_TRUE(is_hexapod || robot.rod_count() < leg_count(robot) || !is_solved);
  }
}

TEST(NoHeapOfSerialRobots, FromTendonsToTipAndBack) {
  for (const char* name : {"nottingham-tpcj", "four-tendon-neutral"}) {
    const SerialRobot robot = load_serial(name).value();
    SerialWorkspace work(robot);
    std::mt19937 random(4);
    const std::vector<Bend> bends = random_bends(robot, random);
    const auto none = [&](auto&& run) { EXPECT_EQ(allocations_of(run), 0) << name; };
    none([&] { tendon_changes(bends, kernel::Model::exact, work); });
    std::vector<double> changes = work.changes;
    none([&] { EXPECT_TRUE(bends_of_changes(robot, changes, kernel::Model::exact, work).ok()); });
    changes[0] -= 1e-3;
    none([&] { EXPECT_FALSE(bends_of_changes(robot, changes, kernel::Model::exact, work).ok()); });
    none([&] { tendon_rates(bends, kernel::Model::exact, work); });
    none([&] { tip_motion(bends, work); });
    const SE3<double> tip = work.ends.back();
    const Vec3<double> axis = tip.rotate(Vec3<double>(0, 0, 1));
    none([&] { EXPECT_TRUE(inverse(robot, {tip.p}, {}, work).ok()); });
    none([&] { EXPECT_TRUE(inverse(robot, {tip.p, axis}, {}, work).ok()); });
    none([&] { EXPECT_TRUE(inverse(robot, {tip.p, {}, tip.R}, {}, work).ok()); });
    none([&] { EXPECT_FALSE(inverse(robot, {Vec3<double>(1, 0, 0)}, {}, work).ok()); });
    none([&] { resolved_rate(robot, bends, {{0.01, 0, 0}, {0, 0.1, 0}}, {}, work); });
  }
}

TEST(NoHeapInLinearAlgebra, UpToTheLargestSize) {
  using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto view = [](const Dense& a) { return MatrixView{a.data(), a.rows(), a.cols()}; };
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto any = [&] { return normal(random); };
  for (const int n : {1, 3, 6, 17, max_rows}) {
    for (const int m : {2, max_rows}) {
      const Dense square = Dense::NullaryExpr(n, n, any), wide = Dense::NullaryExpr(n, m, any);
      Dense out(max_rows, max_rows);
      const std::span<double> room(out.data(), static_cast<std::size_t>(out.size()));
      const std::span<const double> b(square.data(), static_cast<std::size_t>(n));
      const MatrixView a = view(square), w = view(wide);
      bool is_regular = false;
      double det = 0;
      EXPECT_EQ(allocations_of([&] {
                  singular_values(a, room);
                  singular_values(w, room);
                  svd(w);
                  is_regular = solve(a, w, room);
                  least_norm(w, b, room);
                  det = determinant(a);
                }),
                0)
          << n << 'x' << m;
      EXPECT_TRUE(is_regular && det != 0);
    }
  }
}

}  // namespace no_heap_test
}  // namespace sinew::test
