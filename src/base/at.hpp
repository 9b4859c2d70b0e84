/// @file at.hpp
/// An int as an index of what the standard library counts in std::size_t.
#pragma once
#include <cstddef>

namespace sinew::inline v1 {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace sinew::inline v1
