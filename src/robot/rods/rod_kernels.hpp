/// @file rod_kernels.hpp
/// The inner loops of rods in SIMD lanes, in the widest instruction set this machine has. One function is one
/// sweep over the rods; robot/rods/elastica_system.hpp makes Newton's method of them.
#pragma once
#include <span>

#include "robot/rods/rod_lanes.hpp"

namespace sinew::inline v1 {

using CoarseRods = RodLanes<coarse_nodes>;
using FineRods = RodLanes<fine_nodes>;

/// A platform as the rods see it.
struct alignas(64) RodPlatform {
  double wrench[8];                 ///< of the world on it, base axes; then two zeros
  double inverse[6][8];             ///< columns of the inverse of its stiffness, each with two zeros
  double rotation[9], position[3];  ///< rows first; [m]
};

/// What the rods make of a platform: forces and moments on their tips, and their change by its twist.
struct alignas(64) RodSums {
  double wrench[8];      ///< Σ n, Σ b × n; the last two are of no use
  double twist[8];       ///< Newton's step (δp, δφ), likewise
  double stiffness[36];  ///< ∂wrench/∂(δp, δφ), rows first
  double rod_error;      ///< largest gap: closure over length, or of the rods' own equations; NaN if any is
  double error;          ///< the balance of the platform too, see ElasticaSystem::evaluate
};

/// Lengths fed to the rods of a group [m].
struct alignas(64) RodFeed {
  RodLane length;
};

/// Eight poses of one robot, one a lane; its rods are then one RodLanes each.
struct alignas(64) PoseLanes {
  RodLane position[3], quaternion[4];
  RodLane wrench[6];    ///< of the world on the platform
  RodLane missing[6];   ///< to balance, once the gaps of the rods are closed
  RodLane twist[6];     ///< the last step
  RodLane error;        ///< as ElasticaSystem::evaluate, of each pose
  RodLane factors[36];  ///< of the platforms' stiffness
  RodLane unstable;     ///< directions in which the pose does not hold by itself, where that was asked
};

/// What is done to eight poses in one sweep over their rods.
struct PoseStep {
  bool moves = true;             ///< else they are evaluated where they are
  bool from_scratch = false;     ///< see ElasticaSystem::evaluate
  bool renews = false;           ///< factors
  bool counts_unstable = false;  ///< directions, by the pivots of these factors
};

namespace rod_kernels {

/// Gaps, forces: `wrench` and the errors. Not `from_scratch` it takes sines and Bθ as the last step left
/// them.
void evaluate(std::span<CoarseRods> groups, const RodPlatform& platform, bool from_scratch, RodSums& sums);
void evaluate(std::span<FineRods> groups, const RodPlatform& platform, bool from_scratch, RodSums& sums);

/// Factors at the point last evaluated: `stiffness`, and `wrench` of the forces that close the gaps. False
/// where the stiffness is too near to singular for its `inverse` to be of use.
bool linearise(std::span<CoarseRods> groups, RodPlatform& platform, RodSums& sums);
bool linearise(std::span<FineRods> groups, RodPlatform& platform, RodSums& sums);

/// Newton's `twist` with the last factors and inverse, and `wrench` as after `linearise`, which need not be
/// found again where it is `fresh` from there.
void step(std::span<CoarseRods> groups, const RodPlatform& platform, bool fresh, RodSums& sums);
void step(std::span<FineRods> groups, const RodPlatform& platform, bool fresh, RodSums& sums);

/// Moves the states by the platform's step (δp, δφ) and, where not null, by the lengths fed to each group.
void apply(std::span<CoarseRods> groups, const double* step, const RodFeed* fed);
void apply(std::span<FineRods> groups, const double* step, const RodFeed* fed);

/// Of each lane the largest of all groups: see ElasticaSystem::truncation.
void truncation(std::span<const CoarseRods> groups, double* largest);
void truncation(std::span<const FineRods> groups, double* largest);

/// Eight poses at once, `rods[k]` holds rod k of each: Newton's step from where they were last evaluated, and
/// evaluation where it leads.
void advance(std::span<CoarseRods> rods, const PoseStep& step, PoseLanes& poses);

/// Name of the instruction set in use.
const char* instruction_set();

}  // namespace rod_kernels
}  // namespace sinew::inline v1
