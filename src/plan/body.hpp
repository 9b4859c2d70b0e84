/// @file body.hpp
/// Points along the backbone of a robot that is being inserted, and how they move with stage and bends.
/// The robot is a tube around them: every disc lies in the ball of its radius around the backbone.
/// Theory: docs/theory/insertion.md
#pragma once
#include <span>
#include <vector>

#include "math/linalg.hpp"
#include "sinew/plan/insertion.hpp"
#include "sinew/plan/scene.hpp"

namespace sinew::inline v1 {

/// Where a robot is: unknowns of all searches. `x` is the stage, then two bends a section.
using Posture = std::vector<double>;

Posture posture_of(const InsertionStep& step);
InsertionStep step_of(std::span<const double> posture);

inline std::size_t posture_size(const SerialRobot& robot) { return 1 + 2 * robot.sections.size(); }

class Body {
 public:
  /// @param spacing of points along the backbone, at most [m]
  Body(const InsertionScene& scene, double spacing);

  /// Places all points; with `rates`, their derivatives too.
  void place(std::span<const double> posture, bool rates);

  double posture(std::size_t k) const { return posture_[k]; }  ///< as it was placed last
  std::size_t size() const { return points_.size(); }
  std::size_t unknowns() const { return unknowns_; }
  const Vec3<double>& point(std::size_t i) const { return points_[i]; }
  double radius(std::size_t i) const { return radii_[i]; }
  /// Of the robot's length, from its base [m].
  double arc(std::size_t i) const { return arcs_[i]; }
  int section(std::size_t i) const { return sections_[i]; }
  /// Unknowns that move the point: the first so many.
  std::size_t movers(std::size_t i) const {
    return i == 0 ? 1 : 3 + 2 * static_cast<std::size_t>(sections_[i]);
  }
  /// ∂point/∂x_k
  const Vec3<double>& rate(std::size_t i, std::size_t k) const { return rates_[i * unknowns_ + k]; }
  /// Direction of the backbone at its tip, and ∂/∂x_k.
  Vec3<double> tip_direction() const { return direction_; }
  Vec3<double> tip_direction_rate(std::size_t k) const { return cross(turns_[k], direction_); }

  /// How far the arc from point `i` to the next leaves its chord at most [m].
  double sagitta(std::size_t i) const;
  /// Arc over which an unknown may swing point `i` [m/rad].
  double lever(std::size_t i, std::size_t k) const { return levers_[i * unknowns_ + k]; }

  /// How far point `i` moves at most while every unknown goes straight from one posture to the other: the
  /// sum of what each joint that turns does to it, which is at most its turn times the arc between them.
  double motion_bound(std::size_t i, std::span<const double> from, std::span<const double> to) const;

  /// How far point `i` sags at most: at each joint the moment of all that is distal of it, with arms as long
  /// as the arc, bends and twists a round backbone; tendons that hold it as well are left out.
  double sag_bound(std::size_t i, const InsertionWeight& weight) const;

 private:
  struct Piece {
    int section;
    bool is_joint;
    int joint;      ///< number in its section
    double length;  ///< along the backbone [m]
    double share;   ///< of the joint's arc
  };
  const SerialRobot* robot_;
  SE3<double> base_;
  Vec3<double> axis_;
  std::size_t unknowns_;
  Posture posture_;
  std::vector<Piece> pieces_;  ///< piece i ends at point i + 1
  std::vector<Vec3<double>> points_, rates_, turns_;
  std::vector<double> radii_, arcs_;
  std::vector<int> sections_;
  Vec3<double> direction_{0, 0, 1};
  std::vector<double> levers_;  ///< of point i: arc over which each unknown may swing it [m/rad]
};

}  // namespace sinew::inline v1
