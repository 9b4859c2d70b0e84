/// Hexapods of rods: lengths for a pose, warm along a walk and cold from home, and poses for lengths.
/// Run: build/dev/bin/bench_hexapod. The baseline is the field's own way: 36 unknowns, Cosserat rods by RK4
/// with 40 steps, Jacobian by differences that integrate the one rod they touch.
#include <fmt/format.h>

#include <hwy/highway.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <random>

#include "instruction_sets.hpp"
#include "report.hpp"
#include "robot/parallel.hpp"
#include "robot/rods/mechanism.hpp"
#include "robot/rods/tangent_system.hpp"
#include "shooting_hexapod.hpp"
#include "shooting_rod/shooting_rod.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::bench {
namespace {

/// The public code of docs/performance.md, timed on another machine.
constexpr const char *public_warm = "public code 260000 ns to 3e-10, 126000 ns to 1e-6 (docs/performance.md)",
                     *public_cold = "public code 2500 us, 194 of 200 solved (docs/performance.md)",
                     *public_tilted = "public code 1250 us, 106 of 200 solved (docs/performance.md)";

SpatialPose pose_of(const Vec3<double>& p, const SO3<double>& R) { return spatial_pose(SE3<double>{p, R}); }

/// A platform that wanders `range` to the sides and from 0.37 to 0.58 m, or half as far upwards, in steps of
/// one size, a new direction every 50. Heavy rods, and free platforms, meet folds further out.
struct Walk {
  Robot robot;
  Workspace work;
  std::vector<SpatialPose> poses;
  std::vector<std::vector<double>> lengths;
  std::size_t at = 0;

  Walk(const char* name, double stride, double range) : robot(load(name).value()), work(robot) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Vec3<double> p(0, 0, 0.4), direction(0, 0, 1);
    const auto turn = [&] {
      const double x = uniform(random), y = uniform(random);
      direction = Vec3<double>(x, y, uniform(random)).normalized() * stride;
    };
    for (int k = 0; k < 2048; ++k) {
      if (k % 50 == 0) turn();
      const auto is_inside = [&](const Vec3<double>& q) {
        return std::abs(q[0]) < range && std::abs(q[1]) < range && q[2] > 0.37 && q[2] < 0.37 + 2.1 * range;
      };
      while (!is_inside(p + direction)) turn();
      p += direction;
      poses.push_back(pose_of(p, SO3<double>::identity()));
    }
    poses.insert(poses.end(), poses.rbegin(), poses.rend());  // there and back
  }
  Equilibrium inverse() {
    at = (at + 1) % poses.size();
    return inverse_equilibrium(robot, poses[at], {.warm_start = true, .check_stability = false}, work);
  }
  Equilibrium forward() {
    at = (at + 1) % poses.size();
    return equilibrium(robot, lengths[at], {.warm_start = true, .check_stability = false}, work);
  }
};

/// The field's way along the same walk, warm.
struct FieldWalk {
  std::shared_ptr<Walk> walk;
  test::ShootingHexapod hexapod;
  test::ShootingHexapod::Unknowns state;
  std::size_t at = 0;
  double residual = 0;

  explicit FieldWalk(std::shared_ptr<Walk> same)
      : walk(std::move(same)),
        hexapod(legs_of<RodLeg>(walk->robot), Vec3<double>::Zero(), 40),
        state(hexapod.straight(0.42)) {
    hexapod.solve(state, SE3<double>::from(walk->poses[0]), Vec<double, 6>::Zero(), 1e-10, 60);
  }
  void next() {
    at = (at + 1) % walk->poses.size();
    residual = hexapod.solve(state, SE3<double>::from(walk->poses[at]), Vec<double, 6>::Zero(), 1e-6);
  }
};

/// Largest difference of warm lengths from cold ones of more elements; worst residual, mean iterations.
std::string judge_inverse(const std::shared_ptr<Walk>& walk) {
  Workspace cold(walk->robot);
  double worst = 0, residual = 0, iterations = 0;
  int failures = 0;
  for (std::size_t k = 0; k < walk->poses.size(); ++k) {
    const Equilibrium warm = walk->inverse();
    iterations += warm.report.iterations / static_cast<double>(walk->poses.size());
    failures += !warm.is_solved();
    residual = std::max(residual, warm.report.residual);
    if (k % 64 != 0) continue;
    const Equilibrium exact = inverse_equilibrium(walk->robot, walk->poses[walk->at], {}, cold);
    for (std::size_t i = 0; i < 6; ++i) worst = std::max(worst, std::abs(warm.inputs[i] - exact.inputs[i]));
  }
  return fmt::format("residual {:.0e}, lengths to {:.0e} m, {:.1f} iterations, {} failures", residual, worst,
                     iterations, failures);
}

