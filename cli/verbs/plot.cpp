/// plot: a table of results as lines, points, a map or contours; a robot from its sides, in space, or what
/// the tendons of one of its sections leave it free to do.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "figure/diagram_figure.hpp"
#include "figure/robot_figure.hpp"
#include "figure/table_figure.hpp"
#include "figure/table_grid.hpp"
#include "figure/table_status.hpp"
#include "figure_file.hpp"
#include "io/document/quantity.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "question.hpp"
#include "request.hpp"
#include "show.hpp"
#include "sinew/io/table.hpp"
#include "sinew/study/study.hpp"
#include "study_items.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

/// One kind of figure, and the options that shape it beside those of all.
struct Kind {
  std::string_view name;
  bool is_of_table;
  std::vector<std::string_view> options;
};

const std::vector<Kind>& kinds() {
  static const std::vector<std::string_view> place{
      "pose",          "independent", "bending",  "elbow",     "curvature",   "inputs",
      "configuration", "changes",     "start",    "wrench",    "gravity",     "theta-is",
      "model",         "set",         "tensions", "following", "distributed", "distributed-following",
      "loads"};
  static const std::vector<Kind> all = [] {
    std::vector<std::string_view> seen = place;
    seen.push_back("view");
    return std::vector<Kind>{
        {"line", true, {"x", "y", "log-y", "at", "all-statuses"}},
        {"points", true, {"x", "y", "log-y", "at", "colour", "log-value", "all-statuses"}},
        {"map", true, {"x", "y", "at", "value", "log-value", "all-statuses"}},
        {"contour", true, {"x", "y", "at", "value", "log-value", "all-statuses"}},
        {"sides", false, place},
        {"3d", false, seen},
        {"diagram",
         false,
         {"section", "changes", "measured", "model", "tolerance", "envelope", "limit", "set"}}};
  }();
  return all;
}

std::string names_of_kinds(bool is_of_table) {
  std::vector<std::string_view> names;
  for (const Kind& kind : kinds())
    if (kind.is_of_table == is_of_table) names.push_back(kind.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// What is wrong with `--as`.
Errors refuse_kind(std::string_view name, bool is_of_table) {
  const auto found = std::ranges::find(kinds(), name, &Kind::name);
  if (found != kinds().end() && found->is_of_table == is_of_table) return {};
  std::vector<std::string_view> names;
  for (const Kind& kind : kinds()) names.push_back(kind.name);
  const std::string_view hint = found == kinds().end() ? closest(name, names) : std::string_view();
  return {{"unknown_kind", "--as",
           fmt::format("{} is no figure of a {}{} A table is drawn as {}; a robot as {}.", in_quotes(name),
                       is_of_table ? "table" : "robot",
                       hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)),
                       names_of_kinds(true), names_of_kinds(false))}};
}

/// Options that shape other kinds of figures only.
Errors refuse_idle(const Arguments& arguments, std::string_view name) {
  constexpr std::array always{"output", "as", "title", "width", "font", "force", "quiet", "help"};
  const Kind& kind = *std::ranges::find(kinds(), name, &Kind::name);
  Errors errors;
  for (const auto& [option, texts] : arguments.options) {
    if (std::ranges::find(always, option) != always.end() ||
        std::ranges::find(kind.options, option) != kind.options.end())
      continue;
    std::vector<std::string> others;
    for (const Kind& other : kinds())
      if (std::ranges::find(other.options, option) != other.options.end())
        others.push_back(fmt::format("--as {}", other.name));
    errors.push_back({"no_effect", fmt::format("--{}", option),
                      fmt::format("without effect on --as {}; it is of {}. Leave it out, or draw that.", name,
                                  fmt::join(others, ", "))});
  }
  return errors;
}

/// The answer that a figure is drawn from. Nothing where there is none; `exit` then says why. One that does
/// not hold is drawn, and `exit` says so.
std::optional<Answer> asked(OpenRobot& robot, const Document& query, std::string_view needs, int& exit) {
  Answer answer = ask(robot, query);
  exit = exit_code(answer);
  if (const Errors errors = answer.errors(); !errors.empty())
    refuse("plot", errors);
  else if (const std::string said = in_options(answer.text("message")); !answer.converged() || !said.empty())
    message(fmt::format("plot {}: {}: {}", answer.text("robot"), answer.text("status"), said));
  if (!answer.find(needs)) return {};
  return answer;
}

/// Angles of `--view`.
Expected<Eye> eye_of(const Arguments& arguments) {
  const std::string* text = arguments.text("view");
  if (!text) return Eye{};
  const std::size_t comma = text->find(',');
  if (comma == std::string::npos || text->find(',', comma + 1) != std::string::npos)
    return failure("wrong_length", "--view",
                   fmt::format("{}; it has two angles, from straight above and about z: --view \"60 deg, 30 "
                               "deg\".",
                               in_quotes(*text)));
  Eye eye;
  for (const auto& [angle, part] :
       {std::pair{&eye.tilt, text->substr(0, comma)}, std::pair{&eye.turn, text->substr(comma + 1)}}) {
    const auto value = parse_quantity(part, Dimension::angle);
    if (!value) return failure(value.error().front().code, "--view", value.error().front().message);
    *angle = *value * 180 / std::numbers::pi;
  }
  if (eye.tilt < 0 || eye.tilt > 180)
    return failure(
        "out_of_range", "--view",
        fmt::format("the first angle goes from 0, above, over 90 deg, the side, to 180 deg, below; "
                    "it is {:.6g} deg.",
                    eye.tilt));
  eye.turn = std::fmod(std::fmod(eye.turn, 360) + 360, 360);
  return eye;
}

