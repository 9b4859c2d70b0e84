#include "figure/diagram_figure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sinew::cli {
namespace {

constexpr double degree = std::numbers::pi / 180;

Series points_of(const Node* points, Mark mark, Colour colour, double width, std::string label) {
  Series series{.label = std::move(label), .x = {}, .y = {}, .mark = mark, .colour = colour, .width = width};
  if (points)
    for (const Node& point : points->items) {
      series.x.push_back(point.items[0].number / degree);
      series.y.push_back(point.items[1].number / degree);
    }
  return series;
}

/// Edge of the bends a section is allowed; of an actuator's travel its polygon is the boundary's own
/// business.
Series envelope_of(const Answer& answer, double limit) {
  Series edge{
      .label = "limit", .x = {}, .y = {}, .mark = Mark::outline, .colour = Colour::black, .width = 1.5};
  const bool is_square = answer.text("envelope.kind") == "square";
  const int corners = is_square ? 4 : 180;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / corners,
                 radius = is_square ? limit * std::sqrt(2.0) : limit;
    edge.x.push_back(radius * std::cos(angle));
    edge.y.push_back(radius * std::sin(angle));
  }
  return edge;
}

/// Where a tendon is taut: a line, or the points of a curve.
Series frontier(const Node& node, double reach, std::string label) {
  if (const Node* curve = node.find("curve"))
    return points_of(curve, Mark::line, Colour::vermillion, 1.2, std::move(label));
  const auto normal = numbers(node.find("normal"));
  const double offset = number(node, "offset") / degree;
  Series line{.label = std::move(label),
              .x = {},
              .y = {},
              .mark = Mark::line,
              .colour = Colour::vermillion,
              .width = 1.2};
  constexpr int steps = 400;  // what is outside the panel is left out: a frontier has no ends
  for (int k = -steps; k <= steps; ++k) {
    const double along = 3 * reach * k / steps;
    const double x = normal.at(0) * offset - normal.at(1) * along,
                 y = normal.at(1) * offset + normal.at(0) * along;
    const bool is_inside = std::abs(x) <= reach && std::abs(y) <= reach;
    line.x.push_back(is_inside ? x : std::nan(""));
    line.y.push_back(is_inside ? y : std::nan(""));
  }
  return line;
}

}  // namespace

std::size_t section_of(const Arguments& arguments) {
  const std::string* text = arguments.text("section");
  return text ? static_cast<std::size_t>(std::strtoul(text->c_str(), nullptr, 10)) : 0;
}

Figure diagram_figure(const Answer& answer, const OpenRobot& robot, std::size_t section) {
  const bool is_travel = answer.text("envelope.kind") == "actuator";
  double limit = is_travel ? 0 : number(*answer.find("envelope"), "limit") / degree;
  for (const char* key : {"boundary", "polygon"})
    if (const Node* points = answer.find(key); points && is_travel)
      for (const Node& point : points->items)
        for (const Node& part : point.items) limit = std::max(limit, std::abs(part.number / degree));
  const double reach = 1.25 * std::max(limit, 1e-3);
  const bool is_twin = robot.description.text(fmt::format("sections[{}].type", section)) == "tpcj";
  Panel panel{
      .title = answer.text("class"),
      .x = {.label = formula(is_twin ? "β_1" : "θ cos φ"), .unit = "deg", .low = -reach, .high = reach},
      .y = {.label = formula(is_twin ? "β_2" : "θ sin φ"), .unit = "deg", .low = -reach, .high = reach},
      .series = {},
      .legend = Legend::below,
      .equal_aspect = true};
  const Node* boundary = answer.find("boundary");
  if (boundary && boundary->items.size() > 2)
    panel.series.push_back(points_of(boundary, Mark::polygon, Colour::green, 1.5, "free"));
  if (!is_travel) panel.series.push_back(envelope_of(answer, limit));
  const auto& frontiers = answer.find("frontiers")->items;
  for (std::size_t i = 0; i < frontiers.size(); ++i)
    panel.series.push_back(frontier(frontiers[i], reach, i == 0 ? "tendon taut" : ""));
  if (const Node* outline = answer.find("outline"))
    panel.series.push_back(points_of(outline, Mark::outline, Colour::purple, 1.2, "with earlier sections"));
  Node point;
  point.kind = Node::Kind::list;
  point.items.push_back(*answer.find("point"));
  panel.series.push_back(points_of(&point, Mark::points, Colour::blue, 6, "meets the tendons best"));
  Figure figure;
  figure.title = fmt::format("{}, section {}", answer.text("robot"), section);
  figure.panels = {std::move(panel)};
  figure.width = figure.height = 700;
  return figure;
}

}  // namespace sinew::cli
