#include "sinew/plan/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <unordered_map>

#include "plan/mesh_file.hpp"
#include "sinew/io/table.hpp"

namespace sinew::inline v1 {
namespace {

std::string shown(const Vec3<double>& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}

Vec3<double> area_vector(const Mesh& mesh, const std::array<int, 3>& t) {
  const auto at = [&](int i) {
    return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])];
  };
  return cross(Vec3<double>(at(1) - at(0)), Vec3<double>(at(2) - at(0))) * 0.5;
}

/// An edge, as often as it is passed in either sense.
struct EdgeUse {
  int forward = 0, backward = 0;
};

struct EdgeHash {
  std::size_t operator()(const std::uint64_t& edge) const { return edge * 0x9E3779B97F4A7C15ull; }
};
using Edges = std::unordered_map<std::uint64_t, EdgeUse, EdgeHash>;

Edges edges_of(const Mesh& mesh) {
  Edges edges;
  edges.reserve(mesh.triangles.size() * 3 / 2 + 1);
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto a = static_cast<std::uint64_t>(t[i]), b = static_cast<std::uint64_t>(t[(i + 1) % 3]);
      EdgeUse& use = edges[a < b ? a << 32 | b : b << 32 | a];
      ++(a < b ? use.forward : use.backward);
    }
  return edges;
}

struct PointHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& p) const {
    std::uint64_t h = 0;
    for (const std::int64_t x : p)
      h = (h ^ static_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ull, h ^= h >> 29;
    return h;
  }
};

/// Adds points, each once: those of files repeat in every triangle, rounded to floats.
class Merger {
 public:
  Merger(Mesh& mesh, double cell) : mesh_(&mesh), cell_(cell) {}
  int index(const Vec3<double>& p) {
    std::array<std::int64_t, 3> key{};
    for (int i = 0; i < 3; ++i) key[static_cast<std::size_t>(i)] = std::llround(p[i] / cell_);
    const auto [place, is_new] = known_.emplace(key, static_cast<int>(mesh_->vertices.size()));
    if (is_new) mesh_->vertices.push_back(p);
    return place->second;
  }

 private:
  Mesh* mesh_;
  double cell_;
  std::unordered_map<std::array<std::int64_t, 3>, int, PointHash> known_;
};

}  // namespace

double Mesh::volume() const {
  double six = 0;
  for (const auto& [a, b, c] : triangles) {
    const auto at = [&](int i) { return vertices[static_cast<std::size_t>(i)]; };
    six += dot(at(a), cross(at(b), at(c)));
  }
  return six / 6;
}

Errors mesh_errors(const Mesh& mesh, const std::string& where) {
  Errors errors;
  const auto fail = [&](const char* code, std::string message) {
    errors.push_back({code, where, std::move(message)});
  };
  if (mesh.triangles.empty()) {
    fail("mesh_empty", "no triangle; a solid is bounded by at least four");
    return errors;
  }
  for (const Vec3<double>& p : mesh.vertices)
    if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z())) {
      fail("mesh_not_finite", "a vertex is not a finite number; export the mesh anew");
      return errors;
    }
  std::size_t flat = 0;
  Vec3<double> flat_at(0, 0, 0);
  for (const auto& t : mesh.triangles)
    if (const auto a = static_cast<std::size_t>(t[0]);
        t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || !(squared_norm(area_vector(mesh, t)) > 0)) {
      if (flat++ == 0) flat_at = mesh.vertices[a];
    }
  if (flat > 0)
    fail("mesh_degenerate",
         fmt::format("{} of {} triangles have no area, the first at {}; remove them where the mesh was made",
                     flat, mesh.triangles.size(), shown(flat_at)));
  std::size_t open = 0, crowded = 0, turned = 0;
  std::uint64_t open_edge = ~0ull, crowded_edge = ~0ull, turned_edge = ~0ull;
  for (const auto& [edge, use] : edges_of(mesh)) {
    const int count = use.forward + use.backward;
    if (count == 1) ++open, open_edge = std::min(open_edge, edge);
    if (count > 2) ++crowded, crowded_edge = std::min(crowded_edge, edge);
    if (count == 2 && use.forward != 1) ++turned, turned_edge = std::min(turned_edge, edge);
  }
  const auto middle = [&](std::uint64_t edge) {
    return shown(Vec3<double>((mesh.vertices[edge >> 32] + mesh.vertices[edge & 0xFFFFFFFFu]) * 0.5));
  };
  if (open > 0)
    fail("mesh_open",
         fmt::format("{} edges belong to one triangle only, the first at {}: the mesh has a hole; inside "
                     "and outside are known of closed meshes only",
                     open, middle(open_edge)));
  if (crowded > 0)
    fail("mesh_not_manifold",
         fmt::format("{} edges belong to three triangles or more, the first at {}; split the mesh into "
                     "solids that do not share edges",
                     crowded, middle(crowded_edge)));
  if (turned > 0)
    fail("mesh_not_oriented",
         fmt::format("at {} edges the two triangles are of opposite sense, the first at {}; give all "
                     "normals outwards where the mesh was made",
                     turned, middle(turned_edge)));
  if (errors.empty() && !(mesh.volume() > 0))
    fail("mesh_inside_out",
         fmt::format("the normals point inwards (volume {:.4g} mm³); flip them, or write `flip: true`",
                     1e9 * mesh.volume()));
  return errors;
}

