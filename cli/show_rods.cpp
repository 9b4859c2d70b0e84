/// Equilibria of robots on rods, as people read them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "show.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

const std::vector<std::string> wrench_rows{"fx[N]", "fy[N]", "fz[N]", "mx[N m]", "my[N m]", "mz[N m]"};

/// Headings of what a motion of the platform is divided by: `x[1/mm]`.
std::vector<std::string> per_motion(std::string_view title, bool is_si) {
  std::vector<std::string> header{std::string(title)};
  for (const Input& column : pose_columns(true))
    header.push_back(fmt::format("{}[1/{}]", column.name, is_si ? column.unit : shown(column.unit).unit));
  return header;
}

std::string show_stiffness(const Node& matrix) {
  const auto columns = pose_columns(true);
  return show_matrix(matrix, per_motion("stiffness", false), wrench_rows,
                     [&](std::size_t, std::size_t j) { return 1 / shown(columns[j].unit).factor; });
}

std::string show_energies(const Answer& answer) {
  std::vector<std::string> header, row;
  for (const char* name : {"energy", "potential"}) {
    const auto value = answer.number(name);
    if (!value) continue;  // under a moment there is no potential
    header.push_back(heading(name, "J"));
    row.push_back(cell(*value, "J"));
  }
  TextTable table(std::move(header));
  table.add(std::move(row));
  return table.text();
}

/// Twists, each so that its largest number shown is 1.
std::string show_twists(const Node& twists) {
  const auto columns = pose_columns(true);
  std::vector<std::string> header{"direction"};
  for (const Input& column : columns) header.push_back(heading(column.name, column.unit));
  TextTable table(std::move(header));
  for (std::size_t k = 0; k < twists.items.size(); ++k) {
    std::vector<double> parts = numbers(&twists.items[k]);
    double largest = 0;
    for (std::size_t j = 0; j < parts.size(); ++j) {
      parts[j] *= shown(columns[j].unit).factor;
      if (std::abs(parts[j]) > std::abs(largest)) largest = parts[j];
    }
    std::vector<std::string> row{fmt::format("{}", k + 1)};
    for (const double part : parts) row.push_back(cell(part / largest, ""));
    table.add(std::move(row));
  }
  return table.text();
}

std::string show_stability(const Answer& answer) {
  const auto count = static_cast<int>(answer.number("unstable_directions").value_or(0));
  if (count == 0) return "unstable directions: none\n";
  std::string text = fmt::format("unstable directions: {}\n", count);
  if (const Node& twists = *answer.find("unstable"); !twists.items.empty()) text += show_twists(twists);
  std::vector<std::string> legs;
  for (const double leg : numbers(answer.find("unstable_legs"))) legs.push_back(fmt::format("legs[{}]", leg));
  if (!legs.empty()) text += fmt::format("unstable with the platform held: {}\n", fmt::join(legs, ", "));
  return text;
}

}  // namespace

std::string show_load(const Answer& answer) {
  const std::string why = answer.text("why");
  return fmt::format(
      "load: {} times the wrench of --until, {}\n", six_digits(answer.number("load").value_or(0)),
      why == "limit"         ? "the limit"
      : why == "bifurcation" ? "a bifurcation: beyond it the equilibrium does not hold by itself"
      : why == "stability"   ? "stability: beyond it the moment drives the equilibrium away"
      : why == "straight"    ? "straight: a rod is pulled straight"
      : why == "sharp"       ? "sharp: the rods bend more sharply than is resolved"
      : why == "fold"        ? "a fold: beyond it no equilibrium is nearby"
                             : why);
}

bool is_on_rods(const Answer& answer) {
  const Node* legs = answer.find("legs");
  return legs &&
         std::ranges::any_of(legs->items, [](const Node& leg) { return leg.find("tip_angle") != nullptr; });
}

std::string show_equilibrium(const Answer& answer, const OpenRobot& robot) {
  std::string text = show_energies(answer);
  if (const Node* stiffness = answer.find("stiffness")) text += '\n' + show_stiffness(*stiffness);
  if (const Node* matrix = answer.find("sensitivity"))
    text += '\n' + show_sensitivity("sensitivity", *matrix, robot);
  if (const Node* margins = answer.find("margins")) text += '\n' + show_margins(*margins);
  if (answer.find("stable")) text += '\n' + show_stability(answer);
  if (answer.find("load")) text += '\n' + show_load(answer);
  return text;
}

std::string show_margins(const Node& margins) {
  TextTable table({"margin", "value"});
  table.add({"fold", six_digits(number(margins, "fold"))});
  table.add({"strain[%]", six_digits(100 * number(margins, "strain"))});
  return table.text();
}

