/// Answers of serial robots, as people read them.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "show.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

/// The two numbers of a section's configuration.
std::array<std::string_view, 2> coordinates(const Robot& robot, std::size_t section) {
  const bool is_twin = robot.description.text(fmt::format("sections[{}].type", section)) == "tpcj";
  return is_twin ? std::array<std::string_view, 2>{"beta_1", "beta_2"}
                 : std::array<std::string_view, 2>{"theta", "phi"};
}

std::size_t most_tendons(const Node& changes) {
  std::size_t most = 0;
  for (const Node& section : changes.items) most = std::max(most, section.items.size());
  return most;
}

/// Configuration and changes of each section. Where sections are of two kinds, the headings name neither's
/// coordinates.
std::string show_sections(const Answer& answer, const Robot& robot) {
  const auto &bends = answer.find("configuration")->items, &changes = answer.find("changes")->items;
  const auto first = coordinates(robot, 0);
  bool is_one_kind = true;
  for (std::size_t m = 1; m < bends.size(); ++m) is_one_kind = is_one_kind && coordinates(robot, m) == first;
  std::vector<std::string> header{"section"};
  for (const std::size_t j : {0U, 1U})
    header.push_back(heading(is_one_kind ? first[j] : j == 0 ? "theta|beta_1" : "phi|beta_2", "rad"));
  const std::size_t tendons = most_tendons(*answer.find("changes"));
  for (std::size_t i = 0; i < tendons; ++i) header.push_back(heading(fmt::format("change_{}", i), "m"));
  TextTable table(std::move(header));
  for (std::size_t m = 0; m < bends.size(); ++m) {
    std::vector<std::string> row{fmt::format("sections[{}]", m)};
    for (const Node& part : bends[m].items) row.push_back(cell(part.number, "rad"));
    for (std::size_t i = 0; i < tendons; ++i)
      row.push_back(i < changes[m].items.size() ? cell(changes[m].items[i].number, "m") : "-");
    table.add(std::move(row));
  }
  return table.text();
}

/// Pose of each section's end; the last is the tip.
std::string show_ends(const Node& ends) {
  std::vector<std::string> header{"end of"};
  const auto columns = pose_columns(true);
  for (const Input& column : columns) header.push_back(heading(column.name, column.unit));
  TextTable table(std::move(header));
  for (std::size_t m = 0; m < ends.items.size(); ++m) {
    std::vector<std::string> row{fmt::format("sections[{}]", m)};
    const auto values = pose_values(ends.items[m]);
    for (std::size_t i = 0; i < values.size(); ++i) row.push_back(cell(values[i], columns[i].unit));
    table.add(std::move(row));
  }
  return table.text();
}

/// One row a solution and section, where all were asked for.
std::string show_solutions(const Answer& answer, const Robot& robot) {
  const Node* solutions = answer.find("solutions");
  if (!solutions) return {};
  const auto names = coordinates(robot, 0);
  TextTable table({"solution", "section", heading(names[0], "rad"), heading(names[1], "rad")});
  for (std::size_t k = 0; k < solutions->items.size(); ++k) {
    const auto& sections = solutions->items[k].find("configuration")->items;
    for (std::size_t m = 0; m < sections.size(); ++m)
      table.add({fmt::format("{}", k + 1), fmt::format("sections[{}]", m),
                 cell(sections[m].items[0].number, "rad"), cell(sections[m].items[1].number, "rad")});
  }
  const bool is_complete = answer.find("complete")->boolean;
  return '\n' + table.text() +
         fmt::format("{}{} solution{}{}\n", is_complete ? "" : "at least ", solutions->items.size(),
                     solutions->items.size() == 1 ? "" : "s", is_complete ? ", all there are" : "");
}

std::string show_tip_velocity(const Answer& answer, const Robot& robot) {
  std::vector<std::string> J{"J"}, K{"K"}, tendons;
  const auto& sections = robot.description.find("sections")->items;
  for (std::size_t m = 0; m < sections.size(); ++m)
    for (const std::string_view name : coordinates(robot, m)) J.push_back(fmt::format("{}[{}]", name, m));
  K.insert(K.end(), J.begin() + 1, J.end());
  for (const Input& input : robot.inputs) tendons.push_back(input.name);
  const auto si = [](std::size_t, std::size_t) { return 1.0; };
  std::string text = show_matrix(*answer.find("J"), std::move(J), {"vx", "vy", "vz", "wx", "wy", "wz"}, si) +
                     '\n' + show_matrix(*answer.find("K"), std::move(K), tendons, si);
  for (const char* key : {"condition", "condition_homogenised", "position", "rotation"})
    if (const auto value = answer.number(fmt::format("indices.{}", key)))
      text += fmt::format("{}{} {}\n", text.ends_with("\n\n") ? "" : "", key, six_digits(*value));
  if (const Node* rates = answer.find("rates")) {
    TextTable table({"section", "rate_1[deg/s]", "rate_2[deg/s]"});
    for (std::size_t m = 0; m < rates->items.size(); ++m)
      table.add({fmt::format("sections[{}]", m), cell(rates->items[m].items[0].number, "rad"),
                 cell(rates->items[m].items[1].number, "rad")});
    text += '\n' + table.text();
  }
  return text;
}

