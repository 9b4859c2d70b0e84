#include "sinew/io/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sinew/io/quantity.hpp"

namespace sinew::inline v0 {
namespace {

constexpr std::string_view grid = "  set grid lc rgb '#cccccc' lw 1 dt 1\n";

constexpr std::string_view hex(Colour colour) {  // Okabe & Ito, Color Universal Design, 2008
  switch (colour) {
    case Colour::black:
      return "#000000";
    case Colour::blue:
      return "#0072b2";
    case Colour::vermillion:
      return "#d55e00";
    case Colour::green:
      return "#009e73";
    case Colour::orange:
      return "#e69f00";
    case Colour::sky:
      return "#56b4e9";
    case Colour::purple:
      return "#cc79a7";
    case Colour::yellow:
      return "#f0e442";
    case Colour::grey:
      return "#999999";
    case Colour::white:
      return "#ffffff";
  }
  return "#000000";
}

/// A string of gnuplot that means exactly this text. Between single quotes only the quote itself is special,
/// and is doubled; but two quotes in a row, or one where a string begins, end it for gnuplot 5.4: these are
/// put between double ones.
std::string literal(std::string_view text) {
  std::string out = "'";
  bool is_beginning = true;
  for (const char c : text) {
    if (c == '\'') {
      out += is_beginning ? "'.\"'\".'" : "''";
    } else {
      out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    is_beginning = c == '\'';
  }
  return out + '\'';
}

std::string axis_title(const Axis& axis) {
  return literal(axis.unit.empty() ? axis.label : fmt::format("{} [{}]", axis.label, axis.unit));
}

std::string bound(const std::optional<double>& value) { return value ? si_text(*value) : "*"; }

std::string data_name(std::size_t panel, std::size_t series) {
  return fmt::format("$panel{}_{}", panel + 1, series + 1);
}

/// One point a line, an empty line where the curve is interrupted; a shade is its last column.
std::string data_block(const std::string& name, const Series& series, bool in_space) {
  std::string text = name + " << EOD\n";
  std::vector<const std::vector<double>*> columns{&series.x, &series.y};
  if (in_space) columns.push_back(&series.z);
  if (!series.shades.empty()) columns.push_back(&series.shades);
  std::size_t count = series.x.size();
  for (const auto* column : columns) count = std::min(count, column->size());
  const bool closed = (series.mark == Mark::polygon || series.mark == Mark::outline) && count > 0;
  for (std::size_t i = 0; i < count + (closed ? 1 : 0); ++i) {
    const auto value = [&](const auto* column) { return (*column)[i % count]; };
    if (std::ranges::all_of(columns, [&](const auto* column) { return std::isfinite(value(column)); }))
      for (const auto* column : columns) text += (column == columns[0] ? "" : " ") + si_text(value(column));
    text += '\n';
  }
  return text + "EOD\n";
}

std::string map_name(std::size_t panel) { return fmt::format("$panel{}_map", panel + 1); }

/// Distance between neighbours; of a single place any.
double spacing(const std::vector<double>& places) {
  return places.size() > 1 ? (places.back() - places.front()) / static_cast<double>(places.size() - 1) : 1;
}

bool is_regular(const std::vector<double>& places) {
  const double step = spacing(places);
  for (std::size_t i = 1; i < places.size(); ++i)
    if (std::abs(places[i] - places[i - 1] - step) > 1e-6 * std::abs(step)) return false;
  return true;
}

bool is_regular(const HeatMap& map) { return is_regular(map.x) && is_regular(map.y); }

/// More rectangles than a viewer draws at once.
bool is_image(const HeatMap& map) {
  constexpr std::size_t most_rectangles = 20000;
  return map.x.size() * map.y.size() > most_rectangles && map.x.size() > 1 && map.y.size() > 1 &&
         is_regular(map);
}

/// Edges of cell i: half-way to its neighbours, the outermost as far outside as inside.
std::array<double, 2> cell_edges(const std::vector<double>& places, std::size_t i) {
  const std::size_t last = places.size() - 1;
  if (last == 0) return {places[0] - 0.5, places[0] + 0.5};
  const double before = places[i > 0 ? i : 1] - places[i > 0 ? i - 1 : 0];
  const double after = places[i < last ? i + 1 : last] - places[i < last ? i : last - 1];
  return {places[i] - before / 2, places[i] + after / 2};
}

/// As a matrix, row by row. No eye and no palette tells more than six digits apart.
std::string image_block(const std::string& name, const HeatMap& map) {
  std::string text = name + " << EOD\n";
  const std::size_t columns = map.x.size(), rows = std::min(map.y.size(), map.values.size() / columns);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const double value = map.values[j * columns + i];
      text += std::isfinite(value) ? fmt::format("{:.6g}", value) : "NaN";
      text += i + 1 < columns ? ' ' : '\n';
    }
  return text + "EOD\n";
}

/// One cell a line: its middle, its value, and its edges where they differ from cell to cell. An empty cell
/// is left out.
std::string data_block(const std::string& name, const HeatMap& map) {
  if (is_image(map)) return image_block(name, map);
  std::string text = name + " << EOD\n";
  const std::size_t columns = map.x.size();
  const bool has_edges = !is_regular(map);
  for (std::size_t k = 0; k < std::min(map.values.size(), columns * map.y.size()); ++k) {
    if (!std::isfinite(map.values[k])) continue;
    text += fmt::format("{} {} {}", si_text(map.x[k % columns]), si_text(map.y[k / columns]),
                        si_text(map.values[k]));
    if (has_edges)
      for (const auto& [low, high] : {cell_edges(map.x, k % columns), cell_edges(map.y, k / columns)}) {
        const double over = 0.02 * (high - low);
        text += ' ' + si_text(low - over) + ' ' + si_text(high + over);
      }
    text += '\n';
  }
  return text + "EOD\n";
}

/// Between the outer edges of the cells.
std::array<double, 2> frame(const std::vector<double>& places) {
  if (!is_regular(places)) return {cell_edges(places, 0)[0], cell_edges(places, places.size() - 1)[1]};
  const double half = std::abs(spacing(places)) / 2;
  const auto [low, high] = std::ranges::minmax(places);
  return {low - half, high + half};
}

/// The map's frame and back along a closed curve, the other way round: no rule of filling, even or winding,
/// then fills what is inside. The frame is no larger: gnuplot does not clip a polygon with a seam as it
/// should. One point a line.
std::string outside_block(const std::string& name, const Series& series, const HeatMap& map) {
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const auto [left, right] = frame(map.x);
  const auto [low, high] = frame(map.y);
  double twice_area = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    twice_area += series.x[i] * series.y[next] - series.x[next] * series.y[i];
  }
  std::string text = name + " << EOD\n";
  const auto add = [&text](double x, double y) { text += si_text(x) + ' ' + si_text(y) + '\n'; };
  for (const auto& [x, y] : {std::array{left, low}, {left, high}, {right, high}, {right, low}, {left, low}})
    add(x, y);
  for (std::size_t i = 0; i <= count && count > 0; ++i) {
    const std::size_t k = twice_area > 0 ? i % count : (count - i) % count;
    add(series.x[k], series.y[k]);
  }
  add(left, low);
  return text + "EOD\n";
}

std::string series_block(const Panel& panel, const std::string& name, const Series& series) {
  const bool is_edge = series.mark == Mark::outside && panel.map.has_value();
  return is_edge ? outside_block(name, series, *panel.map) : data_block(name, series, panel.eye.has_value());
}

bool has_negative(const std::vector<double>& values) {
  return std::ranges::any_of(values, [](double value) { return value < 0; });
}

/// Whether numbers at its bar have a minus.
bool has_negative_scale(const Panel& panel) {
  if (panel.map) return has_negative(panel.map->values);
  return std::ranges::any_of(panel.series, [](const Series& series) { return has_negative(series.shades); });
}

/// The colours and their bar, for which gnuplot leaves too little room; for numbers with a minus even less.
std::string scale_lines(const ColourScale& scale, bool is_negative, bool has_cells) {
  // Cividis (Nuñez, Anderton, Renslow 2018), at equal steps.
  return fmt::format(
      "{}  set cbrange [{}:{}]\n  set cblabel {}{}\n{}  set rmargin 9\n"
      "  set palette defined (0 '#00224e', 1 '#123570', 2 '#3b496c', 3 '#575d6d', 4 '#707173', 5 '#8a8678', "
      "6 '#a59c74', 7 '#c3b369', 8 '#e1cc55', 9 '#fee838')\n",
      scale.log ? "  set logscale cb\n" : "", bound(scale.low), bound(scale.high), literal(scale.label),
      is_negative ? " offset 2,0" : "", has_cells ? "  unset grid\n" : "");
}

/// The frame just around the cells, and their colours.
std::string map_lines(const HeatMap& map) {
  const auto range = [](char axis, const std::vector<double>& places) {
    const auto [low, high] = frame(places);
    return fmt::format("  set {}range [{}:{}]\n", axis, si_text(low), si_text(high));
  };
  return range('x', map.x) + range('y', map.y) +
         scale_lines({map.label, map.low, map.high, map.log}, has_negative(map.values), true);
}

/// Cells reach a little over their neighbours, the further the smaller they are: else the page shines through
/// where two edges are smoothed.
std::string map_stroke(const HeatMap& map, std::size_t panel) {
  const std::string name = map_name(panel);
  if (is_image(map))
    return fmt::format("{} matrix using ({}+{}*$1):({}+{}*$2):3 with image notitle", name,
                       si_text(map.x.front()), si_text(spacing(map.x)), si_text(map.y.front()),
                       si_text(spacing(map.y)));
  constexpr std::string_view with = "with boxxyerror fs solid 1 noborder lc palette notitle";
  if (!is_regular(map)) return fmt::format("{} using 1:2:4:5:6:7:3 {}", name, with);
  const auto reach = [](const std::vector<double>& places) {
    return si_text(std::abs(spacing(places)) * (0.52 + 0.001 * static_cast<double>(places.size())));
  };
  const std::string x = reach(map.x), y = reach(map.y);
  return fmt::format("{} using 1:2:($1-{}):($1+{}):($2-{}):($2+{}):3 {}", name, x, x, y, y, with);
}

/// Strokes that draw one series; only the last is in the legend.
std::vector<std::string> strokes(const Series& series) {
  const std::string colour = fmt::format("lc rgb '{}'", hex(series.colour)), width = si_text(series.width);
  const std::string dot = si_text(0.25 * series.width);
  switch (series.mark) {
    case Mark::line:
      return {fmt::format("with lines {} lw {} dt 1", colour, width)};
    case Mark::dashed:
      return {fmt::format("with lines {} lw {} dt (12,6)", colour, width)};
    case Mark::dotted:
      return {fmt::format("with lines {} lw {} dt (2,5)", colour, width)};
    case Mark::points:
      return {fmt::format("with points {} pt 7 ps {}", series.shades.empty() ? colour : "lc palette", dot)};
    case Mark::line_points:
      return {fmt::format("with linespoints {} lw {} dt 1 pt 7 ps {}", colour, width, dot)};
    case Mark::circles:
      return {"with points lc rgb '#ffffff' pt 7 ps 1.1",
              fmt::format("with points {} lw {} pt 6 ps 1.1", colour, width)};
    case Mark::polygon:
      return {fmt::format("with filledcurves closed {} fs transparent solid 0.2 noborder", colour),
              fmt::format("with lines {} lw {} dt 1", colour, width)};
    case Mark::outline:
      return {fmt::format("with lines {} lw {} dt 1", colour, width)};
    case Mark::outside:
      return {"with filledcurves closed lc rgb '#ffffff' fs solid 1 noborder"};
  }
  return {};
}

std::string_view key(Legend legend) {
  switch (legend) {
    case Legend::none:
      return "unset key";
    case Legend::top_left:
      return "set key inside top left Left reverse";
    case Legend::top_right:
      return "set key inside top right Left reverse";
    case Legend::bottom_left:
      return "set key inside bottom left Left reverse";
    case Legend::bottom_right:
      return "set key inside bottom right Left reverse";
    case Legend::below:
      return "set key below center Left reverse";
  }
  return "unset key";
}

/// gnuplot gives all numbers of a log axis the decimals of the smallest: 100.0000000 on one from 1e-7.
bool is_tiny(const Axis& axis) { return axis.log && axis.low && *axis.low < 1e-4; }

/// Takes back what those of a panel set.
std::string after_axes(const Panel& panel) {
  return std::string(is_tiny(panel.x) ? "  set format x\n" : "") +
         (is_tiny(panel.y) ? "  set format y\n" : "");
}

std::string axis_lines(char axis, const Axis& of) {
  return fmt::format(
      "  set {0}label {1}\n  {2} logscale {0}\n  set {0}range [{3}:{4}]\n  set {0}tics {5}\n{6}", axis,
      axis_title(of), of.log ? "set" : "unset", bound(of.low), bound(of.high),
      of.step ? si_text(*of.step) : "autofreq",
      is_tiny(of) ? fmt::format("  set format {} '%g'\n", axis) : "");
}

std::string note_lines(const std::vector<Note>& notes) {
  constexpr std::array sides{"right", "center", "left"};  // of the text: a note on the left ends at its point
  constexpr std::array offsets{-0.8, 0.0, 0.8};
  std::string text = "  unset label\n";
  for (const Note& note : notes) {
    const auto side = static_cast<std::size_t>(note.side);
    text +=
        fmt::format("  set label {} at {},{} {} offset {},0 textcolor rgb '{}' front\n", literal(note.text),
                    si_text(note.x), si_text(note.y), sides[side], offsets[side], hex(note.colour));
  }
  return text;
}

/// Takes back what the scale of a panel set.
std::string after_scale(const Panel& panel) {
  const bool is_log = panel.map ? panel.map->log : panel.scale->log;
  return fmt::format("  set rmargin -1\n{}{}", is_log ? "  unset logscale cb\n" : "",
                     has_negative_scale(panel) ? "  set cblabel offset 0,0\n" : "");
}

/// What is plotted after what there already is, one stroke a line.
class Strokes {
 public:
  explicit Strokes(std::string_view command) : command_(command), separator_(command) {}
  void add(std::string_view stroke) {
    text_ += separator_;
    text_ += stroke;
    separator_ = ", \\\n       ";
  }
  /// An empty frame where there is nothing: the grid of panels stays in step.
  std::string text() const { return (text_.empty() ? command_ + "NaN notitle" : text_) + '\n'; }

