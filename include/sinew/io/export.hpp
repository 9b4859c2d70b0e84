/// @file export.hpp
/// A robot in the languages of what drives it.
#pragma once
#include <string>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/robot/controller.hpp"

namespace sinew::inline v0 {

struct ExportedFile {
  std::string name, text;
};

/// A C++14 header for controllers: the tables of sinew/kernel/table.h filled in, `namespace robot`.
SINEW_API std::vector<ExportedFile> controller_header(const ControllerTable& table);

}  // namespace sinew::inline v0
