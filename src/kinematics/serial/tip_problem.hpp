/// @file tip_problem.hpp
/// How far a serial robot's tip is from its target, and that to first order as a bounded least squares
/// problem. Theory: docs/theory/serial_inverse.md
#pragma once
#include <array>

#include "base/limits.hpp"
#include "kinematics/serial/tip_rows.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::inline v1 {

using Bends = std::array<Bend, max_sections>;

/// Bends of all sections and how much longer they are than at rest [m].
struct Shape {
  Bends bends;
  std::array<double, max_sections> extensions{};
};

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

  /// The shape within the limits; of each section, the bend and the extension nearest to the given.
  void bring_within(Shape& shape) const;
  /// Only where the tip is, into `work.ends`.
  TipMiss screen(const Shape& shape) const;
  /// With the Jacobian in `work.J`.
  TipMiss measure(const Shape& shape) const;
  /// After `measure` of the same shape; no section turns by more than `most` [rad].
  void linearise(const Shape& shape, const TipMiss& miss, double most, BoundedStep& system) const;
  Shape moved(const Shape& shape, const BoundedStep& system) const;

 private:
  std::span<const Bend> bends_of(const Shape& shape) const;
  void set_lengths(const Shape& shape) const;
  TipMiss miss() const;

  const SerialRobot& robot_;
  SerialWorkspace& work_;
  TipTarget target_;
  int rows_;
  double length_;
  bool is_extensible_;
};

}  // namespace sinew::inline v1
