#include "plan/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace sinew::inline v1 {
namespace {
constexpr int leaf_size = 4;
constexpr int stack_size = 128;  // a tree of halves has log2 of the triangles' number levels

std::size_t index(int i) { return static_cast<std::size_t>(i); }
}  // namespace

double TriangleTree::Box::distance(const Vec3<double>& p) const {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double out = std::max({low[i] - p[i], 0.0, p[i] - high[i]});
    sum += out * out;
  }
  return sum;
}

TriangleTree::TriangleTree(const Mesh& mesh) : mesh_(&mesh) {
  const std::size_t count = mesh.triangles.size();
  const auto at = [&](std::size_t t, std::size_t i) { return mesh.vertices[index(mesh.triangles[t][i])]; };
  std::vector<Vec3<double>> middles(count);
  face_normals_.resize(count);
  across_.assign(count, {-1, -1, -1});
  vertex_normals_.assign(mesh.vertices.size(), Vec3<double>(0, 0, 0));
  std::unordered_map<std::uint64_t, std::pair<int, int>> sides;  // an edge's first triangle, and which side
  sides.reserve(count * 3 / 2 + 1);
  for (std::size_t t = 0; t < count; ++t) {
    const Vec3<double> normal = cross(Vec3<double>(at(t, 1) - at(t, 0)), Vec3<double>(at(t, 2) - at(t, 0)));
    face_normals_[t] = normal / std::sqrt(squared_norm(normal));
    middles[t] = (at(t, 0) + at(t, 1) + at(t, 2)) / 3;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3<double> one = at(t, (i + 1) % 3) - at(t, i), other = at(t, (i + 2) % 3) - at(t, i);
      const double angle = std::atan2(std::sqrt(squared_norm(cross(one, other))), dot(one, other));
      vertex_normals_[index(mesh.triangles[t][i])] += angle * face_normals_[t];
      const auto a = static_cast<std::uint64_t>(mesh.triangles[t][i]),
                 b = static_cast<std::uint64_t>(mesh.triangles[t][(i + 1) % 3]);
      const auto [side, is_new] =
          sides.try_emplace(a < b ? a << 32 | b : b << 32 | a, static_cast<int>(t), static_cast<int>(i));
      if (is_new) continue;
      const auto [neighbour, its_side] = side->second;
      across_[t][i] = neighbour;
      across_[index(neighbour)][index(its_side)] = static_cast<int>(t);
    }
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(2 * count / leaf_size + 2);
  nodes_.emplace_back();
  build(0, 0, static_cast<int>(count), middles, order_);
  for (const int t : order_)
    corners_.push_back(
        {at(index(t), 0), at(index(t), 1) - at(index(t), 0), at(index(t), 2) - at(index(t), 0)});
}

void TriangleTree::build(int node, int first, int count, std::vector<Vec3<double>>& middles,
                         std::vector<int>& order) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Box box{{inf, inf, inf}, {-inf, -inf, -inf}};
  Vec3<double> low(inf, inf, inf), high(-inf, -inf, -inf);
  for (int k = first; k < first + count; ++k) {
    const int t = order[index(k)];
    for (const int v : mesh_->triangles[index(t)])
      for (int i = 0; i < 3; ++i) {
        const double x = mesh_->vertices[index(v)][i];
        box.low[i] = std::min(box.low[i], x), box.high[i] = std::max(box.high[i], x);
      }
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], middles[index(t)][i]);
      high[i] = std::max(high[i], middles[index(t)][i]);
    }
  }
  nodes_[index(node)].box = box;
  if (count <= leaf_size) {
    nodes_[index(node)].first = first, nodes_[index(node)].count = count;
    return;
  }
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
  const auto begin = order.begin() + first, half = begin + count / 2;
  std::nth_element(begin, half, begin + count,
                   [&](int a, int b) { return middles[index(a)][axis] < middles[index(b)][axis]; });
  const int child = static_cast<int>(nodes_.size());
  nodes_[index(node)].first = child;
  nodes_.emplace_back(), nodes_.emplace_back();
  build(child, first, count / 2, middles, order);
  build(child + 1, first + count / 2, count - count / 2, middles, order);
}

