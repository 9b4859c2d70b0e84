/// Named architectures: the short form of a robot file, written out as the list of legs it stands for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

#include "io/document/parse.hpp"
#include "io/document/reader.hpp"
#include "robot/catalog.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::inline v1 {
namespace {

Node map_of(const Node& like, std::vector<std::pair<std::string, Node>> members) {
  Node map = placed({}, like);
  map.kind = Node::Kind::map;
  for (auto& [key, value] : members) map.members.push_back({key, like.line, like.column, std::move(value)});
  return map;
}

void erase(Node& map, std::string_view key) {
  std::erase_if(map.members, [&](const Member& member) { return member.key == key; });
}

/// Whether base tangents of these legs have a direction of their own, which the file must give.
template <class... Legs>
bool is_clamped(const Architecture& architecture, TypeList<Legs...>) {
  return ((Legs::Link::name == architecture.link && Legs::Closure::name == architecture.closure &&
           Legs::is_clamped) ||
          ...);
}

/// Whether these legs run on rails, which have a direction and a hinge.
template <class... Legs>
bool are_on_rails(const Architecture& architecture, TypeList<Legs...>) {
  return ((Legs::Link::name == architecture.link && HasSlide<typename Legs::Link>) || ...);
}

/// Turns the short form into legs. Every error is noted by the readers of the file.
class Expansion {
 public:
  Expansion(const Architecture& architecture, Reader& robot)
      : architecture_(&architecture),
        count_(static_cast<std::size_t>(architecture.legs)),
        robot_(&robot),
        is_on_rails_(are_on_rails(architecture, SpatialLegs{})) {}

  Node legs() {
    Reader base = robot_->required("base", "where the legs start: {radius, angle}");
    Reader platform = robot_->required("platform", "where the legs end: {radius, angle}");
    platform.has("home");
    const Places feet = places(base, "base"), heads = places(platform, "platform");
    const std::vector<double> directions = base_directions(base, feet);
    const std::vector<double> axes = is_on_rails_   ? hinge_axes(base, feet)
                                     : is_spatial() ? turns(base, "first_axis", "first_axes", feet)
                                                    : std::vector<double>();
    base.close();
    platform.close();

    const Node none;
    const Node& foot = base.node() ? *base.node() : none;
    const Node& name = *robot_->node()->find("architecture");
    const auto text = [&](std::string_view word) { return placed(make_node(word), name); };
    Node list = placed({}, name);
    list.kind = Node::Kind::list;
    for (std::size_t i = 0; i < count_; ++i) {
      std::vector<std::pair<std::string, Node>> at{{"point", feet.points[i]}};
      if (!directions.empty()) at.emplace_back("direction", placed(make_node(directions[i]), foot));
      if (!axes.empty())
        at.emplace_back(is_on_rails_ ? "hinge_axis" : "first_axis", placed(make_node(axes[i]), foot));
      list.items.push_back(map_of(name, {{"base", map_of(foot, std::move(at))},
                                         {"link", map_of(name, {{"type", text(architecture_->link)}})},
                                         {"closure", map_of(name, {{"type", text(architecture_->closure)}})},
                                         {"platform_point", heads.points[i]}}));
    }
    return list;
  }

 private:
  /// A point a leg, and where each lies as seen from the middle [rad].
  struct Places {
    std::vector<Node> points;
    std::vector<double> azimuths;
  };

  bool is_spatial() const { return architecture_->space == "spatial"; }
  bool is_in_pairs() const { return is_spatial() && !is_on_rails_; }

  std::vector<Reader> one_a_leg(const Reader& list, std::string_view what) const {
    auto items = list.items();
    if (list.is(Node::Kind::list) && items.size() != count_)
      list.fail("wrong_length", fmt::format("{} needs {} {}, found {}; give one for each leg.",
                                            architecture_->name, count_, what, items.size()));
    return items;
  }

  std::vector<double> angles_in(const Reader& list, std::string_view what) const {
    std::vector<double> angles;
    for (const Reader& item : one_a_leg(list, what)) angles.push_back(item.quantity(Dimension::angle));
    angles.resize(count_);
    return angles;
  }

  Places places(Reader& map, std::string_view where) const {
    if (const auto points = map.optional("points")) return listed(map, *points, where);
    return ring(map, where);
  }

  Places listed(Reader& map, const Reader& points, std::string_view where) const {
    if (where == "platform") map.has("radius");  // no circle here: it makes moments comparable with forces
    for (const std::string_view key : {"radius", "angle", "angles", "spread", "height"})
      if ((key != "radius" || where == "base") && map.has(key))
        map.fail("ambiguous", fmt::format("gives both points and {}; keep one", key));
    Places result;
    for (const Reader& point : one_a_leg(points, fmt::format("{} points", where))) {
      result.points.push_back(*point.node());
      result.azimuths.push_back(azimuth(point.over(*point.node())));
    }
    result.points.resize(count_);
    result.azimuths.resize(count_);
    return result;
  }

  /// Of a point as written; the reader of the legs tells whether it is one.
  static double azimuth(Reader point) {
    if (point.is(Node::Kind::map)) {
      const auto angle = point.optional("angle");
      return angle ? angle->quantity(Dimension::angle) : 0;
    }
    const auto parts = point.items();
    if (parts.size() < 2) return 0;
    return std::atan2(parts[1].quantity(Dimension::length), parts[0].quantity(Dimension::length));
  }

