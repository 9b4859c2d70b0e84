/// @file parallel.hpp
/// A parallel robot: legs and a platform, never a class of its own. Constant once built and shared between
/// threads; all memory that changes is in a Workspace. Theory: docs/theory/leg.md
#pragma once
#include <vector>

#include "sinew/leg/any_leg.hpp"

namespace sinew::inline v0 {

template <class LegT>
struct ParallelRobot {
  using Leg = LegT;
  using Space = typename Leg::Space;
  using Pose = typename Space::Pose;

  std::vector<Leg> legs;
  std::vector<int> input_of_leg;  ///< index of the leg's actuator; legs that are tied share one
  Pose home = {};                 ///< where solvers start when told nothing else
  double platform_radius = 0;     ///< homogenises moments in the indices [m], > 0

  /// Every leg has an input of its own.
  bool has_ties() const { return input_count() < leg_count(); }
  int leg_count() const { return static_cast<int>(legs.size()); }
  int row_count() const { return leg_count(); }  // each closure here gives one row
  int input_count() const {
    return input_of_leg.empty() ? 0 : 1 + *std::max_element(input_of_leg.begin(), input_of_leg.end());
  }
};

}  // namespace sinew::inline v0
