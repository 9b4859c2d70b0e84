#include "plan/compressor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "io/document/quantity.hpp"
#include "plan/draw.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int camber_steps = 24, plate_around = 96, plate_steps = 20;
constexpr double embedded = 0.3e-3;  // that blades reach into case and hub, so that no gap is left [m]

/// A point on the cylinder of this radius around the engine's axis.
Vec3<double> on_cylinder(const Compressor& c, double x, double turn, double radius) {
  return {x, radius * std::sin(turn), c.case_radius - radius * std::cos(turn)};
}

/// A closed loop of points at two radii, with its inside in between.
Mesh prism(const Compressor& c, const std::vector<Vec2<double>>& loop, double inner, double outer) {
  Mesh mesh;
  const int n = static_cast<int>(loop.size()), half = n / 2;
  for (const double radius : {inner, outer})
    for (const Vec2<double>& p : loop) mesh.vertices.push_back(on_cylinder(c, p[0], p[1], radius));
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    mesh.triangles.push_back({i, n + i, next});
    mesh.triangles.push_back({next, n + i, n + next});
  }
  // the loop goes along one side and back along the other: opposite points are neighbours across it
  for (int i = 0; i < half - 1; ++i) {
    const int a = i, b = i + 1, d = n - 1 - i, e = n - 2 - i;
    mesh.triangles.push_back({a, b, d}), mesh.triangles.push_back({b, e, d});
    mesh.triangles.push_back({n + a, n + d, n + b}), mesh.triangles.push_back({n + b, n + d, n + e});
  }
  if (mesh.volume() < 0)
    for (auto& [a, b, d] : mesh.triangles) std::swap(b, d);
  return mesh;
}

Mesh blade(const Compressor& c, const BladeRow& row, double turn) {
  const double radius = 0.5 * (c.case_radius + c.hub_radius);
  std::vector<Vec2<double>> upper, lower;
  double around = 0;  // along the camber line, in the middle of the annulus
  for (int i = 0; i <= camber_steps; ++i) {
    const double t = static_cast<double>(i) / camber_steps, step = row.chord / camber_steps;
    const double angle = row.angle_in + t * (row.angle_out - row.angle_in);
    const double before = row.angle_in + (t - 0.5 / camber_steps) * (row.angle_out - row.angle_in);
    if (i > 0) around += step * std::tan(before);
    const double x = row.start + t * row.chord;
    const double half = 0.5 * row.thickness * (0.2 + 0.8 * 4 * t * (1 - t));  // blunt edges
    const double nx = -std::sin(angle), ny = std::cos(angle);
    upper.emplace_back(x + half * nx, turn + (around + half * ny) / radius);
    lower.emplace_back(x - half * nx, turn + (around - half * ny) / radius);
  }
  std::vector<Vec2<double>> loop = lower;
  loop.insert(loop.end(), upper.rbegin(), upper.rend());
  return prism(c, loop, c.hub_radius - embedded, c.case_radius + embedded);
}

