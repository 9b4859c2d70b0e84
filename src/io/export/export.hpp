/// @file export.hpp
/// A robot in the languages of what drives it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "robot/controller.hpp"

namespace sinew::inline v1 {

struct ExportedFile {
  std::string name, text;
};

/// A C++14 header for controllers: the tables of sinew/kernel/table.h filled in, in a namespace of that name.
std::string controller_header(const ControllerTable& table, std::string_view name = "robot");

/// A core for an FPGA in Verilog-2005, LSK forward and inverse with states of tendons, and a testbench that
/// works in any simulator. Its modules are named after the robot. Theory: docs/theory/controller.md
std::vector<ExportedFile> controller_verilog(const ControllerTable& table);

}  // namespace sinew::inline v1
