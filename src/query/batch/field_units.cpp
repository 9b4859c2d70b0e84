#include "query/batch/field_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "io/document/quantity.hpp"
#include "query/fields/fields.hpp"
#include "sinew/robot/arm.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "sinew/robot/assembly.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {
namespace {

/// Radians are left out of denominators; of like by like nothing is left.
std::string quotient(std::string_view unit, std::string_view by) {
  if (unit == by) return {};
  if (by == "rad" || by.empty()) return std::string(unit);
  if (unit == "N m" && (by == "m" || by == "N")) return by == "m" ? "N" : "m";
  if (unit == "m" && by == "N m") return "1/N";
  if (unit == "m^2" && by == "m") return "m";
  const std::string_view over = unit.empty() ? "1" : unit;
  const bool is_product = by.find(' ') != std::string_view::npos;
  return is_product ? fmt::format("{}/({})", over, by) : fmt::format("{}/{}", over, by);
}

/// Of the k-th index of those at the end of a place, from the first one; 0 where there is none.
std::size_t index_of(std::string_view place, int k) {
  place = place.substr(std::min(place.size(), place.find_last_of('.') + 1));
  std::size_t open = place.find('[');
  while (k-- > 0 && open != std::string_view::npos) open = place.find('[', open + 1);
  return open == std::string_view::npos ? 0 : static_cast<std::size_t>(std::atoi(place.data() + open + 1));
}

Ask kind_of(const Node& query) {
  const Node* kind = query.find("query");
  return (kind ? ask_of(kind->text) : std::nullopt).value_or(Ask::describe);
}

}  // namespace

FieldUnits::FieldUnits(const Robot& robot, const Node& query)
    : places_(robot, kind_of(query)),
      kind_(robot.serial()                    ? Kind::serial
            : robot.arm() || robot.arm_legs() ? Kind::arms
            : has_rods(robot)                 ? Kind::rods
            : robot.model() == Model::prb     ? Kind::chains
                                              : Kind::arcs),
      linear_(robot.planar() || (robot.arm_legs() && robot.arm_legs()->is_planar) ? 2 : 3),
      legs_(static_cast<std::size_t>(leg_count(robot))),
      holding_(!query.find("changes")    ? Holding::tensions
               : !query.find("tensions") ? Holding::changes
                                         : Holding::both) {
  if (const SerialRobot* sections = robot.serial()) {
    for (const Section& section : sections->sections) {
      inputs_.insert(inputs_.end(), 2, "rad");
      if (section.is_extensible()) inputs_.emplace_back("m");
    }
  } else if (kind_ != Kind::arms) {
    for (const InputOfLeg& input : inputs_of(robot)) inputs_.emplace_back(unit(input.dimension));
  }
}

std::string FieldUnits::of_input(std::size_t input) const {
  if (kind_ == Kind::arms) return holding_ == Holding::changes ? "m" : "N";
  return input < inputs_.size() ? inputs_[input] : std::string();
}

/// What columns of K are of.
std::string FieldUnits::of_coordinate(std::size_t column) const {
  return kind_ == Kind::chains ? "rad" : of_input(column);
}

/// A row of J's, before it is divided by a motion: its line times a length, of planes a length.
std::string FieldUnits::of_constraint(std::size_t row) const { return row < legs_ ? "m^2" : "m"; }

std::string FieldUnits::of_block(std::string_view name, std::size_t row, std::size_t column) const {
  if (name == "J" || name == "K") {
    const bool is_J = name == "J";
    if (kind_ == Kind::serial) return quotient(is_J ? motion(row) : "m", of_input(column));
    const std::string of_row = kind_ == Kind::rods ? std::string(load(row)) : of_constraint(row);
    return quotient(of_row, is_J ? std::string(motion(column)) : of_coordinate(column));
  }
  if (name == "U") return quotient(motion(row), of_coordinate(column));
  if (name == "sensitivity") return quotient(motion(row), of_input(column));
  if (name == "stiffness") return quotient(load(row), motion(column));
  if (name == "compliance") return quotient(motion(row), load(column));
  if (name == "wrench_sensitivity") return quotient(load(row), "N");
  if (name == "covariance") {
    const bool is_first = row < linear_, is_second = column < linear_;
    return is_first && is_second ? "N^2" : is_first || is_second ? "N^2 m" : "N^2 m^2";
  }
  const std::string answers = holding_ == Holding::changes ? "N" : "m";
  if (name == "answer_rates") return quotient(answers, of_input(column));
  return name == "answers_by_wrench" ? quotient(answers, load(column)) : std::string();
}

