/// The hot paths take no memory. Every malloc of this program is counted (under AddressSanitizer, which owns
/// malloc, the test has nothing to count and says so).
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "every_robot.hpp"
#include "sinew/analysis/velocity.hpp"

namespace {
std::atomic<long> allocations{0};
void* volatile kept = nullptr;  // so that the compiler cannot elide the allocation
}

#if !defined(__SANITIZE_ADDRESS__)
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
#endif

namespace sinew::test {
namespace {

template <class Work>
long allocations_of(Work&& run) {
  const long before = allocations;
  run();
  return allocations - before;
}

class NoHeap : public testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "AddressSanitizer owns malloc";
#endif
    const auto allocate = [] {
      kept = std::malloc(100);
      std::free(kept);
    };
    ASSERT_GT(allocations_of(allocate), 0) << "the counter does not count";
    ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
    inputs = values(work.inputs);
    coordinates = values(work.coordinates);
  }
  AnyRobot robot = load(std::string(GetParam())).value();
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

INSTANTIATE_TEST_SUITE_P(Builtin, NoHeap, testing::ValuesIn(builtin_robot_names()),
                         [](const auto& robot) { return "robot_" + std::to_string(robot.index); });

}  // namespace
}  // namespace sinew::test
