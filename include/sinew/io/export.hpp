/// @file export.hpp
/// A robot in the languages of what drives it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/robot/controller.hpp"

namespace sinew::inline v0 {

struct ExportedFile {
  std::string name, text;
};

/// A C++14 header for controllers: the tables of sinew/kernel/table.h filled in, in a namespace of that name.
SINEW_API std::string controller_header(const ControllerTable& table, std::string_view name = "robot");

}  // namespace sinew::inline v0
