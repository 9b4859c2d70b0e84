/// Points along an inserted robot: where they are, how they move, and how far at most.
#include "plan/body.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scenes.hpp"
#include "sinew/analysis/shape.hpp"
#include "thorough.hpp"

namespace sinew::test {
namespace body_test {

constexpr const char* robots[] = {"nottingham-tpcj", "nottingham-neutral"};

class Draws {
 public:
  explicit Draws(const InsertionScene& scene) : scene_(&scene) {}
  Posture posture(double size = 1) {
    Posture x{0.1 * unit_(random_)};
    for (const Section& section : scene_->robot.sections)
      for (int i = 0; i < 2; ++i)
        x.push_back(size * std::min(section.limit, 1.5) * (2 * unit_(random_) - 1) / 1.5);
    return x;
  }
  double unit() { return unit_(random_); }

 private:
  const InsertionScene* scene_;
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> unit_{0, 1};
};

std::vector<Bend> bends_of(const Posture& x) {
  std::vector<Bend> bends;
  for (std::size_t k = 1; k < x.size(); k += 2) bends.emplace_back(x[k], x[k + 1]);
  return bends;
}

TEST(Body, PointsAreThoseOfTheShape) {
  for (const char* name : robots) {
    InsertionScene scene = open_scene(name);
    scene.axis = Vec3<double>(0.6, 0, 0.8);
    scene.base.R = SO3<double>::exp(Vec3<double>(0.3, -0.2, 0.5));
    Body body(scene, 1);
    Draws draws(scene);
    for (const double size : {0.0, 1e-9, 1.0}) {
      const Posture x = draws.posture(size);
      body.place(x, false);
      const SerialShape shape = serial_shape(scene.robot, bends_of(x), 2);
      std::vector<Vec3<double>> all{shape.backbones[0][0]};
      for (const auto& line : shape.backbones) all.insert(all.end(), line.begin() + 1, line.end());
      ASSERT_EQ(all.size(), body.size()) << name;
      for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_LT(distance_of(body.point(i), scene.base.point(all[i]) + x[0] * scene.axis), 1e-14)
            << name << i;
      EXPECT_LT(distance_of(body.tip_direction(), scene.base.rotate(shape.ends.back().rotate({0, 0, 1}))),
                1e-13);
      EXPECT_NEAR(body.arc(body.size() - 1), scene.robot.length(), 1e-14);
    }
  }
}

TEST(Body, RatesAreTheDerivatives) {
  for (const char* name : robots) {
    const InsertionScene scene = open_scene(name);
    Body body(scene, 2e-3), before(scene, 2e-3), after(scene, 2e-3);
    Draws draws(scene);
    for (const double size : {0.0, 1e-6, 0.1, 1.0}) {
      const Posture x = draws.posture(size);
      body.place(x, true);
      for (std::size_t k = 0; k < x.size(); ++k) {
        Posture low = x, high = x;
        low[k] -= 1e-6, high[k] += 1e-6;
        before.place(low, false), after.place(high, false);
        for (std::size_t i = 0; i < body.size(); ++i)
          EXPECT_LT(distance_of((after.point(i) - before.point(i)) / 2e-6, body.rate(i, k)), 1e-9)
              << name << i << k;
        EXPECT_LT(
            distance_of((after.tip_direction() - before.tip_direction()) / 2e-6, body.tip_direction_rate(k)),
            1e-8);
        for (std::size_t i = 0; i < body.size(); ++i)
          if (k >= body.movers(i)) {
            EXPECT_EQ(squared_norm(body.rate(i, k)), 0);
          }
      }
    }
  }
}

TEST(Body, NoPointMovesFartherThanItsBound) {
  for (const char* name : robots) {
    const InsertionScene scene = open_scene(name);
    Body one(scene, 2e-3), other(scene, 2e-3);
    Draws draws(scene);
    double nearest = 0;
    for (int sample = 0; sample < count_of(100, 5000); ++sample) {
      const Posture from = draws.posture();
      Posture to = draws.posture();
      const double share = std::pow(10.0, -4 * draws.unit());
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[k] + share * (to[k] - from[k]);
      one.place(from, false);
      for (int part = 1; part <= 4; ++part) {
        Posture between = from;
        for (std::size_t k = 0; k < to.size(); ++k) between[k] += 0.25 * part * (to[k] - from[k]);
        other.place(between, false);
        for (std::size_t i = 0; i < one.size(); ++i) {
          const double moved = distance_of(one.point(i), other.point(i)),
                       bound = one.motion_bound(i, from, to);
          EXPECT_LE(moved, bound * (1 + 1e-9) + 1e-15) << name;
          if (bound > 0) nearest = std::max(nearest, moved / bound);
        }
      }
    }
    EXPECT_GT(nearest, 0.9) << name;  // and it is not far beyond
  }
}

TEST(Body, ArcsLeaveTheirChordsByLessThanTheirSagitta) {
  for (const char* name : robots) {
    const InsertionScene scene = open_scene(name);
    Body coarse(scene, 1), fine(scene, 1e-4);
    Draws draws(scene);
    const Posture x = draws.posture();
    coarse.place(x, false), fine.place(x, false);
    for (std::size_t i = 0; i + 1 < coarse.size(); ++i) {
      const Vec3<double> from = coarse.point(i), along = coarse.point(i + 1) - from;
      for (std::size_t k = 0; k < fine.size(); ++k) {
        if (fine.arc(k) < coarse.arc(i) || fine.arc(k) > coarse.arc(i + 1)) continue;
        const double t = dot(Vec3<double>(fine.point(k) - from), along) / squared_norm(along);
        EXPECT_LE(distance_of(fine.point(k), from + t * along), coarse.sagitta(i) * (1 + 1e-6) + 1e-12)
            << name << i;
      }
    }
  }
}

}  // namespace body_test
}  // namespace sinew::test