/// The robot's shape at the asked configuration, default its home.
Expected<Document> shape_query(const Arguments& arguments, const OpenRobot& robot) {
  auto query = request("shape", arguments, robot);
  constexpr std::array places{"pose", "independent", "inputs", "configuration", "changes", "tensions"};
  if (!query || std::ranges::any_of(places, [&](auto place) { return arguments.has(place); })) return query;
  if (robot.is_on_rods && robot.inputs.size() != 3 && robot.inputs.size() != 6)
    return failure("missing_option", "",
                   fmt::format("--inputs is missing: which lengths have the {} rods?", robot.inputs.size()));
  query->root.members.push_back(at_home(robot));
  return query;
}

std::optional<Figure> picture(const Arguments& arguments, std::string_view kind, int& exit) {
  const auto fail = [&](const Errors& errors) {
    exit = refuse("plot", errors);
    return std::optional<Figure>();
  };
  auto robot = open(arguments);
  if (!robot) return fail(robot.error());
  if (kind == "diagram") {
    const auto query = request("diagram", arguments, *robot);
    if (!query) return fail(query.error());
    const auto answer = asked(*robot, *query, "class", exit);
    if (!answer) return {};
    return diagram_figure(*answer, *robot, section_of(arguments));
  }
  if (kind == "3d" && !robot->is_spatial && !is_serial(*robot) && !is_arm(*robot))
    return fail({{"not_available", "--as",
                  fmt::format("{} moves in a plane, and is drawn in it: leave out --as 3d.",
                              robot->description.text("robot"))}});
  const auto eye = eye_of(arguments);
  if (!eye) return fail(eye.error());
  const auto query = shape_query(arguments, *robot);
  if (!query) return fail(query.error());
  const auto answer = asked(*robot, *query, "backbones", exit);
  if (!answer) return {};
  return robot_figure(*answer, *robot, kind == "3d" ? std::optional<Eye>(*eye) : std::nullopt);
}

Expected<Figure> result(const Arguments& arguments, const std::string* kind) {
  auto table = read_result(arguments.operand());
  if (!table) return tl::unexpected(table.error());
  const bool has_title = arguments.operand().ends_with(".h5") && !table->comments.empty() &&
                         !table->comments.front().starts_with("status:");
  const std::string title = has_title ? table->comments.front() : std::string();
  auto part = cut(std::move(*table), arguments);
  if (!part) return tl::unexpected(part.error());
  const std::string_view name = kind ? std::string_view(*kind) : table_kind(part->table, arguments);
  if (Errors errors = refuse_idle(arguments, name); !errors.empty()) return tl::unexpected(std::move(errors));
  const auto names_status = [&](std::string_view option) {
    const std::string* text = arguments.text(option);
    return text && (',' + *text + ',').find(",status,") != std::string::npos;
  };
  const bool is_of_statuses = names_status("value") || names_status("colour") || names_status("y");
  const bool draws_all = arguments.has("all-statuses") || is_of_statuses;
  const Statuses statuses(part->table);
  if (statuses.has_others() && !draws_all) statuses.leave_out(part->table, arguments.text("x"));
  if (is_of_statuses || names_status("x"))
    statuses.number(part->table);
  else if (!statuses.words().empty())  // no quantity that anybody did not ask for
    std::erase_if(part->table.columns, [](const Column& column) { return column.name == "status"; });
  const auto paper = page_options(arguments);
  if (!paper) return tl::unexpected(paper.error());
  auto figure = table_figure(part->table, name, arguments, *paper, statuses.words());
  if (!figure) return figure;
  figure->title = Text(title) + (title.empty() || part->place.empty() ? "" : ", ") + part->place;
  figure->remark = statuses.remark(draws_all);
  return figure;
}

}  // namespace

int run_plot(const Arguments& arguments) {
  if (arguments.operands.empty())
    return refuse("plot", {{"missing_result", "RESULT|ROBOT|SCENE",
                            "what is to be drawn? Give an .h5 or .csv file, or a robot."}});
  const std::string *output = arguments.text("output"), *kind = arguments.text("as");
  if (const Errors errors = refuse_figure(arguments, *output); !errors.empty()) return refuse("plot", errors);
  if (arguments.has("along")) return plot_insertion(arguments);
  const bool is_table = arguments.operand().ends_with(".csv") || arguments.operand().ends_with(".h5");
  if (kind)
    if (const Errors errors = refuse_kind(*kind, is_table); !errors.empty()) return refuse("plot", errors);
  int exit = solved;
  std::optional<Figure> figure;
  if (is_table) {
    auto drawn = result(arguments, kind);
    if (!drawn) return refuse("plot", drawn.error());
    figure = std::move(*drawn);
  } else {
    const std::string name = kind                       ? *kind
                             : arguments.has("section") ? "diagram"
                             : arguments.has("view")    ? "3d"
                                                        : "sides";
    if (const Errors errors = refuse_idle(arguments, name); !errors.empty()) return refuse("plot", errors);
    figure = picture(arguments, name, exit);
  }
  if (!figure) return exit;
  if (const std::string* title = arguments.text("title")) figure->title = *title;
  const int written = write_figure_file(arguments, *figure, *output);
  return written == solved ? exit : written;
}

}  // namespace sinew::cli
