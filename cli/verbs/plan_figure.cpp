/// Pictures of a way in: of plot, and of reproduce LSK Fig. 12.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "figure_file.hpp"
#include "plan/compressor.hpp"
#include "plan/insertion_figure.hpp"
#include "plan/plan_table.hpp"
#include "request.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/serial.hpp"
#include "sinew/plan/insertion.hpp"
#include "sinew/study/study.hpp"
#include "study_items.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

constexpr double degree = 180 / std::numbers::pi;
constexpr std::uint64_t item_seed = 1;

std::string in_mm(double metres, int places) { return fmt::format("{:.{}f} mm", 1e3 * metres, places); }

/// Largest bend of a joint [rad], and most that a tendon is paid out or pulled in [m].
std::array<double, 2> used(const InsertionScene& scene, const std::vector<InsertionStep>& steps) {
  SerialWorkspace work(scene.robot);
  double bend = 0, change = 0;
  for (const InsertionStep& step : steps) {
    for (const Bend& one : step.bends) bend = std::max({bend, std::abs(one[0]), std::abs(one[1])});
    tendon_changes(step.bends, kernel::Model::exact, work);
    for (const double one : work.changes) change = std::max(change, std::abs(one));
  }
  return {bend, change};
}

/// The paper prints no number of its way, nor the engine's geometry: what can be compared is what it says of
/// it.
std::vector<Finding> findings(const InsertionScene& scene, const InsertionPlan& plan) {
  const auto holds = [](bool is_so) { return std::string(is_so ? "holds" : "fails"); };
  const auto [bend, change] = used(scene, plan.steps);
  const Section& section = scene.robot.sections.front();
  const int poses = static_cast<int>(std::ceil(1e3 * plan.steps.back().stage - 1e-9)) + 1;
  return {
      {"diameter of the robot", "6 mm", in_mm(2 * section.outer_radius(), 0), "",
       std::abs(section.outer_radius() - 3e-3) < 1e-9 ? "agrees" : "differs"},
      {"its length", "175 mm", in_mm(scene.robot.length(), 0), "",
       std::abs(scene.robot.length() - 0.175) < 1e-9 ? "agrees" : "differs"},
      {"there is a way through the port and between the blades", "found by hand, two rows of stators",
       "found, two rows of stators and one of rotors", "", holds(plan.report.ok())},
      {"poses of the extraction", "1 mm each step", fmt::format("{} poses", poses), "", "for information"},
      {"nothing is touched, nor between the poses", "collisions looked for by eye",
       fmt::format("{}, {} poses by FCL", to_string(plan.check.verdict), plan.check.poses), "",
       holds(plan.check.verdict != InsertionVerdict::touches)},
      {"least clearance", "not printed", in_mm(plan.check.clearance, 3), "", "for information"},
      {"insertion", "not printed", in_mm(plan.steps.back().stage, 1), "", "for information"},
      {"bends are within the limit of a joint", "24°", fmt::format("{:.2f}°", degree * bend), "",
       holds(bend <= section.limit * (1 + 1e-12))},
      {"most that a tendon moves", "not printed", in_mm(change, 2), "", "for information"},
      {"how far the tip may be off", "3 mm, measured",
       fmt::format("{}, worst case of tendons known to {}", in_mm(plan.check.off.sum(), 1),
                   in_mm(scene.robot.tolerance, 3)),
       "", "for information"},
  };
}

}  // namespace

/// @implements LSK section 7.2, Fig. 12 (b), in a stand-in for the engine
Expected<ItemResult> insertion_result() {
  const Compressor compressor;
  const auto robot = load_serial(compressor.robot);
  if (!robot) return tl::unexpected(robot.error());
  const InsertionScene scene = compressor_scene(compressor, *robot);
  InsertionOptions options;
  options.seed = item_seed;
  options.stop = stop_token();
  const InsertionPlan plan = plan_insertion(scene, options);
  if (!plan.report.ok()) return failure("no_way", "lsk/fig12", std::string(plan.report.message.view()));
  return ItemResult{findings(scene, plan),
                    {},
                    {{"fig12", plan_table(scene, plan, item_seed)}},
                    {{"fig12", insertion_phases(scene, plan.steps, plan.check, 4)},
                     {"fig12_curves", insertion_curves(scene, plan.steps, plan.check)}}};
}

int plot_insertion(const Arguments& arguments) {
  constexpr std::array drawn{"output", "along", "as", "title", "width", "font", "force", "quiet"};
  const std::string *kind = arguments.text("as"), *title = arguments.text("title");
  Errors errors;
  for (const auto& [option, texts] : arguments.options)
    if (std::ranges::find(drawn, option) == drawn.end())
      errors.push_back({"no_effect", "--" + option, "without effect on a plan; leave it out."});
  if (kind && *kind != "phases" && *kind != "line")
    errors.push_back({"unknown_kind", "--as",
                      fmt::format("{} is no figure of a plan: phases (default) or line", in_quotes(*kind))});
  if (!errors.empty()) return refuse("plot", errors);
  const std::string& file = *arguments.text("along");
  const auto scene = load_scene(arguments.operand());
  if (!scene) return refuse("plot", scene.error());
  const auto steps =
      read_result(file).and_then([&](const Table& table) { return plan_steps(table, *scene, file); });
  if (!steps) return refuse("plot", steps.error());
  finish_what_is_begun();
  InsertionCheckOptions options;
  options.stop = stop_token();
  const InsertionCheck check = check_insertion(*scene, *steps, options);
  if (check.is_stopped) return stopped;
  Figure figure = kind && *kind == "line" ? insertion_curves(*scene, *steps, check)
                                          : insertion_phases(*scene, *steps, check, 4);
  if (title) figure.title = *title;
  return write_figure_file(arguments, figure, *arguments.text("output"));
}

}  // namespace sinew::cli
