#include "sinew/plan/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "io/robots/read_pose.hpp"
#include "io/robots/serial_file.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::inline v1 {
namespace {

namespace fs = std::filesystem;

constexpr double min_deviation = 0.02e-3;  // of curved primitives from their triangles [m]

Vec3<double> vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

Vec3<double> point(const Reader& place) {
  return vector_of(place.array<3>(Dimension::length, Range::place()));
}

/// A direction of any length but 0.
Vec3<double> direction(const Reader& place) {
  const Vec3<double> v = vector_of(place.array<3>(Dimension::number, Range::between(-1e9, 1e9)));
  const double size = std::sqrt(squared_norm(v));
  if (size > 1e-9) return v / size;
  if (place.node()) place.refuse("out_of_range", "a direction is not 0, write [0, 0, 1] for z");
  return {0, 0, 1};
}

class SceneReader {
 public:
  SceneReader(const Document& document, const fs::path& folder) : root_(document, errors_), folder_(folder) {}

  Expected<InsertionScene> read() {
    const Reader version = root_.required("sinew", "version of the file format: 1");
    if (version.node() && version.integer() != 1)
      version.refuse("unknown_version", "this sinew reads version 1");
    const Reader kind = root_.required("kind", "what the file is: scene");
    if (kind.node() && kind.text() != "scene") kind.refuse("unknown_kind", "write `kind: scene`");
    if (const auto name = root_.optional("name")) scene_.name = name->text();
    read_robot();
    scene_.base =
        SE3<double>::from(read_spatial_pose(root_.required("base", "pose of the robot's base, stage at 0")));
    scene_.axis = scene_.base.rotate({0, 0, 1});
    if (const auto axis = root_.optional("axis")) scene_.axis = direction(*axis);
    Reader stage = root_.required("stage", "how the base is moved");
    scene_.stage_limit =
        stage.required("limit", "most that it moves the base").quantity(Dimension::length, Range::size());
    stage.close();
    read_port();
    read_target();
    if (auto margins = root_.optional("margins")) {
      if (const auto clearance = margins->optional("clearance"))
        scene_.clearance = clearance->quantity(Dimension::length, Range::positive());
      if (const auto error = margins->optional("model"))
        scene_.model_error = error->quantity(Dimension::length, Range::not_negative());
      if (const auto tension = margins->optional("tension")) read_tension(*tension);
      margins->close();
    }
    if (auto weight = root_.optional("weight")) read_weight(*weight);
    if (const auto obstacles = root_.optional("obstacles"))
      for (Reader& obstacle : items_of(*obstacles)) read_obstacle(obstacle);
    root_.close();
    std::size_t count = 0;
    for (const Mesh& mesh : scene_.solids) count += mesh.triangles.size();
    if (count > triangle_limit)
      root_.fail("mesh_too_large",
                 fmt::format("the obstacles have {} triangles; at most {}", count, triangle_limit));
    if (!errors_.empty()) return tl::unexpected(errors_);
    return std::move(scene_);
  }

 private:
  std::vector<Reader>& items_of(const Reader& list) { return items_ = list.items(); }

  void read_robot() {
    const Reader place = root_.required("robot", "a built-in serial robot or a file beside the scene");
    if (!place.is(Node::Kind::string)) return void(place.text());
    scene_.robot_name = place.text();
    const auto known = builtin_robot_names();
    const bool is_known = std::find(known.begin(), known.end(), scene_.robot_name) != known.end();
    const std::string source = is_known ? scene_.robot_name : (folder_ / scene_.robot_name).string();
    const auto document = read_robot_file(source);
    if (!document) return append(document.error());
    if (!is_serial(*document))
      return place.refuse("not_serial",
                          "insertion is planned for serial robots only, such as nottingham-tpcj");
    auto robot = read_serial_robot(*document);
    if (!robot) return append(robot.error());
    scene_.robot = std::move(*robot);
  }

  void read_port() {
    auto port = root_.optional("port");
    if (!port) return;
    InsertionPort result;
    result.position = point(port->required("position", "a point of its axis"));
    result.radius = port->required("radius").quantity(Dimension::length, Range::size());
    double thickest = 0;
    for (const Section& section : scene_.robot.sections)
      thickest = std::max(thickest, section.outer_radius());
    if (errors_.empty() && result.radius < thickest + scene_.clearance)
      port->fail("port_too_small",
                 fmt::format("its radius is {}, the robot's {}: with a clearance of {} it does not go in",
                             human(result.radius, Dimension::length), human(thickest, Dimension::length),
                             human(scene_.clearance, Dimension::length)));
    port->close();
    scene_.port = result;
  }

  void read_tension(const Reader& tension) {
    scene_.tension = tension.quantity(Dimension::force, Range::not_negative());
    if (scene_.tension > 0 && errors_.empty() && !scene_.robot.stretch)
      tension.fail("missing_field",
                   "what it does to a tendon is not known: the robot's file has no `stretch`");
  }

