#include "sinew/io/figure.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <limits>

namespace {

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
  return {.title = "three panels",
          .panels = {panel, square, map},
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
  EXPECT_NE(script.find("set xlabel 'x_1 [m]'"), std::string::npos);
  EXPECT_NE(script.find("it''s `date`"), std::string::npos);
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
  EXPECT_NE(script.find("set cblabel 'it''s κ'"), std::string::npos);
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

}  // namespace
