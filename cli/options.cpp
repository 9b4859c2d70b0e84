/// Options of the command: fields of questions under the same names, and what no question has.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "query/fields/fields.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

constexpr std::string_view figures[] = {"line", "points", "map", "contour", "sides", "3d", "diagram"},
                           instruction_sets[] = {"native", "avx512", "avx2", "baseline"};

constexpr std::array own_options{
    Option{"to", "\"X, Y, PHI\"|LANGUAGE", "last pose of a path; of export the language: c-header, verilog"},
    Option{"to-inputs", "\"A, B, ...\"", "of branches the inputs where the curve leads"},
    Option{"to-tensions", "\"A, B; ...\"", "of branches on chains the tensions where the curve leads"},
    Option{"to-lengths", "\"A, -; ...\"", "of branches on chains the tendon lengths where the curve leads"},
    Option{"to-wrench", "\"FX, FY, FZ, MX, MY, MZ\"", "of branches the wrench where the curve leads"},
    Option{"poses", "FILE", "the path as a table: a .csv file of poses"},
    Option{"limit", "N", "how many times --until adds its wrench at most; of diagram the envelope's size"},
    Option{"output", "FILE",
           "where to write: a folder for reproduce (default: out), a figure for plot, a .csv for track; of "
           "export a file, or the folder of several",
           'o'},
    Option{
        "host", "ADDRESS",
        "of serve where it listens; default 127.0.0.1, this machine alone. Any other one asks for the token "
        "that is printed with the address"},
    Option{"scene", "SCENE", "of serve the scene that its plans are of"},
    Option{"plan", "FILE",
           "of serve a way into the scene, as sinew plan writes it; more than one may be given", 0, true},
    Option{"port", "PORT", "of serve; default 8765, 0 is any that is free"},
    Option{"frame", "", "of serve: pages of this machine, such as notebooks, may show the page in a frame"},
    Option{"demo", "", "of serve: a simulated device, moved by the panel's firmware"},
    Option{"device", "PATH", "of serve the serial port of the robot's controller, as /dev/ttyACM0"},
    Option{"baud", "RATE", "of the device; default 1000000"},
    Option{"record", "FOLDER",
           "of serve where recordings of devices go, and are shown from; default sinew-recordings"},
    Option{"resume", "", "go on with what an interrupted run left; without it, begin"},
    Option{"force", "",
           "replace results that are there, or of a figure its script that was changed by hand; without it "
           "both are "
           "kept and the command refuses"},
    Option{"threads", "N", "threads of this process; default one a core"},
    Option{
        "isa", "NAME",
        "instruction set: native (default), avx512, avx2, or baseline, whose results are the same bytes on "
        "every machine",
        0, false, instruction_sets},
    Option{"seed", "N",
           "of random numbers; one seed, one answer; default 1, of scene the dimensions as they are"},
    Option{"time-limit", "TIME", "after which plan gives up; default 60 s"},
    Option{"check", "PLAN", "no new plan: whether this one, an .h5 or .csv file, holds in the scene"},
    Option{"along", "FILE",
           "the plan of drive, or of plot with a scene: .h5 or .csv, or any table with its columns"},
    Option{"limits", "\"NAME=VALUE, ...\"",
           "of drive: stage_speed, stage_acceleration, bend_speed, bend_acceleration, tendon_speed, "
           "tendon_acceleration; may be repeated",
           0, true},
    Option{"fit", "NAMES",
           "of identify what may change, with commas between; default stiffness, angles, compliance and "
           "curvature of "
           "sections, offsets and toes of tendons, weight, marker, base, tilt.x, tilt.y and the lag"},
    Option{"hold-out", "N",
           "of identify: in how many parts blocks of rows are held out in turn, and judged by a fit without "
           "them; "
           "default 5, 0 for none"},
    Option{"noise", "LENGTH", "of a coordinate of the marker; default what the fit leaves"},
    Option{"map", "",
           "of identify: take motors and axes as the rows say, should counts be paid out, or tendons turned "
           "or the "
           "other way round"},
    Option{"errors", "FILE", "of identify a .csv file of measured and computed places, a row each"},
    Option{"rate", "HZ", "of drive: points a second; default 50"},
    Option{"reverse", "", "of drive: from the last posture to the first, out again"},
    Option{"stage-motor", "\"{lead: L, counts: N}\"",
           "of drive, serve: the motor of the linear stage, as `motor` of a robot"},
    Option{"compress", "LEVEL", "of HDF5, 0 (none, default) to 9"},
    Option{"list", "", "only list what there is; of sweep what it would do"},
    Option{"as", "NAME",
           "the kind of figure: of a table line, points, map or contour; of a robot sides, 3d or diagram; "
           "default what suits",
           0, false, figures},
    Option{"x", "COLUMN|AXIS",
           "of plot the column along x, default the first; of map a value, or FROM : TO : COUNT, default the "
           "home's"},
    Option{"y", "COLUMNS|AXIS",
           "of plot the columns to draw, default all the others, of a map the one upwards; of map as --x"},
    Option{"value", "COLUMN", "what a map or contours show; default the first column that is no axis"},
    Option{"at", "\"COLUMN=VALUE, ...\"",
           "only the rows there, or nearest to it: where a map cuts further axes; may be repeated", 0, true},
    Option{"colour", "COLUMN", "what colours the points"},
    Option{"log-value", "", "logarithmic colours"},
    Option{"view", "\"TILT, TURN\"",
           "angles from which a robot is seen in space: from straight above, and about z; default \"60 deg, "
           "30 deg\""},
    Option{"z", "AXIS", "a value, or FROM : TO : COUNT; default the home's"},
    Option{"phi", "AXIS", "angle of the platform: a value, or FROM : TO : COUNT; default the home's"},
    Option{"rx", "AXIS",
           "x of the platform's rotation vector: a value, or FROM : TO : COUNT; default the home's"},
    Option{"ry", "AXIS", "y of it"},
    Option{"rz", "AXIS", "z of it"},
    Option{"log-y", "", "logarithmic y axis"},
    Option{"all-statuses", "",
           "draw samples of a sweep that did not converge, too; without it they are left out and counted"},
    Option{"title", "TEXT", "title of the figure"},
    Option{"width", "LENGTH",
           "of the figure on paper: 85 mm is one column of a journal, 180 mm two; text then has 8 points"},
    Option{"font", "NAME,SIZE", "of the figure's texts; the size in points may be left out: \"Times,9\""},
    Option{"json", "", "the answer as one line of JSON, SI and radians"},
    Option{"quiet", "", "only data on stdout and errors on stderr", 'q'},
    Option{"man", "", "all verbs and options as a page for man, on stdout"},
    Option{"help", "", "this text", 'h'},
};

