/// @file effort_sensor.hpp
/// The load on a platform from the efforts of its feeds, whatever the limbs are: at fixed lengths the pose
/// makes all efforts, and the wrench is what they leave over. Theory: docs/theory/limb_group.md
#pragma once
#include <cmath>
#include <optional>

#include "robot/limbs/limb_group.hpp"
#include "solve/continuation.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {

/// From an equilibrium on, as long as Newton's method follows: each step leads twice as far as the one
/// before, a fourth of that where it failed. The group is then at the last equilibrium.
/// @param put sets what is held, or measured, at a part of the way
/// @param correct Newton's method there, which counts its iterations; false where it does not follow
template <class Space, class Put, class Correct>
ParameterPath follow_parts(LimbGroup<Space>& group, LimbState& spare, const ParameterOptions& options,
                           const Put& put, const Correct& correct) {
  ParameterPath end;
  follow_parameter(end, options, [&](double next, double taken) {
    group.save(spare);
    put(next);
    if (correct(end.iterations)) return ParameterStep{ParameterStep::reached, 2 * taken};
    group.restore(spare);
    return ParameterStep{ParameterStep::failed, taken / 4};
  });
  return end;
}

/// A Σ Aᵀ of efforts with these deviations, independent of each other: of the wrench that they make by A.
template <int dof>
Eigen::Matrix<double, dof, dof, Eigen::RowMajor> covariance_of(
    const Eigen::Matrix<double, dof, dof, Eigen::RowMajor>& by_efforts, Numbers deviations) {
  const auto scaled = (by_efforts * Vec<double, dof>(deviations.data()).asDiagonal()).eval();
  return scaled * scaled.transpose();
}

/// An effort that is measured.
struct MeasuredEffort {
  int feed = 0;
  double value = 0;  ///< [N]
  double unit = 1;   ///< by which its error is counted [N]
};

/// Newton's method on the platform's pose, for as many efforts as it has freedoms. The group outlasts it.
template <class Space>
class EffortSensor {
 public:
  static constexpr int dof = Space::dof, turns = dof - Space::dimension;
  using Twist = Vec<double, dof>;
  using Rows = Eigen::Matrix<double, dof, dof, Eigen::RowMajor>;
  using Measured = std::array<MeasuredEffort, static_cast<std::size_t>(dof)>;

  EffortSensor(LimbGroup<Space>& group, const Measured& measured)
      : group_(group),
        measured_(measured),
        wanted_(measured) {}

  /// After `evaluate`: the largest of the limbs' own errors, and of efforts over their units.
  double error() const {
    double error = group_.limb_error();
    for (const MeasuredEffort& one : wanted_)
      error = worse(error, (group_.effort(one.feed) - one.value) / one.unit);
    return error;
  }
  /// After `linearise`: ∂efforts/∂(p, r φ), r the group's radius.
  Rows rows() const {
    Rows rows;
    for (int k = 0; k < dof; ++k)
      rows.row(k) = group_.effort_jacobian(wanted_[static_cast<std::size_t>(k)].feed).transpose();
    rows.template rightCols<turns>() /= group_.radius();
    return rows;
  }
  /// After `linearise`: Newton's step. Nothing where some motion changes no effort.
  std::optional<Twist> step() const {
    const Rows by_pose = rows();
    Twist missing, twist;
    for (int k = 0; k < dof; ++k) {
      const MeasuredEffort& one = wanted_[static_cast<std::size_t>(k)];
      missing[k] = one.value - group_.closing_effort(one.feed);
    }
    if (!solve(MatrixView(by_pose.data(), dof, dof), MatrixView(missing.data(), dof, 1), span(twist)))
      return {};
    twist.template tail<turns>() /= group_.radius();
    return twist;
  }
  /// After `linearise`: ∂wrench/∂efforts at fixed lengths, forces [1], moments [m]. Nothing as there.
  std::optional<Rows> sensitivity() const {
    Rows wrench_by_pose = group_.stiffness(), found;
    wrench_by_pose.template rightCols<turns>() /= group_.radius();
    const Rows left = rows().transpose(),
               right = wrench_by_pose.transpose();  // S R⁻¹, by Rᵀ on its transpose
    if (!solve(MatrixView(left.data(), dof, dof), MatrixView(right.data(), dof, dof), span(found))) return {};
    return found.transpose().eval();
  }

  /// From an equilibrium to where the efforts are as measured, and there to shapes as fine as `truncation`.
  /// Evaluated there; or linearised, too, at the last equilibrium on the way.
  /// @param correct(sensor, iterations, residual) Newton's method by `error` and `step`; false where it is
  /// lost
  /// @param lost the status where no wrench near by makes the efforts
  template <class Correct>
  Report find(LimbState& spare, const ParameterOptions& options, double truncation, Status lost,
              const Correct& correct) {
    Report report;
    const auto attempt = [&](int& iterations) { return correct(iterations, report.residual); };
    group_.evaluate();
    Measured from = measured_;
    for (MeasuredEffort& one : from) one.value = group_.effort(one.feed);
    const auto aim = [&](double part) {
      for (std::size_t k = 0; k < from.size(); ++k)
        wanted_[k].value = std::lerp(from[k].value, measured_[k].value, part);
    };
    const ParameterPath end = follow_parts(group_, spare, options, aim, attempt);
    report.iterations = end.iterations;
    if (!end.arrived && !note_stop(options.stride.stop, report)) {
      report.status = end.ran_out ? Status::iteration_limit : lost;
      report.message.append(
          end.ran_out ? "the way to these forces takes more steps than max_iterations; raise it"
                      : "no wrench near the unloaded platform makes these forces; check their signs "
                        "(pull > 0) and the lengths");
    }
    while (report.ok() && !group_.is_finest() && group_.truncation() > truncation) {
      group_.refine();
      if (attempt(report.iterations)) continue;
      report.status = Status::stalled;
      report.message.append("the limbs bend too sharply to be resolved");
    }
    if (end.arrived) return report;
    group_.evaluate();
    group_.linearise();
    return report;
  }
  /// Where some motion changes no effort.
  static void say_undetermined(Report& report) {
    report.status = Status::singular;
    report.message.append("here these forces do not tell the wrench: some motion changes none of them");
  }

 private:
  template <class Numbers>
  static std::span<double> span(Numbers& numbers) {
    return {numbers.data(), static_cast<std::size_t>(numbers.size())};
  }

  LimbGroup<Space>& group_;
  Measured measured_, wanted_;
};

}  // namespace sinew::inline v1
