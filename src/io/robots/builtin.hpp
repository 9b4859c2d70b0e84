/// @file builtin.hpp
/// The robot files that are part of the library.
#pragma once
#include <span>
#include <string_view>

#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

struct BuiltinRobot {
  std::string_view name;  ///< file name without `.yaml`
  std::string_view text;  ///< the file
};

std::span<const BuiltinRobot> builtin_robots();   ///< robots/*.yaml
std::span<const BuiltinRobot> robot_templates();  ///< examples/robots/*.yaml

}  // namespace sinew::inline v1
