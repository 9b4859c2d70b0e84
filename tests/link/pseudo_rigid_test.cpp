/// The pseudo-rigid chain against differences, the numbers of an independent implementation, and the
/// elastica.
#include "link/pseudo_rigid.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>

#include "check_jacobian.hpp"
#include "link/arc.hpp"
#include "link/elastica.hpp"
#include "reference_file.hpp"

namespace sinew {
namespace pseudo_rigid_test {

using Eigen::MatrixXd, Eigen::VectorXd;
using Json = nlohmann::json;

constexpr auto bases = {ChainBase::pinned, ChainBase::clamped};
constexpr auto models = {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs};

template <class Angles>
auto span_of(const Angles& angles) {
  using S = typename Angles::Scalar;
  return std::span<const S>(angles.data(), static_cast<std::size_t>(angles.size()));
}
VectorXd vector_of(const Json& list) {
  const auto values = list.get<std::vector<double>>();
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// A chain and angles: straight, nearly so, or up to a turn of the whole.
std::pair<PseudoRigid, VectorXd> any_chain() {
  const PseudoRigid chain{.length = 0.2,
                          .links = *rc::gen::inRange(2, 13),
                          .base = *rc::gen::elementOf(std::vector(bases)),
                          .model = *rc::gen::elementOf(std::vector(models))};
  const double size = *rc::gen::element(0.0, 1e-9, 1e-3, 1.0, 6.0) / chain.links;
  VectorXd angles(chain.joints());
  for (double& angle : angles) angle = size * *rc::gen::inRange(-1000, 1001) * 1e-3;
  return {chain, angles};
}

RC_GTEST_PROP(PseudoRigid, RatesAreDerivatives, ()) {  // @verifies TDPCR (33)
  const auto [chain, angles] = any_chain();
  const auto tip = chain.tip(span_of(angles));
  MatrixXd rate(2, angles.size());
  for (int j = 0; j < chain.joints(); ++j) rate.col(j) = tip.rate[static_cast<std::size_t>(j)];
  const auto position = [&chain = chain](const auto& q) { return chain.tip(span_of(q)).position; };
  RC_ASSERT(test::jacobian_error(rate, test::complex_step_jacobian(position, angles)) < 1e-13);
  RC_ASSERT(test::jacobian_error(rate, test::central_jacobian(position, angles)) < 1e-9);
  for (int k = 0; k < chain.joints(); ++k) {
    MatrixXd second(2, angles.size());
    for (int j = 0; j < chain.joints(); ++j) second.col(j) = tip.rate_rate(j, k);
    const auto column = [&chain = chain, k](const auto& q) {
      return chain.tip(span_of(q)).rate[static_cast<std::size_t>(k)];
    };
    RC_ASSERT(test::jacobian_error(second, test::complex_step_jacobian(column, angles)) < 1e-13);
  }
}

RC_GTEST_PROP(PseudoRigid, TendonRatesAreDerivatives, ()) {
  const auto [chain, angles] = any_chain();
  for (const int side : {1, -1})
    for (int j = 0; j < chain.joints(); ++j) {
      const auto bend = [&chain = chain, j, side](const auto& q) {
        return Eigen::Matrix<std::decay_t<decltype(q[0])>, 2, 1>(
            chain.tendon_bend(j, q[0], 0.005, side).change, chain.tendon_bend(j, q[0], 0.005, side).rate);
      };
      const Vec<double, 1> angle(angles[j]);
      const auto found = chain.tendon_bend(j, angle[0], 0.005, side);
      const MatrixXd slopes = test::complex_step_jacobian(bend, angle);
      RC_ASSERT(std::abs(slopes(0, 0) - found.rate) < 1e-15);
      RC_ASSERT(std::abs(slopes(1, 0) - found.curvature) < 1e-15);
    }
}

/// Tendons between discs by their holes: points on the links, straight between them.
TEST(PseudoRigid, TendonsBetweenDiscsAreDistancesOfHoles) {
  for (const ChainBase base : bases) {
    const PseudoRigid chain{.length = 0.3, .links = 5, .base = base, .model = PrbDiscretisation::discs};
    VectorXd angles(chain.joints());
    for (int j = 0; j < chain.joints(); ++j) angles[j] = 0.3 - 0.25 * j;
    const double d = 0.004, step = chain.link_length();
    for (const int side : {1, -1}) {
      const bool is_pinned = base == ChainBase::pinned;
      double turn = 0;
      Vec2<double> joint(0, is_pinned ? step : 0), hole(side * d, is_pinned ? step / 2 : 0);
      double length = is_pinned ? step / 2 : 0;  // from the base to the first disc
      for (const double angle : angles) {
        turn += angle;
        const Vec2<double> along(-std::sin(turn), std::cos(turn)), beside(std::cos(turn), std::sin(turn));
        const Vec2<double> next = joint + step / 2 * along + side * d * beside;
        length += (next - hole).norm();
        hole = next;
        joint += step * along;
      }
      length += step / 2;  // to the tip
      EXPECT_NEAR(chain.tendon_length(span_of(angles), d, side), length, 1e-16);
    }
  }
}

TEST(PseudoRigid, TurnsOfEndsAndJointsBetweenAreTheTurn) {
  for (const ChainBase base : bases)
    for (const PrbDiscretisation model :
         {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs})
      for (const int links : {2, 5}) {
        const PseudoRigid chain{.length = 0.3, .links = links, .base = base, .model = model};
        VectorXd angles(chain.joints());
        for (int j = 0; j < chain.joints(); ++j) angles[j] = 0.3 - 0.25 * j;
        const auto [first, last] = chain.end_turns(span_of(angles));
        const double between = base == ChainBase::pinned ? angles.sum() : angles.sum() - angles[0];
        EXPECT_NEAR(first + between + last, chain.turn(span_of(angles)), 1e-15);
      }
}

TEST(PseudoRigid, ChordsAndTheirRatesAreTheirs) {  // @verifies TDPCR (33)
  const Json& robot = test::reference_file("data/tdpcr/poses.json")["3-RFR"];
  const PseudoRigid chain{
      .length = robot["l"], .links = robot["n"], .base = ChainBase::pinned, .model = PrbDiscretisation::even};
  for (const Json& pose : robot["poses"])
    for (std::size_t i = 0; i < 3; ++i) {
      const VectorXd angles = vector_of(pose["theta"][i]);
      const auto tip = chain.tip(span_of(angles));
      EXPECT_NEAR(tip.position.norm(), pose["rho"][i].get<double>(), 1e-15);
      for (std::size_t j = 0; j < 5; ++j)
        EXPECT_NEAR(dot(tip.position, tip.rate[j]), pose["K_theta"][i][5 * i + j].get<double>(), 1e-15);
    }
}

// ---- equilibrium: what the springs make of it

/// Energy of springs less the work of a bending moment m on all that turns and a force along the chord or in
/// space, descended by Newton's method.
struct Load {
  double moment = 0, chord_force = 0;
  Vec2<double> force = Vec2<double>::Zero();
};

VectorXd equilibrium(const PseudoRigid& chain, double stiffness, const Load& load) {
  const double k = stiffness / chain.link_length();
  VectorXd angles = VectorXd::Zero(chain.joints());
  for (int j = 0; j < chain.joints(); ++j) angles[j] = load.moment / k;
  for (int i = 0; i < 50; ++i) {
    const auto tip = chain.tip(span_of(angles));
    const double chord = tip.position.norm();
    const Vec2<double> F = load.force + load.chord_force * tip.position / chord;
    VectorXd slope(angles.size());
    MatrixXd curvature = MatrixXd::Zero(angles.size(), angles.size());
    for (int j = 0; j < chain.joints(); ++j) {
      const Vec2<double>& u_j = tip.rate[static_cast<std::size_t>(j)];
      slope[j] = k * chain.spring(j) * angles[j] - load.moment * chain.turn_weight(j) - dot(F, u_j);
      curvature(j, j) += k * chain.spring(j);
      for (int l = 0; l < chain.joints(); ++l) {
        const Vec2<double>& u_l = tip.rate[static_cast<std::size_t>(l)];
        const double along = dot(tip.position, u_j) * dot(tip.position, u_l) / (chord * chord * chord);
        curvature(j, l) -= dot(F, tip.rate_rate(j, l)) + load.chord_force * (dot(u_j, u_l) / chord - along);
      }
    }
    const VectorXd step = curvature.ldlt().solve(slope);
    angles -= step;
    if (step.lpNorm<Eigen::Infinity>() < 1e-15) break;
  }
  return angles;
}

TEST(PseudoRigid, LoadedChainsAreTheirs) {
  const Json& about = test::reference_file("data/tdpcr/statics.json")["about"];
  const double stiffness = about["EI"];
  const PseudoRigid paper{.length = 0.2, .links = 6, .model = PrbDiscretisation::even};
  for (const Json& law : test::reference_file("data/tdpcr/statics2.json")["leg_law_M0"]) {
    const VectorXd angles = equilibrium(paper, stiffness, {.moment = law["m"], .chord_force = law["f"]});
    EXPECT_LT((angles - vector_of(law["theta"])).lpNorm<Eigen::Infinity>(), 1e-12);
    EXPECT_NEAR(paper.tip(span_of(angles)).position.norm(), law["rho"].get<double>(), 1e-13);
    EXPECT_NEAR(paper.turn(span_of(angles)), law["sum_theta"].get<double>(), 1e-12);
  }
  for (const Json& load : test::reference_file("data/tdpcr/statics.json")["elastica_convergence"])
    for (const Json& prb : load["prb"])
      for (const PrbDiscretisation model : {PrbDiscretisation::even, PrbDiscretisation::weighted}) {
        const PseudoRigid chain{.length = 0.2, .links = prb["n"], .model = model};
        const VectorXd angles =
            equilibrium(chain, stiffness, {.moment = load["m"], .chord_force = load["f"]});
        const bool is_weighted = model == PrbDiscretisation::weighted;
        EXPECT_NEAR(chain.tip(span_of(angles)).position.norm(),
                    prb[is_weighted ? "rho_weighted" : "rho_paper"].get<double>(), 1e-12);
        EXPECT_NEAR(chain.turn(span_of(angles)),
                    prb[is_weighted ? "turn_weighted" : "turn_paper"].get<double>(), 1e-11);
      }
}

/// p of an error that falls as links^−p.
double order(double coarse, double fine) { return std::log2(std::abs(coarse / fine)); }

TEST(PseudoRigid, WithMoreLinksAMomentMakesAnArc) {  // of second order with weights, else the turn of first
  const double stiffness = 3e-3, moment = -0.02, curvature = -moment / stiffness;
  const Arc arc{0.2};
  for (const ChainBase base : bases)
    for (const PrbDiscretisation model : {PrbDiscretisation::even, PrbDiscretisation::weighted}) {
      const auto errors = [&](int links) {
        const PseudoRigid chain{.length = 0.2, .links = links, .base = base, .model = model};
        const VectorXd angles = equilibrium(chain, stiffness, {.moment = moment});
        const double chord = chain.tip(span_of(angles)).position.norm() - arc.chord(curvature),
                     turn = chain.turn(span_of(angles)) + curvature * 0.2;
        const double tip = (chain.tip(span_of(angles)).position - arc.tip(curvature).position).norm();
        return std::array{chord, turn, tip};
      };
      const auto coarse = errors(12), fine = errors(24);
      EXPECT_NEAR(order(coarse[0], fine[0]), 2, 0.1);
      const bool is_weighted = model == PrbDiscretisation::weighted, is_pinned = base == ChainBase::pinned;
      if (is_weighted) {
        EXPECT_LT(std::abs(fine[1]), 1e-14);  // the turn is exact
      } else if (is_pinned) {
        EXPECT_NEAR(order(coarse[1], fine[1]), 1, 0.1);
      }
      if (is_pinned) continue;  // its first link, not the backbone, points along +y
      EXPECT_NEAR(order(coarse[2], fine[2]), is_weighted ? 2 : 1, 0.15);
    }
}

TEST(PseudoRigid, ClampedAndPulledAcrossItTendsToTheElastica) {
  const double stiffness = 3e-3, length = 0.2;
  const Vec2<double> force(0.05, -0.03);
  const auto rod = elastica_under_force(force * (length * length / stiffness));
  ASSERT_TRUE(rod.status == Status::converged);
  const Vec2<double> elastica = length * rod.state.tip;
  const auto error = [&](PrbDiscretisation model, int links) {
    const PseudoRigid chain{.length = length, .links = links, .base = ChainBase::clamped, .model = model};
    return (chain.tip(span_of(equilibrium(chain, stiffness, {.force = force}))).position - elastica).norm();
  };
  EXPECT_NEAR(order(error(PrbDiscretisation::weighted, 16), error(PrbDiscretisation::weighted, 32)), 2, 0.15);
  EXPECT_NEAR(order(error(PrbDiscretisation::even, 16), error(PrbDiscretisation::even, 32)), 1, 0.15);
}

}  // namespace pseudo_rigid_test
}  // namespace sinew
