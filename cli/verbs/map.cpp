/// map: singularities over a grid of poses, as a table of numbers or a heat map.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <functional>

#include "figure_file.hpp"
#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"
#include "io/file/write_file.hpp"
#include "map_figure.hpp"
#include "question.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

constexpr double max_poses = 1e7;
constexpr std::array<std::string_view, 7> axis_names{"x", "y", "z", "phi", "rx", "ry", "rz"};

/// The robot itself, and the branch its legs are on.
struct Subject {
  Robot robot;
  std::vector<int> bending, elbow;
  std::vector<double> curvature;
  InverseOptions branch() const { return {.bending = bending, .curvature = curvature, .elbow = elbow}; }
};

std::vector<int> signs(const Node* list) {
  std::vector<int> result;
  if (list)
    for (const double sign : numbers(list)) result.push_back(sign < 0 ? -1 : 1);
  return result;
}

/// The options, read as those of an inverse query at home, which tells what is wrong with them.
Expected<Subject> subject(const Arguments& arguments, OpenRobot& opened) {
  auto query = request("inverse", arguments, opened);
  if (!query) return tl::unexpected(query.error());
  query->root.members.push_back(at_home(opened));
  if (Errors errors = ask(opened, *query).errors(); !errors.empty()) return tl::unexpected(std::move(errors));
  const Document& tree = *query;
  const auto file = read_robot_file(arguments.operand());
  if (!file) return tl::unexpected(file.error());
  const Node* set = at(tree.root, "set");
  const auto document = with(*file, set ? std::span<const Member>(set->members) : std::span<const Member>());
  auto robot = document ? read_robot(*document) : tl::unexpected(document.error());
  if (!robot) return tl::unexpected(robot.error());
  const Node* curvature = at(tree.root, "curvature");
  return Subject{std::move(*robot), signs(at(tree.root, "bending")), signs(at(tree.root, "elbow")),
                 curvature ? numbers(curvature) : std::vector<double>{}};
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

/// `12 mm` or `-120 mm : 120 mm : 13`.
MapAxis read_axis(std::string_view name, std::string_view text, Dimension dimension, Errors& errors) {
  const std::vector<std::string> parts = split(text);
  const std::string where = fmt::format("--{}", name);
  const auto value = [&](std::size_t k, Dimension of) {
    const Expected<double> read = parse_quantity(parts[k], of);
    if (!read) errors.push_back({read.error().front().code, where, read.error().front().message});
    return read.value_or(0.0);
  };
  if (parts.size() == 1) {
    const double fixed = value(0, dimension);
    return {.from = fixed, .to = fixed, .count = 1};
  }
  if (parts.size() != 3) {
    errors.push_back(
        {"not_an_axis", where,
         fmt::format("{} is neither a value nor FROM : TO : COUNT: {} \"{} : 13\".", in_quotes(text), where,
                     dimension == Dimension::length ? "-60 mm : 60 mm" : "-60 deg : 60 deg")});
    return {};
  }
  const double from = value(0, dimension), to = value(1, dimension), count = value(2, Dimension::count);
  if (errors.empty() && (count < 2 || count > max_poses))
    errors.push_back({"out_of_range", where,
                      fmt::format("the third number says how many values, from 2 to {:.0f}; it is {}.",
                                  max_poses, si_text(count))});
  return {.from = from, .to = to, .count = errors.empty() ? static_cast<int>(count) : 1};
}

/// Home, with the axes of the command line.
Expected<PoseGrid> read_grid(const Arguments& arguments, const Robot& robot, const std::vector<Input>& axes) {
  PoseGrid grid = PoseGrid::at(home(robot));
  Errors errors;
  std::vector<std::string_view> known;
  double poses = 1;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    known.push_back(axes[a].name);
    const Dimension dimension = axes[a].unit == "m" ? Dimension::length : Dimension::angle;
    if (const std::string* text = arguments.text(axes[a].name))
      grid.axes[a] = read_axis(axes[a].name, *text, dimension, errors);
    poses *= grid.axes[a].count;
  }
  for (const std::string_view name : axis_names)
    if (arguments.has(name) && std::ranges::find(known, name) == known.end())
      errors.push_back({"unknown_axis", fmt::format("--{}", name),
                        fmt::format("is no axis of this robot, which is {}; its axes: --{}.",
                                    grid.is_spatial ? "spatial" : "planar", fmt::join(known, ", --"))});
  if (errors.empty() && poses > max_poses)
    errors.push_back(
        {"too_large", "", fmt::format("{:.3g} poses; {:.0g} at most: give fewer values.", poses, max_poses)});
  return errors.empty() ? Expected<PoseGrid>(grid) : tl::unexpected(errors);
}

