#include "figure/table_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "figure/quantity_name.hpp"
#include "figure/table_grid.hpp"
#include "io/figure/contour.hpp"
#include "sinew/io/node.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

constexpr std::size_t max_curves = 100;
constexpr std::size_t max_vector_points = 200'000;  // beyond that an .svg or .pdf does not open in a minute

using Words = std::vector<std::string>;

bool has_words(const Column& column, const Words& words) { return column.name == "status" && !words.empty(); }

/// Above and below the first and the last word.
void name_places(Axis& axis, const Words& words) {
  axis.words = words;
  axis.low = -0.5;
  axis.high = static_cast<double>(words.size()) - 0.5;
}

std::vector<const Column*> columns_to_draw(const Table& table, const Column* x, const std::string* list,
                                           Errors& errors) {
  std::vector<const Column*> result;
  if (!list) {
    for (const Column& other : table.columns)
      if (&other != x) result.push_back(&other);
    if (result.size() > max_curves)
      errors.push_back(
          {"too_many_columns", "--y",
           fmt::format("there are {} columns to draw, and {} at most are told apart; name some: --y {}.",
                       result.size(), max_curves, in_quotes(result.front()->name))});
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

/// One colour after the other, each with its entry in the legend.
Panel curves(const Column& x, const std::vector<const Column*>& ys, bool is_log, bool is_ours, Mark mark,
             double width) {
  std::vector<Scale> scales;
  for (const Column* y : ys) scales.push_back(scale_of(*y, is_log));
  if (ys.size() > 1)  // of one unit, one scale
    for (std::size_t i = 0; i < ys.size(); ++i) {
      const Shown people = shown(ys[i]->unit);
      scales[i] = {people.factor, std::string(people.unit)};
    }
  const bool has_one_unit =
      std::ranges::all_of(scales, [&](const Scale& scale) { return scale.unit == scales.front().unit; });
  const Scale along = scale_of(x);
  Panel panel{.title = {},
              .x = {.label = quantity_name(x.name, is_ours), .unit = along.unit},
              .y = {.label = ys.size() == 1 ? quantity_name(ys[0]->name, is_ours) : common_name(ys),
                    .unit = has_one_unit ? scales[0].unit : ""},
              .series = {}};
  constexpr std::array colours{Colour::blue, Colour::vermillion, Colour::green, Colour::orange,
                               Colour::sky,  Colour::purple,     Colour::black, Colour::yellow};
  for (std::size_t i = 0; i < ys.size(); ++i)
    panel.series.push_back({.label = ys.size() == 1 ? Text()
                                     : has_one_unit ? quantity_name(ys[i]->name, is_ours)
                                                    : titled(*ys[i], scales[i], is_ours),
                            .x = along.shown(x.values),
                            .y = scales[i].shown(ys[i]->values),
                            .mark = mark,
                            .colour = colours[i % colours.size()],
                            .width = width});
  panel.y.log = is_log;
  return panel;
}

/// Extent of the values that there are; 0 of none.
double span(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  return low < high ? high - low : 0;
}

/// Whether both are lengths, and neither so short that equal axes would make a strip of the panel.
bool has_equal_axes(const Column& x, const Column& y) {
  const double across = span(x.values), up = span(y.values);
  return x.unit == "m" && y.unit == "m" && up > 0.2 * across && across > 0.2 * up;
}

/// Points coloured by a column; those without a value of it stay, in grey.
Expected<Panel> coloured_points(Panel panel, const Column& colour, bool log, bool is_ours,
                                const Words& words) {
  const Scale scale = scale_of(colour, log);
  const auto values = scale.shown(colour.values);
  const auto is_known = [](double value) { return std::isfinite(value); };
  if (std::ranges::none_of(values, is_known))
    return failure("no_values", fmt::format("--colour {}", colour.name),
                   "the column has no values; choose another.");
  if (log && std::ranges::any_of(values, [](double value) { return value <= 0; }))
    return failure(
        "not_positive", "--log-value",
        fmt::format("some values of {} are not above 0 and have no logarithm; leave it out.", colour.name));
  const auto [low, high] = colour_ends(values, log);
  panel.scale = ColourScale{.label = titled(colour, scale, is_ours), .low = low, .high = high, .log = log};
  if (has_words(colour, words)) panel.scale->words = words;
  if (!std::ranges::all_of(values, is_known)) {
    Series rest = panel.series.front();
    for (std::size_t k = 0; k < values.size(); ++k)
      if (is_known(values[k])) rest.x[k] = rest.y[k] = std::numeric_limits<double>::quiet_NaN();
    rest.label = Text("no value: ") + quantity_name(colour.name, is_ours);
    rest.colour = Colour::grey;
    panel.series.insert(panel.series.begin(), std::move(rest));
    panel.legend = Legend::below;
  }
  panel.series.back().shades = values;
  return panel;
}

/// The first column, unless it is one value throughout and another is not.
const Column* first_that_varies(const Table& table) {
  const auto found = std::ranges::find_if(table.columns, [](const Column& c) { return span(c.values) > 0; });
  return found == table.columns.end() ? &table.columns.front() : &*found;
}

Errors refuse_count(std::size_t points, const Arguments& arguments) {
  if (points <= max_vector_points || arguments.text("output")->ends_with(".png")) return {};
  return {{"too_many_points", "--output",
           fmt::format("{} points; an .svg or .pdf has {} at most, else nothing opens it. Write a .png, or "
                       "fewer rows.",
                       points, max_vector_points)}};
}

/// Whether some row has a number in both; an axis without any has no ends.
bool meet(const Column& x, const Column& y) {
  for (std::size_t row = 0; row < x.values.size(); ++row)
    if (std::isfinite(x.values[row]) && std::isfinite(y.values[row])) return true;
  return false;
}

Expected<Figure> plane_figure(const Table& table, const Arguments& arguments, bool is_line,
                              const Words& words) {
  Errors errors;
  const std::string* name = arguments.text("x");
  const Column* x = name ? column(table, *name, "x", errors) : first_that_varies(table);
  auto ys = columns_to_draw(table, x, arguments.text("y"), errors);
  const std::string* colour_name = arguments.text("colour");
  const Column* colour = colour_name ? column(table, *colour_name, "colour", errors) : nullptr;
  if (errors.empty() && ys.empty())
    errors.push_back(
        {"too_few_columns", arguments.operand(), "a curve needs two columns, x and y; there is one."});
  if (errors.empty() && std::ranges::none_of(ys, [&](const Column* y) { return meet(*x, *y); }))
    errors.push_back(
        {"no_values", arguments.operand(),
         fmt::format("no row has a number both in {} and in a column to draw; choose others.", x->name)});
  if (errors.empty() && colour && ys.size() > 1) {
    if (arguments.has("y"))
      errors.push_back(
          {"contradiction", "--colour", "colours one column of points, and --y names several; name one."});
    ys.resize(1);
  }
  if (errors.empty() && !is_line) errors = refuse_count(table.row_count() * ys.size(), arguments);
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  const auto rows = static_cast<double>(std::max<std::size_t>(table.row_count(), 1));
  const double dot = std::min(3.0, 8 * std::pow(rows, -0.2));
  const bool is_log = arguments.has("log-y");
  const bool is_ours = is_of_sinew(table);
  Panel panel = curves(*x, ys, is_log, is_ours, is_line ? Mark::line : Mark::points, is_line ? 2 : dot);
  panel.equal_aspect = !is_line && !is_log && ys.size() == 1 && has_equal_axes(*x, *ys.front());
  if (ys.size() > (is_line ? 4U : 1U)) panel.legend = Legend::below;
  if (has_words(*x, words)) name_places(panel.x, words);
  if (ys.size() == 1 && has_words(*ys.front(), words) && !is_log) name_places(panel.y, words);
  if (colour) {
    auto coloured = coloured_points(std::move(panel), *colour, arguments.has("log-value"), is_ours, words);
    if (!coloured) return tl::unexpected(coloured.error());
    panel = std::move(*coloured);
  }
  Figure figure;
  constexpr double row = 26;  // of the legend
  if (panel.legend == Legend::below) figure.height += row * static_cast<double>(panel.series.size());
  figure.panels = {std::move(panel)};
  return figure;
}

/// Cells of one size in place of many of different sizes, which no image has: each takes the nearest value.
HeatMap with_even_cells(const HeatMap& map) {
  constexpr std::size_t most = 1000;
  const auto even = [](const std::vector<double>& places) {
    double least = places.back() - places.front();
    for (std::size_t i = 1; i < places.size(); ++i) least = std::min(least, places[i] - places[i - 1]);
    const double steps = std::min<double>(most - 1, std::ceil((places.back() - places.front()) / least));
    std::vector<double> all;
    for (double k = 0; k <= steps; ++k) all.push_back(std::lerp(places.front(), places.back(), k / steps));
    return all;
  };
  const auto nearest = [](const std::vector<double>& places, double value) {
    const auto above = std::ranges::lower_bound(places, value);
    const auto k = static_cast<std::size_t>(above - places.begin());
    return k == places.size() || (k > 0 && value - places[k - 1] <= places[k] - value) ? k - 1 : k;
  };
  HeatMap result{.x = even(map.x),
                 .y = even(map.y),
                 .values = {},
                 .label = map.label,
                 .log = map.log,
                 .words = map.words};
  for (const double y : result.y)
    for (const double x : result.x)
      result.values.push_back(map.values[nearest(map.y, y) * map.x.size() + nearest(map.x, x)]);
  return result;
}

bool is_even(const std::vector<double>& places) {
  const double step = (places.back() - places.front()) / static_cast<double>(places.size() - 1);
  for (std::size_t i = 1; i < places.size(); ++i)
    if (std::abs(places[i] - places[i - 1] - step) > 1e-6 * step) return false;
  return true;
}

/// The page about a map: as large as needed where its axes are equal.
void set_page(Figure& figure, const Panel& panel) {
  constexpr double side = 540, beside = 230, below = 95;
  const HeatMap& map = *panel.map;
  const double ratio = (map.y.back() - map.y.front()) / (map.x.back() - map.x.front());
  const bool is_wide = panel.equal_aspect && ratio < 1;
  figure.width = beside + (map.words.empty() ? 0 : 60) +
                 side * (panel.equal_aspect && ratio > 1 ? std::max(1 / ratio, 0.4) : 1);
  figure.height = below + side * (is_wide ? std::max(ratio, 0.4) : 1);
}

Expected<Figure> map_figure(const Table& table, const Arguments& arguments, bool has_lines,
                            const FigureOptions& paper, const Words& words) {
  const auto columns = map_columns(table, arguments);
  if (!columns) return tl::unexpected(columns.error());
  auto map = heat_map(table, *columns, arguments.has("log-value"));
  if (!map) return tl::unexpected(map.error());
  if (has_words(*columns->value, words)) map->words = words;
  constexpr std::size_t many_cells = 20'000;
  if (map->values.size() > many_cells && !(is_even(map->x) && is_even(map->y))) *map = with_even_cells(*map);
  const bool is_ours = is_of_sinew(table);
  const auto axis = [is_ours](const Column& of, const std::vector<double>& places) {
    return Axis{.label = quantity_name(of.name, is_ours),
                .unit = scale_of(of).unit,
                .step = round_step(places.back() - places.front(), 8)};
  };
  Panel panel{.title = {},
              .x = axis(*columns->x, map->x),
              .y = axis(*columns->y, map->y),
              .series = {},
              .legend = Legend::none,
              .equal_aspect = has_equal_axes(*columns->x, *columns->y),
              .map = std::move(*map)};
  Figure figure;
  set_page(figure, panel);
  figure.panels = {std::move(panel)};
  if (has_lines) {
    const PageLayout page = page_of(figure, paper);
    add_contours(figure.panels[0], contour_levels(*figure.panels[0].map), page.width, page.height);
  }
  return figure;
}

}  // namespace

std::string_view table_kind(const Table& table, const Arguments& arguments) {
  if (arguments.has("value")) return "map";
  if (arguments.has("colour")) return "points";
  if (arguments.has("x") || arguments.has("y") || arguments.has("log-y")) return "line";
  const GridAxes axes = grid_axes(table);
  const bool is_map = axes.is_full && axes.columns.size() > 1 && axes.columns.size() < table.columns.size();
  return is_map ? "map" : "line";
}

Expected<Figure> table_figure(const Table& table, std::string_view kind, const Arguments& arguments,
                              const FigureOptions& paper, const std::vector<std::string>& words) {
  const bool has_cells = kind == "map" || kind == "contour";
  return has_cells ? map_figure(table, arguments, kind == "contour", paper, words)
                   : plane_figure(table, arguments, kind == "line", words);
}

}  // namespace sinew::cli
