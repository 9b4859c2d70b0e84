/// Single rods of a system, stable and not, against the exact elastica: indices of stability and what the
/// estimate of truncation is worth; and one instruction set against another.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "kinematics/rods/path.hpp"
#include "link/elastica_map.hpp"
#include "link/galerkin.hpp"
#include "rod_robots.hpp"

namespace sinew::test {
namespace rod_stability_test {

/// A system of one rod of unit length and stiffness. Only its rod is of interest: nothing else holds the
/// platform.
struct SingleRod {
  ElasticaSystem system{
      RodRobot{{rod_leg(Vec3<double>::Zero(), Vec3<double>::Zero(), 1)}, pose_of(level(0.9)), 1}};

  /// Takes over an exact shape, at its tip. Evaluated.
  double take(const Vec2<double>& local_force, const ElasticaState<double>& state) {
    const auto& basis = GalerkinBasis<fine_nodes>::get();
    std::array<ElasticaSection, fine_nodes> sections;
    elastica_sections(local_force, basis.node, sections);
    std::array<double, RodLeg::coordinates> x;
    for (std::size_t j = 0; j < fine_nodes; ++j) x[j] = sections[j].angle;
    x[fine_nodes] = state.force[0];
    x[fine_nodes + 1] = state.force[1];
    x[fine_nodes + 2] = 1;
    const Vec3<double> lateral = Vec3<double>(0.6, 0.8, 0) * (state.tip[0] < 0 ? -1 : 1);
    SE3<double> pose;
    pose.p = Vec3<double>(0.6, 0.8, 0) * state.tip[0] + Vec3<double>(0, 0, state.tip[1]);
    system.set_platform(pose);
    if (state.tip[0] < 0)  // its coordinates are those of the side the tip lies on
      for (std::size_t j = 0; j <= fine_nodes; ++j) x[j] = -x[j];
    system.set_rod(0, x, lateral);
    return system.evaluate(), system.limb_error();
  }
};

/// Whether what a system counts is what is exact; true where the shape is too sharp to be resolved.
bool counts_right(SingleRod& rod, const ElasticaEquilibrium& exact) {
  rod.take(exact.local_force, exact.state);
  if (!(rod.system.truncation() < 1e-6)) return true;
  EXPECT_TRUE(close_rods(rod.system));
  rod.system.linearise();
  return rod.system.unstable_with_tip_held(0) ==
         std::array{exact.unstable_in_plane, exact.unstable_out_of_plane};
}

TEST(RodStability, CountsTheUnstableDirectionsOfAllEquilibriaOfATip) {
  RodRandom random(1);
  SingleRod rod;
  int stable = 0, aside = 0;
  for (int trial = 0; trial < 25; ++trial) {
    const double r = random.uniform(0.2, 0.99), angle = random.uniform(0.05, 3);
    for (const auto& exact : elastica_map({r * std::sin(angle), r * std::cos(angle)}).equilibria) {
      if (exact.unstable_in_plane < 0) continue;
      EXPECT_TRUE(counts_right(rod, exact)) << "local force " << exact.local_force.transpose();
      stable += exact.is_stable();
      aside += exact.unstable_out_of_plane > 0;
    }
  }
  EXPECT_GT(stable, 20);  // the samples were worth it
  EXPECT_GT(aside, 15);
}

template <std::size_t N>
double least_bending() {
  const auto& basis = GalerkinBasis<N>::get();
  Eigen::Matrix<double, N, N> bending;
  for (std::size_t j = 0; j < N; ++j)
    for (std::size_t k = 0; k < N; ++k)
      bending(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) =
          basis.bending[j][k] / std::sqrt(basis.weight[j] * basis.weight[k]);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>>(bending).eigenvalues()[0];
}

TEST(RodStability, ABasisIsNoSofterThanTheRod) {  // of which the count makes use
  const double exact = std::numbers::pi * std::numbers::pi / 4;
  EXPECT_NEAR(least_bending<coarse_nodes>(), exact, 1e-10);
  EXPECT_NEAR(least_bending<fine_nodes>(), exact, 1e-10);
}

TEST(RodStability, CountsThemBeyondTheFirstInflection) {
  RodRandom random(4);
  SingleRod rod;
  std::array<int, 4> by_inflections{};
  int in_plane = 0, many_aside = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const ElasticaEquilibrium exact =
        elastica_equilibrium(elastica_local_force(random.uniform(0, 200), random.uniform(-3.14159, 3.14159)));
    if (exact.unstable_in_plane < 0) continue;
    EXPECT_TRUE(counts_right(rod, exact)) << "local force " << exact.local_force.transpose();
    if (!(rod.system.truncation() < 1e-6)) continue;
    ++by_inflections[std::size_t(std::min(exact.inflections, 3))];
    in_plane += exact.unstable_in_plane > 0;
    many_aside += exact.unstable_out_of_plane > 1;
  }
  for (const int seen : by_inflections) EXPECT_GT(seen, 50);
  EXPECT_GT(in_plane, 200);
  EXPECT_GT(many_aside, 200);
}

TEST(RodStability, TruncationIsAnHonestEstimate) {
  RodRandom random(2);
  SingleRod rod;
  for (const bool is_fine : {false, true}) {
    int judged = 0, exceeded = 0;
    double worst = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const Vec2<double> local =
          elastica_local_force(random.uniform(0, is_fine ? 150 : 20), random.uniform(-3.14159, 3.14159));
      const ElasticaTangent exact = elastica_tangent(local);
      const Mat<double, 2, 2> compliance = exact.compliance();
      rod.take(local, exact.state);
      if (!is_fine) rod.system.coarsen();
      if (!close_rods(rod.system)) continue;
      const double estimate = rod.system.truncation();
      if (estimate < 1e-12 || estimate > 1e-6 || !(compliance.norm() < 1)) continue;
      // the force it takes to hold the exact tip: how far the tip moves under what that is off
      const RodResult reading = rod.system.rod(0);
      const Vec2<double> force(exact.state.tip[0] < 0 ? -reading.lateral_force : reading.lateral_force,
                               reading.axial_force);
      const double error = (compliance * (force - exact.state.force)).norm() / estimate;
      ++judged;
      exceeded += error > 1;
      worst = std::max(worst, error);
    }
    EXPECT_GT(judged, 300);
    EXPECT_LE(exceeded, judged / 100);
    EXPECT_LT(worst, 5);
    EXPECT_GT(worst, 0.05);  // nor does it only frighten
  }
}

