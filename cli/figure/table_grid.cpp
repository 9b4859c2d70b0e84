#include "figure/table_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "figure/quantity_name.hpp"
#include "io/document/quantity.hpp"
#include "request.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/io/node.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// The values that a column has, in order; what differs by rounding alone is one.
class Places {
 public:
  explicit Places(const Column& column) {
    for (const double value : column.values) (std::isfinite(value) ? all_ : gaps_).push_back(value);
    std::ranges::sort(all_);
    if (all_.empty()) return;
    same_ = 1e-9 * (all_.back() - all_.front());
    std::size_t kept = 1;
    for (const double value : all_)
      if (value - all_[kept - 1] > same_) all_[kept++] = value;
    all_.resize(kept);
  }
  const std::vector<double>& values() const { return all_; }
  std::size_t count() const { return all_.size(); }
  bool has_gaps() const { return !gaps_.empty(); }

  /// Which of them is nearest; `none` for what is no number.
  std::size_t nearest(double value) const {
    if (!std::isfinite(value) || all_.empty()) return none;
    const auto above = std::ranges::lower_bound(all_, value);
    if (above == all_.begin()) return 0;
    const auto k = static_cast<std::size_t>(above - all_.begin());
    return k == all_.size() || value - all_[k - 1] <= all_[k] - value ? k - 1 : k;
  }

 private:
  std::vector<double> all_, gaps_;
  double same_ = 0;
};

bool all_differ(std::vector<std::uint64_t> keys) {
  std::ranges::sort(keys);
  return std::ranges::adjacent_find(keys) == keys.end();
}

bool has_more_than_two_values(const Column& column) {
  std::vector<double> found;
  for (const double value : column.values) {
    if (std::isfinite(value) && std::ranges::find(found, value) == found.end()) found.push_back(value);
    if (found.size() > 2) return true;
  }
  return false;
}

std::string shown_number(double si, std::string_view unit) {
  const Shown people = shown(unit);
  return fmt::format("{}{}{}", six_digits(si * people.factor, 1e-3), people.unit.empty() ? "" : " ",
                     people.unit);
}

/// What a number in a column of this unit is.
Dimension dimension_of(std::string_view symbol) {
  for (int k = 0; k <= static_cast<int>(Dimension::line_mass); ++k)
    if (const auto dimension = static_cast<Dimension>(k); !symbol.empty() && unit(dimension) == symbol)
      return dimension;
  return Dimension::number;
}

/// `phi=30 deg` of `--at`: which of the column's values is meant.
struct Chosen {
  const Column* column;
  Places places;
  std::size_t index;
};

std::optional<Chosen> chosen(const Table& table, std::string_view text, Errors& errors) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    errors.push_back({"not_a_place", "--at",
                      fmt::format("{} is no COLUMN=VALUE; write --at \"phi=30 deg\".", in_quotes(text))});
    return {};
  }
  const Column* found = column(table, trimmed(text.substr(0, equals)), "at", errors);
  if (!found) return {};
  const auto value = parse_quantity(trimmed(text.substr(equals + 1)), dimension_of(found->unit));
  if (!value) {
    errors.push_back(
        {value.error().front().code, fmt::format("--at, {}", found->name), value.error().front().message});
    return {};
  }
  Places places(*found);
  const std::size_t index = places.nearest(*value), count = places.count();
  if (count > 0) {
    const double low = places.values().front(), high = places.values().back();
    const double beside =
        count > 1 ? 0.5 * (high - low) / static_cast<double>(count - 1) : 1e-9 * std::abs(low);
    if (*value >= low - beside && *value <= high + beside) return Chosen{found, std::move(places), index};
    errors.push_back({"out_of_range", fmt::format("--at, {}", found->name),
                      fmt::format("{} is outside the table, which has {} to {}; give one of these.",
                                  shown_number(*value, found->unit), shown_number(low, found->unit),
                                  shown_number(high, found->unit))});
  } else {
    errors.push_back({"no_values", fmt::format("--at, {}", found->name),
                      "the column has no values; leave it out, or choose another column."});
  }
  return {};
}

std::vector<std::string_view> places_given(const Arguments& arguments) {
  std::vector<std::string_view> all;
  const auto given = arguments.options.find("at");
  if (given == arguments.options.end()) return all;
  for (std::string_view rest : given->second)
    for (bool more = true; more;) {
      const std::size_t comma = rest.find(',');
      all.push_back(trimmed(rest.substr(0, comma)));
      more = comma != std::string_view::npos;
      if (more) rest.remove_prefix(comma + 1);
    }
  return all;
}

