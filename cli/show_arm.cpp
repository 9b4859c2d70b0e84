/// What an arm is made of, as people read it.
#include <fmt/format.h>

#include <algorithm>

#include "io/robots/arm_file.hpp"
#include "show.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

/// The number at a path in SI, or `-`.
std::string si_at(const Node& map, std::string_view path) {
  const Node* value = at(map, path);
  return value ? six_digits(value->number) : std::string("-");
}
std::string shown_at(const Node& map, std::string_view path, std::string_view unit) {
  const Node* value = at(map, path);
  return value ? cell(value->number, unit) : std::string("-");
}

/// Stiffness and mass of each section, where it tapers at both ends, and its discs.
std::string show_backbone(const Answer& about) {
  TextTable table({"section", "length[mm]", "bending_x[N m^2]", "bending_y[N m^2]", "torsion[N m^2]",
                   "stretch[N]", "shear[N]", "mass[kg/m]", "discs", "disc_radius[mm]", "disc_mass[kg]",
                   "tendons"});
  const auto& sections = about.find("sections")->items;
  for (std::size_t m = 0; m < sections.size(); ++m) {
    const Node& section = sections[m];
    std::size_t tendons = 0;
    for (const Node& tendon : about.find("tendons")->items)
      if (number(tendon, "section") == static_cast<double>(m)) ++tendons;
    const auto add = [&](std::string name, std::string_view of, bool is_first) {
      const Node& backbone = *at(section, of);
      table.add({std::move(name), is_first ? shown_at(section, "length", "m") : "-",
                 si_at(backbone, "bending[0]"), si_at(backbone, "bending[1]"), si_at(backbone, "torsion"),
                 si_at(backbone, "stretch"), si_at(backbone, "shear"), si_at(backbone, "mass"),
                 !is_first                    ? "-"
                 : at(section, "discs.count") ? si_at(section, "discs.count")
                                              : "channel",
                 is_first ? shown_at(section, "discs.radius", "m") : "-",
                 is_first ? si_at(section, "discs.mass") : "-", is_first ? fmt::format("{}", tendons) : "-"});
    };
    add(fmt::format("sections[{}]", m), "backbone", true);
    if (at(section, "backbone.end")) add(fmt::format("sections[{}].end", m), "backbone.end", false);
  }
  return table.text();
}

/// One row a tendon and the sections that it passes alike.
std::string show_tendons(const Answer& about, const OpenRobot& robot) {
  TextTable table({"tendon", "in", "radius[mm]", "angle[deg]", "end_radius[mm]", "turn[deg]",
                   "compliance[m/N]", "outside", "friction", "pretension[N]"});
  const auto& tendons = about.find("tendons")->items;
  for (std::size_t i = 0; i < tendons.size(); ++i) {
    const auto& routes = tendons[i].find("routes")->items;
    for (std::size_t first = 0, last = 0; first < routes.size(); first = ++last) {
      while (last + 1 < routes.size() && as_json(routes[last + 1]) == as_json(routes[first])) ++last;
      const Node& route = routes[first];
      table.add(
          {robot.inputs[i].name,
           first == last ? fmt::format("sections[{}]", first) : fmt::format("sections[{}..{}]", first, last),
           shown_at(route, "radius", "m"), shown_at(route, "angle", "rad"),
           shown_at(route, "end_radius", "m"), shown_at(route, "turn", "rad"),
           si_at(tendons[i], "compliance"), si_at(tendons[i], "outside"), si_at(tendons[i], "friction"),
           si_at(tendons[i], "pretension")});
    }
  }
  return table.text();
}

std::string vector_text(const Node* list) { return fmt::format("[{}]", fmt::join(numbers(list), ", ")); }

/// What each tendon does.
std::string show_tendon_states(const Answer& answer, const OpenRobot& robot) {
  TextTable table({"tendon", "tension[N]", "change[mm]", "slack[mm]"});
  std::size_t next = 0;
  const auto& tensions = answer.find("tensions")->items;
  for (std::size_t m = 0; m < tensions.size(); ++m)
    for (std::size_t i = 0; i < tensions[m].items.size(); ++i) {
      const auto cell_of = [&](std::string_view key, std::string_view unit) {
        return cell(answer.find(key)->items[m].items[i].number, unit);
      };
      table.add({robot.inputs[next++].name, cell_of("tensions", "N"), cell_of("changes", "m"),
                 cell_of("slack", "m")});
    }
  return table.text();
}

