/// @file legs_loads.hpp
/// Loads on a platform on arms: on the platform, along legs and at places of legs. Theory:
/// docs/theory/arm_legs.md
#pragma once
#include <array>
#include <vector>

#include "sinew/kinematics/arm_legs.hpp"
#include "sinew/robot/arm_legs.hpp"

namespace sinew::inline v1 {

/// What acts beside the wrench on the platform, and the gravity of the whole.
struct LegsLoads {
  std::array<double, 3> gravity{}, along{}, following_along{};
  std::array<double, 6> following{};  ///< on the platform, in its axes
  std::vector<ArmLegsPointLoad> points = {};
};
/// At a share of the way from one to another.
LegsLoads mix(const LegsLoads& from, const LegsLoads& to, double share);
/// What of a share of the loads acts on each leg.
std::vector<ArmLoad> loads_of_legs(const LegsLoads& loads, double share, std::size_t legs);
/// Whether what acts on one leg has a potential: what follows has none, nor has a moment in space. In the
/// plane a moment has one, since all rotations are about one axis.
bool load_has_potential(const ArmLoad& load, bool is_planar);

/// Places of each leg where its rod has nodes beside its own, in order and none twice [m].
using LegsBreaks = std::vector<std::vector<double>>;
/// Where loads act that are not 0.
LegsBreaks breaks_for(const ArmLegs& robot, const LegsLoads& loads);
/// Whether loads may act at all of these places.
bool has_all(const LegsBreaks& breaks, const LegsBreaks& wanted);
LegsBreaks together(const LegsBreaks& a, const LegsBreaks& b);

}  // namespace sinew::inline v1
