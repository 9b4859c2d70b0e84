/// branches: curves of equilibria as a table of what is special about them, a file of numbers, or a diagram.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "figure/quantity_name.hpp"
#include "figure_file.hpp"
#include "io/document/visible.hpp"
#include "io/figure/figure.hpp"
#include "question.hpp"
#include "sinew/io/table.hpp"
#include "terminal.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

constexpr std::array<std::string_view, 7> events{
    "", "begin", "target", "fold", "bifurcation", "rod_bifurcation", "stability"};

std::size_t event_of(const Node& row) {
  const Node* event = row.find("event");
  if (!event) return 0;
  return static_cast<std::size_t>(std::ranges::find(events, event->text) - events.begin());
}

bool is_stable(const Node& row) { return number(row, "unstable_directions") == 0; }

/// One row a special point, first and last points of curves.
std::string show_events(const Answer& answer, bool is_spatial) {
  const auto columns = pose_columns(is_spatial);
  std::vector<std::string> header{"curve", "parameter", "event"};
  for (const Input& column : columns) header.push_back(heading(column.name, column.unit));
  header.emplace_back("unstable_directions");
  TextTable table(std::move(header));
  const auto& curves = answer.find("curves")->items;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const auto& rows = curves[c].find("rows")->items;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const bool is_last = k + 1 == rows.size();
      if (event_of(rows[k]) == 0 && !is_last && !(k == 0 && c > 0)) continue;
      std::string what(events[event_of(rows[k])]);
      if (k == 0 && c > 0) what = "leaves curve 1";
      if (is_last && what.empty()) what = "end: " + curves[c].find("why")->text;
      std::vector<std::string> cells{fmt::format("{}", c + 1), six_digits(number(rows[k], "parameter")),
                                     what};
      const auto pose = pose_values(*rows[k].find("pose"));
      for (std::size_t j = 0; j < pose.size(); ++j) cells.push_back(cell(pose[j], columns[j].unit));
      cells.push_back(six_digits(number(rows[k], "unstable_directions")));
      table.add(std::move(cells));
    }
  }
  const auto& equilibria = answer.find("equilibria")->items;
  const auto stable = std::ranges::count_if(equilibria, is_stable);
  return table.text() +
         fmt::format("equilibria found at 1: {}, of them stable: {}\n", equilibria.size(), stable);
}

Table solutions_table(const Answer& answer, const OpenRobot& robot) {
  Table table;
  table.comments = {fmt::format("sinew {}: branches {}", version(), answer.text("robot")),
                    "event: 1 begin, 2 target, 3 fold, 4 bifurcation, 5 rod_bifurcation, 6 stability"};
  const auto column = [&](std::string name, std::string unit) {
    table.columns.push_back({std::move(name), std::move(unit), {}});
  };
  for (const char* name : {"curve", "parameter", "event", "unstable_directions"}) column(name, "");
  for (const Input& one : pose_columns(robot.is_spatial)) column(one.name, one.unit);
  for (const Input& one : robot.inputs) column(one.name, one.unit);
  column("potential", "J");
  column("residual", "");
  const auto& curves = answer.find("curves")->items;
  for (std::size_t c = 0; c < curves.size(); ++c)
    for (const Node& point : curves[c].find("rows")->items) {
      std::vector<double> row{static_cast<double>(c + 1), number(point, "parameter"),
                              static_cast<double>(event_of(point)), number(point, "unstable_directions")};
      for (const auto& more : {pose_values(*point.find("pose")), numbers(point.find("inputs"))})
        row.insert(row.end(), more.begin(), more.end());
      const Node* potential = point.find("potential");
      row.push_back(potential ? potential->number : std::numeric_limits<double>::quiet_NaN());
      row.push_back(number(point, "residual"));
      table.add_row(row);
    }
  return table;
}

/// One coordinate of the platform, or where its pose was led an input, over the parameter: stable stretches
/// drawn through, others dashed.
class Diagram {
 public:
  Diagram(const Answer& answer, std::vector<Input> columns, bool shows_inputs)
      : answer_(answer),
        columns_(std::move(columns)),
        shows_inputs_(shows_inputs) {}

