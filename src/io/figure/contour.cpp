#include "io/figure/contour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

/// A point in the units of the axes.
using Point = std::array<double, 2>;

/// Where a line crosses the sides of cells, and which of these points are neighbours on it.
class Crossings {
 public:
  Crossings(const HeatMap& map, double level) : map_(map), level_(level) {
    for (std::size_t j = 0; j + 1 < map.y.size(); ++j)
      for (std::size_t i = 0; i + 1 < map.x.size(); ++i) add_cell(i, j);
  }

  /// Each piece from an end to the other, then the closed ones.
  void write(Series& line) {
    for (const bool wants_end : {true, false})
      for (std::size_t k = 0; k < points_.size(); ++k)
        if (!points_[k].is_written && (!wants_end || points_[k].next[1] == none)) write_from(k, line);
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct Crossing {
    Point at;
    std::array<std::size_t, 2> next{none, none};
    bool is_written = false;
  };

  double value(std::size_t i, std::size_t j) const { return map_.values[j * map_.x.size() + i]; }

  /// Four middles of cells from column i and row j. Where all four sides are crossed the value at the centre
  /// tells which crossings belong together.
  void add_cell(std::size_t i, std::size_t j) {
    constexpr std::array<std::array<std::size_t, 2>, 5> ring{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
    std::array<double, 5> off;
    for (std::size_t c = 0; c < 5; ++c) off[c] = value(i + ring[c][0], j + ring[c][1]) - level_;
    if (!std::ranges::all_of(off, [](double v) { return std::isfinite(v); })) return;
    std::array<std::size_t, 4> found;
    std::size_t count = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      if ((off[c] < 0) == (off[c + 1] < 0)) continue;
      const auto [ai, aj] = ring[c];
      const auto [bi, bj] = ring[c + 1];
      const double part = off[c] / (off[c] - off[c + 1]);
      const std::size_t corner = (j + std::min(aj, bj)) * map_.x.size() + i + std::min(ai, bi);
      found[count++] = place(2 * corner + (ai == bi), {std::lerp(map_.x[i + ai], map_.x[i + bi], part),
                                                       std::lerp(map_.y[j + aj], map_.y[j + bj], part)});
    }
    if (count == 2) join(found[0], found[1]);
    if (count < 4) return;
    const bool joins_first = (off[0] + off[1] + off[2] + off[3] < 0) == (off[0] < 0);
    join(found[0], found[joins_first ? 1 : 3]);
    join(found[2], found[joins_first ? 3 : 1]);
  }

  /// The point on a side, which two cells share.
  std::size_t place(std::size_t side, const Point& at) {
    const auto [entry, is_new] = sides_.try_emplace(side, points_.size());
    if (is_new) points_.push_back({at});
    return entry->second;
  }

  void join(std::size_t a, std::size_t b) {
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}})
      points_[from].next[points_[from].next[0] == none ? 0 : 1] = to;
  }

  void write_from(std::size_t start, Series& line) {
    const auto add = [&line](const Point& at) {
      line.x.push_back(at[0]);
      line.y.push_back(at[1]);
    };
    std::size_t before = none, here = start;
    while (here != none && !points_[here].is_written) {
      points_[here].is_written = true;
      add(points_[here].at);
      const auto& next = points_[here].next;
      before = std::exchange(here, next[0] != before ? next[0] : next[1]);
    }
    if (here == start) add(points_[start].at);  // closed
    add({not_a_number, not_a_number});
  }

  const HeatMap& map_;
  double level_;
  std::vector<Crossing> points_;
  std::unordered_map<std::size_t, std::size_t> sides_;  ///< only looked up: its order tells nothing
};

/// Ends of the colours.
std::pair<double, double> range(const HeatMap& map) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : map.values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return {map.low.value_or(low), map.high.value_or(high)};
}

/// The panel as a square of side 1, in which distances on the page are compared.
struct Page {
  const HeatMap& map;
  double width, height;  ///< of the cells [px]

  Point at(double x, double y) const {
    return {(x - map.x.front()) / (map.x.back() - map.x.front()),
            (y - map.y.front()) / (map.y.back() - map.y.front())};
  }
  Point across(const Point& a, const Point& b) const {
    return {(a[0] - b[0]) * width, (a[1] - b[1]) * height};
  }
  double distance(const Point& a, const Point& b) const {
    const Point d = across(a, b);
    return std::hypot(d[0], d[1]);
  }
};