/// A plate on a cylinder, with a round hole along z at the origin where `hole` is not 0.
Mesh plate(const Compressor& c, double inner, double outer, double hole) {
  Mesh mesh;
  const double turn = c.sector / c.case_radius;
  const auto rim = [&](int i) -> Vec2<double> {  // of the sector, in the direction of a corner of the hole
    const double angle = 2 * std::numbers::pi * i / plate_around;
    const double x = std::cos(angle), y = std::sin(angle), width = outer * std::sin(turn);
    const double along = x > 0 ? c.downstream / x : x < 0 ? -c.upstream / x : 1e9;
    return Vec2<double>(x, y) * std::min(along, y == 0 ? 1e9 : width / std::abs(y));
  };
  const int rings = plate_steps + 1;
  const double start = hole > 0 ? hole / 2 / std::cos(std::numbers::pi / plate_around) : 0;
  for (const double radius : {inner, outer})
    for (int k = 0; k < rings; ++k)
      for (int i = 0; i < plate_around; ++i) {
        const Vec2<double> end = rim(i);
        const double size = std::sqrt(squared_norm(end));
        const double first = std::max(start, hole > 0 ? 0 : 0.5e-3);
        const double t = static_cast<double>(k) / plate_steps,
                     r = first + (size - first) * t * (0.3 + 0.7 * t);
        const Vec2<double> p = end * (r / size);
        mesh.vertices.emplace_back(p[0], p[1], c.case_radius - std::sqrt(radius * radius - p[1] * p[1]));
      }
  const int sheet = rings * plate_around;
  const auto at = [&](int which, int k, int i) {
    return which * sheet + k * plate_around + i % plate_around;
  };
  for (int i = 0; i < plate_around; ++i) {
    for (int k = 0; k + 1 < rings; ++k) {
      mesh.triangles.push_back({at(0, k, i), at(0, k + 1, i), at(0, k + 1, i + 1)});
      mesh.triangles.push_back({at(0, k, i), at(0, k + 1, i + 1), at(0, k, i + 1)});
      mesh.triangles.push_back({at(1, k, i), at(1, k + 1, i + 1), at(1, k + 1, i)});
      mesh.triangles.push_back({at(1, k, i), at(1, k, i + 1), at(1, k + 1, i + 1)});
    }
    const int last = rings - 1;
    mesh.triangles.push_back({at(0, last, i), at(1, last, i), at(1, last, i + 1)});
    mesh.triangles.push_back({at(0, last, i), at(1, last, i + 1), at(0, last, i + 1)});
    if (hole > 0) {
      mesh.triangles.push_back({at(0, 0, i), at(1, 0, i + 1), at(1, 0, i)});
      mesh.triangles.push_back({at(0, 0, i), at(0, 0, i + 1), at(1, 0, i + 1)});
    }
  }
  if (!(hole > 0))
    for (const int which : {0, 1}) {  // no hole: closed by a point
      const double radius = which == 0 ? inner : outer;
      mesh.vertices.emplace_back(0, 0, c.case_radius - radius);
      const int middle = static_cast<int>(mesh.vertices.size()) - 1;
      for (int i = 0; i < plate_around; ++i)
        mesh.triangles.push_back(which == 0 ? std::array{middle, at(0, 0, i), at(0, 0, i + 1)}
                                            : std::array{middle, at(1, 0, i + 1), at(1, 0, i)});
    }
  if (mesh.volume() < 0)
    for (auto& [a, b, d] : mesh.triangles) std::swap(b, d);
  return mesh;
}

}  // namespace

Compressor drawn_compressor(std::uint64_t seed) {
  Compressor c;
  Draw draw(seed);
  for (BladeRow& row : c.rows) {
    const double pitch = 2 * std::numbers::pi * c.case_radius / row.count;
    if (row.name != "stator-1") row.offset = draw.between(0, pitch);  // the port is between two of that row
    row.thickness *= draw.between(0.9, 1.3);
    row.angle_in *= draw.between(0.85, 1.1);
    if (row.removed > 0) row.removed = draw.between(24e-3, 40e-3);
  }
  c.target = {draw.between(70e-3, 86e-3), draw.between(-25e-3, 25e-3), draw.between(14e-3, 28e-3)};
  return c;
}

