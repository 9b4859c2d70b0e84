/// @file column_name.hpp
/// Names that columns of results may have.
#pragma once
#include <string_view>

#include "io/document/reader.hpp"

namespace sinew::inline v1 {

/// Letters, digits and _, not beginning with a digit.
bool is_name(std::string_view text);

/// Notes what is no name of a column, or one that has its own place in the results. Code: `bad_name`.
void check_name(const Reader& place, std::string_view name);

}  // namespace sinew::inline v1
