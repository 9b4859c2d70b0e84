/// Meshes: what bounds a solid, what does not, and files of them.
#include "sinew/plan/scene.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>

#include "scenes.hpp"
#include "study_folder.hpp"

namespace sinew::test {
namespace mesh_test {

std::vector<std::string> codes(const Errors& errors) {
  std::vector<std::string> all;
  for (const Error& error : errors) all.push_back(error.code);
  return all;
}
std::vector<std::string> faults(const Mesh& mesh) { return codes(mesh_errors(mesh, "mesh")); }
using Codes = std::vector<std::string>;

TEST(Mesh, PrimitivesBoundTheirSolids) {
  EXPECT_EQ(faults(box_mesh({1, 2, 3})), Codes{});
  EXPECT_NEAR(box_mesh({1, 2, 3}).volume(), 6, 1e-12);
  for (const double deviation : {1e-1, 1e-2, 1e-3}) {
    const Mesh ball = sphere_mesh(1, deviation), bar = cylinder_mesh(1, 2, deviation);
    EXPECT_EQ(faults(ball), Codes{});
    EXPECT_EQ(faults(bar), Codes{});
    double least = 1e9, most = 0;
    for (const Vec3<double>& p : ball.vertices) most = std::max(most, std::sqrt(squared_norm(p)));
    for (const auto& [a, b, c] : ball.triangles) {
      const auto at = [&](int i) { return ball.vertices[static_cast<std::size_t>(i)]; };
      least = std::min(least, std::sqrt(squared_norm(nearest_on_triangle({0, 0, 0}, at(a), at(b), at(c)))));
    }
    EXPECT_GE(least, 1 - 1e-12) << deviation;
    EXPECT_LE(most, 1 + deviation + 1e-12) << deviation;
    EXPECT_GT(bar.volume(), 2 * std::numbers::pi);
    EXPECT_LT(bar.volume(), 2 * std::numbers::pi * (1 + deviation) * (1 + deviation));
  }
}

TEST(Mesh, CompressorsAreSolids) {
  for (int seed = 0; seed < 20; ++seed)
    for (const Mesh& mesh :
         compressor_meshes(seed == 0 ? Compressor{} : drawn_compressor(static_cast<std::uint64_t>(seed))))
      EXPECT_EQ(faults(mesh), Codes{}) << mesh.name << seed;
}

TEST(Mesh, WhatIsWrongIsNamed) {
  const Mesh box = box_mesh({1, 1, 1});
  EXPECT_EQ(faults({"none", {}, {}}), Codes{"mesh_empty"});
  Mesh open = box;
  open.triangles.pop_back();
  EXPECT_EQ(faults(open), Codes{"mesh_open"});
  Mesh inside_out = box;
  for (auto& [a, b, c] : inside_out.triangles) std::swap(b, c);
  EXPECT_EQ(faults(inside_out), Codes{"mesh_inside_out"});
  Mesh turned = box;
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_EQ(faults(turned), Codes{"mesh_not_oriented"});
  Mesh flat = box;
  flat.triangles.push_back({0, 1, 1});
  EXPECT_EQ(faults(flat).front(), "mesh_degenerate");
  Mesh crowded = box;
  crowded.vertices.emplace_back(0, 0, 5);
  crowded.triangles.push_back({0, 1, 8});
  EXPECT_EQ(faults(crowded), (Codes{"mesh_open", "mesh_not_manifold"}));
  Mesh infinite = box;
  infinite.vertices[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(faults(infinite), Codes{"mesh_not_finite"});
}

TEST(Mesh, FilesGiveBackWhatWasWritten) {
  const Folder folder;
  const Mesh ball = moved(sphere_mesh(0.01, 1e-4), {{0.1, -0.2, 0.3}, {}});
  const auto path = folder.path / "ball.stl";
  ASSERT_TRUE(write_stl(ball, path));
  const Mesh read = read_mesh(path, 1e-3).value();
  EXPECT_EQ(read.triangles.size(), ball.triangles.size());
  EXPECT_EQ(read.vertices.size(), ball.vertices.size());
  EXPECT_EQ(faults(read), Codes{});
  EXPECT_NEAR(read.volume() / ball.volume(), 1, 1e-5);
  std::ofstream(folder.path / "box.obj")
      << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const Mesh box = read_mesh(folder.path / "box.obj", 1).value();
  EXPECT_EQ(faults(box), Codes{});
  EXPECT_NEAR(box.volume(), 1, 1e-6);
}

TEST(Mesh, BadFilesAreRefusedByName) {
  const Folder folder;
  EXPECT_EQ(read_mesh(folder.path / "none.stl", 1).error().front().code, "file_missing");
  EXPECT_EQ(read_mesh(folder.path, 1).error().front().code, "file_unreadable");
  ASSERT_TRUE(write_stl(box_mesh({1, 1, 1}), folder.path / "box.stl"));
  const auto size = std::filesystem::file_size(folder.path / "box.stl");
  for (const std::uintmax_t kept :
       {std::uintmax_t{0}, std::uintmax_t{40}, std::uintmax_t{84}, std::uintmax_t{100}, size / 2, size - 1}) {
    std::filesystem::copy_file(folder.path / "box.stl", folder.path / "cut.stl",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(folder.path / "cut.stl", kept);
    const auto read = read_mesh(folder.path / "cut.stl", 1e-3);
    if (read) {
      EXPECT_NE(faults(*read), Codes{}) << kept;
    } else {
      EXPECT_EQ(read.error().front().code, "file_unreadable") << kept;
    }
  }
  std::ofstream(folder.path / "text.stl") << "not a mesh at all";
  const auto text = read_mesh(folder.path / "text.stl", 1);
  if (text) {
    EXPECT_NE(faults(*text), Codes{});
  }
}

}  // namespace mesh_test
}  // namespace sinew::test
