/// map: singularities over a grid of poses, as a table of numbers or a heat map.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>

#include "map_figure.hpp"
#include "question.hpp"
#include "sinew/io/parse.hpp"
#include "sinew/io/quantity.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

constexpr double most_poses = 1e7;
constexpr std::array<std::string_view, 7> axis_names{"x", "y", "z", "phi", "rx", "ry", "rz"};

/// The robot itself, and the branch its legs are on.
struct Subject {
  AnyRobot robot;
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
Expected<Subject> subject(const Arguments& arguments, Robot& opened) {
  auto query = request("inverse", arguments, opened);
  if (!query) return tl::unexpected(query.error());
  query->pop_back();  // its closing brace
  *query += fmt::format(", {}}}", at_home(opened));
  if (Errors errors = ask(opened.session, *query).errors(); !errors.empty())
    return tl::unexpected(std::move(errors));
  const Document tree = parse_json(*query, "query").value();
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
  if (errors.empty() && (count < 2 || count > most_poses))
    errors.push_back({"out_of_range", where,
                      fmt::format("the third number says how many values, from 2 to {:.0f}; it is {}.",
                                  most_poses, si_text(count))});
  return {.from = from, .to = to, .count = errors.empty() ? static_cast<int>(count) : 1};
}

/// Home, with the axes of the command line.
Expected<PoseGrid> read_grid(const Arguments& arguments, const AnyRobot& robot,
                             const std::vector<Input>& axes) {
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
  if (errors.empty() && poses > most_poses)
    errors.push_back({"too_large", "",
                      fmt::format("{:.3g} poses; {:.0g} at most: give fewer values.", poses, most_poses)});
  return errors.empty() ? Expected<PoseGrid>(grid) : tl::unexpected(errors);
}

/// In SI.
Table table_of(const SingularityMap& map, const std::vector<Input>& axes, std::string_view robot) {
  Table table;
  table.comments = {fmt::format("sinew {}: map {}", version(), robot)};
  for (const Input& axis : axes) table.columns.push_back({axis.name, axis.unit, {}});
  for (const char* heading : {"reachable", map.grid.is_spatial ? "determinant[m^9]" : "determinant[m^4]",
                              "inverse_condition", "inverse_condition_homogenised", "type_1", "type_2"})
    table.columns.push_back(Column::named(heading));
  for (std::size_t k = 0; k < map.samples.size(); ++k) {
    const auto place = map.grid.coordinates(k);
    const MapSample& sample = map.samples[k];
    std::vector<double> row(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(axes.size()));
    const bool known = sample.is_reachable;
    for (const double value :
         {known ? 1.0 : 0.0, sample.determinant, sample.inverse_condition,
          sample.inverse_condition_homogenised, known ? std::popcount(sample.type_1) : MapSample::absent,
          known ? double(sample.is_type_2) : MapSample::absent})
      row.push_back(value);
    table.add_row(row);
  }
  return table;
}

/// A line on the terminal that counts; nothing where stderr is none.
Progress counter(bool quiet) {
  if (quiet || isatty(STDERR_FILENO) == 0) return {};
  return [](std::size_t done, std::size_t total) {
    if (done < total)
      fmt::print(stderr, "\r{:.0f} % of {} poses", 100 * double(done) / double(total), total);
    else
      fmt::print(stderr, "\r\033[K");
    return true;
  };
}

/// `1521 poses: 145 reachable, 0 at a type II, 0 at a type I`.
std::string summary(const SingularityMap& map) {
  const auto count = [&](auto&& what) { return std::ranges::count_if(map.samples, what); };
  return fmt::format("{} poses: {} reachable, {} at a type II, {} at a type I\n", map.samples.size(),
                     count([](const MapSample& sample) { return sample.is_reachable; }),
                     count([](const MapSample& sample) { return sample.is_type_2; }),
                     count([](const MapSample& sample) { return sample.type_1 != 0; }));
}

/// The format of a figure that an extension names.
std::optional<FigureFormat> figure_format(const std::filesystem::path& file) {
  for (const FigureFormat format : {FigureFormat::svg, FigureFormat::png, FigureFormat::pdf})
    if (file.extension() == fmt::format(".{}", extension(format))) return format;
  return {};
}

/// Writes what the name of the file asks for; the names of the files written, a line each.
Expected<std::string> write(const SingularityMap& map, const Subject& subject, const std::vector<Input>& axes,
                            const std::filesystem::path& file) {
  const std::string& robot = subject.robot.name;
  const auto format = figure_format(file);
  if (!format) {
    const auto written = write_csv(table_of(map, axes, robot), file);
    return written ? Expected<std::string>(file.string() + '\n') : tl::unexpected(written.error());
  }
  Workspace work(subject.robot);
  const Probe probe = [&](const AnyPose& pose) {
    return map_sample(subject.robot, pose, subject.branch(), work);
  };
  const auto written = write_figure(map_figure(map, probe, axes, robot),
                                    std::filesystem::path(file).replace_extension(), {.formats = {*format}});
  if (!written) return tl::unexpected(written.error());
  std::string names;
  for (const auto& path : *written) names += path.string() + '\n';
  return names;
}

Errors refuse_file(const std::string& file, const PoseGrid& grid, const std::vector<Input>& axes) {
  if (figure_format(file)) return refuse_to_draw(grid, axes);
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
    if (const Errors errors = refuse_file(*file, *grid, axes); !errors.empty()) return refuse("map", errors);

  Workspace work(asked->robot);
  const SingularityMap map =
      singularity_map(asked->robot, *grid, asked->branch(), work, counter(arguments.has("quiet")));
  if (!file) {
    print(to_csv(table_of(map, axes, asked->robot.name)));
  } else {
    const auto written = write(map, *asked, axes, *file);
    if (!written) return refuse("map", written.error());
    if (!arguments.has("quiet")) print(*written + summary(map));
  }
  if (std::ranges::any_of(map.samples, &MapSample::is_reachable)) return solved;
  message(fmt::format("map {}: unreachable: no pose of the grid", asked->robot.name));
  return no_solution;
}

}  // namespace sinew::cli
