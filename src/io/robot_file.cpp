#include "sinew/io/robot_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "io/architecture.hpp"
#include "io/builtin.hpp"
#include "sinew/base/limits.hpp"
#include "sinew/io/parse.hpp"
#include "sinew/io/reader.hpp"

namespace sinew::inline v0 {
namespace {

/// `[x, y]` or `{radius, angle}`.
Vec2<double> read_point(Reader point) {
  if (point.is(Node::Kind::map)) {
    const double radius =
        point.required("radius").quantity(Dimension::length, {.low = 0, .high = Range::place().high});
    const double angle = point.required("angle").quantity(Dimension::angle);
    point.close();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }
  const auto [x, y] = point.array<2>(Dimension::length, Range::place());
  return {x, y};
}

template <class Closure>
SE2<double> read_base(Reader base) {
  const Vec2<double> point = read_point(base.required("point", "where the leg starts"));
  double direction = std::numbers::pi / 2;
  if constexpr (Closure::base_turns) {
    if (base.has("direction"))
      base.fail("no_effect",
                fmt::format("direction has no effect: a {} closure leaves the base joint free to turn; "
                            "remove it",
                            Closure::name));
  } else {
    direction =
        base.required("direction", "absolute angle of the backbone at its base").quantity(Dimension::angle);
  }
  base.close();
  return SE2<double>::from(point.x(), point.y(),
                           direction - std::numbers::pi / 2);  // the tangent is the frame's +y
}

Backbone read_backbone(Reader& link) {
  Backbone backbone;
  Backbone::fields(backbone, FieldReader(link));
  if (auto material = link.optional("material")) {
    backbone.youngs_modulus = material->required("E").quantity(Dimension::pressure, Range::positive());
    material->close();
  }
  return backbone;
}

template <class LegT>
AnyPlanarLeg read_leg_of(Reader& leg, Reader& link, Reader& closure) {
  LegT result{};
  result.base = read_base<typename LegT::Closure>(leg.required("base", "{point, ...}"));
  LegT::Link::fields(result.link, FieldReader(link));
  LegT::Drive::fields(result.drive, FieldReader(link));
  result.backbone = read_backbone(link);
  LegT::Closure::fields(result.closure, FieldReader(closure));
  result.platform_point = read_point(leg.required("platform_point", "where the leg meets the platform"));
  if (const auto actuated = leg.optional("actuated")) {
    const auto items = actuated->items(1);
    if (!items.empty()) items[0].choice({LegT::Drive::input_name});
  }
  return {result};
}

/// The kind of leg that link and closure name, out of all kinds of this build.
template <class... Legs>
AnyPlanarLeg read_leg(Reader& leg, TypeList<Legs...>) {
  Reader link = leg.required("link", "{type, length, ...}"), closure = leg.required("closure", "{type, ...}");
  const auto kind = [](Reader& part, std::vector<std::string_view> names) {
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names[part.required("type").choice_index(names)];
  };
  const std::string_view link_name = kind(link, {Legs::Link::name...});
  const std::string_view closure_name = kind(closure, {Legs::Closure::name...});
  AnyPlanarLeg result{};
  const auto read_if = [&]<class LegT>(std::type_identity<LegT>) {
    if (LegT::Link::name != link_name || LegT::Closure::name != closure_name) return false;
    result = read_leg_of<LegT>(leg, link, closure);
    return true;
  };
  if (!(read_if(std::type_identity<Legs>{}) || ...))
    leg.fail("no_such_leg", fmt::format("no leg joins a {} link to a {} closure", link_name, closure_name));
  link.close();
  closure.close();
  return result;
}

struct Legs {
  std::vector<AnyPlanarLeg> legs;
  std::vector<int> inputs;
};

Legs read_legs(Reader& robot) {
  Legs result;
  auto items = robot.required("legs", "a list, one entry a leg").items();
  int next_input = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    Reader& leg = items[i];
    result.legs.push_back(read_leg(leg, PlanarLegs{}));
    if (const auto tied = leg.optional("tied")) {
      const int other = tied->integer({.low = 0});
      if (other < 0 || static_cast<std::size_t>(other) >= i)
        tied->refuse("out_of_range", "give the index of an earlier leg, whose actuator this one shares");
      result.inputs.push_back(other >= 0 && static_cast<std::size_t>(other) < i
                                  ? result.inputs[static_cast<std::size_t>(other)]
                                  : 0);
    } else {
      result.inputs.push_back(next_input++);
    }
    leg.close();
  }
  return result;
}

void check_legs(const Reader& legs, const Legs& read) {
  const std::size_t count = read.legs.size();
  if (count < Planar::dof)
    legs.fail("too_few_legs",
              fmt::format("a planar platform has 3 freedoms and each leg holds one, but {}; list at "
                          "least 3.",
                          count == 0   ? "there is none"
                          : count == 1 ? "there is 1 leg"
                                       : "there are 2 legs"));
  if (count > static_cast<std::size_t>(max_rows))
    legs.fail("too_many_legs",
              fmt::format("there are {} legs; this build carries at most {}.", count, max_rows));
}

PlanarPose read_home(Reader& platform) {
  auto home = platform.optional("home");
  if (!home) return {};
  const auto coordinate = [&](std::string_view key, Dimension dimension) {
    const auto value = home->optional(key);
    return value ? value->quantity(dimension, dimension == Dimension::length ? Range::place() : Range::any())
                 : 0.0;
  };
  const PlanarPose pose{coordinate("x", Dimension::length), coordinate("y", Dimension::length),
                        coordinate("phi", Dimension::angle)};
  home->close();
  return Planar::tidy(pose);
}

double largest_platform_point(const std::vector<AnyPlanarLeg>& legs) {
  double radius = 0;
  for (const AnyPlanarLeg& any : legs)
    radius = std::max(radius, with_leg(any, [](const auto& leg) { return leg.platform_point.norm(); }));
  return radius;
}

/// Reads a document that lists its legs.
AnyRobot read_listed(Reader& robot) {
  AnyRobot result;
  result.name = robot.required("name").text();
  if (const auto geometry = robot.optional("geometry"))
    result.geometry_inferred = geometry->choice({"given", "inferred"}) == "inferred";
  if (const auto defaults = robot.optional("defaults"))  // already merged into the legs
    if (!defaults->is(Node::Kind::map)) defaults->refuse("wrong_type", "give a map of what the legs share.");
  const Legs read = read_legs(robot);
  if (const auto legs = robot.optional("legs"))
    if (legs->is(Node::Kind::list)) check_legs(*legs, read);

  double radius = largest_platform_point(read.legs);
  PlanarPose home;
  if (auto platform = robot.optional("platform")) {
    home = read_home(*platform);
    if (const auto given = platform->optional("radius"))
      radius = given->quantity(Dimension::length, Range::size());
    platform->close();
  }
  robot.close();
  if (read.legs.empty()) return result;
  if (!(radius >= Range::size().low))
    robot.fail("collapsed_platform", "all platform points coincide with the reference point; spread them");
  result.model = make_robot(read.legs, read.inputs, home, radius);
  return result;
}

void check_head(Reader& robot) {
  const Reader version = robot.required("sinew", "version of the file format: 1");
  const int number = version.integer();
  if (version.node() && number != 1) version.refuse("unknown_version", "this sinew reads version 1");
  if (const auto kind = robot.optional("kind"))
    if (kind->choice({"parallel", "serial"}) == "serial")
      kind->refuse("not_available", "serial robots are not available in this version");
  if (const auto space = robot.optional("space"))
    if (space->choice({"planar", "spatial"}) == "spatial")
      space->refuse("not_available", "spatial robots are not available in this version");
}

bool is_short_form(const Document& document) { return document.root.find("architecture") != nullptr; }

void erase(Node& map, std::string_view key) {
  std::erase_if(map.members, [&](const Member& member) { return member.key == key; });
}

}  // namespace

