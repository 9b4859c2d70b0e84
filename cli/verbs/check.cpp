/// check: what a robot file means, or everything that is wrong with it; of studies, see study.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <numbers>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "request.hpp"
#include "show.hpp"
#include "sinew/io/robot_file.hpp"
#include "terminal.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

/// A robot, what it needs at home, and how it moves there.
struct Checked {
  OpenRobot robot;
  Answer home, velocity;
};

Checked put_questions(OpenRobot robot, const std::vector<Member>& changes) {
  const auto put = [&](std::string_view query, std::vector<std::string_view> want) {
    std::vector<Member> members{{.key = "query", .value = make_node(query)}, at_home(robot)};
    std::vector<Node> words;
    for (const std::string_view word : want) words.push_back(make_node(word));
    if (!words.empty()) members.push_back({.key = "want", .value = list_of(std::move(words))});
    if (!changes.empty()) members.push_back({.key = "set", .value = map_of(changes)});
    return ask(robot, {"query", map_of(std::move(members))});
  };
  using Words = std::vector<std::string_view>;
  Answer home = put("inverse", robot.is_on_rods ? Words{"sensitivity", "margins", "stability"} : Words{}),
         velocity = put("velocity", {});
  return {std::move(robot), std::move(home), std::move(velocity)};
}

/// `legs[0]`, `legs[0] and legs[2]`, `all legs`: who shares something.
std::string names_of(const std::vector<std::size_t>& legs, std::size_t count) {
  if (legs.size() == count) return "all legs";
  std::string names;
  for (const std::size_t leg : legs) names += fmt::format("{}legs[{}]", names.empty() ? "" : ", ", leg);
  return names;
}

/// Texts that several legs share, in the order they first came.
class PerLeg {
 public:
  explicit PerLeg(std::size_t count) : count_(count) {}
  void add(std::size_t leg, const std::string& text) {
    for (auto& [known, legs] : entries_)
      if (known == text) return legs.push_back(leg);
    entries_.push_back({text, {leg}});
  }
  template <class Line>
  void each(Line line) const {
    for (const auto& [text, legs] : entries_) line(names_of(legs, count_), text);
  }

 private:
  std::size_t count_;
  std::vector<std::pair<std::string, std::vector<std::size_t>>> entries_;
};

/// `length 0.2 m = 200 mm`; the description is SI, so the key says what else to show.
std::string both_ways(std::string_view key, const Node& value) {
  const auto is_one_of = [&](std::initializer_list<std::string_view> keys) {
    return std::ranges::find(keys, key) != keys.end();
  };
  if (is_one_of({"length", "tendon_offset", "diameter", "width", "height"}))
    return fmt::format("{} {} m = {}", key, si_text(value.number), human(value.number, Dimension::length));
  if (key == "E") return fmt::format("E {} Pa = {:.6g} GPa", si_text(value.number), value.number / 1e9);
  if (key == "density") return fmt::format("density {} kg/m^3", si_text(value.number));
  if (key == "G") return fmt::format("G {} Pa = {:.6g} GPa", si_text(value.number), value.number / 1e9);
  if (value.kind == Node::Kind::list) return fmt::format("{} [{}]", key, fmt::join(numbers(&value), ", "));
  return fmt::format("{} {}", key, value.text);
}

std::string show_part(const Node& part) {
  std::string text;
  for (const Member& member : part.members) {
    if (member.key == "type") {
      text += member.value.text;
    } else if (member.value.kind == Node::Kind::map) {
      text += show_part(member.value);
    } else {
      text += ", " + both_ways(member.key, member.value);
    }
  }
  return text;
}

struct PointColumn {
  std::string_view name, unit, path;
};

