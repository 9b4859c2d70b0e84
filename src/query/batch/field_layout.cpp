#include "query/batch/field_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <numeric>

#include "query/fields/fields.hpp"
#include "robot/chains.hpp"
#include "sinew/robot/arm.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "sinew/robot/assembly.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {
namespace {

using Lengths = std::vector<std::size_t>;

FieldLayout list_of(std::size_t numbers) { return {{numbers}, {}}; }
FieldLayout matrix_of(std::size_t rows, std::size_t columns) {
  return {{rows, columns}, Lengths(rows, columns)};
}
std::size_t sum(const Lengths& lengths) { return std::accumulate(lengths.begin(), lengths.end(), 0UL); }
FieldLayout lists_of(const Lengths& lengths) { return {{sum(lengths)}, lengths}; }

bool is_even(const Lengths& lengths) {
  return !lengths.empty() && std::ranges::adjacent_find(lengths, std::not_equal_to()) == lengths.end();
}
FieldLayout matrix_or_lists_of(const Lengths& lengths) {
  return is_even(lengths) ? matrix_of(lengths.size(), lengths.front()) : lists_of(lengths);
}

/// Of each leg, as `angles` has them: before the joints the direction of a first link that a motor turns.
Lengths angles_of(const Robot& robot) {
  Lengths angles;
  with_chains(robot, [&](const auto& legs) {
    for (const auto& leg : legs.legs)
      angles.push_back(static_cast<std::size_t>(leg.chain.joints()) + (legs.has_base_motors ? 1 : 0));
  });
  return angles;
}

/// Takes `[2]` from the end of a place.
std::optional<std::size_t> take_index(std::string_view& place) {
  const std::size_t open = place.rfind('[');
  if (!place.ends_with(']') || open == std::string_view::npos) return {};
  std::size_t index = 0;
  const char* end = place.data() + place.size() - 1;
  const auto [last, error] = std::from_chars(place.data() + open + 1, end, index);
  if (error != std::errc() || last != end) return {};
  place = place.substr(0, open);
  return index;
}

/// All of them, from the end of a place.
Lengths take_indices(std::string_view& place) {
  Lengths indices;
  while (const auto index = take_index(place)) indices.insert(indices.begin(), *index);
  return indices;
}

}  // namespace

std::size_t FieldLayout::size() const {
  return std::accumulate(shape.begin(), shape.end(), 1UL, std::multiplies());
}

std::string FieldLayout::suffix(std::size_t number) const {
  if (shape.empty()) return {};
  if (lists.empty()) return fmt::format("[{}]", number);
  std::size_t list = 0;
  while (list + 1 < lists.size() && number >= lists[list]) number -= lists[list++];
  return fmt::format("[{}][{}]", list, number);
}

FieldLayouts::FieldLayouts(const Robot& robot, std::string_view query)
    : places_(robot, ask_of(query).value_or(Ask::describe)),
      is_diagram_(query == "diagram"),
      is_statics_(query == "statics") {
  if (const SerialRobot* sections = robot.serial())
    count(*sections);
  else if (const Arm* arm = robot.arm())
    count(*arm);
  else if (const ArmLegs* legs = robot.arm_legs())
    count(*legs);
  else
    count(robot);
}

void FieldLayouts::count(const Robot& robot) {
  const auto number = [](int count) { return static_cast<std::size_t>(count); };
  is_planar_ = robot.planar() != nullptr;
  inputs_ = number(input_count(robot));
  freedoms_ = number(dof(robot));
  legs_ = number(leg_count(robot));
  rows_ = number(row_count(robot));
  if (robot.model() == Model::prb) angles_ = angles_of(robot);
  columns_ = angles_.empty() ? inputs_ : sum(angles_);
}

void FieldLayouts::count(const SerialRobot& robot) {
  is_serial_ = true;
  freedoms_ = 6;
  for (const Section& section : robot.sections) {
    configuration_.push_back(section.is_extensible() ? 3 : 2);
    tendons_.push_back(static_cast<std::size_t>(section.tendons));
  }
  rows_ = freedoms_;
  columns_ = sum(configuration_);
}

void FieldLayouts::count(const Arm& arm) {
  is_arm_ = true;
  freedoms_ = rows_ = 6;
  const std::size_t before = tendons_.size();  // of a platform, legs before this one
  tendons_.resize(before + arm.sections.size());
  for (const ArmTendon& tendon : arm.tendons) ++tendons_[before + static_cast<std::size_t>(tendon.section())];
  legs_ = inputs_ = columns_ = inputs_ + arm.tendons.size();
}

void FieldLayouts::count(const ArmLegs& robot) {
  for (const ArmLeg& leg : robot.legs) count(leg.arm);
  is_planar_ = robot.is_planar;
  if (is_planar_) freedoms_ = rows_ = 3;
}

FieldLayout FieldLayouts::lists(std::string_view name) const {
  if (name == "tensions" && !is_arm_) return matrix_of(legs_, 2);
  if (name == "angles") return matrix_or_lists_of(angles_);
  return name == "configuration" ? matrix_or_lists_of(configuration_) : lists_of(tendons_);
}