 private:
  std::string command_, separator_, text_;
};

/// `1:2`, of shaded points `1:2:3`; in space one more.
std::string columns_of(const Series& series, bool in_space) {
  return fmt::format("1:2{}{}", in_space ? ":3" : "", series.shades.empty() ? "" : in_space ? ":4" : ":3");
}

void add_series(Strokes& strokes_of_panel, const Panel& panel, std::size_t index) {
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const Series& series = panel.series[i];
    if (series.mark == Mark::outside && !panel.map) continue;  // nothing lies outside
    std::vector<std::string> all = strokes(series);
    if (panel.eye && series.mark == Mark::polygon)
      all.front() = fmt::format("with polygons fs transparent solid 0.2 fc rgb '{}'", hex(series.colour));
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool named = k + 1 == all.size() && !series.label.empty();
      strokes_of_panel.add(fmt::format("{} using {} {}{}", data_name(index, i),
                                       columns_of(series, panel.eye.has_value()), all[k],
                                       named ? " title " + literal(series.label) : " notitle"));
    }
  }
}

/// Ends of an axis in space: those given, else those of the data and a little more.
std::array<double, 2> ends(const Axis& axis, const std::vector<Series>& all,
                           std::vector<double> Series::*of) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Series& series : all)
    for (const double value : series.*of)
      if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  if (!(low <= high)) low = 0, high = 1;
  const double over = high > low ? 0.05 * (high - low) : 0.5;
  return {axis.low.value_or(low - over), axis.high.value_or(high + over)};
}

