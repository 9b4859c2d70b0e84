/// check: what a robot file means, or everything that is wrong with it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "show.hpp"
#include "sinew/io/quantity.hpp"
#include "terminal.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

/// A robot put to three questions: what it has, what it needs at home, how it moves there.
struct Checked {
  Answer description, home, velocity;
};

Checked put_questions(Session& session) {
  Answer description = ask(session, R"({"query": "describe"})");
  const Node& pose = *description.find("home");
  const std::string at = fmt::format(R"("pose": {{"x": {}, "y": {}, "phi": {}}})", pose.find("x")->text,
                                     pose.find("y")->text, pose.find("phi")->text);
  return {std::move(description), ask(session, R"({"query": "inverse", )" + at + "}"),
          ask(session, R"({"query": "velocity", )" + at + "}")};
}

double number(const Node& map, std::string_view path) {
  const Node* node = at(map, path);
  return node ? node->number : 0.0;
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
  if (is_one_of({"length", "tendon_offset", "diameter"}))
    return fmt::format("{} {} m = {}", key, si_text(value.number), human(value.number, Dimension::length));
  if (key == "E") return fmt::format("E {} Pa = {:.6g} GPa", si_text(value.number), value.number / 1e9);
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

std::string show_points(const Node& legs) {
  const bool has_direction =
      std::ranges::any_of(legs.items, [](const Node& leg) { return at(leg, "base.direction"); });
  std::vector<std::string> header{"leg", "base_x[mm]", "base_y[mm]", "platform_x[mm]", "platform_y[mm]"};
  if (has_direction) header.emplace_back("direction[deg]");
  TextTable table(std::move(header));
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    const Node& leg = legs.items[i];
    std::vector<std::string> row{fmt::format("legs[{}]", i)};
    for (const std::string_view path :
         {"base.point[0]", "base.point[1]", "platform_point[0]", "platform_point[1]"})
      row.push_back(cell(number(leg, path), "m"));
    if (has_direction)
      row.push_back(at(leg, "base.direction") ? cell(number(leg, "base.direction"), "rad") : "-");
    table.add(std::move(row));
  }
  return table.text();
}

std::string show_limits(const Node& inputs) {
  TextTable table({"input", "unit", "least", "most"});
  for (const Node& input : inputs.items) {
    const std::string& unit = input.find("unit")->text;
    table.add({input.find("name")->text, std::string(shown(unit).unit),
               cell(number(input, "limits[0]"), unit), cell(number(input, "limits[1]"), unit)});
  }
  return table.text();
}

std::string show_home(const Checked& robot) {
  std::string text = "home\n" + show_pose(*robot.description.find("home"));
  if (!robot.home.converged())
    return text + "\n" + robot.home.text("status") + ": " + robot.home.text("message") + "\n";
  text += '\n' + show_legs(*robot.home.find("legs"));
  if (!robot.velocity.find("J")) return text;
  return text + '\n' + show_indices(robot.velocity, input_names(robot.description)) + '\n' +
         show_singularities(robot.velocity);
}

std::string show(const Checked& robot) {
  const Answer& about = robot.description;
  const Node &legs = *about.find("legs"), &inputs = *about.find("inputs");
  std::string text =
      fmt::format("{}: {} {} robot, {} legs, {} inputs, model {}, geometry: {}\n", about.text("robot"),
                  about.text("space"), about.text("kind"), legs.items.size(), inputs.items.size(),
                  about.text("model"), about.text("geometry"));
  PerLeg parts(legs.items.size());
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    parts.add(i, "link " + show_part(*legs.items[i].find("link")));
    parts.add(i, "closure " + show_part(*legs.items[i].find("closure")));
  }
  parts.each([&](const std::string& who, const std::string& what) { text += who + ": " + what + '\n'; });
  if (const auto radius = about.number("platform.radius"))
    text += fmt::format("platform: radius {} m = {}\n", si_text(*radius), human(*radius, Dimension::length));
  return text + '\n' + show_limits(inputs) + '\n' + show_points(legs) + '\n' + show_home(robot);
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
  if (diameter > length / 10)
    warnings.add(
        i,
        fmt::format("the diameter of {} is more than a tenth of the length of {}: too thick for an elastic "
                    "backbone; is a unit wrong?",
                    mm(diameter), mm(length)));
  if (E > 0 && (E < 1e3 || E > 1e12))
    warnings.add(
        i, fmt::format("Young's modulus of {} Pa is outside 1 kPa to 1 TPa; is a unit wrong?", si_text(E)));
}

void suspect_at_home(const Node& leg, const Node& state, std::size_t i, PerLeg& warnings) {
  const double length = number(leg, "link.length"), chord = number(state, "chord");
  const double turns = std::abs(number(state, "curvature")) * length / (2 * std::numbers::pi);
  if (chord > 0.999 * length)
    warnings.add(
        i, fmt::format("at home it is stretched almost straight, chord {} of length {}: nearly out of reach",
                       human(chord, Dimension::length), human(length, Dimension::length)));
  if (turns > 1)
    warnings.add(i, fmt::format("at home it bends by {:.0f} deg, more than a full turn", turns * 360));
}

void warn(const Checked& robot) {
  const Node& legs = *robot.description.find("legs");
  const Node* at_home = robot.home.find("legs");
  PerLeg warnings(legs.items.size());
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    suspect(legs.items[i], i, warnings);
    if (at_home) suspect_at_home(legs.items[i], at_home->items[i], i, warnings);
  }
  warnings.each(
      [](const std::string& who, const std::string& what) { message("warning: " + who + ": " + what); });
  if (!robot.home.converged())
    message("warning: the home pose cannot be reached: " + robot.home.text("message"));
}

}  // namespace

int run_check(const Arguments& arguments) {
  auto session = Session::open(arguments.operand());
  if (!session) {
    if (arguments.has("json")) print(json_error(session.error()) + '\n');
    return refuse(arguments.verb, session.error());
  }
  const Checked robot = put_questions(*session);
  print(arguments.has("json") ? robot.description.line + '\n' : show(robot));
  if (!arguments.has("quiet")) warn(robot);
  return solved;
}

}  // namespace sinew::cli
