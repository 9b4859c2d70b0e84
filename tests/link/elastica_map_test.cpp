#include "link/elastica_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <random>
#include <vector>

namespace sinew {
namespace elastica_map_test {

using std::numbers::pi;

class Random {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// Uniform over the disc of radius 0.999, so that half of them are reached from behind.
  Vec2<double> tip() {
    const double r = 0.999 * std::sqrt(uniform(0, 1)), angle = uniform(-pi, pi);
    return {r * std::sin(angle), r * std::cos(angle)};
  }
  Vec2<double> local_force(double largest) {
    return elastica_local_force(largest * uniform(0, 1), uniform(-pi, pi));
  }

 private:
  std::mt19937_64 engine_{20260};
};

/// @name The second variations in a basis: an oracle that knows nothing of zeros of solutions
/// @{

using Matrix = std::vector<std::vector<double>>;
using Vector = std::vector<double>;

/// Nodes and weights of Gauss and Legendre on [0, 1].
struct Gauss {
  Vector node, weight;
  explicit Gauss(int n) {
    for (int i = 1; i <= n; ++i) {
      double x = std::cos(pi * (i - 0.25) / (n + 0.5)), slope = 0;
      for (int iteration = 0; iteration < 8; ++iteration) {
        double before = 1, value = x;
        for (int k = 2; k <= n; ++k) {
          const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
          before = value;
          value = next;
        }
        slope = n * (x * value - before) / (x * x - 1);
        x -= value / slope;
      }
      node.push_back((1 - x) / 2);
      weight.push_back(1 / ((1 - x * x) * slope * slope));
    }
  }
};

/// φ_i(s) = ∫₀^s P_i(2r − 1) dr: φ(0) = 0, and ∫φ_i′φ_j′ is diagonal.
Vector basis_at(double s, int count) {
  Vector legendre = {1, 2 * s - 1};
  for (int k = 2; k <= count; ++k) {
    const std::size_t i = static_cast<std::size_t>(k);
    legendre.push_back(((2 * k - 1) * (2 * s - 1) * legendre[i - 1] - (k - 1) * legendre[i - 2]) / k);
  }
  Vector phi = {s};
  for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i)
    phi.push_back((legendre[i + 1] - legendre[i - 1]) / (2 * (2 * static_cast<double>(i) + 1)));
  return phi;
}

/// Negative directions of ηᵀAη on Cη = 0: a constraint takes one coordinate out, then Sylvester's law of
/// inertia.
int negative_directions(Matrix a, Matrix constraints) {
  while (!constraints.empty()) {
    Vector c = constraints.back();
    constraints.pop_back();
    const std::size_t n = c.size();
    std::size_t out = 0;
    for (std::size_t j = 1; j < n; ++j)
      if (std::abs(c[j]) > std::abs(c[out])) out = j;
    for (std::size_t j = 0; j < n; ++j) {  // η_j stands for φ_j − (c_j/c_out) φ_out
      if (j == out) continue;
      const double share = c[j] / c[out];
      for (std::size_t k = 0; k < n; ++k) a[k][j] -= share * a[k][out];
      for (std::size_t k = 0; k < n; ++k) a[j][k] -= share * a[out][k];
      for (Vector& other : constraints) other[j] -= share * other[out];
    }
    const auto at = static_cast<std::ptrdiff_t>(out);
    a.erase(a.begin() + at);
    for (Vector& row : a) row.erase(row.begin() + at);
    for (Vector& other : constraints) other.erase(other.begin() + at);
  }
  int negative = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    negative += a[k][k] < 0 ? 1 : 0;
    for (std::size_t i = k + 1; i < a.size(); ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < a.size(); ++j) a[i][j] -= factor * a[k][j];
    }
  }
  return negative;
}

struct Indices {
  int in_plane, out_of_plane;
  bool operator==(const Indices&) const = default;
};

