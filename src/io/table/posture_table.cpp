#include "io/table/posture_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/document/quantity.hpp"

namespace sinew::inline v1 {
namespace {

Bend bend_of(const Section& section, double first, double second) {
  if (section.is_twin()) return {first, second};
  return {first * std::cos(second), first * std::sin(second)};
}

/// A column and what its values are to be multiplied by.
struct Measured {
  const Column* column = nullptr;
  double factor = 1;
  double value(std::size_t row) const { return column->values[row] * factor; }
};

/// A column of a plain number is SI.
Measured in_si(const Column* column, Dimension dimension, const std::string& file, Errors& errors) {
  if (!column || column->unit.empty() || column->unit == unit(dimension)) return {column};
  const auto factor = parse_quantity("1 " + column->unit, dimension);
  if (factor) return {column, *factor};
  errors.push_back({factor.error().front().code, fmt::format("{}: {}", file, column->heading()),
                    factor.error().front().message});
  return {};
}

}  // namespace

std::array<std::string, 2> bend_names(const Section& section, std::size_t number) {
  if (section.is_twin()) return {fmt::format("S{}_beta_1", number), fmt::format("S{}_beta_2", number)};
  return {fmt::format("S{}_theta", number), fmt::format("S{}_phi", number)};
}

std::array<double, 2> bend_angles(const Section& section, const Bend& bend) {
  if (section.is_twin()) return {bend[0], bend[1]};
  return {std::hypot(bend[0], bend[1]), std::atan2(bend[1], bend[0])};
}

Expected<std::vector<SerialPosture>> read_postures(const Table& table, const SerialRobot& robot,
                                                   const std::string& file) {
  Errors errors;
  const auto column = [&](const std::string& name, Dimension dimension) {
    const Column* found = table.find(name);
    if (!found)
      errors.push_back(
          {"missing_column", file, fmt::format("has no column {}; a plan of this robot has", name)});
    return in_si(found, dimension, file, errors);
  };
  const Measured stage = column("stage", Dimension::length);
  std::vector<Measured> angles;
  for (std::size_t m = 0; m < robot.sections.size(); ++m)
    for (const std::string& name : bend_names(robot.sections[m], m))
      angles.push_back(column(name, Dimension::angle));
  if (errors.empty() && table.row_count() == 0)
    errors.push_back({"no_rows", file, "has no row: a plan has at least one step"});
  if (!errors.empty()) return tl::unexpected(errors);
  std::vector<SerialPosture> postures(table.row_count());
  for (std::size_t k = 0; k < postures.size(); ++k) {
    postures[k].stage = stage.value(k);
    bool is_finite = std::isfinite(postures[k].stage);
    for (std::size_t m = 0; m < robot.sections.size(); ++m) {
      const double first = angles[2 * m].value(k), second = angles[2 * m + 1].value(k);
      is_finite = is_finite && std::isfinite(first) && std::isfinite(second);
      postures[k].bends.push_back(bend_of(robot.sections[m], first, second));
    }
    if (!is_finite) return failure("not_a_number", file, fmt::format("row {} lacks a number", k));
  }
  return postures;
}

}  // namespace sinew::inline v1
