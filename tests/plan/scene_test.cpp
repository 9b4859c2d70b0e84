/// Scene files, right and wrong.
#include "sinew/plan/scene.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "io/document/parse.hpp"
#include "scenes.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"
#include "study_folder.hpp"

namespace sinew::test {
namespace scene_test {

Expected<InsertionScene> read(const std::string& text, const std::filesystem::path& folder = ".") {
  const auto document = parse_yaml(text, "scene.yaml");
  if (!document) return tl::unexpected(document.error());
  return read_scene(*document, folder);
}

/// The template with a line replaced, or without it.
std::string with_line(const std::string& begin, const std::string& line) {
  std::string text(scene_template()), result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string one = text.substr(at, end - at);
    result += one.starts_with(begin) ? (line.empty() ? "" : line + "\n") : one + "\n";
    at = end + 1;
  }
  return result;
}

std::string first_code(const std::string& text) {
  const auto scene = read(text);
  return scene ? "" : scene.error().front().code;
}

TEST(Scene, TheTemplateIsOne) {
  const InsertionScene scene = read(std::string(scene_template())).value();
  EXPECT_EQ(scene.name, "wall");
  EXPECT_EQ(scene.solids.size(), 5U);
  EXPECT_EQ(scene.robot.section_count(), 5);
  EXPECT_NEAR(scene.base.p.z(), -0.18, 1e-15);
  EXPECT_EQ(scene.axis, Vec3<double>(0, 0, 1));
  double low = 1, high = -1;  // the post lies along y
  for (const Vec3<double>& p : scene.solids[4].vertices)
    low = std::min(low, p.y()), high = std::max(high, p.y());
  EXPECT_NEAR(low, -0.04, 1e-12);
  EXPECT_NEAR(high, 0.04, 1e-12);
}

TEST(Scene, WhatIsWrongIsNamed) {
  EXPECT_EQ(first_code(with_line("sinew:", "")), "missing_key");
  EXPECT_EQ(first_code(with_line("sinew:", "sinew: 2")), "unknown_version");
  EXPECT_EQ(first_code(with_line("kind:", "")), "missing_key");
  EXPECT_EQ(first_code(with_line("kind:", "kind: serial")), "unknown_kind");
  EXPECT_EQ(first_code(with_line("robot:", "robot: 3-rfr")), "not_serial");
  EXPECT_EQ(first_code(with_line("robot:", "robot: none.yaml")), "file_missing");
  EXPECT_EQ(first_code(with_line("robot:", "robot: [1]")), "wrong_type");
  EXPECT_EQ(first_code(with_line("stage:", "stage: {limit: -1 mm}")), "out_of_range");
  EXPECT_EQ(first_code(with_line("stage:", "stage: {limit: 3 deg}")), "wrong_dimension");
  EXPECT_EQ(first_code(with_line("stage:", "stage: {limit: 150 mm}\naxis: [0, 0, 0]")), "out_of_range");
  EXPECT_EQ(
      first_code(with_line("stage:", "stage: {limit: 150 mm}\nport: {position: [0, 0, 0], radius: 3.2 mm}")),
      "port_too_small");
  EXPECT_EQ(first_code(with_line("margins:", "margins:\n  tension: 20 N")), "missing_field");
  EXPECT_EQ(first_code(with_line("margins:", "margins:\n  tension: -1 N")), "out_of_range");
  EXPECT_EQ(first_code(with_line("stage:", "stage: {limit: 150 mm}\nweight: {by_length: 1 N/m}")),
            "missing_key");
  EXPECT_EQ(first_code(with_line(
                "stage:", "stage: {limit: 150 mm}\nweight: {by_length: 1 N/m, E: 0 GPa, diameter: 1 mm}")),
            "out_of_range");
  EXPECT_EQ(first_code(with_line("obstacles:", "obstacles:\n  - {name: nothing}")), "wrong_shape");
  EXPECT_EQ(first_code(with_line("obstacles:", "obstacles:\n  - {sphere: 3 mm, box: [1, 1, 1]}")),
            "wrong_shape");
  EXPECT_EQ(first_code(with_line("obstacles:", "obstacles:\n  - {mesh: none.stl}")), "file_missing");
  EXPECT_EQ(first_code(with_line("obstacles:", "obstacles:\n  - {sphere: 3 mm, colour: red}")),
            "unknown_key");
  EXPECT_EQ(first_code("3"), "wrong_type");
}

TEST(Scene, MeshesAreLookedAt) {
  const Folder folder;
  Mesh box = box_mesh({0.01, 0.01, 0.01});
  ASSERT_TRUE(write_stl(box, folder.path / "box.stl"));
  for (auto& [a, b, c] : box.triangles) std::swap(b, c);
  ASSERT_TRUE(write_stl(box, folder.path / "turned.stl"));
  box.triangles.pop_back();
  ASSERT_TRUE(write_stl(box, folder.path / "open.stl"));
  const auto scene = [&](const std::string& obstacle) {
    return read(with_line("obstacles:", "obstacles:\n  - " + obstacle), folder.path);
  };
  EXPECT_EQ(scene("{mesh: box.stl}").value().solids[0].triangles.size(), 12U);
  EXPECT_NEAR(scene("{mesh: box.stl, unit: m}").value().solids[0].volume(), 1e3, 1e-2);
  EXPECT_EQ(scene("{mesh: turned.stl}").error().front().code, "mesh_inside_out");
  EXPECT_TRUE(scene("{mesh: turned.stl, flip: true}"));
  EXPECT_EQ(scene("{mesh: open.stl}").error().front().code, "mesh_open");
  EXPECT_NE(scene("{mesh: open.stl}").error().front().where.find("scene.yaml:"), std::string::npos);
}

TEST(Scene, WhatIsWrittenIsRead) {
  const Folder folder;
  for (const std::uint64_t seed : {0u, 1u, 2u}) {
    const Compressor compressor = seed == 0 ? Compressor{} : drawn_compressor(seed);
    for (const Mesh& mesh : compressor_meshes(compressor))
      ASSERT_TRUE(write_stl(mesh, folder.path / (mesh.name + ".stl")));
    const InsertionScene made = compressor_of(compressor);
    ASSERT_TRUE(write_text(compressor_scene_text(compressor, made.robot), folder.path / "scene.yaml"));
    const InsertionScene read = load_scene(folder.path / "scene.yaml").value();
    EXPECT_EQ(read.solids.size(), made.solids.size());
    EXPECT_LT(distance_of(read.target.tip, made.target.tip), 1e-6);
    EXPECT_LT(distance_of(read.base.p, made.base.p), 1e-9);
    EXPECT_EQ(read.stage_limit, made.stage_limit);
    EXPECT_EQ(read.clearance, made.clearance);
    EXPECT_EQ(read.target.tolerance, made.target.tolerance);
    EXPECT_NEAR(read.port.value().radius, made.port.value().radius, 1e-9);
  }
}

TEST(Scene, AnyTextIsReadOrRefused) {
  std::mt19937 random(11);
  const std::string whole(scene_template());
  for (int sample = 0; sample < 500; ++sample) {
    std::string text = whole;
    for (int change = 0; change < 3; ++change) {
      const std::size_t at = random() % text.size();
      if (random() % 2)
        text.erase(at, 1 + random() % 20);
      else
        text.insert(at, std::vector<std::string>{"null", "-", "1e400", "[", "{", "\n", " ", "nan", "mesh: x",
                                                 "0"}[random() % 10]);
      if (text.empty()) text = "x";
    }
    const auto scene = read(text);
    if (!scene) {
      EXPECT_FALSE(scene.error().empty());
    }
  }
}

}  // namespace scene_test
}  // namespace sinew::test
