/// @file builtin.hpp
/// The study files that are part of the library: studies/*.yaml.
#pragma once
#include <span>
#include <string_view>

namespace sinew::inline v0 {

struct BuiltinFile {
  std::string_view name;  ///< without `.yaml`
  std::string_view text;
};

std::span<const BuiltinFile> builtin_studies();

}  // namespace sinew::inline v0
