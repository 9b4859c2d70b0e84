#include "io/robots/arm_legs_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/limits.hpp"
#include "io/document/reader.hpp"
#include "io/robots/read_place.hpp"
#include "io/robots/read_pose.hpp"
#include "io/robots/serial_file.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::string_view elastic_link = "elastic";
constexpr std::size_t max_arm_legs = 12, max_leg_tendons = 72;

std::string_view link_type(const Node& leg) {
  const Node* link = leg.find("link");
  const Node* type = link ? link->find("type") : nullptr;
  return type ? std::string_view(type->text) : std::string_view();
}

/// The robot whose legs have their sections listed.
Expected<Node> with_listed_sections(const Document& whole) {
  Node root = whole.root;
  Node* legs = root.find("legs");
  if (!legs) return root;
  for (std::size_t k = 0; k < legs->items.size(); ++k) {
    Node& leg = legs->items[k];
    Node* link = leg.find("link");
    if (!link || !link->find("sections")) continue;
    auto longer = expanded_sections(Document{whole.source, *link});
    if (!longer) {
      Errors errors = longer.error();  // which name places in the link
      const std::string path = joined(joined("legs", k), "link");
      for (Error& error : errors) {
        if (error.where.starts_with("sections")) error.where = joined(path, error.where);
        if (error.message.starts_with("sections")) error.message = joined(path, error.message);
      }
      return tl::unexpected(std::move(errors));
    }
    *link = std::move(longer->root);
  }
  return root;
}

/// The foot: z along the arm, x where angles of tendons are counted from.
SE3<double> read_arm_base(Reader base) {
  const Vec3<double> point = read_point<Spatial>(base.required("point", "where the leg starts"));
  const auto direction = base.optional("direction"), across = base.optional("section_x");
  const Vec3<double> ahead = direction ? read_direction(*direction) : Vec3<double>(0, 0, 1);
  const bool is_along_x = std::abs(ahead.x()) > 1 - 1e-6;
  const Vec3<double> towards = across       ? read_direction(*across)
                               : is_along_x ? Vec3<double>(0, 1, 0)
                                            : Vec3<double>(1, 0, 0);
  Vec3<double> aside = towards - ahead * dot(ahead, towards);
  if (aside.norm() < 1e-6) {
    if (across) across->fail("no_direction", "lies along the leg; the section's x is square to it");
    aside = cross(ahead, Vec3<double>(0.6, 0.48, 0.64));
  }
  if (const auto shared = base.optional("shared")) shared->boolean();
  base.close();
  aside.normalize();
  Mat<double, 3, 3> axes;
  axes << aside, cross(ahead, aside), ahead;
  return {point, SO3<double>::from(axes)};
}

bool is_elastic(Reader& item) {
  if (!item.is(Node::Kind::map)) {
    item.refuse("wrong_type", "give a map of base, link, closure and platform_point.");
    return false;
  }
  if (link_type(*item.node()) == elastic_link) return true;
  item.fail("mixed_legs",
            "its link is not elastic, and another leg's is: legs of sections stand beside no other kind in "
            "this version; make every link elastic, or none");
  return false;
}

Arm read_link(Reader link, const Errors& errors) {
  link.required("type");
  Arm arm = read_arm_of_leg(link, errors);
  link.close();
  return arm;
}

void refuse_tied(Reader& item) {
  if (const auto tied = item.optional("tied"))
    tied->refuse("not_available", "tendons of legs of sections are not tied in this version; leave it out");
}

ArmLeg read_arm_leg(Reader& item, const SpatialPose& home, const Errors& errors) {
  ArmLeg leg;
  if (!is_elastic(item)) return leg;
  leg.base = read_arm_base(item.required("base", "{point, direction, section_x}"));
  leg.arm = read_link(item.required("link"), errors);
  Reader closure = item.required("closure", "{type: ball}, or {type: clamp}");
  leg.is_clamped = closure.required("type").choice({"ball", "clamp"}) == "clamp";
  closure.close();
  leg.platform_point =
      read_point<Spatial>(item.required("platform_point", "where the leg meets the platform"));
  refuse_tied(item);
  item.close();
  // A clamp holds the tip as it stands at home: straight, turned as the foot is.
  leg.mount = SE3<double>::from(home).R.inverse().compose(leg.base.R);
  return leg;
}

