#include "query/unit_hint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/document/quantity.hpp"
#include "query/fields/fields.hpp"
#include "robot/parallel.hpp"
#include "sinew/robot/arm.hpp"
#include "sinew/robot/arm_legs.hpp"

namespace sinew::inline v1 {
namespace {

/// How many times the robot's own measure is far outside; by a slip of units it is 57 times or 1000 times.
constexpr double far_length = 10, far_change = 0.5, far_force = 1000, far_setting = 200;
constexpr double far_angle = 2 * std::numbers::pi;  ///< [rad]

/// A place of a query, written out only where something is said of it.
class Place {
 public:
  explicit Place(std::string_view key) : key_(key) {}
  Place(const Place& in, std::string_view key) : in_(&in), key_(key) {}
  Place(const Place& in, std::size_t index) : in_(&in), index_(index), is_index_(true) {}

  std::string text() const {
    const std::string before = in_ ? in_->text() : std::string();
    return is_index_ ? joined(before, index_) : joined(before, key_);
  }

 private:
  const Place* in_ = nullptr;
  std::string_view key_;
  std::size_t index_ = 0;
  bool is_index_ = false;
};

class Search {
 public:
  Search(const RobotScale& scale, std::span<const InputOfLeg> inputs) : scale_(scale), inputs_(inputs) {}

  std::string found() const { return found_; }
  void query(const Node& query);
  void settings(const Node& query, const Node& robot);

 private:
  void length(const Place& path, const Node& node, double most) {
    value(path, node, Dimension::length, most * scale_.length, scale_.length, "the robot's size");
  }
  void angle(const Place& path, const Node& node) { value(path, node, Dimension::angle, far_angle, 0, ""); }
  void force(const Place& path, const Node& node, Dimension dimension, double unit) {
    value(path, node, dimension, far_force * scale_.force * unit, scale_.force * unit,
          "what bends the robot's links far");
  }
  void value(const Place& path, const Node& node, Dimension dimension, double most, double measure,
             std::string_view of);
  template <class Each>
  void each(const Place& path, const Node& node, const Each& visit);
  void pose(const Place& path, const Node& node);
  void inputs(const Place& path, const Node& list);
  void wrench(const Place& path, const Node& list);
  void configuration(const Place& path, const Node& list);
  void field(const Field& field, const Place& path, const Node& node);
  void numbers(const Field& field, const Place& path, const Node& node);
  void twist(const Place& path, const Node& list);