  /// The two that go farthest; turns count as metres of a platform of 0.1 m.
  std::array<std::size_t, 2> farthest() const {
    const std::size_t count = columns_.size();
    std::vector<double> low(count, std::numeric_limits<double>::infinity()), high(count, -low[0]);
    for (const Node& curve : answer_.find("curves")->items)
      for (const Node& row : curve.find("rows")->items) {
        const auto values = values_of(row);
        for (std::size_t k = 0; k < count; ++k) {
          low[k] = std::min(low[k], values[k]);
          high[k] = std::max(high[k], values[k]);
        }
      }
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t k) {
      return (high[k] - low[k]) * (columns_[k].unit == "rad" ? 0.1 : 1);
    });
    return {std::min(order[0], order[1]), std::max(order[0], order[1])};
  }

  Panel panel(std::size_t coordinate) const {
    const Input& column = columns_[coordinate];
    const Shown unit = shown(column.unit);
    Panel panel{.title = {},
                .x = {.label = "Parameter", .unit = {}},
                .y = {.label = quantity_name(column.name, true), .unit = std::string(unit.unit)},
                .series = {},
                .notes = {},
                .legend = Legend::below};
    for (const Node& curve : answer_.find("curves")->items) add_curve(panel, curve, coordinate, unit.factor);
    add_events(panel, coordinate, unit.factor, 3, Mark::circles, Colour::black, "fold");
    add_events(panel, coordinate, unit.factor, 4, Mark::points, Colour::orange, "bifurcation");
    add_events(panel, coordinate, unit.factor, 5, Mark::points, Colour::purple, "rod bifurcation");
    add_events(panel, coordinate, unit.factor, 2, Mark::points, Colour::green, "target");
    label_once(panel);
    return panel;
  }

 private:
  std::vector<double> values_of(const Node& row) const {
    return shows_inputs_ ? numbers(row.find("inputs")) : pose_values(*row.find("pose"));
  }

  void add_curve(Panel& panel, const Node& curve, std::size_t coordinate, double factor) const {
    const auto& rows = curve.find("rows")->items;
    const auto add = [&](std::size_t k) {
      panel.series.back().x.push_back(number(rows[k], "parameter"));
      panel.series.back().y.push_back(values_of(rows[k])[coordinate] * factor);
    };
    for (std::size_t k = 1; k < rows.size(); ++k) {  // a special point is told as what leads to it
      const bool stable = is_stable(rows[k]);
      if (k == 1 || stable != is_stable(rows[k - 1])) {
        panel.series.push_back({.label = stable ? "stable" : "unstable",
                                .x = {},
                                .y = {},
                                .mark = stable ? Mark::line : Mark::dashed,
                                .colour = stable ? Colour::blue : Colour::vermillion,
                                .width = stable ? 2.5 : 1.2});
        add(k - 1);
      }
      add(k);
    }
  }

  void add_events(Panel& panel, std::size_t coordinate, double factor, std::size_t event, Mark mark,
                  Colour colour, std::string label) const {
    Series series{.label = std::move(label), .x = {}, .y = {}, .mark = mark, .colour = colour, .width = 3};
    for (const Node& curve : answer_.find("curves")->items)
      for (const Node& row : curve.find("rows")->items)
        if (event_of(row) == event) {
          series.x.push_back(number(row, "parameter"));
          series.y.push_back(values_of(row)[coordinate] * factor);
        }
    if (!series.x.empty()) panel.series.push_back(std::move(series));
  }

  static void label_once(Panel& panel) {
    std::vector<Text> known;
    for (Series& series : panel.series) {
      if (std::ranges::find(known, series.label) != known.end())
        series.label.clear();
      else
        known.push_back(series.label);
    }
  }

  const Answer& answer_;
  std::vector<Input> columns_;
  bool shows_inputs_;
};

Figure picture(const Answer& answer, const OpenRobot& robot, bool is_led_by_pose) {
  const Diagram diagram(answer, is_led_by_pose ? robot.inputs : pose_columns(robot.is_spatial),
                        is_led_by_pose);
  const auto [first, second] = diagram.farthest();
  Figure figure;
  figure.title = "Equilibria of " + answer.text("robot");
  figure.panels = {diagram.panel(first), diagram.panel(second)};
  figure.columns = 2;
  figure.width = 1400;
  figure.height = 700;
  return figure;
}

}  // namespace

int run_branches(const Arguments& arguments) {
  auto robot = open_with_platform(arguments);
  if (!robot) return refuse_question(arguments, robot.error());
  const std::string* model = arguments.text("model");
  if (!robot->is_on_rods && !(model && *model == "prb"))
    return refuse_question(arguments,
                           {{"not_available", "",
                             fmt::format("{} has no legs that bear load: it has no equilibria to follow; of "
                                         "tendon-driven links give --model prb",
                                         robot->description.text("robot"))}});
  const std::string* file = arguments.text("output");
  const bool is_table = file && file->ends_with(".csv");
  if (file && !is_table)
    if (const Errors errors = refuse_figure(arguments, *file); !errors.empty())
      return refuse_question(arguments, errors);
  const auto answer = put("track", arguments, *robot);
  if (!answer) return refuse_question(arguments, answer.error());
  const bool has_curves =
      answer->find("curves") && answer->find("equilibria");  // not where it was stopped before
  std::string shown = has_curves ? show_events(*answer, robot->is_spatial) : "";
  if (has_curves && is_table) {
    const auto written = write_csv(solutions_table(*answer, *robot), *file);
    if (!written) return refuse_question(arguments, written.error());
    shown += arguments.has("quiet") ? "" : visible_line(*file) + '\n';
  } else if (has_curves && file) {
    if (const int exit = write_figure_file(arguments, picture(*answer, *robot, arguments.has("to")), *file);
        exit != solved)
      return exit;
  }
  return conclude(*answer, arguments, shown);
}

}  // namespace sinew::cli
