/// Planar tendon-driven robots: J + K, inverse and warm forward kinematics. Run: build/dev/bin/bench_planar
/// The baselines are what one writes first, straight from the paper: residuals only, differences for
/// derivatives.
#include <fmt/format.h>

#include <Eigen/LU>
#include <memory>

#include "report.hpp"
#include "robot/parallel.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::bench {
namespace {

using Unknowns = Eigen::Matrix<double, 6, 1>;  // x, y, φ, and three inputs

/// A robot on a smooth walk inside its workspace, steps of about 0.5 mm and 0.25°.
struct Walk {
  Robot robot;
  Workspace work;
  std::vector<PlanarPose> poses;
  std::vector<std::vector<double>> inputs, coordinates;
  std::size_t step = 0;

  explicit Walk(const std::string& name) : robot(load(name).value()), work(robot) {
    for (int i = 0; i < 1024; ++i) {
      const double t = 2 * std::numbers::pi * i / 256;
      const PlanarPose pose{0.015 * std::cos(t), 0.015 * std::sin(t) - 0.01, 0.1 * std::sin(t)};
      if (!inverse(robot, pose, {}, work).ok()) continue;
      poses.push_back(pose);
      inputs.emplace_back(work.inputs);
      coordinates.emplace_back(work.coordinates);
    }
  }
  std::size_t next() { return step = (step + 1) % poses.size(); }
  std::size_t before(std::size_t i) const { return (i + poses.size() - 1) % poses.size(); }
};

/// Closure residuals as the paper writes them: (1) with (7), (21) with (25); undefined at κ = 0.
double residual_as_printed(const Leg<Planar, Arc, TendonPair, Chord>& leg, const Eigen::Vector2d& point,
                           double l1) {
  const double length = leg.link.length, curvature = (length - l1) / (leg.drive.offset * length);
  return (point - Eigen::Vector2d(leg.base.p)).squaredNorm() / 2 -
         std::pow(2 / curvature * std::sin(length * curvature / 2), 2) / 2;
}

double residual_as_printed(const Leg<Planar, Arc, TendonPair, Strut>& leg, const Eigen::Vector2d& point,
                           double l1) {
  const double length = leg.link.length, curvature = (length - l1) / (leg.drive.offset * length);
  const double u = (1 - std::cos(length * curvature)) / curvature,
               w = std::sin(length * curvature) / curvature;
  const Eigen::Vector2d tip(leg.base.p[0] + leg.base.c * u - leg.base.s * w,
                            leg.base.p[1] + leg.base.s * u + leg.base.c * w);
  return ((point - tip).squaredNorm() - leg.closure.length * leg.closure.length) / 2;
}

/// All residuals of a robot at (pose, inputs).
Eigen::Vector3d residuals_as_printed(const Robot& any, const Unknowns& z) {
  const double c = std::cos(z[2]), s = std::sin(z[2]);
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  any.planar()->for_each_leg([&]<class LegT>(const LegT& leg, const LegPlace&, int i) {
    const auto& b = leg.platform_point;
    if constexpr (requires { residual_as_printed(leg, Eigen::Vector2d(), 0.0); })
      g[i] = residual_as_printed(leg, {z[0] + c * b[0] - s * b[1], z[1] + s * b[0] + c * b[1]}, z[3 + i]);
  });
  return g;
}

/// Central differences by all six unknowns: 12 evaluations.
Eigen::Matrix<double, 3, 6> differences(const Robot& robot, const Unknowns& z, int columns) {
  Eigen::Matrix<double, 3, 6> jacobian;
  for (int j = 0; j < columns; ++j) {
    Unknowns ahead = z, behind = z;
    const double h = 1e-6;
    ahead[j] += h;
    behind[j] -= h;
    jacobian.col(j) = (residuals_as_printed(robot, ahead) - residuals_as_printed(robot, behind)) / (2 * h);
  }
  return jacobian;
}

Unknowns unknowns(const PlanarPose& pose, const std::vector<double>& inputs) {
  Unknowns z;
  z << pose.x, pose.y, pose.phi, inputs[0], inputs[1], inputs[2];
  return z;
}

void compare_jacobians(const std::string& name) {
  auto walk = std::make_shared<Walk>(name);
  double gap = 0;
  for (std::size_t i = 0; i < walk->poses.size(); ++i) {
    const Reduced reduced = assemble(walk->robot, walk->poses[i], walk->coordinates[i], walk->work);
    const auto fd = differences(walk->robot, unknowns(walk->poses[i], walk->inputs[i]), 6);
    gap =
        std::max(gap, (fd.leftCols<3>() - reduced.J).cwiseAbs().maxCoeff() / reduced.J.cwiseAbs().maxCoeff());
    gap = std::max(gap,
                   (fd.rightCols<3>() + reduced.K).cwiseAbs().maxCoeff() / reduced.K.cwiseAbs().maxCoeff());
  }
  compare({name + " J + K", "finite-difference Jacobian",
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(
                 assemble(walk->robot, walk->poses[i], walk->coordinates[i], walk->work).closure_error);
           },
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(differences(walk->robot, unknowns(walk->poses[i], walk->inputs[i]), 6));
           },
           fmt::format("differences are off by up to {:.0e}, ours by rounding", gap)});
}

