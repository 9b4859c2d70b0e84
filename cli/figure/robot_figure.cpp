#include "figure/robot_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "show.hpp"
#include "sinew/math/so3.hpp"

namespace sinew::cli {
namespace {

constexpr std::array<std::vector<double> Series::*, 3> coordinates{&Series::x, &Series::y, &Series::z};
constexpr std::array axis_names{"x", "y", "z"};

/// The curve of a list of points in metres, in mm; of a planar one z is 0.
Series curve(const Node& points, Mark mark, Colour colour, double width, std::string label = {}) {
  Series series{.label = std::move(label), .x = {}, .y = {}, .mark = mark, .colour = colour, .width = width};
  for (const Node& point : points.items)
    for (std::size_t c = 0; c < coordinates.size(); ++c)
      (series.*coordinates[c]).push_back(c < point.items.size() ? 1e3 * point.items[c].number : 0);
  return series;
}

/// The label of the first of many alike.
std::string once(std::size_t i, const char* label) { return i == 0 ? std::string(label) : std::string(); }

/// As Fig. 10 of [TDPCR]: backbones, tendons, platform, joints, and the lines along which the closures pull.
std::vector<Series> drawing(const Answer& shape, const Node& legs) {
  std::vector<Series> all;
  const auto add = [&all](const Node& points, Mark mark, Colour colour, double width,
                          std::string label = {}) {
    all.push_back(curve(points, mark, colour, width, std::move(label)));
  };
  const Node& platform = *shape.find("platform");
  add(platform, platform.items.size() > 2 ? Mark::polygon : Mark::line, Colour::green, 1.5, "platform");
  const auto is = [&](std::size_t i, std::string_view link) {
    return at(legs.items[i], "link.type")->text == link;
  };
  const auto& lines = shape.find("lines")->items;
  std::size_t line = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!is(i, "rod"))  // its tip is on the platform
      add(lines[i], Mark::dashed, Colour::vermillion, 1.5, once(line++, "line of the leg"));
  const auto& tendons = shape.find("tendons")->items;
  for (std::size_t i = 0; i < tendons.size(); ++i)
    for (std::size_t k = 0; k < tendons[i].items.size(); ++k)
      if (!tendons[i].items[k].items.empty())  // rails and rods have none
        add(tendons[i].items[k], Mark::dashed, Colour::grey, 1, once(i + k, "tendon"));
  const auto& backbones = shape.find("backbones")->items;
  std::vector<std::string> named;
  for (std::size_t i = 0; i < backbones.size(); ++i) {
    std::string name = is(i, "rail") ? "rail" : is(i, "rod") ? "rod" : "backbone";
    if (std::ranges::find(named, name) != named.end())
      name.clear();  // in the legend once
    else
      named.push_back(name);
    add(backbones[i], Mark::line, Colour::blue, 3, name);
  }
  add(*shape.find("base"), Mark::circles, Colour::black, 1.5);
  add(platform, Mark::circles, Colour::black, 1.5);
  return all;
}

/// Rim of a disc in the base frame, its proximal face and then its distal one.
Node rim(const Node& disc) {
  const auto p = numbers(at(disc, "pose.position")), q = numbers(at(disc, "pose.quaternion"));
  const SO3<double> turn{q.at(0), Vec3<double>(q.at(1), q.at(2), q.at(3))};
  Node points;
  points.kind = Node::Kind::list;
  constexpr int corners = 24;
  for (const double height : {0.0, number(disc, "height")})
    for (int k = 0; k <= corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners, radius = number(disc, "radius");
      const Vec3<double> corner =
          turn.rotate(Vec3<double>(radius * std::cos(angle), radius * std::sin(angle), height));
      Node point;
      point.kind = Node::Kind::list;
      for (std::size_t i = 0; i < 3; ++i)
        point.items.push_back(make_node(p.at(i) + corner[static_cast<Eigen::Index>(i)]));
      points.items.push_back(std::move(point));
    }
  return points;
}

/// A serial robot: backbone by sections, discs, tendons.
std::vector<Series> serial_drawing(const Answer& shape) {
  std::vector<Series> all;
  const auto& discs = shape.find("discs")->items;
  for (std::size_t i = 0; i < discs.size(); ++i)
    all.push_back(curve(rim(discs[i]), Mark::line, Colour::grey, 0.8, once(i, "disc")));
  const auto& sections = shape.find("tendons")->items;
  for (std::size_t m = 0; m < sections.size(); ++m)
    for (std::size_t i = 0; i < sections[m].items.size(); ++i)
      all.push_back(curve(sections[m].items[i], Mark::line, Colour::vermillion, 0.6, once(m + i, "tendon")));
  const auto& backbones = shape.find("backbones")->items;
  for (std::size_t m = 0; m < backbones.size(); ++m)
    all.push_back(
        curve(backbones[m], Mark::line, m % 2 == 0 ? Colour::blue : Colour::green, 2.5, once(m, "backbone")));
  return all;
}

/// Axes around the drawing: a little larger than it, and none so much narrower than the longest that its
/// numbers would not stand.
std::array<Axis, 3> axes_around(const std::vector<Series>& all) {
  std::array<Axis, 3> axes;
  double longest = 0;
  for (std::size_t c = 0; c < axes.size(); ++c) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Series& series : all)
      for (const double value : series.*coordinates[c])
        low = std::min(low, value), high = std::max(high, value);
    axes[c] = {.label = axis_names[c], .unit = "mm", .low = low, .high = high};
    longest = std::max(longest, high - low);
  }
  for (Axis& axis : axes) {
    const double middle = 0.5 * (*axis.low + *axis.high);
    const double half = std::max({0.53 * (*axis.high - *axis.low), 0.2 * longest, 1e-3});
    axis.low = middle - half;
    axis.high = middle + half;
  }
  return axes;
}