/// Two rows at one place: another axis varies, or they repeat it.
Errors refuse_twice(const Table& table, const MapColumns& columns) {
  std::vector<std::string> others;
  std::string example;
  const GridAxes axes = grid_axes(table);
  for (const Column* other : axes.columns) {
    if (axes.columns.size() == 1) break;  // it numbers the rows
    if (other == columns.x || other == columns.y || other == columns.value) continue;
    const Places places(*other);
    others.push_back(fmt::format("{} ({} values from {} to {})", other->name, places.count(),
                                 shown_number(places.values().front(), other->unit),
                                 shown_number(places.values().back(), other->unit)));
    example += fmt::format("{}{}={}", example.empty() ? "" : ", ", other->name,
                           shown_number(places.values()[places.count() / 2], other->unit));
  }
  if (others.empty())
    return {{"same_place_twice", fmt::format("--x {} --y {}", columns.x->name, columns.y->name),
             "several rows have the same values of both, and a cell has one; choose columns that tell the "
             "rows apart, or draw points: --as points."}};
  return {{"axis_not_fixed", "--at",
           fmt::format("beside {} and {} varies {}; say where: --at \"{}\".", columns.x->name,
                       columns.y->name, fmt::join(others, " and "), example)}};
}

Errors refuse_grid(const Column& x, const Column& y, std::size_t across, std::size_t up, std::size_t rows) {
  if (across < 2 || up < 2) {
    const Column& fixed = across < 2 ? x : y;
    return {{"not_a_grid", fmt::format("--{} {}", across < 2 ? "x" : "y", fixed.name),
             "the column has fewer than two values, and a map needs two along each axis; choose another, or "
             "draw a line: --as line."}};
  }
  return {{"not_a_grid", fmt::format("--x {} --y {}", x.name, y.name),
           fmt::format("{} values of one and {} of the other are a grid of which {} rows fill too little; "
                       "draw points: --as points.",
                       across, up, rows)}};
}

}  // namespace

const Column* column(const Table& table, std::string_view name, std::string_view option, Errors& errors) {
  if (const Column* found = table.find(name)) return found;
  std::vector<std::string_view> names;
  for (const Column& known : table.columns) names.push_back(known.name);
  const std::string_view hint = closest(name, names);
  constexpr std::size_t max_names = 40;
  const std::string_view more = names.size() > max_names ? ", ..." : "";
  if (names.size() > max_names) names.resize(max_names);
  errors.push_back({"unknown_column", fmt::format("--{}", option),
                    fmt::format("no column {}{} Columns: {}{}.", in_quotes(name),
                                hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)),
                                fmt::join(names, ", "), more)});
  return nullptr;
}

std::vector<double> Scale::shown(const std::vector<double>& values) const {
  std::vector<double> result = values;
  if (factor != 1)
    for (double& value : result) value *= factor;
  return result;
}

Scale scale_of(const Column& column, bool is_log) {
  const Shown people = shown(column.unit);
  Scale scale{people.factor, std::string(people.unit)};
  double largest = 0;
  for (const double value : column.values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value * people.factor));
  if (is_log || largest == 0 || (largest >= 0.01 && largest < 1e5)) return scale;
  const int power = 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
  scale.factor *= std::pow(10, -power);
  std::string exponent;
  for (const char c : fmt::format("{}", power)) {
    constexpr std::array digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    exponent += c == '-' ? "⁻" : digits[static_cast<std::size_t>(c - '0')];
  }
  scale.unit = fmt::format("10{}{}{}", exponent, people.unit.empty() ? "" : " ", people.unit);
  return scale;
}

Text titled(const Column& column, const Scale& scale, bool is_ours) {
  return with_unit(quantity_name(column.name, is_ours), scale.unit);
}

std::array<double, 2> colour_ends(const std::vector<double>& values, bool log) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  if (log) {
    if (high >= 100 * low) return {low, high};
    const double first = std::floor(std::log10(low)), last = std::ceil(std::log10(high));
    return {std::pow(10, first), std::pow(10, std::max(last, first + 1))};
  }
  const double extent = low < high ? high - low : std::max(std::abs(low), 1e-9);
  const double step = round_step(extent, 10);
  low = std::floor(low / step) * step;
  high = std::max(std::ceil(high / step) * step, low + step);
  const auto short_digits = [](double value) {  // people edit the script
    return parse_number(fmt::format("{:.12g}", value)).value_or(value);
  };
  return {short_digits(low), short_digits(high)};
}

GridAxes grid_axes(const Table& table) {
  GridAxes axes;
  const std::size_t rows = table.row_count();
  std::vector<std::uint64_t> keys(rows, 0);
  double cells = 1;
  for (const Column& next : table.columns) {
    const Places places(next);
    if (places.count() < 2 || places.has_gaps()) continue;
    cells *= static_cast<double>(places.count());
    if (cells > 1e18) return {};
    for (std::size_t row = 0; row < rows; ++row)
      keys[row] = keys[row] * places.count() + places.nearest(next.values[row]);
    axes.columns.push_back(&next);
    if (cells < static_cast<double>(rows) || !all_differ(keys)) continue;
    axes.is_full = cells == static_cast<double>(rows);
    if (next.values[0] != next.values[1]) std::ranges::reverse(axes.columns);  // the last runs fastest
    return axes;
  }
  return {};
}

