#include "option_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "arm_path.hpp"
#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "query/fields/fields.hpp"
#include "show.hpp"
#include "sinew/io/table.hpp"
#include "sinew/math/se3.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

/// `"1, 2" has 2 values`.
std::string counted(std::string_view list, std::size_t count) {
  return fmt::format("{} has {} value{}", in_quotes(list), count, count == 1 ? "" : "s");
}

Dimension dimension_of(std::string_view unit) {
  return unit == "m" ? Dimension::length : unit == "rad" ? Dimension::angle : Dimension::number;
}

/// Some lengths, then some of another dimension: poses and twists.
std::vector<Dimension> lengths_then(std::size_t lengths, Dimension other, std::size_t count) {
  std::vector<Dimension> dimensions(lengths, Dimension::length);
  dimensions.resize(lengths + count, other);
  return dimensions;
}

/// A tension or a length that is left to what else holds: `null` as in a query, or `-`.
bool holds_nothing(std::string_view part, Dimension dimension) {
  return (part == "null" || part == "-") && dimension != Dimension::angle;
}

Node numbers_node(std::span<const double> values) {
  std::vector<Node> items;
  for (const double value : values) items.push_back(make_node(value));
  return list_of(std::move(items));
}

/// Three of the plane, six in space with a rotation vector, or seven with a quaternion.
Node pose_node(std::span<const double> values) {
  if (values.size() == 3)
    return map_of({member_of("x", make_node(values[0])), member_of("y", make_node(values[1])),
                   member_of("phi", make_node(values[2]))});
  std::vector<double> quaternion(values.begin() + 3, values.end());
  if (values.size() == 6) {
    const auto turn = SO3<double>::exp(Vec3<double>(values[3], values[4], values[5]));
    quaternion = {turn.w, turn.v[0], turn.v[1], turn.v[2]};
  }
  return map_of({member_of("position", numbers_node(values.first(3))),
                 member_of("quaternion", numbers_node(quaternion))});
}

/// Whether three inputs hold z, e1 and e2 of the platform, and the rest of its pose follows.
bool is_held_by_three(const OpenRobot& robot) { return robot.is_on_rods && robot.inputs.size() == 3; }

Node independent_node(double z, double e1, double e2) {
  return map_of(
      {member_of("z", make_node(z)), member_of("e1", make_node(e1)), member_of("e2", make_node(e2))});
}

/// These of a spatial pose.
Node independent_of(std::span<const double> pose) {
  const auto turn = SO3<double>::exp(Vec3<double>(pose[3], pose[4], pose[5])).canonical();
  return independent_node(pose[2], turn.v[0], turn.v[1]);
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\n") - begin + 1);
}

std::vector<std::string_view> split(std::string_view list) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t comma = list.find(',');
    parts.push_back(trimmed(list.substr(0, comma)));
    if (comma == std::string_view::npos) return parts;
    list.remove_prefix(comma + 1);
  }
}

Member member_of(std::string_view key, Node value) {
  return {.key = std::string(key), .value = std::move(value)};
}

void OptionReader::fail(std::string_view code, std::string_view option, std::string_view message) {
  errors_.push_back({std::string(code), fmt::format("--{}", option), std::string(message)});
}

/// The values of an option in SI; `per` may end a unit: "5 mm/s". What cannot be read is 0, and an error,
/// which tells the value's name where it has one.
std::vector<double> OptionReader::values(std::string_view option, std::span<const std::string_view> parts,
                                         std::span<const Dimension> dimensions, std::string_view per,
                                         std::span<const std::string_view> names) {
  std::vector<double> result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string_view bare = parts[i];
    if (!per.empty() && bare.ends_with(per)) bare.remove_suffix(per.size());
    const Expected<double> value = parse_quantity(bare, dimensions[i]);
    result.push_back(value.value_or(0.0));
    if (value) continue;
    const Error& error = value.error().front();
    const std::string name = names.empty() ? "" : fmt::format(" ({})", names[i]);
    errors_.push_back({error.code, fmt::format("--{}, value {}{}", option, i + 1, name), error.message});
  }
  return result;
}

std::vector<double> OptionReader::alike(std::string_view option, std::span<const std::string_view> parts,
                                        Dimension dimension) {
  return values(option, parts, std::vector<Dimension>(parts.size(), dimension));
}