/// An axis in space. No number stands so near an end that it meets that of another axis at their corner.
/// @param aside of its numbers, away from the box [characters]
std::string space_axis(char name, const Axis& of, const std::array<double, 2>& range, double aside) {
  const double span = range[1] - range[0], step = of.step.value_or(round_step(span, 5));
  const double inset = (name == 'z' ? 0.01 : 0.06) * span;
  const double first = std::ceil((range[0] + inset) / step) * step + 0.0;
  std::string text = fmt::format("  set {}label {} rotate parallel{}\n", name, axis_title(of),
                                 name == 'z' ? "" : " offset 0,-0.8");
  text += fmt::format("  unset logscale {0}\n  set {0}range [{1}:{2}]\n", name, si_text(range[0]),
                      si_text(range[1]));
  return text + fmt::format("  set {}tics {},{},{} offset {},{}\n", name, si_text(first), si_text(step),
                            si_text(range[1] - inset), si_text(aside), name == 'z' ? "0" : "-0.3");
}

/// By what a box in space is enlarged so that it fills the page: gnuplot leaves room for any turn.
double zoom(const Eye& eye, const std::array<double, 3>& box, double width, double height) {
  constexpr double wide = 0.74, high = 0.84;  // of the page; the rest is for numbers and names of axes
  constexpr double drawn = 4.0 / 7.0;         // length of the x axis, of the page's shorter side
  const double tilt = eye.tilt * std::numbers::pi / 180, turn = eye.turn * std::numbers::pi / 180;
  const double c = std::abs(std::cos(turn)), s = std::abs(std::sin(turn));
  const double across = box[0] * c + box[1] * s;
  const double up = (box[0] * s + box[1] * c) * std::abs(std::cos(tilt)) + box[2] * std::abs(std::sin(tilt));
  const double unit = drawn * std::min(width, height) / box[0];
  return std::min(wide * width / (across * unit), high * height / (up * unit));
}

