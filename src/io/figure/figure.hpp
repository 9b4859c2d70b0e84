/// @file figure.hpp
/// Figures: a description of curves and maps in panels, written as a gnuplot script that holds its data, and
/// drawn by gnuplot. The script is there to be edited: `gnuplot fig9.gp` in its folder draws the same files
/// again.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/figure/figure_text.hpp"
#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

/// Okabe and Ito's palette, told apart with any colour vision; grey for what is only there for orientation,
/// white for what lies on the dark of a map.
enum class Colour { black, blue, vermillion, green, orange, sky, purple, yellow, grey, white };

enum class Mark {
  line,
  dashed,
  dotted,
  points,  ///< filled dots
  line_points,
  circles,  ///< open circles, white inside: joints
  polygon,  ///< closed, filled with a pale shade of its colour
  outline,  ///< closed, not filled
  outside,  ///< closed; the map where it is not inside becomes the page's white: an edge through cells
};

/// One curve. Where a coordinate is not finite the line is interrupted.
struct Series {
  Text label;  ///< in the legend; empty: not there
  std::vector<double> x, y;
  Mark mark = Mark::line;
  Colour colour = Colour::blue;
  double width = 2;                 ///< of the line, or of the dots [points of the page]
  std::vector<double> z = {};       ///< heights, in a panel with an eye
  std::vector<double> shades = {};  ///< of Mark::points in place of one colour, on the panel's scale
};

/// Colours of cividis (dark blue to yellow; even steps for every colour vision) and the bar that explains
/// them.
struct ColourScale {
  Text label;
  std::optional<double> low = {}, high = {};  ///< ends of the colours; default: what the values need
  bool log = false;
  std::vector<std::string> words =
      {};  ///< of the values 0, 1, ...: each has one colour, and its name at the bar
};

/// Values at the points of a grid, each a cell of one colour of cividis. It lies below the curves. A value
/// that is not finite leaves its cell empty. Many cells a regular distance apart are drawn as one image, so
/// that an .svg or .pdf of a million cells opens.
struct HeatMap {
  std::vector<double> x, y;                   ///< where the columns and rows are, in order
  std::vector<double> values;                 ///< x fastest
  Text label;                                 ///< of the colour bar
  std::optional<double> low = {}, high = {};  ///< ends of the colours; default: what the values need
  bool log = false;                           ///< of the colours
  std::vector<std::string> words = {};        ///< as those of a ColourScale
};

/// A text at a point of the panel, in its coordinates.
struct Note {
  Text text;
  double x, y;
  enum class Side { left, centre, right, above, below } side = Side::right;  ///< of the point
  Colour colour = Colour::black;
  double z = 0;  ///< in a panel with an eye
};

struct Axis {
  Text label;
  std::string unit;  ///< appended in parentheses, as `unit_text` sets it; empty: none
  bool log = false;
  std::optional<double> low = {}, high = {};  ///< default: what the data need
  std::optional<double> step = {};            ///< between numbered tics; of a log axis a factor
  std::vector<std::string> words = {};        ///< at 0, 1, ... in place of numbers
};

/// From where a panel in space is seen, from far away: equal lengths along an axis look equal anywhere.
struct Eye {
  double tilt = 60;  ///< 0: from above, 90: from the side [deg]
  double turn = 30;  ///< of the panel about z [deg]
};

enum class Legend { none, top_left, top_right, bottom_left, bottom_right, below };

struct Panel {
  Text title;
  Axis x, y;
  std::vector<Series> series;
  std::vector<Note> notes = {};
  Legend legend = Legend::top_left;
  bool equal_aspect = false;  ///< a metre is as long in y as in x
  std::optional<HeatMap> map = {};
  std::optional<ColourScale> scale = {};  ///< of the series' shades, where there is no map
  Axis z = {};
  std::optional<Eye> eye = {};  ///< makes the panel one in space, x, y and z to one scale
};

/// A round distance (1, 2 or 5 times a power of ten) that is `span` / `most` or the next larger one.
double round_step(double span, double most);

/// Panels in a grid, row by row. A string is taken literally: no markup.
struct Figure {
  Text title;  ///< above the panels; may be empty
  std::vector<Panel> panels;
  int columns = 1;                    ///< of the grid
  double width = 800, height = 600;   ///< [px of the SVG, 96 an inch]; the PNG has twice as many
  std::vector<std::string> comments;  ///< at the top of the script: what this is and whence
  Text remark = {};                   ///< below the title: what is left out, say
};

enum class FigureFormat { svg, png, pdf };

std::string_view extension(FigureFormat format) noexcept;  ///< `svg`

struct FigureOptions {
  std::vector<FigureFormat> formats = {FigureFormat::svg, FigureFormat::png};
  std::string gnuplot = "gnuplot";  ///< a program on PATH, or a path to one
  bool replaces_edited_script = false;
  double width = 0;                 ///< of the page [mm]; 0: as the figure says
  std::string font = "sans-serif";  ///< letters, digits, spaces and `-_.`; anything else is left out
  double font_size = 0;             ///< [pt]; 0: 8 at a width, else 11.25
};

/// What a figure is laid out on: of the width that the options say, with no more panels side by side than
/// have room. Where they say nothing it is the figure's own.
struct PageLayout {
  double width, height;  ///< in units of 1/15 of the size of the font
  double unit;           ///< [pt]
  int columns;           ///< of the grid of panels
};
PageLayout page_of(const Figure& figure, const FigureOptions& options);

/// The script that draws `name.svg` and the like into the folder it is run in; without a name, to stdout. The
/// same figure gives the same bytes. No text of the figure, nor the name, is code in it. Its last line is a
/// checksum.
std::string gnuplot_script(const Figure& figure, const std::string& name, const FigureOptions& options = {});

/// Whether a script is as `gnuplot_script` made it; else somebody changed it.
bool is_as_written(std::string_view script);

/// Draws a figure. The files written: its script `stem.gp` first, then one for each format; all of them are
/// put in place at the end, or none. Where gnuplot is missing or fails the script alone is written. Codes:
/// `file_unwritable`, `gnuplot_missing`, `gnuplot_failed`, and `script_edited` where the script of an earlier
/// figure was changed since.
/// @param stem path without extension; its folder is made if need be
Expected<std::vector<std::filesystem::path>> write_figure(const Figure& figure,
                                                          const std::filesystem::path& stem,
                                                          const FigureOptions& options = {});

}  // namespace sinew::inline v1
