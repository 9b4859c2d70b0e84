// Meshes: files of each format, read by assimp, and what is said of them.
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "check.hpp"
#include "driver.hpp"
#include "sinew/plan/scene.hpp"

namespace {

constexpr std::string_view words[] = {"solid a\n",
                                      "facet normal 0 0 1\n outer loop\n",
                                      "vertex 0 0 0\n",
                                      "vertex 1 0 0\n",
                                      "vertex 1e38 nan inf\n",
                                      "endloop\nendfacet\n",
                                      "endsolid a\n",
                                      "v 0 0 0\n",
                                      "v 1 0 0\n",
                                      "vn 0 0 1\n",
                                      "f 1 2 3\n",
                                      "f 1//1 2//1 3//1\n",
                                      "f -1 -2 -3\n",
                                      "f 1 2 99999999999\n",
                                      "l 1 2\n",
                                      "mtllib a.mtl\n",
                                      "ply\n",
                                      "format ascii 1.0\n",
                                      "format binary_little_endian 1.0\n",
                                      "element vertex 3\n",
                                      "element face 4294967295\n",
                                      "property float x\n",
                                      "property list uchar int vertex_indices\n",
                                      "end_header\n",
                                      "3 0 1 2\n"};

/// One file for each format, of this process.
const std::array<std::filesystem::path, 3>& files() {
  static const std::array<std::filesystem::path, 3> all = [] {
    std::array<std::filesystem::path, 3> made;
    const char* const formats[] = {".stl", ".obj", ".ply"};
    for (std::size_t k = 0; k < made.size(); ++k)
      made[k] =
          std::filesystem::temp_directory_path() / ("sinew-fuzz-" + std::to_string(getpid()) + formats[k]);
    std::atexit([] {
      for (const auto& file : files()) std::filesystem::remove(file);
    });
    return made;
  }();
  return all;
}

}  // namespace

/// The first byte says which format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::filesystem::path& file = files()[data[0] % 3];
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  const auto mesh = sinew::read_mesh(file, 1e-3);
  if (!mesh) return sinew::fuzz::check_errors(mesh.error()), 0;
  const sinew::Errors errors = sinew::mesh_errors(*mesh, "mesh");
  if (!errors.empty()) return sinew::fuzz::check_errors(errors), 0;
  if (!(mesh->volume() > 0)) sinew::fuzz::die("a solid without a volume", mesh->name);
  for (const auto& vertex : mesh->vertices)
    if (!std::isfinite(sinew::squared_norm(vertex)))
      sinew::fuzz::die("a vertex that is no number", mesh->name);
  return 0;
}

SINEW_FUZZ_MAIN("mesh", words)