/// All numbers of a Newton step and its outcome.
std::vector<double> numbers_of_a_step() {
  RodRandom random(3);
  std::vector<double> numbers;
  for (const int rods : {3, 8, 9})
    for (const bool is_fine : {false, true})
      for (const double far : {0.0, 1.0}) {  // shapes within 2.5 rad and beyond: two ways to a sine
        const RodRobot robot = random.robot(rods, 0.2);
        ElasticaSystem system(robot);
        EXPECT_TRUE(system.rest_at(random.near(home(robot), 0.02, 0.1)));
        if (is_fine) system.refine();
        system.set_platform(random.near(system.platform(), 1e-3, 1e-2));
        system.set_wrench(random.wrench(5, 1));
        if (far > 0)
          for (int k = 0; k < rods; ++k) {
            std::array<double, RodLeg::coordinates> x;
            system.evaluate();
            system.get_rod(k, x);
            for (std::size_t j = 0; j < fine_nodes; ++j) x[j] += 3.0 * double(j) / double(fine_nodes);
            system.set_rod(k, x, system.aim(k).lateral);
          }
        numbers.push_back(system.evaluate());
        system.linearise();
        numbers.insert(numbers.end(), system.stiffness().data(), system.stiffness().data() + 36);
        const Wrench6 missing = system.wrench_residual(), feed = system.input_wrench_jacobian(rods - 1);
        numbers.insert(numbers.end(), missing.data(), missing.data() + 6);
        numbers.insert(numbers.end(), feed.data(), feed.data() + 6);
        const std::vector<double> fed(std::size_t(rods), 1e-4);
        ElasticaSystem::Twist twist = ElasticaSystem::Twist::Constant(1e-4);
        if (far == 0) twist = system.step(true);
        system.move(twist, fed);
        system.evaluate(false);
        const Wrench6 carried = system.step(false);
        numbers.insert(numbers.end(), carried.data(), carried.data() + 6);
        numbers.push_back(system.evaluate());
        for (int k = 0; k < rods; ++k) {
          const RodResult rod = system.rod(k);
          numbers.insert(numbers.end(), rod.force.data(), rod.force.data() + 3);
          numbers.insert(numbers.end(), {rod.tip_angle, rod.energy, rod.length});
        }
      }
  return numbers;
}

