#include "io/figure/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"

namespace sinew::inline v1 {
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

/// Bytes that mean themselves in any string of gnuplot. No quote, backslash, backtick, bracket of a block or
/// sign of a macro is among them.
bool is_plain(char c) {
  constexpr std::string_view others = " _.,:;()+-*/=<>[]^!?%&~";
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80 || std::isalnum(byte) || others.find(c) != std::string_view::npos;
}

/// A string of gnuplot that is exactly these bytes. What is not plain is written as its octal number, which
/// gnuplot puts in after it has found where the string ends and what in it is a command.
std::string literal_bytes(std::string_view bytes) {
  if (std::ranges::all_of(bytes, is_plain)) return fmt::format("'{}'", bytes);
  std::string out = "\"";
  bool follows_number = false;  // whose digits gnuplot reads on, however many
  for (const char c : bytes) {
    const bool is_number = !is_plain(c) || (follows_number && std::isdigit(static_cast<unsigned char>(c)));
    out += is_number ? fmt::format("\\{:03o}", unsigned{static_cast<unsigned char>(c)}) : std::string(1, c);
    follows_number = is_number;
  }
  return out + '"';
}

/// On one line, each sign of gnuplot's markup as itself.
std::string escaped(std::string_view text) {
  constexpr std::string_view signs = "{}^_@&~\\";
  std::string out;
  for (const char c : visible_line(text)) {
    if (signs.find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

/// In gnuplot's markup, which the parts alone decide about.
std::string markup(const Text& text) {
  std::string out;
  for (const Text::Part& part : text.parts()) {
    const std::string inside = escaped(part.text);
    switch (part.style) {
      case Text::Style::upright:
        out += inside;
        break;
      case Text::Style::italic:
        out += "{/:Italic " + inside + '}';
        break;
      case Text::Style::subscript:
        out += "_{" + inside + '}';
        break;
      case Text::Style::superscript:
        out += "^{" + inside + '}';
        break;
    }
  }
  return out;
}

/// Of a character, about: a page's unit is 1/15 of the size of the font.
constexpr double character_width = 8.6, line_height = 19;

/// Characters of UTF-8.
std::size_t length(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

double width_of(const Text& text) { return character_width * static_cast<double>(length(text.plain())); }

/// Broken at spaces into lines of at most this width, where words allow; as even as few lines can be.
std::vector<Text> lines_of(const Text& text, double width) {
  const double whole = width_of(text), count = std::ceil(whole / std::max(width, 1.0));
  if (count <= 1) return {text};
  const double most = std::min(width, whole / count + 8 * character_width);
  std::vector<Text> lines(1);
  Text word;
  const auto end_word = [&] {
    const bool is_first = lines.back().empty();
    if (!is_first && width_of(lines.back()) + width_of(word) > most) {
      lines.emplace_back();
      std::string bare = word.parts().empty() ? "" : word.parts().front().text;
      Text rest(std::string_view(bare).substr(bare.starts_with(' ') ? 1 : 0),
                word.parts().empty() ? Text::Style::upright : word.parts().front().style);
      for (std::size_t k = 1; k < word.parts().size(); ++k)
        rest += Text(word.parts()[k].text, word.parts()[k].style);
      word = std::move(rest);
    }
    lines.back() += word;
    word.clear();
  };
  for (const Text::Part& part : text.parts()) {
    std::string_view rest = part.text;
    for (std::size_t space = rest.find(' ', 1); space != std::string_view::npos; space = rest.find(' ', 1)) {
      word += Text(rest.substr(0, space), part.style);
      end_word();
      rest.remove_prefix(space);
    }
    if (rest.starts_with(' ') && !word.empty()) end_word();
    word += Text(rest, part.style);
  }
  end_word();
  return lines;
}

/// A string of gnuplot that shows these lines.
std::string literal(const std::vector<Text>& lines) {
  std::string bytes;
  for (const Text& line : lines) bytes += (&line == lines.data() ? "" : "\n") + markup(line);
  return literal_bytes(bytes);
}

/// A string of gnuplot that shows this text, on one line.
std::string literal(const Text& text) { return literal_bytes(markup(text)); }

/// The room that panels have on their page.
struct Cell {
  double width, height;  ///< [units of the page]
  double right;          ///< of its right edge, of the page's width
  double page_width;
};

/// A line that gnuplot skips: no end of a line, nor a backslash, which would go on with the next one.
std::string comment(std::string_view text) {
  std::string line(text);
  std::ranges::replace(line, '\n', ' ');
  line = visible_line(line);
  std::ranges::replace(line, '\\', '/');
  return "# " + line + '\n';
}

std::string axis_title(const Axis& axis, double room) {
  return literal(lines_of(with_unit(axis.label, axis.unit), room));
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
  constexpr std::size_t max_rectangles = 20000;
  return map.x.size() * map.y.size() > max_rectangles && map.x.size() > 1 && map.y.size() > 1 &&
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

/// `('converged' 0, 'unstable' 1)`
std::string word_tics(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += fmt::format("{}{} {}", k == 0 ? "(" : ", ", literal(words[k]), k);
  return text + ')';
}

/// Cividis (Nuñez, Anderton, Renslow 2018), at equal steps.
constexpr std::array<unsigned, 10> cividis{0x00224e, 0x123570, 0x3b496c, 0x575d6d, 0x707173,
                                           0x8a8678, 0xa59c74, 0xc3b369, 0xe1cc55, 0xfee838};

/// Its colour at a part of the way.
unsigned cividis_at(double part) {
  const double place = part * (cividis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), cividis.size() - 2);
  unsigned colour = 0;
  for (const unsigned shift : {16U, 8U, 0U}) {
    const auto channel = [&](std::size_t k) { return static_cast<double>(cividis[k] >> shift & 0xffU); };
    const double mixed = std::lerp(channel(below), channel(below + 1), place - static_cast<double>(below));
    colour |= static_cast<unsigned>(std::lround(mixed)) << shift;
  }
  return colour;
}

/// Of numbers shades that run into each other, of words one colour each.
std::string palette(std::size_t words) {
  std::string text;
  const auto add = [&text](double at, unsigned colour) {
    text += fmt::format("{}{} '#{:06x}'", text.empty() ? "" : ", ", at, colour);
  };
  for (std::size_t k = 0; words == 0 && k < cividis.size(); ++k) add(static_cast<double>(k), cividis[k]);
  for (std::size_t k = 0; k < words; ++k) {
    const unsigned colour =
        cividis_at(words > 1 ? static_cast<double>(k) / static_cast<double>(words - 1) : 0.5);
    add(static_cast<double>(k), colour);
    add(static_cast<double>(k + 1), colour);
  }
  return fmt::format("  set palette defined ({})\n", text);
}

/// Ends of the values that colours show.
std::array<double, 2> ends_of(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  return low <= high ? std::array{low, high} : std::array{0.0, 1.0};
}

/// What stands at a bar of colours: its numbers and how wide they are.
struct BarTics {
  std::string tics;
  double characters;
};

BarTics bar_tics(const ColourScale& scale, const std::array<double, 2>& values, double height) {
  if (!scale.words.empty()) {
    std::size_t longest = 0;
    for (const std::string& word : scale.words) longest = std::max(longest, length(visible_line(word)));
    return {word_tics(scale.words), static_cast<double>(longest)};
  }
  if (scale.log) return {"autofreq", 6};
  const double low = scale.low.value_or(values[0]), high = scale.high.value_or(values[1]);
  if (!(low < high)) return {"autofreq", 8};
  const double step = round_step(high - low, std::clamp(std::floor(height / (2.2 * line_height)), 2.0, 10.0));
  std::size_t longest = 0;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high * (1 + 1e-9) && longest < 20; ++k)
    longest = std::max(longest, fmt::format("{:.6g}", k * step + 0.0).size());
  return {si_text(step), static_cast<double>(longest)};
}

/// The colours and their bar. gnuplot leaves too little room for its numbers and its name: these stand clear
/// of each other and of what is beside the panel.
std::string scale_lines(const ColourScale& scale, const std::array<double, 2>& values, bool has_cells,
                        const Cell& cell) {
  const double inside = cell.height - 4.5 * line_height;
  const std::vector<Text> label = lines_of(scale.label, inside);
  const auto [tics, characters] = bar_tics(scale, values, inside);
  const double beside = 34 + 10 * characters + line_height * static_cast<double>(label.size()) + 12;
  const double room = (0.075 * (cell.width - 80) + beside) / 1.075;
  return fmt::format(
             "{}  set cbrange [{}:{}]\n  set cbtics {}\n  set cblabel {} offset {:.2f},0\n{}  set rmargin at "
             "screen {:.4f}\n",
             scale.log ? "  set logscale cb\n" : "", scale.words.empty() ? bound(scale.low) : "-0.5",
             scale.words.empty() ? bound(scale.high) : fmt::format("{}.5", scale.words.size() - 1), tics,
             literal(label), 0.6 + 0.25 * characters, has_cells ? "  unset grid\n" : "",
             cell.right - room / cell.page_width) +
         palette(scale.words.size());
}

/// The frame just around the cells, and their colours.
std::string map_lines(const HeatMap& map, const Cell& cell) {
  const auto range = [](char axis, const std::vector<double>& places) {
    const auto [low, high] = frame(places);
    return fmt::format("  set {}range [{}:{}]\n", axis, si_text(low), si_text(high));
  };
  return range('x', map.x) + range('y', map.y) +
         scale_lines({map.label, map.low, map.high, map.log, map.words}, ends_of(map.values), true, cell);
}

/// Of the points that have a shade.
std::string shade_lines(const Panel& panel, const Cell& cell) {
  std::vector<double> values;
  for (const Series& series : panel.series)
    values.insert(values.end(), series.shades.begin(), series.shades.end());
  return scale_lines(*panel.scale, ends_of(values), false, cell);
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

/// What is beside the text of an entry of the legend.
constexpr double key_sample = 70;

/// What a legend has for texts beside the samples of its lines, within axes or below them.
double key_room(const Panel& panel, double width) {
  const double beside = panel.map || panel.scale ? 230 : 110;
  return width - beside - key_sample;
}

/// The name of a series as a legend shows it.
std::vector<Text> key_lines(const Panel& panel, const Series& series, double width) {
  constexpr double safe = 1.1;  // letters are not all as wide as one is on average
  if (panel.eye) return {series.label};
  return lines_of(series.label, std::max(key_room(panel, width), 8 * character_width) / safe);
}

/// Rows of the legend below the panel: as many entries side by side as have room under its axes, as gnuplot
/// has it.
std::size_t key_rows(const Panel& panel, double width) {
  double widest = 0;
  std::size_t count = 0, lines = 0;
  for (const Series& series : panel.series) {
    if (series.label.empty()) continue;
    widest = std::max(widest, 1.1 * width_of(series.label));
    ++count, lines += key_lines(panel, series, width).size();
  }
  if (count == 0) return 0;
  const auto columns = static_cast<std::size_t>(
      std::max(1.0, std::floor((key_room(panel, width) + key_sample) / (widest + key_sample))));
  return columns == 1 ? lines : (count + columns - 1) / columns;
}

std::string key(const Panel& panel, double width) {
  switch (panel.legend) {
    case Legend::none:
      return "unset key";
    case Legend::top_left:
      return "set key inside top left Left reverse maxrows auto";
    case Legend::top_right:
      return "set key inside top right Left reverse maxrows auto";
    case Legend::bottom_left:
      return "set key inside bottom left Left reverse maxrows auto";
    case Legend::bottom_right:
      return "set key inside bottom right Left reverse maxrows auto";
    case Legend::below:
      return fmt::format("set key below center Left reverse maxrows {}",
                         std::max<std::size_t>(key_rows(panel, width), 1));
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

/// The numbers of an axis as far apart as it wants them, or further, where they would run into each other.
double step_with_room(const Axis& of, double room) {
  if (!of.low || !of.high || of.log) return *of.step;
  const double span = std::abs(*of.high - *of.low);
  const auto characters = [&](double end) { return si_text(std::trunc(end / *of.step) * *of.step).size(); };
  const std::size_t widest = std::max(characters(*of.low), characters(*of.high));
  const double most = room / (character_width * (static_cast<double>(widest) + 1.5));
  return std::max(*of.step, round_step(span, std::max(most, 1.0)));
}

std::string axis_lines(char axis, const Axis& of, double room) {
  return fmt::format(
      "  set {0}label {1}\n  {2} logscale {0}\n  set {0}range [{3}:{4}]\n  set {0}tics {5}\n{6}", axis,
      axis_title(of, room), of.log ? "set" : "unset", bound(of.low), bound(of.high),
      !of.words.empty() ? word_tics(of.words)
      : of.step         ? si_text(axis == 'x' ? step_with_room(of, room) : *of.step)
                        : "autofreq",
      is_tiny(of) ? fmt::format("  set format {} '10^{{%L}}'\n", axis) : "");
}

std::string note_lines(const Panel& panel) {
  // Of the text: a note on the left ends at its point.
  constexpr std::array sides{"right", "center", "left", "center", "center"};
  constexpr std::array offsets{"-0.8,0", "0,0", "0.8,0", "0,0.8", "0,-0.8"};
  std::string text = "  unset label\n";
  for (const Note& note : panel.notes) {
    const auto side = static_cast<std::size_t>(note.side);
    text += fmt::format("  set label {} at {},{}{} {} offset {} textcolor rgb '{}' front\n",
                        literal(note.text), si_text(note.x), si_text(note.y),
                        panel.eye ? "," + si_text(note.z) : "", sides[side], offsets[side], hex(note.colour));
  }
  return text;
}

/// Takes back what the scale of a panel set.
std::string after_scale(const Panel& panel) {
  const bool is_log = panel.map ? panel.map->log : panel.scale->log;
  return fmt::format("  set rmargin -1\n  set cbtics autofreq\n{}", is_log ? "  unset logscale cb\n" : "");
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

/// @param width of the panel, in which its legend has to have room
void add_series(Strokes& strokes_of_panel, const Panel& panel, std::size_t index, double width) {
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const Series& series = panel.series[i];
    if (series.mark == Mark::outside && !panel.map) continue;  // nothing lies outside
    std::vector<std::string> all = strokes(series);
    if (panel.eye && series.mark == Mark::polygon)
      all.front() = fmt::format("with polygons fs transparent solid 0.2 fc rgb '{}'", hex(series.colour));
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool named = k + 1 == all.size() && !series.label.empty();
      const std::vector<Text> lines = named ? key_lines(panel, series, width) : std::vector<Text>{};
      strokes_of_panel.add(fmt::format("{} using {} {}{}", data_name(index, i),
                                       columns_of(series, panel.eye.has_value()), all[k],
                                       named ? " title " + literal(lines.front()) : " notitle"));
      // gnuplot gives an entry one line
      for (std::size_t line = 1; line < lines.size(); ++line)
        strokes_of_panel.add("keyentry with lines lt nodraw title " + literal(lines[line]));
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
  std::string text = fmt::format("  set {}label {} rotate parallel{}\n", name, axis_title(of, 1e9),
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
std::string space_lines(const Panel& panel, std::size_t index, const Cell& cell) {
  const std::array x = ends(panel.x, panel.series, &Series::x), y = ends(panel.y, panel.series, &Series::y),
                   z = ends(panel.z, panel.series, &Series::z);
  const std::array box{x[1] - x[0], y[1] - y[0], z[1] - z[0]};
  std::string text = fmt::format("  set title {}\n  {}\n", literal(lines_of(panel.title, 0.9 * cell.width)),
                                 key(panel, cell.width));
  const double side = std::fmod(panel.eye->turn, 180) < 90 ? 1 : -1;  // on which the y axis is seen
  text += space_axis('x', panel.x, x, -0.3 * side) + space_axis('y', panel.y, y, 0.6 * side) +
          space_axis('z', panel.z, z, 0);
  text += fmt::format(
      "  set size noratio\n  set lmargin 0\n  set rmargin 0\n  set bmargin 0\n  set tmargin "
      "2\n  set view equal xyz\n  set view {},{},{:.4g}\n"
      "  set xyplane at {}\n  set pm3d noborder\n  set grid xtics ytics ztics vertical\n",
      si_text(panel.eye->tilt), si_text(panel.eye->turn), zoom(*panel.eye, box, cell.width, cell.height),
      si_text(z[0]));
  text += note_lines(panel);
  if (panel.scale) text += shade_lines(panel, cell);
  Strokes all("  splot ");
  add_series(all, panel, index, cell.width);
  text += all.text() + "  unset grid\n" + std::string(grid);
  text +=
      "  set xlabel '' norotate offset 0,0\n  set ylabel '' rotate offset 0,0\n  unset zlabel\n"
      "  set xtics offset 0,0\n  set ytics offset 0,0\n";
  text += "  set lmargin -1\n  set rmargin -1\n  set bmargin -1\n";
  return text + (panel.scale ? after_scale(panel) : "");
}

std::string panel_lines(const Panel& panel, std::size_t index, const Cell& cell) {
  std::string text = fmt::format("  set title {}\n", literal(lines_of(panel.title, 0.85 * cell.width)));
  const double across = cell.width - (panel.map || panel.scale ? 230 : 110);
  const double up = cell.height - 4.5 * line_height;
  text += axis_lines('x', panel.x, across) + axis_lines('y', panel.y, up);
  const bool is_below = panel.legend == Legend::below;  // gnuplot draws it over the name of the x axis
  const std::size_t rows = is_below ? key_rows(panel, cell.width) : 0;
  if (is_below) text += fmt::format("  set bmargin {:.4g}\n", 4 + 1.35 * static_cast<double>(rows));
  text += fmt::format("  {}\n  set size {}\n", key(panel, cell.width),
                      panel.equal_aspect ? "ratio -1" : "noratio");
  text += fmt::format("  set tmargin {}\n", panel.title.empty() ? "1.5" : "-1") + note_lines(panel);
  Strokes all("  plot ");
  if (panel.map) {
    text += map_lines(*panel.map, cell);
    all.add(map_stroke(*panel.map, index));
  } else if (panel.scale) {
    text += shade_lines(panel, cell);
  }
  add_series(all, panel, index, cell.width);
  text += all.text() + (is_below ? "  set bmargin -1\n" : "") + after_axes(panel);
  if (!panel.map && !panel.scale) return text;
  return text + std::string(grid) + after_scale(panel);
}

/// The title, and below it what the figure leaves out; an empty one takes no room.
std::vector<Text> title_lines(const Figure& figure, double width) {
  std::vector<Text> all;
  for (const Text& text : {figure.title, figure.remark})
    if (!text.empty())
      for (Text& line : lines_of(text, 0.95 * width)) all.push_back(std::move(line));
  return all;
}

constexpr double points_per_inch = 72;

/// Pixels an inch: of a printed page what journals ask for, of the screen's two for each of its own.
double png_resolution(const FigureOptions& options) { return options.width > 0 ? 300 : 192; }

/// The name of a font: what of it is no name could be more than that in an SVG.
std::string font_name(const std::string& font) {
  std::string name;
  for (const char c : font)
    if (std::isalnum(static_cast<unsigned char>(c)) || c == ' ' || c == '-' || c == '_' || c == '.')
      name += c;
  return name.empty() ? "sans-serif" : name;
}

std::string terminal_line(FigureFormat format, const PageLayout& page, const FigureOptions& options) {
  // The same page three times; the SVG in its own units.
  const std::string font = font_name(options.font);
  switch (format) {
    case FigureFormat::svg:
      return fmt::format(
          "set terminal svg enhanced size {:.0f},{:.0f} dynamic font '{},15' background '#ffffff'",
          page.width, page.height, font);
    case FigureFormat::png: {
      const double pixels = page.unit * png_resolution(options) / points_per_inch;  // a unit
      return fmt::format(
          "set terminal pngcairo enhanced size {:.0f},{:.0f} font '{},11.25' fontscale {:.6g} linewidth "
          "{:.6g} pointscale {:.6g} background '#ffffff'",
          pixels * page.width, pixels * page.height, font, pixels, pixels, pixels);
    }
    case FigureFormat::pdf:
      return fmt::format(
          "set terminal pdfcairo enhanced size {:.4f}in,{:.4f}in font '{},{:.6g}' linewidth {:.6g} "
          "pointscale {:.6g} background '#ffffff'",
          page.unit * page.width / points_per_inch, page.unit * page.height / points_per_inch, font,
          15 * page.unit, page.unit, 0.75 * page.unit);
  }
  return {};
}

std::string header_lines(const Figure& figure, const std::string& name, const FigureOptions& options) {
  std::string text, formats;
  for (const std::string& line : figure.comments) text += comment(line);
  if (!name.empty()) text += comment(fmt::format("Draw again: gnuplot {}.gp", name));
  text += "\nset encoding utf8\nset minussign\n\n";
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
                        terminal_line(format, page_of(figure, options), options));
  // "./": a name that begins with a bar would be a command. Without a name: to stdout.
  return name.empty() ? text
                      : text + fmt::format("  set output {}.format\n", literal_bytes("./" + name + '.'));
}

/// Fowler, Noll and Vo: tells what a person changed, not what somebody forged.
std::uint64_t checksum(std::string_view text) {
  std::uint64_t sum = 0xcbf29ce484222325U;
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return sum;
}

/// The last line of a script.
std::string seal(std::string_view script) {
  return fmt::format("# As sinew wrote it: {:016x}\n", checksum(script));
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

PageLayout page_of(const Figure& figure, const FigureOptions& options) {
  constexpr double screen = 11.25, print = 8;  // [pt]
  const double size = options.font_size > 0 ? options.font_size : options.width > 0 ? print : screen;
  const double unit = size / 15;
  const int columns = std::max(figure.columns, 1);
  const auto count = std::max<std::size_t>(figure.panels.size(), 1);
  if (!(options.width > 0) && size == screen) return {figure.width, figure.height, unit, columns};
  const double points = options.width > 0 ? options.width / 25.4 * 72 : 0.75 * figure.width;
  PageLayout page{points / unit, 0, unit, columns};
  constexpr double narrowest = 330;  // that a panel with its numbers still is one
  page.columns = std::clamp(static_cast<int>(page.width / narrowest), 1, columns);
  const auto rows_of = [count](int side) {
    return static_cast<double>((count + static_cast<std::size_t>(side) - 1) / static_cast<std::size_t>(side));
  };
  // What is inside of the axes keeps its form; the room that texts need around it does not change.
  const bool has_bar = std::ranges::any_of(
      figure.panels, [](const Panel& panel) { return panel.map.has_value() || panel.scale.has_value(); });
  double below = 0;
  const double before = figure.width / columns, now = page.width / page.columns;
  for (const Panel& panel : figure.panels)
    if (panel.legend == Legend::below)
      below = std::max(below, 1.35 * line_height *
                                  (static_cast<double>(key_rows(panel, now)) -
                                   static_cast<double>(key_rows(panel, before))));
  const double beside = has_bar ? 230 : 110, above = 95;
  const double titles = line_height * static_cast<double>(title_lines(figure, page.width).size());
  const double form = (figure.height / rows_of(columns) - above) / std::max(before - beside, 1.0);
  const double inside = std::max(now - beside, 60.0) * std::clamp(form, 0.3, 3.0);
  page.height = rows_of(page.columns) * (inside + above + std::max(below, 0.0)) + titles;
  return page;
}

std::string gnuplot_script(const Figure& figure, const std::string& name, const FigureOptions& options) {
  const PageLayout page = page_of(figure, options);
  const auto columns = static_cast<std::size_t>(page.columns);
  const std::size_t rows = std::max<std::size_t>((figure.panels.size() + columns - 1) / columns, 1);
  std::string text = header_lines(figure, name, options);
  text += "  set border 31 lw 1 lc rgb '#444444'\n  set tics out nomirror\n" + std::string(grid) +
          "  set key samplen 2.5 spacing 1.25\n";
  const std::vector<Text> title = title_lines(figure, page.width);
  const double width = page.width / static_cast<double>(columns);
  const double height =
      (page.height - line_height * static_cast<double>(title.size())) / static_cast<double>(rows);
  // One margin for all, so that the axes of stacked panels stand above each other.
  const bool has_room_of_its_own = std::ranges::any_of(figure.panels, [](const Panel& panel) {
    return panel.map || panel.scale || panel.eye || !panel.y.words.empty();
  });
  if (columns == 1 && !has_room_of_its_own) text += "  set lmargin 11\n  set rmargin 3\n";
  text += fmt::format("  set multiplot layout {},{}{}\n", rows, columns,
                      title.empty() ? "" : " title " + literal(title));
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const Cell cell{width, height, static_cast<double>(p % columns + 1) / static_cast<double>(columns),
                    page.width};
    text += figure.panels[p].eye ? space_lines(figure.panels[p], p, cell)
                                 : panel_lines(figure.panels[p], p, cell);
  }
  text += "  unset multiplot\n  unset output\n}\n";
  return name.empty() ? text : text + seal(text);
}

bool is_as_written(std::string_view script) {
  const std::size_t size = seal({}).size();
  return script.size() >= size &&
         script.substr(script.size() - size) == seal(script.substr(0, script.size() - size));
}

}  // namespace sinew::inline v1
