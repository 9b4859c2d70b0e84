#include "plan/plan_table.hpp"

#include <fmt/format.h>

#include "io/table/posture_table.hpp"

namespace sinew::inline v1 {

std::vector<std::array<double, 2>> plan_angles(const InsertionScene& scene, const InsertionStep& step) {
  std::vector<std::array<double, 2>> angles;
  for (std::size_t m = 0; m < step.bends.size(); ++m)
    angles.push_back(bend_angles(scene.robot.sections[m], step.bends[m]));
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
    for (const std::string& name : bend_names(scene.robot.sections[m], m))
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
  const auto postures = read_postures(table, scene.robot, file);
  if (!postures) return tl::unexpected(postures.error());
  std::vector<InsertionStep> steps;
  for (const SerialPosture& posture : *postures) steps.push_back({posture, 0, -1, {0, 0, 0}});
  return steps;
}

}  // namespace sinew::inline v1