void compare_inverse(const char* name, double stride, double range, const InstructionSet& isa) {
  hwy::SetSupportedTargetsForTest(isa.target);
  auto walk = std::make_shared<Walk>(name, stride, range);
  inverse_equilibrium(walk->robot, walk->poses[0], {}, walk->work);
  const std::string accuracy = judge_inverse(walk);
  auto field = std::make_shared<FieldWalk>(walk);
  compare({fmt::format("{} inverse {:.1f} mm {}", name, 1e3 * stride, isa.name), "36 unknowns",
           [walk, isa] {
             hwy::SetSupportedTargetsForTest(isa.target);
             benchmark::DoNotOptimize(walk->inverse().report.residual);
           },
           [field] {
             field->next();
             benchmark::DoNotOptimize(field->residual);
           },
           accuracy, 1, std::string_view(name) == "hexapod" && stride == 1e-3 ? public_warm : ""});
}

void compare_forward(const char* name, double stride, const InstructionSet& isa) {
  hwy::SetSupportedTargetsForTest(isa.target);
  auto walk = std::make_shared<Walk>(name, stride, 0.05);
  inverse_equilibrium(walk->robot, walk->poses[0], {}, walk->work);
  for (const SpatialPose& pose : walk->poses) {
    const Equilibrium held =
        inverse_equilibrium(walk->robot, pose, {.warm_start = true, .check_stability = false}, walk->work);
    walk->lengths.emplace_back(held.inputs.begin(), held.inputs.end());
  }
  equilibrium(walk->robot, walk->lengths[0], {.start = walk->poses[0]}, walk->work);
  double worst = 0, iterations = 0;
  int failures = 0;
  for (std::size_t k = 0; k < walk->poses.size(); ++k) {
    const Equilibrium found = walk->forward();
    iterations += found.report.iterations / static_cast<double>(walk->poses.size());
    failures += !found.is_solved();
    worst = std::max(worst, (found.pose.position - walk->poses[walk->at].position).norm());
  }
  auto field = std::make_shared<FieldWalk>(walk);
  compare({fmt::format("{} forward {:.1f} mm {}", name, 1e3 * stride, isa.name), "36 unknowns (inverse)",
           [walk, isa] {
             hwy::SetSupportedTargetsForTest(isa.target);
             benchmark::DoNotOptimize(walk->forward().report.residual);
           },
           [field] {
             field->next();
             benchmark::DoNotOptimize(field->residual);
           },
           fmt::format("position to {:.0e} m, {:.1f} iterations, {} failures", worst, iterations, failures)});
}

/// The classical fourth-order method on p, R, m of an inextensible rod, n constant: what most codes use.
Vec3<double> runge_kutta_tip(const SpatialRod& rod, double length, const RodState<double>& base, int steps) {
  struct Slope {
    Vec3<double> p, m;
    Mat<double, 3, 3> R;
  };
  Vec3<double> p = base.p, m = base.m;
  Mat<double, 3, 3> R = base.R.matrix();
  const Vec3<double> flexibility(1 / rod.bending_stiffness[0], 1 / rod.bending_stiffness[1],
                                 1 / rod.torsion_stiffness);
  const auto slope = [&](const Mat<double, 3, 3>& turned, const Vec3<double>& moment) {
    const Vec3<double> u = flexibility.cwiseProduct(turned.transpose() * moment), t = turned.col(2);
    Mat<double, 3, 3> hat;
    hat << 0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0;
    return Slope{t, -cross(t, base.n), turned * hat};
  };
  const double h = length / steps;
  for (int k = 0; k < steps; ++k) {
    const Slope a = slope(R, m), b = slope(R + h / 2 * a.R, m + h / 2 * a.m);
    const Slope c = slope(R + h / 2 * b.R, m + h / 2 * b.m), d = slope(R + h * c.R, m + h * c.m);
    p += h / 6 * (a.p + 2 * b.p + 2 * c.p + d.p);
    m += h / 6 * (a.m + 2 * b.m + 2 * c.m + d.m);
    R += h / 6 * (a.R + 2 * b.R + 2 * c.R + d.R);
  }
  return p;
}

/// One bent and twisted rod integrated along it: the general rod's method of order 8, and the fourth-order
/// one of the baseline, each with the error of its tip.
template <class Median>
void print_orders(Median&& median) {
  fmt::print("{:>6} {:>9} {:>7} {:>14} {:>16} {:>9}\n", "rod", "steps", "order", "integrated[ns]",
             "derivatives[ns]", "error[m]");
  const SpatialRod rod = SpatialRod::round(207e9, 79e9, 1.3e-3);
  RodState<double> base;
  base.n = Vec3<double>(0.4, -0.2, -0.3);
  base.m = Vec3<double>(0.05, 0.08, 0.02);
  constexpr double length = 0.5;
  const Vec3<double> exact = integrate(rod, length, base, {256}).state.p;
  for (const int steps : {4, 8, 16, 32, 64}) {
    RodTip tip;
    const double integrated = median([&] { tip = integrate(rod, length, base, {steps}); });
    const double derived =
        median([&] { benchmark::DoNotOptimize(integrate_tangent(rod, length, base, {steps})); });
    fmt::print("{:>6} {:>9} {:>7} {:>14.0f} {:>16.0f} {:>9.0e}\n", "1", steps, 8, integrated, derived,
               (tip.state.p - exact).norm());
  }
  for (const int steps : {10, 20, 40, 80, 160}) {
    Vec3<double> tip;
    const double integrated = median([&] { tip = runge_kutta_tip(rod, length, base, steps); });
    fmt::print("{:>6} {:>9} {:>7} {:>14.0f} {:>16} {:>9.0e}\n", "1", steps, 4, integrated, "-",
               (tip - exact).norm());
  }
}

