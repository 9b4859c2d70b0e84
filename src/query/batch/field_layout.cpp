#include "query/batch/field_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <numeric>

#include "robot/chains.hpp"
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

FieldLayouts::FieldLayouts(const Robot& robot, std::string_view query) {
  if (query == "diagram") return;
  if (const SerialRobot* sections = robot.serial())
    read_sections(*sections);
  else
    read_platform(robot, query);
}

FieldLayout FieldLayouts::input(std::string_view place) const {
  return place.starts_with("set.") ? FieldLayout() : find(inputs_, place);
}

void FieldLayouts::read_platform(const Robot& robot, std::string_view query) {
  const auto count = [](int number) { return static_cast<std::size_t>(number); };
  const std::size_t inputs = count(input_count(robot)), freedoms = count(dof(robot)),
                    legs = count(leg_count(robot)), rows = count(row_count(robot)),
                    space = robot.planar() ? 2 : 3;
  const bool is_on_chains = robot.model() == Model::prb, is_planar = robot.planar() != nullptr;
  const Lengths angles = is_on_chains ? angles_of(robot) : Lengths();
  const std::size_t columns = is_on_chains ? sum(angles) : inputs;  // of K and U
  const FieldLayout vector = list_of(space), wrench = list_of(freedoms), pair = list_of(2);
  inputs_ = {{"inputs", list_of(inputs)},
             {"start", list_of(inputs)},
             {"wrench", wrench},
             {"gravity", list_of(3)},
             {"position", list_of(3)},
             {"quaternion", list_of(4)},
             {"twist", list_of(freedoms)},
             {"along", list_of(freedoms)},
             {"rates", list_of(inputs)},
             {"bending", list_of(legs)},
             {"elbow", list_of(legs)},
             {"curvature", list_of(legs)},
             {"tensions", matrix_of(legs, 2)},
             {"lengths", matrix_of(legs, 2)},
             {"angles", matrix_or_lists_of(angles)},
             {"axial_forces", list_of(inputs)},
             {"measured_tensions", list_of(legs)}};
  outputs_ = {{"indices.position", {}},
              {"position", list_of(3)},
              {"quaternion", list_of(4)},
              {"inputs", list_of(inputs)},
              {"J", matrix_of(rows, freedoms)},
              {"K", matrix_of(rows, columns)},
              {"U", matrix_of(freedoms, columns)},
              {"rates", list_of(columns)},
              {"twist", list_of(freedoms)},
              {"wrench", wrench},
              {"stiffness", matrix_of(freedoms, freedoms)},
              {"compliance", matrix_of(freedoms, freedoms)},
              {"covariance", matrix_of(freedoms, freedoms)},
              {"wrench_sensitivity", matrix_of(freedoms, freedoms)},
              {"tendon_lengths", pair},
              {"tensions", pair},
              {"base_tangent", is_planar ? FieldLayout() : list_of(3)},
              {"joint_angles", pair},
              {"carriage", vector},
              {"force", vector},
              {"force_0", vector},
              {"moment", list_of(3)},
              {"moment_0", list_of(3)},
              {"curvature_0", pair},
              {"tip", vector},
              {"tip_wrench", wrench},
              {"linear", list_of(freedoms)},
              {"point", vector},
              {"direction", vector}};
  if (query != "statics")  // there it has columns of what is held, which may be tensions
    outputs_.push_back({"sensitivity", matrix_of(freedoms, inputs)});
  if (is_even(angles)) outputs_.push_back({"angles", list_of(angles.front())});  // of a leg
}

void FieldLayouts::read_sections(const SerialRobot& robot) {
  Lengths configuration, tendons;
  for (const Section& section : robot.sections) {
    configuration.push_back(section.is_extensible() ? 3 : 2);
    tendons.push_back(static_cast<std::size_t>(section.tendons));
  }
  const FieldLayout bends = matrix_or_lists_of(configuration), changes = lists_of(tendons);
  inputs_ = {{"configuration", bends},           {"start", bends},         {"changes", changes},
             {"slack", list_of(tendons.size())}, {"position", list_of(3)}, {"direction", list_of(3)},
             {"quaternion", list_of(4)},         {"twist", list_of(6)}};
  outputs_ = {{"indices.position", {}},
              {"position", list_of(3)},
              {"quaternion", list_of(4)},
              {"configuration", bends},
              {"rates", bends},
              {"changes", changes},
              {"motors", changes},
              {"slack", changes},
              {"J", matrix_of(6, sum(configuration))},
              {"K", matrix_of(sum(tendons), sum(configuration))},
              {"steering", matrix_of(2, 2)}};
}

FieldLayout FieldLayouts::find(const Table& table, std::string_view place) {
  Lengths indices;
  while (const auto index = take_index(place)) indices.insert(indices.begin(), *index);
  const auto found = std::ranges::find_if(table, [&](const Entry& entry) {
    return place.ends_with(entry.key) &&
           (place.size() == entry.key.size() || place[place.size() - entry.key.size() - 1] == '.');
  });
  if (found == table.end()) return {};
  if (indices.empty()) return found->layout;
  const auto& lists = found->layout.lists;
  return indices.size() == 1 && indices[0] < lists.size() ? list_of(lists[indices[0]]) : FieldLayout();
}

}  // namespace sinew::inline v1