/// Of what leaves the plane of x and z of a leg's sections.
void check_flat(const Reader& link, const Arm& arm) {
  for (std::size_t m = 0; m < arm.sections.size(); ++m)
    if (arm.sections[m].curvature[0] != 0 || arm.sections[m].curvature[2] != 0)
      link.fail(
          "out_of_plane",
          fmt::format("section {} is bent at rest about x, or twisted: in a planar robot it bends about y "
                      "alone; give precurvature: [0, u, 0]",
                      m));
  std::vector<std::size_t> counts(arm.sections.size());
  for (const ArmTendon& tendon : arm.tendons) {
    const auto section = static_cast<std::size_t>(tendon.section());
    const std::size_t index = counts[section]++;
    for (const TendonRoute& route : tendon.routes)
      for (const double angle : {route.start_angle, route.end_angle})
        if (std::abs(std::sin(angle)) > 1e-9) {
          link.fail(
              "out_of_plane",
              fmt::format("tendon {} of section {} runs at {:.6g} deg, beside the plane: in a planar robot "
                          "it is at 0 deg, right of the leg seen from its base, or at 180 deg",
                          index, section, angle * 180 / std::numbers::pi));
          return;
        }
  }
}

/// A leg in the plane: its sections' x is to the right, y down into the plane.
ArmLeg read_planar_leg(Reader& item, const SpatialPose& home, const Errors& errors) {
  ArmLeg leg;
  if (!is_elastic(item)) return leg;
  leg.arm = read_link(item.required("link"), errors);
  check_flat(item.required("link"), leg.arm);
  Reader closure =
      item.required("closure", "{type: chord}, {type: strut, length}, {type: pin} or {type: clamp}");
  const std::string type(closure.required("type").choice({"chord", "strut", "pin", "clamp"}));
  leg.is_clamped = type == "clamp";
  leg.turns_at_base = type == "chord";
  if (type == "strut")
    leg.strut = closure.required("length", "of the rigid bar between the tip and the platform")
                    .quantity(Dimension::length, Range::size());
  closure.close();
  leg.platform_point.head<2>() =
      read_point<Planar>(item.required("platform_point", "where the leg meets the platform"));
  Reader base = item.required("base", leg.turns_at_base ? "{point}" : "{point, direction}");
  leg.base.p.head<2>() = read_point<Planar>(base.required("point", "where the leg starts"));
  const Vec3<double> way = SE3<double>::from(home).point(leg.platform_point) - leg.base.p;
  double direction = std::atan2(way.y(), way.x());
  if (!leg.turns_at_base)
    direction =
        base.required("direction", "absolute angle of the backbone at its base").quantity(Dimension::angle);
  else if (const auto given = base.optional("direction"))
    given->fail("no_effect",
                "has no effect: a chord closure leaves the base joint free to turn; remove it, or write "
                "closure: {type: pin}");
  else if (errors.empty() && way.norm() < 1e-9 * leg.arm.length())
    base.fail("no_direction",
              "the platform is at the base point at home, which gives the leg no direction; move the home");
  if (const auto shared = base.optional("shared")) shared->boolean();
  base.close();
  refuse_tied(item);
  item.close();
  const double c = std::cos(direction), s = std::sin(direction);
  Mat<double, 3, 3> axes;
  axes << s, 0, c, -c, 0, s, 0, -1, 0;
  leg.base.R = SO3<double>::from(axes);
  leg.mount = SE3<double>::from(home).R.inverse().compose(leg.base.R);
  return leg;
}

void check_feet(const Reader& legs, const ArmLegs& robot) {
  auto items = legs.items();
  for (std::size_t j = 1; j < robot.legs.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      const double size = robot.legs[j].arm.length();
      if ((robot.legs[i].base.p - robot.legs[j].base.p).norm() > 1e-9 * size) continue;
      Reader base = items[j].required("base");
      const auto shared = base.optional("shared");
      if (shared && shared->boolean()) continue;
      base.fail("coincident_base_points",
                fmt::format("its point is that of legs[{}]; move one of them, or add shared: true", i));
      return;
    }
}

/// A leg of joints at both ends of what is held bears a force along one line, one with a joint at its tip any
/// force.
void check_planar_hold(const Reader& legs, const ArmLegs& robot) {
  int held = 0;
  double spread = 0, size = 0;
  for (const ArmLeg& leg : robot.legs) {
    if (leg.is_clamped) return;
    held += leg.turns_at_base || leg.strut > 0 ? 1 : 2;
    size = std::max(size, leg.platform_point.norm());
    spread = std::max(spread, (leg.platform_point - robot.legs[0].platform_point).norm());
  }
  if (held < 3)
    legs.fail(
        "loose_platform",
        fmt::format("they hold {} of the platform's 3 freedoms: a leg with chord or strut holds 1, with pin "
                    "2, with clamp 3; add legs, or close them otherwise",
                    held));
  else if (spread <= 1e-9 * size)
    legs.fail("collapsed_platform",
              "all platform points are one joint, so nothing holds the rotation about it; spread them, or "
              "clamp a leg");
}

