/// @file thorough.hpp
/// How often tests draw: often enough to notice a fault, or as often as SINEW_TEST_THOROUGH=1 asks for.
#pragma once
#include <cstdlib>
#include <string_view>

namespace sinew::test {

inline bool is_thorough() {
  const char* asked = std::getenv("SINEW_TEST_THOROUGH");
  return asked && *asked && std::string_view(asked) != "0";
}

/// `usual`, or `all` where SINEW_TEST_THOROUGH is set.
template <class Count>
Count count_of(Count usual, Count all) {
  return is_thorough() ? all : usual;
}

}  // namespace sinew::test