Indices indices_in_basis(const ElasticaEquilibrium& e, int size) {
  static const Gauss gauss(56);
  const std::size_t n = static_cast<std::size_t>(size);
  std::vector<ElasticaSection> sections(gauss.node.size());
  elastica_sections(e.local_force, gauss.node, sections);
  Matrix in(n, Vector(n)), out = in, in_constraint(2, Vector(n)), out_constraint(1, Vector(n));
  for (std::size_t i = 0; i < n; ++i) in[i][i] = out[i][i] = 1 / (2 * static_cast<double>(i) + 1);
  for (std::size_t g = 0; g < gauss.node.size(); ++g) {
    const Vector phi = basis_at(gauss.node[g], size);
    const double sin = std::sin(sections[g].angle), cos = std::cos(sections[g].angle);
    const double pull = e.state.force[0] * sin + e.state.force[1] * cos;
    const double bend = sections[g].curvature * sections[g].curvature;
    for (std::size_t i = 0; i < n; ++i) {
      const double weight = gauss.weight[g] * phi[i];
      for (std::size_t j = 0; j < n; ++j) {
        in[i][j] += weight * pull * phi[j];
        out[i][j] += weight * (pull - bend) * phi[j];
      }
      in_constraint[0][i] += weight * cos;
      in_constraint[1][i] += weight * sin;
      out_constraint[0][i] += weight;
    }
  }
  return {negative_directions(in, in_constraint), negative_directions(out, out_constraint)};
}
/// @}

std::string describe(const ElasticaEquilibrium& e) {
  return "force " + std::to_string(e.state.force[0]) + " " + std::to_string(e.state.force[1]) + " tip " +
         std::to_string(e.state.tip[0]) + " " + std::to_string(e.state.tip[1]);
}

TEST(ElasticaMap, KnowsTheTwoShapesOfACompressedRod) {
  const ElasticaMap map = elastica_map({0.1, 0.9});
  EXPECT_TRUE(map.report.ok());
  ASSERT_EQ(map.equilibria.size(), 2U);
  const ElasticaEquilibrium &low = map.equilibria[0], &high = map.equilibria[1];
  EXPECT_NEAR(low.state.tip_angle, 0.875240, 1e-6);
  EXPECT_NEAR(low.state.force[0], -4.833594, 1e-6);
  EXPECT_NEAR(low.state.force[1], -18.814924, 1e-6);
  EXPECT_TRUE(low.is_stable());
  EXPECT_NEAR(low.out_of_plane_stiffness, -48.33594, 1e-5);
  EXPECT_NEAR(high.state.tip_angle, -0.686066, 1e-6);
  EXPECT_NEAR(high.state.force[0], 0.844174, 1e-6);
  EXPECT_NEAR(high.state.force[1], -22.84851, 1e-5);
  EXPECT_EQ(high.unstable_in_plane, 0);
  EXPECT_EQ(high.unstable_out_of_plane, 1);
}

TEST(ElasticaMap, NearlyStretchedLegHasAPairOfShapesBesideTheOrdinaryOne) {
  const ElasticaMap ordinary = elastica_map({0.3, 0.93}, {.force_bound = 30});
  ASSERT_EQ(ordinary.equilibria.size(), 1U);
  EXPECT_TRUE(ordinary.equilibria[0].is_stable());
  EXPECT_EQ(ordinary.equilibria[0].inflections, 0);
  const ElasticaMap map = elastica_map({0.3, 0.93});
  ASSERT_EQ(map.equilibria.size(), 3U);  // a pair that has just met, |f| = 35.8 and 37.5
  EXPECT_EQ(map.equilibria[1].unstable_in_plane, 0);
  EXPECT_EQ(map.equilibria[2].unstable_in_plane, 1);
  for (std::size_t k = 1; k < 3; ++k) {
    const ElasticaEquilibrium& e = map.equilibria[k];
    EXPECT_EQ(e.unstable_out_of_plane, 1);
    // Not the solver's word: Runge and Kutta from the base, with this force and curvature.
    double theta = 0, kappa = e.state.base_curvature, d = 0, w = 0;
    const auto bend = [&](double angle) {
      return e.state.force[1] * std::sin(angle) - e.state.force[0] * std::cos(angle);
    };
    const double h = 1e-3;
    for (int i = 0; i < 1000; ++i) {
      const double k1 = bend(theta), a1 = theta + h / 2 * kappa, k2 = bend(a1);
      const double a2 = a1 + h * h / 4 * k1, k3 = bend(a2), a3 = theta + h * kappa + h * h / 2 * k2;
      d += h / 6 * (std::sin(theta) + 2 * std::sin(a1) + 2 * std::sin(a2) + std::sin(a3));
      w += h / 6 * (std::cos(theta) + 2 * std::cos(a1) + 2 * std::cos(a2) + std::cos(a3));
      theta += h * kappa + h * h / 6 * (k1 + k2 + k3);
      kappa += h / 6 * (k1 + 2 * k2 + 2 * k3 + bend(a3));
    }
    EXPECT_NEAR(d, 0.3, 1e-9);
    EXPECT_NEAR(w, 0.93, 1e-9);
    EXPECT_NEAR(kappa, 0, 1e-8);
  }
}

