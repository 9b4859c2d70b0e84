/// @file frame_kernels.hpp
/// The inner loops of rods as fields of frames, in SIMD lanes; robot/rods/general_system.hpp makes Newton's
/// method of them.
#pragma once
#include <span>

#include "robot/rods/frame_lanes.hpp"

namespace sinew::inline v1::frame_kernels {

/// Gaps, places of the tips, errors.
void evaluate(std::span<FrameRods> groups, int elements);

/// Factors at the point last evaluated: `condensed`, and as `close`.
/// @param shift of the energy's curvature by all turns [EI/L]
void linearise(std::span<FrameRods> groups, int elements, double shift = 0);

/// `reduced` and `open` of the last evaluation, with the last factors.
void close(std::span<FrameRods> groups, int elements);

/// Moves frames, forces and lengths by `step`. After `linearise` or `close`.
void apply(std::span<FrameRods> groups, int elements);

/// Of each lane the largest of all groups: squares of the two highest Legendre coefficients of the frames'
/// rates.
void truncation(std::span<const FrameRods> groups, int elements, double* largest);

}  // namespace sinew::inline v1::frame_kernels