/// A number on a line, and the half width and height that it hides [px].
struct Label {
  Point at, reach;
};

std::string text_of(double level) {
  std::string text = fmt::format("{:.6g}", level);
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text;
}

/// Whether all cells under a number have values: beside them is the page, where a light one is not seen.
bool is_on_cells(const Page& page, const Point& at, const Point& reach) {
  const HeatMap& map = page.map;
  const auto nearest = [](const std::vector<double>& places, double part) {
    const double value = std::lerp(places.front(), places.back(), std::clamp(part, 0.0, 1.0));
    const auto above = std::ranges::lower_bound(places, value);
    const auto k = static_cast<std::size_t>(above - places.begin());
    return k == places.size() || (k > 0 && value - places[k - 1] < places[k] - value) ? k - 1 : k;
  };
  for (const double side : {-1.0, 0.0, 1.0})
    for (const double end : {-1.0, 1.0}) {
      const std::size_t i = nearest(map.x, at[0] + side * reach[0] / page.width),
                        j = nearest(map.y, at[1] + end * reach[1] / page.height);
      if (!std::isfinite(map.values[j * map.x.size() + i])) return false;
    }
  return true;
}

/// How far a number there is from the frame and from others [px]; < 0: over them.
double room(const Page& page, const Point& at, const Point& reach, const std::vector<Label>& labels) {
  const double from_left = std::min(at[0], 1 - at[0]) * page.width - reach[0],
               from_below = std::min(at[1], 1 - at[1]) * page.height - reach[1];
  double least = std::min({from_left, from_below, 60.0});  // beyond that the frame is no reason
  for (const Label& other : labels) {
    const Point d = page.across(at, other.at);
    const double gap =
        std::max(std::abs(d[0]) - reach[0] - other.reach[0], std::abs(d[1]) - reach[1] - other.reach[1]);
    least = std::min(least, 0.5 * gap);  // neighbours stand further apart than the frame
  }
  return least;
}

/// Of the points [begin, end) of a line [px].
double length_of(const Page& page, const Series& line, std::size_t begin, std::size_t end) {
  double length = 0;
  for (std::size_t k = begin + 1; k < end; ++k)
    length += page.distance(page.at(line.x[k - 1], line.y[k - 1]), page.at(line.x[k], line.y[k]));
  return length;
}

/// The roomiest place on the points [begin, end) of a line; nothing on a short one.
void place_label(const Page& page, const Series& line, std::size_t begin, std::size_t end, const Point& reach,
                 std::vector<Label>& labels) {
  if (length_of(page, line, begin, end) < 5 * reach[0]) return;
  double best = 4;
  Label label{{not_a_number, not_a_number}, reach};
  const std::size_t stride = std::max<std::size_t>(1, (end - begin) / 400);
  for (std::size_t k = begin; k < end; k += stride) {
    const Point at = page.at(line.x[k], line.y[k]);
    const double free = room(page, at, reach, labels);
    if (free > best && is_on_cells(page, at, reach)) best = free, label.at = at;
  }
  if (std::isfinite(label.at[0])) labels.push_back(label);
}

/// The parts of a line that no number hides.
Series without(const Series& line, const std::vector<Label>& labels, const Page& page) {
  Series result = line;
  result.x.clear(), result.y.clear();
  const auto add = [&result](double x, double y) { result.x.push_back(x), result.y.push_back(y); };
  for (std::size_t k = 0; k < line.x.size(); ++k) {
    add(line.x[k], line.y[k]);
    if (k + 1 == line.x.size() || !std::isfinite(line.x[k]) || !std::isfinite(line.x[k + 1])) continue;
    const Point a = page.at(line.x[k], line.y[k]), b = page.at(line.x[k + 1], line.y[k + 1]);
    for (const Label& label : labels) {
      double from = 0, to = 1;  // of the segment, inside the label's box
      const Point start = page.across(a, label.at), way = page.across(b, a);
      for (std::size_t c = 0; c < 2; ++c) {
        const double one = (-label.reach[c] - start[c]) / way[c],
                     other = (label.reach[c] - start[c]) / way[c];
        if (way[c] == 0 && std::abs(start[c]) > label.reach[c]) to = -1;
        if (way[c] == 0) continue;
        from = std::max(from, std::min(one, other));
        to = std::min(to, std::max(one, other));
      }
      if (from >= to) continue;
      if (from == 0) result.x.back() = result.y.back() = not_a_number;
      const auto between = [&](double part) {
        return Point{std::lerp(line.x[k], line.x[k + 1], part), std::lerp(line.y[k], line.y[k + 1], part)};
      };
      if (from > 0) add(between(from)[0], between(from)[1]), add(not_a_number, not_a_number);
      if (to < 1) add(between(to)[0], between(to)[1]);
      break;
    }
  }
  return result;
}

