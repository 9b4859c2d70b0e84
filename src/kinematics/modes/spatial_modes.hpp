/// @file spatial_modes.hpp
/// All assembly modes of a spatial robot whose six legs each keep a platform point at a distance from a base
/// point (6-UFS, and any Stewart-Gough platform). The 40 complex solutions of six general legs are carried to
/// the given ones; those that arrive real are the modes. Theory: docs/theory/spatial_modes.md
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "leg/platform_constraint.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

struct SpatialModesOptions {
  int attempts = 3;         ///< sets of 40 paths at most; another set where one leaves something open
  int max_steps = 3000;     ///< of one path
  int newton_starts = 300;  ///< where the paths leave something open
  std::uint64_t seed = 1;   ///< of the paths' way through the complex numbers
  StopToken stop = {};      ///< looked at between paths and starts: a millisecond or less
};

/// What the search found, and how far it can be believed.
struct SpatialModes {
  Report report;  ///< `unreachable`: no pose exists; `stalled`: none was found; `singular`: a continuum
  std::vector<SpatialPose> poses;  ///< z descending, then y, then x descending, then the quaternion
  std::vector<double> residual;    ///< largest closure error of each pose [m]
  int complex_count = 0;           ///< different finite complex solutions met, of at most 40
  int infinite_paths = 0;  ///< paths of 40 that ended at infinity: no finite solution is missing for them
  int lost_paths = 40;     ///< paths of 40 whose end is not known
  int singular_count = 0;  ///< solutions met where J is singular: modes merge there, or a self-motion passes

  /// The poses are all there are (told apart from 1e-6 on), with probability one over the seed and as far as
  /// the paths' step control holds. Otherwise their number is a lower bound.
  bool is_complete() const noexcept { return lost_paths == 0 && singular_count == 0; }
};

/// Legs beyond the sixth only choose among the poses of six. Deterministic, bounded work, no threads; the
/// first call in a process also finds the 40 solutions that all searches start from.
SpatialModes spatial_modes(std::span<const PlatformConstraint<3>> legs,
                           const SpatialModesOptions& options = {});

}  // namespace sinew::inline v1