/// κ of one leg by 60 halvings of the residual as printed, on the bending side of the known solution.
double bisected(const Robot& robot, Unknowns z, int leg, double low, double high) {
  const auto at = [&](double input) {
    z[3 + leg] = input;
    return residuals_as_printed(robot, z)[leg];
  };
  const bool rising = at(high) > at(low);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    ((at(middle) > 0) == rising ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// @param warm whether the branch is told by the last pose's curvatures, as a controller does; else the
/// smallest |κ|
void compare_inverse(const std::string& name, bool warm) {
  auto walk = std::make_shared<Walk>(name);
  const auto solve = [walk, warm](std::size_t i) {
    const InverseOptions last{.curvature = walk->coordinates[walk->before(i)]};
    return inverse(walk->robot, walk->poses[i], warm ? last : InverseOptions{}, walk->work).report.residual;
  };
  double error = 0;
  for (std::size_t i = 0; i < walk->poses.size(); ++i) error = std::max(error, solve(i));
  compare({name + (warm ? " warm inverse" : " inverse"), "bisection",
           [walk, solve] { benchmark::DoNotOptimize(solve(walk->next())); },
           [walk] {
             const std::size_t i = walk->next();
             const Unknowns z = unknowns(walk->poses[i], walk->inputs[i]);
             for (int leg = 0; leg < 3; ++leg)
               benchmark::DoNotOptimize(bisected(walk->robot, z, leg, z[3 + leg] - 2e-3, z[3 + leg] + 2e-3));
           },
           fmt::format("closure error {:.0e} m", error)});
}

/// Newton from the last pose with a finite-difference Jacobian at every iterate, to the same residual.
Unknowns newton_on_differences(const Robot& robot, Unknowns z) {
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d g = residuals_as_printed(robot, z);
    if (g.cwiseAbs().maxCoeff() < 1e-15) break;
    const Eigen::Matrix3d J = differences(robot, z, 3).leftCols<3>();
    z.head<3>() -= J.partialPivLu().solve(g);
  }
  return z;
}

void compare_forward(const std::string& name) {
  auto walk = std::make_shared<Walk>(name);
  double error = 0, iterations = 0;
  for (std::size_t i = 0; i < walk->poses.size(); ++i) {
    const Forward answer =
        forward(walk->robot, walk->inputs[i], {.start = walk->poses[walk->before(i)]}, walk->work);
    const auto& pose = std::get<PlanarPose>(answer.pose);
    error = std::max({error, std::abs(pose.x - walk->poses[i].x), std::abs(pose.y - walk->poses[i].y)});
    iterations += answer.report.iterations;
  }
  compare({name + " warm forward", "Newton on differences",
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(
                 forward(walk->robot, walk->inputs[i], {.start = walk->poses[walk->before(i)]}, walk->work)
                     .report.residual);
           },
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(
                 newton_on_differences(walk->robot, unknowns(walk->poses[walk->before(i)], walk->inputs[i])));
           },
           fmt::format("{:.2f} iterations, pose error {:.0e} m",
                       iterations / static_cast<double>(walk->poses.size()), error)});
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  for (const std::string name : {"3-rfr", "3-frr"}) {
    sinew::bench::compare_jacobians(name);
    sinew::bench::compare_inverse(name, false);
    sinew::bench::compare_inverse(name, true);
    sinew::bench::compare_forward(name);
  }
  return sinew::bench::main(argc, argv);
}