std::optional<Node> OptionReader::read(const Field& field, std::string_view option, std::string_view text) {
  using Shape = FieldShape;
  switch (field.shape) {
    case Shape::flag:
      return make_node(true);
    case Shape::whole:
      return quantity(option, text, Dimension::count);
    case Shape::quantity: {
      const std::string* envelope = arguments_.text("envelope");  // the limit is in what it bounds
      const bool is_limit = field.name == "limit" && query_ == "diagram";
      const Dimension of_limit = envelope && *envelope == "actuator" ? Dimension::length : Dimension::angle;
      return quantity(option, text, is_limit ? of_limit : field.dimension);
    }
    case Shape::word:
    case Shape::text_or_number:
      return make_node(text);
    case Shape::words:
      return words(text);
    case Shape::point:
      return point(option, text, field.dimension);
    case Shape::numbers:
    case Shape::per_leg:
      return numbers_node(alike(option, split(text), field.dimension));
    case Shape::inputs:
      return inputs(option, text);
    case Shape::signs:
      return signs(option, text);
    case Shape::pairs:
      return pairs(option, text, field.dimension);
    case Shape::lists:
      return sections(option, text, field.dimension);
    case Shape::pose:
      return pose(option, text);
    case Shape::independent:
      return independent(option, text);
    case Shape::start:
      return start(option, text);
    case Shape::place:
    case Shape::target:
      return place(option, text);
    case Shape::places:
      return places(std::string(text));
    case Shape::path_points:
      return read_arm_path(std::string(text), *robot_, errors_);
    case Shape::wrench:
      return wrench(option, text);
    case Shape::twist:
      return twist(option, text);
    case Shape::range:
      return range(option, text);
    case Shape::point_loads:
      return json(option, text);
    case Shape::growing_load:
    case Shape::settings:
      break;  // of several options
    case Shape::measured_rows:
    case Shape::names:
      break;  // of identify, which reads its own
  }
  return {};
}

/// A path out of a .csv file: the columns that `track -o` writes, any others are left alone.
std::optional<Node> OptionReader::places(const std::string& file) {
  const Expected<Table> table = read_csv(file);
  if (!table) {
    errors_.insert(errors_.end(), table.error().begin(), table.error().end());
    return {};
  }
  std::vector<const Column*> columns;
  for (const Input& column : pose_columns(robot_->is_spatial)) {
    const Column* found = table->find(column.name);
    if (!found || found->unit != column.unit) {
      fail("missing_column", "poses",
           fmt::format("{} has no column {}[{}]; a path needs a heading like x[m],y[m],phi[rad] (in space "
                       "x[m],y[m],z[m],rx[rad],ry[rad],rz[rad]).",
                       file, column.name, column.unit));
      return {};
    }
    columns.push_back(found);
  }
  std::vector<Node> list;
  list.reserve(table->row_count());
  for (std::size_t k = 0; k < table->row_count(); ++k) {
    std::vector<double> row;
    for (const Column* column : columns) row.push_back(column->values[k]);
    if (!std::ranges::all_of(row, [](double value) { return std::isfinite(value); })) {
      fail("not_a_number", "poses", fmt::format("{}: pose {} has an empty cell.", file, k + 1));
      return {};
    }
    list.push_back(is_held_by_three(*robot_) ? independent_of(row) : pose_node(row));
  }
  return list_of(std::move(list));
}

std::optional<Node> OptionReader::pose(std::string_view option, std::string_view text) {
  const auto parts = split(text);
  const std::size_t count = parts.size();
  if (robot_->is_spatial ? count != 6 && count != 7 : count != 3) {
    fail("wrong_length", option,
         fmt::format("{}; {}.", counted(text, count),
                     robot_->is_spatial
                         ? fmt::format("a spatial pose has six, x, y, z and its rotation vector, or "
                                       "seven, x, y, z and its quaternion w, x, y, z: --{} \"0, 0, "
                                       "180 mm, 0, 10 deg, 0\"",
                                       option)
                         : fmt::format("a planar pose has three, x, y, phi: --{} \"10 mm, -5 mm, 10 "
                                       "deg\"",
                                       option)));
    return {};
  }
  const auto dimensions = count == 3   ? lengths_then(2, Dimension::angle, 1)
                          : count == 6 ? lengths_then(3, Dimension::angle, 3)
                                       : lengths_then(3, Dimension::number, 4);
  const std::vector<double> numbers = values(option, parts, dimensions);
  // the query holds a quaternion, which no longer tells
  for (std::size_t k = 3; k < numbers.size() && count == 6; ++k)
    if (std::abs(numbers[k]) > 2 * std::numbers::pi)
      message(fmt::format("--{}: a rotation of {:.6g} rad is {:.3g} turns; did you mean \"{:.6g} deg\"?",
                          option, numbers[k], std::abs(numbers[k]) / (2 * std::numbers::pi), numbers[k]));
  return pose_node(numbers);
}

