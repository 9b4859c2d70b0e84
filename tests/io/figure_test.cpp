#include "io/figure/figure.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <limits>

namespace figure_test {

using namespace sinew;
namespace fs = std::filesystem;

/// A folder of this process that goes with it.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("sinew_figure_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

std::string bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr std::string_view awkward = "U_p^{2} <b> & \"q\" it's `date` $x \\n ‖Uₚ‖ @here %d";

Figure one_of_each() {
  Panel panel{.title = std::string(awkward),
              .x = {.label = "x_1", .unit = "m"},
              .y = {.label = "y", .unit = "", .log = true, .low = 0.5, .high = 200},
              .series = {},
              .notes = {{"left", 2, 2, Note::Side::left}, {"it's here", 2, 4, Note::Side::centre}}};
  double height = 1;
  for (const Mark mark : {Mark::line, Mark::dashed, Mark::dotted, Mark::points, Mark::line_points,
                          Mark::circles, Mark::polygon, Mark::outline}) {
    Series series{.label = "m_" + std::to_string(height), .x = {0, 1, 2, 3}, .y = {}, .mark = mark};
    for (int i = 0; i < 4; ++i) series.y.push_back(height * (i + 1));
    panel.series.push_back(series);
    height *= 1.6;
  }
  panel.series[0].y[1] = std::numeric_limits<double>::quiet_NaN();
  Panel square{.title = "",
               .x = {.label = "x", .unit = "mm", .step = 1},
               .y = {.label = "y", .unit = "mm"},
               .series = {{.label = "", .x = {0, 1, 1, 0}, .y = {0, 0, 1, 1}, .mark = Mark::polygon}},
               .notes = {},
               .legend = Legend::none,
               .equal_aspect = true};
  const double missing = std::numeric_limits<double>::quiet_NaN();
  Panel map{
      .title = "map",
      .x = {.label = "x", .unit = "mm"},
      .y = {.label = "phi", .unit = "deg"},
      .series = {{.label = "", .x = {-1, 1}, .y = {5, 15}}},
      .legend = Legend::none,
      .map = HeatMap{.x = {-1, 0, 1}, .y = {5, 15}, .values = {1, 2, missing, 4, 5, 6}, .label = "it's κ"}};
  Panel space{.title = std::string(awkward),
              .x = {.label = std::string(awkward), .unit = "mm"},
              .y = {.label = "y", .unit = "mm"},
              .series = {},
              .legend = Legend::top_left,
              .z = {.label = "it's z", .unit = "mm", .low = 0, .high = 10},
              .eye = Eye{.tilt = 70, .turn = 40}};
  for (const Mark mark : {Mark::line, Mark::dashed, Mark::circles, Mark::polygon, Mark::points})
    space.series.push_back(
        {.label = "it's", .x = {0, 1, 2, 0}, .y = {0, 1, 0, 1}, .mark = mark, .z = {0, 5, 5, 9}});
  Panel cloud{
      .title = "",
      .x = {.label = "x", .unit = "mm"},
      .y = {.label = "y", .unit = "mm"},
      .series =
          {{.label = "", .x = {0, 1, 2}, .y = {1, 2, 3}, .mark = Mark::points, .shades = {-5, missing, 7}}},
      .legend = Legend::below,
      .scale = ColourScale{.label = std::string(awkward)}};
  return {.title = "three panels",
          .panels = {panel, square, map, space, cloud},
          .columns = 3,
          .width = 900,
          .height = 450,
          .comments = {"a test\nset output 'elsewhere'"}};
}

/// Big-endian number of a PNG's header.
unsigned png_number(const std::string& png, std::size_t at) {
  unsigned value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(png[at + i]);
  return value;
}

TEST(Figure, TheScriptHoldsItsDataAndNoDate) {
  const std::string script = gnuplot_script(one_of_each(), "f");
  EXPECT_EQ(script, gnuplot_script(one_of_each(), "f"));
  EXPECT_TRUE(script.starts_with("# a test set output 'elsewhere'\n"));  // a comment stays one
  EXPECT_NE(script.find("$panel1_1 << EOD\n0 1\n\n2 3\n3 4\nEOD\n"), std::string::npos)
      << "a gap is an empty line";
  EXPECT_NE(script.find("$panel2_1 << EOD\n0 0\n1 0\n1 1\n0 1\n0 0\nEOD\n"), std::string::npos) << "closed";
  EXPECT_NE(script.find("$panel3_map << EOD\n-1 5 1\n0 5 2\n-1 15 4\n0 15 5\n1 15 6\nEOD\n"),
            std::string::npos)
      << "a cell without a value is left out";
  EXPECT_NE(script.find(R"x(set xlabel "x\134_1 (m)")x"), std::string::npos);
  EXPECT_NE(script.find(R"(\042q\042 it\047s \140date\140 \044x \134\134n)"), std::string::npos);
  EXPECT_EQ(script.find('`'), std::string::npos);
  EXPECT_EQ(script.find("/tmp"), std::string::npos);
}

TEST(Figure, DrawsEveryMarkInEveryFormatAndTheSameBytesAgain) {
  const Folder folder;
  const FigureOptions all{.formats = {FigureFormat::svg, FigureFormat::png, FigureFormat::pdf}};
  const auto files = write_figure(one_of_each(), folder.path / "new" / "it's a_figure", all);
  ASSERT_TRUE(files) << to_string(files.error());
  ASSERT_EQ(files->size(), 4U);
  std::vector<std::string> first;
  for (const fs::path& file : *files) first.push_back(bytes(file));

  EXPECT_TRUE(first[1].starts_with("<?xml"));
  EXPECT_NE(first[1].find("<svg"), std::string::npos);
  EXPECT_NE(first[1].find("</svg>"), std::string::npos);
  EXPECT_NE(first[1].find("U_p^{2} &lt;b> &amp; \"q\" it's `date` $x \\n ‖Uₚ‖ @here %d"), std::string::npos);
  EXPECT_TRUE(first[2].starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(png_number(first[2], 16), 1800U);
  EXPECT_EQ(png_number(first[2], 20), 900U);
  EXPECT_GT(first[2].size(), 10000U);
  EXPECT_TRUE(first[3].starts_with("%PDF-"));
  EXPECT_EQ(first[3].find("/CreationDate (D:20"), std::string::npos);

  ASSERT_TRUE(write_figure(one_of_each(), folder.path / "new" / "it's a_figure", all));
  for (std::size_t i = 0; i < files->size(); ++i) EXPECT_EQ(bytes((*files)[i]), first[i]) << (*files)[i];
}

TEST(FigureText, SetsSymbolsOfOursAndUnitsAndNothingElse) {
  using Style = Text::Style;
  const Text pose = formula("‖U_p‖ of x^-2");
  ASSERT_EQ(pose.parts().size(), 6U);
  EXPECT_EQ(pose.parts()[1], (Text::Part{"U", Style::italic}));
  EXPECT_EQ(pose.parts()[2], (Text::Part{"p", Style::subscript}));
  EXPECT_EQ(pose.parts()[5], (Text::Part{"−2", Style::superscript}));
  EXPECT_EQ(with_unit("v_{2}", "").parts().size(), 1U);
  EXPECT_EQ(with_unit(formula("φ"), "deg").plain(), "φ (°)");
  EXPECT_EQ(unit_text("10⁻⁶ m^4").parts().back(), (Text::Part{"4", Style::superscript}));
  EXPECT_EQ(unit_text("m_{2} ^x").parts().size(), 1U) << "what is no unit is literal";
}

TEST(Figure, HasTheWidthThatIsAskedForInEveryFormat) {
  const Folder folder;
  const FigureOptions paper{.formats = {FigureFormat::svg, FigureFormat::png, FigureFormat::pdf},
                            .width = 85,
                            .font = "DejaVu Sans' onload='x"};
  const Figure figure = one_of_each();
  const auto files = write_figure(figure, folder.path / "f", paper);
  ASSERT_TRUE(files) << to_string(files.error());
  const std::string svg = bytes((*files)[1]), png = bytes((*files)[2]), pdf = bytes((*files)[3]);
  EXPECT_NE(svg.find("<svg \n width=\"85mm\" height=\""), std::string::npos) << svg.substr(0, 200);
  EXPECT_EQ(svg.find("onload="), std::string::npos);  // a name of a font is no markup
  EXPECT_NEAR(png_number(png, 16), 85 / 25.4 * 300, 1);
  EXPECT_EQ(png.substr(37, 4), "pHYs");
  EXPECT_NE(pdf.find("/MediaBox [ 0 0 240"), std::string::npos);
  EXPECT_EQ(page_of(figure, paper).columns, 1) << "three panels side by side have no room";
  EXPECT_EQ(page_of(figure, {.width = 180}).columns, 2);
  EXPECT_EQ(page_of(figure, {}).width, 900);
}

TEST(Figure, AnEmptyPanelIsAnEmptyFrame) {
  const Folder folder;
  const Panel empty{.title = "nothing",
                    .x = {.label = "x", .unit = "", .low = 0, .high = 1},
                    .y = {.label = "y", .unit = "", .low = 0, .high = 1},
                    .series = {}};
  const auto files = write_figure({.title = "", .panels = {empty}, .comments = {}}, folder.path / "f");
  EXPECT_TRUE(files) << to_string(files.error());
}

TEST(Figure, TheFrameOfAMapIsAroundItsCellsAndItsColoursAreLabelled) {
  const std::string script = gnuplot_script(one_of_each(), "f");
  EXPECT_NE(script.find("set xrange [-1.5:1.5]"), std::string::npos);
  EXPECT_NE(script.find("set yrange [0:20]"), std::string::npos);
  EXPECT_NE(script.find("set cbrange [*:*]"), std::string::npos);
  EXPECT_NE(script.find(R"(set cblabel "it\047s κ")"), std::string::npos);
}

TEST(Figure, AMapWithoutAnyValueIsAnEmptyFrame) {
  const Folder folder;
  const double missing = std::numeric_limits<double>::quiet_NaN();
  for (const bool has_range : {true, false}) {
    HeatMap map{.x = {0, 1}, .y = {0, 1}, .values = std::vector<double>(4, missing), .label = "v"};
    if (has_range) map.low = 0, map.high = 1;
    const Panel empty{.title = "",
                      .x = {.label = "x", .unit = ""},
                      .y = {.label = "y", .unit = ""},
                      .series = {},
                      .map = map};
    const auto files = write_figure({.title = "", .panels = {empty}, .comments = {}}, folder.path / "f");
    EXPECT_TRUE(files) << to_string(files.error());
  }
}

TEST(Figure, QuotesOfATextEndNoString) {
  const Folder folder;
  for (const std::string text :
       {"'", "''", "'''", "a''b", "''a'", "'; system 'touch hacked'; '", "a' b' c'",
        "'.system('touch hacked').'", "\\'", "\"'\"", "`touch hacked`", "'0", "1'23\"456|78#9", "{7}7"}) {
    const Panel panel{.title = text,
                      .x = {.label = text, .unit = ""},
                      .y = {.label = "y", .unit = text},
                      .series = {{.label = text, .x = {0, 1}, .y = {0, 1}}},
                      .notes = {{text, 0.5, 0.5}}};
    const auto files = write_figure({.title = text, .panels = {panel}, .comments = {}}, folder.path / "f",
                                    {.formats = {FigureFormat::svg}});
    ASSERT_TRUE(files) << text << to_string(files.error());
    const std::string svg = bytes(files->back()), whole = '>' + text + '<';
    std::size_t count = 0;  // two titles, the x axis, legend, note
    for (std::size_t at = svg.find(whole); at != std::string::npos; at = svg.find(whole, at + 1)) ++count;
    EXPECT_GE(count, 5U) << text;
    EXPECT_NE(svg.find(">y (" + text + ")<"), std::string::npos) << text;
    EXPECT_FALSE(fs::exists(folder.path / "hacked"));
  }
}

TEST(Figure, APanelInSpaceHasOneScaleAndTakesBackWhatItSets) {
  const std::string script = gnuplot_script(one_of_each(), "f");
  for (const char* line :
       {"$panel4_1 << EOD\n0 0 0\n1 1 5\n2 0 5\n0 1 9\nEOD\n", "set view equal xyz\n  set view 70,40,",
        R"x(set zlabel "it\047s z (mm)")x", "set zrange [0:10]", "splot $panel4_1 using 1:2:3 with lines",
        "with polygons fs transparent solid 0.2 fc rgb '#0072b2' notitle", "unset zlabel"})
    EXPECT_NE(script.find(line), std::string::npos) << line;
}

TEST(Figure, ALogAxisOfTinyNumbersIsWrittenInPowersAndTakesThatBack) {
  Figure figure = one_of_each();
  EXPECT_EQ(gnuplot_script(figure, "f").find("set format"), std::string::npos);
  figure.panels[0].y.low = 1e-7;
  const std::string script = gnuplot_script(figure, "f");
  const std::size_t set = script.find("set format y '10^{%L}'\n"), back = script.find("set format y\n");
  EXPECT_LT(set, back);
  EXPECT_LT(back, script.find("set title", script.find("set title") + 1));  // before the next panel
}

TEST(Figure, ShadedPointsHaveAColumnMoreAndALabelledBar) {
  const std::string script = gnuplot_script(one_of_each(), "f");
  EXPECT_NE(script.find("$panel5_1 << EOD\n0 1 -5\n\n2 3 7\nEOD\n"), std::string::npos);
  EXPECT_NE(script.find("plot $panel5_1 using 1:2:3 with points lc palette pt 7"), std::string::npos);
  EXPECT_NE(script.find(R"(set cblabel "U\134_p\134^\134\173\062\134\175 <b>)"), std::string::npos);
}

TEST(Figure, ManyCellsAreOneImageAndFewAreRectangles) {
  Panel panel{.title = "",
              .x = {.label = "x", .unit = ""},
              .y = {.label = "y", .unit = ""},
              .series = {},
              .map = HeatMap{.x = {}, .y = {}, .values = {}, .label = "v"}};
  for (int k = 0; k < 200; ++k) panel.map->x.push_back(0.5 * k), panel.map->y.push_back(k);
  panel.map->values.assign(40000, 1.0 / 3);
  panel.map->values[1] = std::numeric_limits<double>::quiet_NaN();
  const auto script = [&] { return gnuplot_script({.title = {}, .panels = {panel}, .comments = {}}, "f"); };
  EXPECT_NE(script().find("$panel1_map << EOD\n0.333333 NaN 0.333333"), std::string::npos);
  EXPECT_NE(script().find("matrix using (0+0.5*$1):(0+1*$2):3 with image notitle"), std::string::npos);
  EXPECT_EQ(script().find("boxxyerror"), std::string::npos);
  const Folder folder;
  const FigureOptions all{.formats = {FigureFormat::svg, FigureFormat::png, FigureFormat::pdf}};
  const auto files = write_figure({.title = {}, .panels = {panel}, .comments = {}}, folder.path / "f", all);
  ASSERT_TRUE(files) << to_string(files.error());
  EXPECT_LT(fs::file_size((*files)[1]), 1000000U);  // an .svg that opens
  panel.map->log = true;
  EXPECT_TRUE(write_figure({.title = {}, .panels = {panel}, .comments = {}}, folder.path / "f", all));
}

TEST(Figure, UnequalCellsMeetHalfWay) {
  const Panel panel{.title = "",
                    .x = {.label = "x", .unit = ""},
                    .y = {.label = "y", .unit = ""},
                    .series = {},
                    .map = HeatMap{.x = {0, 1, 3}, .y = {0, 2}, .values = {1, 2, 3, 4, 5, 6}, .label = "v"}};
  const std::string script = gnuplot_script({.title = {}, .panels = {panel}, .comments = {}}, "f");
  EXPECT_NE(script.find("\n1 0 2 0.47 2.03 -1.04 1.04\n"), std::string::npos) << "and a little over";
  EXPECT_NE(script.find("set xrange [-0.5:4]"), std::string::npos);
  EXPECT_NE(script.find("set yrange [-1:3]"), std::string::npos);
}

TEST(Figure, WithoutGnuplotTheScriptStaysAndTheMessageSaysWhatToInstall) {
  const Folder folder;
  const auto files = write_figure(one_of_each(), folder.path / "f", {.gnuplot = "gnuplot-that-is-not-here"});
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().front().code, "gnuplot_missing");
  EXPECT_NE(to_string(files.error()).find("gnuplot is not installed: apt-get install gnuplot-nox"),
            std::string::npos);
  EXPECT_EQ(bytes(folder.path / "f.gp"), gnuplot_script(one_of_each(), "f"));
}

TEST(Figure, WhatGnuplotComplainsOfIsInTheError) {
  const Folder folder;
  Figure figure = one_of_each();
  figure.panels[0].y.low = figure.panels[0].y.high = 0;  // no logarithm
  const auto files = write_figure(figure, folder.path / "f");
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().front().code, "gnuplot_failed");
  EXPECT_NE(to_string(files.error()).find("range"), std::string::npos) << to_string(files.error());
}

TEST(Figure, AFolderThatCannotBeWrittenIsAnError) {
  const Folder folder;
  std::ofstream(folder.path / "file") << "no folder";
  const auto files = write_figure(one_of_each(), folder.path / "file" / "f");
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().front().code, "file_unwritable");
}

}  // namespace figure_test
