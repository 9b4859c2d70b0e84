/// Signed distances by the tree against all triangles one by one.
#include "plan/obstacles.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scenes.hpp"
#include "thorough.hpp"

namespace sinew::test {
namespace obstacles_test {

TEST(Obstacles, DistancesAreThoseOfAllTriangles) {
  const std::vector<Mesh> solids = compressor_meshes(Compressor{});
  const Obstacles obstacles(solids);
  std::vector<Obstacles> alone;
  for (const Mesh& mesh : solids) alone.push_back(Obstacles({&mesh, 1}));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-0.03, 0.12), y(-0.04, 0.04), z(-0.01, 0.05);
  for (int sample = 0; sample < count_of(200, 5000); ++sample) {
    const Vec3<double> p(x(random), y(random), z(random));
    const Nearest found = obstacles.nearest(p, 1);
    // of several solids, inside of one, the deepest counts
    double slow = 1e9;
    for (const Obstacles& one : alone) slow = std::min(slow, one.nearest(p, 1).distance);
    EXPECT_NEAR(found.distance, slow, 1e-12);
    if (found.distance > 0) {
      EXPECT_NEAR(found.distance, slow_distance(p, solids), 1e-12);
    }
    EXPECT_NEAR(squared_norm(found.away), 1, 1e-9);
    // away from the surface it grows by as much
    const double h = 1e-7;
    EXPECT_NEAR((obstacles.nearest(p + h * found.away, 1).distance - found.distance) / h, 1, 0.05);
  }
}

TEST(Obstacles, SidesAreToldAtFacesEdgesAndCorners) {
  const Mesh box = box_mesh({2, 2, 2});
  const Obstacles obstacles({&box, 1});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-2, 2);
  for (int sample = 0; sample < 2000; ++sample) {
    const Vec3<double> p(u(random), u(random), u(random));
    const Vec3<double> out = (p.cwiseAbs() - Vec3<double>(1, 1, 1)).cwiseMax(0.0);
    const double inside = (p.cwiseAbs() - Vec3<double>(1, 1, 1)).maxCoeff();
    EXPECT_NEAR(obstacles.nearest(p, 10).distance, inside > 0 ? std::sqrt(squared_norm(out)) : inside, 1e-12);
  }
}

TEST(Obstacles, NothingIsFoundBeyondWhatWasAskedButInside) {
  const Mesh box = box_mesh({2, 2, 2});
  const Obstacles obstacles({&box, 1});
  EXPECT_EQ(obstacles.nearest({0, 0, 1.5}, 0.4).mesh, -1);
  EXPECT_EQ(obstacles.nearest({0, 0, 1.5}, 0.6).mesh, 0);
  EXPECT_EQ(obstacles.nearest({0, 0, 0.1}, 0.1).distance, -0.9);
}

}  // namespace obstacles_test
}  // namespace sinew::test
