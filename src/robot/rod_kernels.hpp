/// @file rod_kernels.hpp
/// The inner loops of rods in SIMD lanes, in the widest instruction set this machine has. One function is one
/// sweep over the rods; robot/rod_system.hpp makes Newton's method of them.
#pragma once
#include <span>

#include "robot/rod_lanes.hpp"

namespace sinew::inline v0 {

using CoarseRods = RodLanes<coarse_nodes>;
using FineRods = RodLanes<fine_nodes>;

/// Rotation matrix (rows first) and position of a platform; wrench-like sums about its reference point.
struct PlatformFrame {
  double rotation[9], position[3];
};

/// What the rods make of a platform: forces and moments on their tips, and their change by its twist.
struct RodSums {
  double wrench[6];      ///< Σ n, Σ b × n
  double stiffness[36];  ///< ∂wrench/∂(δp, δφ), rows first
  double error;          ///< largest gap: closure over length, or of the rod's own equations; NaN if any is
};

/// Lengths fed to the rods of a group [m].
struct alignas(64) RodFeed {
  RodLane length;
};

/// Eight poses of one robot, one a lane; its rods are then one RodLanes each.
struct alignas(64) PoseLanes {
  RodLane position[3], quaternion[4];
  RodLane wrench[6];    ///< of the world on the platform
  RodLane missing[6];   ///< to balance
  RodLane error;        ///< as RodSystem::evaluate, of each pose
  RodLane factors[36];  ///< of the platforms' stiffness
};

namespace rod_kernels {

/// Gaps, forces: `wrench` and `error`. Not `anew` it takes Bθ as the last step left it.
void evaluate(std::span<CoarseRods> groups, const PlatformFrame& platform, bool anew, RodSums& sums);
void evaluate(std::span<FineRods> groups, const PlatformFrame& platform, bool anew, RodSums& sums);

/// Factors at the point last evaluated: `stiffness`, and `wrench` of the forces that close the gaps.
void linearise(std::span<CoarseRods> groups, RodSums& sums);
void linearise(std::span<FineRods> groups, RodSums& sums);

/// With kept factors: `wrench` of the forces that would close the gaps of the last evaluation.
void reduce(std::span<CoarseRods> groups, RodSums& sums);
void reduce(std::span<FineRods> groups, RodSums& sums);

/// Moves the states by the platform's step (δp, δφ) and, where not null, by the lengths fed to each group.
void apply(std::span<CoarseRods> groups, const double* step, const RodFeed* fed);
void apply(std::span<FineRods> groups, const double* step, const RodFeed* fed);

/// @name Eight poses at once: `rods[k]` holds rod k of each
/// @{
void evaluate(std::span<CoarseRods> rods, bool anew, PoseLanes& poses);
void linearise(std::span<CoarseRods> rods, PoseLanes& poses);
void step(std::span<CoarseRods> rods, bool fresh, PoseLanes& poses);
/// @}

/// Name of the instruction set in use.
const char* instruction_set();

}  // namespace rod_kernels
}  // namespace sinew::inline v0
