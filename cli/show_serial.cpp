/// Answers of serial robots, as people read them.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/robots/serial_file.hpp"
#include "show.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

/// The two numbers of a section's configuration.
std::array<std::string_view, 2> coordinates(const OpenRobot& robot, std::size_t section) {
  const bool is_twin = robot.description.text(fmt::format("sections[{}].type", section)) == "tpcj";
  return is_twin ? std::array<std::string_view, 2>{"beta_1", "beta_2"}
                 : std::array<std::string_view, 2>{"theta", "phi"};
}

std::size_t max_tendons(const Node& changes) {
  std::size_t most = 0;
  for (const Node& section : changes.items) most = std::max(most, section.items.size());
  return most;
}

/// Columns for the coordinates of all sections. Where these are of two kinds, the headings name both's.
std::vector<std::string> coordinate_columns(const OpenRobot& robot, std::string_view per = {}) {
  const auto& sections = robot.description.find("sections")->items;
  const auto first = coordinates(robot, 0);
  bool is_one_kind = true, has_extension = false;
  for (std::size_t m = 0; m < sections.size(); ++m) {
    is_one_kind = is_one_kind && coordinates(robot, m) == first;
    has_extension = has_extension || sections[m].find("extension");
  }
  std::vector<std::string> columns{fmt::format("{}[deg{}]", is_one_kind ? first[0] : "theta|beta_1", per),
                                   fmt::format("{}[deg{}]", is_one_kind ? first[1] : "phi|beta_2", per)};
  if (has_extension) columns.push_back(fmt::format("extension[mm{}]", per));
  return columns;
}

/// Their cells of one section, of a configuration or its rate.
void append_coordinates(const Node& section, std::size_t columns, std::vector<std::string>& row) {
  constexpr std::string_view units[] = {"rad", "rad", "m"};
  for (std::size_t j = 0; j < columns; ++j)
    row.push_back(j < section.items.size() ? cell(section.items[j].number, units[j]) : "-");
}