  RobotScale scale_;
  std::span<const InputOfLeg> inputs_;
  std::string found_;
};

/// What the number may have been meant in.
std::string_view small_unit(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "mm";
    case Dimension::angle:
      return "deg";
    case Dimension::force:
      return "mN";
    default:
      return "N mm";
  }
}

/// @param most beyond it the value is far outside; none is where it is 0
/// @param measure of the robot, which the message compares with
void Search::value(const Place& path, const Node& node, Dimension dimension, double most, double measure,
                   std::string_view of) {
  double si = node.number;
  const bool is_bare = node.kind == Node::Kind::number;
  if (node.kind == Node::Kind::string)
    si = parse_quantity(node.text, dimension).value_or(0.0);
  else if (!is_bare)
    return;
  if (!found_.empty() || most <= 0 || !(std::abs(si) > most) || !std::isfinite(si)) return;
  const std::string size =
      dimension == Dimension::angle
          ? fmt::format("{:.3g} turns", std::abs(si) / far_angle)
          : fmt::format("{:.4g} times {} ({})", std::abs(si) / measure, of, human(measure, dimension));
  found_ = fmt::format("{} is {:.6g} {}, {}", path.text(), si, unit(dimension), size);
  if (is_bare)
    found_ += fmt::format("; did you mean \"{} {}\"?", node.text.empty() ? si_text(si) : node.text,
                          small_unit(dimension));
}

/// Of a list, in lists or not, each value with its path.
template <class Each>
void Search::each(const Place& path, const Node& node, const Each& visit) {
  if (node.kind != Node::Kind::list) return visit(path, node);
  for (std::size_t i = 0; i < node.items.size() && found_.empty(); ++i)
    each(Place(path, i), node.items[i], visit);
}

void Search::pose(const Place& path, const Node& node) {
  for (const Member& member : node.members) {
    const Place here(path, member.key);
    if (member.key == "position")
      each(here, member.value, [&](const Place& at, const Node& one) { length(at, one, far_length); });
    else if (member.key == "x" || member.key == "y" || member.key == "z")
      length(here, member.value, far_length);
    else if (member.key == "phi" || member.key == "tilt" || member.key == "azimuth" ||
             member.key == "torsion")
      angle(here, member.value);
  }
}

void Search::inputs(const Place& path, const Node& list) {
  for (std::size_t k = 0; k < std::min(list.items.size(), inputs_.size()); ++k) {
    if (inputs_[k].dimension == Dimension::angle)
      angle(Place(path, k), list.items[k]);
    else
      length(Place(path, k), list.items[k], far_length);
  }
}

void Search::wrench(const Place& path, const Node& list) {
  const std::size_t forces = list.items.size() == 3 ? 2 : 3;
  for (std::size_t k = 0; k < list.items.size(); ++k) {
    if (k < forces)
      force(Place(path, k), list.items[k], Dimension::force, 1);
    else
      force(Place(path, k), list.items[k], Dimension::moment, scale_.length);
  }
}

void Search::configuration(const Place& path, const Node& list) {
  for (std::size_t m = 0; m < list.items.size(); ++m)
    for (std::size_t k = 0; k < list.items[m].items.size(); ++k) {
      const Node& value_of = list.items[m].items[k];
      if (k < 2)
        angle(Place(Place(path, m), k), value_of);
      else
        length(Place(Place(path, m), k), value_of, far_change);
    }
}

void Search::query(const Node& query) {
  for (const Member& member : query.members)
    if (const Field* known = find_field(member.key)) field(*known, Place(member.key), member.value);
}

/// By the shape of the field.
void Search::field(const Field& field, const Place& path, const Node& node) {
  using Shape = FieldShape;
  switch (field.shape) {
    case Shape::inputs:
      if (field.dimension == Dimension::length) inputs(path, node);
      break;
    case Shape::start:
      if (node.kind == Node::Kind::map)
        pose(path, node);
      else if (inputs_.empty() && scale_.force > 0)
        break;  // an arm's curvatures: its shape may bend as sharply as it likes
      else if (inputs_.empty())
        configuration(path, node);
      else
        inputs(path, node);
      break;
    case Shape::pose:
    case Shape::place:
    case Shape::independent:
      pose(path, node);
      break;
    case Shape::places:
      for (std::size_t k = 0; k < node.items.size(); ++k) pose(Place(path, k), node.items[k]);
      break;
    case Shape::path_points:
      for (std::size_t k = 0; k < node.items.size(); ++k)
        for (const Member& member : node.items[k].members)
          if (const Field* known = find_field(member.key); known && known->shape != Shape::path_points)
            this->field(*known, Place(Place(path, k), member.key), member.value);
      break;
    case Shape::target:
      pose(path, node);
      if (const Node* target = node.find("pose")) pose(Place(path, "pose"), *target);
      if (const Node* target = node.find("inputs")) inputs(Place(path, "inputs"), *target);
      if (const Node* target = node.find("wrench")) wrench(Place(path, "wrench"), *target);
      break;
    case Shape::wrench:
      wrench(path, node);
      break;
    case Shape::growing_load:
      if (const Node* step = node.find("wrench")) wrench(Place(path, "wrench"), *step);
      break;
    case Shape::twist:
      if (field.name == "twist" && node.kind == Node::Kind::list) twist(path, node);
      break;
    case Shape::lists:
      if (field.dimension == Dimension::angle && field.uses.forward == of_serial)
        configuration(path, node);
      else
        numbers(field, path, node);
      break;
    case Shape::point:
    case Shape::numbers:
    case Shape::per_leg:
    case Shape::pairs:
    case Shape::quantity:
      numbers(field, path, node);
      break;
    default:
      break;
  }
}

/// What has one dimension: lengths, and changes of tendons; forces, of which a tendon's has a short arm: it
/// pulls more than it bends.
void Search::numbers(const Field& field, const Place& path, const Node& node) {
  const bool is_change =
      field.shape != FieldShape::point && ((field.uses.diagram | field.uses.forward) & ~of_arms) == of_serial;
  each(path, node, [&](const Place& at, const Node& one) {
    if (field.dimension == Dimension::length)
      length(at, one, is_change ? far_change : far_length);
    else if (field.dimension == Dimension::force)
      force(at, one, Dimension::force, 100);
  });
}

/// Velocities of the platform: of as much as its size a second.
void Search::twist(const Place& path, const Node& list) {
  const bool is_on_rods =
      std::ranges::any_of(inputs_, [](const InputOfLeg& input) { return input.name == "length"; });
  const std::size_t shifts = list.items.size() != 3 ? 3 : is_on_rods ? 1 : 2;  // of three inputs vz, wx, wy
  for (std::size_t k = 0; k < std::min(shifts, list.items.size()); ++k)
    length(Place(path, k), list.items[k], far_length);
}

/// A plain number in place of a length or an angle that is two hundred times smaller.
void Search::settings(const Node& query, const Node& robot) {
  const Node* set = query.find("set");
  if (!set) return;
  for (const Member& change : set->members) {
    if (change.value.kind != Node::Kind::number || !found_.empty()) continue;
    const Node* before = at(robot, change.key);
    if (!before) {  // of a file that says it for all legs, or by an architecture
      const std::string_view key = std::string_view(change.key).substr(change.key.rfind('.') + 1);
      if (key == "length" || key == "tendon_offset" || key == "diameter" || key == "radius" || key == "joint")
        length(Place(change.key), change.value, far_length);
      continue;
    }
    const auto old = before->kind == Node::Kind::string
                         ? parse_any_quantity(before->text)
                         : Expected<Quantity>(Quantity{before->number, Dimension::number});
    if (!old || (old->dimension != Dimension::length && old->dimension != Dimension::angle)) continue;
    if (!(std::abs(change.value.number) > far_setting * std::abs(old->value)) &&
        old->dimension == Dimension::length)
      continue;
    if (old->dimension == Dimension::angle && !(std::abs(change.value.number) > far_angle)) continue;
    found_ = fmt::format("{} = {} is in {}, and {} in the file; did you mean \"{} {}\"?", change.key,
                         change.value.text, old->dimension == Dimension::length ? "metres" : "radians",
                         before->text, change.value.text, small_unit(old->dimension));
  }
}

/// Where the answer says the robot is.
std::string far_answer(const Value& answer, const RobotScale& scale) {
  for (const std::string_view key : {"pose", "tip"}) {
    const Value* pose = answer.find(key);
    if (!pose || !pose->members()) continue;
    double square = 0;
    const auto add = [&](double part) { square += part * part; };
    if (const Value* position = pose->find("position"))
      std::ranges::for_each(position->block()->numbers(), add);
    else if (pose->find("x"))
      for (const std::string_view axis : {"x", "y"}) add(pose->find(axis)->number().value_or(0));
    const double distance = std::sqrt(square);
    if (distance > far_length * scale.length)
      return fmt::format("the answer is {:.6g} m away, {:.3g} times the robot's size ({})", distance,
                         distance / scale.length, human(scale.length, Dimension::length));
  }
  return {};
}

}  // namespace

