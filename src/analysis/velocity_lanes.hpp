/// @file velocity_lanes.hpp
/// Robots whose legs close in closed form, one pose a lane. What the lanes cannot tell for certain they
/// leave. Theory: docs/theory/velocity.md
#pragma once
#include <array>
#include <variant>

#include "sinew/analysis/velocity.hpp"

namespace sinew::inline v1::velocity_lanes {

/// An arc between free joints.
struct ChordLeg {
  double length, offset;              ///< backbone ℓ, tendon offset d [m]
  double bending;                     ///< sign of the curvature, ±1
  double domain;                      ///< curvatures lie below it [1/m]
  std::array<double, 3> base, point;  ///< a in the base frame, b in that of the platform [m]
};

struct ChordRobot {
  int dof = 3;  ///< 3 or 6, and as many legs
  double radius = 0;
  std::array<ChordLeg, 6> legs = {};
};

/// A carriage on a rail, and a strut on its hinge.
struct HingedLeg {
  double strut;                       ///< L [m]
  double elbow;                       ///< +1: the strut leads ahead along the rail; −1: back
  std::array<double, 3> base, point;  ///< a in the base frame, b in that of the platform [m]
  /// Unit vectors in the base frame: of the hinge, along the rail, and square to both.
  std::array<double, 3> hinge, rail, across;
};

struct HingedRobot {
  double radius = 0;
  double size = 0;  ///< a length to compare errors with [m]
  std::array<HingedLeg, 3> legs = {};
};

/// Nothing where the lanes do not serve a robot.
using LaneRobot = std::variant<std::monostate, ChordRobot, HingedRobot>;

/// Some of a batch of `total` poses.
struct Part {
  const double* poses;  ///< of the batch
  std::size_t total, first, count;
  std::optional<OperationMode> independent;  ///< as `PoseBatch`
};

/// How far from a border, relatively, a pose must be for the lanes to answer.
inline constexpr double straight_margin = 1e-7;    ///< of the chord to the backbone's length
inline constexpr double domain_margin = 1e-9;      ///< of the curvature to its domain
inline constexpr double square_margin = 1e-9;      ///< of a strut to where it is square to its rail
inline constexpr double plane_margin = 2;          ///< factor of the tolerance of a hinge's plane
inline constexpr double far_margin = 1e3;          ///< of a slide over its strut, where its digits count
inline constexpr double rim_margin = 1e-6;         ///< of e₀² + e₃²
inline constexpr double type_2_margin = 1e-9;      ///< σmin/σmax of the homogenised J
inline constexpr double condition_margin = 1e-14;  ///< σmin/σmax of J

/// Answers all poses but those it marks as doubtful, one mark a pose of the part.
void evaluate(const LaneRobot& robot, const Part& part, const VelocityBatch& out, std::uint8_t* doubtful);

/// Name of the instruction set that is used.
const char* instruction_set();

}  // namespace sinew::inline v1::velocity_lanes