/// Of fields whose numbers have several; else the table's.
std::string FieldUnits::of_answer(std::string_view place) const {
  const AnswerField* field = places_.field(place);
  if (field && field->name == "determinant")  // each line a length, each rotation another
    return fmt::format("m^{}", legs_ + (linear_ == 2 ? 1 : 3));
  const bool is_of_wrench = field && field->name == "covariance" && field->shape == AnswerShape::square;
  const bool has_several = field && (field->unit.find(", ") != std::string_view::npos || is_of_wrench);
  if (!has_several) return std::string(places_.unit(place));
  const std::size_t first = index_of(place, 0);
  if (field->name == "wrench" || field->name == "tip_wrench") return std::string(load(first));
  if (field->name == "linear") return std::string(motion(first));
  if (field->name == "inputs" && kind_ != Kind::serial) return of_input(first);
  if (field->name == "twist") return fmt::format("{}/s", motion(first));
  if (field->name == "rates") {
    const bool is_nested = kind_ == Kind::serial && place.ends_with(']');
    const std::size_t extension = 2;
    if (is_nested) return index_of(place, 1) < extension ? "rad/s" : "m/s";
    return of_coordinate(first) + "/s";
  }
  const bool is_unsure = kind_ == Kind::arms && holding_ == Holding::both;
  return is_unsure ? std::string(field->unit) : of_block(field->name, first, index_of(place, 1));
}

/// Of places of questions.
std::string FieldUnits::of_question(std::string_view place) const {
  const std::string_view words = place.substr(0, place.find('[', place.rfind('.') + 1));
  const std::string_view name = words.substr(words.rfind('.') + 1);
  if (words.starts_with("set.")) return name == "length" ? "m" : "";  // units of the rest stand in no table
  constexpr std::pair<std::string_view, std::string_view> parts[] = {
      {"x", "m"},      {"y", "m"},         {"z", "m"},         {"phi", "rad"},
      {"tilt", "rad"}, {"azimuth", "rad"}, {"torsion", "rad"}, {"curvatures", "1/m"}};  // of poses, of starts
  for (const auto& [part, one] : parts)
    if (part == name) return std::string(one);
  const Field* field = find_field(name);
  if (!field) return {};
  const std::size_t first = index_of(place, 0);
  switch (field->shape) {
    case FieldShape::inputs:
      return name == "rates" ? of_coordinate(first) + "/s" : of_input(first);
    case FieldShape::wrench:
      return std::string(load(first));
    case FieldShape::twist:
      return name == "twist" ? fmt::format("{}/s", motion(first)) : std::string();
    case FieldShape::quantity:
    case FieldShape::point:
    case FieldShape::numbers:
    case FieldShape::per_leg:
    case FieldShape::pairs:
    case FieldShape::lists:
      return name.starts_with("distributed") ? "N/m" : std::string(unit(field->dimension));
    default:
      return {};
  }
}

Batch::Field FieldUnits::input(std::string name, const std::string& place, const FieldLayout& layout) const {
  return {std::move(name), joined(place, layout, &FieldUnits::of_question), layout.shape};
}

Batch::Field FieldUnits::output(std::string name, const std::string& place, const FieldLayout& layout) const {
  return {std::move(name), joined(place, layout, &FieldUnits::of_answer), layout.shape};
}

/// Of all numbers that stand at a place.
std::string FieldUnits::joined(const std::string& place, const FieldLayout& layout,
                               std::string (FieldUnits::*of)(std::string_view) const) const {
  std::vector<std::string> units;
  for (std::size_t i = 0; i < layout.size(); ++i) {
    std::string one = (this->*of)(place + layout.suffix(i));
    if (std::ranges::find(units, one) == units.end()) units.push_back(std::move(one));
  }
  if (units.size() > 1) std::ranges::replace(units, "", "1");
  return fmt::format("{}", fmt::join(units, ", "));
}

}  // namespace sinew::inline v1