RobotScale scale_of(const Robot& robot) {
  if (robot.serial()) return {.length = robot.serial()->longest()};
  if (const Arm* arm = robot.arm()) {
    const double length = arm->length();
    return {.length = length, .force = arm->sections.front().start.bending_x / (length * length)};
  }
  if (const ArmLegs* legs = robot.arm_legs(); legs && !legs->legs.empty()) {
    const Arm& arm = legs->legs.front().arm;
    const double length = arm.length();
    return {.length = length + legs->legs.front().base.p.norm(),
            .force = arm.sections.front().start.bending_x / (length * length)};
  }
  RobotScale scale;
  const double height = std::visit(
      []<class Pose>(const Pose& pose) {
        if constexpr (std::is_same_v<Pose, PlanarPose>)
          return std::hypot(pose.x, pose.y);
        else
          return pose.position.norm();
      },
      home(robot));
  double stiffness = 0;
  with_legs(robot, [&](const auto& r) {
    r.for_each_leg([&]<class L>(const L& leg, const LegPlace&, int) {
      double size = leg.base.p.norm() + leg.platform_point.norm() + height;
      if constexpr (requires { leg.size(); }) size += leg.size();
      scale.length = std::max(scale.length, size);
      if constexpr (BearsLoad<L>)
        stiffness += leg.link.bending_stiffness();
      else if (leg.backbone.youngs_modulus && leg.backbone.diameter)
        stiffness +=
            *leg.backbone.youngs_modulus * std::numbers::pi / 64 * std::pow(*leg.backbone.diameter, 4);
    });
  });
  if (scale.length > 0) scale.force = stiffness / (scale.length * scale.length);
  return scale;
}

std::string unit_hint(const Node& query, const Value& answer, const RobotScale& scale, const Node& robot,
                      std::span<const InputOfLeg> inputs) {
  Search search(scale, inputs);
  search.query(query);
  search.settings(query, robot);
  return search.found().empty() ? far_answer(answer, scale) : search.found();
}

}  // namespace sinew::inline v1