/// Configuration and changes of each section.
std::string show_sections(const Answer& answer, const OpenRobot& robot) {
  const auto &bends = answer.find("configuration")->items, &changes = answer.find("changes")->items;
  const auto columns = coordinate_columns(robot);
  std::vector<std::string> header{"section"};
  header.insert(header.end(), columns.begin(), columns.end());
  const std::size_t tendons = max_tendons(*answer.find("changes"));
  for (std::size_t i = 0; i < tendons; ++i) header.push_back(heading(fmt::format("change_{}", i), "m"));
  TextTable table(std::move(header));
  for (std::size_t m = 0; m < bends.size(); ++m) {
    std::vector<std::string> row{fmt::format("sections[{}]", m)};
    append_coordinates(bends[m], columns.size(), row);
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
std::string show_solutions(const Answer& answer, const OpenRobot& robot) {
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

std::string show_tip_velocity(const Answer& answer, const OpenRobot& robot) {
  std::vector<std::string> J{"J"}, K{"K"}, tendons;
  const auto& sections = robot.description.find("sections")->items;
  for (std::size_t m = 0; m < sections.size(); ++m) {
    for (const std::string_view name : coordinates(robot, m))
      J.push_back(fmt::format("{}[{}][rad/s]", name, m));
    if (sections[m].find("extension")) J.push_back(fmt::format("extension[{}][m/s]", m));
  }
  K.insert(K.end(), J.begin() + 1, J.end());
  for (const Input& input : robot.inputs) tendons.push_back(input.name + "[m/s]");
  const auto si = [](std::size_t, std::size_t) { return 1.0; };
  std::string text =
      show_matrix(*answer.find("J"), std::move(J),
                  {"vx[m/s]", "vy[m/s]", "vz[m/s]", "wx[rad/s]", "wy[rad/s]", "wz[rad/s]"}, si) +
      '\n' + show_matrix(*answer.find("K"), std::move(K), tendons, si);
  for (const char* key : {"condition", "condition_homogenised", "position", "rotation"})
    if (const auto value = answer.number(fmt::format("indices.{}", key)))
      text += fmt::format("{} {}\n", key, six_digits(*value));
  if (const Node* rates = answer.find("rates")) {
    const auto columns = coordinate_columns(robot, "/s");
    std::vector<std::string> header{"rate of"};
    header.insert(header.end(), columns.begin(), columns.end());
    TextTable table(std::move(header));
    for (std::size_t m = 0; m < rates->items.size(); ++m) {
      std::vector<std::string> row{fmt::format("sections[{}]", m)};
      append_coordinates(rates->items[m], columns.size(), row);
      table.add(std::move(row));
    }
    text += '\n' + table.text();
  }
  return text;
}

std::string show_points(std::string_view title, const Node* points, const OpenRobot& robot,
                        std::size_t section) {
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

bool is_serial(const OpenRobot& robot) { return robot.description.text("kind") == "serial"; }

std::string show_serial_robot(const OpenRobot& robot) {
  const Answer& about = robot.description;
  const auto& sections = about.find("sections")->items;
  TextTable table({"section", "type", "segments", "length[mm]", "joint[mm]", "disc_radius[mm]", "tendons",
                   "tendon_radius[mm]", "tendon_angle[deg]", "limit[deg]", "extension[mm]"});
  const auto shown_at = [](const Node& section, std::string_view path, std::string_view unit) {
    const Node* value = at(section, path);
    return value ? cell(value->number, unit) : std::string("-");
  };
  const auto shown_extension = [](const Node& section) {
    const auto range = numbers(section.find("extension"));
    return range.empty() ? std::string("-") : fmt::format("{}..{}", cell(range[0], "m"), cell(range[1], "m"));
  };
  for (std::size_t m = 0; m < sections.size(); ++m) {
    const Node& section = sections[m];
    table.add({fmt::format("sections[{}]", m), section.find("type")->text,
               six_digits(number(section, "segments")), shown_at(section, "length", "m"),
               shown_at(section, "joint", "m"), shown_at(section, "disc.radius", "m"),
               six_digits(number(section, "tendons.count")), shown_at(section, "tendons.radius", "m"),
               shown_at(section, "tendons.angle", "rad"), shown_at(section, "limit", "rad"),
               shown_extension(section)});
  }
  return fmt::format(
             "{}: serial robot, {} section{}, {} tendons, {} mm long\ntolerance of a tendon {} mm\n\n",
             about.text("robot"), sections.size(), sections.size() == 1 ? "" : "s", robot.inputs.size(),
             cell(about.number("length").value_or(0), "m"),
             cell(about.number("tolerance").value_or(0), "m")) +
         table.text();
}

std::string show_serial(const Answer& answer, const OpenRobot& robot) {
  if (answer.text("query") == "velocity") return show_tip_velocity(answer, robot);
  if (!answer.find("configuration")) return {};
  return show_sections(answer, robot) + '\n' + show_ends(*answer.find("sections")) +
         show_solutions(answer, robot) + (answer.find("J") ? '\n' + show_tip_velocity(answer, robot) : "");
}

/// After "an earlier section is not exact".
std::string_view outline_note(const Answer& answer) {
  constexpr std::pair<std::string_view, std::string_view> notes[] = {
      {"previous_over_tensioned", "; it is over-tensioned, so there is no outline"},
      {"over_tensioned", "; this one is over-tensioned, so there is no outline"},
      {"beyond_envelope", "; the outline lies beyond the limit"},
      {"exact_model", "; the model pcc has no outline"}};
  for (const auto& [reason, note] : notes)
    if (answer.text("no_outline") == reason) return note;
  return answer.find("outline") ? ": see outline" : "";
}

std::string show_diagram(const Answer& answer, const OpenRobot& robot, std::size_t section) {
  const auto slack = numbers(answer.find("slack"));
  TextTable table({"tendon", heading("slack", "m")});
  for (std::size_t i = 0; i < slack.size(); ++i) table.add({fmt::format("{}", i), cell(slack[i], "m")});
  std::string text =
      fmt::format("{}{}\n", answer.text("class"), answer.find("partial")->boolean ? ", partially" : "");
  if (answer.find("conditional")->boolean)
    text += fmt::format("an earlier section is not exact{}\n", outline_note(answer));
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
