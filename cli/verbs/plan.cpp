/// plan: a way in through clutter. scene: a stand-in for a compressor.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "answer.hpp"
#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"
#include "plan/compressor.hpp"
#include "plan/plan_table.hpp"
#include "request.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/plan/insertion.hpp"
#include "sinew/study/study.hpp"
#include "terminal.hpp"
#include "text_table.hpp"
#include "waiting.hpp"

namespace sinew::cli {
namespace {

namespace fs = std::filesystem;

std::string mm(double metres) { return fmt::format("{:.3f} mm", 1e3 * metres); }

std::string vector_json(const Vec3<double>& v) {
  return fmt::format("[{},{},{}]", si_text(v[0]), si_text(v[1]), si_text(v[2]));
}

std::string solid_name(const InsertionScene& scene, int solid) {
  return solid < 0 ? "nothing" : scene.solids[static_cast<std::size_t>(solid)].name;
}

/// What may move the robot, and what would make it clear all the same.
std::string taut_text(const InsertionScene& scene, const InsertionCheck& check) {
  std::string text = fmt::format("the tip may be off by up to {}: {} by slack or stretched tendons",
                                 mm(check.off.sum()), mm(check.off.tendons));
  if (scene.weight) text += fmt::format(", {} by weight", mm(check.off.sag));
  if (scene.model_error > 0) text += fmt::format(", {} by the model", mm(check.off.model));
  text +=
      fmt::format("\nit would be clear with {:.1f} % of that: tendons calibrated to {:.4f} mm instead of {}",
                  100 * check.allowed_share, 1e3 * check.allowed_share * scene.robot.tolerance,
                  mm(scene.robot.tolerance));
  if (scene.tension > 0)
    text += fmt::format(", tension up to {} instead of {}",
                        human(check.allowed_share * scene.tension, Dimension::force),
                        human(scene.tension, Dimension::force));
  if (scene.weight)
    text += fmt::format(", {} of weight instead of {}",
                        human(check.allowed_share * scene.weight->by_length, Dimension::line_load),
                        human(scene.weight->by_length, Dimension::line_load));
  if (scene.model_error > 0)
    text += fmt::format(", the model off by {} instead of {}", mm(check.allowed_share * scene.model_error),
                        mm(scene.model_error));
  return text + '\n';
}

/// What a check found, in words.
std::string verdict_text(const InsertionScene& scene, const InsertionCheck& check) {
  const CheckedStep& worst = check.steps[check.worst];
  std::string text = fmt::format(
      "{}: {} at stage {}, section {}, to {}\n",
      styled(to_string(check.verdict), check.verdict == InsertionVerdict::clear     ? Style::good
                                       : check.verdict == InsertionVerdict::touches ? Style::bad
                                                                                    : Style::doubtful),
      mm(check.clearance), mm(worst.stage), worst.spot.section, solid_name(scene, worst.spot.solid));
  if (check.verdict == InsertionVerdict::clear_if_taut) text += taut_text(scene, check);
  return text;
}

std::string json_check(const InsertionScene& scene, const InsertionCheck& check) {
  const CheckedStep& worst = check.steps[check.worst];
  return fmt::format(
      "\"verdict\":{},\"clearance\":{},\"stage\":{},\"section\":{},\"solid\":{},\"allowed_share\":{},"
      "\"off\":{{\"tendons\":{},\"sag\":{},\"model\":{}}},\"poses\":{}",
      json_text(std::string(to_string(check.verdict))), si_text(check.clearance), si_text(worst.stage),
      worst.spot.section, worst.spot.solid < 0 ? "null" : json_text(solid_name(scene, worst.spot.solid)),
      si_text(check.allowed_share), si_text(check.off.tendons), si_text(check.off.sag),
      si_text(check.off.model), check.poses);
}

int check_plan(const Arguments& arguments, const InsertionScene& scene, unsigned threads) {
  const std::string& file = *arguments.text("check");
  const auto table = read_result(file);
  if (!table) return refuse("plan", table.error());
  const auto steps = plan_steps(*table, scene, file);
  if (!steps) return refuse("plan", steps.error());
  for (std::size_t k = 0; k < steps->size(); ++k) {
    const std::string exceeded = exceeded_limit(scene, (*steps)[k]);
    if (exceeded.empty()) continue;
    message(fmt::format("sinew plan: {}: LIMIT EXCEEDED in row {}: {}", file, k, exceeded));
    return no_solution;
  }
  InsertionCheckOptions options;
  options.threads = threads;
  options.stop = stop_token();
  const InsertionCheck check = check_insertion(scene, *steps, options);
  if (check.is_stopped) return stopped;
  print(arguments.has("json") ? fmt::format("{{\"steps\":{},{}}}\n", steps->size(), json_check(scene, check))
                              : verdict_text(scene, check));
  return check.verdict == InsertionVerdict::touches ? no_solution : solved;
}

/// All dimensions of a compressor by their names.
void visit_dimensions(Compressor& c,
                      const std::function<void(const std::string&, double&, Dimension)>& visit) {
  visit("case_radius", c.case_radius, Dimension::length);
  visit("hub_radius", c.hub_radius, Dimension::length);
  visit("case_thickness", c.case_thickness, Dimension::length);
  visit("hub_thickness", c.hub_thickness, Dimension::length);
  visit("port_diameter", c.port_diameter, Dimension::length);
  visit("sector", c.sector, Dimension::length);
  visit("upstream", c.upstream, Dimension::length);
  visit("downstream", c.downstream, Dimension::length);
  visit("stage_limit", c.stage_limit, Dimension::length);
  visit("target.x", c.target[0], Dimension::length);
  visit("target.y", c.target[1], Dimension::length);
  visit("target.z", c.target[2], Dimension::length);
  for (BladeRow& row : c.rows) {
    visit(row.name + ".start", row.start, Dimension::length);
    visit(row.name + ".chord", row.chord, Dimension::length);
    visit(row.name + ".angle_in", row.angle_in, Dimension::angle);
    visit(row.name + ".angle_out", row.angle_out, Dimension::angle);
    visit(row.name + ".thickness", row.thickness, Dimension::length);
    visit(row.name + ".offset", row.offset, Dimension::length);
    visit(row.name + ".removed", row.removed, Dimension::length);
    double count = row.count;
    visit(row.name + ".count", count, Dimension::count);
    row.count = static_cast<int>(count);
  }
}

void set_dimension(Compressor& compressor, const std::string& change, Errors& errors) {
  const std::size_t equals = change.find('=');
  const std::string name = change.substr(0, equals);
  std::vector<std::string> names;
  bool is_known = false;
  visit_dimensions(compressor, [&](const std::string& its, double& value, Dimension dimension) {
    names.push_back(its);
    if (its != name || equals == std::string::npos) return;
    is_known = true;
    const auto read = parse_quantity(std::string_view(change).substr(equals + 1), dimension);
    if (read && std::abs(*read) < 1e4)
      value = *read;
    else
      errors.push_back(read
                           ? Error{"out_of_range", "--set " + name, "is larger than any compressor"}
                           : Error{read.error().front().code, "--set " + name, read.error().front().message});
  });
  if (is_known) return;
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string_view hint = closest(name, views);
  errors.push_back({"unknown_choice", "--set",
                    fmt::format("{} is no NAME=VALUE of a dimension{} --list names them", in_quotes(change),
                                hint.empty() ? ";" : fmt::format("; did you mean {}?", hint))});
}

}  // namespace

int check_scene(const Arguments& arguments) {
  const auto scene = load_scene(arguments.operand());
  if (!scene) {
    if (arguments.has("json")) print(json_error(scene.error()) + '\n');
    return refuse(arguments.verb, scene.error());
  }
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene->solids) triangles += mesh.triangles.size();
  if (arguments.has("json"))
    print(fmt::format("{{\"scene\":{},\"robot\":{},\"solids\":{},\"triangles\":{}}}\n",
                      json_text(scene->name), json_text(scene->robot_name), scene->solids.size(), triangles));
  else
    print(
        fmt::format("scene    {}\nrobot    {}, {} long, moved by up to {}\nsolids   {}, of {} "
                    "triangles\ntarget   ({}, {}, {})\n",
                    arguments.operand(), scene->robot_name, mm(scene->robot.length()), mm(scene->stage_limit),
                    scene->solids.size(), triangles, mm(scene->target.tip[0]), mm(scene->target.tip[1]),
                    mm(scene->target.tip[2])));
  return solved;
}

