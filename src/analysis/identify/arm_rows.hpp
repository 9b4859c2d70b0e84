/// @file arm_rows.hpp
/// What an arm shows at measured rows, and by what it changes as the arm does. Theory:
/// docs/theory/identification.md
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "robot/arms/arm_model.hpp"
#include "sinew/analysis/identify.hpp"
#include "strain/relax.hpp"
#include "strain/tangent.hpp"

namespace sinew::inline v1 {

namespace identification {
inline std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace identification

/// What the marker's place depends on: columns of a row's sensitivities.
class ArmFields {
 public:
  explicit ArmFields(const Arm& arm);

  int bending_x(int section) const { return 6 * section; }
  int bending_y(int section) const { return 6 * section + 1; }
  int torsion(int section) const { return 6 * section + 2; }
  int curvature(int section, int axis) const { return 6 * section + 3 + axis; }
  int angle(int tendon, int section) const { return routes_[static_cast<std::size_t>(tendon)] + 2 * section; }
  int radius(int tendon, int section) const { return angle(tendon, section) + 1; }
  int free_length(int tendon) const { return lengths_ + tendon; }
  int compliance(int tendon) const { return lengths_ + tendons_ + tendon; }
  int toe(int tendon) const { return lengths_ + 2 * tendons_ + tendon; }
  int gravity(int axis) const { return rest_ + axis; }
  int tip_mass() const { return rest_ + 3; }
  int mass() const { return rest_ + 4; }
  int marker(int axis) const { return rest_ + 5 + axis; }
  int base(int axis) const { return rest_ + 8 + axis; }
  int tilt(int axis) const { return rest_ + 11 + axis; }
  int size() const { return rest_ + 14; }

 private:
  std::vector<int> routes_;
  int tendons_ = 0, lengths_ = 0, rest_ = 0;
};

/// Solves rows of one arm. Stiffnesses, radii, compliances and masses change by their logarithm.
class ArmRows {
 public:
  ArmRows(const MeasuredArm& arm, const ArmBasis& basis);

  /// An arm of as many sections, discs and tendons.
  void set(const MeasuredArm& arm);
  double tolerance = 1e-6;  ///< of the equilibrium, see strain::RelaxOptions
  const ArmFields& fields() const { return fields_; }
  int size() const { return model_.size; }
  /// Of a tendon with its end where it is fitted, the arm straight [m].
  double straight_length(int tendon) const { return straight_[static_cast<std::size_t>(tendon)]; }

  /// @param free_lengths of tendons [m]
  /// @param y coordinates to start from, and those found
  Status solve(std::span<const double> free_lengths, std::span<double> y);
  /// After it: the marker in the axes of the measurement [m].
  Eigen::Vector3d marker() const;
  /// After it; [m] by each field.
  /// @param exact false: by the Hessian that the solve ended with, of a step before; it becomes exact where
  /// the
  ///              row's coordinates no longer change
  void sensitivities(Eigen::Matrix3Xd& by_field, bool exact = true);
  std::span<const double> tensions() const { return rod_->tensions(); }
  double slack(int tendon) const { return rod_->slack(static_cast<std::size_t>(tendon)); }

 private:
  void load();
  void straighten();

  MeasuredArm arm_;
  ArmBasis basis_;
  ArmFields fields_;
  strain::RodModel model_;
  std::optional<strain::LoadedRod> rod_;
  std::optional<strain::Tangent> tangent_;
  std::vector<int> section_of_piece_;
  std::vector<double> straight_;
  Eigen::VectorXd straight_by_field_;
  Eigen::Matrix3d base_turn_ = Eigen::Matrix3d::Identity();
  std::vector<double> directions_;
};

}  // namespace sinew::inline v1