/// Point of a triangle that is nearest, by the region of its plane: Ericson, Real-Time Collision Detection,
/// section 5.1.5.
void TriangleTree::closest(const Corner& t, const Vec3<double>& p, Found& best, int place) {
  const Vec3<double> ap = p - t.a;
  const double d1 = dot(t.ab, ap), d2 = dot(t.ac, ap);
  const double bb = squared_norm(t.ab), cc = squared_norm(t.ac), bc = dot(t.ab, t.ac);
  const double d3 = d1 - bb, d4 = d2 - bc, d5 = d1 - bc, d6 = d2 - cc;
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  double u = 0, v = 0;
  int feature = 0;
  if (d1 <= 0 && d2 <= 0) {
    feature = 4;
  } else if (d3 >= 0 && d4 <= d3) {
    u = 1, feature = 5;
  } else if (d6 >= 0 && d5 <= d6) {
    v = 1, feature = 6;
  } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    u = d1 / (d1 - d3), feature = 1;
  } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    v = d2 / (d2 - d6), feature = 3;
  } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    v = (d4 - d3) / ((d4 - d3) + (d5 - d6)), u = 1 - v, feature = 2;
  } else {
    const double whole = 1 / (va + vb + vc);
    u = vb * whole, v = vc * whole;
  }
  const Vec3<double> at = t.a + u * t.ab + v * t.ac;
  const double squared = squared_norm(Vec3<double>(p - at));
  if (squared < best.squared) best = {squared, at, place, feature};
}

void TriangleTree::search(const Vec3<double>& point, Found& best) const {
  struct Waiting {
    int node;
    double distance;
  };
  std::array<Waiting, stack_size> stack;
  int size = 0;
  stack[0] = {0, nodes_.front().box.distance(point)};
  for (size = 1; size > 0;) {
    const Waiting next = stack[index(--size)];
    if (!(next.distance < best.squared)) continue;
    const Node& node = nodes_[index(next.node)];
    if (node.count > 0) {
      for (int k = node.first; k < node.first + node.count; ++k) closest(corners_[index(k)], point, best, k);
      continue;
    }
    Waiting near{node.first, nodes_[index(node.first)].box.distance(point)};
    Waiting far{node.first + 1, nodes_[index(node.first + 1)].box.distance(point)};
    if (far.distance < near.distance) std::swap(near, far);
    if (far.distance < best.squared) stack[index(size++)] = far;
    if (near.distance < best.squared) stack[index(size++)] = near;
  }
}

/// By which the side of a closed surface is told even where the nearest point is on an edge or a corner:
/// J. A. Bærentzen, H. Aanæs, IEEE TVCG 11 (2005) 243.
Vec3<double> TriangleTree::normal_of(const Found& found) const {
  const int t = order_[index(found.place)];
  if (found.feature == 0) return face_normals_[index(t)];
  if (found.feature <= 3) {
    const int other = across_[index(t)][index(found.feature - 1)];
    return other < 0 ? face_normals_[index(t)]
                     : Vec3<double>(face_normals_[index(t)] + face_normals_[index(other)]);
  }
  return vertex_normals_[index(mesh_->triangles[index(t)][index(found.feature - 4)])];
}

Nearest TriangleTree::nearest(const Vec3<double>& point, double within) const {
  const double outside = nodes_.front().box.distance(point);
  if (outside > within * within) return {within, {0, 0, 0}, -1, -1};
  Found best{within * within, {0, 0, 0}, -1, 0};
  search(point, best);
  if (best.place < 0) {
    if (outside > 0) return {within, {0, 0, 0}, -1, -1};
    best.squared = std::numeric_limits<double>::infinity();  // it may be deep inside
    search(point, best);
  }
  const Vec3<double> gap = point - best.point, normal = normal_of(best);
  const double side = dot(gap, normal) < 0 ? -1 : 1, distance = std::sqrt(best.squared);
  if (side > 0 && distance > within) return {within, {0, 0, 0}, -1, -1};
  // on the surface itself the way out is that of the normal
  const Vec3<double> away = distance > 1e-12 ? Vec3<double>(gap * (side / distance))
                                             : Vec3<double>(normal / std::sqrt(squared_norm(normal)));
  return {side * distance, away, 0, order_[index(best.place)]};
}

Obstacles::Obstacles(std::span<const Mesh> meshes) {
  trees_.reserve(meshes.size());
  for (const Mesh& mesh : meshes) trees_.emplace_back(mesh);
}

Nearest Obstacles::nearest(const Vec3<double>& point, double within) const {
  Nearest best{within, {0, 0, 0}, -1, -1};
  for (std::size_t m = 0; m < trees_.size(); ++m) {
    // a solid that is deeper in than the best outside one has to be found as well
    const Nearest found = trees_[m].nearest(point, std::max(best.distance, 0.0));
    if (found.triangle < 0 || !(found.distance < best.distance)) continue;
    best = found;
    best.mesh = static_cast<int>(m);
  }
  return best;
}

}  // namespace sinew::inline v1
