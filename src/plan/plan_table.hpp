/// @file plan_table.hpp
/// A plan as a table: a row a step. Columns: docs/scenes.md
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sinew/io/table.hpp"
#include "sinew/plan/insertion.hpp"

namespace sinew::inline v1 {

/// @param seed that the plan was made with
Table plan_table(const InsertionScene& scene, const InsertionPlan& plan, std::uint64_t seed);

/// The steps in such a table, whatever else it has. Codes: `missing_column`, `no_rows`, `not_a_number`.
/// @param file names the table in errors
Expected<std::vector<InsertionStep>> plan_steps(const Table& table, const InsertionScene& scene,
                                                const std::string& file);

/// The two angles of each section at a step, as such a table has them and `forward` takes them.
std::vector<std::array<double, 2>> plan_angles(const InsertionScene& scene, const InsertionStep& step);

}  // namespace sinew::inline v1
