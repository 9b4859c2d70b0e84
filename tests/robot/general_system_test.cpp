/// Rods that bear torque as legs: against rods without torque, against differences, against each rod by
/// itself, and against balances of the whole.
#include "robot/rods/general_system.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/rods/lengths_for_pose.hpp"
#include "kinematics/rods/solve.hpp"
#include "rod_robots.hpp"
#include "sanitizers.hpp"
#include "shooting_rod/rod_bvp.hpp"
#include "thorough.hpp"

namespace sinew::test {
namespace general_system_test {

/// What a rod may do beside bending, and how its ends are held.
struct Kind {
  const char* name;
  bool clamped, cosserat, heavy;
  bool held = false, tip_turns = false, strip = false, precurved = false, loaded = false;
};
constexpr Kind without_torque[] = {
    {"ball, Kirchhoff", false, false, false},
    {"ball, Cosserat, weight", false, true, true},
    {"clamp, Kirchhoff", true, false, false},
    {"clamp, Kirchhoff, weight", true, false, true},
    {"clamp, Cosserat, weight", true, true, true},
    {"held, clamp that turns", true, false, true, true, true},
    {"held, ball, load", false, false, false, true, false, false, false, true}};
constexpr Kind general[] = {
    {"held, clamp", true, false, false, true},
    {"held, clamp, weight, Cosserat", true, true, true, true},
    {"held, clamp, strip, load", true, false, false, true, false, true, false, true},
    {"held, clamp, precurved", true, false, false, true, false, false, true},
    {"held, ball, strip, Cosserat", false, true, false, true, false, true},
    {"held, ball, precurved, load", false, false, false, true, false, false, true, true},
    {"held, clamp that turns, strip, precurved", true, false, true, true, true, true, true},
    {"spins, clamp, strip, load", true, false, false, false, false, true, false, true},
    {"spins, clamp, precurved, weight", true, false, true, false, false, false, true},
    {"spins, ball, precurved", false, false, false, false, false, false, true}};
const Vec3<double> gravity(3, -2, -9);

/// A robot with such rods, whose tips lean by up to `lean`. Shear and stretch are exaggerated, so that tests
/// see them.
RodRobot with_rods_of(const Kind& kind, RodRobot robot, double lean, RodRandom& random) {
  for (RodLeg& leg : robot.legs) {
    const double stiffness = leg.link.bending_stiffness();
    leg.is_clamped = kind.clamped;
    leg.is_spin_held = kind.held;
    leg.is_tip_spin_free = kind.tip_turns;
    leg.platform_tangent = (Vec3<double>(0, 0, 1) + random.vector(lean)).normalized();
    const Vec3<double> across = leg.base.rotate(Vec3<double>(1, 0, 0)) + random.vector(1.5 * lean);
    leg.platform_across = cross(cross(leg.platform_tangent, across), leg.platform_tangent).normalized();
    leg.link.is_cosserat = kind.cosserat;
    const double thick = kind.cosserat ? 10 : 1;  // EI stays: a thick rod of something soft
    leg.link.diameter = kind.strip ? 0 : 3e-3 * thick;
    if (kind.strip) leg.link.width = 5e-3 * thick, leg.link.height = 3e-3 * thick;
    leg.link.youngs_modulus = 1;
    leg.link.youngs_modulus = stiffness / leg.link.bending_stiffness();
    leg.link.shear_modulus = leg.link.youngs_modulus / 2.6;
    leg.link.density = kind.heavy ? 0.1 / (9 * leg.link.area()) : 0;  // 0.1 N/m under some 9 m/s²
    if (kind.precurved) leg.link.precurvature = random.vector(0.8);
    if (kind.loaded) leg.link.load = random.vector(0.1);
  }
  return robot;
}
RodRobot robot_of(const Kind& kind, RodRandom& random) {
  return with_rods_of(kind, random.robot(6, 0.2), 0.2, random);
}
/// ... and one whose guides are upright and whose rods bend much: paths there do not fold.
RodRobot upright_of(const Kind& kind, RodRandom& random) {
  const RodRobot tripod = tripod_robot(g2);
  return with_rods_of(kind, RodRobot(tripod.legs, tripod.home, tripod.platform_radius), 0.03, random);
}

/// A system at rest at a random pose, lengths changed a little: nothing about it is special.
template <class System>
bool begin(System& system, const RodRobot& robot, RodRandom& random) {
  system.set_gravity(gravity);
  if (!system.rest_at(random.near(home(robot), 0.03, 0.15))) return false;
  for (int k = 0; k < system.limbs(); ++k)
    system.set_feed(k, system.length(k) * (1 + random.uniform(0, 3e-4)));
  return close_rods(system) && balance(system);
}

template <class System>
void finest(System& system) {
  while (!system.is_finest()) system.refine();
}

/// Samples of a kind: one under AddressSanitizer, where steps take ten times as long.
int samples(int usual) { return test::addresses_are_checked ? std::min(usual, 1) : usual; }

TEST(GeneralSystem, WithoutTorqueIsTheFieldOfTangents) {
  for (const Kind& kind : without_torque) {
    RodRandom random(3);
    int tried = 0;
    for (int sample = 0; sample < samples(3); ++sample) {
      const RodRobot robot = robot_of(kind, random);
      for (const RodLeg& leg : robot.legs) ASSERT_TRUE(leg.is_torque_free());
      TangentSystem tangents(robot);
      GeneralSystem rods(robot);
      if (!begin(tangents, robot, random)) continue;
      finest(tangents);
      if (!close_rods(tangents) || !balance(tangents)) continue;
      rods.set_gravity(gravity);
      ASSERT_TRUE(rods.rest_at(tangents.platform())) << kind.name;
      for (int k = 0; k < 6; ++k) rods.set_feed(k, tangents.length(k));
      finest(rods);
      ASSERT_TRUE(close_rods(rods) && balance(rods)) << kind.name;
      if (unstable_directions(tangents) != 0 || unstable_directions(rods) != 0) continue;  // other shapes
      ++tried;
      const auto near = [&](const auto& a, const auto& b, double tolerance, const char* what) {
        EXPECT_LT((a - b).cwiseAbs().maxCoeff(), tolerance * (1e-6 + b.cwiseAbs().maxCoeff()))
            << kind.name << ": " << what;
      };
      near(rods.wrench(), tangents.wrench(), 1e-9, "wrench");
      const Mat<double, 6, 6> a = rods.stiffness(), b = tangents.stiffness();
      near(a, b, 1e-9, "stiffness");
      EXPECT_NEAR(rods.weight_energy(), tangents.weight_energy(), 1e-10);
      for (int k = 0; k < 6; ++k) {
        near(rods.input_wrench_jacobian(k), tangents.input_wrench_jacobian(k), 1e-9, "feed");
        near(rods.effort_jacobian(k), tangents.effort_jacobian(k), 1e-8, "axial row");
        const RodResult p = rods.rod(k), q = tangents.rod(k);
        near(p.force, q.force, 1e-9, "force");
        near(p.force_0, q.force_0, 1e-9, "force at the base");
        near(p.moment, q.moment, 1e-8, "moment");
        near(p.moment_0, q.moment_0, 1e-8, "moment at the base");
        near(p.curvature_0, q.curvature_0, 1e-8, "curvature at the base");
        EXPECT_NEAR(p.energy, q.energy, 1e-10);
        EXPECT_NEAR(p.tip_angle, q.tip_angle, 1e-9);
        EXPECT_NEAR(p.lateral_force, q.lateral_force, 1e-8);
        EXPECT_NEAR(p.axial_force, q.axial_force, 1e-8);
        EXPECT_NEAR(rods.effort(k), tangents.effort(k), 1e-8);
        EXPECT_NEAR(p.largest_curvature, q.largest_curvature, 1e-2 * q.largest_curvature);
      }
    }
    EXPECT_GE(tried, samples(2)) << kind.name;
  }
}

TEST(GeneralSystem, ComesToRestWhereTheFieldOfTangentsDoes) {
  for (const Kind& kind : without_torque) {
    RodRandom random(7);
    int tried = 0;
    for (int sample = 0; sample < samples(2); ++sample) {
      const RodRobot robot = robot_of(kind, random);
      RodWork tangents = work_of<TangentSystem>(robot, gravity);
      RodWork rods = work_of<GeneralSystem>(robot, gravity);
      if (!tangents.system->rest_at(home(robot))) continue;
      std::array<double, 6> inputs;
      for (std::size_t k = 0; k < 6; ++k)
        inputs[k] = tangents.system->length(int(k)) + random.uniform(0, 5e-3);
      RodQuestion question;
      question.wrench = random.wrench(0.1, 0.01);
      const Report a = solve_rods(tangents, home(robot), inputs, question);
      const Report b = solve_rods(rods, home(robot), inputs, question);
      if (!a.ok()) continue;
      ++tried;
      ASSERT_TRUE(b.ok()) << kind.name << ": " << b.message.view();
      const SE3<double>&p = tangents.system->platform(), &q = rods.system->platform();
      EXPECT_LT((p.p - q.p).norm(), 1e-10) << kind.name;
      EXPECT_LT((p.R.matrix() - q.R.matrix()).norm(), 1e-9) << kind.name;
      EXPECT_EQ(unstable_directions(*tangents.system), unstable_directions(*rods.system)) << kind.name;
    }
    EXPECT_GE(tried, samples(1)) << kind.name;
  }
}

TEST(GeneralSystem, StiffnessAndFeedAreTheDerivativesOfTheWrench) {
  const int count = samples(test::count_of(1, 2));
  for (const Kind& kind : general) {
    RodRandom random(11);
    int tried = 0;
    for (int sample = 0; sample < count; ++sample) {
      const RodRobot robot = robot_of(kind, random);
      GeneralSystem system(robot);
      if (!begin(system, robot, random)) continue;
      ++tried;
      const LimbState from = system.state();
      const Mat<double, 6, 6> stiffness = system.stiffness();
      Mat<double, 6, 6> feed, rows;
      for (int c = 0; c < 6; ++c) feed.col(c) = system.input_wrench_jacobian(c);
      for (int c = 0; c < 6; ++c) rows.row(c) = system.effort_jacobian(c);
      Mat<double, 6, 6> by_twist, by_length, axial;
      for (int c = 0; c < 6; ++c) {
        const auto forces = [&] {
          Vec<double, 6> pulls;
          for (int k = 0; k < 6; ++k) pulls[k] = system.effort(k);
          return pulls;
        };
        using Both = Eigen::Matrix<double, 12, 1>;
        const auto beside = [&](double h) {
          Both both;
          both << wrench_beside(system, from, Vec<double, 6>(Vec<double, 6>::Unit(c) * h)), forces();
          return both;
        };
        const auto fed = [&](double h) {
          std::array<double, 6> more{};
          more[std::size_t(c)] = h;
          return wrench_beside(system, from, Vec<double, 6>::Zero(), more);
        };
        constexpr double h = 2e-5;
        const Both slope = (8 * (beside(h) - beside(-h)) - (beside(2 * h) - beside(-2 * h))) / (12 * h);
        by_twist.col(c) = slope.head<6>();
        axial.col(c) = slope.tail<6>();
        by_length.col(c) = (8 * (fed(h) - fed(-h)) - (fed(2 * h) - fed(-2 * h))) / (12 * h);
      }
      const double size = stiffness.cwiseAbs().maxCoeff();
      EXPECT_LT((by_twist - stiffness).cwiseAbs().maxCoeff() / size, 1e-6) << kind.name;
      EXPECT_LT((axial - rows).cwiseAbs().maxCoeff() / size, 1e-6) << kind.name;
      EXPECT_LT((by_length - feed).cwiseAbs().maxCoeff() / feed.cwiseAbs().maxCoeff(), 1e-6) << kind.name;
    }
    EXPECT_GE(tried, count) << kind.name;
  }
}

/// What unloading a platform gives back: the wrench is the derivative of elastic energy and weight.
TEST(GeneralSystem, ForcesDoTheWorkOfTheEnergy) {
  for (const Kind& kind : general) {
    RodRandom random(21);
    const RodRobot robot = robot_of(kind, random);
    GeneralSystem system(robot);
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

/// Rods integrated anew, as finely as they ask for, from what the answer says of their bases: they meet the
/// platform, and what they hand over is the wrench.
TEST(GeneralSystem, RodsIntegratedAnewBalanceThePlatform) {  // @verifies 3PFS (20)-(23)
  for (const Kind& kind : general) {
    RodRandom random(31);
    int tried = 0;
    for (int sample = 0; sample < samples(3); ++sample) {
      const RodRobot robot = upright_of(kind, random);
      RodWork work = work_of<GeneralSystem>(robot, gravity);
      RodGroup& system = *work.system;
      if (!system.rest_at(home(robot))) continue;
      std::array<double, 6> inputs;
      for (std::size_t k = 0; k < 6; ++k) inputs[k] = system.length(int(k)) + random.uniform(0, 5e-3);
      RodQuestion question;
      question.wrench = random.wrench(0.5, 0.02);
      const Report report = solve_rods(work, home(robot), inputs, question);
      if (!report.ok() && report.status != Status::unstable) continue;
      ++tried;
      const SE3<double>& pose = system.platform();
      Wrench6 sum = Wrench6::Zero();
      for (int k = 0; k < 6; ++k) {
        const RodLeg& leg = robot.legs[std::size_t(k)];
        const RodResult reading = system.rod(k);
        const double axial_rotation = dynamic_cast<const v1::GeneralSystem&>(system).axial_rotation(k),
                     length = reading.length;
        EXPECT_EQ(length, inputs[std::size_t(k)]);
        const Vec3<double> t0 = leg.tangent(), x0 = leg.base.rotate(Vec3<double>(1, 0, 0));
        Mat<double, 3, 3> axes;
        axes << x0, cross(t0, x0), t0;
        RodState<double> base;
        base.p = leg.base.p;
        base.R = SO3<double>::exp(Vec3<double>(t0 * axial_rotation)).compose(SO3<double>::from(axes));
        base.n = reading.force_0;
        base.m = reading.moment_0;
        SpatialRod rod = spatial_rod(leg.link);
        rod.load += gravity * leg.link.mass_per_length();
        const RodTip tip = integrate(rod, length, base, {0, 1e-14});
        const Vec3<double> arm = pose.R.rotate(leg.platform_point);
        EXPECT_LT((tip.state.p - pose.p - arm).norm(), 1e-11) << kind.name;
        if (!leg.is_spin_held) {
          EXPECT_LT(std::abs(dot(base.m, t0)), 1e-12) << kind.name;
        }
        if (leg.is_clamped) {
          EXPECT_LT((tip.state.tangent() - pose.R.rotate(leg.platform_tangent)).norm(), 1e-10) << kind.name;
          const Vec3<double> x = tip.state.R.rotate(Vec3<double>(1, 0, 0));
          if (leg.is_tip_spin_free) {
            EXPECT_LT(std::abs(dot(tip.state.m, tip.state.tangent())), 1e-11) << kind.name;
          } else {
            EXPECT_LT((x - pose.R.rotate(leg.platform_across)).norm(), 1e-10) << kind.name;
          }
        } else {
          EXPECT_LT(tip.state.m.norm(), 1e-11) << kind.name;
        }
        sum.head<3>() += tip.state.n;
        sum.tail<3>() += cross(arm, tip.state.n);
        if (leg.is_clamped) sum.tail<3>() += tip.state.m;
      }
      EXPECT_LT((sum - question.wrench).lpNorm<Eigen::Infinity>(), 1e-10) << kind.name;
    }
    EXPECT_GE(tried, samples(2)) << kind.name;
  }
}

TEST(GeneralSystem, EveryRodIsOneHeldByItself) {
  for (const Kind& kind : general) {
    RodRandom random(41);
    const RodRobot robot = robot_of(kind, random);
    GeneralSystem system(robot);
    ASSERT_TRUE(begin(system, robot, random)) << kind.name;
    finest(system);
    ASSERT_TRUE(close_rods(system) && balance(system)) << kind.name;
    Mat<double, 6, 6> stiffness = Mat<double, 6, 6>::Zero();
    for (int k = 0; k < 6; ++k) {
      const RodLeg& leg = robot.legs[std::size_t(k)];
      const Vec3<double> t0 = leg.tangent(), x0 = leg.base.rotate(Vec3<double>(1, 0, 0));
      Mat<double, 3, 3> base, tip;
      base << x0, cross(t0, x0), t0;
      tip << leg.platform_across, cross(leg.platform_tangent, leg.platform_across), leg.platform_tangent;
      SpatialRod rod = spatial_rod(leg.link);
      rod.load += gravity * leg.link.mass_per_length();
      RodEnds ends;
      ends.base = leg.is_spin_held ? RodEnds::Base::held : RodEnds::Base::spins;
      ends.tip = !leg.is_clamped        ? RodEnds::Tip::ball
                 : leg.is_tip_spin_free ? RodEnds::Tip::tangent
                                        : RodEnds::Tip::clamp;
      const RodResult reading = system.rod(k);
      const Vec3<double> arm = system.platform().R.rotate(leg.platform_point);
      const RodBvpSolution held = solve_rod_bvp(
          rod, {leg.base.p, SO3<double>::from(base)}, reading.length, ends,
          {system.platform().p + arm, system.platform().R.compose(SO3<double>::from(tip))},
          RodStart{reading.force_0, reading.moment_0, system.axial_rotation(k)}, {.tolerance = 1e-13});
      ASSERT_TRUE(held.report.ok()) << kind.name << held.report.message.view();
      EXPECT_LT((held.tip.n - reading.force).norm(), 1e-9 * (1 + reading.force.norm())) << kind.name;
      EXPECT_LT((held.base.n - reading.force_0).norm(), 1e-9 * (1 + reading.force.norm())) << kind.name;
      EXPECT_LT((held.base.m - reading.moment_0).norm(), 1e-9) << kind.name;
      if (leg.is_clamped) {
        EXPECT_LT((held.tip.m - reading.moment).norm(), 1e-9) << kind.name;
      }
      EXPECT_EQ(system.unstable_with_tip_held(k)[0],
                unstable_directions(rod, reading.length, held.base, ends));
      Mat<double, 6, 6> carry = Mat<double, 6, 6>::Identity();  // of the tip by the platform's twist
      carry.topRightCorner<3, 3>() = -skew(arm);
      stiffness += carry.transpose() * held.stiffness * carry;
      stiffness.bottomRightCorner<3, 3>() +=
          arm * reading.force.transpose() - dot(arm, reading.force) * Mat<double, 3, 3>::Identity();
      Wrench6 feed = carry.transpose() * held.feed;
      EXPECT_LT((feed - system.input_wrench_jacobian(k)).norm(), 1e-8 * feed.norm()) << kind.name;
    }
    const Mat<double, 6, 6> whole = system.stiffness();
    EXPECT_LT((whole - stiffness).norm(), 1e-8 * whole.norm()) << kind.name;
  }
}

/// A hexapod whose rods' sections are held at both ends resists the turn of its platform by torsion, too.
TEST(GeneralSystem, HeldSpinStiffensTheTurnAboutTheAxis) {
  RodRobot robot = tripod_robot(g2);
  robot = RodRobot(robot.legs, robot.home, robot.platform_radius);
  for (RodLeg& leg : robot.legs) {
    leg.is_clamped = true;
    leg.link.shear_modulus = leg.link.youngs_modulus / 2.6;
    leg.platform_across = leg.base.rotate(Vec3<double>(1, 0, 0));
  }
  RodRobot held = robot;
  for (RodLeg& leg : held.legs) leg.is_spin_held = true;
  const SE3<double> turned{home(robot).p, SO3<double>::exp({0, 0, 0.4})};
  GeneralSystem spinning(robot), resisting(held);
  ASSERT_TRUE(spinning.rest_at(turned) && resisting.rest_at(turned));
  for (int k = 0; k < 6; ++k) resisting.set_feed(k, spinning.length(k));
  ASSERT_TRUE(close_rods(spinning) && balance(spinning));
  ASSERT_TRUE(close_rods(resisting) && balance(resisting));
  const double torsion = spatial_rod(held.legs[0].link).torsion_stiffness / spinning.length(0);
  const double torque = resisting.wrench()[5] - spinning.wrench()[5];
  EXPECT_GT(torque, 0.5 * 6 * torsion * 0.4);  // six rods twisted by some 0.4 each
  EXPECT_LT(torque, 2.0 * 6 * torsion * 0.4);
  EXPECT_GT(resisting.stiffness()(5, 5), spinning.stiffness()(5, 5) + 3 * torsion);
  for (int k = 0; k < 6; ++k) {
    EXPECT_LT(std::abs(dot(spinning.rod(k).moment_0, robot.legs[std::size_t(k)].tangent())), 1e-9);
    EXPECT_GT(std::abs(dot(resisting.rod(k).moment_0, robot.legs[std::size_t(k)].tangent())), 0.1 * torsion);
  }
}

TEST(GeneralSystem, StepsConvergeAsTheEstimateSays) {
  RodRandom random(51);
  int compared = 0;
  for (const Kind& kind : general) {
    const RodRobot robot = robot_of(kind, random);
    GeneralSystem system(robot);
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
      EXPECT_LT(off, 2 * estimates[k] + 1e-13) << kind.name;
      ++compared;
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(GeneralSystem, CoordinatesHoldTheState) {
  for (const Kind& kind : general) {
    RodRandom random(61);
    const RodRobot robot = robot_of(kind, random);
    GeneralSystem system(robot), other(robot);
    ASSERT_TRUE(begin(system, robot, random)) << kind.name;
    while (system.elements() < GeneralSystem::coordinate_elements) system.refine();
    while (system.elements() > GeneralSystem::coordinate_elements) system.coarsen();
    ASSERT_TRUE(close_rods(system) && balance(system));
    std::vector<double> coordinates(6 * RodLeg::coordinates, 1.0);
    for (std::size_t k = 0; k < 6; ++k)
      system.get_rod(int(k), std::span(coordinates).subspan(k * RodLeg::coordinates, RodLeg::coordinates));
    EXPECT_EQ(coordinates.back(), system.length(5));
    other.set_gravity(gravity);
    other.set_platform(system.platform());
    other.set_wrench(system.wrench());
    other.set_rods(coordinates);
    EXPECT_LT(other.evaluate(), 1e-11) << kind.name;
    const auto line = other.centreline(3, 101);
    EXPECT_LT((line.back() - system.rod(3).tip).norm(), 1e-10);
    EXPECT_LT((line.front() - system.base(3)).norm(), 1e-15);
  }
}

/// As tests/kinematics/hexapod_test.cpp does with rods without torque: lengths and pose are each other's
/// answer.
TEST(GeneralSystem, HoldsThePosesThatItsLengthsLeadTo) {
  for (const Kind& kind : general) {
    RodRandom random(71);
    int tried = 0;
    for (int sample = 0; sample < samples(3); ++sample) {
      const RodRobot robot = upright_of(kind, random);
      RodWork work = work_of<GeneralSystem>(robot, gravity);
      RodQuestion question;
      question.wrench = random.wrench(0.05, 0.005);
      const SE3<double> wanted = random.near(home(robot), 0.01, 0.05);
      const Report held = lengths_for_pose(work, home(robot), wanted, question);
      if (!held.ok()) continue;
      std::array<double, 6> inputs;
      for (std::size_t k = 0; k < 6; ++k) inputs[k] = work.system->length(int(k));
      question.warm_start = true;
      for (const double more : {2e-3, 0.0}) {  // away and back
        std::array<double, 6> there = inputs;
        there[1] += more;
        const Report back = solve_rods(work, home(robot), there, question);
        ASSERT_TRUE(back.ok() || back.status == Status::unstable) << kind.name << back.message.view();
      }
      ++tried;
      EXPECT_LT((work.system->platform().p - wanted.p).norm(), 1e-9) << kind.name;
      EXPECT_LT((work.system->platform().R.matrix() - wanted.R.matrix()).norm(), 1e-8) << kind.name;
    }
    EXPECT_GE(tried, samples(1)) << kind.name;
  }
}

}  // namespace general_system_test
}  // namespace sinew::test
