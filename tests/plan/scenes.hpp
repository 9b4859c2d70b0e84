/// @file scenes.hpp
/// Scenes of tests of insertion.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "plan/compressor.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/plan/scene.hpp"

namespace sinew::test {

/// Nothing around; the robot's tip is at the origin where its stage is at 0, and goes along z.
inline InsertionScene open_scene(const char* robot = "nottingham-tpcj") {
  InsertionScene scene;
  scene.name = "open";
  scene.robot_name = robot;
  scene.robot = load_serial(robot).value();
  scene.base.p = Vec3<double>(0, 0, -scene.robot.length());
  scene.stage_limit = 0.15;
  scene.target.tip = Vec3<double>(0.02, 0.01, 0.1);
  return scene;
}

inline Mesh named(Mesh mesh, const char* name, const Vec3<double>& position) {
  mesh.name = name;
  return moved(std::move(mesh), {position, {}});
}

/// The stand-in for a compressor, without its files.
inline InsertionScene compressor_of(const Compressor& compressor) {
  return compressor_scene(compressor, load_serial(compressor.robot).value());
}

/// Plates of 3 mm across the way, each with a square hole beside that of the one before, and the target
/// behind the last. [m]
struct Slalom {
  int plates = 4;
  double hole = 10e-3;    ///< side of a hole; the robot with its clearance is 7 mm thick
  double offset = 10e-3;  ///< from hole to hole, at most; 0.4 of it at least
  double gap = 30e-3;     ///< between the middles of plates
};

inline InsertionScene slalom_of(const Slalom& slalom, std::uint64_t seed) {
  InsertionScene scene = open_scene();
  scene.name = "slalom " + std::to_string(seed);
  scene.base.p = Vec3<double>(0, 0, -0.18);
  scene.stage_limit = 0.18;
  std::mt19937_64 random(seed);  // whose numbers the standard says
  const auto draw = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const auto away = [&](double distance) {
    const double angle = draw(0, 2 * std::numbers::pi);
    return Vec3<double>(distance * std::cos(angle), distance * std::sin(angle), 0);
  };
  constexpr double wide = 90e-3, thick = 3e-3;
  const double half = slalom.hole / 2, out = half + wide / 2;
  Vec3<double> hole(0, 0, 8e-3);
  for (int k = 0; k < slalom.plates; ++k) {
    if (k > 0) hole = hole + away(draw(0.4, 1) * slalom.offset) + Vec3<double>(0, 0, slalom.gap);
    for (const double side : {-1.0, 1.0}) {
      const std::string name = "plate-" + std::to_string(k) + (side < 0 ? "-low" : "-high");
      scene.solids.push_back(named(box_mesh({wide, 2 * wide, thick}), (name + "-x").c_str(),
                                   Vec3<double>(hole + Vec3<double>(side * out, 0, 0))));
      scene.solids.push_back(named(box_mesh({2 * half, wide, thick}), (name + "-y").c_str(),
                                   Vec3<double>(hole + Vec3<double>(0, side * out, 0))));
    }
  }
  scene.target.tip = hole + away(8e-3) + Vec3<double>(0, 0, draw(15e-3, 25e-3));
  return scene;
}

inline double distance_of(const Vec3<double>& a, const Vec3<double>& b) {
  return std::sqrt(squared_norm(Vec3<double>(a - b)));
}

/// Point of a triangle nearest to p, by projection on its plane and on its edges: slow and plain.
inline Vec3<double> nearest_on_triangle(const Vec3<double>& p, const Vec3<double>& a, const Vec3<double>& b,
                                        const Vec3<double>& c) {
  const Vec3<double> n = cross(Vec3<double>(b - a), Vec3<double>(c - a));
  const double nn = squared_norm(n);
  const Vec3<double> q = p - n * (dot(Vec3<double>(p - a), n) / nn);
  const auto side = [&](const Vec3<double>& from, const Vec3<double>& to) {
    return dot(cross(Vec3<double>(to - from), Vec3<double>(q - from)), n) >= 0;
  };
  if (side(a, b) && side(b, c) && side(c, a)) return q;
  Vec3<double> best = a;
  for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
    const Vec3<double> along = to - from;
    const double t = std::min(1.0, std::max(0.0, dot(Vec3<double>(p - from), along) / squared_norm(along)));
    const Vec3<double> on = from + t * along;
    if (distance_of(p, on) < distance_of(p, best)) best = on;
  }
  return best;
}

/// Least distance of a point from all surfaces of a scene.
inline double slow_distance(const Vec3<double>& p, const std::vector<Mesh>& solids) {
  double best = 1e9;
  for (const Mesh& mesh : solids)
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto at = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
      best = std::min(best, distance_of(p, nearest_on_triangle(p, at(a), at(b), at(c))));
    }
  return best;
}

}  // namespace sinew::test