/// Where legs begin and end: what at least one of them has.
constexpr std::array point_columns{
    PointColumn{"base_x", "m", "base.point[0]"},
    PointColumn{"base_y", "m", "base.point[1]"},
    PointColumn{"base_z", "m", "base.point[2]"},
    PointColumn{"first_axis_x", "", "base.first_axis[0]"},
    PointColumn{"first_axis_y", "", "base.first_axis[1]"},
    PointColumn{"first_axis_z", "", "base.first_axis[2]"},
    PointColumn{"hinge_axis_x", "", "base.hinge_axis[0]"},
    PointColumn{"hinge_axis_y", "", "base.hinge_axis[1]"},
    PointColumn{"hinge_axis_z", "", "base.hinge_axis[2]"},
    PointColumn{"direction_x", "", "base.direction[0]"},
    PointColumn{"direction_y", "", "base.direction[1]"},
    PointColumn{"direction_z", "", "base.direction[2]"},
    PointColumn{"platform_x", "m", "platform_point[0]"},
    PointColumn{"platform_y", "m", "platform_point[1]"},
    PointColumn{"platform_z", "m", "platform_point[2]"},
    PointColumn{"direction", "rad", "base.direction"},
};

const Node* number_at(const Node& leg, std::string_view path) {
  const Node* node = at(leg, path);
  return node && node->kind == Node::Kind::number ? node : nullptr;
}

std::string show_points(const Node& legs) {
  std::vector<PointColumn> columns;
  std::ranges::copy_if(point_columns, std::back_inserter(columns), [&](const PointColumn& column) {
    return std::ranges::any_of(legs.items, [&](const Node& leg) { return number_at(leg, column.path); });
  });
  std::vector<std::string> header{"leg"};
  for (const PointColumn& column : columns) header.push_back(heading(column.name, column.unit));
  TextTable table(std::move(header));
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    std::vector<std::string> row{fmt::format("legs[{}]", i)};
    for (const PointColumn& column : columns) {
      const Node* value = number_at(legs.items[i], column.path);
      row.push_back(value ? cell(value->number, column.unit) : "-");
    }
    table.add(std::move(row));
  }
  return table.text();
}

std::string show_limits(const Node& inputs) {
  TextTable table({"input", "unit", "least", "most"});
  for (const Node& input : inputs.items) {
    const std::string& unit = input.find("unit")->text;
    const auto limit = [&](std::string_view path) {
      const Node* value = at(input, path);
      return value ? cell(value->number, unit) : "-";
    };
    table.add(
        {input.find("name")->text, std::string(shown(unit).unit), limit("limits[0]"), limit("limits[1]")});
  }
  return table.text();
}

/// A home that rods rest at, and how they do.
std::string show_rest(const Checked& checked) {
  const Answer& home = checked.home;
  if (home.find("error")) return "home\n" + show_pose(*checked.robot.description.find("home"));
  if (!home.find("legs"))
    return "home\n" + show_pose(*checked.robot.description.find("home")) + "\n" + home.text("status") + ": " +
           home.text("message") + "\n";
  return "home, at rest\n" + show_pose(*home.find("pose")) + '\n' +
         show_inputs("value", numbers(home.find("inputs")), checked.robot) + '\n' +
         show_legs(*home.find("legs")) + '\n' + show_equilibrium(home, checked.robot);
}

std::string show_home(const Checked& checked) {
  if (checked.robot.is_on_rods) return show_rest(checked);
  std::string text = "home\n" + show_pose(*checked.robot.description.find("home"));
  if (!checked.home.converged())
    return text + "\n" + checked.home.text("status") + ": " + checked.home.text("message") + "\n";
  text += '\n' + show_legs(*checked.home.find("legs"));
  if (!checked.velocity.find("J")) return text;
  return text + '\n' + show_indices(checked.velocity, checked.robot) + '\n' +
         show_singularities(checked.velocity);
}

double norm_of(const Node& vector) {
  double square = 0;
  for (const double part : numbers(&vector)) square += part * part;
  return std::sqrt(square);
}

