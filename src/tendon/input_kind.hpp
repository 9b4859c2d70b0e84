/// @file input_kind.hpp
/// What a motor of a leg commands.
#pragma once
#include <string_view>

#include "sinew/units.hpp"

namespace sinew::inline v1 {

/// What a motor commands, and in which unit.
struct InputKind {
  std::string_view name;
  Dimension dimension;
};

}  // namespace sinew::inline v1
