#include "plan/insertion_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "io/table/posture_table.hpp"
#include "plan/body.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double mm = 1e3, degree = 180 / std::numbers::pi;
constexpr double sharp = 0.9;  ///< cosine between the normals of two triangles whose edge is drawn, at most
constexpr double gap = std::numeric_limits<double>::quiet_NaN();
constexpr double around = 20e-3;  ///< of the robot is shown [m]
constexpr std::array colours{Colour::blue,   Colour::vermillion, Colour::green, Colour::orange,
                             Colour::purple, Colour::sky,        Colour::black};

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double x) { low = std::min(low, x), high = std::max(high, x); }
};

/// A direction to look in, by what lies to the right and upwards.
struct View {
  Vec3<double> right, up;
  std::string right_name, up_name;
  Vec3<double> away() const { return cross(right, up); }
};

std::string axis_name(const Vec3<double>& axis) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(axis[k]) > 1 - 1e-9) return fmt::format("{}{}", axis[k] < 0 ? "-" : "", "xyz"[k]);
  return "";
}

/// Along the stage's axis, and across it, so that the way to the target goes to the right.
std::array<View, 2> views(const InsertionScene& scene) {
  const Vec3<double> way = scene.target.tip - scene.base.p;
  Vec3<double> right(0, 0, 0);
  double most = -1;
  for (int k = 0; k < 3; ++k) {  // the axis of the scene that goes that way best
    Vec3<double> one(0, 0, 0);
    one[k] = 1;
    one = one - dot(one, scene.axis) * scene.axis;
    const double size = std::sqrt(squared_norm(one));
    if (size < 1e-6) continue;
    one = one / size;
    if (std::abs(dot(one, way)) <= most) continue;
    most = std::abs(dot(one, way));
    right = dot(one, way) < 0 ? Vec3<double>(-1.0 * one) : one;
  }
  const Vec3<double> up = cross(scene.axis, right);
  const auto named = [](const Vec3<double>& axis, const char* otherwise) {
    const std::string name = axis_name(axis);
    return name.empty() ? std::string(otherwise) : name;
  };
  return {View{right, up, named(right, "across"), named(up, "across, too")},
          View{right, scene.axis, named(right, "across"), named(scene.axis, "along the stage's axis")}};
}

void append(Series& series, const View& view, const Vec3<double>& point) {
  series.x.push_back(mm * dot(point, view.right));
  series.y.push_back(mm * dot(point, view.up));
}

void interrupt(Series& series) {
  series.x.push_back(gap);
  series.y.push_back(gap);
}

Vec3<double> normal_of(const Mesh& mesh, const std::array<int, 3>& t) {
  const auto at = [&](int k) {
    return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
  };
  const Vec3<double> n = cross(Vec3<double>(at(1) - at(0)), Vec3<double>(at(2) - at(0)));
  return n / std::sqrt(std::max(squared_norm(n), 1e-300));
}

void add_sharp_edges(const Mesh& mesh, const View& view, Series& series) {
  std::map<std::pair<int, int>, Vec3<double>> seen;
  for (const auto& triangle : mesh.triangles) {
    const Vec3<double> normal = normal_of(mesh, triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      const auto [other, is_new] = seen.try_emplace({a, b}, normal);
      if (is_new || dot(other->second, normal) > sharp) continue;
      append(series, view, mesh.vertices[static_cast<std::size_t>(a)]);
      append(series, view, mesh.vertices[static_cast<std::size_t>(b)]);
      interrupt(series);
    }
  }
}

/// Sharp edges of the solids that are within `depth`.
Series edges_of(const InsertionScene& scene, const View& view, const Interval& depth) {
  Series series{"", {}, {}, Mark::line, Colour::grey, 0.7};
  for (const Mesh& mesh : scene.solids) {
    Interval its;
    for (const Vec3<double>& vertex : mesh.vertices) its.add(dot(vertex, view.away()));
    if (its.high >= depth.low && its.low <= depth.high) add_sharp_edges(mesh, view, series);
  }
  return series;
}

/// Both sides of the tube, section after section in two colours.
void add_robot(const InsertionScene& scene, const Body& body, const View& view, Panel& panel) {
  const auto at = [&](std::size_t i) {
    return Vec2<double>(dot(body.point(i), view.right), dot(body.point(i), view.up));
  };
  for (int m = 0; m < scene.robot.section_count(); ++m) {
    Series tube{"", {}, {}, Mark::polygon, m % 2 ? Colour::sky : Colour::blue, 1.2};
    std::vector<Vec2<double>> left, right;
    for (std::size_t i = 0; i + 1 < body.size(); ++i) {
      if (body.section(i + 1) != m) continue;
      const Vec2<double> a = at(i), b = at(i + 1), along = b - a;
      const double size = along.norm();
      // where it comes towards the eye its sides are not seen
      if (size < 0.3 * (body.arc(i + 1) - body.arc(i))) continue;
      const Vec2<double> side = Vec2<double>(-along.y(), along.x()) * (body.radius(i + 1) / size);
      for (const Vec2<double>& end : {a, b}) {
        left.emplace_back(end + side);
        right.emplace_back(end - side);
      }
    }
    left.insert(left.end(), right.rbegin(), right.rend());
    for (const Vec2<double>& corner : left) {
      tube.x.push_back(mm * corner.x());
      tube.y.push_back(mm * corner.y());
    }
    if (!tube.x.empty()) panel.series.push_back(std::move(tube));
  }
}

/// What is shown of a view.
struct Window {
  Interval right, up, depth;
};

