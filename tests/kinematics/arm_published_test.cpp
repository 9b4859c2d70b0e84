/// A two-section arm as a public code computes it, model by model, and what that differs from balance by
/// energy (docs/theory/arm_models.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "arms.hpp"
#include "math/linalg.hpp"
#include "reference_file.hpp"

namespace sinew::test {
namespace arm_published_test {

using Json = nlohmann::json;

/// Largest difference of a tip from row-major 3×4 numbers [m].
double distance(const SE3<double>& tip, const Json& T) {
  return std::max({std::abs(tip.p[0] - T[3].get<double>()), std::abs(tip.p[1] - T[7].get<double>()),
                   std::abs(tip.p[2] - T[11].get<double>())});
}
double rotation_distance(const SE3<double>& tip, const Json& T) {
  const Mat<double, 3, 3> R = tip.R.matrix();
  double most = 0;
  for (int i = 0; i < 9; ++i)
    most = std::max(most,
                    std::abs(R(i / 3, i % 3) - T[static_cast<std::size_t>(i / 3 * 4 + i % 3)].get<double>()));
  return most;
}
const Json& cases() { return reference_file("data/field/tdcr_two_segment_models.json")["cases"]; }
ArmLoad load_of(const Json& c) {
  ArmLoad load;
  for (std::size_t i = 0; i < 3; ++i) {
    load.wrench[i] = c["tip_force_N_base_frame"][i].get<double>();
    load.wrench[i + 3] = c["tip_moment_Nm_base_frame"][i].get<double>();
  }
  return load;
}
std::vector<TendonCommand> commands_of(const Json& c) {
  return tensions(c["tensions_N"].get<std::vector<double>>());
}
const Json& tip_of(const Json& c, const char* model) { return c["models"][model]["tip_T_rowmajor_3x4"]; }

ArmState solved(const Arm& arm, const Json& c, ArmModel model, ArmBalance balance) {
  ArmWorkspace work(arm);
  const ArmState state =
      arm_forward(arm, commands_of(c), load_of(c), {.model = model, .balance = balance}, work);
  EXPECT_TRUE(state.report.ok()) << to_string(state.report);
  EXPECT_LE(state.report.residual, 1e-10);
  EXPECT_EQ(state.stability_told, balance == ArmBalance::energy);
  return state;
}

TEST(ArmPublished, SubsegmentConstantCurvatureCollocated) {
  const Arm arm = two_sections();
  double most = 0;
  for (const Json& c : cases()) {
    const ArmState state = solved(arm, c, ArmModel::subsegment_cc, ArmBalance::collocated);
    const Json& T = tip_of(c, "CCsub_PiecewiseConstantCurvature");
    most = std::max(most, distance(state.tip, T));
    EXPECT_LT(distance(state.tip, T), 1e-8) << c["tensions_N"];
    EXPECT_LT(rotation_distance(state.tip, T), 1e-8) << c["tensions_N"];
  }
  std::printf("subsegment_cc collocated: from the code's numbers at most %.1e m\n", most);
}

TEST(ArmPublished, SubsegmentRodProjected) {
  const Arm arm = two_sections();
  double most = 0;
  for (const Json& c : cases()) {
    const ArmState state = solved(arm, c, ArmModel::subsegment_rod, ArmBalance::projected);
    const Json& T = tip_of(c, "VCref_SubsegmentCosserat");
    most = std::max(most, distance(state.tip, T));
    EXPECT_LT(distance(state.tip, T), 1e-5) << c["tensions_N"];
    EXPECT_LT(rotation_distance(state.tip, T), 3e-5) << c["tensions_N"];
  }
  std::printf("subsegment_rod projected: from the code's numbers at most %.1e m\n", most);
}

/// Its numbers stopped that far from its own equations: in the second case x has to be 0, and is 3e-5 m.
TEST(ArmPublished, PseudoRigidCollocated) {
  const Arm arm = two_sections();
  double most = 0;
  for (const Json& c : cases()) {
    const ArmState state = solved(arm, c, ArmModel::prb, ArmBalance::collocated);
    most = std::max(most, distance(state.tip, tip_of(c, "PRB_3dof_per_subsegment")));
    EXPECT_LT(distance(state.tip, tip_of(c, "PRB_3dof_per_subsegment")), 1e-4) << c["tensions_N"];
  }
  std::printf("prb collocated: from the code's numbers at most %.1e m\n", most);
  EXPECT_NEAR(solved(arm, cases()[1], ArmModel::prb, ArmBalance::collocated).tip.p.x(), 0, 1e-9);
}

/// The file's displacements are those of a tendon along its own section: that of the second one adds.
std::vector<TendonCommand> pulled(const Json& c) {
  auto pulls = c["models"]["CC_from_VCref_displacements"]["input_displacements_m"].get<std::vector<double>>();
  for (std::size_t i = 0; i < 3; ++i) pulls[i + 3] += pulls[i];
  for (double& pull : pulls) pull = -pull;
  return changes(pulls);
}

TEST(ArmPublished, ConstantCurvatureInClosedForm) {
  const Arm arm = two_sections();
  ArmWorkspace work(arm);
  double most = 0;
  for (const Json& c : cases()) {
    const ArmState& state =
        arm_forward(arm, pulled(c), {}, {.model = ArmModel::cc, .balance = ArmBalance::closed_form}, work);
    ASSERT_TRUE(state.report.ok()) << to_string(state.report);
    const Json& T = tip_of(c, "CC_from_VCref_displacements");
    most = std::max(most, distance(state.tip, T));
    EXPECT_LT(distance(state.tip, T), 1e-9);
    EXPECT_LT(rotation_distance(state.tip, T), 1e-9);
  }
  std::printf("cc closed_form: from the code's numbers at most %.1e m\n", most);
}

/// The force that the public code leaves out where the first section ends, turned round: distal tendons bend
/// there as the backbone's strain jumps, and press on the last disc.
std::array<double, 6> left_out(const Arm& arm, const ArmWorkspace& work, const Json& c) {
  const double end = arm.sections[0].length, beside[] = {end * (1 - 1e-9), end * (1 + 1e-9)};
  const auto strains = arm_strains(arm, beside, work);
  std::array<double, 6> wrench{};
  for (std::size_t i = 3; i < 6; ++i) {
    const TendonRoute& route = arm.tendons[i].routes[0];
    const Vec3<double> place(route.end_radius * std::cos(route.end_angle),
                             route.end_radius * std::sin(route.end_angle), 0);
    const auto way = [&](const std::array<double, 6>& s) {
      const Vec3<double> along =
          Vec3<double>(s[0], s[1], s[2]) + cross(Vec3<double>(s[3], s[4], s[5]), place);
      return Vec3<double>(along / along.norm());
    };
    const Vec3<double> force = (way(strains[0]) - way(strains[1])) * c["tensions_N"][i].get<double>(),
                       moment = cross(place, force);
    for (std::size_t k = 0; k < 3; ++k) {
      wrench[k] += force[static_cast<int>(k)];
      wrench[k + 3] += moment[static_cast<int>(k)];
    }
  }
  return wrench;
}

/// The rod of the public code by shooting, from equations: in body axes the wrench of backbone and tendons
/// together, g(ξ) = C(ξ − ξ₀) + Σ τ (t, r × t), is carried along unchanged where no load acts, so that
/// (∂g/∂ξ) ξ′ = −(u × n, u × m + v × n). Where the first section ends its tendons let go, and nothing else.
class ShotRod {
 public:
  using Six = Vec<double, 6>;
  using Square = Mat<double, 6, 6>;