/// A panel in space; what it sets is taken back for those after it.
std::string space_lines(const Panel& panel, std::size_t index, double width, double height) {
  const std::array x = ends(panel.x, panel.series, &Series::x), y = ends(panel.y, panel.series, &Series::y),
                   z = ends(panel.z, panel.series, &Series::z);
  const std::array box{x[1] - x[0], y[1] - y[0], z[1] - z[0]};
  std::string text = fmt::format("  set title {}\n  {}\n", literal(panel.title), key(panel.legend));
  const double side = std::fmod(panel.eye->turn, 180) < 90 ? 1 : -1;  // on which the y axis is seen
  text += space_axis('x', panel.x, x, -0.3 * side) + space_axis('y', panel.y, y, 0.6 * side) +
          space_axis('z', panel.z, z, 0);
  text += fmt::format(
      "  unset label\n  set size noratio\n  set lmargin 0\n  set rmargin 0\n  set bmargin 0\n  set tmargin "
      "2\n  set view equal xyz\n  set view {},{},{:.4g}\n"
      "  set xyplane at {}\n  set pm3d noborder\n  set grid xtics ytics ztics vertical\n",
      si_text(panel.eye->tilt), si_text(panel.eye->turn), zoom(*panel.eye, box, width, height),
      si_text(z[0]));
  if (panel.scale) text += scale_lines(*panel.scale, has_negative_scale(panel), false);
  Strokes all("  splot ");
  add_series(all, panel, index);
  text += all.text() + "  unset grid\n" + std::string(grid);
  text +=
      "  set xlabel '' norotate offset 0,0\n  set ylabel '' rotate offset 0,0\n  unset zlabel\n"
      "  set xtics offset 0,0\n  set ytics offset 0,0\n";
  text += "  set lmargin -1\n  set rmargin -1\n  set bmargin -1\n";
  return text + (panel.scale ? after_scale(panel) : "");
}