Expected<Cut> cut(Table table, const Arguments& arguments) {
  Errors errors;
  std::string place;
  Text shown_place;
  const bool is_ours = is_of_sinew(table);
  std::vector<char> stays(table.row_count(), 1);
  for (const std::string_view text : places_given(arguments)) {
    const auto where = chosen(table, text, errors);
    if (!where) continue;
    for (std::size_t row = 0; row < stays.size(); ++row)
      if (where->places.nearest(where->column->values[row]) != where->index) stays[row] = 0;
    place += fmt::format("{}{} = {}", place.empty() ? "" : ", ", where->column->name,
                         shown_number(where->places.values()[where->index], where->column->unit));
    const Shown people = shown(where->column->unit);
    shown_place += (shown_place.empty() ? Text() : Text(", ")) +
                   place_name(where->column->name,
                              six_digits(where->places.values()[where->index] * people.factor, 1e-3),
                              people.unit, is_ours);
  }
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  if (place.empty()) return Cut{std::move(table), {}};
  for (Column& column : table.columns) {
    std::size_t kept = 0;
    for (std::size_t row = 0; row < stays.size(); ++row)
      if (stays[row]) column.values[kept++] = column.values[row];
    column.values.resize(kept);
  }
  if (table.row_count() == 0)
    return failure("no_values", "--at", fmt::format("no row is at {}; give fewer of them.", place));
  return Cut{std::move(table), std::move(shown_place)};
}

Expected<MapColumns> map_columns(const Table& table, const Arguments& arguments) {
  Errors errors;
  const auto named = [&](std::string_view option) -> const Column* {
    const std::string* name = arguments.text(option);
    return name ? column(table, *name, option, errors) : nullptr;
  };
  MapColumns result{named("x"), named("y"), named("value")};
  if (result.x && result.x == result.y)
    errors.push_back({"contradiction", "--y", "is the column of --x, too; a map is over two. Name another."});
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  const GridAxes axes = grid_axes(table);
  const auto is_taken = [&](const Column* other) {
    return other == result.x || other == result.y || other == result.value;
  };
  for (const Column** axis : {&result.x, &result.y}) {
    if (*axis) continue;
    const auto found = std::ranges::find_if_not(axes.columns, is_taken);
    if (found == axes.columns.end())
      return failure("not_a_grid", arguments.operand(),
                     fmt::format("no two columns at the left tell the rows apart, so --{} has no default; "
                                 "name both axes: --x COLUMN --y COLUMN.",
                                 axis == &result.x ? "x" : "y"));
    *axis = *found;
  }
  const auto is_axis = [&](const Column& other) {
    return is_taken(&other) || std::ranges::find(axes.columns, &other) != axes.columns.end();
  };
  for (const bool wants_many : {true, false})
    for (const Column& other : table.columns)
      if (!result.value && !is_axis(other) && (!wants_many || has_more_than_two_values(other)))
        result.value = &other;
  if (!result.value)
    return failure("too_few_columns", arguments.operand(),
                   "a map needs three columns, two axes and a value; there is none left for the value.");
  return result;
}

Expected<HeatMap> heat_map(const Table& table, const MapColumns& columns, bool log) {
  const Column &x = *columns.x, &y = *columns.y, &value = *columns.value;
  const Places across(x), up(y);
  const std::size_t rows = table.row_count();
  const double cells = static_cast<double>(across.count()) * static_cast<double>(up.count());
  if (across.count() < 2 || up.count() < 2 || cells > 20.0 * static_cast<double>(rows))
    return tl::unexpected(refuse_grid(x, y, across.count(), up.count(), rows));
  const Scale scale = scale_of(value, log);
  HeatMap map{.x = scale_of(x).shown(across.values()),
              .y = scale_of(y).shown(up.values()),
              .values = std::vector<double>(across.count() * up.count(), not_a_number),
              .label = titled(value, scale, is_of_sinew(table)),
              .log = log};
  std::vector<char> is_seen(map.values.size(), 0);
  std::size_t known = 0, not_positive = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t i = across.nearest(x.values[row]), j = up.nearest(y.values[row]);
    if (i == none || j == none) continue;
    const std::size_t cell = j * across.count() + i;
    if (is_seen[cell]++) return tl::unexpected(refuse_twice(table, columns));
    map.values[cell] = value.values[row] * scale.factor;
    known += std::isfinite(value.values[row]);
    not_positive += value.values[row] <= 0;
  }
  if (known == 0)
    return failure("no_values", fmt::format("--value {}", value.name),
                   "the column has no values here; choose another.");
  if (log && not_positive > 0)
    return failure("not_positive", "--log-value",
                   fmt::format("{} of {} values of {} are not above 0 and have no logarithm; leave it out.",
                               not_positive, known, value.name));
  const auto [low, high] = colour_ends(map.values, log);
  map.low = low;
  map.high = high;
  return map;
}

}  // namespace sinew::cli
