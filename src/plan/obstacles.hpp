/// @file obstacles.hpp
/// Signed distance to the solids of a scene: a tree of boxes over the triangles of each mesh. Exact, without
/// a grid. Theory: docs/theory/insertion.md
#pragma once
#include <span>

#include "sinew/plan/scene.hpp"

namespace sinew::inline v1 {

/// The surface point that is nearest to a point.
struct Nearest {
  double distance = 0;           ///< [m], < 0 inside a solid
  Vec3<double> away{0, 0, 0};    ///< unit vector in which the distance grows; 0 where nothing was found
  int mesh = -1, triangle = -1;  ///< of the surface; −1: nothing within what was asked
};

/// Triangles of one mesh in a tree.
class TriangleTree {
 public:
  explicit TriangleTree(const Mesh& mesh);
  /// @param within nothing farther is looked for, unless the point may be inside the solid [m]
  Nearest nearest(const Vec3<double>& point, double within) const;
  double box_distance(const Vec3<double>& point) const { return nodes_.front().box.distance(point); }

 private:
  struct Box {
    double low[3], high[3];
    double distance(const Vec3<double>& p) const;  ///< squared
  };
  struct Node {
    Box box;
    int first = 0, count = 0;  ///< triangles of a leaf; count 0: the children are `first` and `first` + 1
  };
  struct Corner {
    Vec3<double> a, ab, ac;
  };
  struct Found {
    double squared;
    Vec3<double> point;
    int place = -1, feature = 0;  ///< 0: face; 1 to 3: edges ab, bc, ca; 4 to 6: corners
  };
  void build(int node, int first, int count, std::vector<Vec3<double>>& middles, std::vector<int>& order);
  void search(const Vec3<double>& point, Found& best) const;
  static void closest(const Corner& t, const Vec3<double>& p, Found& best, int place);
  Vec3<double> normal_of(const Found& found) const;

  const Mesh* mesh_;
  std::vector<Node> nodes_;
  std::vector<int> order_;                    ///< triangle at each place of the tree
  std::vector<Corner> corners_;               ///< in the order of the tree
  std::vector<Vec3<double>> face_normals_;    ///< of triangles, unit
  std::vector<std::array<int, 3>> across_;    ///< triangles at edges ab, bc, ca
  std::vector<Vec3<double>> vertex_normals_;  ///< weighted by angles
};

/// All meshes of a scene. The meshes must outlive it.
class Obstacles {
 public:
  explicit Obstacles(std::span<const Mesh> meshes);
  /// The least signed distance to any solid, that is to their union from outside.
  Nearest nearest(const Vec3<double>& point, double within) const;

 private:
  std::vector<TriangleTree> trees_;
};

}  // namespace sinew::inline v1
