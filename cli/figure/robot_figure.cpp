#include "figure/robot_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "show.hpp"
#include "sinew/math/se3.hpp"

namespace sinew::cli {
namespace {

constexpr std::array<std::vector<double> Series::*, 3> coordinates{&Series::x, &Series::y, &Series::z};
const std::array axis_names{formula("x"), formula("y"), formula("z")};

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

/// As Fig. 10 of [TDPCR]: backbones, tendons, platform, joints, struts, and of legs without one the lines
/// along which the closures pull.
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
  const auto has_strut = [&](std::size_t i) {
    const Node* closure = at(legs.items[i], "closure.type");
    return closure && closure->text.ends_with("strut");
  };
  const auto& lines = shape.find("lines")->items;
  std::size_t line = 0, strut = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!is(i, "rod") && !has_strut(i))  // a rod's tip is on the platform
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
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (has_strut(i)) add(lines[i], Mark::line, Colour::vermillion, 3, once(strut++, "strut"));
  add(*shape.find("base"), Mark::circles, Colour::black, 1.5);
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (has_strut(i)) {  // the joint between link and strut
      Node joint;
      joint.kind = Node::Kind::list;
      joint.items = {lines[i].items.front()};
      add(joint, Mark::circles, Colour::black, 1.5);
    }
  add(platform, Mark::circles, Colour::black, 1.5);
  return all;
}

