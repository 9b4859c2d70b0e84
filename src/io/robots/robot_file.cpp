#include "sinew/io/robot_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/limits.hpp"
#include "io/document/parse.hpp"
#include "io/document/reader.hpp"
#include "io/robots/actuation.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/arm_legs_file.hpp"
#include "io/robots/builtin.hpp"
#include "io/robots/read_material.hpp"
#include "io/robots/read_place.hpp"
#include "io/robots/read_pose.hpp"
#include "io/robots/robot_size.hpp"
#include "io/robots/serial_file.hpp"
#include "robot/parallel.hpp"
#include "tendon/input_kind.hpp"
#include "tendon/theta_is.hpp"

namespace sinew::inline v1 {
namespace {

/// Axes at the foot of a planar leg: the clamped tangent is +y.
template <class LegT>
SE2<double> read_foot(Reader& base, const Vec2<double>& point) {
  double direction = std::numbers::pi / 2;
  if constexpr (LegT::is_clamped) {
    direction =
        base.required("direction", "absolute angle of the backbone at its base").quantity(Dimension::angle);
  } else if (base.has("direction")) {
    const auto why = LegT::Closure::base_turns
                         ? fmt::format("a {} closure leaves the base joint free to turn", LegT::Closure::name)
                         : fmt::format("a {} link turns at its base by its input theta", LegT::Link::name);
    base.fail("no_effect", fmt::format("direction has no effect: {}; remove it", why));
  }
  return SE2<double>::from(point.x(), point.y(), direction - std::numbers::pi / 2);
}

/// Axes at the foot of a spatial leg: x along the first axis of its universal joint, see Spatial; of a rail x
/// along the axis of the hinge and y along the rail.
template <class LegT>
SE3<double> read_foot(Reader& base, const Vec3<double>& point) {
  constexpr bool is_rail = HasSlide<typename LegT::Link>;
  const Reader axis =
      is_rail
          ? base.required("hinge_axis",
                          "axis of the strut's hinge, square to the rail: [1, 0, 0], or an angle in the base "
                          "plane")
          : base.required("first_axis",
                          "first axis of the universal joint: [1, 0, 0], or an angle in the base plane");
  const Vec3<double> first = read_direction(axis);
  const auto given = base.optional("direction");
  const Vec3<double> ahead = given ? read_direction(*given) : Vec3<double>(0, 0, 1);
  const Vec3<double> side = cross(first, ahead);
  const bool is_slanted = is_rail && std::abs(dot(first, ahead)) > 1e-6;
  if (side.norm() < 1e-6 || is_slanted) {
    axis.fail("no_direction",
              is_rail
                  ? "must be square to the rail (base.direction, default [0, 0, 1]); turn one of them"
                  : "lies along the leg's direction when the joint is straight (base.direction, default [0, "
                    "0, 1]); turn one of them");
    return {point, SO3<double>::identity()};
  }
  const Vec3<double> second = side.normalized();
  Mat<double, 3, 3> axes;
  axes << first, cross(second, first), second;
  return {point, SO3<double>::from(axes)};
}

template <class LegT>
typename LegT::Frame read_base(Reader base) {
  const auto point = read_point<typename LegT::Space>(base.required("point", "where the leg starts"));
  auto frame = read_foot<LegT>(base, point);
  if (const auto shared = base.optional("shared")) shared->boolean();  // asked again by check_base_points
  base.close();
  return frame;
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

/// The names of the inputs, as the file repeats them.
template <class LegT>
void read_actuated(Reader& leg) {
  const auto actuated = leg.optional("actuated");
  if (!actuated) return;
  std::vector<std::string_view> names;
  for (const InputKind& kind : LegT::Drive::input_kinds) names.push_back(kind.name);
  const Node& list = *actuated->node();
  if (list.kind == Node::Kind::list &&
      std::ranges::equal(list.items, names, {}, [](const Node& item) { return std::string_view(item.text); }))
    return;
  actuated->fail(
      "wrong_actuators",
      fmt::format("a leg with link {} and closure {} has the actuators [{}]; write these, or leave "
                  "the list out",
                  LegT::Link::name, LegT::Closure::name, fmt::join(names, ", ")));
}

/// Axes at the foot of a rod: +y along its guide.
Vec3<double> read_guide(Reader& base) {
  const auto given = base.optional("direction");
  return given ? read_direction(*given) : Vec3<double>(0, 0, 1);
}
/// The x of a rod's section, square to where the rod goes; `otherwise` where the file does not say.
Vec3<double> read_section_x(Reader& end, const Vec3<double>& ahead, const Vec3<double>& otherwise) {
  const auto given = end.optional("section_x");
  const Vec3<double> towards = given ? read_direction(*given) : otherwise;
  const Vec3<double> aside = towards - ahead * dot(ahead, towards);
  if (aside.norm() >= 1e-6) return aside.normalized();
  if (given) given->fail("no_direction", "lies along the rod; the section's x is square to it");
  return otherwise;
}

SE3<double> guide_frame(Reader& base, const Vec3<double>& point, const Vec3<double>& ahead) {
  Eigen::Index least;
  ahead.cwiseAbs().minCoeff(&least);
  const Vec3<double> any = cross(ahead, Vec3<double>(Vec3<double>::Unit(least))).normalized();
  const Vec3<double> aside = read_section_x(base, ahead, any);
  Mat<double, 3, 3> axes;
  axes << aside, ahead, cross(aside, ahead);
  return {point, SO3<double>::from(axes)};
}

Vec3<double> read_vector(const Reader& list, Dimension dimension) {
  const auto [x, y, z] = list.array<3>(dimension, Range::between(-1e6, 1e6));
  return {x, y, z};
}

/// What the rod is at rest and what weighs on it.
void read_shape(Rod& rod, Reader& link) {
  if (auto section = link.optional("section")) {
    rod.width =
        section->required("width", "along the section's x").quantity(Dimension::length, Range::positive());
    rod.height =
        section->required("height", "along the section's y").quantity(Dimension::length, Range::positive());
    section->close();
    if (const auto diameter = link.optional("diameter"))
      diameter->refuse("ambiguous", "section and diameter both say how thick the rod is; keep one");
  } else {
    Rod::fields(rod, FieldReader(link));
  }
  if (const auto bent = link.optional("precurvature"))
    rod.precurvature = read_vector(*bent, Dimension::curvature);
  if (const auto load = link.optional("load")) rod.load = read_vector(*load, Dimension::line_load);
}

/// The joint that holds a clamped tip.
void read_clamp(RodLeg& leg, Reader& closure) {
  if (const auto direction = closure.optional("direction")) leg.platform_tangent = read_direction(*direction);
  if (const auto spin = closure.optional("spin"))
    leg.is_tip_spin_free = spin->choice({"held", "free"}) == "free";
  // where the base's x points along the clamp, its third axis does not
  const Vec3<double> x = leg.base.rotate(Vec3<double>(1, 0, 0)), &t = leg.platform_tangent;
  const Vec3<double> z = leg.base.rotate(Vec3<double>(0, 0, 1)), aside = cross(t, x).norm() < 1e-6 ? z : x;
  leg.platform_across = read_section_x(closure, t, Vec3<double>(aside - t * dot(t, aside)).normalized());
}

/// What torque needs, which only the whole leg tells.
void check_torque(const RodLeg& leg, Reader& link) {
  if (leg.link.is_cosserat || (leg.is_torque_free() && !link.has("precurvature"))) return;
  auto material = link.optional("material");
  if (!material || material->has("G") || material->has("poisson")) return;
  material->fail("missing_key",
                 "this rod bears torque: it is not round, is bent when free, or is held against spin at both "
                 "ends; it needs G, or poisson: Poisson's ratio");
}

/// E, and what shear, stretch and weight need.
void read_rod_material(Rod& rod, Reader& link) {
  if (const auto law = link.optional("law"))
    rod.is_cosserat = law->choice({"kirchhoff", "cosserat"}) == "cosserat";
  Reader material = link.required("material", "{E: Young's modulus}");
  rod.youngs_modulus = material.required("E").quantity(Dimension::pressure, Range::positive());
  const auto shear = read_shear_modulus(material, rod.youngs_modulus);
  if (shear) rod.shear_modulus = *shear;
  if (rod.is_cosserat && !shear)
    material.fail("missing_key", "law: cosserat, which shears, needs G, or poisson: Poisson's ratio");
  if (const auto density = material.optional("density"))
    rod.density = density->quantity(Dimension::density, Range::not_negative());
  material.close();
}

RodLeg read_rod(Reader& leg, Reader& link, Reader& closure, bool is_clamped) {
  RodLeg result;
  Reader base = leg.required("base", "{point, ...}");
  const auto point = read_point<Spatial>(base.required("point", "where the rod leaves its guide"));
  result.base = guide_frame(base, point, read_guide(base));
  if (const auto spin = base.optional("spin")) result.is_spin_held = spin->choice({"free", "held"}) == "held";
  if (const auto shared = base.optional("shared")) shared->boolean();  // asked again by check_base_points
  base.close();
  read_shape(result.link, link);
  read_rod_material(result.link, link);
  result.is_clamped = is_clamped;
  if (is_clamped) read_clamp(result, closure);
  check_torque(result, link);
  result.platform_point =
      read_point<Spatial>(leg.required("platform_point", "where the leg meets the platform"));
  read_actuated<RodLeg>(leg);
  return result;
}

template <class LegT>
LegT read_closing_leg(Reader& leg, Reader& link, Reader& closure) {
  LegT result{};
  result.base = read_base<LegT>(leg.required("base", "{point, ...}"));
  LegT::Link::fields(result.link, FieldReader(link));
  LegT::Drive::fields(result.drive, FieldReader(link));
  if constexpr (requires { result.drive.theta_is; })
    if (const auto theta = link.optional("theta_is")) result.drive.theta_is = read_theta_is(*theta);
  if constexpr (HasArc<typename LegT::Link>) result.backbone = read_backbone(link);
  LegT::Closure::fields(result.closure, FieldReader(closure));
  result.platform_point =
      read_point<typename LegT::Space>(leg.required("platform_point", "where the leg meets the platform"));
  read_actuated<LegT>(leg);
  return result;
}

/// What people ask for that no leg has yet is called by its name, with what there is instead.
bool is_supported(Reader& leg) {
  constexpr std::string_view one_link =
      "a leg has one link in this version: model it by one link of the same length, or a lone arm of several "
      "sections by kind: serial";
  constexpr std::string_view one_tendon =
      "a link is bent in one plane, by one tendon and its twin, in this version; sections with three or four "
      "tendons are for robots of kind: serial";
  if (!leg.is(Node::Kind::map)) return true;  // said by whoever reads it
  if (const auto links = leg.optional("links")) {
    links->refuse("not_available", one_link);
    return false;
  }
  auto link = leg.optional("link");
  if (link && link->is(Node::Kind::list)) {
    link->refuse("not_available", one_link);
    return false;
  }
  auto tendons = leg.optional("tendons");
  if (!tendons && link && link->is(Node::Kind::map)) tendons = link->optional("tendons");
  if (tendons) tendons->refuse("not_available", one_tendon);
  return !tendons;
}

/// The kind of leg that link and closure name, out of all kinds of one space; none where there is no such
/// kind.
template <class Any, class... Legs>
std::optional<Any> read_leg(Reader& leg, TypeList<Legs...>) {
  if (!is_supported(leg)) return {};
  Reader link = leg.required("link", "{type, length, ...}"), closure = leg.required("closure", "{type, ...}");
  const auto kind = [](Reader& part, std::vector<std::string_view> names) {
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names[part.required("type").choice_index(names)];
  };
  Any result{};
  const std::string_view link_name = kind(link, {Legs::Link::name...});
  std::string_view closure_name;
  const auto read_if = [&]<class LegT>(std::type_identity<LegT>) {
    if constexpr (BearsLoad<LegT>) {
      if (LegT::Link::name != link_name) return false;
      result.kind =
          LegT(read_rod(leg, link, closure, kind(closure, {Ball::name, Clamp::name}) == Clamp::name));
    } else {
      if (closure_name.empty()) closure_name = kind(closure, {Legs::Closure::name...});
      if (LegT::Link::name != link_name || LegT::Closure::name != closure_name) return false;
      result.kind = read_closing_leg<LegT>(leg, link, closure);
    }
    return true;
  };
  const auto pairs = std::array{fmt::format("{} with {}", Legs::Link::name, Legs::Closure::name)...};
  if (!(read_if(std::type_identity<Legs>{}) || ...)) {
    leg.fail("no_such_leg", fmt::format("no leg joins link {} to closure {}; there are {}", link_name,
                                        closure_name, fmt::join(pairs, ", ")));
    return {};
  }
  link.close();
  closure.close();
  return result;
}

/// The legs of a file, and what is tied.
template <class Any>
struct Legs {
  std::vector<Any> legs;
  std::vector<int> tied;
  bool is_whole = true;  ///< every leg is of a kind that exists
};

/// The earlier leg whose actuator leg i shares; −1 where it has its own.
template <class Any>
int read_tie(Reader& leg, const std::vector<Any>& legs, std::size_t i) {
  const auto tied = leg.optional("tied");
  if (!tied) return -1;
  const int other = tied->integer({.low = 0});
  if (other < 0 || static_cast<std::size_t>(other) >= i) {
    tied->refuse("out_of_range", "give the index of an earlier leg, whose actuator this one shares");
    return -1;
  }
  const auto input_count = [](const Any& any) {
    return with_leg(any, []<class L>(const L&) { return L::inputs; });
  };
  if (input_count(legs[i]) != 1 || input_count(legs[static_cast<std::size_t>(other)]) != 1)
    tied->refuse("not_available", "only legs with one actuator each can share it");
  else if (legs[i].kind.index() != legs[static_cast<std::size_t>(other)].kind.index())
    tied->refuse("not_available", "only legs of one kind can share an actuator");
  return other;
}

template <class Any, class Kinds>
Legs<Any> read_legs(Reader& robot, Kinds kinds) {
  Legs<Any> result;
  auto items = robot.required("legs", "a list, one entry a leg").items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto leg = read_leg<Any>(items[i], kinds);
    result.is_whole = result.is_whole && leg;
    result.legs.push_back(leg.value_or(Any{}));
    result.tied.push_back(read_tie(items[i], result.legs, i));
    if (leg) items[i].close();
  }
  return result;
}

template <class Any>
void check_count(const Reader& legs, const std::vector<Any>& read) {
  int rows = 0, inputs = 0;
  for (const Any& any : read)
    with_leg(any, [&]<class L>(const L&) {
      rows += L::rows;
      inputs += L::inputs;
    });
  if (read.empty()) legs.fail("too_few_legs", "there is none; list at least one leg.");
  if (rows > max_rows || inputs > max_rows)
    legs.fail("too_many_legs", fmt::format("there are {} legs with {} constraints and {} actuators; this "
                                           "build carries at most {} of either.",
                                           read.size(), rows, inputs, max_rows));
}

/// Two legs from one point of the base are a slip, unless the file says that they share it.
template <class Any>
void check_base_points(const Reader& legs, const std::vector<Any>& read, double size) {
  const auto point = [&](std::size_t i) {
    return with_leg(read[i],
                    [](const auto& leg) -> Vec<double, Any::Space::dimension> { return leg.base.p; });
  };
  auto items = legs.items();
  for (std::size_t j = 1; j < read.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      if ((point(i) - point(j)).norm() > 1e-9 * size) continue;
      Reader base = items[j].required("base");
      const auto shared = base.optional("shared");
      if (shared && shared->boolean()) continue;
      base.fail("coincident_base_points",
                fmt::format("its point is that of legs[{}]; move one of them, or add shared: true if both "
                            "joints sit on one axis",
                            i));
      return;
    }
}

/// Platform points must span what turns: two of them in the plane, three off a line in space.
template <class Any>
bool is_collapsed(const std::vector<Any>& read, double size) {
  std::vector<Vec3<double>> points;
  for (const Any& any : read) {
    Vec3<double> point = Vec3<double>::Zero();
    with_leg(any,
             [&](const auto& leg) { point.template head<Any::Space::dimension>() = leg.platform_point; });
    points.push_back(point);
  }
  double spread = 0;
  for (const auto& p : points)
    for (const auto& q : points) {
      if constexpr (Any::Space::dimension == 2)
        spread = std::max(spread, (q - p).norm());
      else
        for (const auto& r : points) spread = std::max(spread, cross(q - p, r - p).norm() / size);
    }
  return points.size() >= Any::Space::dimension && spread <= 1e-9 * size;
}

template <class Space>
typename Space::Pose read_home(Reader& platform) {
  auto home = platform.optional("home");
  if constexpr (Space::dimension == 3) {
    if (!home) platform.required("home", "{position, quaternion}: where the search for a pose starts");
    return home ? read_spatial_pose(std::move(*home)) : SpatialPose{};
  } else {
    if (!home) return {};
    const auto coordinate = [&](std::string_view key, Dimension dimension) {
      const auto value = home->optional(key);
      return value
                 ? value->quantity(dimension, dimension == Dimension::length ? Range::place() : Range::any())
                 : 0.0;
    };
    const PlanarPose pose{coordinate("x", Dimension::length), coordinate("y", Dimension::length),
                          coordinate("phi", Dimension::angle)};
    home->close();
    return Space::tidy(pose);
  }
}

template <class Any>
double largest_platform_point(const std::vector<Any>& legs) {
  double radius = 0;
  for (const Any& any : legs)
    radius = std::max(radius, with_leg(any, [](const auto& leg) { return leg.platform_point.norm(); }));
  return radius;
}

/// What weighs on rods; on legs that bear no load nothing does.
void read_mass(Reader& platform, bool has_rods, Weight& weight) {
  const auto mass = platform.optional("mass");
  if (!mass) return;
  if (!has_rods) mass->fail("no_effect", "has no effect: the legs bear no load; leave it out");
  weight.platform_mass = mass->quantity(Dimension::mass, Range::not_negative());
}

/// Legs, platform and home of one space.
template <class RobotT, class Kinds>
RobotT read_model(Reader& robot, Kinds kinds, Weight& weight) {
  using Any = typename RobotT::Leg;
  const Legs<Any> read = read_legs<Any>(robot, kinds);
  double radius = largest_platform_point(read.legs);
  typename Any::Space::Pose home;
  if (auto platform = robot.optional("platform")) {
    home = read_home<typename Any::Space>(*platform);
    if (const auto given = platform->optional("radius"))
      radius = given->quantity(Dimension::length, Range::size());
    read_mass(*platform, std::is_same_v<Kinds, LoadedLegs>, weight);
    platform->close();
  } else if (Any::Space::dimension == 3) {
    robot.required("platform", "{home: {position, quaternion}}");
  }
  if (const auto legs = robot.optional("legs"); legs && legs->is(Node::Kind::list)) {
    check_count(*legs, read.legs);
    if (read.is_whole) check_base_points(*legs, read.legs, radius);
  }
  if (read.legs.empty()) return {};
  if (read.is_whole && (!(radius >= Range::size().low) || is_collapsed(read.legs, radius)))
    robot.fail(
        "collapsed_platform",
        Any::Space::dimension == 2
            ? "all platform points coincide, so nothing holds the platform's rotation; spread them"
            : "all platform points lie on a line, so nothing holds the rotation about it; spread them");
  return RobotT(read.legs, home, radius, read.tied);
}

/// The link types of the legs as the file writes them; empty where there is none.
std::vector<std::string_view> link_types(const Reader& robot) {
  std::vector<std::string_view> types;
  const Node* legs = robot.node() ? robot.node()->find("legs") : nullptr;
  if (!legs || legs->kind != Node::Kind::list) return types;
  for (const Node& leg : legs->items) {
    const Node* link = leg.kind == Node::Kind::map ? leg.find("link") : nullptr;
    const Node* type = link && link->kind == Node::Kind::map ? link->find("type") : nullptr;
    types.push_back(type ? std::string_view(type->text) : std::string_view());
  }
  return types;
}

/// Whether rods are in the plane, where none can be. One error says so.
bool has_misplaced_rods(Reader& robot, bool is_spatial) {
  const auto types = link_types(robot);
  const auto rod = std::ranges::find(types, Rod::name);
  if (rod == types.end() || is_spatial) return false;
  robot.required("legs")
      .items()[static_cast<std::size_t>(rod - types.begin())]
      .required("link")
      .required("type")
      .refuse("no_such_leg", "rods are for robots in space; write space: spatial");
  return true;
}

/// Reads a document that lists its legs.
Robot read_listed(Reader& robot) {
  const std::string name = robot.required("name").text();
  const auto geometry = robot.optional("geometry");
  const bool is_inferred = geometry && geometry->choice({"given", "inferred"}) == "inferred";
  if (const auto defaults = robot.optional("defaults"))  // already merged into the legs
    if (!defaults->is(Node::Kind::map)) defaults->refuse("wrong_type", "give a map of what the legs share.");
  const auto space = robot.optional("space");
  const bool is_spatial = space && space->choice({"planar", "spatial"}) == "spatial";
  if (has_misplaced_rods(robot, is_spatial)) return {};
  const bool has_rods = is_spatial && std::ranges::count(link_types(robot), Rod::name) > 0;
  Weight weight;
  if (const auto gravity = robot.optional("gravity")) {
    if (!has_rods) gravity->fail("no_effect", "has no effect: the legs bear no load; leave it out");
    weight.gravity = read_gravity(*gravity);
  }
  Robot result;
  if (!is_spatial) {
    result = Robot(name, read_model<PlanarRobot>(robot, PlanarLegs{}, weight), is_inferred);
  } else {
    auto legs = has_rods ? read_model<SpatialRobot>(robot, LoadedLegs{}, weight)
                         : read_model<SpatialRobot>(robot, SpatialLegs{}, weight);
    result = Robot(name, std::move(legs), weight, is_inferred);
  }
  robot.close();
  return result;
}

void check_head(Reader& robot) {
  const Reader version = robot.required("sinew", "version of the file format: 1");
  const int number = version.integer();
  if (version.node() && number != 1) version.refuse("unknown_version", "this sinew reads version 1");
  if (const auto kind = robot.optional("kind")) kind->choice({"parallel", "serial"});
}

/// Every leg written out in full: architecture expanded, defaults merged in. What no robot can have is
/// refused first: the defaults are copied into each leg, and legs are compared with each other.
Expected<Document> listed(const Document& document) {
  if (auto fits = check_size(document); !fits) return tl::unexpected(fits.error());
  Expected<Document> longer = expanded(document);
  if (!longer) return longer;
  const Node* list = longer->root.find("legs");
  if (const std::size_t count = list ? list->items.size() : 0; count > max_rows)
    return failure(
        "too_many_legs", place(document, list->line, list->column),
        fmt::format("legs: there are {} legs; this build carries at most {} constraints and {} actuators.",
                    count, max_rows, max_rows));
  const Node* defaults = longer->root.find("defaults");
  Node* legs = longer->root.find("legs");
  if (!defaults || !legs) return longer;
  for (Node& leg : legs->items) leg = merged(*defaults, leg);
  return longer;
}

}  // namespace

Expected<void> check_size(const Document& document) {
  constexpr std::size_t most = 5000;  // of 24 legs with all that they can have about a thousand
  const auto count = [](const auto& self, const Node& node) -> std::size_t {
    std::size_t values = 1;
    for (const Node& item : node.items) values += self(self, item);
    for (const Member& member : node.members) values += self(self, member.value);
    return values;
  };
  const std::size_t values = count(count, document.root);
  if (values <= most) return {};
  return failure("too_large", document.source,
                 fmt::format("it has {} values; a robot has at most {}.", values, most));
}

Expected<Robot> read_robot(const Document& document) {
  if (is_arm(document)) return read_arm(document).map([](Arm arm) { return Robot(std::move(arm)); });
  if (is_serial(document))
    return read_serial_robot(document).map([](SerialRobot robot) { return Robot(std::move(robot)); });
  if (auto fits = check_size(document); !fits) return tl::unexpected(fits.error());
  const Expected<Document> longer = expanded(document);
  if (!longer) return tl::unexpected(longer.error());
  const Expected<Document> whole = listed(*longer);
  if (!whole) return tl::unexpected(whole.error());
  if (stands_on_arms(whole->root))
    return read_arm_legs(*longer, *whole).map([](ArmLegs legs) { return Robot(std::move(legs)); });
  Errors errors;
  Reader robot =
      Reader(*longer, errors).over(whole->root);  // a shared default is named as such, and told once
  check_head(robot);
  const auto is_final = [](const Error& error) { return error.code == "not_available"; };
  if (!robot.is(Node::Kind::map) || std::ranges::any_of(errors, is_final)) return tl::unexpected(errors);
  Robot result = read_listed(robot);
  if (!errors.empty()) return tl::unexpected(errors);
  return result;
}

std::vector<std::string_view> builtin_robot_names() {
  std::vector<std::string_view> names;
  for (const BuiltinRobot& robot : builtin_robots()) names.push_back(robot.name);
  return names;
}

std::string_view robot_template(std::string_view name) {
  const auto found = std::ranges::find(robot_templates(), name, &BuiltinRobot::name);
  return found == robot_templates().end() ? std::string_view() : found->text;
}

std::vector<std::string_view> robot_template_names() {
  std::vector<std::string_view> names;
  for (const BuiltinRobot& robot : robot_templates()) names.push_back(robot.name);
  return names;
}

Expected<std::string> read_robot_text(const std::string& path_or_name) {
  for (const BuiltinRobot& robot : builtin_robots())
    if (robot.name == path_or_name) return std::string(robot.text);
  auto text = read_text(path_or_name);
  if (text || path_or_name.find_first_of("./") != std::string::npos) return text;
  Errors errors = std::move(text.error());  // looks like a name, not a file
  errors.front().message +=
      fmt::format(" Robots that come with sinew: {}.", fmt::join(builtin_robot_names(), ", "));
  return tl::unexpected(std::move(errors));
}

Expected<Document> read_robot_file(const std::string& path_or_name) {
  const auto text = read_robot_text(path_or_name);
  return text ? parse_yaml(*text, path_or_name) : tl::unexpected(text.error());
}

Expected<Robot> load(const std::string& path_or_name) {
  const Expected<Document> document = read_robot_file(path_or_name);
  return document ? read_robot(*document) : tl::unexpected(document.error());
}

namespace {

/// What of a leg's place stands in its defaults only becomes the leg's own: maps empty, so that defaults set
/// later still count, and lists as they are.
Expected<void> make_own(Document& robot, const Document& whole, const std::string& path) {
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (path[k] != '.' && path[k] != '[') continue;
    const std::string above = path.substr(0, k);
    const Node* shared = at(whole.root, above);
    if (!shared || at(robot.root, above)) continue;
    Node own = *shared;
    if (own.kind == Node::Kind::map) own.members.clear();
    if (const auto done = set(robot.root, above, std::move(own)); !done) return done;
  }
  return {};
}

}  // namespace

