/// Rods as fields of tangents: their linear algebra against differences, their equilibria against the plane
/// elastica and against balances of the whole.
#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/rods/solve.hpp"
#include "robot/rods/tangent_kernels.hpp"
#include "rod_robots.hpp"

namespace sinew::test {
namespace tangent_system_test {

/// What a rod may do beside bending, and how its tip is held.
struct Kind {
  const char* name;
  bool clamped, cosserat, heavy;
};
constexpr Kind kinds[] = {
    {"ball, Kirchhoff", false, false, false},        {"ball, Kirchhoff, weight", false, false, true},
    {"ball, Cosserat, weight", false, true, true},   {"clamp, Kirchhoff", true, false, false},
    {"clamp, Kirchhoff, weight", true, false, true}, {"clamp, Cosserat, weight", true, true, true}};
const Vec3<double> gravity(3, -2, -9);

/// A random robot of such rods. Shear and stretch are exaggerated, so that tests see them.
RodRobot robot_of(const Kind& kind, RodRandom& random, int rods = 6) {
  RodRobot robot = random.robot(rods, 0.2);
  for (RodLeg& leg : robot.legs) {
    leg.is_clamped = kind.clamped;
    leg.platform_tangent = (Vec3<double>(0, 0, 1) + random.vector(0.2)).normalized();
    leg.link.is_cosserat = kind.cosserat;
    if (kind.cosserat) {  // EI stays: a thick rod of something soft
      leg.link.youngs_modulus *= 1e-4;
      leg.link.diameter *= 10;
      leg.link.shear_modulus = leg.link.youngs_modulus / 2.6;
    }
    leg.link.density = kind.heavy ? 0.1 / (9 * leg.link.area()) : 0;  // 0.1 N/m under some 9 m/s²
  }
  return robot;
}

/// A system at rest at a random pose, lengths changed a little: nothing about it is special.
bool begin(TangentSystem& system, const RodRobot& robot, RodRandom& random) {
  system.set_gravity(gravity);
  if (!system.rest_at(random.near(home(robot), 0.03, 0.15))) return false;
  for (int k = 0; k < system.limbs(); ++k)
    system.set_feed(k, system.length(k) * (1 + random.uniform(0, 3e-3)));
  return close_rods(system) && balance(system);
}

TEST(TangentSystem, FactorsAreTheDerivativesOfTheGaps) {
  constexpr int elements = 3, tip = elements * TangentState::degree;
  RodRandom random(3);
  TangentRods rods{};
  for (int i = 0; i < rod_lanes; ++i) {
    rods.length[i] = random.uniform(0.3, 0.5);
    rods.flexibility[i] = random.uniform(2, 4);
    rods.stretch[i] = random.uniform(-0.02, 0.02);
    rods.shear[i] = 0.02;
    rods.active[i] = 1;
    rods.clamped[i] = i % 2;
    for (int c = 0; c < 3; ++c)
      rods.force[c][i] = random.uniform(-2, 2), rods.weight[c][i] = random.uniform(-1, 1);
    const Vec3<double> a = random.vector(0.5), b = random.vector(0.5);
    for (int node = 0; node <= tip; ++node) {
      const double s = double(node) / tip;
      const Vec3<double> t = (Vec3<double>(0, 0, 1) + a * std::sin(2 * s) + b * s).normalized();
      for (int c = 0; c < 3; ++c) rods.tangent[node][c][i] = t[c];
      if (node == tip)
        for (int c = 0; c < 3; ++c) rods.platform_tangent[c][i] = t[c];
    }
  }
  RodPlatform platform{};
  platform.rotation[0] = platform.rotation[4] = platform.rotation[8] = 1;
  platform.position[2] = 0.35;
  RodSums sums{};
  const std::span<TangentRods> group(&rods, 1);
  tangent_kernels::evaluate(group, elements, platform, true, sums);
  tangent_kernels::linearise(group, elements, sums);
  const TangentRods at = rods;

  constexpr int n = 2 * tip;
  for (const int lane : {0, 1, 5}) {
    Eigen::MatrixXd L = Eigen::MatrixXd::Identity(n, n), D = Eigen::MatrixXd::Zero(n, n);
    for (int node = 1; node <= tip; ++node) {
      const int first = TangentRods::first_of(node), row = TangentRods::row_of(node), r = 2 * (node - 1);
      for (int k = 0; k < node - first; ++k)
        for (int q = 0; q < 4; ++q) L(r + q / 2, 2 * (first + k - 1) + q % 2) = at.lower[row + k][q][lane];
      if (node == tip) {
        D(r, r) = at.tip_pivot[0][lane];
        D(r, r + 1) = D(r + 1, r) = at.tip_pivot[1][lane];
        D(r + 1, r + 1) = at.tip_pivot[2][lane];
      } else {
        L(r + 1, r) = at.inner[node][lane];
        D(r, r) = 1 / at.pivot[node][0][lane];
        D(r + 1, r + 1) = 1 / at.pivot[node][1][lane];
      }
    }
    const Eigen::MatrixXd H = L * D * L.transpose();
    const auto vector = [&](const RodLane* v) { return Vec3<double>(v[0][lane], v[1][lane], v[2][lane]); };
    const auto put = [&](const Vec3<double>& v, RodLane* to) {
      for (int c = 0; c < 3; ++c) to[c][lane] = v[c];
    };
    for (int node = 1; node < tip; ++node)
      for (int q = 0; q < 2; ++q) {
        Eigen::VectorXd column = Eigen::VectorXd::Zero(n);
        constexpr double h = 1e-5;
        for (const int sign : {-1, 1}) {
          rods = at;
          const Vec3<double> t = vector(at.tangent[node]),
                             to = (t + sign * h * vector(at.across[node][q])).normalized();
          put(to, rods.tangent[node]);
          for (int w = 0; w < 2; ++w) {  // the frame goes along by the least turn
            const Vec3<double> e = vector(at.across[node][w]);
            put(e - (t + to) * (dot(e, to) / (1 + dot(t, to))), rods.across[node][w]);
          }
          tangent_kernels::evaluate(group, elements, platform, false, sums);
          for (int r = 0; r < n; ++r) column[r] += sign * rods.gap[r / 2 + 1][r % 2][lane] / (2 * h);
        }
        EXPECT_LT((column - H.col(2 * (node - 1) + q)).lpNorm<Eigen::Infinity>(), 3e-7);
      }
  }
}

TEST(TangentSystem, StiffnessAndFeedAreTheDerivativesOfTheWrench) {
  for (const Kind& kind : kinds) {
    RodRandom random(11);
    int tried = 0;
    for (int sample = 0; sample < 4; ++sample) {
      const RodRobot robot = robot_of(kind, random);
      TangentSystem system(robot);
      if (!begin(system, robot, random)) continue;
      ++tried;
      const LimbState from = system.state();
      const Mat<double, 6, 6> stiffness = system.stiffness();
      Mat<double, 6, 6> feed;
      for (int c = 0; c < 6; ++c) feed.col(c) = system.input_wrench_jacobian(c);
      Mat<double, 6, 6> by_twist, by_length;
      for (int c = 0; c < 6; ++c) {
        const auto beside = [&](double h) {
          return wrench_beside(system, from, Vec<double, 6>(Vec<double, 6>::Unit(c) * h));
        };
        const auto fed = [&](double h) {
          std::array<double, 6> more{};
          more[std::size_t(c)] = h;
          return wrench_beside(system, from, Vec<double, 6>::Zero(), more);
        };
        constexpr double h = 5e-6;
        by_twist.col(c) = (8 * (beside(h) - beside(-h)) - (beside(2 * h) - beside(-2 * h))) / (12 * h);
        by_length.col(c) = (8 * (fed(h) - fed(-h)) - (fed(2 * h) - fed(-2 * h))) / (12 * h);
      }
      const double size = stiffness.cwiseAbs().maxCoeff();
      EXPECT_LT((by_twist - stiffness).cwiseAbs().maxCoeff() / size, 1e-6) << kind.name;
      EXPECT_LT((by_length - feed).cwiseAbs().maxCoeff() / feed.cwiseAbs().maxCoeff(), 1e-6) << kind.name;
    }
    EXPECT_GE(tried, 3) << kind.name;
  }
}

TEST(TangentSystem, BallJointsAndNoWeightMakeElasticas) {
  RodRandom random(5);
  int tried = 0;
  for (int sample = 0; sample < 20; ++sample) {
    const RodRobot robot = robot_of(kinds[0], random, 6);
    TangentSystem system(robot);
    if (!begin(system, robot, random)) continue;
    ++tried;
    while (!system.is_finest()) system.refine();
    ASSERT_TRUE(close_rods(system));
    for (int k = 0; k < 6; ++k)
      EXPECT_LT(off_elastica(planar_state(system.rod(k), robot.legs[std::size_t(k)])), 1e-10);
  }
  EXPECT_GE(tried, 15);
}

TEST(TangentSystem, SolvesTheTripodsAsThePlaneRodsDo) {
  for (const RodTripod& t : {g1, g2}) {
    const RodRobot robot = tripod_robot(t);
    RodWork plane = work_of<ElasticaSystem>(robot);
    RodWork spatial = work_of<TangentSystem>(robot);
    RodRandom random(9);
    for (int sample = 0; sample < 20; ++sample) {
      std::array<double, 3> inputs;
      for (double& length : inputs) length = t.length + random.uniform(-0.02, 0.02);
      RodQuestion question;
      question.wrench = random.wrench(5, 0.2);
      const Report a = solve_rods(plane, home(robot), inputs, question);
      const Report b = solve_rods(spatial, home(robot), inputs, question);
      ASSERT_TRUE(a.ok() && b.ok()) << a.message.view() << b.message.view();
      EXPECT_LT((plane.system->platform().p - spatial.system->platform().p).norm(), 1e-12);
      EXPECT_LT((plane.system->platform().R.matrix() - spatial.system->platform().R.matrix()).norm(), 1e-11);
      const Mat<double, 6, 6> difference = plane.system->stiffness() - spatial.system->stiffness();
      EXPECT_LT(difference.norm(), 1e-8 * plane.system->stiffness().norm());
      EXPECT_EQ(unstable_directions(*plane.system), unstable_directions(*spatial.system));
      for (int k = 0; k < 6; ++k) {
        const RodResult p = plane.system->rod(k), s = spatial.system->rod(k);
        EXPECT_LT((p.force - s.force).norm(), 1e-8);
        EXPECT_LT((p.curvature_0 - s.curvature_0).norm(), 1e-8);
        EXPECT_NEAR(p.energy, s.energy, 1e-11);
        EXPECT_NEAR(p.tip_angle, s.tip_angle, 1e-10);
        EXPECT_NEAR(p.largest_curvature, s.largest_curvature, 2e-2 * p.largest_curvature);
      }
    }
  }
}

/// What unloading a platform gives back: the wrench is the derivative of elastic energy and weight.
TEST(TangentSystem, ForcesDoTheWorkOfTheEnergy) {
  for (const Kind& kind : kinds) {
    RodRandom random(21);
    const RodRobot robot = robot_of(kind, random);
    TangentSystem system(robot);
    ASSERT_TRUE(begin(system, robot, random)) << kind.name;
    const LimbState from = system.state();
    const Wrench6 held = system.wrench();
    const auto energy = [&] {
      double sum = system.weight_energy();
      for (int k = 0; k < system.limbs(); ++k) sum += system.rod(k).energy;
      return sum;
    };
    for (int c = 0; c < 6; ++c) {
      const auto beside = [&](double h) {
        wrench_beside(system, from, Vec<double, 6>(Vec<double, 6>::Unit(c) * h));
        return energy();
      };
      constexpr double h = 2e-5;
      const double slope = (8 * (beside(h) - beside(-h)) - (beside(2 * h) - beside(-2 * h))) / (12 * h);
      EXPECT_NEAR(slope, held[c], 1e-6 * (1 + held.cwiseAbs().maxCoeff())) << kind.name << c;
    }
  }
}

TEST(TangentSystem, BasesAndPlatformCarryTheWeight) {
  for (const Kind& kind : kinds) {
    RodRandom random(31);
    const RodRobot robot = robot_of(kind, random);
    TangentSystem system(robot);
    ASSERT_TRUE(begin(system, robot, random)) << kind.name;
    while (!system.is_finest()) system.refine();
    ASSERT_TRUE(close_rods(system));
    for (int k = 0; k < system.limbs(); ++k) {
      const RodResult rod = system.rod(k);
      const RodLeg& leg = robot.legs[std::size_t(k)];
      const Vec3<double> weight = gravity * leg.link.mass_per_length() * rod.length;
      EXPECT_LT((rod.force_0 - rod.force - weight).norm(), 1e-12);
      EXPECT_LT(std::abs(dot(rod.moment_0, leg.tangent())), 1e-12);  // free to spin
      EXPECT_LT(std::abs(dot(rod.moment, system.platform().R.rotate(leg.platform_tangent))), 1e-12);
      // the moment at the base bends it there: EI κ, by the slope of the tangents
      const auto line = system.centreline(k, 2001);
      const Vec3<double> bend = (line[2] - 2 * line[1] + line[0]) * (4e6 / (rod.length * rod.length));
      if (!kind.cosserat) {
        EXPECT_LT((cross(leg.tangent(), bend) - rod.curvature_0).norm(), 0.02 * (1 + rod.curvature_0.norm()));
      }
      EXPECT_LT((line.back() - rod.tip).norm(), 1e-9);
    }
  }
}

/// The nearest critical loads of a column whose tip is held, [Euler]: 4π² EI/L² between clamps, 20.1907 EI/L²
/// with a ball joint. The rod is stiff along its axis, but not rigid.
TEST(TangentSystem, ColumnsBuckleAtTheirCriticalLoads) {
  for (const bool clamped : {false, true}) {
    RodLeg leg = rod_leg({0, 0, 0}, {0, 0, 0}, 0.3);
    leg.is_clamped = clamped;
    leg.link.is_cosserat = true;
    leg.link.shear_modulus = leg.link.youngs_modulus / 2.6;
    const RodRobot robot({leg}, pose_of(level(0.4)), 0.1);
    TangentSystem system(robot);
    system.set_platform(level(0.4));
    ASSERT_TRUE(system.draw_rods());
    const double critical = (clamped ? 39.4784176 : 20.1907286) * 0.3 / (0.4 * 0.4);
    for (const double part : {0.2, 0.99, 1.01}) {
      const double load = part * critical;
      system.set_feed(0, 0.4 / (1 - load * (leg.link.stretch_compliance() + leg.link.shear_compliance())));
      ASSERT_TRUE(close_rods(system));
      system.linearise();
      EXPECT_NEAR(system.rod(0).axial_force, -load, 1e-3 * load);
      EXPECT_EQ(system.unstable_with_tip_held(0)[0], part < 1 ? 0 : 2) << part;  // either way aside
    }
  }
}

TEST(TangentSystem, ElementsConvergeAsTheEstimateSays) {
  RodRandom random(41);
  int compared = 0;
  for (int sample = 0; sample < 20; ++sample) {
    const RodRobot robot = robot_of(kinds[3 + sample % 3], random);
    TangentSystem system(robot);
    if (!begin(system, robot, random)) continue;
    while (system.is_fine()) system.coarsen();
    std::vector<double> estimates;
    std::vector<Wrench6> wrenches;
    for (;; system.refine()) {
      ASSERT_TRUE(close_rods(system));
      balance(system);
      estimates.push_back(system.truncation());
      wrenches.push_back(system.wrench());
      if (system.is_finest()) break;
    }
    const double stiffness = system.stiffness().topLeftCorner(3, 3).norm();
    for (std::size_t k = 0; k + 1 < wrenches.size(); ++k) {
      // an error of the tips, over the length, as forces
      const double off =
          (wrenches[k] - wrenches.back()).head<3>().norm() / (6 * stiffness * system.length(0));
      EXPECT_LT(off, 2 * estimates[k] + 1e-13);
      ++compared;
    }
  }
  EXPECT_GT(compared, 40);
}

TEST(TangentSystem, CoordinatesHoldTheState) {
  RodRandom random(51);
  const RodRobot robot = robot_of(kinds[5], random);
  TangentSystem system(robot), other(robot);
  ASSERT_TRUE(begin(system, robot, random));
  while (system.elements() < TangentSystem::coordinate_elements) system.refine();
  ASSERT_TRUE(close_rods(system) && balance(system));
  std::vector<double> coordinates(6 * RodLeg::coordinates);
  for (int k = 0; k < 6; ++k)
    system.get_rod(k,
                   std::span(coordinates).subspan(std::size_t(k) * RodLeg::coordinates, RodLeg::coordinates));
  other.set_gravity(gravity);
  other.set_platform(system.platform());
  other.set_wrench(system.wrench());
  other.set_rods(coordinates);
  EXPECT_LT(other.evaluate(), 1e-9);
}

}  // namespace tangent_system_test
}  // namespace sinew::test
