/// Serial robots of [LSK] Table 2: the tip's Jacobian, the bends to a target, resolved rates.
/// Run: build/dev/bin/bench_serial_inverse
/// The baselines are what one writes first: products of 4×4 matrices, differences, a pseudoinverse, bends cut
/// off at their limits.
#include <fmt/format.h>

#include <memory>
#include <numbers>
#include <random>

#include "math/linalg.hpp"
#include "report.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::bench {
namespace {

using kernel::Backbone;
using Bends = std::vector<Bend>;
constexpr double degree = std::numbers::pi / 180;

SerialRobot table_2(Backbone backbone, int count) {
  SerialRobot robot;
  for (int m = 1; m <= count; ++m) {
    Section section;
    section.backbone = backbone;
    section.joint = 2.375e-3;
    section.disc_height = 2e-3;
    section.tendon_radius = 2.45e-3;
    section.tendon_angle = 24 * degree * m;
    section.limit = (section.is_twin() ? 1 : section.segments) * 24 * degree;
    robot.sections.push_back(section);
  }
  return robot;
}

Bends random_bends(const SerialRobot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Bends bends;
  for (const Section& section : robot.sections) {
    Bend bend(any(random), any(random));
    while (!section.is_twin() && bend.norm() > 1) bend = Bend(any(random), any(random));
    bends.push_back(section.limit * bend);
  }
  return bends;
}

enum class Task { position, direction, pose };
constexpr const char* names[] = {"position", "position + direction", "pose"};

TipTarget target_of(const SE3<double>& tip, Task task) {
  TipTarget target{.position = tip.p};
  if (task == Task::direction) target.direction = tip.rotate(Vec3<double>(0, 0, 1));
  if (task == Task::pose) target.rotation = tip.R;
  return target;
}

/// A robot on a smooth path of its tip through its workspace and along its limits, steps of about 1 mm.
struct Walk {
  SerialRobot robot;
  SerialWorkspace work{robot};
  std::vector<Bends> bends;
  std::vector<TipTarget> targets;
  std::size_t step = 0;

  Walk(Backbone backbone, Task task) : robot(table_2(backbone, 5)) {
    constexpr int count = 2560;
    for (int i = 0; i < count; ++i) {
      Bends at;
      for (std::size_t m = 0; m < 5; ++m) {
        const double t = 2 * std::numbers::pi * i / count, limit = 0.7 * robot.sections[m].limit;
        const auto k = static_cast<double>(m);
        at.emplace_back(limit * std::sin((2 + static_cast<double>(m % 3)) * t + 2 * k),
                        limit * std::cos((3 - static_cast<double>(m % 2)) * t + k));
      }
      section_ends(at, work);
      bends.push_back(at);
      targets.push_back(target_of(work.ends.back(), task));
    }
    for (std::size_t m = 0; m < 5; ++m) work.bends[m] = bends[0][m];
  }
  std::size_t next() { return step = (step + 1) % targets.size(); }
  SerialInverse follow() { return inverse(robot, targets[next()], {.start = work.bends}, work); }
  double millimetres() const {
    double sum = 0;
    for (std::size_t i = 1; i < targets.size(); ++i)
      sum += (targets[i].position - targets[i - 1].position).norm();
    return 1e3 * sum / static_cast<double>(targets.size() - 1);
  }
};

/// Poses as (3) and (4) say: one matrix a joint and a disc.
Eigen::Matrix4d product_of_matrices(const SerialRobot& robot, const Bends& bends) {
  Eigen::Matrix4d end = Eigen::Matrix4d::Identity();
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const Section& section = robot.sections[m];
    for (int i = 0; i < section.segments; ++i) {
      const Bend bend = !section.is_twin() ? Bend(bends[m] / section.segments)
                        : i % 2 == 0       ? Bend(0, bends[m].y())
                                           : Bend(bends[m].x(), 0);
      const double a = bend.norm(), c = std::cos(a), s = std::sin(a), x = a > 0 ? bend.x() / a : 1,
                   y = a > 0 ? bend.y() / a : 0, side = a > 0 ? section.joint * (1 - c) / a : 0,
                   ahead = a > 0 ? section.joint * s / a : section.joint;
      Eigen::Matrix4d joint, disc = Eigen::Matrix4d::Identity();
      joint << 1 + (c - 1) * x * x, (c - 1) * x * y, s * x, side * x,  //
          (c - 1) * x * y, 1 + (c - 1) * y * y, s * y, side * y,       //
          -s * x, -s * y, c, ahead,                                    //
          0, 0, 0, 1;
      disc(2, 3) = section.disc_height;
      end = end * joint * disc;
    }
  }
  return end;
}