std::string panel_lines(const Panel& panel, std::size_t index) {
  std::string text = fmt::format("  set title {}\n", literal(panel.title));
  text += axis_lines('x', panel.x) + axis_lines('y', panel.y);
  const bool is_tight = panel.legend == Legend::below;  // gnuplot draws it over the name of the x axis
  if (is_tight) text += "  set xlabel offset 0,0.5\n";
  text +=
      fmt::format("  {}\n  set size {}\n", key(panel.legend), panel.equal_aspect ? "ratio -1" : "noratio");
  text += fmt::format("  set tmargin {}\n", panel.title.empty() ? "1.5" : "-1") + note_lines(panel.notes);
  Strokes all("  plot ");
  if (panel.map) {
    text += map_lines(*panel.map);
    all.add(map_stroke(*panel.map, index));
  } else if (panel.scale) {
    text += scale_lines(*panel.scale, has_negative_scale(panel), false);
  }
  add_series(all, panel, index);
  text += all.text() + (is_tight ? "  set xlabel offset 0,0\n" : "") + after_axes(panel);
  if (!panel.map && !panel.scale) return text;
  return text + std::string(grid) + after_scale(panel);
}

std::string terminal_line(FigureFormat format, double width, double height) {
  // The same page three times: the PNG at two pixels a unit, the PDF at 72 units an inch.
  switch (format) {
    case FigureFormat::svg:
      return fmt::format(
          "set terminal svg noenhanced size {:.0f},{:.0f} dynamic font 'sans-serif,15' background "
          "'#ffffff'",
          width, height);
    case FigureFormat::png:
      return fmt::format(
          "set terminal pngcairo noenhanced size {:.0f},{:.0f} font 'sans-serif,11.25' fontscale 2 "
          "linewidth 2 pointscale 2 background '#ffffff'",
          2 * width, 2 * height);
    case FigureFormat::pdf:
      return fmt::format(
          "set terminal pdfcairo noenhanced size {:.4f}in,{:.4f}in font 'sans-serif,15' linewidth 1 "
          "pointscale 0.75 background '#ffffff'",
          width / 72, height / 72);
  }
  return {};
}