Expected<Mesh> read_mesh(const std::filesystem::path& path, double unit) {
  std::error_code missing;
  if (!std::filesystem::exists(path, missing))
    return failure("file_missing", path.string(), "there is no such file");
  if (!std::filesystem::is_regular_file(path, missing))
    return failure("file_unreadable", path.string(), "it is no file");
  const auto corners = read_triangles(path);
  if (!corners) return tl::unexpected(corners.error());
  Mesh mesh;
  mesh.name = path.stem().string();
  double size = 0;
  for (const float x : *corners) {
    if (!std::isfinite(x))
      return failure("mesh_not_finite", path.string(), "a vertex is not a finite number");
    size = std::max(size, std::abs(static_cast<double>(x)));
  }
  if (!(size > 0)) size = 1;
  Merger merger(mesh, size * unit * 1e-7);  // what floats tell apart
  for (std::size_t k = 0; k < corners->size(); k += 9) {
    std::array<int, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const float* x = &(*corners)[k + 3 * i];
      triangle[i] = merger.index(Vec3<double>(x[0], x[1], x[2]) * unit);
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

Expected<void> write_stl(const Mesh& mesh, const std::filesystem::path& path) {
  std::string bytes(80, ' ');
  const std::string head = "binary STL of sinew [mm]: " + mesh.name.substr(0, 50);
  bytes.replace(0, head.size(), head);
  const auto put = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  const auto put_vector = [&](const Vec3<double>& v) {
    for (int i = 0; i < 3; ++i) put(static_cast<float>(v[i]));
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const Vec3<double> area = area_vector(mesh, t);
    const double size = std::sqrt(squared_norm(area));
    put_vector(size > 0 ? Vec3<double>(area / size) : Vec3<double>(0, 0, 0));
    for (const int i : t) put_vector(Vec3<double>(mesh.vertices[static_cast<std::size_t>(i)] * 1e3));
    put(std::uint16_t{0});
  }
  return write_text(bytes, path);
}

Mesh box_mesh(const Vec3<double>& size) {
  Mesh box{"box", {}, {}};
  for (int i = 0; i < 8; ++i)
    box.vertices.emplace_back((i & 1 ? 0.5 : -0.5) * size.x(), (i & 2 ? 0.5 : -0.5) * size.y(),
                              (i & 4 ? 0.5 : -0.5) * size.z());
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

namespace {
/// Corners of a polygon around a circle that is nowhere farther from it than so.
int corners(double radius, double deviation) {
  const double half = std::acos(1 / (1 + deviation / radius));
  return std::clamp(static_cast<int>(std::ceil(std::numbers::pi / half)), 8, 720);
}
}  // namespace

Mesh sphere_mesh(double radius, double deviation) {
  // two polygons, one of the meridians and one of the parallels: each takes half of what is allowed
  const int around = corners(radius, deviation / 2), down = around / 2;
  const double pi = std::numbers::pi;
  const double outer = radius / (std::cos(pi / around) * std::cos(pi / (2 * down)));
  Mesh ball{"sphere", {}, {}};
  ball.vertices.emplace_back(0, 0, outer);
  for (int k = 1; k < down; ++k)
    for (int i = 0; i < around; ++i) {
      const double polar = pi * k / down, turn = 2 * pi * i / around;
      ball.vertices.emplace_back(outer * std::sin(polar) * std::cos(turn),
                                 outer * std::sin(polar) * std::sin(turn), outer * std::cos(polar));
    }
  ball.vertices.emplace_back(0, 0, -outer);
  const int south = static_cast<int>(ball.vertices.size()) - 1;
  const auto at = [&](int k, int i) { return 1 + (k - 1) * around + i % around; };
  for (int i = 0; i < around; ++i) {
    ball.triangles.push_back({0, at(1, i), at(1, i + 1)});
    ball.triangles.push_back({south, at(down - 1, i + 1), at(down - 1, i)});
    for (int k = 1; k + 1 < down; ++k) {
      ball.triangles.push_back({at(k, i), at(k + 1, i), at(k + 1, i + 1)});
      ball.triangles.push_back({at(k, i), at(k + 1, i + 1), at(k, i + 1)});
    }
  }
  return ball;
}

Mesh cylinder_mesh(double radius, double length, double deviation) {
  const int around = corners(radius, deviation);
  const double outer = radius / std::cos(std::numbers::pi / around);
  Mesh bar{"cylinder", {}, {}};
  for (const double z : {-length / 2, length / 2})
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * std::numbers::pi * i / around;
      bar.vertices.emplace_back(outer * std::cos(turn), outer * std::sin(turn), z);
    }
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    bar.triangles.push_back({i, next, around + next});
    bar.triangles.push_back({i, around + next, around + i});
    if (i > 0 && next > 0) {
      bar.triangles.push_back({0, next, i});
      bar.triangles.push_back({around, around + i, around + next});
    }
  }
  return bar;
}

Mesh moved(Mesh mesh, const SE3<double>& pose) {
  for (Vec3<double>& p : mesh.vertices) p = pose.point(p);
  return mesh;
}

}  // namespace sinew::inline v1
