#include "io/arm_legs_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/limits.hpp"
#include "io/read_place.hpp"
#include "io/read_pose.hpp"
#include "io/reader.hpp"
#include "io/serial_file.hpp"

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

ArmLeg read_arm_leg(Reader& item, const SpatialPose& home, const Errors& errors) {
  ArmLeg leg;
  if (!item.is(Node::Kind::map)) {
    item.refuse("wrong_type", "give a map of base, link, closure and platform_point.");
    return leg;
  }
  if (link_type(*item.node()) != elastic_link) {
    item.fail("mixed_legs",
              "its link is not elastic, and another leg's is: legs of sections stand beside no other kind in "
              "this version; make every link elastic, or none");
    return leg;
  }
  leg.base = read_arm_base(item.required("base", "{point, direction, section_x}"));
  Reader link = item.required("link");
  link.required("type");
  leg.arm = read_arm_of_leg(link, errors);
  link.close();
  Reader closure = item.required("closure", "{type: ball}, or {type: clamp}");
  leg.is_clamped = closure.required("type").choice({"ball", "clamp"}) == "clamp";
  closure.close();
  leg.platform_point =
      read_point<Spatial>(item.required("platform_point", "where the leg meets the platform"));
  if (const auto tied = item.optional("tied"))
    tied->refuse("not_available", "tendons of legs of sections are not tied in this version; leave it out");
  item.close();
  // A clamp holds the tip as it stands at home: straight, turned as the foot is.
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
  const Reader space = robot.required("space", "spatial: legs of sections are for robots in space");
  if (space.node() && space.choice({"spatial", "planar"}) == "planar")
    space.refuse("no_such_leg", "legs of sections are for robots in space; write space: spatial");
  if (const auto gravity = robot.optional("gravity")) {
    const Vec3<double> g = read_gravity(*gravity);
    result.gravity = {g.x(), g.y(), g.z()};
  }
  Reader platform = robot.required("platform", "{home: {position, quaternion}}");
  if (platform.is(Node::Kind::map)) {
    result.home = read_spatial_pose(platform.required("home", "{position, quaternion}: with legs at rest"));
    if (const auto radius = platform.optional("radius"))
      radius->quantity(Dimension::length, Range::size());  // what pages draw
    if (const auto mass = platform.optional("mass"))
      result.platform_mass = mass->quantity(Dimension::mass, Range::between(0, 1e9));
    platform.close();
  } else if (platform.node()) {
    platform.refuse("wrong_type", "give a map: {home: {position, quaternion}}.");
  }
  Reader legs = robot.required("legs", "a list, one entry a leg");
  auto items = legs.items();
  if (items.size() > max_arm_legs) {
    legs.fail("too_many_legs", fmt::format("there are {}; this build carries at most {} legs of sections.",
                                           items.size(), max_arm_legs));
    return tl::unexpected(errors);
  }
  for (Reader& item : items) result.legs.push_back(read_arm_leg(item, result.home, errors));
  if (result.tendons() > max_leg_tendons)
    legs.fail("too_many_tendons", fmt::format("the legs have {}; this build carries at most {}.",
                                              result.tendons(), max_leg_tendons));
  if (errors.empty()) {
    check_feet(legs, result);
    check_hold(legs, result);
  }
  robot.close();
  if (!errors.empty()) return tl::unexpected(errors);
  return result;
}

}  // namespace sinew::inline v1