TEST(ElasticaMap, IndicesAreThoseOfTheSecondVariationInABasis) {
  Random random;
  std::array<int, 3> in_plane{}, out_of_plane{};
  for (int k = 0; k < 400; ++k) {
    const ElasticaEquilibrium e = elastica_equilibrium(random.local_force(160));
    const Indices exact{e.unstable_in_plane, e.unstable_out_of_plane};
    EXPECT_EQ(indices_in_basis(e, 34), exact) << describe(e);  // 26 miss one beside a fold, at a force of 150
    EXPECT_EQ(indices_in_basis(e, 42), exact) << describe(e);
    ++in_plane[static_cast<std::size_t>(std::min(exact.in_plane, 2))];
    ++out_of_plane[static_cast<std::size_t>(std::min(exact.out_of_plane, 2))];
  }
  for (std::size_t k = 0; k < 3; ++k)  // the sample has seen all kinds
    EXPECT_TRUE(in_plane[k] > 0 && out_of_plane[k] > 0) << k;
}

TEST(ElasticaMap, StabilityThatIsNotKnownIsNotClaimed) {
  EXPECT_FALSE(elastica_equilibrium({std::nan(""), 1}).is_stable());
  EXPECT_FALSE(elastica_equilibrium({0, 0}).is_stable());
  EXPECT_FALSE(elastica_equilibrium({0, -1}).is_stable());
}

TEST(ElasticaMap, SmallBasisAlreadyCountsTheFirstModes) {  // the count converges from below
  Random random;
  for (int k = 0; k < 100; ++k) {
    const ElasticaEquilibrium e = elastica_equilibrium(random.local_force(45));
    const Indices exact{e.unstable_in_plane, e.unstable_out_of_plane};
    for (const int size : {6, 8, 10, 12}) {
      const Indices count = indices_in_basis(e, size);
      EXPECT_LE(count.in_plane, exact.in_plane) << describe(e);
      EXPECT_LE(count.out_of_plane, exact.out_of_plane) << describe(e);
      EXPECT_TRUE(size < 10 || count == exact) << size << ": " << describe(e);
    }
  }
}

TEST(ElasticaMap, FindsEveryEquilibriumByItsTip) {
  Random random;
  for (int k = 0; k < 25; ++k) {
    const ElasticaState<double> wanted = elastica(random.local_force(45));
    const ElasticaMap map = elastica_map(wanted.tip);
    EXPECT_TRUE(map.report.ok());
    EXPECT_TRUE(std::is_sorted(map.equilibria.begin(), map.equilibria.end(),
                               [](const auto& a, const auto& b) { return a.state.energy < b.state.energy; }));
    const auto same = [&](const ElasticaEquilibrium& e) {
      return (e.state.force - wanted.force).norm() < 1e-5 &&
             std::abs(e.state.tip_angle - wanted.tip_angle) < 1e-6;
    };
    EXPECT_EQ(std::count_if(map.equilibria.begin(), map.equilibria.end(), same), 1) << wanted.tip.transpose();
    for (const ElasticaEquilibrium& e : map.equilibria) {
      EXPECT_LT((e.state.tip - wanted.tip).norm(), 1e-14);
      EXPECT_LE(e.local_force.norm(), 45);
    }
  }
}