  ShotRod(const Arm& arm, std::vector<double> tau, const ArmLoad& load)
      : arm_(arm),
        tau_(std::move(tau)),
        load_(load) {
    const CrossSection& c = arm.sections[0].start;
    stiffness_ << c.shear, c.shear, c.stretch, c.bending_x, c.bending_y, c.torsion;
  }
  /// Newton's method, loads growing, over the strain at the base; returns the tip's place.
  Vec3<double> tip() {
    Six base;
    base << 0, 0, 1, 0, 0, 0;
    for (int share = 1; share <= 10; ++share) {
      share_ = 0.1 * share;
      Six gap = shoot(base);
      for (int i = 0; i < 40 && gap.norm() > 1e-11; ++i) {
        Square J;
        for (int j = 0; j < 6; ++j) {
          const double h = j < 3 ? 1e-9 : 1e-5;
          Six moved = base;
          moved[j] += h;
          J.col(j) = (shoot(moved) - gap) / h;
        }
        Six step = quotient(J, gap);
        for (int half = 0; half < 10; ++half, step /= 2)
          if (const Six next = shoot(base - step); next.norm() < gap.norm()) {
            base -= step;
            gap = next;
            break;
          }
      }
    }
    residual = shoot(base).norm();
    return place_;
  }
  double residual = 0;  ///< of force and moment at the tip [N, N m]