/// What follows an option of this shape.
std::string_view spelling(const Field& field) {
  using Shape = FieldShape;
  switch (field.shape) {
    case Shape::flag:
      return "";
    case Shape::whole:
      return "N";
    case Shape::quantity:
      return field.dimension == Dimension::length  ? "LENGTH"
             : field.dimension == Dimension::angle ? "ANGLE"
             : field.dimension == Dimension::force ? "FORCE"
                                                   : "N";
    case Shape::word:
    case Shape::text_or_number:
      return "NAME";
    case Shape::words:
      return "NAME,NAME";
    case Shape::point:
      return "\"X, Y, Z\"";
    case Shape::numbers:
    case Shape::inputs:
    case Shape::per_leg:
    case Shape::start:
      return "\"A, B, ...\"";
    case Shape::signs:
      return "\"+,-,+\"";
    case Shape::pairs:
    case Shape::lists:
      return "\"A, B; ...\"";
    case Shape::pose:
    case Shape::place:
    case Shape::target:
      return "\"X, Y, PHI\"";
    case Shape::independent:
      return "\"Z, E1, E2\"";
    case Shape::places:
    case Shape::path_points:
    case Shape::measured_rows:
      return "FILE";
    case Shape::names:
      return "NAMES";
    case Shape::wrench:
    case Shape::growing_load:
      return "\"FX, FY, FZ, MX, MY, MZ\"";
    case Shape::twist:
      return "\"VX, VY, W\"";
    case Shape::range:
      return "\"LOW, HIGH\"";
    case Shape::settings:
      return "PATH=VALUE";
    case Shape::point_loads:
      return "JSON";
  }
  return "";
}

/// A sentence with names in backticks, those of fields as options.
std::string in_dashes(std::string_view meaning) {
  std::string text;
  for (std::size_t at = 0; at < meaning.size();) {
    const std::size_t begin = std::min(meaning.find('`', at), meaning.size());
    text += meaning.substr(at, begin - at);
    const std::size_t end = std::min(meaning.find('`', begin + 1), meaning.size());
    if (begin < end) {
      std::string name(meaning.substr(begin + 1, end - begin - 1));
      if (find_field(name.substr(0, name.find('.')))) {
        std::ranges::replace(name, '_', '-');
        text += "--";
      }
      text += name;
    }
    at = end + 1;
  }
  return text;
}

/// An option, with its texts.
struct FieldOption {
  std::string name, help;
  const Field* field;

  explicit FieldOption(const Field& of) : name(of.name), help(in_dashes(of.meaning)), field(&of) {
    std::ranges::replace(name, '_', '-');
  }
  Option option() const {
    return {name,
            spelling(*field),
            help,
            0,
            field->shape == FieldShape::settings,
            field->words,
            field->shape == FieldShape::words};
  }
};

bool is_own(std::string_view name) {
  return std::ranges::find(own_options, name, &Option::name) != own_options.end();
}

/// All fields; made when they are first asked for.
const std::vector<FieldOption>& field_options() {
  static const std::vector<FieldOption> made(question_fields().begin(), question_fields().end());
  return made;
}

}  // namespace

std::vector<std::string_view> options_of(Ask ask, std::initializer_list<std::string_view> without,
                                         std::initializer_list<std::string_view> with) {
  const auto is_spelled = [&](std::string_view name) {
    return name != "query" && name != "id" && std::ranges::find(without, name) == without.end();
  };
  std::vector<std::string_view> names;
  for (const FieldOption& one : field_options())
    if (one.field->uses.of(ask) != 0 && is_spelled(one.name)) names.push_back(one.name);
  for (const std::string_view name : with)
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  return names;
}

std::span<const Option> all_options() {
  static const std::vector<Option> options = [] {
    std::vector<Option> all;
    for (const FieldOption& one : field_options())
      if (!is_own(one.name) && one.name != "query" && one.name != "id") all.push_back(one.option());
    all.insert(all.end(), own_options.begin(), own_options.end());
    return all;
  }();
  return options;
}

const Option& option(std::string_view name) {
  const auto found = std::ranges::find(all_options(), name, &Option::name);
  if (found == all_options().end())
    throw std::logic_error("an option without a description: " + std::string(name));
  return *found;
}

}  // namespace sinew::cli
