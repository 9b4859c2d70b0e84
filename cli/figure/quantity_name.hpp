/// @file quantity_name.hpp
/// Columns of tables as the axes of a figure name them: a quantity in words or its symbol.
#pragma once
#include <string_view>
#include <vector>

#include "io/figure/figure_text.hpp"
#include "sinew/io/table.hpp"

namespace sinew::cli {

/// Whether the table is one of this command's, whose columns are known to be of a platform or a tip.
bool is_of_sinew(const Table& table);

/// `Tension 1 of leg 2`, `φ`, `x_p` of a pose; what is not known is literal.
/// @param is_ours of a table of this command: its `x` is the platform's, its `e1` a component of a quaternion
Text quantity_name(std::string_view column, bool is_ours);

/// What several columns have in common, `Tendon length`; else what a quantity of the unit is, `Length`; empty
/// where neither is known.
Text common_name(const std::vector<const Column*>& columns);

/// `φ = 30°`
Text place_name(std::string_view column, std::string_view value, std::string_view unit, bool is_ours);

}  // namespace sinew::cli