std::string show_arm_matrix(const Answer& answer, std::string_view key, std::string_view what) {
  const Node* matrix = answer.find(key);
  if (!matrix) return {};
  std::string text = fmt::format("\n{} [{}]\n", key, what);
  std::vector<std::string> header;
  for (std::size_t j = 0; j < matrix->items.front().items.size(); ++j) header.push_back(fmt::format("{}", j));
  TextTable table(std::move(header));
  for (const Node& line : matrix->items) {
    std::vector<std::string> row;
    for (const Node& one : line.items) row.push_back(six_digits(one.number));
    table.add(std::move(row));
  }
  return text + table.text();
}

/// Between motors and tendons, and where the marker is.
std::string show_measurement(const Answer& about, const OpenRobot& robot) {
  if (!about.find("measurement")) return {};
  const auto values = [&](std::string_view path) { return numbers(about.find(path)); };
  std::string text = fmt::format("\nmeasured (for identify alone): lag {} s, play {} mm\n",
                                 six_digits(about.number("measurement.drive.lag").value_or(0)),
                                 cell(about.number("measurement.drive.play").value_or(0), "m"));
  TextTable drive({"tendon", "gain", "offset[mm]", "toe[mm]"});
  const auto gains = values("measurement.drive.gain"), offsets = values("measurement.drive.offset"),
             toes = values("measurement.drive.toe");
  for (std::size_t i = 0; i < gains.size(); ++i)
    drive.add({robot.inputs[i].name, six_digits(gains[i]), cell(offsets[i], "m"), cell(toes[i], "m")});
  TextTable marker({"marker", "x", "y", "z"});
  for (const auto& [name, path, unit] : {std::array{"place[mm]", "measurement.marker.place", "m"},
                                         std::array{"base[mm]", "measurement.marker.base", "m"},
                                         std::array{"tilt[deg]", "measurement.marker.tilt", "rad"}}) {
    const auto three = values(path);
    marker.add({name, cell(three[0], unit), cell(three[1], unit), cell(three[2], unit)});
  }
  return text + drive.text() + '\n' + marker.text();
}

}  // namespace

bool stands_on_arms(const OpenRobot& robot) { return robot.description.text("kind") == "arm_legs"; }

std::string show_arm_legs_robot(const OpenRobot& robot) {
  const Answer& about = robot.description;
  std::string text = fmt::format("{}: platform on legs of sections, {} tendons, geometry: {}\n",
                                 about.text("robot"), robot.inputs.size(), about.text("geometry"));
  text += fmt::format("gravity: {} m/s^2, platform: {} kg\n\n", vector_text(about.find("gravity")),
                      six_digits(about.number("platform.mass").value_or(0)));
  TextTable table({"leg", "sections", "tendons", "length[mm]", "closure", "base[m]", "platform_point[m]"});
  const auto& legs = about.find("legs")->items;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const auto& sections = at(legs[k], "link.sections")->items;
    std::vector<int> counts(sections.size());
    for (const Node& tendon : at(legs[k], "link.tendons")->items)
      ++counts[static_cast<std::size_t>(number(tendon, "section"))];
    table.add({fmt::format("legs[{}]", k), fmt::format("{}", sections.size()),
               fmt::format("{}", fmt::join(counts, "+")), shown_at(legs[k], "link.length", "m"),
               at(legs[k], "closure.type")->text, vector_text(at(legs[k], "base.point")),
               vector_text(at(legs[k], "platform_point"))});
  }
  return text + table.text();
}

