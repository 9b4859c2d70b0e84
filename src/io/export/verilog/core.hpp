/// @file core.hpp
/// A core in Verilog and what its testbench has to know of it. Theory: docs/theory/controller.md
#pragma once
#include <string>

#include "robot/controller.hpp"

namespace sinew::inline v1::verilog {

/// What modules of this robot are called before their own name, and clocks from a section to its result.
struct Core {
  std::string name;
  int levels = 0;   ///< of adders, of the inverse's products
  int nearest = 0;  ///< to the sums of bends
  int forward = 0, inverse = 0;
};

Core core_of(const ControllerTable& table);
std::string core_text(const ControllerTable& table, const Core& core);
std::string bench_text(const ControllerTable& table, const Core& core);

}  // namespace sinew::inline v1::verilog