std::string show_equilibria(const Answer& answer, const OpenRobot& robot) {
  const auto& solutions = answer.find("solutions")->items;
  const bool is_forward = answer.text("query") == "forward";  // else one pose is held, by several lengths
  const std::vector<Input> columns = is_forward ? pose_columns(robot.is_spatial) : robot.inputs;
  const bool has_potential =
      std::ranges::any_of(solutions, [](const Node& one) { return one.find("potential") != nullptr; });
  std::vector<std::string> header{is_forward ? "equilibrium" : "solution"};
  for (const Input& column : columns) header.push_back(heading(column.name, column.unit));
  if (has_potential) header.push_back(heading("potential", "J"));
  header.emplace_back("unstable_directions");
  TextTable table(std::move(header));
  for (std::size_t k = 0; k < solutions.size(); ++k) {
    std::vector<std::string> row{fmt::format("{}", k + 1)};
    const auto values =
        is_forward ? pose_values(*solutions[k].find("pose")) : numbers(solutions[k].find("inputs"));
    for (std::size_t j = 0; j < values.size(); ++j) row.push_back(cell(values[j], columns[j].unit));
    if (has_potential) row.push_back(cell(number(solutions[k], "potential"), "J"));
    row.push_back(six_digits(number(solutions[k], "unstable_directions")));
    table.add(std::move(row));
  }
  const bool is_one = solutions.size() == 1;
  return table.text() + (is_forward
                             ? fmt::format("at least {} equilibri{}\n", solutions.size(), is_one ? "um" : "a")
                             : fmt::format("at least {} solution{}\n", solutions.size(), is_one ? "" : "s"));
}

/// A twist, as it goes with a pose.
std::string show_motion(const std::vector<double>& twist) {
  TextTable table({"twist", "value"});
  constexpr const char* rows[] = {"vx", "vy", "vz", "wx", "wy", "wz"};
  for (std::size_t k = 0; k < twist.size(); ++k) {
    const Shown unit = shown(k < 3 ? "m" : "rad");
    table.add({fmt::format("{}[{}/s]", rows[k], unit.unit), cell(twist[k], k < 3 ? "m" : "rad")});
  }
  return table.text();
}

std::string show_rod_velocity(const Answer& answer, const OpenRobot& robot) {
  const auto si = [](std::size_t, std::size_t) { return 1.0; };
  std::vector<std::string> K{"K"};
  for (const Input& input : robot.inputs) K.push_back(input.name + "[1/m]");
  std::string text = show_pose(*answer.find("pose")) + '\n' +
                     show_inputs("value", numbers(answer.find("inputs")), robot) + '\n' +
                     show_matrix(*answer.find("J"), per_motion("J", true), wrench_rows, si) + '\n' +
                     show_matrix(*answer.find("K"), std::move(K), wrench_rows, si) + '\n' +
                     (answer.find("U") ? show_sensitivity("U", *answer.find("U"), robot) + '\n' : "");
  TextTable table({"index", "value"});
  table.add({"position[mm/mm]", six_digits(answer.number("indices.position").value_or(0))});
  table.add({"rotation[deg/mm]", six_digits(answer.number("indices.rotation").value_or(0) *
                                            shown("rad").factor / shown("m").factor)});
  std::string motion;
  if (const Node* rates = answer.find("rates"))
    motion += '\n' + show_inputs("rate", numbers(rates), robot, "/s");
  if (const Node* twist = answer.find("twist")) motion += '\n' + show_motion(numbers(twist));
  return text + table.text() + motion +
         (answer.text("type_2.singular") == "true"
              ? "\ntype II: singular, the platform moves with the inputs held\n"
              : "\ntype II: none, the stiffness is regular\n");
}

std::string show_wrench(const Answer& answer) {
  const auto wrench = numbers(answer.find("wrench"));
  const Node* covariance = answer.find("covariance");
  std::vector<std::string> header{"wrench", "value"};
  if (covariance) header.emplace_back("deviation");
  TextTable table(std::move(header));
  for (std::size_t k = 0; k < wrench.size(); ++k) {
    std::vector<std::string> row{wrench_rows[wrench.size() == 3 && k == 2 ? 5 : k], six_digits(wrench[k])};
    if (covariance) row.push_back(six_digits(std::sqrt(covariance->items[k].items[k].number)));
    table.add(std::move(row));
  }
  return table.text();
}

std::string show_sensed(const Answer& answer) {
  return show_pose(*answer.find("pose")) + '\n' + show_wrench(answer);
}

}  // namespace sinew::cli
