// Scenes of an insertion: read, with the robots they name and solids of primitives.
#include <cmath>

#include "check.hpp"
#include "driver.hpp"
#include "sinew/plan/scene.hpp"

namespace {

constexpr std::string_view words[] = {"sinew: 1\n",
                                      "kind: scene\n",
                                      "name: a\n",
                                      "robot: nottingham-tpcj\n",
                                      "robot: nottingham-neutral\n",
                                      "robot: 3-rfr\n",
                                      "base: {position: [0, 0, -180 mm]}\n",
                                      "quaternion: [1, 0, 0, 0]\n",
                                      "axis: [0, 0, 1]\n",
                                      "stage: {limit: 150 mm}\n",
                                      "port: {position: [0, 0, 0], radius: 5 mm}\n",
                                      "target: {tip: [10 mm, 0, 90 mm]}\n",
                                      "direction: [1, 0, 1]\n",
                                      "tolerance: 1 mm\n",
                                      "margins: {clearance: 1 mm, model: 1 mm}\n",
                                      "tension: 20 N\n",
                                      "weight: {by_length: 1 N/m, E: 60 GPa, diameter: 1 mm}\n",
                                      "obstacles:\n",
                                      "  - {name: a, box: [1 mm, 1 mm, 1 mm]}\n",
                                      "  - {sphere: 3 mm}\n",
                                      "  - {cylinder: {radius: 1 mm, length: 2 mm}}\n",
                                      "  - {mesh: none.stl}\n",
                                      "  - {mesh: /dev/zero}\n",
                                      "flip: true\n",
                                      "unit: in\n",
                                      "[]",
                                      "{}",
                                      "null",
                                      "1e999",
                                      "&a ",
                                      "!t "};

void check(const sinew::InsertionScene& scene) {
  using sinew::fuzz::die;
  if (scene.robot.sections.empty()) die("a scene without a robot", scene.robot_name);
  if (!(scene.stage_limit > 0 && scene.clearance > 0 && scene.target.tolerance > 0 && scene.model_error >= 0))
    die("a scene beyond its bounds", scene.name);
  if (std::abs(sinew::squared_norm(scene.axis) - 1) > 1e-9) die("an axis that is no unit vector", scene.name);
  for (const sinew::Mesh& mesh : scene.solids) {
    if (!sinew::mesh_errors(mesh, mesh.name).empty()) die("a mesh that bounds no solid", mesh.name);
    for (const auto& vertex : mesh.vertices)
      if (!std::isfinite(sinew::squared_norm(vertex))) die("a vertex that is no number", mesh.name);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto document =
      sinew::parse_yaml(std::string_view(reinterpret_cast<const char*>(data), size), "scene.yaml");
  if (!document) return sinew::fuzz::check_errors(document.error()), 0;
  const auto scene = sinew::read_scene(*document, "/nonexistent");
  if (scene)
    check(*scene);
  else
    sinew::fuzz::check_errors(scene.error());
  return 0;
}

SINEW_FUZZ_MAIN("scene", words)
