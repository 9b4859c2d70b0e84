/// @file parallel.hpp
/// A parallel robot: legs and a platform, never a class of its own. Constant once built and shared between
/// threads; all memory that changes is in a Workspace. Theory: docs/theory/leg.md
#pragma once
#include <utility>
#include <vector>

#include "sinew/base/assert.hpp"
#include "sinew/leg/any_leg.hpp"

namespace sinew::inline v0 {

/// Where a leg's rows, link coordinates and inputs begin among the robot's.
struct LegPlace {
  int row = 0, coordinate = 0, input = 0;
  int plane = 0;         ///< row of its plane, if it has one: these follow after all others, [3PFS (17)]
  bool is_tied = false;  ///< its inputs are those of an earlier leg
};

template <class LegT>
struct ParallelRobot {
  using Leg = LegT;
  using Space = typename Leg::Space;
  using Pose = typename Space::Pose;

  std::vector<Leg> legs;
  Pose home = {};              ///< where solvers start when told nothing else
  double platform_radius = 0;  ///< homogenises moments in the indices [m], > 0
  std::vector<LegPlace> places;
  LegPlace total;  ///< number of rows, planes among them, link coordinates, inputs

  ParallelRobot() = default;

  /// @param tied for each leg the earlier leg whose actuators it shares, or −1; none where empty
  ParallelRobot(std::vector<Leg> robot_legs, Pose robot_home, double radius, std::span<const int> tied = {})
      : legs(std::move(robot_legs)),
        home(robot_home),
        platform_radius(radius) {
    for (std::size_t i = 0; i < legs.size(); ++i) {
      LegPlace place = total;
      place.is_tied = !tied.empty() && tied[i] >= 0;
      if (place.is_tied) place.input = places.at(static_cast<std::size_t>(tied[i])).input;
      places.push_back(place);
      with_leg(legs[i], [&]<class L>(const L&) {
        total.row += L::driven_rows;
        if (L::has_plane) ++total.plane;
        total.coordinate += L::coordinates;
        if (!place.is_tied) total.input += L::inputs;
      });
      total.is_tied = total.is_tied || place.is_tied;
    }
    for (LegPlace& place : places) place.plane += total.row;
    total.row += total.plane;
  }

  int leg_count() const { return static_cast<int>(legs.size()); }
  bool has_ties() const { return total.is_tied; }

  /// Calls `use(leg, place, i)` with each concrete leg.
  template <class Use>
  void for_each_leg(Use&& use) const {
    for (std::size_t i = 0; i < legs.size(); ++i)
      with_leg(legs[i], [&](const auto& leg) { use(leg, places[i], static_cast<int>(i)); });
  }
};

/// The coordinates of one leg out of the robot's.
template <class LegT>
typename LegT::Coordinates own_coordinates(const LegT&, const LegPlace& place, std::span<const double> all) {
  return typename LegT::Coordinates(all.data() + place.coordinate);
}

}  // namespace sinew::inline v0