/// The heading of the table, without rows; in SI.
std::string heading_of(const PoseGrid& grid, const std::vector<Input>& axes, std::string_view robot) {
  Table table;
  table.comments = {fmt::format("sinew {}: map {}", version(), robot)};
  for (const Input& axis : axes) table.columns.push_back({axis.name, axis.unit, {}});
  for (const char* heading : {"reachable", grid.is_spatial ? "determinant[m^9]" : "determinant[m^4]",
                              "inverse_condition", "inverse_condition_homogenised", "type_1", "type_2"})
    table.columns.push_back(Column::named(heading));
  return to_csv(table);
}

void append_row(std::string& text, const PoseGrid& grid, std::size_t k, const MapSample& sample) {
  const auto place = grid.coordinates(k);
  const bool known = sample.is_reachable;
  std::array<double, 12> row{};
  auto end = std::copy_n(place.begin(), grid.axis_count(), row.begin());
  for (const double value :
       {known ? 1.0 : 0.0, sample.determinant, sample.inverse_condition, sample.inverse_condition_homogenised,
        known ? std::popcount(sample.type_1) : MapSample::absent,
        known ? double(sample.is_type_2) : MapSample::absent})
    *end++ = value;
  append_csv_row(text, {row.data(), static_cast<std::size_t>(end - row.begin())});
}

/// A line on the terminal that counts; none where stderr is none. Ctrl-C ends the map.
Progress counter(bool quiet) {
  const bool is_silent = quiet || isatty(STDERR_FILENO) == 0;
  return [is_silent](std::size_t done, std::size_t total) {
    if (is_silent) return !interrupted();
    if (done < total && !interrupted())
      fmt::print(stderr, "\r{:.0f} % of {} poses", 100 * double(done) / double(total), total);
    else
      fmt::print(stderr, "\r\033[K");
    return !interrupted();
  };
}

/// What a map comes to, while its samples pass.
struct Tally {
  std::size_t poses = 0, reachable = 0, type_2 = 0, type_1 = 0;

  void add(const MapSample& sample) {
    ++poses;
    reachable += sample.is_reachable;
    type_2 += sample.is_type_2;
    type_1 += sample.type_1 != 0;
  }
  /// `1521 poses: 145 reachable, 0 at a type II, 0 at a type I`
  std::string text() const {
    return fmt::format("{} poses: {} reachable, {} at a type II, {} at a type I\n", poses, reachable, type_2,
                       type_1);
  }
};

/// Where text goes: a file in the making, or stdout.
using Write = std::function<Expected<void>(std::string_view text)>;

/// The rows go to `write` as they are computed, some at a time: a map has any length in constant memory.
Expected<Tally> write_rows(const Subject& subject, const PoseGrid& grid, const Progress& progress,
                           const Write& write) {
  constexpr std::size_t rows_at_once = 256;
  const std::size_t total = grid.size();
  Workspace work(subject.robot);
  Tally tally;
  std::string rows;
  Expected<void> written = write(heading_of(grid, pose_columns(grid.is_spatial), subject.robot.name()));
  if (!written || !progress(0, total)) return written.map([&] { return tally; });
  visit_map(subject.robot, grid, subject.branch(), work, [&](std::size_t k, const MapSample& sample) {
    tally.add(sample);
    append_row(rows, grid, k, sample);
    if ((k + 1) % rows_at_once != 0 && k + 1 < total) return true;
    written = write(rows);
    rows.clear();
    return written.has_value() && progress(k + 1, total);
  });
  return written.map([&] { return tally; });
}