 private:
  /// J⁻¹ b.
  static Six quotient(const Square& J, const Six& b) {
    const Eigen::Matrix<double, 6, 6, Eigen::RowMajor> rows = J;
    Six x;
    if (!solve({rows.data(), 6, 6}, {b.data(), 6, 1}, {x.data(), 6})) x.setConstant(NAN);
    return x;
  }
  static Mat<double, 3, 3> cross_matrix(const Vec3<double>& a) {
    Mat<double, 3, 3> m;
    m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
    return m;
  }
  /// Of tendons from `first` up to `last`: their wrench on a section, and ∂/∂ξ.
  Six pull(const Six& strain, std::size_t first, std::size_t last, Square* rate) const {
    Six sum = Six::Zero();
    for (std::size_t i = first; i < last; ++i) {
      const TendonRoute& route = arm_.tendons[i].routes[0];
      const Vec3<double> r(route.start_radius * std::cos(route.start_angle),
                           route.start_radius * std::sin(route.start_angle), 0),
          x = strain.head<3>() + cross(Vec3<double>(strain.tail<3>()), r), t = x / x.norm();
      const double tau = share_ * tau_[i];
      sum.head<3>() += tau * t;
      sum.tail<3>() += tau * cross(r, t);
      if (rate == nullptr) continue;
      const Mat<double, 3, 3> across = tau / x.norm() * (Mat<double, 3, 3>::Identity() - t * t.transpose()),
                              arm = cross_matrix(r);
      rate->topLeftCorner<3, 3>() += across;
      rate->topRightCorner<3, 3>() -= across * arm;
      rate->bottomLeftCorner<3, 3>() += arm * across;
      rate->bottomRightCorner<3, 3>() -= arm * across * arm;
    }
    return sum;
  }
  Six elastic(const Six& strain) const {
    Six bent = strain;
    bent[2] -= 1;
    return stiffness_.cwiseProduct(bent);
  }
  /// Strain's derivative along the rod.
  Six slope(const Six& strain, std::size_t first) const {
    Square rate = stiffness_.asDiagonal();
    const Six g = elastic(strain) + pull(strain, first, 6, &rate);
    const Vec3<double> v = strain.head<3>(), u = strain.tail<3>(), n = g.head<3>(), m = g.tail<3>();
    Six side;
    side << -cross(u, n), -cross(u, m) - cross(v, n);
    return quotient(rate, side);
  }
  /// Runge-Kutta steps; frames by Magnus steps of the same order.
  Six shoot(Six strain) {
    constexpr int steps = 100;
    const double h = 0.2 / steps;
    SE3<double> frame;
    for (const std::size_t first : {0U, 3U}) {
      for (int k = 0; k < steps; ++k) {
        const Six a = slope(strain, first), b = slope(strain + h / 2 * a, first),
                  c = slope(strain + h / 2 * b, first), d = slope(strain + h * c, first),
                  end = strain + h / 6 * (a + 2 * b + 2 * c + d),
                  middle = 0.5 * (strain + end) + h / 8 * (a - slope(end, first)), change = end - strain;
        const Vec3<double> v = middle.head<3>(), u = middle.tail<3>(), dv = change.head<3>(),
                           du = change.tail<3>();
        Six omega = h / 6 * (strain + 4 * middle + end);
        omega.head<3>() += h * h / 12 * (cross(u, dv) + cross(v, du));
        omega.tail<3>() += h * h / 12 * cross(u, du);
        frame = frame.compose(SE3<double>::exp(omega));
        strain = end;
      }
      if (first == 0) strain += pull(strain, 0, 3, nullptr).cwiseQuotient(stiffness_);
    }
    place_ = frame.p;
    const Six g = elastic(strain) + pull(strain, 3, 6, nullptr);
    const Mat<double, 3, 3> R = frame.R.matrix();
    Six gap;
    gap << R * g.head<3>(), R * g.tail<3>();
    for (int i = 0; i < 6; ++i) gap[i] -= share_ * load_.wrench[static_cast<std::size_t>(i)];
    return gap;
  }

