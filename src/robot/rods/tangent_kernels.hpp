/// @file tangent_kernels.hpp
/// The inner loops of rods as fields of tangents, in SIMD lanes; robot/rods/tangent_system.hpp makes Newton's
/// method of them.
#pragma once
#include <span>

#include "robot/rods/rod_kernels.hpp"
#include "robot/rods/tangent_lanes.hpp"

namespace sinew::inline v1::tangent_kernels {

/// Gaps, forces and moments at the tips: `wrench`, errors. `from_scratch` after states were set, not stepped.
void evaluate(std::span<TangentRods> groups, int elements, const RodPlatform& platform, bool from_scratch,
              RodSums& sums);

/// Factors at the point last evaluated: `stiffness`, and `wrench` of the forces that close the gaps.
void linearise(std::span<TangentRods> groups, int elements, RodSums& sums);

/// `wrench` as after `linearise`, from the last evaluation with the last factors.
void close(std::span<TangentRods> groups, int elements, RodSums& sums);

/// Moves the states by the platform's step (δp, δφ) and, where not null, by the lengths fed to each group.
/// After `linearise` or `close`.
void apply(std::span<TangentRods> groups, int elements, const double* step, const RodFeed* fed);

/// Of each lane the largest of all groups: squares of the two highest Legendre coefficients of t′.
void truncation(std::span<const TangentRods> groups, int elements, double* largest);

}  // namespace sinew::inline v1::tangent_kernels
