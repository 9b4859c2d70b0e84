/// @file parallel.hpp
/// What a robot is made of: legs and a platform, never a class of its own. Theory: docs/theory/leg.md
#pragma once
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "leg/any_leg.hpp"
#include "robot/catalog.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

/// Where a leg's rows, link coordinates and inputs begin among the robot's.
struct LegPlace {
  int row = 0, coordinate = 0, input = 0;
  int plane = 0;         ///< row of its plane, if it has one: these follow after all others, [3PFS (17)]
  bool is_tied = false;  ///< its inputs are those of an earlier leg

  /// Where the k-th row of such a leg is.
  template <class LegT>
  int row_of(int k) const {
    return k < LegT::driven_rows ? row + k : plane;
  }
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
  int rods = 0;    ///< legs that bear load

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
        if (BearsLoad<L>) ++rods;
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

  /// The same of legs that are all alike.
  template <class Alike>
  ParallelRobot(const ParallelRobot<Alike>& robot)
      : home(robot.home),
        platform_radius(robot.platform_radius),
        places(robot.places),
        total(robot.total),
        rods(robot.rods) {
    for (const Alike& leg : robot.legs) legs.push_back(Leg{leg});
  }

  int leg_count() const { return static_cast<int>(legs.size()); }
  bool has_ties() const { return total.is_tied; }

  /// Calls `use(leg, place, i)` with each concrete leg.
  template <class Use>
  void for_each_leg(Use&& use) const {
    for (std::size_t i = 0; i < legs.size(); ++i)
      with_leg(legs[i], [&](const auto& leg) { use(leg, places[i], static_cast<int>(i)); });
  }
  /// ... that closes.
  template <class Use>
  void for_each_closing_leg(Use&& use) const {
    for_each_leg([&]<class L>(const L& leg, const LegPlace& place, int i) {
      if constexpr (!BearsLoad<L>) use(leg, place, i);
    });
  }
};

namespace detail {
template <class List>
struct AnyOf;
template <class... Ts>
struct AnyOf<TypeList<Ts...>> {
  using type = AnyLeg<Ts...>;
};
}  // namespace detail

using AnyPlanarLeg = detail::AnyOf<PlanarLegs>::type;
using AnySpatialLeg = detail::AnyOf<LoadedLegs>::type;

/// All that a Robot knows of its legs and its platform.
struct PlanarRobot : ParallelRobot<AnyPlanarLeg> {
  using ParallelRobot::ParallelRobot;
};
struct SpatialRobot : ParallelRobot<AnySpatialLeg> {
  using ParallelRobot::ParallelRobot;
};

template <class LegT>
Robot::Robot(std::string name, const ParallelRobot<LegT>& legs)
    : Robot(std::move(name),
            std::conditional_t<LegT::Space::dimension == 2, PlanarRobot, SpatialRobot>(legs)) {}

/// Calls `use` with the legs of a robot, which are those of one space.
template <class Use>
decltype(auto) with_legs(const Robot& robot, Use&& use) {
  if (const auto* planar = robot.planar()) return use(*planar);
  return use(*robot.spatial());
}

/// Calls `use` with the legs of a robot if all close on the platform, and `otherwise()` if some bear load.
template <class Use, class Otherwise>
std::invoke_result_t<Otherwise> with_closing_legs(const Robot& robot, Use&& use, Otherwise&& otherwise) {
  if (bears_load(robot)) return otherwise();
  return with_legs(robot, use);
}

/// Its legs of one kind, in their order, with their places in the whole robot. Allocates.
template <class LegT, class Any>
ParallelRobot<LegT> legs_of(const ParallelRobot<Any>& robot) {
  ParallelRobot<LegT> found;
  found.home = robot.home;
  found.platform_radius = robot.platform_radius;
  found.total = robot.total;
  found.rods = robot.rods;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const auto* leg = std::get_if<LegT>(&robot.legs[i].kind);
    if (!leg) continue;
    found.legs.push_back(*leg);
    found.places.push_back(robot.places[i]);
  }
  return found;
}
template <class LegT>
ParallelRobot<LegT> legs_of(const Robot& robot) {
  if constexpr (LegT::Space::dimension == 2)
    return robot.planar() ? legs_of<LegT>(*robot.planar()) : ParallelRobot<LegT>();
  else
    return robot.spatial() ? legs_of<LegT>(*robot.spatial()) : ParallelRobot<LegT>();
}

/// The robot with every leg changed by `change(leg)`: one of its own.
template <class Change>
Robot with_changed_legs(const Robot& robot, Change&& change) {
  const auto changed = [&](auto legs) {
    for (auto& any : legs.legs) with_leg(any, change);
    return legs;
  };
  if (const auto* planar = robot.planar())
    return Robot(robot.name(), changed(*planar), robot.geometry_inferred());
  return Robot(robot.name(), changed(*robot.spatial()), robot.weight(), robot.geometry_inferred());
}

/// Calls `use(leg, place, i)` with each rod of a robot, in the order of its legs.
template <class Use>
void for_each_rod(const Robot& robot, Use&& use) {
  if (const auto* spatial = robot.spatial())
    spatial->for_each_leg([&]<class L>(const L& leg, const LegPlace& place, int i) {
      if constexpr (BearsLoad<L>) use(leg, place, i);
    });
}

/// The coordinates of one leg out of the robot's.
template <class LegT>
typename LegT::Coordinates own_coordinates(const LegT&, const LegPlace& place, std::span<const double> all) {
  return typename LegT::Coordinates(all.data() + place.coordinate);
}

}  // namespace sinew::inline v1
