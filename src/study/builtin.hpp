/// @file builtin.hpp
/// Files that are part of the library: studies/*.yaml, data/, and the program that counts cycles on a
/// controller with the kernel that it includes.
#pragma once
#include <span>
#include <string_view>

namespace sinew::inline v1 {

struct BuiltinFile {
  std::string_view name;  ///< of a study without `.yaml`; of a source its path as it is included
  std::string_view text;
};

std::span<const BuiltinFile> builtin_studies();
/// A table below data/: `rods/steel.csv`.
std::string_view builtin_data(std::string_view name);
std::span<const BuiltinFile> builtin_firmware();

}  // namespace sinew::inline v1