  /// Points on a circle: `radius`, and `angles` of all legs or `angle` of the first; or, of legs in pairs,
  /// `angle` of the middle of the first pair and the `spread` of its legs to either side.
  Places ring(Reader& map, std::string_view where) const {
    const double radius = map.required("radius").quantity(Dimension::length, Range::size());
    const auto height = is_spatial() ? map.optional("height") : std::nullopt;
    Places result;
    if (const auto all = map.optional("angles")) {
      result.azimuths = angles_in(*all, fmt::format("{} angles", where));
      for (const std::string_view key : {"angle", "spread"})
        if (map.has(key)) map.fail("ambiguous", fmt::format("gives both angles and {}; keep one", key));
    } else {
      result.azimuths = spaced(map);
    }
    const Node& like = map.node() ? *map.node() : *robot_->node();
    for (const double angle : result.azimuths) {
      result.points.push_back(map_of(
          like, {{"radius", placed(make_node(radius), like)}, {"angle", placed(make_node(angle), like)}}));
      if (height) result.points.back().members.push_back({"height", like.line, like.column, *height->node()});
    }
    return result;
  }

  std::vector<double> spaced(Reader& map) const {
    const bool in_pairs = is_in_pairs();
    const double first =
        map.required("angle", in_pairs
                                  ? "of the middle of the first pair of legs; the others are spaced evenly"
                                  : "of the first leg; the others are spaced evenly")
            .quantity(Dimension::angle);
    const double spread =
        in_pairs ? map.required("spread", "angle from the middle of a pair of legs to either of them")
                       .quantity(Dimension::angle)
                 : 0;
    const std::size_t size = in_pairs ? 2 : 1;
    std::vector<double> angles;
    for (std::size_t i = 0; i < count_; ++i) {
      const auto group = static_cast<double>(i / size), groups = static_cast<double>(count_ / size);
      angles.push_back(first + group * 2 * std::numbers::pi / groups + (i % size == 0 ? -spread : spread));
    }
    return angles;
  }

  /// Of upright rails, hinges along the circle of the base unless the file turns them.
  std::vector<double> hinge_axes(Reader& base, const Places& feet) const {
    Places beside = feet;
    for (double& angle : beside.azimuths) angle -= std::numbers::pi / 2;
    return turns(base, "hinge_axis", "hinge_axes", beside);
  }

  std::vector<double> base_directions(Reader& base, const Places& feet) const {
    if (is_clamped(*architecture_, PlanarLegs{})) {
      if (!base.has("direction") && !base.has("directions"))
        base.required("direction",
                      "angle of the first leg's backbone at its base; the others turn with their "
                      "base points");
      return turns(base, "direction", "directions", feet);
    }
    for (const std::string_view key : {"direction", "directions"})
      if (base.has(key))
        base.fail(
            "no_effect",
            is_on_rails_
                ? fmt::format("{} has no effect: the rails of a short form stand upright; list the legs", key)
                : fmt::format("{} has no effect: the legs of a {} turn at their base; remove it", key,
                              architecture_->name));
    return {};
  }

  /// Angles of all legs [rad] under `all`, or under `first` that of the first leg, with which the others turn
  /// as their base points do; else those of the base points.
  std::vector<double> turns(Reader& base, std::string_view first, std::string_view all,
                            const Places& feet) const {
    if (const auto list = base.optional(all)) {
      if (base.has(first)) base.fail("ambiguous", fmt::format("gives both {} and {}; keep one", first, all));
      return angles_in(*list, fmt::format("{} of the base", all));
    }
    std::vector<double> angles = feet.azimuths;
    if (const auto given = base.optional(first)) {
      const double turn = given->quantity(Dimension::angle) - angles[0];
      for (double& angle : angles) angle += turn;
    }
    return angles;
  }

  const Architecture* architecture_;
  std::size_t count_;
  Reader* robot_;
  bool is_on_rails_;
};

const Architecture& architecture_of(Reader& robot) {
  std::vector<std::string_view> names;
  for (const Architecture& row : architectures) names.push_back(row.name);
  return architectures[robot.required("architecture").choice_index(names)];
}

/// `legs` beside an architecture is refused, a contradicting `space` too.
void check_beside(const Architecture& architecture, Reader& robot) {
  if (const auto legs = robot.optional("legs")) {
    const std::size_t found = legs->is(Node::Kind::list) ? legs->items().size() : 0;
    const bool differs = found != static_cast<std::size_t>(architecture.legs);
    legs->fail("ambiguous", fmt::format("the file gives an architecture and legs; keep one.{}",
                                        differs ? fmt::format(" A {} has {} legs, these are {}.",
                                                              architecture.name, architecture.legs, found)
                                                : ""));
  }
  if (const auto space = robot.optional("space"))
    if (space->choice({"planar", "spatial"}) != architecture.space)
      space->refuse("ambiguous", fmt::format("a {} is {}; remove space, or choose another architecture.",
                                             architecture.name, architecture.space));
}

}  // namespace

Expected<Document> expanded(const Document& document) {
  const Node* name = document.root.find("architecture");
  if (!name) return document;
  Errors errors;
  Reader robot(document, errors);
  const Architecture& architecture = architecture_of(robot);
  if (!errors.empty()) return tl::unexpected(errors);
  check_beside(architecture, robot);
  if (!errors.empty()) return tl::unexpected(errors);
  Node legs = Expansion(architecture, robot).legs();
  if (!errors.empty()) return tl::unexpected(errors);

  Document longer = document;
  for (const std::string_view key : {"architecture", "base", "legs", "space"}) erase(longer.root, key);
  if (Node* platform = longer.root.find("platform"))
    for (const std::string_view key : {"angle", "angles", "spread", "height", "points"})
      erase(*platform, key);
  const auto add = [&](const char* key, Node value) {
    longer.root.members.push_back({key, name->line, name->column, std::move(value)});
  };
  add("space", placed(make_node(architecture.space), *name));
  add("legs", std::move(legs));
  return longer;
}

}  // namespace sinew::inline v1
