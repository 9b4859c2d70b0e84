/// @file vectors.hpp
/// What a core has to say of some robots, by integers in plain arithmetic: a second way to the bits of
/// kernel::LinearTable, of sizes that are not known at compile time.
#pragma once
#include <cstdint>
#include <vector>

#include "robot/controller.hpp"

namespace sinew::inline v1::verilog {

struct Bend {
  std::int64_t x = 0, y = 0;
};

/// One section of a robot in a stream.
struct Vector {
  Bend bend;
  std::vector<std::int64_t> changes;
  bool in_limits = true;  ///< this section and those before
  std::vector<std::int64_t> measured;
  Bend found;
  std::vector<int> states;
};

/// Robots in turn, the sections of each in turn: at rest, at limits, at the ends of 16 bits, at random.
std::vector<Vector> vectors(const ControllerTable& table);

}  // namespace sinew::inline v1::verilog
