/// @file mesh.hpp
/// Closed triangle meshes: what a robot may not touch. Read from STL, OBJ and PLY files or made of
/// primitives. Theory: docs/theory/insertion.md
#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/base/export.hpp"
#include "sinew/math/se3.hpp"

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

}  // namespace sinew::inline v1
