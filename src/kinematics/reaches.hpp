/// Forward kinematics knows a robot by its reaches alone: one a leg, once the links are shaped.
#pragma once
#include <array>
#include <cstddef>
#include <new>
#include <type_traits>

#include "base/limits.hpp"
#include "robot/parallel.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

/// A list of fixed capacity; what is not listed is not initialised.
template <int D>
class Reaches {
 public:
  void add(const PlatformConstraint<D>& reach) { new (place(count_++)) PlatformConstraint<D>(reach); }
  std::span<const PlatformConstraint<D>> view() const {
    return {std::launder(reinterpret_cast<const PlatformConstraint<D>*>(bytes_.data())), count_};
  }

 private:
  static_assert(std::is_trivially_destructible_v<PlatformConstraint<D>>);
  void* place(std::size_t i) { return bytes_.data() + i * sizeof(PlatformConstraint<D>); }

  alignas(PlatformConstraint<D>) std::array<std::byte, max_rows * sizeof(PlatformConstraint<D>)> bytes_;
  std::size_t count_ = 0;
};

template <class LegT>
Reaches<LegT::Space::dimension> reaches_of(const ParallelRobot<LegT>& robot, Numbers coordinates) {
  Reaches<LegT::Space::dimension> reaches;
  robot.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int) {
    reaches.add(leg.reach(own_coordinates(leg, place, coordinates)));
  });
  return reaches;
}

}  // namespace sinew::inline v1
