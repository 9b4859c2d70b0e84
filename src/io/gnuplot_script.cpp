#include "sinew/io/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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

/// A string of gnuplot that means exactly this text. Between single quotes only the quote itself is special.
std::string literal(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < ' ') {
      out += ' ';
    } else {
      out.append(c == '\'' ? 2 : 1, c);
    }
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

/// One point a line, an empty line where the curve is interrupted.
std::string data_block(const std::string& name, const Series& series) {
  std::string text = name + " << EOD\n";
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const bool closed = (series.mark == Mark::polygon || series.mark == Mark::outline) && count > 0;
  for (std::size_t i = 0; i < count + (closed ? 1 : 0); ++i) {
    const double x = series.x[i % count], y = series.y[i % count];
    text += std::isfinite(x) && std::isfinite(y) ? si_text(x) + ' ' + si_text(y) + '\n' : "\n";
  }
  return text + "EOD\n";
}

std::string map_name(std::size_t panel) { return fmt::format("$panel{}_map", panel + 1); }

/// Distance between neighbours; of a single place any.
double spacing(const std::vector<double>& places) {
  return places.size() > 1 ? (places.back() - places.front()) / static_cast<double>(places.size() - 1) : 1;
}

/// One cell a line: its middle, its value. An empty cell is left out.
std::string data_block(const std::string& name, const HeatMap& map) {
  std::string text = name + " << EOD\n";
  const std::size_t columns = map.x.size();
  for (std::size_t k = 0; k < std::min(map.values.size(), columns * map.y.size()); ++k)
    if (std::isfinite(map.values[k]))
      text += fmt::format("{} {} {}\n", si_text(map.x[k % columns]), si_text(map.y[k / columns]),
                          si_text(map.values[k]));
  return text + "EOD\n";
}

/// Between the outer edges of the cells.
std::array<double, 2> frame(const std::vector<double>& places) {
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
  return is_edge ? outside_block(name, series, *panel.map) : data_block(name, series);
}

/// The colours and their bar, for which gnuplot leaves too little room, and the frame just around the cells.
std::string map_lines(const HeatMap& map) {
  const auto range = [](char axis, const std::vector<double>& places) {
    const auto [low, high] = frame(places);
    return fmt::format("  set {}range [{}:{}]\n", axis, si_text(low), si_text(high));
  };
  // Cividis (Nuñez, Anderton, Renslow 2018), at equal steps.
  return fmt::format(
      "{}{}{}  set cbrange [{}:{}]\n  set cblabel {}\n  unset grid\n  set rmargin 9\n"
      "  set palette defined (0 '#00224e', 1 '#123570', 2 '#3b496c', 3 '#575d6d', 4 '#707173', 5 '#8a8678', "
      "6 '#a59c74', 7 '#c3b369', 8 '#e1cc55', 9 '#fee838')\n",
      range('x', map.x), range('y', map.y), map.log ? "  set logscale cb\n" : "", bound(map.low),
      bound(map.high), literal(map.label));
}

/// Cells reach a little over their neighbours, the further the smaller they are: else the page shines through
/// where two edges are smoothed.
std::string map_stroke(const HeatMap& map, std::size_t panel) {
  const auto reach = [](const std::vector<double>& places) {
    return si_text(std::abs(spacing(places)) * (0.52 + 0.001 * static_cast<double>(places.size())));
  };
  const std::string x = reach(map.x), y = reach(map.y);
  return fmt::format(
      "{} using 1:2:($1-{}):($1+{}):($2-{}):($2+{}):3 with boxxyerror fs solid 1 noborder lc palette notitle",
      map_name(panel), x, x, y, y);
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
      return {fmt::format("with points {} pt 7 ps {}", colour, dot)};
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

std::string axis_lines(char axis, const Axis& of) {
  return fmt::format("  set {0}label {1}\n  {2} logscale {0}\n  set {0}range [{3}:{4}]\n  set {0}tics {5}\n",
                     axis, axis_title(of), of.log ? "set" : "unset", bound(of.low), bound(of.high),
                     of.step ? si_text(*of.step) : "autofreq");
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

std::string panel_lines(const Panel& panel, std::size_t index) {
  std::string text = fmt::format("  set title {}\n", literal(panel.title));
  text += axis_lines('x', panel.x) + axis_lines('y', panel.y);
  text +=
      fmt::format("  {}\n  set size {}\n", key(panel.legend), panel.equal_aspect ? "ratio -1" : "noratio");
  text += fmt::format("  set tmargin {}\n", panel.title.empty() ? "1.5" : "-1") + note_lines(panel.notes);
  std::string separator = "  plot ";
  if (panel.map) {
    text += map_lines(*panel.map) + separator + map_stroke(*panel.map, index);
    separator = ", \\\n       ";
  }
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    if (panel.series[i].mark == Mark::outside && !panel.map) continue;  // nothing lies outside
    const std::vector<std::string> all = strokes(panel.series[i]);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::string& label = panel.series[i].label;
      const bool named = k + 1 == all.size() && !label.empty();
      text += separator + data_name(index, i) + " using 1:2 " + all[k] +
              (named ? " title " + literal(label) : " notitle");
      separator = ", \\\n       ";
    }
  }
  if (separator == "  plot ") text += "  plot NaN notitle";  // an empty frame, and the grid stays in step
  if (!panel.map) return text + "\n";
  return text + "\n" + std::string(grid) + "  set rmargin -1\n" +
         (panel.map->log ? "  unset logscale cb\n" : "");
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
  const bool has_map =
      std::ranges::any_of(figure.panels, [](const Panel& panel) { return panel.map.has_value(); });
  if (columns == 1 && !has_map) text += "  set lmargin 11\n  set rmargin 3\n";
  text += fmt::format("  set multiplot layout {},{}{}\n", rows, columns,
                      figure.title.empty() ? "" : " title " + literal(figure.title));
  for (std::size_t p = 0; p < figure.panels.size(); ++p) text += panel_lines(figure.panels[p], p);
  return text + "  unset multiplot\n  unset output\n}\n";
}

}  // namespace sinew::inline v0
