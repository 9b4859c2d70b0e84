/// Rigid 3PRS: J + K, inverse and warm forward kinematics. Run: build/dev/bin/bench_tripod_rigid
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

using PrsLeg = Leg<Spatial, Rail, SlideDrive, HingedStrut>;
using Nine = Eigen::Matrix<double, 9, 1>;  // small motion of the platform, and three inputs
using Six = Eigen::Matrix<double, 6, 1>;

/// The robot on a smooth walk inside its workspace, steps of about 1 mm and 0.5°.
struct Walk {
  Robot robot = load("3prs").value();
  Workspace work{robot};
  std::vector<SpatialPose> poses;
  std::vector<std::vector<double>> inputs, coordinates;
  std::size_t step = 0;

  Walk() {
    for (int i = 0; i < 1024; ++i) {
      const double t = 2 * std::numbers::pi * i / 256;
      const ConstrainedPose at = constrained_pose(robot, {0.5 + 0.03 * std::sin(2 * t), 0.15 * std::cos(t),
                                                          0.15 * std::sin(t) + 0.05 * std::cos(3 * t)});
      if (!at.ok() || !inverse(robot, at.pose, {}, work).ok()) continue;
      poses.push_back(at.pose);
      inputs.emplace_back(work.inputs);
      coordinates.emplace_back(work.coordinates);
    }
  }
  std::size_t next() { return step = (step + 1) % poses.size(); }
  std::size_t before(std::size_t i) const { return (i + poses.size() - 1) % poses.size(); }
  const std::vector<PrsLeg> legs = legs_of<PrsLeg>(robot).legs;
};

/// Closure residuals as the paper writes them: (2) and (11), the latter squared and halved.
Six residuals_as_printed(const std::vector<PrsLeg>& legs, const SpatialPose& pose, const Nine& z) {
  const auto& q = pose.quaternion;
  const Eigen::Vector3d turn = z.segment<3>(3);
  const double angle = turn.norm();
  Eigen::Matrix3d R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  if (angle > 0) R = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * R;
  const Eigen::Vector3d p = Eigen::Vector3d(pose.position) + z.head<3>();
  Six g;
  for (int i = 0; i < 3; ++i) {
    const PrsLeg& leg = legs[static_cast<std::size_t>(i)];
    const Eigen::Vector3d u = leg.base.rotate(Vec3<double>(1, 0, 0)),
                          k = leg.base.rotate(Vec3<double>(0, 1, 0));
    const Eigen::Vector3d strut =
        p + R * Eigen::Vector3d(leg.platform_point) - Eigen::Vector3d(leg.base.p) - z[6 + i] * k;
    g[i] = (strut.squaredNorm() - leg.closure.length * leg.closure.length) / 2;
    g[3 + i] = u.dot(strut);
  }
  return g;
}

/// Central differences by the first `columns` unknowns.
Eigen::Matrix<double, 6, 9> differences(const std::vector<PrsLeg>& legs, const SpatialPose& pose,
                                        const std::vector<double>& inputs, int columns) {
  Eigen::Matrix<double, 6, 9> jacobian;
  Nine z = Nine::Zero();
  for (int i = 0; i < 3; ++i) z[6 + i] = inputs[static_cast<std::size_t>(i)];
  for (int j = 0; j < columns; ++j) {
    Nine ahead = z, behind = z;
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
    const auto fd = differences(walk->legs, walk->poses[i], walk->inputs[i], 9);
    gap =
        std::max(gap, (fd.leftCols<6>() - reduced.J).cwiseAbs().maxCoeff() / reduced.J.cwiseAbs().maxCoeff());
    gap = std::max(gap,
                   (fd.rightCols<3>() + reduced.K).cwiseAbs().maxCoeff() / reduced.K.cwiseAbs().maxCoeff());
  }
  compare({"3-prs J + K", "finite-difference Jacobian",
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(
                 assemble(walk->robot, walk->poses[i], walk->coordinates[i], walk->work).closure_error);
           },
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(differences(walk->legs, walk->poses[i], walk->inputs[i], 9));
           },
           fmt::format("differences are off by up to {:.0e}, ours by rounding", gap)});
}

/// Newton from the last pose with a finite-difference Jacobian at every iterate, to the same residual.
SpatialPose newton_on_differences(const std::vector<PrsLeg>& legs, SpatialPose pose,
                                  const std::vector<double>& inputs) {
  Nine z = Nine::Zero();
  for (int i = 0; i < 3; ++i) z[6 + i] = inputs[static_cast<std::size_t>(i)];
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
  compare({"3-prs warm forward", "Newton on differences",
           [walk, solve] { benchmark::DoNotOptimize(solve(walk->next()).report.residual); },
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(
                 newton_on_differences(walk->legs, walk->poses[walk->before(i)], walk->inputs[i]));
           },
           fmt::format("position to {:.0e} m in {:.1f} iterations", error, iterations)});
}

/// Newton in one slide after the other, from the last ones, as one does without (11) solved for ρ.
void compare_inverse() {
  auto walk = std::make_shared<Walk>();
  double error = 0;
  for (std::size_t i = 0; i < walk->poses.size(); ++i) {
    const Inverse answer = inverse(walk->robot, walk->poses[i], {}, walk->work);
    for (std::size_t k = 0; k < 3; ++k)
      error = std::max(error, std::abs(answer.inputs[k] - walk->inputs[i][k]));
  }
  compare({"3-prs inverse", "Newton on differences",
           [walk] {
             const std::size_t i = walk->next();
             benchmark::DoNotOptimize(inverse(walk->robot, walk->poses[i], {}, walk->work).report.residual);
           },
           [walk] {
             const std::size_t i = walk->next();
             Nine z = Nine::Zero();
             for (int k = 0; k < 3; ++k)
               z[6 + k] = walk->inputs[walk->before(i)][static_cast<std::size_t>(k)];
             for (int iteration = 0; iteration < 20; ++iteration) {
               const Six g = residuals_as_printed(walk->legs, walk->poses[i], z);
               if (g.head<3>().cwiseAbs().maxCoeff() < 1e-15) break;
               Nine ahead = z;
               ahead.tail<3>().array() += 1e-6;
               const Six beside = residuals_as_printed(walk->legs, walk->poses[i], ahead);
               for (int k = 0; k < 3; ++k) z[6 + k] -= g[k] * 1e-6 / (beside[k] - g[k]);
             }
             benchmark::DoNotOptimize(z);
           },
           fmt::format("closed form, slides to {:.0e} m", error)});
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  sinew::bench::compare_jacobians();
  sinew::bench::compare_inverse();
  sinew::bench::compare_forward();
  return sinew::bench::main(argc, argv);
}
