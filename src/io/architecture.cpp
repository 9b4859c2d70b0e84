#include "io/architecture.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace sinew::inline v0 {
namespace {

Node placed(Node node, const Node& like) {
  node.line = like.line;
  node.column = like.column;
  return node;
}

Node map_of(const Node& like, std::vector<std::pair<std::string, Node>> members) {
  Node map = placed({}, like);
  map.kind = Node::Kind::map;
  for (auto& [key, value] : members) map.members.push_back({key, like.line, like.column, std::move(value)});
  return map;
}

/// Points on a circle, given by `radius` and either `angle` of the first or all `angles`.
struct Ring {
  double radius;
  std::vector<double> angles;
};

Ring read_ring(Reader& map, int count) {
  Ring ring{map.required("radius").quantity(Dimension::length, Range::size()), {}};
  if (const auto all = map.optional("angles")) {
    ring.angles = all->quantities(Dimension::angle, {}, static_cast<std::size_t>(count));
    if (map.has("angle")) map.fail("ambiguous", "gives both angle and angles; keep one");
  } else {
    const double first =
        map.required("angle", "of the first leg; the others are spaced evenly").quantity(Dimension::angle);
    for (int i = 0; i < count; ++i) ring.angles.push_back(first + i * 2 * std::numbers::pi / count);
  }
  return ring;
}

Node polar(const Ring& ring, std::size_t i, const Node& like) {
  return map_of(like, {{"radius", placed(make_node(ring.radius), like)},
                       {"angle", placed(make_node(ring.angles[i]), like)}});
}

}  // namespace

const Architecture* architecture_of(Reader& robot) {
  std::vector<std::string_view> names;
  for (const Architecture& row : architectures) names.push_back(row.name);
  const Reader name = robot.required("architecture");
  return &architectures[name.choice_index(names)];
}

Node legs_of(const Architecture& architecture, Reader& robot) {
  Reader base = robot.required("base", "where the legs start: {radius, angle}");
  Reader platform = robot.required("platform", "where the legs end: {radius, angle}");
  const Ring feet = read_ring(base, architecture.legs), heads = read_ring(platform, architecture.legs);
  std::optional<double> direction;
  if (const auto given = base.optional("direction")) direction = given->quantity(Dimension::angle);
  base.close();

  Node list;
  list.kind = Node::Kind::list;
  const Node none;
  const Node& foot = base.node() ? *base.node() : none;
  const Node& head = platform.node() ? *platform.node() : none;
  const Node& name = *robot.node()->find("architecture");
  for (std::size_t i = 0; i < static_cast<std::size_t>(architecture.legs); ++i) {
    std::vector<std::pair<std::string, Node>> at{{"point", polar(feet, i, foot)}};
    if (direction)  // that of the first leg; the others are turned with their base points
      at.emplace_back("direction", placed(make_node(*direction + feet.angles[i] - feet.angles[0]), foot));
    list.items.push_back(
        map_of(name, {{"base", map_of(foot, std::move(at))},
                      {"link", map_of(name, {{"type", placed(make_node(architecture.link), name)}})},
                      {"closure", map_of(name, {{"type", placed(make_node(architecture.closure), name)}})},
                      {"platform_point", polar(heads, i, head)}}));
  }
  return list;
}

}  // namespace sinew::inline v0
