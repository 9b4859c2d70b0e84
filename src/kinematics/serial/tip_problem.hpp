/// @file tip_problem.hpp
/// How far a serial robot's tip is from its target, and that to first order as a bounded least squares
/// problem. Theory: docs/theory/serial_inverse.md
#pragma once
#include <array>

#include "kinematics/serial/tip_rows.hpp"
#include "sinew/kinematics/serial_inverse.hpp"

namespace sinew::inline v0 {

using Bends = std::array<Bend, max_sections>;

/// From the tip to its target, in base axes.
struct TipMiss {
  Vec3<double> shift, turn;  ///< [m], [rad]; `turn` the shortest, 0 where only a position is wanted
  double position = 0, angle = 0;

  /// What is descended: in shares of the length and radians.
  double merit(double length) const { return squared_norm(shift) / (length * length) + squared_norm(turn); }
  double residual(double length) const { return std::max(position, length * angle); }
};

class TipProblem {
 public:
  TipProblem(const SerialRobot& robot, const TipTarget& target, SerialWorkspace& work);

  double length() const { return length_; }
  double farthest() const;  ///< by how much the target is out of reach for certain [m]; 0: it may be in reach

  /// The bends within the limits; of each section, those nearest to the given.
  void bring_within(Bends& bends) const;
  /// Only where the tip is, into `work.ends`.
  TipMiss screen(const Bends& bends) const;
  /// With the Jacobian in `work.J`.
  TipMiss measure(const Bends& bends) const;
  /// After `measure` of the same bends; no unknown goes farther than `most` [rad].
  void linearise(const Bends& bends, const TipMiss& miss, double most, BoundedStep& system) const;
  Bends moved(const Bends& bends, const BoundedStep& system) const;

 private:
  TipMiss miss() const;

  const SerialRobot& robot_;
  SerialWorkspace& work_;
  TipTarget target_;
  int rows_;
  double length_;
};

}  // namespace sinew::inline v0