Errors compressor_errors(const Compressor& c) {
  Errors errors;
  const auto demand = [&](bool holds, std::string_view where, std::string_view rule) {
    if (!holds) errors.push_back({"out_of_range", std::string(where), std::string(rule)});
  };
  demand(c.hub_radius > 0 && c.case_radius > c.hub_radius, "case",
         "the case's radius is larger than the hub's");
  demand(c.case_thickness > 0, "case", "a thickness is > 0");
  demand(c.hub_thickness > 0 && c.hub_thickness < c.hub_radius, "hub",
         "a thickness is > 0 and below the radius");
  demand(c.sector > 0 && c.sector < c.hub_radius, "sector",
         "half the sector is > 0 and below the hub's radius");
  demand(c.upstream > 0 && c.downstream > 0, "length", "the compressor reaches to both sides of the port");
  demand(c.port_diameter > 0 && c.port_diameter < 2 * std::min({c.sector, c.upstream, c.downstream}), "port",
         "the port is > 0 and fits into what is made of the case");
  demand(c.stage_limit > 0, "stage", "a limit is > 0");
  for (const BladeRow& row : c.rows) {
    demand(row.chord > 0 && row.thickness > 0, row.name, "chord and thickness of a blade are > 0");
    demand(row.count >= 0 && row.count <= 2000, row.name, "blades are 0 to 2000");
    demand(std::abs(row.angle_in) < 1.5 && std::abs(row.angle_out) < 1.5, row.name,
           "angles are below 85 deg");
  }
  return errors;
}

std::vector<Mesh> compressor_meshes(const Compressor& c) {
  std::vector<Mesh> all;
  all.push_back(plate(c, c.case_radius, c.case_radius + c.case_thickness, c.port_diameter));
  all.back().name = "case";
  all.push_back(plate(c, c.hub_radius - c.hub_thickness, c.hub_radius, 0));
  all.back().name = "hub";
  for (const BladeRow& row : c.rows) {
    if (row.count == 0) continue;
    const double pitch = 2 * std::numbers::pi / row.count;
    const double first = row.offset / c.case_radius, limit = c.sector / c.case_radius;
    int number = 0;
    for (int k = -row.count / 2; k <= row.count / 2; ++k) {
      const double turn = first + k * pitch;
      if (std::abs(turn) > limit || std::abs(turn) * c.case_radius < row.removed) continue;
      all.push_back(blade(c, row, turn));
      all.back().name = fmt::format("{}-{:02}", row.name, ++number);
    }
  }
  return all;
}

InsertionScene compressor_scene(const Compressor& c, SerialRobot robot) {
  InsertionScene scene;
  scene.name = "compressor";
  scene.robot_name = c.robot;
  scene.base.p = Vec3<double>(0, 0, -c.case_thickness - robot.length());
  scene.robot = std::move(robot);
  scene.stage_limit = c.stage_limit;
  scene.port = InsertionPort{{0, 0, 0}, c.port_diameter / 2};
  scene.target.tip = c.target;
  scene.solids = compressor_meshes(c);
  return scene;
}

std::string compressor_scene_text(const Compressor& c, const SerialRobot& robot) {
  const InsertionScene scene = compressor_scene(c, robot);
  const auto mm = [](double metres) { return human(metres, Dimension::length); };
  std::string text = fmt::format(
      "# A stand-in for a compressor: annulus of {} between hub and case, {} rows of blades, a port of {}.\n"
      "# Axes: origin where the port meets the inside of the case; x downstream, z inwards, y around the "
      "engine.\n"
      "sinew: 1\n"
      "kind: scene\n"
      "name: compressor\n"
      "robot: {}\n"
      "base: {{position: [0, 0, {}]}}    # stage at 0: the straight robot's tip is at the outside of the "
      "case\n"
      "axis: [0, 0, 1]                   # in which the stage moves the base\n"
      "stage: {{limit: {}}}\n"
      "port: {{position: [0, 0, 0], radius: {}}}\n"
      "target: {{tip: [{}, {}, {}], tolerance: {}}}\n"
      "margins: {{clearance: {}}}\n"
      "obstacles:\n",
      mm(c.case_radius - c.hub_radius), c.rows.size(), mm(c.port_diameter), c.robot, mm(scene.base.p.z()),
      mm(c.stage_limit), mm(c.port_diameter / 2), mm(c.target.x()), mm(c.target.y()), mm(c.target.z()),
      mm(scene.target.tolerance), mm(scene.clearance));
  for (const Mesh& mesh : scene.solids)
    text += fmt::format("  - {{name: {0}, mesh: {0}.stl, unit: mm}}\n", mesh.name);
  return text;
}

}  // namespace sinew::inline v1