Expected<Document> expanded(const Document& document) {
  if (!is_short_form(document)) return document;
  Errors errors;
  Reader robot(document, errors);
  const Architecture* architecture = architecture_of(robot);
  if (!errors.empty()) return tl::unexpected(errors);
  if (const auto legs = robot.optional("legs"))
    legs->fail("ambiguous", "the file gives an architecture and legs; keep one.");
  Node legs = legs_of(*architecture, robot);
  if (!errors.empty()) return tl::unexpected(errors);
  Document longer = document;
  for (const std::string_view key : {"architecture", "base", "legs"}) erase(longer.root, key);
  if (Node* platform = longer.root.find("platform"))
    for (const std::string_view key : {"angle", "angles"}) erase(*platform, key);
  longer.root.members.push_back({"legs", legs.line, legs.column, std::move(legs)});
  return longer;
}

namespace {

/// Every leg written out in full: architecture expanded, defaults merged in.
Expected<Document> listed(const Document& document) {
  Expected<Document> longer = expanded(document);
  if (!longer) return longer;
  const Node* defaults = longer->root.find("defaults");
  Node* legs = longer->root.find("legs");
  if (!defaults || !legs) return longer;
  for (Node& leg : legs->items) leg = merged(*defaults, leg);
  return longer;
}

}  // namespace

Expected<AnyRobot> read_robot(const Document& document) {
  const Expected<Document> longer = expanded(document);
  if (!longer) return tl::unexpected(longer.error());
  const Document whole = listed(*longer).value();
  Errors errors;
  Reader robot =
      Reader(*longer, errors).over(whole.root);  // a shared default is named as such, and told once
  check_head(robot);
  const auto is_final = [](const Error& error) { return error.code == "not_available"; };
  if (!robot.is(Node::Kind::map) || std::ranges::any_of(errors, is_final)) return tl::unexpected(errors);
  AnyRobot result = read_listed(robot);
  if (!errors.empty()) return tl::unexpected(errors);
  return result;
}

std::vector<std::string_view> builtin_robot_names() {
  std::vector<std::string_view> names;
  for (const BuiltinRobot& robot : builtin_robots()) names.push_back(robot.name);
  return names;
}

Expected<Document> read_robot_file(const std::string& path_or_name) {
  for (const BuiltinRobot& robot : builtin_robots())
    if (robot.name == path_or_name) return parse_yaml(robot.text, path_or_name);
  auto document = read_file(path_or_name);
  if (document || path_or_name.find_first_of("./") != std::string::npos) return document;
  Errors errors = std::move(document.error());  // looks like a name, not a file
  errors.front().message +=
      fmt::format(" Robots that come with sinew: {}.", fmt::join(builtin_robot_names(), ", "));
  return tl::unexpected(std::move(errors));
}

Expected<AnyRobot> load(const std::string& path_or_name) {
  const Expected<Document> document = read_robot_file(path_or_name);
  return document ? read_robot(*document) : tl::unexpected(document.error());
}

Expected<Document> with(const Document& document, const std::string& path, Node value) {
  Document changed = document;
  if (path.starts_with("legs")) {
    auto longer = listed(document);
    if (!longer) return longer;
    changed = std::move(*longer);
  }
  // A place of its own, in no file: an error about the value is then named by its path, and told once.
  value.line = -1;
  value.column = static_cast<int>(std::hash<std::string>{}(path)&0x7fffffffU);
  if (const auto done = set(changed.root, path, std::move(value)); !done) return tl::unexpected(done.error());
  return changed;
}

}  // namespace sinew::inline v0
