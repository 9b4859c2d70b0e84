/// @file mesh_file.hpp
/// Triangles of a mesh file as assimp reads them.
#pragma once
#include <filesystem>
#include <vector>

#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

/// Three corners of three numbers a triangle, as the file has them. assimp reads in a process of its own: of
/// damaged files it has been seen to end the program, and not to end. Codes: `file_unreadable`,
/// `mesh_too_large`.
Expected<std::vector<float>> read_triangles(const std::filesystem::path& path);

}  // namespace sinew::inline v1
