/// plot: curves of a table of results, or the shape of a robot.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "figure_file.hpp"
#include "request.hpp"
#include "show.hpp"
#include "sinew/io/figure.hpp"
#include "sinew/io/table.hpp"
#include "sinew/math/so3.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

/// The two coordinates that a panel shows.
struct View {
  std::size_t x, y;
  std::string_view x_name, y_name;
};

/// The curve of a list of points in metres, in mm.
Series curve(const Node& points, const View& view, Mark mark, Colour colour, double width,
             std::string label = {}) {
  Series series{.label = std::move(label), .x = {}, .y = {}, .mark = mark, .colour = colour, .width = width};
  for (const Node& point : points.items) {
    series.x.push_back(1e3 * point.items.at(view.x).number);
    series.y.push_back(1e3 * point.items.at(view.y).number);
  }
  return series;
}

Panel empty_panel(const View& view) {
  return {.title = {},
          .x = {.label = std::string(view.x_name), .unit = "mm"},
          .y = {.label = std::string(view.y_name), .unit = "mm"},
          .series = {},
          .notes = {},
          .legend = Legend::below,
          .equal_aspect = true};
}

/// The label of the first of many alike.
std::string once(std::size_t i, const char* label) { return i == 0 ? std::string(label) : std::string(); }

/// As Fig. 10 of [TDPCR]: backbones, tendons, platform, joints, and the lines along which the closures pull.
Panel picture(const Answer& shape, const View& view, const Node& legs) {
  Panel panel = empty_panel(view);
  const auto add = [&](const Node& points, Mark mark, Colour colour, double width, std::string label = {}) {
    panel.series.push_back(curve(points, view, mark, colour, width, std::move(label)));
  };
  const Node& platform = *shape.find("platform");
  add(platform, platform.items.size() > 2 ? Mark::polygon : Mark::line, Colour::green, 1.5, "platform");
  const auto is = [&](std::size_t i, std::string_view link) {
    return at(legs.items[i], "link.type")->text == link;
  };
  const auto& lines = shape.find("lines")->items;
  std::size_t line = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!is(i, "rod"))  // its tip is on the platform
      add(lines[i], Mark::dashed, Colour::vermillion, 1.5, once(line++, "line of the leg"));
  const auto& tendons = shape.find("tendons")->items;
  for (std::size_t i = 0; i < tendons.size(); ++i)
    for (std::size_t k = 0; k < tendons[i].items.size(); ++k)
      if (!tendons[i].items[k].items.empty())  // rails and rods have none
        add(tendons[i].items[k], Mark::dashed, Colour::grey, 1, once(i + k, "tendon"));
  const auto& backbones = shape.find("backbones")->items;
  std::vector<std::string> named;
  for (std::size_t i = 0; i < backbones.size(); ++i) {
    std::string name = is(i, "rail") ? "rail" : is(i, "rod") ? "rod" : "backbone";
    if (std::ranges::find(named, name) != named.end())
      name.clear();  // in the legend once
    else
      named.push_back(name);
    add(backbones[i], Mark::line, Colour::blue, 3, name);
  }
  add(*shape.find("base"), Mark::circles, Colour::black, 1.5);
  add(platform, Mark::circles, Colour::black, 1.5);
  return panel;
}

/// Rim of a disc in the base frame, its proximal face and then its distal one.
Node rim(const Node& disc) {
  const auto p = numbers(at(disc, "pose.position")), q = numbers(at(disc, "pose.quaternion"));
  const SO3<double> turn{q.at(0), Vec3<double>(q.at(1), q.at(2), q.at(3))};
  Node points;
  points.kind = Node::Kind::list;
  constexpr int corners = 24;
  for (const double height : {0.0, number(disc, "height")})
    for (int k = 0; k <= corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners, radius = number(disc, "radius");
      const Vec3<double> corner =
          turn.rotate(Vec3<double>(radius * std::cos(angle), radius * std::sin(angle), height));
      Node point;
      point.kind = Node::Kind::list;
      for (std::size_t i = 0; i < 3; ++i)
        point.items.push_back(make_node(p.at(i) + corner[static_cast<Eigen::Index>(i)]));
      points.items.push_back(std::move(point));
    }
  return points;
}

/// A serial robot: backbone by sections, discs, tendons.
Panel serial_picture(const Answer& shape, const View& view) {
  Panel panel = empty_panel(view);
  const auto& discs = shape.find("discs")->items;
  for (std::size_t i = 0; i < discs.size(); ++i)
    panel.series.push_back(curve(rim(discs[i]), view, Mark::line, Colour::grey, 0.8, once(i, "disc")));
  const auto& sections = shape.find("tendons")->items;
  for (std::size_t m = 0; m < sections.size(); ++m)
    for (std::size_t i = 0; i < sections[m].items.size(); ++i)
      panel.series.push_back(
          curve(sections[m].items[i], view, Mark::line, Colour::vermillion, 0.6, once(m + i, "tendon")));
  const auto& backbones = shape.find("backbones")->items;
  for (std::size_t m = 0; m < backbones.size(); ++m)
    panel.series.push_back(curve(backbones[m], view, Mark::line, m % 2 == 0 ? Colour::blue : Colour::green,
                                 2.5, once(m, "backbone")));
  return panel;
}

