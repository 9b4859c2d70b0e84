/// @file chord_lanes.hpp
/// Robots of arcs between free joints, one pose a lane. What the lanes cannot tell for certain they leave.
#pragma once
#include <array>

#include "sinew/analysis/velocity_batch.hpp"

namespace sinew::inline v0::chord_lanes {

struct ChordLeg {
  double length, offset;              ///< backbone ℓ, tendon offset d [m]
  double bending;                     ///< sign of the curvature, ±1
  double domain;                      ///< curvatures lie below it [1/m]
  std::array<double, 3> base, point;  ///< a in the base frame, b in that of the platform [m]
};

struct ChordRobot {
  int dof = 0;  ///< 3 or 6, and as many legs
  double radius = 0;
  std::array<ChordLeg, 6> legs = {};
};

/// Some of a batch of `total` poses.
struct Part {
  const double* poses;  ///< of the batch
  std::size_t total, first, count;
};

/// How far from a border, relatively, a pose must be for the lanes to answer.
inline constexpr double straight_margin = 1e-7;    ///< of the chord to the backbone's length
inline constexpr double domain_margin = 1e-9;      ///< of the curvature to its domain
inline constexpr double type_2_margin = 1e-9;      ///< σmin/σmax of the homogenised J
inline constexpr double condition_margin = 1e-14;  ///< σmin/σmax of J

/// Answers all poses but those it marks as doubtful, one mark a pose of the part.
void evaluate(const ChordRobot& robot, const Part& part, const VelocityBatch& out, std::uint8_t* doubtful);

/// Name of the instruction set that is used.
const char* instruction_set();

}  // namespace sinew::inline v0::chord_lanes