  /// A round backbone.
  void read_weight(Reader& weight) {
    InsertionWeight result;
    result.by_length = weight.required("by_length").quantity(Dimension::line_load, Range::not_negative());
    const double E = weight.required("E", "of the backbone").quantity(Dimension::pressure, Range::positive());
    const double d =
        weight.required("diameter", "of the backbone").quantity(Dimension::length, Range::size());
    weight.close();
    result.stiffness = E * std::numbers::pi * d * d * d * d / 64;
    scene_.weight = result;
  }

  void read_target() {
    Reader target = root_.required("target", "where the tip is to get");
    scene_.target.tip = point(target.required("tip", "its place"));
    if (const auto along = target.optional("direction")) scene_.target.direction = direction(*along);
    if (const auto tolerance = target.optional("tolerance"))
      scene_.target.tolerance = tolerance->quantity(Dimension::length, Range::positive());
    if (const auto tolerance = target.optional("direction_tolerance"))
      scene_.target.direction_tolerance = tolerance->quantity(Dimension::angle, Range::positive());
    target.close();
  }

  void read_obstacle(Reader& obstacle) {
    std::optional<Mesh> mesh;
    int shapes = 0;
    if (const auto file = obstacle.optional("mesh")) ++shapes, mesh = read_file_of(*file, obstacle);
    if (const auto size = obstacle.optional("box"))
      ++shapes, mesh = box_mesh(vector_of(size->array<3>(Dimension::length, Range::size())));
    if (const auto radius = obstacle.optional("sphere")) {
      const double r = radius->quantity(Dimension::length, Range::size());
      ++shapes, mesh = sphere_mesh(r, std::max(min_deviation, 1e-3 * r));
    }
    if (auto cylinder = obstacle.optional("cylinder")) {
      const double r = cylinder->required("radius").quantity(Dimension::length, Range::size());
      const double length = cylinder->required("length").quantity(Dimension::length, Range::size());
      cylinder->close();
      ++shapes, mesh = cylinder_mesh(r, length, std::max(min_deviation, 1e-3 * r));
    }
    if (shapes != 1 && obstacle.is(Node::Kind::map))
      obstacle.fail("wrong_shape", "write one of mesh, box, sphere, cylinder");
    if (const auto name = obstacle.optional("name"); name && mesh) mesh->name = name->text();
    SE3<double> pose;
    if (const auto place = obstacle.optional("position")) pose.p = point(*place);
    if (const auto turn = obstacle.optional("quaternion")) {
      const auto q = turn->array<4>(Dimension::number, Range::between(-1e9, 1e9));
      const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      if (size > 1e-9)
        pose.R = SO3<double>{q[0], {q[1], q[2], q[3]}}.normalised();
      else if (turn->node())
        turn->refuse("out_of_range", "a quaternion is not 0, write [1, 0, 0, 0] for no turn");
    }
    obstacle.close();
    if (!mesh) return;
    if (!names_.insert(mesh->name).second) {
      int number = 2;
      while (!names_.insert(fmt::format("{}-{}", mesh->name, number)).second) ++number;
      mesh->name = fmt::format("{}-{}", mesh->name, number);
    }
    scene_.solids.push_back(moved(std::move(*mesh), pose));
  }

  std::optional<Mesh> read_file_of(const Reader& file, Reader& obstacle) {
    double unit = 1e-3;
    if (const auto word = obstacle.optional("unit"))
      unit = word->choice_of<double>({{"mm", 1e-3}, {"m", 1.0}, {"cm", 1e-2}, {"in", 25.4e-3}});
    bool flip = false;
    if (const auto word = obstacle.optional("flip")) flip = word->boolean();
    if (!file.is(Node::Kind::string)) return file.text(), std::nullopt;
    const fs::path path = folder_ / file.text();
    auto mesh = read_mesh(path, unit);
    if (!mesh) {
      for (const Error& error : mesh.error()) file.fail(error.code, path.string() + ": " + error.message);
      return std::nullopt;
    }
    if (flip)
      for (auto& [a, b, c] : mesh->triangles) std::swap(b, c);
    const Errors wrong = mesh_errors(*mesh, path.string());
    for (const Error& error : wrong) file.fail(error.code, path.string() + ": " + error.message);
    if (!wrong.empty()) return std::nullopt;
    return std::move(*mesh);
  }

  void append(const Errors& more) { errors_.insert(errors_.end(), more.begin(), more.end()); }

  Errors errors_;
  Reader root_;
  fs::path folder_;
  InsertionScene scene_;
  std::vector<Reader> items_;
  std::set<std::string> names_;
};

}  // namespace

Expected<InsertionScene> read_scene(const Document& document, const fs::path& folder) {
  return SceneReader(document, folder).read();
}

Expected<InsertionScene> load_scene(const fs::path& path) {
  const auto document = read_file(path.string());
  if (!document) return tl::unexpected(document.error());
  return read_scene(*document, path.parent_path());
}

}  // namespace sinew::inline v1