/// A line of the panel's map without what is too small to be seen as one; each piece with room for it is
/// written on.
Series written_on(Panel& panel, const Page& page, double level, std::vector<Label>& labels) {
  constexpr double speck = 12;  // px
  const std::string text = text_of(level);
  const std::size_t signs = text.size() - (level < 0 ? 2 : 0);  // the minus has three bytes
  const Point reach{4.6 * static_cast<double>(signs) + 3, 9};
  const Series all = contour_line(page.map, level);
  Series line = all;
  line.x.clear(), line.y.clear();
  for (std::size_t begin = 0, end = 0; begin < all.x.size(); begin = end + 1) {
    for (end = begin; std::isfinite(all.x[end]);) ++end;
    if (length_of(page, all, begin, end) < speck) continue;
    for (std::size_t k = begin; k <= end; ++k) line.x.push_back(all.x[k]), line.y.push_back(all.y[k]);
    const std::size_t before = labels.size();
    place_label(page, all, begin, end, reach, labels);
    if (labels.size() == before) continue;
    const Point& at = labels.back().at;
    panel.notes.push_back({text, std::lerp(page.map.x.front(), page.map.x.back(), at[0]),
                           std::lerp(page.map.y.front(), page.map.y.back(), at[1]), Note::Side::centre,
                           line.colour});
  }
  return line;
}

/// Levels of a logarithmic map: 1, 2, 5 of each decade; 1 alone where these are too many; then every second
/// decade, and so on.
std::vector<double> log_levels(double low, double high, double most) {
  const int first = static_cast<int>(std::floor(std::log10(low))),
            last = static_cast<int>(std::floor(std::log10(high)));
  std::vector<double> levels;
  const auto fill = [&](std::initializer_list<double> factors, int stride) {
    levels.clear();
    for (int power = first; power <= last; ++power)
      for (const double factor : factors)
        if (const double level = factor * std::pow(10, power);
            power % stride == 0 && level > low && level < high)
          levels.push_back(level);
    return static_cast<double>(levels.size()) <= most;
  };
  if (fill({1, 2, 5}, 1)) return levels;
  for (int stride = 1; !fill({1}, stride);) ++stride;
  return levels;
}

}  // namespace

Series contour_line(const HeatMap& map, double level) {
  const auto [low, high] = range(map);
  const auto shade = [&map](double v) { return map.log ? std::log(v) : v; };
  Series line{.label = {}, .x = {}, .y = {}, .mark = Mark::line, .colour = Colour::black, .width = 1};
  if (shade(level) < 0.5 * (shade(low) + shade(high))) line.colour = Colour::white;
  Crossings(map, level).write(line);
  return line;
}

std::vector<double> contour_levels(const HeatMap& map, double most) {
  const auto [low, high] = range(map);
  std::vector<double> levels;
  if (!(low < high)) return levels;
  if (map.log && low > 0 && high > 3 * low) return log_levels(low, high, most);
  const double step = round_step(high - low, most);
  for (double k = std::ceil(low / step); k * step < high; ++k)
    if (k * step > low) levels.push_back(k * step + 0.0);  // no -0
  return levels;
}

void add_contours(Panel& panel, const std::vector<double>& levels, double width, double height) {
  const HeatMap& map = *panel.map;
  if (map.x.size() < 2 || map.y.size() < 2) return;
  Page page{map, 0.72 * width, 0.82 * height};  // the rest is for numbers, titles and the bar
  const double ratio = (map.y.back() - map.y.front()) / (map.x.back() - map.x.front());
  if (panel.equal_aspect && ratio * page.width > page.height) page.width = page.height / ratio;
  if (panel.equal_aspect) page.height = ratio * page.width;
  std::vector<Label> labels;
  std::vector<Series> lines;
  for (const double level : levels) lines.push_back(written_on(panel, page, level, labels));
  for (const Series& line : lines) panel.series.push_back(without(line, labels, page));
}

}  // namespace sinew::inline v1