/// Balls on one line leave the platform free to turn about it.
void check_hold(const Reader& legs, const ArmLegs& robot) {
  double spread = 0, size = 0;
  for (const ArmLeg& a : robot.legs) {
    if (a.is_clamped) return;
    size = std::max(size, a.platform_point.norm());
    for (const ArmLeg& b : robot.legs)
      for (const ArmLeg& c : robot.legs)
        spread = std::max(spread, cross(Vec3<double>(b.platform_point - a.platform_point),
                                        Vec3<double>(c.platform_point - a.platform_point))
                                      .norm());
  }
  if (spread > 1e-9 * size * size) return;
  legs.fail(
      "collapsed_platform",
      "all platform points lie on a line of ball joints, so nothing holds the rotation about it; spread "
      "them, or clamp a leg");
}

}  // namespace

bool stands_on_arms(const Node& robot) {
  const Node* legs = robot.find("legs");
  return legs && legs->kind == Node::Kind::list &&
         std::ranges::any_of(legs->items, [](const Node& leg) { return link_type(leg) == elastic_link; });
}

Expected<ArmLegs> read_arm_legs(const Document& document, const Document& whole) {
  const auto root = with_listed_sections(whole);
  if (!root) return tl::unexpected(root.error());
  Errors errors;
  Reader robot = Reader(document, errors).over(*root);
  ArmLegs result;
  const Reader version = robot.required("sinew", "version of the file format: 1");
  if (version.integer() != 1 && version.node())
    version.refuse("unknown_version", "this sinew reads version 1");
  if (const auto kind = robot.optional("kind"); kind && kind->node()->text != "parallel")
    kind->refuse("not_available", "its legs end at a platform: leave kind out, or write parallel");
  result.name = robot.required("name").text();
  if (const auto geometry = robot.optional("geometry"))
    result.geometry_inferred = geometry->choice({"given", "inferred"}) == "inferred";
  if (const auto defaults = robot.optional("defaults"))  // merged into the legs already
    if (!defaults->is(Node::Kind::map)) defaults->refuse("wrong_type", "give a map of what the legs share.");
  const Reader space = robot.required("space", "spatial or planar");
  result.is_planar = space.node() && space.choice({"spatial", "planar"}) == "planar";
  if (const auto gravity = robot.optional("gravity"))
    result.gravity = read_gravity_of(*gravity, result.is_planar);
  const std::string_view home_is = result.is_planar ? "{x, y, phi}" : "{position, quaternion}";
  Reader platform = robot.required("platform", fmt::format("{{home: {}}}", home_is));
  if (platform.is(Node::Kind::map)) {
    Reader home = platform.required("home", fmt::format("{}: with legs at rest", home_is));
    result.home =
        result.is_planar ? in_space(read_planar_pose(std::move(home))) : read_spatial_pose(std::move(home));
    if (const auto radius = platform.optional("radius"))
      radius->quantity(Dimension::length, Range::size());  // what pages draw
    if (const auto mass = platform.optional("mass"))
      result.platform_mass = mass->quantity(Dimension::mass, Range::between(0, 1e9));
    platform.close();
  } else if (platform.node()) {
    platform.refuse("wrong_type", fmt::format("give a map: {{home: {}}}.", home_is));
  }
  Reader legs = robot.required("legs", "a list, one entry a leg");
  auto items = legs.items();
  if (items.size() > max_arm_legs) {
    legs.fail("too_many_legs", fmt::format("there are {}; this build carries at most {} legs of sections.",
                                           items.size(), max_arm_legs));
    return tl::unexpected(errors);
  }
  for (Reader& item : items)
    result.legs.push_back(result.is_planar ? read_planar_leg(item, result.home, errors)
                                           : read_arm_leg(item, result.home, errors));
  if (result.tendons() > max_leg_tendons)
    legs.fail("too_many_tendons", fmt::format("the legs have {}; this build carries at most {}.",
                                              result.tendons(), max_leg_tendons));
  if (errors.empty()) {
    check_feet(legs, result);
    if (result.is_planar)
      check_planar_hold(legs, result);
    else
      check_hold(legs, result);
  }
  robot.close();
  if (!errors.empty()) return tl::unexpected(errors);
  return result;
}

}  // namespace sinew::inline v1
