/// What linearised tendon lengths cost, against tests/data/lsk, whose numbers come from another
/// implementation in many digits, and against integrals and poses by hand.
#include "analysis/chord_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "serial_robots.hpp"

namespace sinew::test {
namespace chord_error_test {

using kernel::Model;
using std::numbers::pi;

double number(const nlohmann::json& text) { return std::stod(text.get<std::string>()); }

constexpr double percent_per_degree = 100 * (pi / 180) * (pi / 180);

/// ∫ f over 0 … range, Gauss's three points on many pieces.
template <class F>
double integral(double range, const F& f) {
  constexpr int pieces = 200;
  const double h = 0.5 * range / pieces, at = std::sqrt(0.6);
  double sum = 0;
  for (int k = 0; k < pieces; ++k) {
    const double middle = (2 * k + 1) * h;
    sum += h * (5 * f(middle - at * h) + 8 * f(middle) + 5 * f(middle + at * h)) / 9;
  }
  return sum;
}

// ---------------------------------------------------------------- the error and its mean

TEST(ChordError, IsTheirsAtEveryDegree) {  // @verifies LSK (17)
  const auto curve = lsk_reference("references")["error_curve"];
  ASSERT_EQ(curve.size(), 46U);
  for (const auto& row : curve) {
    const double error = number(row["e_pct"]), bend = degrees(row["beta_deg"].get<double>());
    EXPECT_NEAR(100 * chord_error(bend), error, 1e-14) << row["beta_deg"];
    EXPECT_EQ(chord_error(-bend), chord_error(bend));
  }
}

TEST(ChordError, KeepsItsDigitsWhereThePrintedFormHasNone) {
  EXPECT_EQ(chord_error(0), 0);
  for (const double bend : {1e-4, 1e-8, 1e-12, 1e-100}) {
    const double square = bend * bend;
    EXPECT_NEAR(chord_error(bend) / (square / 24 * (1 + 7 * square / 240)), 1, 1e-15) << bend;
  }
  EXPECT_EQ(1e-8 / (2 * std::sin(0.5e-8)) - 1, 0);  // LSK (17) as printed
}

TEST(ChordError, IsWhatEveryTendonOfABentJointIsOffBy) {  // @verifies LSK (17)
  Section section = nottingham().sections[0];
  section.segments = 2;
  for (const double bend : {-3.0, -0.9, 0.1, 0.41, 2.7})
    for (const double angle : {0.0, 0.4, 1.5, 4.0}) {
      const auto map = section.map();
      const auto at = kernel::direction<double>(angle);
      const double exact =
          2 * section.joint + kernel::tendon_change(kernel::exact_pull(map, {bend, bend}), at);
      const double linear =
          2 * section.joint + kernel::tendon_change(kernel::linear_pull(map, {bend, bend}), at);
      EXPECT_NEAR(linear / exact, 1 + chord_error(bend), 1e-14) << bend << ' ' << angle;
    }
}

TEST(ChordErrors, MeanIsTheIntegral) {  // @verifies LSK (19), (20)
  const auto derived = lsk_reference("references")["derived"];
  const ChordErrors table2 = chord_errors(degrees(24));
  EXPECT_NEAR(100 * table2.largest, number(derived["e_at_24deg_pct"]), 1e-14);
  EXPECT_NEAR(100 * table2.mean, number(derived["mean_e_0_24_pct"]), 1e-14);
  EXPECT_NEAR(100 * table2.largest / 3, number(derived["e24_over_3"]), 1e-14);
  for (const double range : {1e-6, 0.1, 1.0, 2.5, pi}) {
    const double mean = integral(range, chord_error) / range;
    EXPECT_NEAR(chord_errors(range).mean / mean, 1, 1e-12) << range;
    EXPECT_LT(mean, chord_error(range) / 3 * (1 + 1e-9));  // a third is that of the first term alone
  }
  EXPECT_EQ(chord_errors(0).mean, 0);
}

// ---------------------------------------------------------------- the parabola

TEST(ChordErrorFit, GivesTheirCoefficients) {  // @verifies LSK (18)
  const auto fit = lsk_reference("error_precision")["fit_1.289e-3"];
  const auto coefficient = [](QuadraticFit way) {
    return fit_chord_error(way, degrees(45)).coefficient * percent_per_degree;
  };
  const auto expect = [&](QuadraticFit way, const char* key, double tolerance) {
    EXPECT_NEAR(coefficient(way) / fit[key].get<double>(), 1, tolerance) << key;
  };
  // Theirs are sums over samples with both ends, ours integrals: they differ by what two samples weigh.
  expect(QuadraticFit::least_squares, "lsq_c_b2", 5e-6);
  expect(QuadraticFit::with_constant, "lsq_quadratic_with_constant_leading", 5e-6);
  expect(QuadraticFit::minimax, "minimax_c_b2", 5e-9);
  expect(QuadraticFit::taylor, "taylor_100/24*(pi/180)^2", 1e-15);
  expect(QuadraticFit::endpoint, "endpoint_45", 1e-14);
  const double constant = 100 * fit_chord_error(QuadraticFit::with_constant, degrees(45)).constant;
  EXPECT_NEAR(constant / fit["lsq_quadratic_with_constant_c0"].get<double>(), 1, 1e-3);
}

TEST(ChordErrorFit, OnlyTheOneWithAConstantRoundsToThePrintedNumber) {
  const auto printed = [](QuadraticFit way) {
    return std::round(fit_chord_error(way, degrees(45)).coefficient * percent_per_degree * 1e6) == 1289;
  };
  EXPECT_TRUE(printed(QuadraticFit::with_constant));
  for (const auto way :
       {QuadraticFit::least_squares, QuadraticFit::minimax, QuadraticFit::taylor, QuadraticFit::endpoint})
    EXPECT_FALSE(printed(way));
}

TEST(ChordErrorFit, LeastSquaresLeaveNothingAlongTheirTerms) {
  for (const double range : {0.3, 0.785, 2.0, pi}) {
    const Quadratic pure = fit_chord_error(QuadraticFit::least_squares, range),
                    both = fit_chord_error(QuadraticFit::with_constant, range);
    const auto left = [range](const Quadratic& q, int power) {
      return integral(range, [&](double b) {
        return (chord_error(b) - q.coefficient * b * b - q.constant) * std::pow(b, power);
      });
    };
    const double size = chord_error(range);
    EXPECT_NEAR(left(pure, 2) / size, 0, 1e-11) << range;
    EXPECT_NEAR(left(both, 2) / size, 0, 1e-11) << range;
    EXPECT_NEAR(left(both, 0) / size, 0, 1e-11) << range;
  }
}

TEST(ChordErrorFit, MissesByWhatItSaysAndMinimaxByLeast) {
  for (const double range : {0.785, 2.5}) {
    double least = 1;
    for (const auto way : {QuadraticFit::least_squares, QuadraticFit::taylor, QuadraticFit::endpoint,
                           QuadraticFit::minimax, QuadraticFit::with_constant}) {
      const Quadratic q = fit_chord_error(way, range);
      double most = 0;
      for (int k = 0; k <= 20000; ++k) {
        const double b = range * k / 20000;
        most = std::max(most, std::abs(chord_error(b) - q.coefficient * b * b - q.constant));
      }
      EXPECT_NEAR(most / q.largest_miss, 1, 1e-6) << range;
      if (q.constant == 0) least = std::min(least, q.largest_miss);
    }
    EXPECT_EQ(least, fit_chord_error(QuadraticFit::minimax, range).largest_miss);
  }
}

// ---------------------------------------------------------------- whole robots

TEST(EqualBends, LengthsAreTheCorrectedOnes) {  // @verifies LSK (21), (22)
  const SerialRobot robot = nottingham();
  const auto derived = lsk_reference("references")["derived"];
  const TendonLengths lengths = lengths_at_equal_bends(robot, degrees(24), degrees(45));
  EXPECT_NEAR(lengths.exact * 1e3, number(derived["eq21_fixed_mm"]), 1e-12);
  EXPECT_NEAR(lengths.linear * 1e3, number(derived["eq22_fixed_mm"]), 1e-12);
  const double b = degrees(24), L = 2.375, r = 2.45;
  const double printed_21 = 40 * (L / b - std::sqrt(2) * r) * std::sin(b / 2);
  const double printed_22 = 40 * (L - std::sqrt(2) * r * b);
  EXPECT_NEAR(printed_22 / printed_21 - 1, 1.0147, 1e-4);  // not 0.7 %
}

TEST(EqualBends, RelativeErrorHasNoDirectionAndTheAbsoluteOneIsThatOfTheOuterTendon) {
  const SerialRobot robot = nottingham();
  double most = 0, worst = 0;
  for (int d = 0; d < 360; d += 5) {
    const TendonLengths lengths = lengths_at_equal_bends(robot, degrees(24), degrees(d));
    EXPECT_NEAR(lengths.linear / lengths.exact - 1, chord_error(degrees(24)), 1e-14) << d;
    if (lengths.linear - lengths.exact > most) {
      most = lengths.linear - lengths.exact;
      worst = d;
    }
  }
  EXPECT_EQ(worst, 225);
}

TEST(TendonEvaluations, AreThoseOfThePaper) {  // @verifies LSK (5), (12)
  const auto derived = lsk_reference("references")["derived"];
  for (int m = 1; m <= 10; ++m) {
    const auto count = tendon_evaluations(m);
    EXPECT_EQ(count.anew, derived["K_pcc"][static_cast<std::size_t>(m - 1)]);
    EXPECT_EQ(count.carried, derived["K_lsk"][static_cast<std::size_t>(m - 1)]);
    EXPECT_EQ(2 * count.anew, (m + 1) * count.carried);  // not M times as many
  }
  EXPECT_EQ(tendon_evaluations(5, 4).carried, 20);
}

TEST(LinearCommands, AreNeverTooShort) {
  std::mt19937 random(5);
  for (const auto backbone : {kernel::Backbone::twin_pivot, kernel::Backbone::neutral}) {
    const SerialRobot robot = nottingham(backbone, 5, 4);
    SerialWorkspace work(robot);
    for (int k = 0; k < 200; ++k) {
      const auto bends = random_bends(robot, random);
      tendon_changes(bends, Model::exact, work);
      const std::vector<double> exact = work.changes;
      tendon_changes(bends, Model::linear, work);
      for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_GE(work.changes[i], exact[i]);
    }
  }
}

TEST(LinearConsequences, OfRandomPosesAreTheirs) {
  const auto theirs = lsk_reference("lsk_consequences");
  const LinearConsequences ours = linear_consequences(nottingham(), 20000, 7);
  const auto expect = [&](const Distances& d, const char* key) {  // four standard errors
    EXPECT_NEAR(d.mean * 1e3, theirs[key]["mean"].get<double>(), 0.012) << key;
    EXPECT_NEAR(d.p95 * 1e3, theirs[key]["p95"].get<double>(), 0.035) << key;
    EXPECT_GT(d.largest * 1e3, 2.2);
    EXPECT_LT(d.largest * 1e3, 4.0);
  };
  expect(ours.commanded, "tip_error_mm_lsk_command");
  expect(ours.read_back, "tip_error_mm_lsk_inverse_of_true_lengths");
  const auto& slack = theirs["mean_slack_mm_per_section_cables"];
  ASSERT_EQ(ours.slack.size(), 5U);
  for (std::size_t m = 0; m < 5; ++m) {
    EXPECT_NEAR(ours.slack[m].mean * 1e3, slack["mean"][m].get<double>(), 0.001 * std::sqrt(double(m + 1)))
        << m;
    EXPECT_LE(ours.slack[m].largest * 1e3, slack["max"][m].get<double>());
  }
  EXPECT_EQ(ours.left_out, 0);
}

TEST(LinearConsequences, SlackAtMostIsTheirs) {
  const auto theirs = lsk_reference("lsk_consequences");
  const auto ours = largest_linear_slack(nottingham());
  for (std::size_t m = 0; m < 5; ++m) {
    EXPECT_NEAR(ours[m].slack * 1e3, theirs["mean_slack_mm_per_section_cables"]["max"][m].get<double>(),
                1e-12);
    EXPECT_NEAR(ours[m].dead_zone,
                degrees(theirs["dead_zone_cumulative_section_bend_deg_at_max"][m].get<double>()), 1e-13);
  }
}

TEST(LinearConsequences, FarthestBendsOfSectionOneAreTheirs) {
  const Section section = nottingham().sections[0];
  for (const auto& row : lsk_reference("lsk_consequences")["section1_feasible_set_under_lsk_lengths"]) {
    const Bend bend(degrees(row["beta_deg"][0].get<double>()), degrees(row["beta_deg"][1].get<double>()));
    EXPECT_NEAR(linear_freedom(section, bend), degrees(row["farthest_feasible_per_joint_deg"].get<double>()),
                1e-10);
  }
  EXPECT_NEAR(linear_freedom(section, Bend(0, 0)), 0, 1e-6);
}

/// One section of twin pivots driven by LSK: its joints bend by 2 asin(β/2), most at the corner of the
/// limits.
TEST(LinearConsequences, OfOneSectionStayBelowThatOfTheCorner) {
  const SerialRobot robot = nottingham(kernel::Backbone::twin_pivot, 1);
  const LinearConsequences ours = linear_consequences(robot, 5000, 3);
  const double meant = degrees(24), bent = 2 * std::asin(meant / 2);
  const Section& section = robot.sections[0];
  const Vec<double, 3> there = section.pose(Vec2<double>(meant, meant)).p,
                       here = section.pose(Vec2<double>(bent, bent)).p;
  const double corner = (here - there).norm();
  EXPECT_LT(ours.commanded.largest, corner);
  EXPECT_GT(ours.commanded.largest, 0.9 * corner);
}

TEST(LinearConsequences, AreTheSameOfTheSameSeedOnly) {
  const SerialRobot robot = nottingham(kernel::Backbone::neutral, 2);
  const LinearConsequences a = linear_consequences(robot, 300, 1), b = linear_consequences(robot, 300, 1),
                           c = linear_consequences(robot, 300, 2);
  EXPECT_EQ(a.commanded.mean, b.commanded.mean);
  EXPECT_EQ(a.read_back.largest, b.read_back.largest);
  EXPECT_NE(a.commanded.mean, c.commanded.mean);
}

TEST(LinearConsequences, PosesWithoutArcsAreLeftOut) {
  SerialRobot robot = nottingham(kernel::Backbone::twin_pivot, 1);
  robot.sections[0].limit = 1.99;
  EXPECT_EQ(linear_consequences(robot, 500, 1).left_out, 0);
  robot.sections[0].limit = 2.5;  // of the square, 1 − 0.8² asks for a chord beyond 2
  EXPECT_NEAR(linear_consequences(robot, 2000, 1).left_out, 720, 90);
  EXPECT_EQ(linear_consequences(robot, 0, 1).commanded.mean, 0);
}

}  // namespace chord_error_test
}  // namespace sinew::test