std::string show(const Checked& checked) {
  const Answer& about = checked.robot.description;
  const Node &legs = *about.find("legs"), &inputs = *about.find("inputs");
  const auto counted = [](std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
  };
  std::string text =
      fmt::format("{}: {} {} robot, {}, {}, model {}, geometry: {}\n", about.text("robot"),
                  about.text("space"), about.text("kind"), counted(legs.items.size(), "leg"),
                  counted(inputs.items.size(), "input"), about.text("model"), about.text("geometry"));
  text += fmt::format("freedoms: {} of the platform, {} held by the legs, {} driven by actuators\n",
                      about.text("freedoms.platform"), about.text("freedoms.constraints"),
                      about.text("freedoms.actuators"));
  PerLeg parts(legs.items.size());
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    parts.add(i, "link " + show_part(*legs.items[i].find("link")));
    parts.add(i, "closure " + show_part(*legs.items[i].find("closure")));
  }
  parts.each([&](const std::string& who, const std::string& what) { text += who + ": " + what + '\n'; });
  if (const auto radius = about.number("platform.radius"))
    text += fmt::format("platform: radius {} m = {}\n", si_text(*radius), human(*radius, Dimension::length));
  if (const auto mass = about.number("platform.mass"); mass && *mass > 0)
    text += fmt::format("platform: mass {} kg\n", si_text(*mass));
  if (const Node* gravity = about.find("gravity"); gravity && norm_of(*gravity) > 0)
    text += fmt::format("gravity: [{}] m/s^2\n", fmt::join(numbers(gravity), ", "));
  return text + '\n' + show_limits(inputs) + '\n' + show_points(legs) + '\n' + show_home(checked);
}

/// What is allowed but unlikely: more often a slip than a robot.
void suspect(const Node& leg, std::size_t i, PerLeg& warnings) {
  const double length = number(leg, "link.length"), offset = number(leg, "link.tendon_offset"),
               diameter = number(leg, "link.diameter"), E = number(leg, "link.material.E");
  const auto mm = [](double metres) { return human(metres, Dimension::length); };
  if (offset > length / 4)
    warnings.add(
        i, fmt::format("the tendon offset of {} is more than a quarter of the length of {}; is a unit wrong?",
                       mm(offset), mm(length)));
  if (length > 0 && diameter > length / 10)
    warnings.add(
        i,
        fmt::format("the diameter of {} is more than a tenth of the length of {}: too thick for an elastic "
                    "backbone; is a unit wrong?",
                    mm(diameter), mm(length)));
  if (E > 0 && (E < 1e3 || E > 1e12))
    warnings.add(
        i, fmt::format("Young's modulus of {} Pa is outside 1 kPa to 1 TPa; is a unit wrong?", si_text(E)));
}

/// The same of a rod, whose length is an input.
void suspect_rod_at_home(const Node& leg, const Node& state, std::size_t i, PerLeg& warnings) {
  const Node* section = at(leg, "link.section");
  const double length = number(state, "length"),
               diameter = section ? std::min(number(*section, "width"), number(*section, "height"))
                                  : number(leg, "link.diameter");
  if (diameter > length / 10)
    warnings.add(i, fmt::format("the {} of {} is more than a tenth of its length at home, {}: too thick for "
                                "a slender rod; is a unit wrong?",
                                section ? "thickness" : "diameter", human(diameter, Dimension::length),
                                human(length, Dimension::length)));
}

/// What Nitinol recovers from; steel yields long before.
constexpr double max_strain = 0.08;

void warn_of_rods(const Checked& checked) {
  const Answer& home = checked.home;
  if (home.find("error")) return;
  if (!home.find("legs"))
    return message("warning: no lengths hold the platform at home: " + home.text("message"));
  if (!home.converged()) message("warning: home is " + home.text("status") + ": " + home.text("message"));
  if (const double strain = number(home.root(), "margins.strain"); strain > max_strain)
    message(fmt::format(
        "warning: at home the rods bend to a strain of {:.3g} %; few materials recover from more than "
        "{:.3g} %",
        100 * strain, 100 * max_strain));
}

void suspect_at_home(const Node& leg, const Node& state, std::size_t i, PerLeg& warnings) {
  if (at(leg, "link.type")->text == "rod") return suspect_rod_at_home(leg, state, i, warnings);
  const double length = number(leg, "link.length"), chord = number(state, "chord");
  const double turns = std::abs(number(state, "curvature")) * length / (2 * std::numbers::pi);
  const bool is_stretched = at(leg, "closure.type")->text != "strut" && chord > 0.999 * length;
  if (is_stretched)
    warnings.add(
        i, fmt::format("at home it is stretched almost straight, chord {} of length {}: nearly out of reach",
                       human(chord, Dimension::length), human(length, Dimension::length)));
  if (turns > 1)
    warnings.add(i, fmt::format("at home it bends by {:.0f} deg, more than a full turn", turns * 360));
}

