/// @file limits.hpp
/// Static maxima: with them nothing in a hot path touches the heap.
#pragma once
#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// Most constraint rows of a robot, and most rows or columns of a matrix that is decomposed.
inline constexpr int max_rows = 24;

/// Most sections of a serial robot: two columns of its Jacobian each.
inline constexpr int max_sections = max_rows / 2;

/// Most joints of a pseudo-rigid link.
inline constexpr int max_chain_joints = 32;

}  // namespace sinew::inline v1
