#include <gtest/gtest.h>

#include <Eigen/LU>

#include "planar_modes_cases.hpp"
#include "reference_file.hpp"

namespace sinew::test {
namespace planar_modes_test {

Point json_point(const nlohmann::json& json) { return {json[0].get<double>(), json[1].get<double>()}; }

/// Newton from many starts on the closures as printed, in (x, y, φ).
std::vector<PlanarPose> multi_start(const Legs& legs, int starts, std::mt19937& random, double size = 1) {
  std::vector<PlanarPose> found;
  for (int n = 0; n < starts; ++n) {
    Eigen::Vector3d x(uniform(random, -2, 2) * size, uniform(random, -2, 2) * size, uniform(random, -pi, pi));
    double last = 1;
    for (int i = 0; i < 30 && last > 1e-14 * size; ++i) {
      Eigen::Vector3d g;
      Eigen::Matrix3d J;
      const auto platform = SE2<double>::from(x[0], x[1], x[2]);
      for (int k = 0; k < 3; ++k) {
        const auto& leg = legs[static_cast<std::size_t>(k)];
        const Point arm = platform.rotate(leg.platform_point), n_leg = platform.p + arm - leg.anchor;
        g[k] = 0.5 * (n_leg.squaredNorm() - leg.distance * leg.distance);
        J.row(k) << n_leg.x(), n_leg.y(), cross(arm, n_leg);
      }
      const Eigen::Vector3d step = J.partialPivLu().solve(g);
      last = step.head<2>().norm();
      x -= step;
      if (!x.allFinite()) break;
    }
    const PlanarPose pose{x[0], x[1], std::isfinite(x[2]) ? wrap_angle(x[2]) : 0};
    if (!x.allFinite() || !(error(legs, pose) < 1e-11 * size)) continue;
    if (std::none_of(found.begin(), found.end(), [&](const auto& p) { return gap(p, pose) < 1e-6; }))
      found.push_back(pose);
  }
  return found;
}

TEST(PlanarModes, AreThoseOfTheReference) {  // @verifies TDPCR (42)
  const auto& reference = test::reference_file("data/tdpcr/fk.json");
  int cases = 0;
  for (const auto& [name, robot] : reference.items()) {
    if (name == "6-UFS") continue;
    for (const auto& one : robot["cases"]) {
      Legs legs(3);
      for (std::size_t i = 0; i < 3; ++i)
        legs[i] = {json_point(one.contains("b_points") ? one["b_points"][i] : robot["a"][i]),
                   one["lengths"][i].get<double>(), json_point(robot[robot.contains("c") ? "c" : "b"][i])};
      const PlanarModes modes = planar_modes(legs);
      ASSERT_TRUE(modes.ok()) << name << modes.report.message.view();
      EXPECT_EQ(modes.count, static_cast<int>(one["solutions"].size())) << name;
      EXPECT_LT(modes.report.residual, 1e-15);
      for (const auto& s : one["solutions"])
        EXPECT_LT(miss(modes, {s["x"].get<double>(), s["y"].get<double>(), s["phi"].get<double>()}), 1e-12);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 15);
}

TEST(PlanarModes, AlwaysHoldTheTruePoseInAnyUnit) {
  std::mt19937 random{1};
  for (int sample = 0; sample < 20000; ++sample) {
    const double unit = std::pow(10.0, uniform(random, -6, 6));
    Legs legs = random_legs(random, 3, std::pow(10.0, uniform(random, -2, 1)));
    PlanarPose truth = any_pose(random);
    for (auto& leg : legs) {
      leg.anchor *= unit;
      leg.platform_point *= unit;
    }
    truth.x *= unit;
    truth.y *= unit;
    set_distances(legs, truth);
    PlanarModes modes = planar_modes(legs);
    ASSERT_TRUE(modes.ok()) << sample << modes.report.message.view();
    EXPECT_LT(modes.report.residual, 1e-13 * unit);
    EXPECT_TRUE(std::is_sorted(modes.poses.begin(), modes.poses.begin() + modes.count,
                               [](const auto& a, const auto& b) { return a.phi < b.phi - 1e-9; }));
    for (PlanarPose& pose : modes.poses) {
      pose.x /= unit;
      pose.y /= unit;
    }
    EXPECT_LT(miss(modes, {truth.x / unit, truth.y / unit, truth.phi}), 1e-8) << sample;
  }
}

TEST(PlanarModes, AreNeverFewerThanNewtonFinds) {
  std::mt19937 random{2};
  int more = 0, six = 0;
  for (int sample = 0; sample < 300; ++sample) {
    Legs legs = random_legs(random, 3);
    set_distances(legs, any_pose(random));
    const auto found = multi_start(legs, 1000, random);
    const PlanarModes modes = planar_modes(legs);
    EXPECT_GE(modes.count, static_cast<int>(found.size()));
    EXPECT_EQ(modes.count % 2, 0);  // but at a double root
    for (const auto& pose : found) EXPECT_LT(miss(modes, pose), 1e-7);
    more += modes.count > static_cast<int>(found.size());
    six += modes.count == 6;
  }
  EXPECT_LE(more, 5);
  EXPECT_GT(six, 5);
}

TEST(PlanarModes, OfConcentricSimilarTrianglesAreTheClosedForm) {  // at most four: the sextic factors
  std::mt19937 random{3};
  std::array<int, 5> seen{};
  for (int sample = 0; sample < 5000; ++sample) {
    const double base = 1, platform = uniform(random, 0.1, 0.9);
    Legs legs = example({0, 0, 0}, base, platform);
    set_distances(legs, any_pose(random));
    double S = 0;
    Point q(0, 0);
    for (const auto& leg : legs) S += leg.distance * leg.distance / 3;
    for (const auto& leg : legs) q += (leg.distance * leg.distance - S) / 3 * leg.anchor / base;
    const double root = std::sqrt(std::max(0.0, S * S / 4 - q.squaredNorm()));
    if (root < 1e-3) continue;
    std::vector<PlanarPose> closed;
    bool is_close = false;  // to the merging of two
    for (const double D : {S / 2 - root, S / 2 + root}) {
      const double cosine = (base * base + platform * platform - D) / (2 * base * platform);
      is_close |= std::abs(std::abs(cosine) - 1) < 1e-4;
      if (std::abs(cosine) >= 1) continue;
      for (const double psi : {std::acos(cosine), -std::acos(cosine)}) {
        Eigen::Matrix2d M;
        M << platform / base * std::cos(psi) - 1, -platform / base * std::sin(psi),
            platform / base * std::sin(psi), platform / base * std::cos(psi) - 1;
        const Eigen::Vector2d p = M.transpose().inverse() * q / base;
        closed.push_back({p.x(), p.y(), psi + pi / 3});
      }
    }
    if (is_close) continue;
    const PlanarModes modes = planar_modes(legs);
    ASSERT_EQ(modes.count, static_cast<int>(closed.size()));
    ++seen[closed.size()];
    for (const auto& pose : closed) EXPECT_LT(miss(modes, pose), 1e-9);
  }
  EXPECT_GT(seen[2], 100);
  EXPECT_GT(seen[4], 100);
}

TEST(PlanarModes, CanBeSix) {
  const Legs legs{
      {{0, 0}, 0.144, {-0.04, -0.03}}, {{0.16, 0}, 0.097, {0.07, -0.01}}, {{0.03, 0.14}, 0.196, {0, 0.05}}};
  const PlanarModes modes = planar_modes(legs);
  EXPECT_EQ(modes.count, 6);
  EXPECT_LT(error(legs, modes.poses[3]), 1e-15);
  EXPECT_EQ(modes.residual[3], error(legs, modes.poses[3]));
}

TEST(PlanarModes, AtHomeOfTheExampleAreMirrorImages) {
  Legs legs = example({0, 0, 0});
  set_distances(legs, {0, 0, 0});
  const PlanarModes modes = planar_modes(legs);
  ASSERT_EQ(modes.count, 2);
  EXPECT_LT(miss(modes, {0, 0, 0}), 1e-14);
  EXPECT_LT(miss(modes, {0, 0, 2 * pi / 3}), 1e-14);
}

TEST(PlanarModes, MergeAtATypeTwoSingularity) {  // TDPCR 5.1, last pose
  for (const double psi : {1e-1, 1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 0.0}) {
    Legs legs = example({0, 0, 0});
    set_distances(legs, {0.03, 0, pi / 3 + psi});
    const PlanarModes modes = planar_modes(legs);
    ASSERT_TRUE(modes.ok());
    EXPECT_EQ(modes.count, psi > 5e-7 ? 2 : 1) << psi;
    EXPECT_LT(miss(modes, {0.03, 0, pi / 3 + psi}), psi > 5e-7 ? 1e-9 : 3e-7) << psi;
    EXPECT_EQ(modes.is_double[0], psi < 1e-4) << psi;
  }
}

TEST(PlanarModes, HalfATurnIsAnOrdinaryAngle) {
  std::mt19937 random{4};
  for (int sample = 0; sample < 1000; ++sample) {
    Legs legs = random_legs(random, 3);
    const PlanarPose truth{uniform(random, -1, 1), uniform(random, -1, 1), pi};
    set_distances(legs, truth);
    EXPECT_LT(miss(planar_modes(legs), truth), 1e-9);
  }
}

}  // namespace planar_modes_test
}  // namespace sinew::test