TEST(RodLanes, AgreeWhateverTheInstructionSet) {
  const std::vector<double> best = numbers_of_a_step();
  const std::string best_name = rod_kernels::instruction_set();
  int sets = 0;
  for (const std::int64_t set : {std::int64_t{HWY_AVX3}, std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSSE3},
                                 std::int64_t{HWY_EMU128}, std::int64_t{HWY_SCALAR}}) {
    if ((hwy::SupportedTargets() & set) == 0) continue;
    hwy::SetSupportedTargetsForTest(set);
    hwy::GetChosenTarget().Update(set);
    const std::string name = rod_kernels::instruction_set();
    const std::vector<double> numbers = numbers_of_a_step();
    ASSERT_EQ(numbers.size(), best.size());
    double worst = 0;
    for (std::size_t k = 0; k < best.size(); ++k)
      worsen(worst, std::abs(numbers[k] - best[k]) / (1 + std::abs(best[k])));
    EXPECT_LT(worst, 1e-11) << name << " beside " << best_name;
    hwy::SetSupportedTargetsForTest(0);
    ++sets;
  }
  hwy::GetChosenTarget().DeInit();
  EXPECT_EQ(rod_kernels::instruction_set(), best_name);
  EXPECT_GT(sets, 0);
}

/// Anywhere, in equilibrium or not: what the lanes count at eight poses is what the system counts at each.
TEST(PoseLanes, CountUnstableDirectionsAsOneByOne) {
  RodRandom random(6);
  const RodRobot robot = random.robot(6, 0.2);
  std::array<int, 8> seen{};
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<CoarseRods> rods(6);
    PoseLanes poses{};
    std::array<int, rod_lanes> counts{};
    for (int lane = 0; lane < rod_lanes; ++lane) {
      ElasticaSystem system(robot);
      system.set_platform(random.near(home(robot), 0.1, 0.5));
      system.set_wrench(random.wrench(5, 1));
      for (int k = 0; k < 6; ++k) {
        std::array<double, coarse_nodes> theta;
        const double bend = random.uniform(-2, 2), wave = random.uniform(-1, 1);
        for (std::size_t j = 0; j < coarse_nodes; ++j) {
          const double s = GalerkinBasis<coarse_nodes>::get().node[j];
          theta[j] = bend * s + wave * std::sin(6 * s);
        }
        const double push = (trial % 4) * 6 * system.stiffness(k);
        system.set_shape(k, 1, theta, random.uniform(-push, push), random.uniform(-push, push),
                         system.aim(k).lateral);
      }
      system.evaluate();
      system.linearise();
      counts[std::size_t(lane)] = unstable_directions(system);
      for (int k = 0; k < 6; ++k) system.copy_rod(k, rods[std::size_t(k)], lane);
      const SE3<double>& pose = system.platform();
      for (int c = 0; c < 3; ++c) {
        poses.position[c][lane] = pose.p[c];
        poses.quaternion[c + 1][lane] = pose.R.v[c];
      }
      poses.quaternion[0][lane] = pose.R.w;
      for (int c = 0; c < 6; ++c) poses.wrench[c][lane] = system.wrench()[c];
    }
    rod_kernels::advance(
        rods, {.moves = false, .from_scratch = true, .renews = true, .counts_unstable = true}, poses);
    for (std::size_t lane = 0; lane < rod_lanes; ++lane) {
      EXPECT_EQ(poses.unstable[lane], counts[lane]) << trial;
      ++seen[std::size_t(std::min(counts[lane], 7))];
    }
  }
  for (const int count : {0, 1, 2, 3})
    EXPECT_GT(seen[std::size_t(count)], 5) << count;  // the samples were worth it
}

}  // namespace rod_stability_test
}  // namespace sinew::test
