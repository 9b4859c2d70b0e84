/// @file scene.hpp
/// What a robot is to go into: closed triangle meshes that it may not touch, where it begins, and where its
/// tip is to get. Format: docs/scenes.md, theory: docs/theory/insertion.md
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/base/export.hpp"
#include "sinew/io/node.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// Triangles that bound a solid, counter-clockwise seen from outside. [m]
struct Mesh {
  std::string name;
  std::vector<Vec3<double>> vertices;         ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< indices of vertices

  /// Of the solid [m³]; < 0 where it is inside out.
  SINEW_API double volume() const;
};

/// Most triangles of all meshes of a scene together.
inline constexpr std::size_t triangle_limit = 4'000'000;

/// What is wrong with a mesh that should bound a solid: `mesh_empty`, `mesh_not_finite`, `mesh_degenerate`
/// (triangles without area), `mesh_open` (edges of one triangle), `mesh_not_manifold` (edges of three or
/// more), `mesh_not_oriented` (neighbours of opposite sense), `mesh_inside_out`. Each with a count and a
/// place.
/// @param where names the mesh in errors
SINEW_API Errors mesh_errors(const Mesh& mesh, const std::string& where);

/// A mesh of a file, its vertices merged where they coincide, scaled by `unit` [m]. Codes: `file_missing`,
/// `file_unreadable` (with what the reader of that format found), `mesh_too_large`.
SINEW_API Expected<Mesh> read_mesh(const std::filesystem::path& path, double unit);

/// A binary STL file, in millimetres. Codes: `file_unwritable`.
SINEW_API Expected<void> write_stl(const Mesh& mesh, const std::filesystem::path& path);

/// @name Primitives
/// Curved ones circumscribe the exact solid, by at most `deviation` [m], so none is smaller than it should
/// be.
/// @{
SINEW_API Mesh box_mesh(const Vec3<double>& size);            ///< edges [m], about the origin
SINEW_API Mesh sphere_mesh(double radius, double deviation);  ///< radius [m], about the origin
SINEW_API Mesh cylinder_mesh(double radius, double length,
                             double deviation);  ///< [m], along z, about the origin
/// @}

/// The mesh elsewhere: every vertex is `pose.point(vertex)` [m].
SINEW_API Mesh moved(Mesh mesh, const SE3<double>& pose);

/// Where the tip is to get, in scene axes.
struct InsertionTarget {
  Vec3<double> tip{0, 0, 0};              ///< [m]
  std::optional<Vec3<double>> direction;  ///< unit vector along the backbone there
  double tolerance = 0.5e-3;              ///< of the tip [m], > 0
  double direction_tolerance = 0.05;      ///< [rad], > 0
};

/// A hole that the robot goes in through: for messages and checks, the meshes are what counts.
struct InsertionPort {
  Vec3<double> position{0, 0, 0};  ///< a point of its axis [m]
  double radius = 0;               ///< [m], > 0
};

/// What bends the robot by its own weight, and what resists.
struct InsertionWeight {
  double by_length = 0;  ///< of robot and what it carries [N/m], ≥ 0
  double stiffness = 0;  ///< EI of the round backbone in its joints [N m²], > 0
};

/// The whole task, in scene axes.
struct InsertionScene {
  std::string name;
  std::string robot_name;  ///< as the scene writes it
  SerialRobot robot;
  SE3<double> base;            ///< of the robot where its stage is at 0, in scene axes [m]
  Vec3<double> axis{0, 0, 1};  ///< unit vector in which the stage moves the base
  double stage_limit = 0;      ///< most that the stage moves it [m], > 0
  std::optional<InsertionPort> port;
  InsertionTarget target;
  double clearance = 0.5e-3;  ///< that a plan keeps between robot and solids [m], > 0
  double model_error = 0;     ///< what the robot may be off its kinematics [m], ≥ 0
  double tension = 0;         ///< greatest of any tendon [N], ≥ 0; > 0: the robot says how tendons stretch
  std::optional<InsertionWeight> weight;
  std::vector<Mesh> solids;
};

/// The scene that a document describes, or every error of it and of its meshes at once.
/// @param folder that file names of robot and meshes are relative to
SINEW_API Expected<InsertionScene> read_scene(const Document& document, const std::filesystem::path& folder);

/// The scene in a file.
SINEW_API Expected<InsertionScene> load_scene(const std::filesystem::path& path);

}  // namespace sinew::inline v1