/// What one evaluation and one linearisation cost: against the number of rods, eight of which share the
/// lanes, and of elements, whose polynomials are of order 8.
void print_costs() {
  fmt::print("{:>6} {:>9} {:>7} {:>14} {:>16}\n", "rods", "elements", "order", "evaluation[ns]",
             "linearised[ns]");
  const Robot hexapod = load("hexapod").value();
  const auto six = legs_of<RodLeg>(hexapod);
  const auto median = [](auto&& run) {
    std::vector<double> times;
    for (int k = 0; k < 101; ++k) {
      const auto begin = std::chrono::steady_clock::now();
      for (int i = 0; i < 20; ++i) run();
      times.push_back(
          std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count() / 20);
    }
    std::ranges::nth_element(times, times.begin() + 50);
    return times[50];
  };
  for (const int rods : {1, 6, 8, 12, 24}) {
    std::vector<RodLeg> legs;
    for (int k = 0; k < rods; ++k) legs.push_back(six.legs[static_cast<std::size_t>(k % 6)]);
    Mechanism<TangentSystem> system(ParallelRobot<RodLeg>(legs, six.home, six.platform_radius));
    system.set_platform(SE3<double>::from(six.home));
    system.draw_rods();
    for (;; system.refine()) {
      const double evaluation = median([&] { system.evaluate(); });
      const double linearised = median([&] { system.linearise(); });
      fmt::print("{:>6} {:>9} {:>7} {:>14.0f} {:>16.0f}\n", rods, system.elements(), TangentState::degree,
                 evaluation, linearised);
      if (system.is_finest()) break;
    }
  }
  print_orders(median);
}

/// Random poses from home, every one a new start.
void print_cold(const char* name, double tilt, int count, const char* published = nullptr) {
  const Robot robot = load(name).value();
  Workspace work(robot);
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  std::vector<double> times;
  int solved = 0, stable = 0, folds = 0, elsewhere = 0;
  for (int k = 0; k < count; ++k) {
    const double x = uniform(-0.12, 0.12), y = uniform(-0.12, 0.12), z = uniform(0.35, 0.6);
    const double a = uniform(-tilt, tilt), b = uniform(-tilt, tilt), c = uniform(-tilt, tilt);
    const SpatialPose wanted = pose_of({x, y, z}, SO3<double>::exp(Vec3<double>(a, b, c)));
    const auto begin = std::chrono::steady_clock::now();
    const Equilibrium found = inverse_equilibrium(robot, wanted, {}, work);
    times.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    solved += found.is_solved();
    stable += found.report.ok();
    folds += found.report.status == Status::singular;
    elsewhere +=
        found.is_solved() && found.report.message.view().find("another branch") != std::string_view::npos;
  }
  std::ranges::sort(times);
  fmt::print(
      "{} cold from home, tilt up to {:.2f} rad: {} of {} held ({} stable; {} on another branch than "
      "home's), {} folds named; median {:.0f} us, 95 % {:.0f} us{}{}\n",
      name, tilt, solved, count, stable, elsewhere, folds, times[times.size() / 2],
      times[times.size() * 95 / 100], published ? "; " : "", published ? published : "");
}

/// Rods that bear torque: resumed steps along a walk.
void print_warm(const char* name) {
  Walk walk(name, 1e-3, 0.05);
  inverse_equilibrium(walk.robot, walk.poses[0], {}, walk.work);
  std::vector<double> times;
  double residual = 0;
  int failures = 0;
  for (int k = 0; k < 300; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    const Equilibrium found = walk.inverse();
    times.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    residual = std::max(residual, found.report.residual);
    failures += !found.is_solved();
  }
  std::ranges::sort(times);
  fmt::print("{} inverse 1.0 mm, warm: median {:.0f} us, 95 % {:.0f} us; residual {:.0e}, {} failures\n",
             name, times[times.size() / 2], times[times.size() * 95 / 100], residual, failures);
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew::bench;
  const auto has = hwy::SupportedTargets();
  for (const InstructionSet& isa : instruction_sets)
    if (has & isa.target) {
      for (const double stride : {0.5e-3, 1e-3, 2e-3}) compare_inverse("hexapod", stride, 0.1, isa);
      compare_inverse("hexapod-self-weight", 1e-3, 0.05, isa);
      compare_forward("hexapod", 1e-3, isa);
    }
  hwy::SetSupportedTargetsForTest(0);
  print_cold("hexapod", 0, 1000, public_cold);
  print_cold("hexapod", 0.35, 1000, public_tilted);
  print_cold("hexapod-torsion", 0, 50);
  print_warm("hexapod-torsion");
  print_costs();
  return sinew::bench::main(argc, argv);
}
