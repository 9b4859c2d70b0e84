/// @file same_name.hpp
/// Names of fields, compared.
#pragma once
#include <string_view>

namespace sinew::inline v1 {

/// Most of those that differ do in their length or their first letter, which is seen without a call.
inline bool is_same_name(std::string_view a, std::string_view b) {
  return a.size() == b.size() && (a.empty() || a.front() == b.front()) && a == b;
}

}  // namespace sinew::inline v1