TEST(ElasticaMap, FindsLargeForcesAndTheBendAtTheBaseOfAPulledRod) {
  Random random;
  for (int k = 0; k < 6; ++k) {
    const double hair = k % 2 == 0 ? 1 : std::pow(10.0, -random.uniform(0, 6));
    const ElasticaState<double> wanted =
        elastica(elastica_local_force(random.uniform(45, 300), hair * random.uniform(-pi, pi)));
    const ElasticaMap map = elastica_map(wanted.tip, {.force_bound = 300});
    EXPECT_TRUE(std::any_of(map.equilibria.begin(), map.equilibria.end(), [&](const auto& e) {
      return (e.state.force - wanted.force).norm() < 1e-6 * wanted.force.norm() &&
             std::abs(e.state.tip_angle - wanted.tip_angle) < 1e-6;
    })) << wanted.tip.transpose();
  }
}

TEST(ElasticaMap, SmallerCellsFindNoMore) {
  Random random;
  for (int k = 0; k < 10; ++k) {
    const Vec2<double> tip = random.tip();
    EXPECT_EQ(elastica_map(tip).equilibria.size(), elastica_map(tip, {.refinement = 2}).equilibria.size())
        << tip.transpose();
  }
}

TEST(ElasticaMap, StiffnessIsTheDerivativeOfTheForceByTheTip) {
  const Vec2<double> tip(0.25, 0.6);
  const ElasticaMap map = elastica_map(tip);
  ASSERT_GE(map.equilibria.size(), 2U);
  const double h = 1e-4;
  std::array<std::array<ElasticaMap, 2>, 2> moved;
  for (int j = 0; j < 2; ++j)
    for (const int side : {0, 1})
      moved[static_cast<std::size_t>(j)][static_cast<std::size_t>(side)] =
          elastica_map(tip + (side == 0 ? -h : h) * Vec2<double>::Unit(j));
  for (std::size_t k = 0; k < map.equilibria.size(); ++k)
    for (int j = 0; j < 2; ++j) {
      const auto& [behind, ahead] = moved[static_cast<std::size_t>(j)];
      ASSERT_EQ(behind.equilibria.size(), map.equilibria.size());
      ASSERT_EQ(ahead.equilibria.size(), map.equilibria.size());
      const ElasticaEquilibrium& e = map.equilibria[k];
      const auto &before = behind.equilibria[k].state, &after = ahead.equilibria[k].state;
      const Vec2<double> slope = (after.force - before.force) / (2 * h);
      EXPECT_LT((slope - e.stiffness.col(j)).norm(), 1e-4 * e.stiffness.norm());
      EXPECT_NEAR((after.energy - before.energy) / (2 * h), e.state.force[j], 1e-5);
    }
}

TEST(ElasticaMap, MirrorImagesHaveMirroredShapes) {
  const ElasticaMap map = elastica_map({0.2, 0.7}), mirrored = elastica_map({-0.2, 0.7});
  ASSERT_EQ(map.equilibria.size(), mirrored.equilibria.size());
  for (std::size_t k = 0; k < map.equilibria.size(); ++k) {
    const ElasticaEquilibrium &a = map.equilibria[k], &b = mirrored.equilibria[k];
    EXPECT_NEAR(a.state.force[0], -b.state.force[0], 1e-10);
    EXPECT_NEAR(a.state.tip_angle, -b.state.tip_angle, 1e-11);
    EXPECT_NEAR(a.out_of_plane_stiffness, b.out_of_plane_stiffness, 1e-9);
    EXPECT_EQ(a.unstable_in_plane, b.unstable_in_plane);
    EXPECT_EQ(a.unstable_out_of_plane, b.unstable_out_of_plane);
  }
}