/// A spatial robot from the front and from above; a serial one from the front and from the side.
Figure picture(const Answer& shape, const Robot& robot) {
  if (is_serial(robot)) {
    Figure figure;
    figure.title = shape.text("robot");
    figure.panels = {serial_picture(shape, {0, 2, "x", "z"}), serial_picture(shape, {1, 2, "y", "z"})};
    figure.columns = 2;
    figure.width = 1400;
    figure.height = 800;
    return figure;
  }
  const Node& legs = *robot.description.find("legs");
  Figure figure;
  figure.title = shape.text("robot");
  figure.width = figure.height = 700;
  if (robot.is_spatial) {
    figure.panels = {picture(shape, {0, 2, "x", "z"}, legs), picture(shape, {0, 1, "x", "y"}, legs)};
    figure.columns = 2;
    figure.width = 1400;
  } else {
    figure.panels = {picture(shape, {0, 1, "x", "y"}, legs)};
  }
  return figure;
}

/// The robot's shape at the asked configuration, default its home. Nothing where it has none; `exit` then
/// says why. An unstable one is drawn, and `exit` says that it is none that holds.
std::optional<Figure> robot_figure(const Arguments& arguments, int& exit) {
  auto robot = open(arguments);
  auto query = robot ? request("shape", arguments, *robot) : tl::unexpected(robot.error());
  if (!query) {
    exit = refuse("plot", query.error());
    return {};
  }
  if (!arguments.has("pose") && !arguments.has("independent") && !arguments.has("inputs") &&
      !arguments.has("configuration") && !arguments.has("changes")) {
    if (robot->is_on_rods && robot->inputs.size() != 3 && robot->inputs.size() != 6) {
      exit = refuse(
          "plot",
          {{"missing_option", "",
            fmt::format("--inputs is missing: which lengths have the {} rods?", robot->inputs.size())}});
      return {};
    }
    query->pop_back();  // its closing brace
    *query += fmt::format(", {}}}", at_home(*robot));
  }
  const Answer shape = ask(robot->session, *query);
  exit = exit_code(shape);
  if (const Errors errors = shape.errors(); !errors.empty())
    refuse("plot", errors);
  else if (!shape.converged())
    message(fmt::format("plot {}: {}: {}", shape.text("robot"), shape.text("status"), shape.text("message")));
  if (!shape.find("backbones")) return {};
  return picture(shape, *robot);
}

const Column* column(const Table& table, std::string_view name, std::string_view option, Errors& errors) {
  if (const Column* found = table.find(name)) return found;
  std::vector<std::string_view> names;
  for (const Column& known : table.columns) names.push_back(known.name);
  const std::string_view hint = closest(name, names);
  errors.push_back({"unknown_column", fmt::format("--{}", option),
                    fmt::format("no column {}{} Columns: {}.", in_quotes(name),
                                hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)),
                                fmt::join(names, ", "))});
  return nullptr;
}

std::vector<const Column*> columns_to_draw(const Table& table, const Column* x, const std::string* list,
                                           Errors& errors) {
  std::vector<const Column*> result;
  if (!list) {
    for (const Column& other : table.columns)
      if (&other != x) result.push_back(&other);
    return result;
  }
  for (std::string_view rest = *list;;) {
    const std::size_t comma = rest.find(',');
    const Column* found = column(table, rest.substr(0, comma), "y", errors);
    if (found) result.push_back(found);
    if (comma == std::string_view::npos) return result;
    rest.remove_prefix(comma + 1);
  }
}

Figure curves(const Arguments& arguments, const Column& x, const std::vector<const Column*>& ys) {
  const bool has_one_unit =
      std::ranges::all_of(ys, [&](const Column* y) { return y->unit == ys.front()->unit; });
  Panel panel{.title = {},
              .x = {.label = x.name, .unit = x.unit},
              .y = {.label = ys.size() == 1 ? ys[0]->name : "", .unit = has_one_unit ? ys[0]->unit : ""},
              .series = {}};
  panel.y.log = arguments.has("log-y");
  constexpr std::array colours{Colour::blue, Colour::vermillion, Colour::green, Colour::orange,
                               Colour::sky,  Colour::purple,     Colour::black, Colour::yellow};
  for (std::size_t i = 0; i < ys.size(); ++i)
    panel.series.push_back({.label = ys.size() == 1 ? ""
                                     : has_one_unit ? ys[i]->name
                                                    : ys[i]->heading(),
                            .x = x.values,
                            .y = ys[i]->values,
                            .colour = colours[i % colours.size()]});
  Figure figure;
  figure.panels = {std::move(panel)};
  return figure;
}

std::optional<Figure> table_figure(const Arguments& arguments, int& exit) {
  const auto table = read_csv(arguments.operand());
  if (!table) {
    exit = refuse("plot", table.error());
    return {};
  }
  Errors errors;
  const std::string* name = arguments.text("x");
  const Column* x = name ? column(*table, *name, "x", errors) : &table->columns.front();
  const auto ys = columns_to_draw(*table, x, arguments.text("y"), errors);
  if (errors.empty() && ys.empty())
    errors.push_back(
        {"too_few_columns", arguments.operand(), "a curve needs two columns, x and y; there is one."});
  if (errors.empty()) return curves(arguments, *x, ys);
  exit = refuse("plot", errors);
  return {};
}

}  // namespace

int run_plot(const Arguments& arguments) {
  if (arguments.operands.empty())
    return refuse("plot",
                  {{"missing_result", "RESULT|ROBOT", "what is to be drawn? Give a .csv file or a robot."}});
  const std::string* output = arguments.text("output");
  if (const Errors errors = refuse_format(*output); !errors.empty()) return refuse("plot", errors);
  int exit = solved;
  auto figure =
      arguments.operand().ends_with(".csv") ? table_figure(arguments, exit) : robot_figure(arguments, exit);
  if (!figure) return exit;
  if (const std::string* title = arguments.text("title")) figure->title = *title;
  const int written = write_figure_file(arguments, *figure, *output);
  return written == solved ? exit : written;
}

}  // namespace sinew::cli