Vec<double, 6> gap(const Eigen::Matrix4d& from, const Eigen::Matrix4d& to) {
  const Eigen::Matrix3d turn = to.topLeftCorner<3, 3>() * from.topLeftCorner<3, 3>().transpose();
  Vec<double, 6> gap;
  gap << to.topRightCorner<3, 1>() - from.topRightCorner<3, 1>(), (turn(2, 1) - turn(1, 2)) / 2,
      (turn(0, 2) - turn(2, 0)) / 2, (turn(1, 0) - turn(0, 1)) / 2;
  return gap;
}

Eigen::Matrix<double, 6, 10> differences(const SerialRobot& robot, Bends bends) {
  Eigen::Matrix<double, 6, 10> J;
  const Eigen::Matrix4d here = product_of_matrices(robot, bends);
  for (int j = 0; j < 10; ++j) {
    double& bend = bends[static_cast<std::size_t>(j / 2)][j % 2];
    const double before = bend;
    bend += 1e-7;
    J.col(j) = gap(here, product_of_matrices(robot, bends)) / 1e-7;
    bend = before;
  }
  return J;
}

/// Position and direction by the pseudoinverse, bends cut off at their limits. Returns what is missed at the
/// end.
double pseudoinverse_on_differences(const SerialRobot& robot, const TipTarget& target, Bends& bends,
                                    int most) {
  double missed = 1;
  for (int i = 0; i < most; ++i) {
    const Eigen::Matrix4d tip = product_of_matrices(robot, bends);
    const Eigen::Vector3d axis = tip.block<3, 1>(0, 2), wanted = *target.direction;
    Vec<double, 6> miss;
    miss << (Eigen::Vector3d(target.position) - tip.topRightCorner<3, 1>()) / robot.length(),
        cross(axis, wanted);
    missed = miss.norm();
    if (missed < 1e-12) break;
    Eigen::Matrix<double, 6, 10, Eigen::RowMajor> J = differences(robot, bends);
    J.topRows<3>() /= robot.length();
    J.bottomRows<3>() -= axis * (axis.transpose() * J.bottomRows<3>()).eval();
    std::array<double, 10> step;
    least_norm(MatrixView(J.data(), 6, 10), {miss.data(), 6}, step, 1e-8);
    for (int j = 0; j < 10; ++j) {
      const auto m = static_cast<std::size_t>(j / 2);
      bends[m][j % 2] = std::clamp(bends[m][j % 2] + step[static_cast<std::size_t>(j)],
                                   -robot.sections[m].limit, robot.sections[m].limit);
    }
  }
  return missed;
}

const char* name(Backbone backbone) { return backbone == Backbone::neutral ? "neutral" : "twin-pivot"; }

void compare_jacobian(Backbone backbone) {
  auto walk = std::make_shared<Walk>(backbone, Task::pose);
  double worst = 0;
  for (std::size_t i = 0; i < walk->bends.size(); i += 16) {
    tip_motion(walk->bends[i], walk->work);
    worst = std::max(
        worst, (walk->work.jacobian() - differences(walk->robot, walk->bends[i])).cwiseAbs().maxCoeff());
  }
  compare({fmt::format("{} x 5: tip's Jacobian", name(backbone)), "differences of products of matrices",
           [walk] {
             tip_motion(walk->bends[walk->next()], walk->work);
             benchmark::DoNotOptimize(walk->work.J.data());
           },
           [walk] { benchmark::DoNotOptimize(differences(walk->robot, walk->bends[walk->next()])); },
           fmt::format("differences are off by up to {:.0e}, ours by rounding", worst)});
}