TEST(ElasticaMap, NearlyStraightRodIsABeamColumn) {
  // θ = A (cos λ(1−s)/cos λ − 1): (1 − w)/d² = ½∫θ²/(∫θ)² fixes λ² = −fw
  const auto ratio = [](double load) {
    const double x = std::sqrt(load), c = std::cos(x), s = std::sin(x);
    const double mean = s / (x * c) - 1, square = (0.5 + s * c / (2 * x)) / (c * c) - 2 * s / (x * c) + 1;
    return 0.5 * square / (mean * mean);
  };
  for (const double d : {1e-2, 1e-3, 1e-4}) {
    const ElasticaMap map = elastica_map({d, 1 - d * d});
    ASSERT_EQ(map.equilibria.size(), 2U) << d;
    for (const ElasticaEquilibrium& e : map.equilibria)
      EXPECT_NEAR(ratio(-e.state.force[1]), 1, 5 * d * d + 3e-16 / (d * d)) << d;
  }
}

TEST(ElasticaMap, RodOnItsAxisMayLieInAnyPlane) {
  const ElasticaMap map = elastica_map({0, 0.9});
  EXPECT_EQ(map.report.status, Status::singular);
  EXPECT_FALSE(map.report.message.empty());
  ASSERT_EQ(map.equilibria.size(), 2U);  // mirror images
  for (const ElasticaEquilibrium& e : map.equilibria) {
    EXPECT_TRUE(std::isnan(e.out_of_plane_stiffness));
    EXPECT_TRUE(e.is_stable());
  }
  EXPECT_NEAR(map.equilibria[0].state.force[0], -map.equilibria[1].state.force[0], 1e-12);
  const ElasticaMap beside =
      elastica_map({1e-9, 0.9});  // the tip held a hair away: one of them has to turn over
  ASSERT_EQ(beside.equilibria.size(), 2U);
  EXPECT_TRUE(beside.equilibria[0].is_stable());
  EXPECT_EQ(beside.equilibria[1].unstable_out_of_plane, 1);
  // Clamped and pinned, the rod buckles where tan x = x.
  const ElasticaMap buckling = elastica_map({0, 1 - 1e-7});
  ASSERT_EQ(buckling.equilibria.size(), 2U);
  EXPECT_NEAR(buckling.equilibria[0].state.force[1], -20.190728556, 1e-4);
}

TEST(ElasticaMap, SaysWhyThereIsNothing) {
  EXPECT_EQ(elastica_map({0, 1}).report.status, Status::singular);
  EXPECT_EQ(elastica_map({1e-6, 1}).report.status, Status::singular);
  EXPECT_EQ(elastica_map({0.6, 0.8000001}).report.status, Status::unreachable);
  EXPECT_EQ(elastica_map({0.8, 0.61}).report.status, Status::unreachable);
  EXPECT_EQ(elastica_map({0, -1.0}).report.status, Status::unreachable);
  EXPECT_EQ(elastica_map({0.4975, 0.8617}).report.status, Status::left_domain);  // needs a larger force
  EXPECT_EQ(elastica_map({0.4975, 0.8617}, {.force_bound = 300}).report.status, Status::converged);
  const double nan = std::nan("");
  EXPECT_EQ(elastica_map({nan, 0.5}).report.status, Status::left_domain);
  EXPECT_EQ(elastica_map({0.5, nan}).report.status, Status::left_domain);
  EXPECT_EQ(elastica_map({0.1, 0.9}, {.force_bound = nan}).report.status, Status::left_domain);
  EXPECT_EQ(elastica_map({0.1, 0.9}, {.force_bound = 301}).report.status, Status::left_domain);
  for (const Vec2<double>& tip : {Vec2<double>(0, 1), Vec2<double>(0.8, 0.61), Vec2<double>(0.4975, 0.8617)})
    EXPECT_TRUE(elastica_map(tip).equilibria.empty());
}

}  // namespace elastica_map_test
}  // namespace sinew