  const Arm& arm_;
  std::vector<double> tau_;
  ArmLoad load_;
  Six stiffness_;
  double share_ = 1;
  Vec3<double> place_;
};

/// Only where the arm twists do distal tendons bend there: in the third and fourth case. With what is left
/// out made up for, all cases agree but the fourth, whose recorded numbers are 1.3 mm from the solution of
/// their own equations.
TEST(ArmPublished, RodWhoseSectionEndsWithoutForceOfDistalTendons) {
  const Arm arm = two_sections();
  const double without[] = {1e-5, 1e-5, 1e-4, 2e-3, 1e-5}, with[] = {1e-7, 2e-6, 1e-8, 2e-3, 1e-8};
  for (std::size_t k = 0; k < cases().size(); ++k) {
    const Json& c = cases()[k];
    const Json& T = tip_of(c, "VC_CosseratRod");
    ArmWorkspace work(arm);
    ArmLoad load = load_of(c);
    load.points = {{arm.sections[0].length, {}, true}};
    ArmOptions options{.model = ArmModel::rod, .order = 8, .elements = 24};
    Vec3<double> whole(0, 0, 0), tip = whole;
    for (int i = 0; i < 10; ++i) {
      const ArmState& state = arm_forward(arm, commands_of(c), load, options, work);
      ASSERT_TRUE(state.report.ok()) << to_string(state.report);
      EXPECT_LT(distance(state.tip, T), i == 9 ? with[k] : without[k]) << k;
      tip = state.tip.p;
      if (i == 0) whole = tip;
      load.points[0].wrench = left_out(arm, work, c);
      options.from_last = true;
    }
    const double effect = (tip - whole).norm();
    if (k == 2 || k == 3) {
      EXPECT_GT(effect, 3e-5);
      std::printf("rod, case %zu: the force left out moves the tip by %.1e m\n", k, effect);
    } else {
      EXPECT_LT(effect, 1e-9);
    }
    if (k == 3) {
      ShotRod shot(arm, c["tensions_N"].get<std::vector<double>>(), load_of(c));
      const double gap = (shot.tip() - tip).norm();
      EXPECT_LT(shot.residual, 1e-10);
      EXPECT_LT(gap, 1e-8);
      std::printf("rod, case 3: from the code's equations %.1e m, from its numbers %.1e m\n", gap,
                  (tip - Vec3<double>(T[3], T[7], T[11])).norm());
    }
  }
}

/// By how much these differ from balance by energy, tip to tip.
TEST(ArmPublished, DifferencesFromEnergy) {
  const Arm arm = two_sections();
  const auto differs = [&](const Json& c, ArmModel model, ArmBalance balance) {
    const ArmState a = solved(arm, c, model, balance), b = solved(arm, c, model, ArmBalance::energy);
    return 1e3 * (a.tip.p - b.tip.p).norm();
  };
  std::printf(
      "tip, less that by energy [mm]\n case  cc projected  cc collocated  rod projected  prb collocated\n");
  double most[4] = {};
  for (std::size_t k = 0; k < cases().size(); ++k) {
    const Json& c = cases()[k];
    const double mm[] = {differs(c, ArmModel::subsegment_cc, ArmBalance::projected),
                         differs(c, ArmModel::subsegment_cc, ArmBalance::collocated),
                         differs(c, ArmModel::subsegment_rod, ArmBalance::projected),
                         differs(c, ArmModel::prb, ArmBalance::collocated)};
    std::printf("%5zu  %12.4f  %13.4f  %13.4f  %14.4f\n", k, mm[0], mm[1], mm[2], mm[3]);
    for (std::size_t i = 0; i < 4; ++i) most[i] = std::max(most[i], mm[i]);
  }
  EXPECT_LT(most[2], 0.5);
  EXPECT_GT(most[1], 2);
  EXPECT_LT(most[1], 10);
}

/// Balance by energy comes to the continuous rod as the square of the distance of discs. Collocated it does
/// so only where no tip force makes the moment vary along a piece; projected it does not where the arm
/// twists.
TEST(ArmPublished, DifferencesFallWithDiscs) {
  std::printf("case  discs  energy - rod  projected - energy  collocated - projected [mm]\n");
  for (const std::size_t k : {0U, 2U, 4U}) {
    const Json& c = cases()[k];
    std::array<double, 3> gap{}, before{};
    for (const int discs : {5, 10, 20, 40}) {
      const Arm arm = two_sections(discs);
      const Vec3<double> energy = solved(arm, c, ArmModel::subsegment_cc, ArmBalance::energy).tip.p,
                         projected = solved(arm, c, ArmModel::subsegment_cc, ArmBalance::projected).tip.p,
                         collocated = solved(arm, c, ArmModel::subsegment_cc, ArmBalance::collocated).tip.p,
                         rod = solved(arm, c, ArmModel::rod, ArmBalance::energy).tip.p;
      before = gap;
      gap = {1e3 * (energy - rod).norm(), 1e3 * (projected - energy).norm(),
             1e3 * (collocated - projected).norm()};
      std::printf("%4zu  %5d  %12.4f  %18.4f  %22.4f\n", k, discs, gap[0], gap[1], gap[2]);
      if (discs > 5) {
        EXPECT_LT(gap[0], 0.3 * before[0]);
      }
    }
    if (k == 0) {
      EXPECT_LT(gap[1], 0.3 * before[1]);
      EXPECT_LT(gap[2], 0.3 * before[2]);
    } else if (k == 2) {
      EXPECT_GT(gap[1], 0.95 * before[1]);
    } else {
      EXPECT_NEAR(gap[2], 0.5 * before[2], 0.02 * before[2]);
    }
  }
}

/// Lines of tendons run through discs that have twisted; their lengths are those told.
TEST(ArmPublished, LinesAndLengthsOfTendonsAgree) {
  const Arm arm = two_sections(6);
  const Json& c = cases()[3];
  for (const ArmModel model : {ArmModel::subsegment_cc, ArmModel::prb}) {
    ArmWorkspace work(arm);
    const ArmState& state = arm_forward(arm, commands_of(c), load_of(c),
                                        {.model = model, .balance = ArmBalance::collocated}, work);
    ASSERT_TRUE(state.report.ok()) << to_string(state.report);
    const auto lines = arm_tendon_lines(arm, work);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      double length = i < 3 ? -0.2 : -0.4;
      for (std::size_t k = 1; k < lines[i].size(); ++k) length += (lines[i][k] - lines[i][k - 1]).norm();
      EXPECT_NEAR(state.changes[i], length, 1e-12) << i;
    }
    EXPECT_FALSE(arm_rates(arm, work).regular);
  }
}

/// Three sections, gravity, taper, bent at rest, more loads: both balances are near that by energy.
TEST(ArmPublished, OtherArms) {
  Arm arm = two_sections(20);
  arm.sections.push_back(arm.sections[1]);
  for (const double angle : {0.0, 120.0, 240.0})
    arm.tendons.push_back(tendon_at(2, 0.01, angle * std::numbers::pi / 180));
  arm.sections[0].end = round_section({54e9, 54e9 / 2.6, 0}, 0.0012);
  arm.sections[1].curvature = {1, 0.5, 0.3};
  for (ArmSection& section : arm.sections) section.discs.mass = 1e-4;
  arm.gravity = {0, 9.81, 0};
  ArmLoad load;
  load.following = {0.02, 0, 0, 0, 0, 0.002};
  load.points = {{0.15, {0, 0.05, 0}, false}};
  const auto pull = tensions({2, 0, 0, 0, 1.5, 0, 0.5, 0, 1});
  const auto tip = [&](ArmModel model, ArmBalance balance) {
    ArmWorkspace work(arm);
    const ArmState& state = arm_forward(arm, pull, load, {.model = model, .balance = balance}, work);
    EXPECT_TRUE(state.report.ok()) << to_string(state.report);
    const Vec3<double> cold = state.tip.p;
    const ArmState& warm =
        arm_forward(arm, pull, load, {.model = model, .balance = balance, .from_last = true}, work);
    EXPECT_TRUE(warm.report.ok()) << to_string(warm.report);
    EXPECT_LE(warm.report.iterations, 1);
    EXPECT_LT((warm.tip.p - cold).norm(), 1e-7);
    return cold;
  };
  const Vec3<double> cc = tip(ArmModel::subsegment_cc, ArmBalance::energy),
                     rod = tip(ArmModel::subsegment_rod, ArmBalance::energy);
  EXPECT_LT((tip(ArmModel::prb, ArmBalance::projected) - tip(ArmModel::prb, ArmBalance::energy)).norm(),
            5e-3);
  EXPECT_LT((tip(ArmModel::subsegment_cc, ArmBalance::projected) - cc).norm(), 5e-3);
  EXPECT_LT((tip(ArmModel::subsegment_cc, ArmBalance::collocated) - cc).norm(), 1e-2);
  EXPECT_LT((tip(ArmModel::subsegment_rod, ArmBalance::projected) - rod).norm(), 5e-3);
}

/// The straight arm is a solution of all of them, and of joints the axis is any.
TEST(ArmPublished, StraightWithoutLoad) {
  const Arm arm = two_sections(4);
  ArmWorkspace work(arm);
  for (const ArmModel model : {ArmModel::subsegment_cc, ArmModel::prb}) {
    const ArmState& state = arm_forward(arm, tensions(std::vector<double>(6, 0.0)), {},
                                        {.model = model, .balance = ArmBalance::collocated}, work);
    ASSERT_TRUE(state.report.ok()) << to_string(state.report);
    EXPECT_LT((state.tip.p - Vec3<double>(0, 0, 0.4)).norm(), 1e-14);
  }
}

/// In closed form any three tendons do, also more, at radii of their own.
TEST(ArmPublished, ClosedFormIsThatOfConstantCurvature) {
  Arm arm = two_sections();
  arm.tendons.push_back(tendon_at(1, 0.004, 2.0));
  const double curvature[2][2] = {{2, -3}, {-1, 4}};  // about x, y
  std::vector<double> change;
  for (const ArmTendon& tendon : arm.tendons) {
    double sum = 0;
    for (std::size_t m = 0; m < tendon.routes.size(); ++m) {
      const TendonRoute& route = tendon.routes[m];
      sum += 0.2 * route.start_radius *
             (curvature[m][0] * std::sin(route.start_angle) - curvature[m][1] * std::cos(route.start_angle));
    }
    change.push_back(sum);
  }
  ArmWorkspace work(arm);
  const ArmState& state = arm_forward(arm, changes(change), {},
                                      {.model = ArmModel::cc, .balance = ArmBalance::closed_form}, work);
  ASSERT_TRUE(state.report.ok()) << to_string(state.report);
  const double places[] = {0.1, 0.3};
  const auto strains = arm_strains(arm, places, work);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_NEAR(strains[m][3], curvature[m][0], 1e-9);
    EXPECT_NEAR(strains[m][4], curvature[m][1], 1e-9);
    EXPECT_NEAR(strains[m][5], 0, 1e-12);
  }
  const ArmState& short_ones = arm_forward(arm, changes(std::vector<double>(7, -0.5)), {},
                                           {.model = ArmModel::cc, .balance = ArmBalance::closed_form}, work);
  EXPECT_EQ(short_ones.report.status, Status::left_domain);
}

