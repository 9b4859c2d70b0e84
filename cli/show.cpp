#include "show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/solve/report.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

double value(const Node& map, std::string_view path) {
  const Node* node = at(map, path);
  return node ? node->number : 0.0;
}

double largest(const Node& matrix) {
  double result = 0;
  for (const Node& row : matrix.items)
    for (const Node& entry : row.items) result = std::max(result, std::abs(entry.number));
  return result;
}

std::vector<std::string> leg_names(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::format("legs[{}]", i));
  return names;
}

/// A matrix with headings; `factor` of row i and column j takes SI to what the headings say.
template <class Factor>
std::string show_matrix(const Node& matrix, std::vector<std::string> header,
                        const std::vector<std::string>& rows, Factor factor) {
  const double scale = largest(matrix);
  TextTable table(std::move(header));
  for (std::size_t i = 0; i < matrix.items.size(); ++i) {
    std::vector<std::string> row{rows.at(i)};
    for (std::size_t j = 0; j < matrix.items[i].items.size(); ++j) {
      const double entry = matrix.items[i].items[j].number;
      row.push_back(std::abs(entry) <= 1e-12 * scale ? "0" : six_digits(entry * factor(i, j)));
    }
    table.add(std::move(row));
  }
  return table.text();
}

/// U maps inputs to the platform: a ratio of lengths is one in any unit, the rest is in degrees and mm.
std::string show_sensitivity(const Node& matrix, const InputNames& inputs) {
  std::vector<std::string> header{"U"}, rows;
  const auto per = [&](std::string_view si) {
    return inputs.units.empty() ? std::string(shown(si).unit)
                                : fmt::format("{}/{}", shown(si).unit, shown(inputs.units[0]).unit);
  };
  header.insert(header.end(), inputs.names.begin(), inputs.names.end());
  for (const auto& [name, unit] : {std::pair{"x", "m"}, std::pair{"y", "m"}, std::pair{"phi", "rad"}})
    rows.push_back(fmt::format("{}[{}]", name, per(unit)));
  return show_matrix(matrix, header, rows, [&](std::size_t i, std::size_t j) {
    return shown(i < 2 ? "m" : "rad").factor / shown(inputs.units[j]).factor;
  });
}

}  // namespace

std::string show_indices(const Answer& answer, const InputNames& inputs) {
  TextTable table({"index", "value"});
  const auto row = [&](std::string_view name, std::optional<double> number, double factor) {
    // beyond what doubles resolve a condition number is noise
    table.add({std::string(name), !number ? "-" : *number > 1e15 ? "inf" : six_digits(*number * factor)});
  };
  const Shown input = shown(inputs.units.empty() ? "m" : inputs.units[0]), turn = shown("rad");
  row("determinant[m^4]", answer.number("determinant"), answer.text("type_2.singular") == "true" ? 0 : 1);
  row("condition", answer.number("indices.condition"), 1);
  row("condition_homogenised", answer.number("indices.condition_homogenised"), 1);
  row(fmt::format("position[mm/{}]", input.unit), answer.number("indices.position"), 1e3 / input.factor);
  row(fmt::format("rotation[{}/{}]", turn.unit, input.unit), answer.number("indices.rotation"),
      turn.factor / input.factor);
  return table.text();
}

std::string show_singularities(const Answer& answer) {
  std::vector<std::string> lost;
  for (const double leg : numbers(answer.find("type_1"))) lost.push_back(fmt::format("legs[{}]", leg));
  std::string text =
      "type I: " + (lost.empty() ? std::string("none")
                                 : fmt::format("{}, whose input moves nothing", fmt::join(lost, ", ")));
  const std::string kind = answer.text("type_2.class");
  text += "\ntype II: ";
  if (answer.text("type_2.singular") != "true")
    return text + "none, the lines of the legs are " + kind + "\n";
  text += fmt::format("singular, the lines of the legs are {}", kind);
  if (const Node* point = answer.find("type_2.point"))
    text += fmt::format(" at x = {} mm, y = {} mm", cell(value(*point, "[0]"), "m"),
                        cell(value(*point, "[1]"), "m"));
  return text + "; the platform moves with the inputs held\n";
}