Expected<Document> with(const Document& document, const std::string& path, Node value) {
  Document changed = document;
  const bool of_legs = path.starts_with("legs"), of_sections = path.starts_with("sections[");
  if (is_serial(document) && (of_legs || of_sections)) {
    auto longer = expanded_sections(document);
    if (!longer) return longer;
    changed = std::move(*longer);
  } else if (of_legs || of_sections) {
    auto longer = expanded(document);
    if (!longer) return longer;
    Expected<Document> whole = listed(*longer);
    if (!whole) return whole;
    if (auto there = set(whole->root, path, value); !there) return tl::unexpected(there.error());
    changed = std::move(*longer);
    if (auto done = make_own(changed, *whole, path); !done) return tl::unexpected(done.error());
  }
  // A place of its own, in no file: an error about the value is then named by its path, and told once.
  value.line = -1;
  value.column = static_cast<int>(std::hash<std::string>{}(path)&0x7fffffffU);
  if (const auto done = set(changed.root, path, std::move(value)); !done) return tl::unexpected(done.error());
  if (auto fits = check_size(changed); !fits) return tl::unexpected(fits.error());
  return changed;
}

Expected<Document> with(const Document& document, std::span<const Member> settings) {
  constexpr std::size_t most = 500;  // each copies the document
  if (settings.size() > most)
    return failure("too_large", "set",
                   fmt::format("set has {} values; give at most {} at once, or another robot file.",
                               settings.size(), most));
  Expected<Document> changed = document;
  const auto is_own = [](const Member& setting) {
    return setting.key.starts_with("legs") || setting.key.starts_with("sections[");
  };
  for (const bool of_one : {false, true})
    for (const Member& setting : settings)
      if (changed && is_own(setting) == of_one) changed = with(*changed, setting.key, setting.value);
  return changed;
}

ThetaIs read_theta_is(const Reader& word) {
  return word.choice_of<ThetaIs>({{"tangent", ThetaIs::tangent}, {"chord", ThetaIs::chord}});
}

}  // namespace sinew::inline v1