TEST(ArmPublished, WhatABalanceIsNotForIsNamed) {
  Arm arm = two_sections();
  ArmWorkspace work(arm);
  const auto pull = tensions({1, 0, 0, 0, 0, 0});
  const auto feed = changes(std::vector<double>(6, 0.0));
  ArmLoad pushed;
  pushed.wrench[0] = 1;
  const auto status = [&](const std::vector<TendonCommand>& commands, ArmModel model, ArmBalance balance,
                          const ArmLoad& load = {}) {
    const ArmState& state = arm_forward(arm, commands, load, {.model = model, .balance = balance}, work);
    EXPECT_FALSE(state.report.message.empty());
    return state.report.status;
  };
  EXPECT_EQ(status(pull, ArmModel::rod, ArmBalance::projected), Status::unsupported);
  EXPECT_EQ(status(pull, ArmModel::subsegment_rod, ArmBalance::collocated), Status::unsupported);
  EXPECT_EQ(status(pull, ArmModel::subsegment_cc, ArmBalance::closed_form), Status::unsupported);
  EXPECT_EQ(status(pull, ArmModel::cc, ArmBalance::closed_form), Status::unsupported);
  EXPECT_EQ(status(feed, ArmModel::subsegment_cc, ArmBalance::collocated), Status::unsupported);
  EXPECT_EQ(status(feed, ArmModel::cc, ArmBalance::closed_form, pushed), Status::unsupported);
  arm.sections[1].discs.count = 0;
  EXPECT_EQ(status(pull, ArmModel::subsegment_cc, ArmBalance::projected), Status::unsupported);
  arm.tendons[4].routes[1] = arm.tendons[3].routes[1];
  EXPECT_EQ(status(feed, ArmModel::cc, ArmBalance::closed_form), Status::unsupported);
}

}  // namespace arm_published_test
}  // namespace sinew::test
