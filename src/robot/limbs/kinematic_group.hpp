/// @file kinematic_group.hpp
/// The legs of a robot that close on its platform, as one group: they hand over rows g = 0 with their
/// Jacobians, whether they are all of the robot or stand beside rods. Theory: docs/theory/leg.md,
/// docs/theory/mixed_robot.md
#pragma once
#include "base/limits.hpp"
#include "robot/parallel.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// A view of a robot's legs: inputs, coordinates and rows are numbered as the robot's. Nothing here
/// allocates.
/// @tparam Any AnyPlanarLeg or AnySpatialLeg
template <class Any>
class KinematicGroup {
 public:
  using Space = typename Any::Space;
  using Frame = typename Space::template Frame<double>;
  using Change = Mat<double, Space::dof, Space::dof>;
  using ChangeByInput =
      Eigen::Matrix<double, Space::dof, Eigen::Dynamic, Eigen::DontAlign, Space::dof, max_rows>;

  explicit KinematicGroup(const ParallelRobot<Any>& robot) : robot_(robot) {}

  int rows() const { return robot_.total.row; }

  /// Link coordinates that the inputs command. The report names an input outside its link's domain.
  Report to_coordinates(Numbers inputs, std::span<double> coordinates) const;
  void to_inputs(Numbers coordinates, std::span<double> inputs) const;
  /// Whether the legs that an input moves can have this value of it.
  bool in_domain(int input, double value) const;

  /// Where the group writes its rows, in the papers' raw form, row-major: J = ∂g/∂x, K = −∂g/∂a, s = −g.
  struct Rows {
    std::span<double> J, K, s;
  };
  struct ClosureError {
    double distance = 0;  ///< the largest by which a leg fails to close [m]; infinite where not finite
    int leg = 0;          ///< the leg that does
  };
  /// @implements TDPCR (5)-(6), (17), (19)-(20), (59), (67)
  /// @implements 3PFS (15)-(18)
  ClosureError evaluate(const Frame& platform, Numbers coordinates, const Rows& rows) const;

  /// What the wrench Jᵀλ changes by when the platform moves and when an input changes: the rows' second
  /// derivatives.
  void curvature(const Frame& platform, Numbers coordinates, Numbers multipliers, Change& by_platform,
                 ChangeByInput& by_input) const;

  /// Inputs that close all legs at this pose, each leg's nearest to what it has at rest; false where one
  /// cannot.
  bool close_at(const Frame& platform, std::span<double> inputs) const;

 private:
  const ParallelRobot<Any>& robot_;
};

}  // namespace sinew::inline v1