/// Rim of a disc in the base frame, its proximal face and then its distal one.
Node rim(const Node& disc, double radius) {
  const auto p = numbers(at(disc, "pose.position")), q = numbers(at(disc, "pose.quaternion"));
  const SO3<double> turn{q.at(0), Vec3<double>(q.at(1), q.at(2), q.at(3))};
  Node points;
  points.kind = Node::Kind::list;
  constexpr int corners = 24;
  for (const double height : {0.0, number(disc, "height")})
    for (int k = 0; k <= corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners;
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
    all.push_back(
        curve(rim(discs[i], number(discs[i], "radius")), Mark::line, Colour::grey, 0.8, once(i, "disc")));
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

/// Points along a curve so dense that they look like it, which one series can colour.
void add_dense(Series& to, const Series& from, double shade) {
  constexpr double step = 0.8;  // [mm]
  for (std::size_t k = 0; k + 1 < from.x.size(); ++k) {
    const double length =
        std::hypot(from.x[k + 1] - from.x[k], from.y[k + 1] - from.y[k], from.z[k + 1] - from.z[k]);
    const int count = std::clamp(static_cast<int>(length / step), 1, 400);
    for (int j = 0; j <= count; ++j) {
      for (const auto coordinate : coordinates)
        (to.*coordinate)
            .push_back(std::lerp((from.*coordinate)[k], (from.*coordinate)[k + 1], double(j) / count));
      to.shades.push_back(shade);
    }
  }
}

/// An arm: discs, its tendons in the colours of their tensions, those that are slack dashed, its backbone.
std::vector<Series> arm_drawing(const Answer& shape) {
  std::vector<Series> all;
  const Node* const told = shape.find("discs");  // none in the plane
  const std::vector<Node> discs = told ? told->items : std::vector<Node>();
  const auto& tendons = shape.find("tendons")->items;
  double around = 0;  // tendons run within the discs
  for (const Node& section : tendons)
    for (const Node& tendon : section.items) {
      const auto start = numbers(&tendon.items.front());
      around = std::max(around, 1.15 * std::hypot(start[0], start[1]));
    }
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const double radius = number(discs[i], "radius");
    all.push_back(
        curve(rim(discs[i], radius > 0 ? radius : around), Mark::line, Colour::grey, 0.8, once(i, "disc")));
  }
  Series taut{.label = {}, .x = {}, .y = {}, .mark = Mark::points, .width = 2};
  const Node* tensions = shape.find("tensions");
  std::size_t slack = 0;
  for (std::size_t m = 0; m < tendons.size(); ++m)
    for (std::size_t i = 0; i < tendons[m].items.size(); ++i) {
      Series line = curve(tendons[m].items[i], Mark::dashed, Colour::grey, 1);
      const double tension = tensions ? tensions->items[m].items[i].number : 0;
      if (tension > 0)
        add_dense(taut, line, tension);
      else
        line.label = once(slack++, "tendon, 0 N"), all.push_back(std::move(line));
    }
  const auto& backbones = shape.find("backbones")->items;
  for (std::size_t m = 0; m < backbones.size(); ++m)
    all.push_back(curve(backbones[m], Mark::line, Colour::blue, 2.5, once(m, "backbone")));
  if (!taut.x.empty()) all.push_back(std::move(taut));
  return all;
}

/// A platform on arms: a line through their tips.
Series tips_drawing(const Answer& shape) {
  Node outline;
  outline.kind = Node::Kind::list;
  for (const Node& backbone : shape.find("backbones")->items) outline.items.push_back(backbone.items.back());
  outline.items.push_back(outline.items.front());
  return curve(outline, Mark::line, Colour::black, 2, "platform");
}

/// Of the colours of taut tendons, where there are any.
std::optional<ColourScale> tension_scale(const Panel& panel) {
  for (const Series& series : panel.series)
    if (!series.shades.empty())
      return ColourScale{.label = "tension (N)", .low = 0, .high = *std::ranges::max_element(series.shades)};
  return {};
}

/// How much an arm bends and twists along itself.
Panel curvature_panel(const Answer& shape) {
  constexpr std::array names{"about x", "about y", "torsion"};
  constexpr std::array colours{Colour::vermillion, Colour::green, Colour::black};
  Panel panel{.title = "curvature of the backbone, in its axes",
              .x = {.label = "from the base along the arm", .unit = "mm"},
              .y = {.label = "curvature", .unit = "1/m"},
              .series = {},
              .legend = Legend::below};
  const auto places = numbers(shape.find("places"));
  for (std::size_t c = 0; c < names.size(); ++c) {
    Series series{.label = names[c], .x = {}, .y = {}, .colour = colours[c]};
    for (std::size_t k = 0; k < places.size(); ++k) {
      series.x.push_back(1e3 * places[k]);
      series.y.push_back(shape.find("curvatures")->items[k].items[c].number);
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// Axes around the drawing: larger than it, so that the numbers of its legs have room, and none so much
/// narrower than the longest that its numbers would not stand.
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
    const double half = std::max({0.5 * (*axis.high - *axis.low) + 0.08 * longest, 0.2 * longest, 1e-3});
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

/// Where the legs begin, in mm, in their order; a serial robot has none.
std::vector<std::array<double, 3>> feet(const Answer& shape) {
  std::vector<std::array<double, 3>> all;
  const Node* base = shape.find("base");
  if (!base) return all;
  for (const Node& point : base->items) {
    std::array<double, 3> foot{};
    for (std::size_t c = 0; c < std::min(foot.size(), point.items.size()); ++c)
      foot[c] = 1e3 * point.items[c].number;
    all.push_back(foot);
  }
  return all;
}

/// How far something leaves a point of the picture in a direction.
struct Direction {
  double across, up;
};

/// The numbers of the legs where these begin, `1` is `legs[0]`: on the side that the curves leave free. Legs
/// that begin at one place of the picture have one text.
/// @param places of the picture, in units of which `reach` are as far as a number needs
void number_legs(Panel& panel, const std::vector<std::array<double, 3>>& at,
                 const std::vector<std::array<double, 2>>& places,
                 const std::vector<std::vector<std::array<double, 2>>>& curves, double reach) {
  constexpr std::array sides{
      std::pair{Note::Side::below, Direction{0, -1}}, std::pair{Note::Side::left, Direction{-1, 0}},
      std::pair{Note::Side::right, Direction{1, 0}}, std::pair{Note::Side::above, Direction{0, 1}}};
  std::vector<char> is_done(at.size(), 0);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (is_done[i]) continue;
    std::string text;
    for (std::size_t k = i; k < at.size(); ++k)
      if (std::hypot(places[k][0] - places[i][0], places[k][1] - places[i][1]) < 0.6 * reach) {
        is_done[k] = 1;
        text += fmt::format("{}{}", text.empty() ? "" : ", ", k + 1);
      }
    double best = -1;
    Note note{.text = text, .x = at[i][0], .y = at[i][1], .z = at[i][2]};
    for (const auto& [side, direction] : sides) {
      const double longer =
          0.5 * reach * static_cast<double>(text.size() - 1) * (direction.across != 0 ? 0.5 : 0);
      const std::array<double, 2> middle{places[i][0] + direction.across * (reach + longer),
                                         places[i][1] + direction.up * reach};
      double free = 2 * reach;  // more is no better
      for (const auto& curve : curves)
        for (const auto& point : curve)
          free = std::min(free, std::hypot(point[0] - middle[0], point[1] - middle[1]));
      if (free > best * 1.001) best = free, note.side = side;
    }
    panel.notes.push_back(std::move(note));
  }
}

/// Points along a curve so near each other that a text between them would be met.
std::vector<std::array<double, 2>> along(const std::vector<std::array<double, 2>>& corners, double step) {
  std::vector<std::array<double, 2>> all;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const double length = std::hypot(corners[k + 1][0] - corners[k][0], corners[k + 1][1] - corners[k][1]);
    const int count = std::clamp(static_cast<int>(length / step), 1, 200);
    for (int j = 0; j < count; ++j)
      all.push_back({std::lerp(corners[k][0], corners[k + 1][0], double(j) / count),
                     std::lerp(corners[k][1], corners[k + 1][1], double(j) / count)});
  }
  if (!corners.empty()) all.push_back(corners.back());
  return all;
}

/// The drawing as seen along the third axis.
Panel projection(std::vector<Series> all, const std::array<Axis, 3>& axes, std::size_t x, std::size_t y,
                 const std::vector<std::array<double, 3>>& starts) {
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
  const double extent = std::max(*panel.x.high - *panel.x.low, *panel.y.high - *panel.y.low);
  const double reach = 0.035 * extent;
  std::vector<std::vector<std::array<double, 2>>> curves;
  for (const Series& series : panel.series) {
    std::vector<std::array<double, 2>> corners;
    for (std::size_t k = 0; k < series.x.size(); ++k) corners.push_back({series.x[k], series.y[k]});
    if (series.mark == Mark::circles)
      curves.push_back(std::move(corners));
    else
      curves.push_back(along(corners, 0.3 * reach));
  }
  std::vector<std::array<double, 3>> places;
  std::vector<std::array<double, 2>> flat;
  for (const auto& start : starts) {
    places.push_back({start[x], start[y], 0});
    flat.push_back({start[x], start[y]});
  }
  number_legs(panel, places, flat, curves, reach);
  set_step({&panel.x, &panel.y}, 8);
  return panel;
}

/// The drawing in space; what the base joins is drawn as an area, so that the eye finds the floor.
Panel space(std::vector<Series> all, std::array<Axis, 3> axes, const Answer& shape, const Eye& eye) {
  if (const Node* base = shape.find("base"); base && base->items.size() > 2)
    all.insert(all.begin(), curve(*base, Mark::polygon, Colour::grey, 1, "base"));
  set_step({&axes[0], &axes[1], &axes[2]}, 10);
  Panel panel{.title = {},
              .x = axes[0],
              .y = axes[1],
              .series = std::move(all),
              .notes = {},
              .legend = Legend::below,
              .z = axes[2],
              .eye = eye};
  const double tilt = eye.tilt * std::numbers::pi / 180, turn = eye.turn * std::numbers::pi / 180;
  const auto seen = [&](double x, double y, double z) {
    const double back = -x * std::sin(turn) + y * std::cos(turn);
    return std::array{x * std::cos(turn) + y * std::sin(turn), back * std::cos(tilt) + z * std::sin(tilt)};
  };
  double extent = 0;
  for (const Axis& axis : axes) extent = std::max(extent, *axis.high - *axis.low);
  const double reach = 0.03 * extent;
  std::vector<std::vector<std::array<double, 2>>> curves;
  for (const Series& series : panel.series) {
    std::vector<std::array<double, 2>> corners;
    for (std::size_t k = 0; k < series.x.size(); ++k)
      corners.push_back(seen(series.x[k], series.y[k], series.z[k]));
    if (series.mark == Mark::circles)
      curves.push_back(std::move(corners));
    else
      curves.push_back(along(corners, 0.3 * reach));
  }
  const auto starts = feet(shape);
  std::vector<std::array<double, 2>> flat;
  for (const auto& start : starts) flat.push_back(seen(start[0], start[1], start[2]));
  number_legs(panel, starts, flat, curves, reach);
  return panel;
}

}  // namespace

Figure robot_figure(const Answer& shape, const OpenRobot& robot, const std::optional<Eye>& eye) {
  const bool on_arms = stands_on_arms(robot),
             is_row = is_serial(robot) || is_arm(robot) || (on_arms && robot.is_spatial);
  auto all = is_arm(robot) || on_arms ? arm_drawing(shape)
             : is_serial(robot)       ? serial_drawing(shape)
                                      : drawing(shape, *robot.description.find("legs"));
  if (on_arms) all.push_back(tips_drawing(shape));
  const auto axes = axes_around(all);
  Figure figure;
  figure.title = shape.text("robot");
  figure.width = figure.height = 800;
  if (eye) {
    figure.panels = {space(all, axes, shape, *eye)};
  } else if (is_row) {
    figure.panels = {projection(all, axes, 0, 2, {}), projection(all, axes, 1, 2, {})};
  } else {
    figure.height = 700;
    const auto starts = feet(shape);
    figure.panels = {projection(all, axes, 0, 1, starts)};
    if (robot.is_spatial) figure.panels.insert(figure.panels.begin(), projection(all, axes, 0, 2, starts));
  }
  if (is_arm(robot) || on_arms) {
    for (Panel& panel : figure.panels)
      if (const auto scale = tension_scale(panel)) panel.scale = scale;
    if (!eye && !on_arms) figure.panels.push_back(curvature_panel(shape));
  }
  figure.columns = static_cast<int>(figure.panels.size());
  if (!eye) figure.width = 700 * figure.columns;
  return figure;
}

}  // namespace sinew::cli
