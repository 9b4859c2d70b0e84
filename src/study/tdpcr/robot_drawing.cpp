#include "study/tdpcr/robot_drawing.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

namespace sinew::inline v1::drawing {

namespace {

constexpr double mm = 1e3;
constexpr double thin = 1.2;

Point turned(const Point& vector, double degrees) {
  const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
  return {c * vector.x() - s * vector.y(), s * vector.x() + c * vector.y()};
}

/// A letter with a small number behind.
std::string numbered(char letter, std::size_t i) {
  constexpr std::string_view zero = "₀";  // the ten digits follow each other in the last byte
  std::string digits = std::to_string(i), name(1, letter);
  for (const char digit : digits) {
    name += zero.substr(0, zero.size() - 1);
    name += static_cast<char>(zero.back() + (digit - '0'));
  }
  return name;
}

}  // namespace

Point at_angle(double radius, double degrees) { return turned(Point(radius, 0), degrees); }

Series curve(std::string label, const Polyline& points, Mark mark, Colour colour, double width) {
  Series series{.label = std::move(label), .x = {}, .y = {}, .mark = mark, .colour = colour, .width = width};
  for (const Point& point : points) {
    series.x.push_back(mm * point.x());
    series.y.push_back(mm * point.y());
  }
  return series;
}

Note text(std::string words, const Point& at, Note::Side side, Colour colour) {
  return {std::move(words), mm * at.x(), mm * at.y(), side, colour};
}

Polyline circle(const Point& centre, double radius) {
  Polyline points;
  for (int degrees = 0; degrees <= 360; degrees += 2) points.push_back(centre + at_angle(radius, degrees));
  return points;
}

Panel plane(std::string title, const Point& low, const Point& high, double step) {
  const auto axis = [&](const char* label, double from, double to) {
    return Axis{.label = label, .unit = "mm", .low = mm * from, .high = mm * to, .step = mm * step};
  };
  return {.title = std::move(title),
          .x = axis("x", low.x(), high.x()),
          .y = axis("y", low.y(), high.y()),
          .series = {},
          .notes = {},
          .legend = Legend::none,
          .equal_aspect = true};
}

void add_arrow(Panel& panel, const Point& from, const Point& to, double head) {
  const Point back = -head * (to - from).normalized();
  panel.series.push_back(curve("", {from, to}, Mark::line, Colour::black, thin));
  panel.series.push_back(
      curve("", {to + turned(back, 18), to, to + turned(back, -18)}, Mark::line, Colour::black, thin));
}

void add_leader(Panel& panel, const Point& named, const Point& words) {
  panel.series.push_back(curve("", {named, words}, Mark::line, Colour::black, 0.8));
  panel.series.push_back(curve("", {named}, Mark::points, Colour::black, 1.2));
}

void add_base(Panel& panel, const PlanarShape& robot, std::string label) {
  panel.series.push_back(curve(std::move(label), robot.base, Mark::outline, Colour::grey, 1.5));
}

void add_platform(Panel& panel, const PlanarShape& robot, std::string label) {
  panel.series.push_back(curve(std::move(label), robot.platform, Mark::polygon, Colour::green, 2));
}

void add_joints(Panel& panel, const PlanarShape& robot, std::string label) {
  panel.series.push_back(curve("", robot.base, Mark::circles, Colour::black, 1.5));
  panel.series.push_back(curve(std::move(label), robot.platform, Mark::circles, Colour::black, 1.5));
}

void add_base_names(Panel& panel, const PlanarShape& robot, double distance) {
  for (std::size_t i = 0; i < robot.base.size(); ++i)
    panel.notes.push_back(text(numbered('A', i + 1), robot.base[i] + distance * robot.base[i].normalized()));
}

void add_platform_names(Panel& panel, const PlanarShape& robot, const Point& centre, double distance,
                        double turn) {
  for (std::size_t i = 0; i < robot.platform.size(); ++i) {
    const Point direction = turned((robot.platform[i] - centre).normalized(), turn);
    panel.notes.push_back(text(numbered('B', i + 1), robot.platform[i] + distance * direction));
  }
}

}  // namespace sinew::inline v1::drawing