/// Where a path begins or ends: a pose, of rods with three inputs what those hold.
std::optional<Node> OptionReader::place(std::string_view option, std::string_view text) {
  return is_held_by_three(*robot_) ? independent(option, text) : pose(option, text);
}

/// A pose; of `inverse`, and of paths, inputs; of a serial robot its configuration.
std::optional<Node> OptionReader::start(std::string_view option, std::string_view text) {
  if (is_serial(*robot_)) return sections(option, text, Dimension::angle);
  if (is_arm(*robot_)) return sections(option, text, Dimension::curvature);
  const bool is_of_inputs = query_ == "inverse" || (query_ == "track" && arguments_.verb != "branches");
  return is_of_inputs ? inputs(option, text) : pose(option, text);
}

std::optional<Node> OptionReader::independent(std::string_view option, std::string_view text) {
  auto parts = split(text);
  const std::size_t count = parts.size();
  std::optional<Member> mode;
  if (count == 4) {
    mode = member_of("mode", make_node(parts.back()));
    parts.pop_back();
  }
  if (parts.size() != 3) {
    fail("wrong_length", option,
         fmt::format(
             "{}; {} three, a height and two components of the quaternion{}: --{} \"0.54 m, 0.1, 0.05\".",
             counted(text, count), option == "independent" ? "it has" : "three rod lengths hold",
             option == "independent" ? ", and after them half_turn for that mode" : "", option));
    return {};
  }
  const auto values_of = values(option, parts, lengths_then(1, Dimension::number, 2));
  Node node = independent_node(values_of[0], values_of[1], values_of[2]);
  if (mode) node.members.push_back(std::move(*mode));
  return node;
}

std::optional<Node> OptionReader::inputs(std::string_view option, std::string_view text) {
  const auto parts = split(text);
  std::vector<std::string_view> names;
  std::vector<Dimension> dimensions;
  for (const Input& input : robot_->inputs) {
    names.push_back(input.name);
    dimensions.push_back(dimension_of(input.unit));
  }
  if (parts.size() != names.size()) {
    fail("wrong_length", option,
         fmt::format("{}; this robot has {} input{}: {}.", counted(text, parts.size()), names.size(),
                     names.size() == 1 ? "" : "s", fmt::join(names, ", ")));
    return {};
  }
  return numbers_node(values(option, parts, dimensions, {}, names));
}

std::optional<Node> OptionReader::twist(std::string_view option, std::string_view text) {
  const auto parts = split(text);
  const std::size_t half = robot_->is_spatial ? 3 : 2, count = robot_->is_spatial ? 6 : 3;
  if (is_held_by_three(*robot_) && parts.size() == 3)  // vz, wx, wy
    return numbers_node(values(option, parts, lengths_then(1, Dimension::angle, 2), "/s"));
  if (parts.size() == count)
    return numbers_node(values(option, parts, lengths_then(half, Dimension::angle, count - half), "/s"));
  fail("wrong_length", option,
       fmt::format("{}; {}.", counted(text, parts.size()),
                   robot_->is_spatial
                       ? "a spatial twist has six, the velocity of the platform and its angular "
                         "velocity: --twist \"5 mm/s, 0, 0, 0, 0, 2 deg/s\""
                       : "a planar twist has three, the velocity of the platform and its turning "
                         "rate: --twist \"5 mm/s, 0, 2 deg/s\""));
  return {};
}

/// Forces, then moments.
std::optional<Node> OptionReader::wrench(std::string_view option, std::string_view text) {
  const auto parts = split(text);
  const std::size_t forces = robot_->is_spatial ? 3 : 2, count = robot_->is_spatial ? 6 : 3;
  if (parts.size() != count) {
    fail("wrong_length", option,
         fmt::format(
             "{}; {}.", counted(text, parts.size()),
             robot_->is_spatial
                 ? fmt::format("a spatial wrench has six, force and moment on the platform: --{} \"1 N, "
                               "-0.5 N, -5 N, 0.2 N m, 0.1 N m, -0.1 N m\"",
                               option)
                 : fmt::format("a planar wrench has three, force and moment on the platform: --{} \"1 "
                               "N, -0.5 N, 0.2 N m\"",
                               option)));
    return {};
  }
  std::vector<Dimension> dimensions(forces, Dimension::force);
  dimensions.resize(count, Dimension::moment);
  return numbers_node(values(option, parts, dimensions));
}