InputNames input_names(const Answer& description) {
  InputNames result;
  if (const Node* inputs = description.find("inputs"))
    for (const Node& input : inputs->items) {
      result.names.push_back(input.find("name")->text);
      result.units.push_back(input.find("unit")->text);
    }
  return result;
}

std::string show_pose(const Node& pose) {
  TextTable table({heading("x", "m"), heading("y", "m"), heading("phi", "rad")});
  table.add({cell(value(pose, "x"), "m"), cell(value(pose, "y"), "m"), cell(value(pose, "phi"), "rad")});
  return table.text();
}

std::string show_legs(const Node& legs) {
  TextTable table({"leg", heading("tendon_1", "m"), heading("tendon_2", "m"), heading("curvature", "1/m"),
                   heading("chord", "m"), heading("base_tangent", "rad")});
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    const Node& leg = legs.items[i];
    table.add({fmt::format("legs[{}]", i), cell(value(leg, "tendon_lengths[0]"), "m"),
               cell(value(leg, "tendon_lengths[1]"), "m"), cell(value(leg, "curvature"), "1/m"),
               cell(value(leg, "chord"), "m"), cell(value(leg, "base_tangent"), "rad")});
  }
  return table.text();
}

std::string show_inputs(std::string_view title, const std::vector<double>& values, const InputNames& names,
                        std::string_view per) {
  const std::string unit = names.units.empty() ? "" : names.units.front();
  TextTable table({"input", fmt::format("{}[{}{}]", title, shown(unit).unit, per)});
  for (std::size_t i = 0; i < values.size(); ++i)
    table.add({names.names.at(i), cell(values[i], names.units.at(i))});
  return table.text();
}

std::string show_modes(const Node& solutions, const InputNames& names) {
  std::vector<std::string> header{"mode", "bending"};
  for (std::size_t i = 0; i < names.names.size(); ++i)
    header.push_back(heading(names.names[i], names.units[i]));
  TextTable table(std::move(header));
  for (std::size_t k = 0; k < solutions.items.size(); ++k) {
    const Node& solution = solutions.items[k];
    std::string bending;
    for (const Node& leg : solution.find("legs")->items)
      bending += fmt::format("{}{}", bending.empty() ? "" : ",", value(leg, "curvature") < 0 ? '-' : '+');
    std::vector<std::string> row{fmt::format("{}", k + 1), '"' + bending + '"'};
    const auto inputs = numbers(solution.find("inputs"));
    for (std::size_t i = 0; i < inputs.size(); ++i) row.push_back(cell(inputs[i], names.units[i]));
    table.add(std::move(row));
  }
  return table.text();
}

std::string show_velocity(const Answer& answer, const InputNames& names) {
  const Node &J = *answer.find("J"), &K = *answer.find("K");
  const auto si = [](std::size_t, std::size_t) { return 1.0; };
  std::vector<std::string> columns{"K"};
  for (const std::string& name : names.names) columns.push_back(name + "[m]");
  // J and K are the paper's: J·(ẋ, ẏ, φ̇) = K·(input rates), rows times the chord, so they stay in SI
  std::string text = show_pose(*answer.find("pose")) + '\n' +
                     show_matrix(J, {"J", "x[m]", "y[m]", "phi[m^2]"}, leg_names(J.items.size()), si) + '\n' +
                     show_matrix(K, columns, leg_names(K.items.size()), si) + '\n';
  if (const Node* U = answer.find("U")) text += show_sensitivity(*U, names) + '\n';
  text += show_indices(answer, names) + '\n' + show_singularities(answer);
  if (const Node* rates = answer.find("rates"))
    text += '\n' + show_inputs("rate", numbers(rates), names, "/s");
  return text;
}

std::string show_report(const Answer& answer) {
  Report report;
  report.residual = answer.number("residual").value_or(0);
  report.iterations = static_cast<int>(answer.number("iterations").value_or(0));
  return to_string(report) + '\n';
}

}  // namespace sinew::cli