std::string show_points(std::string_view title, const Node* points, const Robot& robot, std::size_t section) {
  if (!points || points->items.empty()) return {};
  const bool is_twin = coordinates(robot, section)[0] == "beta_1";
  TextTable table({std::string(title), heading(is_twin ? "beta_1" : "theta cos phi", "rad"),
                   heading(is_twin ? "beta_2" : "theta sin phi", "rad")});
  for (std::size_t k = 0; k < points->items.size(); ++k)
    table.add({fmt::format("{}", k + 1), cell(points->items[k].items[0].number, "rad"),
               cell(points->items[k].items[1].number, "rad")});
  return '\n' + table.text();
}

}  // namespace

bool is_serial(const Robot& robot) { return robot.description.text("kind") == "serial"; }

std::string show_serial_robot(const Robot& robot) {
  const Answer& about = robot.description;
  const auto& sections = about.find("sections")->items;
  TextTable table({"section", "type", "segments", "length[mm]", "joint[mm]", "disc_radius[mm]", "tendons",
                   "tendon_radius[mm]", "tendon_angle[deg]", "limit[deg]"});
  const auto shown_at = [](const Node& section, std::string_view path, std::string_view unit) {
    const Node* value = at(section, path);
    return value ? cell(value->number, unit) : std::string("-");
  };
  for (std::size_t m = 0; m < sections.size(); ++m) {
    const Node& section = sections[m];
    table.add({fmt::format("sections[{}]", m), section.find("type")->text,
               six_digits(number(section, "segments")), shown_at(section, "length", "m"),
               shown_at(section, "joint", "m"), shown_at(section, "disc.radius", "m"),
               six_digits(number(section, "tendons.count")), shown_at(section, "tendons.radius", "m"),
               shown_at(section, "tendons.angle", "rad"), shown_at(section, "limit", "rad")});
  }
  return fmt::format(
             "{}: serial robot, {} section{}, {} tendons, {} mm long\ntolerance of a tendon {} mm\n\n",
             about.text("robot"), sections.size(), sections.size() == 1 ? "" : "s", robot.inputs.size(),
             cell(about.number("length").value_or(0), "m"),
             cell(about.number("tolerance").value_or(0), "m")) +
         table.text();
}

std::string show_serial(const Answer& answer, const Robot& robot) {
  if (answer.text("query") == "velocity") return show_tip_velocity(answer, robot);
  if (!answer.find("configuration")) return {};
  return show_sections(answer, robot) + '\n' + show_ends(*answer.find("sections")) +
         show_solutions(answer, robot);
}

std::string show_diagram(const Answer& answer, const Robot& robot, std::size_t section) {
  const auto slack = numbers(answer.find("slack"));
  TextTable table({"tendon", heading("slack", "m")});
  for (std::size_t i = 0; i < slack.size(); ++i) table.add({fmt::format("{}", i), cell(slack[i], "m")});
  std::string text =
      fmt::format("{}{}\n", answer.text("class"), answer.find("partial")->boolean ? ", partially" : "");
  if (answer.find("conditional")->boolean) text += "an earlier section is not exact: see outline\n";
  text += '\n' + table.text();
  for (const char* key : {"margin", "over_tension"})
    if (const auto value = answer.number(key)) text += fmt::format("{}[mm] {}\n", key, cell(*value, "m"));
  Node point;
  point.kind = Node::Kind::list;
  point.items.push_back(*answer.find("point"));
  text += show_points("point", &point, robot, section) +
          show_points("polygon", answer.find("polygon"), robot, section);
  const Node* boundary = answer.find("boundary");
  if (boundary && boundary->items.size() <= 24) text += show_points("boundary", boundary, robot, section);
  text += show_points("outline", answer.find("outline"), robot, section);
  return text;
}

}  // namespace sinew::cli