std::string header_lines(const Figure& figure, const std::string& name, const FigureOptions& options) {
  std::string text, formats;
  for (std::string comment : figure.comments) {
    std::replace(comment.begin(), comment.end(), '\n', ' ');
    text += "# " + comment + '\n';
  }
  text += fmt::format("# Draw again: gnuplot {}.gp\n\nset encoding utf8\nset minussign\n\n", name);
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    if (figure.panels[p].map) text += data_block(map_name(p), *figure.panels[p].map) + '\n';
    for (std::size_t s = 0; s < figure.panels[p].series.size(); ++s)
      text += series_block(figure.panels[p], data_name(p, s), figure.panels[p].series[s]) + '\n';
  }
  for (const FigureFormat format : options.formats)
    formats += fmt::format("{}{}", formats.empty() ? "" : " ", extension(format));
  text += fmt::format("do for [format in '{}'] {{\n", formats);
  for (const FigureFormat format : options.formats)
    text += fmt::format("  if (format eq '{}') {{ {} }}\n", extension(format),
                        terminal_line(format, figure.width, figure.height));
  return text + fmt::format("  set output {}.'.'.format\n", literal(name));
}

}  // namespace

double round_step(double span, double most) {
  const double least = span / most;
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

std::string_view extension(FigureFormat format) noexcept {
  switch (format) {
    case FigureFormat::svg:
      return "svg";
    case FigureFormat::png:
      return "png";
    case FigureFormat::pdf:
      return "pdf";
  }
  return "svg";
}

std::string gnuplot_script(const Figure& figure, const std::string& name, const FigureOptions& options) {
  const auto columns = static_cast<std::size_t>(std::max(figure.columns, 1));
  const std::size_t rows = std::max<std::size_t>((figure.panels.size() + columns - 1) / columns, 1);
  std::string text = header_lines(figure, name, options);
  text += "  set border 31 lw 1 lc rgb '#444444'\n  set tics out nomirror\n" + std::string(grid) +
          "  set key samplen 2.5 spacing 1.25\n";
  // One margin for all, so that the axes of stacked panels stand above each other.
  const bool has_room_of_its_own = std::ranges::any_of(
      figure.panels, [](const Panel& panel) { return panel.map || panel.scale || panel.eye; });
  if (columns == 1 && !has_room_of_its_own) text += "  set lmargin 11\n  set rmargin 3\n";
  text += fmt::format("  set multiplot layout {},{}{}\n", rows, columns,
                      figure.title.empty() ? "" : " title " + literal(figure.title));
  const double width = figure.width / static_cast<double>(columns),
               height = figure.height / static_cast<double>(rows);
  for (std::size_t p = 0; p < figure.panels.size(); ++p)
    text += figure.panels[p].eye ? space_lines(figure.panels[p], p, width, height)
                                 : panel_lines(figure.panels[p], p);
  return text + "  unset multiplot\n  unset output\n}\n";
}

}  // namespace sinew::inline v0
