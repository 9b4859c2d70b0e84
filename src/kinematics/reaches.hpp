/// Forward kinematics knows a robot by its reaches alone: one a leg, once the links are shaped.
#pragma once
#include <array>

#include "sinew/robot/workspace.hpp"

namespace sinew::inline v0 {

template <int D>
struct Reaches {
  std::array<Reach<D>, max_rows> data;
  std::size_t count = 0;

  std::span<const Reach<D>> view() const { return {data.data(), count}; }
};

template <class LegT>
Reaches<LegT::Space::dimension> reaches_of(const ParallelRobot<LegT>& robot, Numbers coordinates) {
  Reaches<LegT::Space::dimension> reaches;
  robot.for_each_leg([&](const auto& leg, const LegPlace& place, int) {
    reaches.data[reaches.count++] = leg.reach(own_coordinates(leg, place, coordinates));
  });
  return reaches;
}

}  // namespace sinew::inline v0
