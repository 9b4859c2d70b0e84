/// Tendon changes of serial robots: LSK and exact PCC, against the double loop of the paper's (5); how both
/// grow with the number of sections; many poses in SIMD lanes. Run: build/dev/bin/bench_serial_kernel
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "report.hpp"
#include "sinew/kernel/serial.h"
#include "sinew/kinematics/serial.hpp"

namespace sinew::bench {
namespace {

constexpr double limit = 24 * std::numbers::pi / 180;

constexpr std::size_t count = 64;

template <std::size_t M>
struct Walk {
  kernel::Serial<M, 3, double> robot =
      kernel::make_serial<M, 3, double>(kernel::Backbone::twin_pivot, 8, 2.375e-3, 2.45e-3, limit);
  std::vector<std::array<kernel::Bend<double>, M>> poses;
  double changes[M][3] = {};

  Walk() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> bend(-limit, limit);
    for (std::size_t k = 0; k < count; ++k) {
      auto& pose = poses.emplace_back();
      for (auto& b : pose) b = {bend(random), bend(random)};
    }
  }
  using Pose = const kernel::Bend<double> (&)[M];
  Pose pose(std::size_t k) const {
    return *reinterpret_cast<const kernel::Bend<double>(*)[M]>(poses[k].data());
  }

  /// All poses, one after the other: the clock and the call count for little.
  template <kernel::Model model>
  void sweep() {
    for (std::size_t k = 0; k < count; ++k) {
      robot.template changes<model>(pose(k), changes);
      benchmark::DoNotOptimize(changes);
    }
  }
  template <class F>
  void sweep_loop(F&& loop) {
    for (std::size_t k = 0; k < count; ++k) {
      loop(pose(k), changes);
      benchmark::DoNotOptimize(changes);
    }
  }
};

/// (5) as the paper counts it: every tendon of every section is summed anew over the sections it passes, each
/// joint by (2).
template <std::size_t M>
void double_loop(const kernel::Bend<double> (&bends)[M], double (&changes)[M][3]) {
  constexpr double L = 2.375e-3, r = 2.45e-3;
  constexpr int N = 8;
  for (std::size_t m = 0; m < M; ++m)
    for (std::size_t i = 0; i < 3; ++i) {
      const double d = static_cast<double>(m + 1) * limit + 2 * std::numbers::pi * static_cast<double>(i) / 3;
      double length = 0;
      for (std::size_t k = 0; k <= m; ++k) {
        const double x = bends[k].x, y = bends[k].y;
        length +=
            N * ((L / x - r * std::cos(d)) * std::sin(x / 2) + (L / y - r * std::sin(d)) * std::sin(y / 2));
      }
      changes[m][i] = length - static_cast<double>(m + 1) * N * L;
    }
}

template <std::size_t M>
double largest_gap() {
  Walk<M> walk;
  double gap = 0, theirs[M][3];
  for (std::size_t k = 0; k < walk.poses.size(); ++k) {
    const auto& bends = walk.pose(k);
    walk.robot.template changes<kernel::Model::exact>(bends, walk.changes);
    double_loop(bends, theirs);
    for (std::size_t m = 0; m < M; ++m)
      for (std::size_t i = 0; i < 3; ++i) gap = std::max(gap, std::abs(walk.changes[m][i] - theirs[m][i]));
  }
  return gap;
}

template <std::size_t M, kernel::Model model>
void compare_one(const char* name) {
  auto walk = std::make_shared<Walk<M>>();
  auto theirs = std::make_shared<Walk<M>>();
  compare({fmt::format("{}, {} sections", name, M), "double loop", [walk] { walk->template sweep<model>(); },
           [theirs, k = std::size_t{0}]() mutable {
             double_loop(theirs->pose(k), theirs->changes);
             benchmark::DoNotOptimize(theirs->changes);
             k = (k + 1) % count;
           },
           model == kernel::Model::exact ? fmt::format("changes to {:.0e} m", largest_gap<M>())
                                         : std::string("linearised: 0.7 % of a length at 24 deg"),
           static_cast<double>(count)});
}

/// The library's own, of a robot whose size is known at run time; and many poses at once.
void compare_library() {
  struct Many {
    SerialRobot robot;
    std::unique_ptr<SerialWorkspace> work;
    std::vector<double> bends, changes;
    Walk<5> walk;
  };
  constexpr std::size_t poses = count;
  auto many = std::make_shared<Many>();
  for (int m = 1; m <= 5; ++m) {
    Section section;
    section.joint = 2.375e-3;
    section.disc_height = 2e-3;
    section.tendon_radius = 2.45e-3;
    section.tendon_angle = m * limit;
    many->robot.sections.push_back(section);
  }
  many->work = std::make_unique<SerialWorkspace>(many->robot);
  many->bends.resize(10 * poses);
  many->changes.resize(15 * poses);
  for (std::size_t k = 0; k < poses; ++k)
    for (std::size_t m = 0; m < 5; ++m) {
      many->bends[2 * m * poses + k] = many->walk.poses[k][m].x;
      many->bends[(2 * m + 1) * poses + k] = many->walk.poses[k][m].y;
    }
  for (const auto model : {kernel::Model::linear, kernel::Model::exact})
    compare({fmt::format("{}, 5 sections, a pose of {}", model == kernel::Model::linear ? "LSK" : "PCC exact",
                         poses),
             "double loop",
             [many, model] {
               tendon_changes_batch(many->bends, model, many->changes, *many->work);
               benchmark::DoNotOptimize(many->changes.data());
             },
             [many, k = std::size_t{0}]() mutable {
               double_loop(many->walk.pose(k), many->walk.changes);
               benchmark::DoNotOptimize(many->walk.changes);
               k = (k + 1) % count;
             },
             "in SIMD lanes", static_cast<double>(poses)});
}

template <class F>
double nanoseconds(F&& run) {
  std::vector<double> times;
  for (int repeat = 0; repeat < 31; ++repeat) {
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < 200; ++k) run();
    times.push_back(
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
        static_cast<double>(200 * count));
  }
  std::nth_element(times.begin(), times.begin() + 15, times.end());
  return times[15];
}

struct Growth {
  std::vector<double> sections, linear, exact, loop;
};

template <std::size_t M>
void grow(Growth& growth) {
  Walk<M> walk;
  growth.sections.push_back(M);
  growth.linear.push_back(nanoseconds([&] { walk.template sweep<kernel::Model::linear>(); }));
  growth.exact.push_back(nanoseconds([&] { walk.template sweep<kernel::Model::exact>(); }));
  growth.loop.push_back(nanoseconds([&] { walk.sweep_loop(double_loop<M>); }));
}

/// Slope of log time over log sections, least squares.
double exponent(const std::vector<double>& sections, const std::vector<double>& times) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double a = std::log(sections[k]), b = std::log(times[k]);
    x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void print_growth() {
  Growth growth;
  grow<3>(growth), grow<4>(growth), grow<5>(growth), grow<6>(growth), grow<8>(growth), grow<10>(growth);
  std::printf("time grows with M^p, M from 3 to 10: LSK p = %.2f, PCC exact p = %.2f, double loop p = %.2f\n",
              exponent(growth.sections, growth.linear), exponent(growth.sections, growth.exact),
              exponent(growth.sections, growth.loop));
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew;
  bench::compare_one<5, kernel::Model::linear>("LSK");
  bench::compare_one<5, kernel::Model::exact>("PCC exact");
  bench::compare_one<10, kernel::Model::exact>("PCC exact");
  bench::compare_library();
  const int status = bench::main(argc, argv);
  bench::print_growth();
  return status;
}
