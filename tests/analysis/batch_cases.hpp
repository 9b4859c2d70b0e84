/// @file batch_cases.hpp
/// Batches of poses beside the same poses one by one.
#pragma once
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <limits>
#include <vector>

#include "analysis/velocity_lanes.hpp"
#include "sinew/analysis/velocity.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {

/// All that a batch can be asked for, of n poses.
struct Answer {
  std::size_t poses, legs, left = 0;
  std::vector<Status> status;
  std::vector<double> place, inputs, curvatures, residual, determinant, condition, condition_homogenised,
      position, rotation;
  std::vector<std::uint8_t> type_1, is_type_2;

  Answer(std::size_t n, std::size_t leg_count)
      : poses(n),
        legs(leg_count),
        status(n),
        place(7 * n, std::numeric_limits<double>::quiet_NaN()),
        inputs(n * legs),
        curvatures(n * legs),
        residual(n),
        determinant(n),
        condition(n),
        condition_homogenised(n),
        position(n),
        rotation(n),
        type_1(n),
        is_type_2(n) {}

  VelocityBatch spans() {
    return {.status = status,
            .poses = place,
            .inputs = inputs,
            .curvatures = curvatures,
            .residual = residual,
            .determinant = determinant,
            .condition = condition,
            .condition_homogenised = condition_homogenised,
            .position = position,
            .rotation = rotation,
            .type_1 = type_1,
            .is_type_2 = is_type_2};
  }

  /// All numbers of pose k; NaN as one certain number, so that equal answers compare equal.
  std::vector<double> numbers(std::size_t k) const {
    std::vector<double> all{
        static_cast<double>(status[k]), type_1[k] * 1.0, is_type_2[k] * 1.0, determinant[k], condition[k],
        condition_homogenised[k],       position[k],     rotation[k],        residual[k]};
    for (std::size_t i = 0; i < legs; ++i) {
      all.push_back(inputs[i * poses + k]);
      all.push_back(curvatures[i * poses + k]);
    }
    for (std::size_t c = 0; c < 7; ++c) all.push_back(place[c * poses + k]);
    for (double& x : all)
      if (std::isnan(x)) x = -1e300;
    return all;
  }
};

/// Poses as a batch has them.
inline std::vector<double> axes(const std::vector<AnyPose>& poses) {
  const std::size_t n = poses.size();
  if (n == 0) return {};
  const bool planar = std::holds_alternative<PlanarPose>(poses[0]);
  std::vector<double> numbers((planar ? 3 : 7) * n);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> one;
    if (planar) {
      const auto& pose = std::get<PlanarPose>(poses[k]);
      one = {pose.x, pose.y, pose.phi};
    } else {
      const auto& pose = std::get<SpatialPose>(poses[k]);
      one = {pose.position[0], pose.position[1], pose.position[2]};
      one.insert(one.end(), pose.quaternion.begin(), pose.quaternion.end());
    }
    for (std::size_t a = 0; a < one.size(); ++a) numbers[a * n + k] = one[a];
  }
  return numbers;
}

inline Answer in_batch(const Robot& robot, const PoseBatch& batch, std::size_t poses) {
  Workspace work(robot);
  Answer answer(poses, static_cast<std::size_t>(leg_count(robot)));
  answer.left = velocity_batch(robot, batch, answer.spans(), work);
  return answer;
}
inline Answer in_batch(const Robot& robot, const std::vector<AnyPose>& poses,
                       std::span<const int> bending = {}) {
  return in_batch(robot, {axes(poses), bending}, poses.size());
}

/// The largest errors beside `inverse` and `velocity`; statuses and what is absent must be the same.
struct Errors {
  double inputs = 0;     ///< [m]
  double residual = 0;   ///< larger than that of `inverse` [m]
  double curvature = 0;  ///< of the bend angle over what a rounding of the chord does to it
  double determinant = 0, condition = 0, norms = 0;  ///< relative, over max(1, condition/1e5)
  std::size_t statuses = 0, converged = 0, type_1 = 0, type_2 = 0;

  void of_pose(const Robot& robot, const Answer& batch, std::size_t k, const AnyPose& pose,
               const PoseBatch& branch, Workspace& work) {
    const Inverse solved = inverse(robot, pose, {.bending = branch.bending, .elbow = branch.elbow}, work);
    if (!solved.ok()) {
      statuses += batch.status[k] != solved.report.status;
      statuses +=
          !std::isnan(batch.determinant[k]) || !std::isnan(batch.inputs[k]) || !std::isnan(batch.rotation[k]);
      statuses += !std::isnan(batch.residual[k]);
      return;
    }
    worsen(residual, std::abs(batch.residual[k] - solved.report.residual));
    for (std::size_t i = 0; i < batch.legs; ++i) {
      worsen(inputs, std::abs(batch.inputs[i * batch.poses + k] - solved.inputs[i]));
      if (!has_arc(robot)) continue;
      const double turn = solved.coordinates[i] * 0.1;
      worsen(curvature, std::abs(batch.curvatures[i * batch.poses + k] - solved.coordinates[i]) * 0.1 *
                            std::min(1.0, std::abs(turn)));
    }
    const Velocity at = velocity(robot, pose, solved.coordinates, work);
    statuses += batch.status[k] != at.report.status || batch.type_1[k] != at.type_1.size() ||
                batch.is_type_2[k] != at.type_2.singular;
    converged += at.report.ok();
    type_1 += !at.type_1.empty();
    type_2 += at.type_2.singular;
    const double loss = std::max(1.0, at.indices.condition_homogenised / 1e5);
    const auto compare = [&](double& worst, double found, double expected) {
      if (std::isnan(expected) || std::isnan(found))
        statuses += std::isnan(expected) != std::isnan(found);
      else
        worsen(worst, std::abs(found / expected - 1) / loss);
    };
    double scale = 1;
    for (Eigen::Index i = 0; i < at.J.rows(); ++i) scale *= at.J.row(i).norm();
    worsen(determinant, std::abs(batch.determinant[k] - at.determinant) / scale);
    compare(condition, batch.condition[k], at.indices.condition);
    compare(condition, batch.condition_homogenised[k], at.indices.condition_homogenised);
    compare(norms, batch.position[k], at.indices.position);
    compare(norms, batch.rotation[k], at.indices.rotation);
  }

  static void worsen(double& worst, double found) {
    if (!(found <= worst)) worst = found;
  }
};

inline Errors errors(const Robot& robot, const std::vector<AnyPose>& poses,
                     std::span<const int> bending = {}) {
  Workspace work(robot);
  const Answer batch = in_batch(robot, poses, bending);
  Errors found;
  for (std::size_t k = 0; k < poses.size(); ++k)
    found.of_pose(robot, batch, k, poses[k], {{}, bending}, work);
  return found;
}

/// Runs a test's body with each instruction set of this machine.
template <class Body>
void with_each_instruction_set(const Body& body) {
  for (const std::int64_t set : {std::int64_t{HWY_AVX3}, std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSSE3},
                                 std::int64_t{HWY_EMU128}, std::int64_t{HWY_SCALAR}}) {
    if ((hwy::SupportedTargets() & set) == 0) continue;
    hwy::SetSupportedTargetsForTest(set);
    hwy::GetChosenTarget().Update(set);
    SCOPED_TRACE(velocity_lanes::instruction_set());
    body();
    hwy::SetSupportedTargetsForTest(0);
  }
  hwy::GetChosenTarget().DeInit();
}

}  // namespace sinew::test