/// One step for all: they have one scale.
void set_step(std::initializer_list<Axis*> axes, double most) {
  double longest = 0;
  for (const Axis* axis : axes) longest = std::max(longest, *axis->high - *axis->low);
  for (Axis* axis : axes) axis->step = round_step(longest, most);
}

/// The drawing as seen along the third axis.
Panel projection(std::vector<Series> all, const std::array<Axis, 3>& axes, std::size_t x, std::size_t y) {
  for (Series& series : all) {
    std::array<std::vector<double>, 3> places{std::move(series.x), std::move(series.y), std::move(series.z)};
    series.x = std::move(places[x]);
    series.y = std::move(places[y]);
    series.z.clear();
  }
  Panel panel{.title = {},
              .x = axes[x],
              .y = axes[y],
              .series = std::move(all),
              .notes = {},
              .legend = Legend::below,
              .equal_aspect = true};
  set_step({&panel.x, &panel.y}, 10);
  return panel;
}

/// The drawing in space; what the base joins is drawn as an area, so that the eye finds the floor.
Panel space(std::vector<Series> all, std::array<Axis, 3> axes, const Answer& shape, const Eye& eye) {
  if (const Node* base = shape.find("base"); base && base->items.size() > 2)
    all.insert(all.begin(), curve(*base, Mark::polygon, Colour::grey, 1, "base"));
  set_step({&axes[0], &axes[1], &axes[2]}, 10);
  return {.title = {},
          .x = axes[0],
          .y = axes[1],
          .series = std::move(all),
          .notes = {},
          .legend = Legend::top_left,
          .z = axes[2],
          .eye = eye};
}

}  // namespace

Figure robot_figure(const Answer& shape, const Robot& robot, const std::optional<Eye>& eye) {
  const auto all = is_serial(robot) ? serial_drawing(shape) : drawing(shape, *robot.description.find("legs"));
  const auto axes = axes_around(all);
  Figure figure;
  figure.title = shape.text("robot");
  figure.width = figure.height = 800;
  if (eye) {
    figure.panels = {space(all, axes, shape, *eye)};
  } else if (is_serial(robot)) {
    figure.panels = {projection(all, axes, 0, 2), projection(all, axes, 1, 2)};
  } else {
    figure.height = 700;
    figure.panels = {projection(all, axes, 0, 1)};
    if (robot.is_spatial) figure.panels.insert(figure.panels.begin(), projection(all, axes, 0, 2));
  }
  figure.columns = static_cast<int>(figure.panels.size());
  if (!eye) figure.width = 700 * figure.columns;
  return figure;
}

}  // namespace sinew::cli