Expected<Tally> write_table(const Subject& subject, const PoseGrid& grid, const Progress& progress,
                            const std::string* file) {
  if (!file)
    return write_rows(subject, grid, progress,
                      [](std::string_view text) { return print(text), Expected<void>(); });
  auto writer = FileWriter::open(*file);
  if (!writer) return tl::unexpected(writer.error());
  auto tally =
      write_rows(subject, grid, progress, [&](std::string_view text) { return writer->write(text); });
  if (tally && tally->poses == grid.size())  // else the file stays as it was
    if (auto done = writer->finish(); !done) return tl::unexpected(done.error());
  return tally;
}

/// A heat map. Its values are kept: gnuplot reads all of them.
Expected<Tally> draw(const Subject& subject, const PoseGrid& grid, const std::vector<Input>& axes,
                     const Arguments& arguments, const Progress& progress, int& exit) {
  Workspace work(subject.robot);
  const SingularityMap map = singularity_map(subject.robot, grid, subject.branch(), work, progress);
  Tally tally;
  for (const MapSample& sample : map.samples) tally.add(sample);
  if (!map.is_complete()) return tally;
  const Probe probe = [&](const AnyPose& pose) {
    return map_sample(subject.robot, pose, subject.branch(), work);
  };
  exit = write_figure_file(arguments, map_figure(map, probe, axes, subject.robot.name()),
                           *arguments.text("output"));
  return tally;
}

Errors refuse_file(const Arguments& arguments, const std::string& file, const PoseGrid& grid,
                   const std::vector<Input>& axes) {
  if (refuse_format(file).empty()) {
    const auto paper = page_options(arguments);
    return paper ? refuse_to_draw(grid, axes) : paper.error();
  }
  if (file.ends_with(".csv")) return {};
  return {{"unknown_format", "--output",
           fmt::format("{}: the file ends in .csv, or for a heat map in .svg, .png or .pdf: -o map.csv.",
                       in_quotes(file))}};
}

}  // namespace

int run_map(const Arguments& arguments) {
  auto opened = open_with_platform(arguments);
  if (!opened) return refuse("map", opened.error());
  if (opened->is_on_rods)
    return refuse("map",
                  {{"not_available", arguments.operand(),
                    "a map shows singularities of legs that close on the platform; this robot's bear load. "
                    "Ask at one configuration: sinew analyse 3pfs-g2 --inputs \"0.44 m, 0.42 m, 0.41 m\""}});
  const std::vector<Input> axes = pose_columns(opened->is_spatial);
  if (std::ranges::none_of(axis_names, [&](std::string_view name) { return arguments.has(name); }))
    return refuse("map",
                  {{"missing_option", "",
                    fmt::format("what is to vary? Give at least one axis: {}", find_verb("map")->example)}});
  const auto asked = subject(arguments, *opened);
  if (!asked) return refuse("map", asked.error());
  const auto grid = read_grid(arguments, asked->robot, axes);
  if (!grid) return refuse("map", grid.error());
  const std::string* file = arguments.text("output");
  if (file)
    if (const Errors errors = refuse_file(arguments, *file, *grid, axes); !errors.empty())
      return refuse("map", errors);

  const bool is_table_on_screen = !file && isatty(STDOUT_FILENO) != 0;
  const Progress progress = counter(arguments.has("quiet") || is_table_on_screen);
  const bool is_figure = file && refuse_format(*file).empty();
  int exit = solved;
  const Expected<Tally> tally = is_figure ? draw(*asked, *grid, axes, arguments, progress, exit)
                                          : write_table(*asked, *grid, progress, file);
  if (!tally) return refuse("map", tally.error());
  if (exit != solved) return exit;
  if (tally->poses < grid->size()) {
    message(fmt::format("map {}: stopped after {} of {} poses; {}", asked->robot.name(), tally->poses,
                        grid->size(), file ? "nothing was written" : "these are written"));
    return stopped;
  }
  if (file && !arguments.has("quiet")) print((is_figure ? "" : visible_line(*file) + '\n') + tally->text());
  if (tally->reachable > 0) return solved;
  message(fmt::format("map {}: unreachable: no pose of the grid", asked->robot.name()), Style::bad);
  return no_solution;
}

}  // namespace sinew::cli
