/// help: texts made of the tables of verbs and of the library's units.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/document/quantity.hpp"
#include "sinew/io/node.hpp"
#include "sinew/io/robot_file.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

constexpr std::string_view exit_codes =
    "Exit codes: 0 solved, 1 internal error, 2 bad input, 3 no solution, or an unstable one (said why), 4 "
    "stopped by a limit or "
    "a signal.\nCtrl-C stops a solve, which answers what it has; a second one ends the command at once.\n";

std::string joined_names(char separator) {
  std::string names;
  for (const Verb& verb : verbs())
    names += fmt::format("{}{}", names.empty() ? "" : std::string(1, separator), verb.name);
  return names;
}

}  // namespace

std::string help() {
  std::string list;
  for (const Verb& verb : verbs()) list += fmt::format("  {:<10}  {}\n", verb.name, verb.summary);
  return fmt::format(
      "sinew {}: kinematics and singularities of continuum robots\n\n"
      "Usage: sinew VERB ROBOT [OPTIONS]\n"
      "ROBOT is a robot file or the name of a built-in robot: {}.\n\n{}\n"
      "Numbers are SI and radians; with a unit they may be anything else: \"10 mm\", \"5 deg\" (sinew help "
      "units).\n"
      "Tables show mm and degrees, --json shows SI and radians.\n{}\n"
      "Example:\n  sinew inverse 3-rfr --pose \"10 mm, -5 mm, 10 deg\"\n"
      "Help on a verb: sinew VERB --help. Version: sinew --version.\n",
      version(), fmt::join(builtin_robot_names(), ", "), list, exit_codes);
}

std::string help(const Verb& verb) {
  std::size_t width = 0;
  std::vector<std::pair<std::string, std::string_view>> rows;
  for (const std::string_view name : verb.options) {
    const Option& known = option(name);
    const std::string letter = known.letter ? fmt::format("-{}, ", known.letter) : "    ";
    rows.emplace_back(fmt::format("{}--{} {}", letter, name, known.value), known.help);
    width = std::max(width, rows.back().first.size());
  }
  std::string list;
  for (const auto& [spelling, words] : rows) list += fmt::format("  {:<{}}  {}\n", spelling, width, words);
  return fmt::format("sinew {0}: {1}\n\nUsage: sinew {0} {2} [OPTIONS]\n\n{3}\n{4}{5}Example:\n  {6}\n",
                     verb.name, verb.summary, verb.operand, list, verb.notes,
                     verb.notes.empty() ? "" : "\n\n", verb.example);
}

std::vector<std::string> unit_advice() {
  constexpr std::array dimensions{Dimension::length,        Dimension::angle,
                                  Dimension::curvature,     Dimension::force,
                                  Dimension::moment,        Dimension::pressure,
                                  Dimension::mass,          Dimension::density,
                                  Dimension::time,          Dimension::acceleration,
                                  Dimension::line_load,     Dimension::speed,
                                  Dimension::angular_speed, Dimension::angular_acceleration,
                                  Dimension::rigidity,      Dimension::compliance,
                                  Dimension::line_mass};
  std::vector<std::string> lines;
  for (const Dimension dimension : dimensions) lines.emplace_back(advice(dimension));
  return lines;
}

std::string help_units() {
  std::string list;
  for (const std::string& line : unit_advice()) list += fmt::format("  {}\n", line);
  return "A number without a unit is SI and radians; a number with a unit is text, in quotes where it holds "
         "a blank:\n\n" +
         list +
         "\nA unit of another kind is refused. Fractions of whole numbers are read too: \"1/2 in\".\n"
         "In tables lengths are in mm and angles in degrees; JSON is SI and radians throughout.\n";
}

int run_help(const Arguments& arguments) {
  const std::string topic = arguments.operand();
  if (arguments.has("man")) {
    print(manual());
  } else if (topic.empty()) {
    print(help());
  } else if (topic == "units") {
    print(help_units());
  } else if (topic == "fields") {
    print(arguments.has("json") ? fields_json() + '\n' : help_fields());
  } else if (const Verb* verb = find_verb(topic)) {
    print(help(*verb));
  } else {
    return refuse(
        "help",
        {{"unknown_topic", in_quotes(topic),
          fmt::format("no such topic; there are units, fields and the verbs {}.", joined_names(' '))}});
  }
  return solved;
}

}  // namespace sinew::cli
