/// Spatial 6-UFS: J + K, inverse and warm forward kinematics. Run: build/dev/bin/bench_spatial
/// The baselines are what one writes first, straight from the paper: residuals only, differences for
/// derivatives.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <memory>

#include "report.hpp"
#include "robot/parallel.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::bench {
namespace {

using UfsLeg = Leg<Spatial, Arc, TendonPair, Chord>;
using Twelve = Eigen::Matrix<double, 12, 1>;  // small motion of the platform, and six inputs
using Six = Eigen::Matrix<double, 6, 1>;

/// The robot on a smooth walk inside its workspace, steps of about 1 mm and 0.5°.
struct Walk {
  Robot robot = load("6-ufs").value();
  Workspace work{robot};
  std::vector<SpatialPose> poses;
  std::vector<std::vector<double>> inputs, coordinates;
  std::size_t step = 0;

  Walk() {
    const SpatialPose start = std::get<SpatialPose>(home(robot));
    for (int i = 0; i < 1024; ++i) {
      const double t = 2 * std::numbers::pi * i / 256;
      const SpatialPose pose =
          Spatial::moved(start, Vec<double, 6>(0.03 * std::cos(t), 0.03 * std::sin(t), 0.01 * std::sin(2 * t),
                                               0.2 * std::cos(t), 0.2 * std::sin(t), 0.3 * std::sin(t)));
      if (!inverse(robot, pose, {}, work).ok()) continue;
      poses.push_back(pose);
      inputs.emplace_back(work.inputs);
      coordinates.emplace_back(work.coordinates);
    }
  }
  std::size_t next() { return step = (step + 1) % poses.size(); }
  std::size_t before(std::size_t i) const { return (i + poses.size() - 1) % poses.size(); }
  const std::vector<UfsLeg> legs = legs_of<UfsLeg>(robot).legs;
};

/// Closure residuals as the paper writes them: (57) with (1) and (7); undefined at κ = 0.
Six residuals_as_printed(const std::vector<UfsLeg>& legs, const SpatialPose& pose, const Twelve& z) {
  const auto& q = pose.quaternion;
  const Eigen::Vector3d turn = z.segment<3>(3);
  const double angle = turn.norm();
  Eigen::Matrix3d Q = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  if (angle > 0) Q = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * Q;
  const Eigen::Vector3d p = Eigen::Vector3d(pose.position) + z.head<3>();
  Six g;
  for (int i = 0; i < 6; ++i) {
    const UfsLeg& leg = legs[static_cast<std::size_t>(i)];
    const Eigen::Vector3d r = p + Q * Eigen::Vector3d(leg.platform_point) - Eigen::Vector3d(leg.base.p);
    const double length = leg.link.length, curvature = (length - z[6 + i]) / (leg.drive.offset * length);
    g[i] = (r.squaredNorm() - std::pow(2 / curvature * std::sin(length * curvature / 2), 2)) / 2;
  }
  return g;
}

/// Central differences by the first `columns` unknowns.
Eigen::Matrix<double, 6, 12> differences(const std::vector<UfsLeg>& legs, const SpatialPose& pose,
                                         const std::vector<double>& inputs, int columns) {
  Eigen::Matrix<double, 6, 12> jacobian;
  Twelve z = Twelve::Zero();
  for (int i = 0; i < 6; ++i) z[6 + i] = inputs[static_cast<std::size_t>(i)];
  for (int j = 0; j < columns; ++j) {
    Twelve ahead = z, behind = z;
    const double h = 1e-6;
    ahead[j] += h;
    behind[j] -= h;
    jacobian.col(j) =
        (residuals_as_printed(legs, pose, ahead) - residuals_as_printed(legs, pose, behind)) / (2 * h);
  }
  return jacobian;
}

void compare_jacobians() {
  auto walk = std::make_shared<Walk>();
  double gap = 0;
  for (std::size_t i = 0; i < walk->poses.size(); ++i) {
    const Reduced reduced = assemble(walk->robot, walk->poses[i], walk->coordinates[i], walk->work);
    const auto fd = differences(walk->legs, walk->poses[i], walk->inputs[i], 12);
    gap =
        std::max(gap, (fd.leftCols<6>() - reduced.J).cwiseAbs().maxCoeff() / reduced.J.cwiseAbs().maxCoeff());
    gap = std::max(gap,
                   (fd.rightCols<6>() + reduced.K).cwiseAbs().maxCoeff() / reduced.K.cwiseAbs().maxCoeff());
  }
  compare({"6-ufs J + K", "finite-difference Jacobian",
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(
                 assemble(walk->robot, walk->poses[i], walk->coordinates[i], walk->work).closure_error);
           },
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(differences(walk->legs, walk->poses[i], walk->inputs[i], 12));
           },
           fmt::format("differences are off by up to {:.0e}, ours by rounding", gap)});
}

/// Newton from the last pose with a finite-difference Jacobian at every iterate, to the same residual.
SpatialPose newton_on_differences(const std::vector<UfsLeg>& legs, SpatialPose pose,
                                  const std::vector<double>& inputs) {
  Twelve z = Twelve::Zero();
  for (int i = 0; i < 6; ++i) z[6 + i] = inputs[static_cast<std::size_t>(i)];
  for (int i = 0; i < 20; ++i) {
    const Six g = residuals_as_printed(legs, pose, z);
    if (g.cwiseAbs().maxCoeff() < 1e-15) break;
    const Eigen::Matrix<double, 6, 6> J = differences(legs, pose, inputs, 6).leftCols<6>();
    pose = Spatial::moved(pose, Vec<double, 6>(-J.partialPivLu().solve(g)));
  }
  return pose;
}

void compare_forward() {
  auto walk = std::make_shared<Walk>();
  double error = 0, iterations = 0;
  const auto solve = [walk](std::size_t i) {
    return forward(walk->robot, walk->inputs[i], {.start = walk->poses[walk->before(i)]}, walk->work);
  };
  for (std::size_t i = 0; i < walk->poses.size(); ++i) {
    const Forward answer = solve(i);
    error = std::max(error, (std::get<SpatialPose>(answer.pose).position - walk->poses[i].position).norm());
    iterations += answer.report.iterations / static_cast<double>(walk->poses.size());
  }
  compare({"6-ufs warm forward", "Newton on differences",
           [walk, solve] { benchmark::DoNotOptimize(solve(walk->next()).report.residual); },
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(
                 newton_on_differences(walk->legs, walk->poses[walk->before(i)], walk->inputs[i]));
           },
           fmt::format("position to {:.0e} m in {:.1f} iterations", error, iterations)});
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  sinew::bench::compare_jacobians();
  sinew::bench::compare_forward();
  return sinew::bench::main(argc, argv);
}