/// Of the parameter along a curve: LOW, HIGH.
std::optional<Node> OptionReader::range(std::string_view option, std::string_view text) {
  const auto parts = split(text);
  if (parts.size() == 2) return numbers_node(alike(option, parts, Dimension::number));
  fail("wrong_length", option,
       fmt::format("{}; it has two, the lowest and the highest: --range \"-1, 2\".",
                   counted(text, parts.size())));
  return {};
}

/// Some values for each section, sections apart by semicolons; `null` or `-` where nothing is held. Of one
/// section they are a plain list where the query takes that for the section's own.
std::optional<Node> OptionReader::sections(std::string_view option, std::string_view text,
                                           Dimension dimension) {
  std::vector<Node> list;
  for (bool more = true; more;) {
    const std::size_t end = text.find(';');
    auto parts = split(text.substr(0, end));
    std::vector<Dimension> dimensions(parts.size(), dimension);
    if (dimension == Dimension::angle && parts.size() == 3)
      dimensions[2] = Dimension::length;  // the extension
    std::vector<std::size_t> loose;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (holds_nothing(parts[i], dimension)) loose.push_back(i), parts[i] = "0";
    list.push_back(numbers_node(values(option, parts, dimensions)));
    for (const std::size_t i : loose) list.back().items[i] = Node();
    more = end != std::string_view::npos;
    if (more) text.remove_prefix(end + 1);
  }
  if (list.size() == 1 && query_ == "diagram") return list.front();
  return list_of(std::move(list));
}

std::optional<Node> OptionReader::quantity(std::string_view option, std::string_view text,
                                           Dimension dimension) {
  const Expected<double> value = parse_quantity(text, dimension);
  if (value) return make_node(*value);
  fail(value.error().front().code, option, value.error().front().message);
  return {};
}

/// As in a query.
std::optional<Node> OptionReader::json(std::string_view option, std::string_view text) {
  auto document = parse_json(text, std::string(option));
  if (document) return std::move(document->root);
  errors_.insert(errors_.end(), document.error().begin(), document.error().end());
  return {};
}

/// Values for each leg or section, these apart by semicolons; `null` or `-` where nothing is held.
std::optional<Node> OptionReader::pairs(std::string_view option, std::string_view text, Dimension dimension) {
  std::vector<Node> list;
  for (bool more = true; more;) {
    const std::size_t end = text.find(';');
    std::vector<Node> pair;
    for (const std::string_view part : split(text.substr(0, end))) {
      pair.push_back(holds_nothing(part, dimension)
                         ? Node()
                         : make_node(values(option, {&part, 1}, {&dimension, 1}).front()));
    }
    list.push_back(list_of(std::move(pair)));
    more = end != std::string_view::npos;
    if (more) text.remove_prefix(end + 1);
  }
  return list_of(std::move(list));
}

std::optional<Node> OptionReader::point(std::string_view option, std::string_view text, Dimension dimension) {
  const auto parts = split(text);
  if (parts.size() == 3) return numbers_node(alike(option, parts, dimension));
  fail("wrong_length", option, fmt::format("{}; it has three, x, y, z.", counted(text, parts.size())));
  return {};
}

std::optional<Node> OptionReader::signs(std::string_view option, std::string_view text) {
  std::vector<double> list;
  for (const std::string_view sign : split(text)) {
    const bool plus = sign == "+" || sign == "+1" || sign == "1", minus = sign == "-" || sign == "-1";
    if (!plus && !minus) {
      fail("not_a_sign", option,
           fmt::format("{} is no sign; give + or - for each leg: --{} \"+,-,+\".", in_quotes(sign), option));
      return {};
    }
    list.push_back(plus ? 1 : -1);
  }
  return numbers_node(list);
}

Node OptionReader::words(std::string_view text) {
  std::vector<Node> list;
  for (const std::string_view word : split(text)) list.push_back(make_node(word));
  return list_of(std::move(list));
}

}  // namespace sinew::cli