Window window_of(const InsertionScene& scene, const View& view, Body& body, const InsertionStep& last) {
  Window window;
  body.place(posture_of(last), false);
  for (std::size_t i = 0; i < body.size(); ++i) {
    // what is still outside at the end is not shown: only the last of the way to the port
    if (dot(Vec3<double>(body.point(i) - body.point(body.size() - 1)), scene.axis) <
        -0.6 * body.arc(body.size() - 1))
      continue;
    window.right.add(dot(body.point(i), view.right));
    window.up.add(dot(body.point(i), view.up));
    window.depth.add(dot(body.point(i), view.away()));
  }
  for (Interval* side : {&window.right, &window.up}) side->low -= around, side->high += around;
  window.depth.low -= around / 2, window.depth.high += around / 2;
  if (std::abs(dot(view.away(), scene.axis)) > 0.5)  // along the axis all is seen that it goes past
    window.depth = {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  return window;
}

Axis axis_of(const std::string& name, const Interval& shown) {
  return {.label = name,
          .unit = "mm",
          .low = mm * shown.low,
          .high = mm * shown.high,
          .step = round_step(mm * (shown.high - shown.low), 5)};
}

std::string provenance(const InsertionScene& scene) {
  return fmt::format("way into {}, robot {}", scene.name.empty() ? "a scene" : scene.name, scene.robot_name);
}

Series over_stage(std::span<const InsertionStep> steps, Text label, Mark mark, Colour colour) {
  Series series{std::move(label), {}, {}, mark, colour};
  for (const InsertionStep& step : steps) series.x.push_back(mm * step.stage);
  return series;
}

}  // namespace

Figure insertion_phases(const InsertionScene& scene, std::span<const InsertionStep> steps,
                        const InsertionCheck& check, int phases) {
  Figure figure{.title = "",
                .panels = {},
                .columns = phases,
                .width = 330.0 * phases,
                .height = 560,
                .comments = {provenance(scene)}};
  if (steps.empty()) return figure;
  Body body(scene, 1e-3);
  for (const View& view : views(scene)) {
    const Window window = window_of(scene, view, body, steps.back());
    const Series edges = edges_of(scene, view, window.depth);
    for (int phase = 1; phase <= phases; ++phase) {
      const std::size_t k =
          (steps.size() - 1) * static_cast<std::size_t>(phase) / static_cast<std::size_t>(phases);
      body.place(posture_of(steps[k]), false);
      Panel panel{.title = "",
                  .x = axis_of(view.right_name, window.right),
                  .y = axis_of(view.up_name, window.up),
                  .series = {edges},
                  .legend = Legend::none,
                  .equal_aspect = true};
      if (figure.panels.size() < static_cast<std::size_t>(phases))
        panel.title = fmt::format("stage {:.0f} mm", mm * steps[k].stage);
      add_robot(scene, body, view, panel);
      Series target{"", {}, {}, Mark::circles, Colour::green, 4};
      append(target, view, scene.target.tip);
      panel.series.push_back(std::move(target));
      if (k < check.steps.size() && check.steps[k].spot.solid >= 0) {
        Series spot{"", {}, {}, Mark::points, Colour::vermillion, 3};
        append(spot, view, check.steps[k].spot.on_solid);
        panel.series.push_back(std::move(spot));
      }
      figure.panels.push_back(std::move(panel));
    }
  }
  figure.remark = "green: target; red: where robot and solids are nearest";
  return figure;
}

Figure insertion_curves(const InsertionScene& scene, std::span<const InsertionStep> steps,
                        const InsertionCheck& check) {
  Figure figure{
      .title = "", .panels = {}, .columns = 1, .width = 800, .height = 900, .comments = {provenance(scene)}};
  Interval stages_of;
  for (const InsertionStep& step : steps) stages_of.add(step.stage);
  Axis stages{.label = "stage", .unit = "mm"};
  if (stages_of.high > stages_of.low) stages.low = mm * stages_of.low, stages.high = mm * stages_of.high;
  Panel clearance{.title = "",
                  .x = stages,
                  .y = {.label = "clearance", .unit = "mm", .low = 0},
                  .series = {},
                  .legend = Legend::below};
  Series is = over_stage(steps, "robot to solids", Mark::line, Colour::blue);
  for (const CheckedStep& step : check.steps) is.y.push_back(mm * step.spot.distance);
  is.x.resize(is.y.size());
  Series asked = over_stage(steps, "asked for", Mark::dashed, Colour::vermillion);
  asked.y.assign(asked.x.size(), mm * scene.clearance);
  clearance.series = {std::move(is), std::move(asked)};
  figure.panels.push_back(std::move(clearance));
  for (int c = 0; c < 2; ++c) {
    const bool is_twin = scene.robot.sections.front().is_twin();
    Panel bends{
        .title = "",
        .x = stages,
        .y = {.label = is_twin ? (c == 0 ? "β₁ a joint" : "β₂ a joint") : (c == 0 ? "θ cos φ" : "θ sin φ"),
              .unit = "deg"},
        .series = {},
        .legend = c == 1 ? Legend::below : Legend::none};
    for (std::size_t m = 0; m < scene.robot.sections.size(); ++m) {
      Series one = over_stage(steps, fmt::format("section {}", m), Mark::line, colours[m % colours.size()]);
      for (const InsertionStep& step : steps) one.y.push_back(degree * step.bends[m][c]);
      bends.series.push_back(std::move(one));
    }
    figure.panels.push_back(std::move(bends));
  }
  return figure;
}

}  // namespace sinew::inline v1