void compare_warm(Backbone backbone, Task task) {
  auto walk = std::make_shared<Walk>(backbone, task),
       direction = std::make_shared<Walk>(backbone, Task::direction);
  double iterations = 0, error = 0;
  int near = 0;
  const auto count = static_cast<double>(walk->targets.size());
  for (std::size_t i = 0; i < walk->targets.size(); ++i) {
    const SerialInverse answer = walk->follow();
    iterations += answer.report.iterations / count;
    error = std::max(error, answer.report.residual);
    near += answer.ok() && answer.start == 0;
  }
  compare({fmt::format("{} x 5: {}, warm", name(backbone), names[static_cast<int>(task)]),
           "position + direction by pseudoinverse on differences",
           [walk] { benchmark::DoNotOptimize(walk->follow().report.residual); },
           [direction] {
             const std::size_t i = direction->next();
             Bends bends = direction->bends[i == 0 ? direction->bends.size() - 1 : i - 1];
             benchmark::DoNotOptimize(
                 pseudoinverse_on_differences(direction->robot, direction->targets[i], bends, 10));
           },
           fmt::format("steps of {:.1f} mm in {:.1f} iterations to {:.0e} m, {:.2f} % without another start",
                       walk->millimetres(), iterations, error, 100 * near / count)});
}

/// Random targets in reach, each from the straight robot.
struct Cold {
  SerialRobot robot;
  SerialWorkspace work{robot};
  std::vector<TipTarget> targets;
  std::size_t step = 0;
  Cold(Backbone backbone, Task task, int sections, int count) : robot(table_2(backbone, sections)) {
    std::mt19937 random(1);
    for (int i = 0; i < count; ++i) {
      section_ends(random_bends(robot, random), work);
      targets.push_back(target_of(work.ends.back(), task));
    }
  }
  const TipTarget& next() { return targets[step = (step + 1) % targets.size()]; }
};

void compare_cold(Backbone backbone, Task task, int sections) {
  auto cold = std::make_shared<Cold>(backbone, task, sections, 100000),
       other = std::make_shared<Cold>(backbone, Task::direction, 5, 200);
  int found = 0, found_otherwise = 0;
  for (const TipTarget& target : cold->targets) found += inverse(cold->robot, target, {}, cold->work).ok();
  for (const TipTarget& target : other->targets) {
    Bends straight(5, Bend(0, 0));
    found_otherwise += pseudoinverse_on_differences(other->robot, target, straight, 100) < 1e-12;
  }
  compare({fmt::format("{} x {}: {}, cold", name(backbone), sections, names[static_cast<int>(task)]),
           "position + direction of 5 by pseudoinverse on differences",
           [cold] {
             benchmark::DoNotOptimize(inverse(cold->robot, cold->next(), {}, cold->work).report.residual);
           },
           [other] {
             Bends straight(5, Bend(0, 0));
             benchmark::DoNotOptimize(
                 pseudoinverse_on_differences(other->robot, other->next(), straight, 100));
           },
           fmt::format("{} of {} found to 1e-12 of the length, of the baseline {} of {}", found,
                       cold->targets.size(), found_otherwise, other->targets.size())});
}

void compare_rates() {
  auto walk = std::make_shared<Walk>(Backbone::twin_pivot, Task::pose);
  const TipTwist twist{Vec3<double>(0.01, 0.02, -0.01), Vec3<double>(0.1, 0, 0.2)};
  double missed = 0;
  for (const Bends& bends : walk->bends)
    missed = std::max(missed, resolved_rate(walk->robot, bends, twist, {}, walk->work).report.residual);
  compare({"twin-pivot x 5: resolved rates", "pseudoinverse by SVD, without limits and tendons",
           [walk, twist] {
             benchmark::DoNotOptimize(
                 resolved_rate(walk->robot, walk->bends[walk->next()], twist, {}, walk->work).held);
           },
           [walk, twist] {
             tip_motion(walk->bends[walk->next()], walk->work);
             std::array<double, 10> out;
             Vec<double, 6> t;
             t << twist.linear, twist.angular;
             benchmark::DoNotOptimize(least_norm(walk->work.jacobian(), {t.data(), 6}, out));
           },
           fmt::format("misses at most {:.0e} m/s of {:.0e}", missed, twist.linear.norm())});
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew::bench;
  for (const auto backbone : {Backbone::twin_pivot, Backbone::neutral}) {
    compare_jacobian(backbone);
    for (const Task task : {Task::position, Task::direction, Task::pose}) compare_warm(backbone, task);
    for (const Task task : {Task::position, Task::direction, Task::pose}) compare_cold(backbone, task, 5);
  }
  compare_cold(Backbone::twin_pivot, Task::pose, 3);
  compare_rates();
  return sinew::bench::main(argc, argv);
}