int run_scene(const Arguments& arguments) {
  if (arguments.operand() != "compressor")
    return refuse("scene", {{"unknown_choice", in_quotes(arguments.operand()),
                             fmt::format("there is one scene: {}", find_verb("scene")->example)}});
  Errors errors;
  const int seed = whole_option(arguments, "seed", 0, 1'000'000'000, -1, errors);
  Compressor compressor = seed < 0 ? Compressor{} : drawn_compressor(static_cast<std::uint64_t>(seed));
  if (const auto set = arguments.options.find("set"); set != arguments.options.end())
    for (const std::string& change : set->second) set_dimension(compressor, change, errors);
  if (errors.empty()) errors = compressor_errors(compressor);
  if (!errors.empty()) return refuse("scene", errors);
  if (arguments.has("list")) {
    TextTable table({"dimension", "value"});
    visit_dimensions(compressor, [&](const std::string& name, double& value, Dimension dimension) {
      table.add({name, human(value, dimension)});
    });
    print(table.text());
    return solved;
  }
  const fs::path folder =
      arguments.has("output") ? fs::path(*arguments.text("output")) : fs::path("compressor");
  const auto robot = load_serial(compressor.robot);
  if (!robot) return refuse("scene", robot.error());
  const std::vector<Mesh> meshes = compressor_meshes(compressor);
  std::size_t triangles = 0;
  for (const Mesh& mesh : meshes) {
    triangles += mesh.triangles.size();
    if (const auto written = write_stl(mesh, folder / (mesh.name + ".stl")); !written)
      return refuse("scene", written.error());
  }
  const fs::path file = folder / "scene.yaml";
  if (const auto written = write_text(compressor_scene_text(compressor, *robot), file); !written)
    return refuse("scene", written.error());
  if (!arguments.has("quiet"))
    print(fmt::format("{}: {} solids, {} triangles\n", file.string(), meshes.size(), triangles));
  return solved;
}

int run_plan(const Arguments& arguments) {
  if (arguments.operands.empty())
    return refuse("plan",
                  {{"missing_scene", "", fmt::format("which scene? {}", find_verb("plan")->example)}});
  Errors errors;
  InsertionOptions options;
  options.seed = static_cast<std::uint64_t>(whole_option(arguments, "seed", 0, 1'000'000'000, 1, errors));
  options.threads = static_cast<unsigned>(whole_option(arguments, "threads", 1, 1024, 0, errors));
  if (const std::string* limit = arguments.text("time-limit")) {
    const auto read = parse_quantity(*limit, Dimension::time);
    if (read && *read > 0)
      options.time_limit = *read;
    else
      errors.push_back({"out_of_range", "--time-limit",
                        fmt::format("{} is no time > 0, such as \"30 s\"", in_quotes(*limit))});
  }
  if (!errors.empty()) return refuse("plan", errors);
  const auto scene = load_scene(arguments.operand());
  if (!scene) return refuse("plan", scene.error());
  finish_what_is_begun();
  if (arguments.has("check")) return check_plan(arguments, *scene, options.threads);
  options.stop = stop_token();
  const bool is_json = arguments.has("json");
  InsertionPlan plan;
  {
    Waiting waiting(arguments.has("quiet"));
    options.progress = [&waiting](const InsertionProgress& progress) {
      waiting.say(fmt::format("{} {:.0f} %", progress.phase, 100 * progress.share));
    };
    plan = plan_insertion(*scene, options);
  }
  if (!plan.report.ok()) {
    if (is_json)
      print(fmt::format(
          "{{\"status\":{},\"message\":{},\"blocked\":{{\"solid\":{},\"place\":{},\"stage\":{},\"missing\":{}"
          "}}}}\n",
          json_text(std::string(to_string(plan.report.status))),
          json_text(std::string(plan.report.message.view())),
          plan.blocked.solid.empty() ? "null" : json_text(plan.blocked.solid),
          vector_json(plan.blocked.place), si_text(plan.blocked.stage), si_text(plan.blocked.missing)));
    message(fmt::format("sinew plan: {}", plan.report.message.view()));
    return plan.report.status == Status::stopped ? stopped : no_solution;
  }
  const fs::path file = arguments.has("output") ? fs::path(*arguments.text("output"))
                                                : fs::path(arguments.operand()).stem().concat(".plan.h5");
  if (const auto written = write_result(plan_table(*scene, plan, options.seed), file); !written)
    return refuse("plan", written.error());
  if (is_json)
    print(fmt::format(
        "{{\"status\":\"converged\",\"output\":{},\"steps\":{},\"tip_error\":{},\"seconds\":{},{}}}\n",
        json_text(file.string()), plan.steps.size(), si_text(plan.tip_error), si_text(plan.seconds),
        json_check(*scene, plan.check)));
  else if (!arguments.has("quiet"))
    print(verdict_text(*scene, plan.check) +
          fmt::format(
              "{}: {} steps over {}, tip {} from the target; {} final poses and {} ways tried, {:.2f} s\n",
              file.string(), plan.steps.size(), mm(plan.steps.back().stage), mm(plan.tip_error), plan.starts,
              plan.ways, plan.seconds));
  return solved;
}

}  // namespace sinew::cli
