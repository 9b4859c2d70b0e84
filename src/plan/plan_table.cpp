#include "sinew/plan/plan_table.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace sinew::inline v0 {
namespace {

/// Names of a section's two angles, as forward takes them.
std::array<std::string, 2> angle_names(const Section& section, std::size_t number) {
  if (section.is_twin()) return {fmt::format("S{}_beta_1", number), fmt::format("S{}_beta_2", number)};
  return {fmt::format("S{}_theta", number), fmt::format("S{}_phi", number)};
}

/// Of a neutral backbone how far it bends and where to; of twin pivots the bend itself.
std::array<double, 2> angles_of(const Section& section, const Bend& bend) {
  if (section.is_twin()) return {bend[0], bend[1]};
  return {std::hypot(bend[0], bend[1]), std::atan2(bend[1], bend[0])};
}

Bend bend_of(const Section& section, double first, double second) {
  if (section.is_twin()) return {first, second};
  return {first * std::cos(second), first * std::sin(second)};
}

}  // namespace

std::vector<std::array<double, 2>> plan_angles(const InsertionScene& scene, const InsertionStep& step) {
  std::vector<std::array<double, 2>> angles;
  for (std::size_t m = 0; m < step.bends.size(); ++m)
    angles.push_back(angles_of(scene.robot.sections[m], step.bends[m]));
  return angles;
}

Table plan_table(const InsertionScene& scene, const InsertionPlan& plan, std::uint64_t seed) {
  Table table;
  table.comments = {
      fmt::format("sinew {}: way into {}", version(), scene.name.empty() ? "a scene" : scene.name),
      fmt::format("robot: {}", scene.robot_name), fmt::format("seed: {}", seed),
      fmt::format("verdict: {} (0 clear, 1 clear only if taut, 2 touches)", to_string(plan.check.verdict))};
  table.columns = {{"step", "", {}}, {"stage", "m", {}}};
  for (std::size_t m = 0; m < scene.robot.sections.size(); ++m)
    for (const std::string& name : angle_names(scene.robot.sections[m], m))
      table.columns.push_back({name, "rad", {}});
  table.columns.push_back({"clearance", "m", {}});
  table.columns.push_back({"verdict", "", {}});
  for (std::size_t k = 0; k < plan.steps.size(); ++k) {
    const InsertionStep& step = plan.steps[k];
    std::vector<double> row{static_cast<double>(k), step.stage};
    for (const auto& angles : plan_angles(scene, step)) row.insert(row.end(), angles.begin(), angles.end());
    row.push_back(step.clearance);
    row.push_back(static_cast<double>(plan.check.steps[k].verdict));
    table.add_row(row);
  }
  return table;
}

Expected<std::vector<InsertionStep>> plan_steps(const Table& table, const InsertionScene& scene,
                                                const std::string& file) {
  Errors errors;
  const auto column = [&](const std::string& name) -> const Column* {
    const Column* found = table.find(name);
    if (!found)
      errors.push_back(
          {"missing_column", file, fmt::format("has no column {}; a plan of this robot has", name)});
    return found;
  };
  const Column* stage = column("stage");
  std::vector<const Column*> angles;
  for (std::size_t m = 0; m < scene.robot.sections.size(); ++m)
    for (const std::string& name : angle_names(scene.robot.sections[m], m)) angles.push_back(column(name));
  if (errors.empty() && table.row_count() == 0)
    errors.push_back({"no_rows", file, "has no row: a plan has at least one step"});
  if (!errors.empty()) return tl::unexpected(errors);
  std::vector<InsertionStep> steps(table.row_count());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    steps[k].stage = stage->values[k];
    bool is_finite = std::isfinite(steps[k].stage);
    for (std::size_t m = 0; m < scene.robot.sections.size(); ++m) {
      const double first = angles[2 * m]->values[k], second = angles[2 * m + 1]->values[k];
      is_finite = is_finite && std::isfinite(first) && std::isfinite(second);
      steps[k].bends.push_back(bend_of(scene.robot.sections[m], first, second));
    }
    if (!is_finite) return failure("not_a_number", file, fmt::format("row {} lacks a number", k));
  }
  return steps;
}

}  // namespace sinew::inline v0