/// Where platform, legs and actuators do not match one to one.
void warn_of_freedoms(const Answer& about) {
  const int platform = static_cast<int>(about.number("freedoms.platform").value_or(0)),
            held = static_cast<int>(about.number("freedoms.constraints").value_or(0)),
            driven = static_cast<int>(about.number("freedoms.actuators").value_or(0));
  if (held < platform)
    message(
        fmt::format("warning: the legs hold {} of the platform's {} freedoms; it moves with the inputs "
                    "held",
                    held, platform));
  if (held > platform)
    message(
        fmt::format("warning: the legs hold {} freedoms, the platform has {}; only inputs that fit "
                    "together can be reached",
                    held, platform));
  if (driven > held)
    message(
        fmt::format("warning: the robot is redundant: {} actuators move {} freedoms, so the links can "
                    "move while the platform stands still",
                    driven, held));
}

void warn(const Checked& checked) {
  const Node& legs = *checked.robot.description.find("legs");
  const Node* at_home = checked.home.find("legs");
  PerLeg warnings(legs.items.size());
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    suspect(legs.items[i], i, warnings);
    if (at_home) suspect_at_home(legs.items[i], at_home->items[i], i, warnings);
  }
  warnings.each(
      [](const std::string& who, const std::string& what) { message("warning: " + who + ": " + what); });
  warn_of_freedoms(checked.robot.description);
  if (checked.robot.is_on_rods) return warn_of_rods(checked);
  if (!checked.home.converged())
    message("warning: the home pose cannot be reached: " + checked.home.text("message"));
}

/// A study file, or a name that is no robot's: what has a query and axes is not taken for a robot.
bool may_be_study(const std::string& name) {
  const auto text = read_robot_text(name);
  if (!text) return name.find_first_of("./") == std::string::npos;  // else the file's own error says more
  const auto document = parse_yaml(*text, name);
  if (!document) return false;
  const auto has_any = [&](std::initializer_list<std::string_view> keys) {
    return std::ranges::any_of(keys, [&](std::string_view key) { return document->root.find(key); });
  };
  return has_any({"query", "axes", "random", "listed"}) && !has_any({"legs", "sections", "architecture"});
}

bool is_scene(const std::string& name) {
  const auto text = read_robot_text(name);
  const auto document = text ? parse_yaml(*text, name) : tl::unexpected(Errors{});
  const Node* kind = document ? document->root.find("kind") : nullptr;
  return kind && kind->text == "scene";
}

}  // namespace

int run_check(const Arguments& arguments) {
  const bool is_of_scene = is_scene(arguments.operand());
  if (is_of_scene || may_be_study(arguments.operand())) {
    if (arguments.has("set"))
      return refuse(arguments.verb,
                    {{"no_effect", "--set", "it changes a robot, and this file is none; leave it out"}});
    return is_of_scene ? check_scene(arguments) : check_study(arguments);
  }
  auto robot = open(arguments);
  if (!robot) {
    if (arguments.has("json")) print(json_error(robot.error()) + '\n');
    return refuse(arguments.verb, robot.error());
  }
  if (is_serial(*robot)) {
    print(arguments.has("json") ? robot->description.line() + '\n' : show_serial_robot(*robot));
    return solved;
  }
  if (is_arm(*robot)) {
    print(arguments.has("json") ? robot->description.line() + '\n' : show_arm_robot(*robot));
    return solved;
  }
  if (stands_on_arms(*robot)) {
    print(arguments.has("json") ? robot->description.line() + '\n' : show_arm_legs_robot(*robot));
    return solved;
  }
  const auto changes = settings(arguments);
  const Checked checked = put_questions(std::move(*robot), changes ? *changes : std::vector<Member>());
  print(arguments.has("json") ? checked.robot.description.line() + '\n' : show(checked));
  if (!arguments.has("quiet")) warn(checked);
  return solved;
}

}  // namespace sinew::cli