std::string show_arm_legs(const Answer& answer, const OpenRobot& robot) {
  if (!answer.find("pose")) return {};
  std::string text = show_pose(*answer.find("pose")) + '\n' + show_tendon_states(answer, robot) + '\n';
  const bool is_planar = robot.description.text("space") == "planar";
  TextTable table(is_planar ? std::vector<std::string>{"on the tip of", "fx[N]", "fy[N]", "mz[N m]"}
                            : std::vector<std::string>{"on the tip of", "fx[N]", "fy[N]", "fz[N]", "mx[N m]",
                                                       "my[N m]", "mz[N m]"});
  const auto& legs = answer.find("legs")->items;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    std::vector<double> parts;
    for (const char* part : {"force", "moment"})
      for (const double value : numbers(legs[k].find(part))) parts.push_back(value);
    if (is_planar) parts.erase(parts.begin() + 2, parts.end() - 1);
    std::vector<std::string> row{fmt::format("legs[{}]", k)};
    for (const double value : parts) row.push_back(six_digits(value));
    table.add(std::move(row));
  }
  text += table.text();
  if (const Node* wrench = answer.find("wrench")) {
    text +=
        fmt::format("\nwrench on the platform beside weight and load [N, N m]: {}\n", vector_text(wrench));
    if (const auto misfit = answer.number("misfit"))
      text += fmt::format("misfit {}, best known over worst known direction {}\n", six_digits(*misfit),
                          six_digits(answer.number("condition").value_or(0)));
  }
  if (answer.find("load")) text += '\n' + show_load(answer);
  text += show_arm_matrix(answer, "U", "twist of the platform by what holds each tendon");
  text += show_arm_matrix(answer, "stiffness", "wrench on the platform by its twist: N/m, N, N m");
  if (const auto resolution = answer.number("resolution"))
    text += fmt::format("\nfiner polynomials move the platform by {} mm\n", six_digits(1000 * *resolution));
  return text;
}

bool is_arm(const OpenRobot& robot) { return robot.description.text("kind") == "arm"; }

std::string show_arm_robot(const OpenRobot& robot) {
  const Answer& about = robot.description;
  const std::size_t sections = about.find("sections")->items.size();
  std::string text = fmt::format(
      "{}: tendon-driven arm, {} section{}, {} tendon{}, {} mm long, geometry: {}\n", about.text("robot"),
      sections, sections == 1 ? "" : "s", robot.inputs.size(), robot.inputs.size() == 1 ? "" : "s",
      cell(about.number("length").value_or(0), "m"), about.text("geometry"));
  text += fmt::format("gravity: {} m/s^2\n", vector_text(about.find("gravity")));
  if (const double mass = about.number("tip.mass").value_or(0); mass > 0)
    text += fmt::format("tip: mass {} kg at {} m\n", six_digits(mass), vector_text(about.find("tip.place")));
  text += fmt::format("tolerance of a tendon {} mm\n\n", cell(about.number("tolerance").value_or(0), "m"));
  text += show_backbone(about) + '\n' + show_tendons(about, robot);
  const auto rubs = [](const Node& tendon) { return number(tendon, "friction") > 0; };
  if (std::ranges::any_of(about.find("tendons")->items, rubs))
    text += "\ntendons rub: sinew track follows a path with their friction, other questions leave it out\n";
  return text + show_measurement(about, robot);
}

std::string show_arm(const Answer& answer, const OpenRobot& robot) {
  if (!answer.find("tip")) return {};
  std::string text = show_pose(*answer.find("tip")) + '\n' + show_tendon_states(answer, robot);
  if (const Node* wrench = answer.find("wrench"))
    text += fmt::format("\nwrench at the tip [N, N m]: {}, misfit {}\n", vector_text(wrench),
                        six_digits(answer.number("misfit").value_or(0)));
  text += show_arm_matrix(answer, "U", "twist of the tip by what holds each tendon");
  text += show_arm_matrix(answer, "compliance",
                          "twist of the tip by a wrench there: m/N, rad/N, m/(N m), rad/(N m)");
  text += show_arm_matrix(answer, "stiffness", "its inverse");
  if (const auto margin = answer.number("buckling_margin"))
    text +=
        fmt::format("\nbuckling margin {} (about 1 without load, 0 where it buckles)\n", six_digits(*margin));
  if (answer.find("load")) text += '\n' + show_load(answer);
  if (const Node* solutions = answer.find("solutions")) {
    TextTable table({"equilibrium", "x[mm]", "y[mm]", "z[mm]", "potential[J]"});
    for (std::size_t k = 0; k < solutions->items.size(); ++k) {
      const auto place = numbers(at(solutions->items[k], "tip.position"));
      table.add({fmt::format("{}", k), cell(place[0], "m"), cell(place[1], "m"), cell(place[2], "m"),
                 six_digits(number(solutions->items[k], "potential"))});
    }
    text += '\n' + table.text();
  }
  if (const auto resolution = answer.number("resolution"))
    text += fmt::format("\nfiner polynomials move the tip by {} mm\n", six_digits(1000 * *resolution));
  return text;
}

}  // namespace sinew::cli