FieldLayout FieldLayouts::input(std::string_view place) const {
  if (is_diagram_ || place.starts_with("set.")) return {};
  const Lengths indices = take_indices(place);
  if (!indices.empty()) return {};
  const std::string_view name = place.substr(place.rfind('.') + 1);
  if (name == "position") return list_of(is_planar_ ? 2 : 3);
  if (name == "quaternion") return list_of(4);
  const Field* field = find_field(name);
  if (!field) return {};
  using Shape = FieldShape;
  switch (field->shape) {
    case Shape::inputs:
      return list_of(inputs_);
    case Shape::start:
      return is_serial_ ? matrix_or_lists_of(configuration_) : list_of(inputs_);
    case Shape::wrench:
    case Shape::twist:
      return list_of(freedoms_);
    case Shape::point:
      return list_of(3);
    case Shape::signs:
    case Shape::per_leg:
      return list_of(legs_);
    case Shape::pairs:
      return matrix_of(legs_, 2);
    case Shape::numbers:
      return list_of(is_serial_ ? tendons_.size() : inputs_);
    case Shape::lists:
      return lists(name);
    default:
      return {};
  }
}

FieldLayout FieldLayouts::whole(AnswerShape shape) const {
  using Shape = AnswerShape;
  switch (shape) {
    case Shape::pair:
      return list_of(2);
    case Shape::pairs:
      return matrix_of(legs_, 2);
    case Shape::triple:
      return list_of(3);
    case Shape::quaternion:
      return list_of(4);
    case Shape::vector:
      return list_of(is_planar_ ? 2 : 3);
    case Shape::direction:
      return is_planar_ ? FieldLayout() : list_of(3);
    case Shape::inputs:
      return list_of(inputs_);
    case Shape::freedoms:
      return list_of(freedoms_);
    case Shape::square:
      return matrix_of(freedoms_, freedoms_);
    case Shape::by_inputs:  // of statics it has columns of what is held, which may be tensions
      return is_statics_ ? FieldLayout() : matrix_of(freedoms_, inputs_);
    case Shape::jacobian:
      return matrix_of(rows_, is_serial_ ? columns_ : freedoms_);
    case Shape::input_jacobian:
      return matrix_of(is_serial_ ? sum(tendons_) : rows_, columns_);
    case Shape::rates:
      return is_serial_ ? matrix_or_lists_of(configuration_) : list_of(columns_);
    case Shape::sensitivities:
      return matrix_of(freedoms_, columns_);
    case Shape::joints:
      return is_even(angles_) ? list_of(angles_.front()) : FieldLayout();
    case Shape::bends:
      return matrix_or_lists_of(configuration_);
    case Shape::tendons:
      return lists_of(tendons_);
    case Shape::tendons_by_inputs:
      return matrix_of(columns_, columns_);
    case Shape::tendons_by_wrench:
      return matrix_of(columns_, freedoms_);
    case Shape::two_by_two:
      return matrix_of(2, 2);
    default:
      return {};
  }
}

std::string FieldLayouts::why_no_column(std::string_view place) const {
  const AnswerField* field = places_.field(place);
  std::string_view whole = place;
  const Lengths indices = take_indices(whole);
  const FieldLayout layout = output(whole);
  const bool is_number = !field || field->shape == AnswerShape::number || field->shape == AnswerShape::flag ||
                         (field->shape == AnswerShape::direction && is_planar_);
  if (layout.shape.empty() && !is_number)
    return indices.empty() ? fmt::format(
                                 "{} is as long as it is, which is no column; name one of its "
                                 "numbers, such as {}[0], or ask such rows one by one",
                                 place, place)
                           : std::string();
  if (layout.shape.empty())
    return indices.empty() ? std::string() : fmt::format("{} is one number; leave the index out", whole);
  const std::size_t first = layout.lists.empty() ? layout.shape[0] : layout.lists.size();
  // A path's rows tell of all legs at once what elsewhere each leg has.
  const bool is_of_row = place.find("rows[") != place.npos || place.starts_with("equilibria[");
  if (indices.empty() || is_of_row) return {};
  if (indices[0] >= first)
    return fmt::format("{} has no [{}]; give an index from 0 to {}", whole, indices[0], first - 1);
  if (layout.lists.empty() ? indices.size() > 1 : indices.size() > 2)
    return fmt::format("{} has no lists so deep; leave an index out", whole);
  if (indices.size() == 2 && indices[1] >= layout.lists[indices[0]])
    return fmt::format("{}[{}] has no [{}]; give an index from 0 to {}", whole, indices[0], indices[1],
                       layout.lists[indices[0]] - 1);
  return {};
}

FieldLayout FieldLayouts::output(std::string_view place) const {
  if (is_diagram_) return {};
  const AnswerField* field = places_.field(place);
  if (!field) return {};
  const Lengths indices = take_indices(place);
  const FieldLayout layout = whole(field->shape);
  if (indices.empty()) return layout;
  return indices.size() == 1 && indices[0] < layout.lists.size() ? list_of(layout.lists[indices[0]])
                                                                 : FieldLayout();
}

}  // namespace sinew::inline v1
