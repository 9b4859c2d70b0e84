#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "sinew/kernel/fixed.h"
#include "sinew/kernel/serial.h"
#include "sinew/kernel/tendon_state.h"

namespace sinew::kernel {
namespace section_test {

constexpr double limit = 24 * std::numbers::pi / 180, mm = 1;

template <class Angle, class Length = Angle>
constexpr auto table_2(Backbone backbone) {
  return make_serial<5, 3, Angle, Length>(backbone, 8, 2.375 * mm, 2.45 * mm, limit);
}

TEST(KernelArc, ChordLossKeepsAllDigits) {  // @verifies LSK (6)
  for (const double bend : {1e-160, 1e-9, 1e-3, 0.1, 0.49999, 0.50001, 1.0, 2.0, 3.14159, 3.1416, 5.0, 6.2}) {
    const double half = bend / 2;
    // sin h/h − 1 by the long double library, and by its series where that cancels
    const long double h = half;
    const long double exact = bend < 0.2 ? -h * h / 6 * (1 - h * h / 20 * (1 - h * h / 42 * (1 - h * h / 72)))
                                         : std::sin(h) / h - 1;
    EXPECT_NEAR(chord_loss(half * half) / static_cast<double>(exact), 1, 2e-15) << bend;
    if (bend < 1e-15) continue;  // below what a float's square can be
    EXPECT_NEAR(static_cast<double>(chord_loss(static_cast<float>(half * half))) / static_cast<double>(exact),
                1, bend < 3.15 ? 1e-6 : 1e-5)
        << bend;
  }
  EXPECT_EQ(chord_loss(0.0), 0.0);
}

TEST(KernelArc, ArcOverChordIsTheInverse) {
  for (double bend = 0; bend < 3.14; bend += 0.01) {
    const double sine = std::sin(bend / 2), expected = bend == 0 ? 1 : bend / (2 * sine);
    EXPECT_NEAR(arc_over_chord(sine * sine), expected, 1e-15 * expected * (1 + 1 / std::cos(bend / 2)));
    using F = Fixed<32, 28>;
    EXPECT_NEAR(static_cast<double>(arc_over_chord(F(sine * sine))), expected, bend < 2.9 ? 2e-6 : 2e-2)
        << bend;
  }
  EXPECT_NEAR(arc_over_chord(7.0), std::numbers::pi / 2, 1e-15);  // longer than any chord: half a turn
}

/// Largest difference that changes and back make, over random bends within the limit.
template <Model model, class Angle, class Length>
double round_trip(const Serial<5, 3, Angle, Length>& robot) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> bend(-limit, limit);
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    Bend<Angle> bends[5], back[5];
    Length changes[5][3];
    for (auto& b : bends) b = {Angle(bend(random)), Angle(bend(random))};
    bends[k % 5] = {Angle(0.0), Angle(0.0)};
    robot.template changes<model>(bends, changes);
    robot.template bends<model>(changes, back);
    for (int m = 0; m < 5; ++m) {
      worst = std::fmax(worst, std::fabs(static_cast<double>(back[m].x) - static_cast<double>(bends[m].x)));
      worst = std::fmax(worst, std::fabs(static_cast<double>(back[m].y) - static_cast<double>(bends[m].y)));
    }
  }
  return worst;
}

template <class Angle, class Length = Angle>
void expect_round_trips(double tolerance) {
  for (const Backbone backbone : {Backbone::twin_pivot, Backbone::neutral}) {
    EXPECT_LT((round_trip<Model::exact>(table_2<Angle, Length>(backbone))), tolerance);
    EXPECT_LT((round_trip<Model::linear>(table_2<Angle, Length>(backbone))), tolerance);
  }
}

TEST(KernelSerial, BendsComeBackFromTheirChanges) {  // @verifies LSK (10)
  expect_round_trips<double>(1e-14);
  expect_round_trips<float>(1e-5);
  expect_round_trips<Fixed<32, 27>, Fixed<32, 20>>(1e-5);
  expect_round_trips<Fixed<16, 12>, Fixed<16, 9>>(2e-3);
}

/// Length of a tendon through one neutral joint or one axis of a twin pivot, from holes in discs at the ends
/// of the arc.
double hole_to_hole(double joint, double radius, double bend, double across) {
  // In the bending plane the base hole is at (across·r, 0), the tip hole turned by the bend.
  const std::complex<double> chord =
      bend == 0 ? std::complex<double>(0, joint)
                : std::complex<double>((1 - std::cos(bend)) / bend, std::sin(bend) / bend) * joint;
  const std::complex<double> hole = radius * across * std::polar(1.0, -bend);
  return std::abs(chord + hole - radius * across);
}

TEST(KernelSerial, ExactChangesAreDistancesBetweenHoles) {  // @verifies LSK (1), (2), (5), (9), (15)
  const auto twin = table_2<double>(Backbone::twin_pivot), neutral = table_2<double>(Backbone::neutral);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> bend(-limit, limit);
  for (int k = 0; k < 100; ++k) {
    Bend<double> bends[5];
    double of_twin[5][3], of_neutral[5][3], straight = 0;
    for (auto& b : bends) b = {bend(random), bend(random)};
    twin.changes<Model::exact>(bends, of_twin);
    neutral.changes<Model::exact>(bends, of_neutral);
    for (int m = 0; m < 5; ++m) {
      straight += 8 * 2.375;
      for (int i = 0; i < 3; ++i) {
        const auto d = twin.directions[m][i];
        double twin_length = 0, neutral_length = 0;
        for (int j = 0; j <= m; ++j) {
          twin_length += 4 * (hole_to_hole(2.375, 2.45, bends[j].x, d.cosine) +
                              hole_to_hole(2.375, 2.45, bends[j].y, d.sine));
          const double theta = std::hypot(bends[j].x, bends[j].y), phi = std::atan2(bends[j].y, bends[j].x);
          neutral_length +=
              8 * hole_to_hole(2.375, 2.45, theta / 8, std::cos(phi) * d.cosine + std::sin(phi) * d.sine);
        }
        EXPECT_NEAR(of_twin[m][i], twin_length - straight, 1e-12);
        EXPECT_NEAR(of_neutral[m][i], neutral_length - straight, 1e-12);
      }
    }
  }
}

TEST(KernelSerial, TablesAreConstants) {
  constexpr auto robot = table_2<float>(Backbone::twin_pivot);
  static_assert(robot.sections[0].gain == 4 * 2.45F);
  for (int m = 0; m < 5; ++m)
    for (int i = 0; i < 3; ++i) {
      const double angle = (m + 1) * limit + 2 * std::numbers::pi * i / 3;
      constexpr auto exact = table_2<double>(Backbone::twin_pivot);
      EXPECT_NEAR(exact.directions[m][i].cosine, std::cos(angle), 6e-16);
      EXPECT_NEAR(exact.directions[m][i].sine, std::sin(angle), 6e-16);
    }
}

TEST(KernelFixed, RoundsAndSaturates) {
  using F = Fixed<16, 8>;
  static_assert(F(1.5).raw == 384);
  static_assert(F(1000.0).raw == 32767);
  static_assert(F(-1000.0).raw == -32768);
  static_assert((F(100.0) + F(100.0)).raw == 32767);
  static_assert((F(-100.0) - F(100.0)).raw == -32768);
  static_assert(F(F(1.5) * F(-2.25)) == F(-3.375));
  static_assert(F(Fixed<16, 15>(0.5)) == F(0.5));
  static_assert(Fixed<16, 15>(F(3.0)).raw == 32767);  // does not fit
  static_assert((F(1.0) / F(0.0)).raw == 32767);
  static_assert((F(-3.0) / F(2.0)) == F(-1.5));
  static_assert((-F(-128.0)).raw == 32767);
  using Short = Fixed<8, 4>;
  static_assert(Short(1.5).raw == 24 && Short(9.0).raw == 127 && (Short(7.0) + Short(7.0)).raw == 127);
  static_assert(Short(Short(1.5) * Short(-2.25)) == Short(-3.375));
  static_assert((Short(-3.0) / Short(2.0)) == Short(-1.5) && Short(F(7.96875)).raw == 127);
  EXPECT_EQ(F(std::nan("")).raw, -32768);
  for (double a = -2; a < 2; a += 0.01)
    EXPECT_LE(std::fabs(static_cast<double>(F(Fixed<32, 20>(a))) - static_cast<double>(Fixed<32, 20>(a))),
              0.5 / 256);
}

TEST(KernelTendonState, ComesFromWhatIsBeyondTheModel) {  // [LSK] section 4.1
  EXPECT_EQ(tendon_state(0.01, 0.05), TendonState::exact);
  EXPECT_EQ(tendon_state(0.06, 0.05), TendonState::slack);
  EXPECT_EQ(tendon_state(-0.06, 0.05), TendonState::over_tensioned);
  constexpr auto robot = table_2<double>(Backbone::twin_pivot);
  const Pull<double> bent = exact_pull(robot.sections[0], Bend<double>{0.2, 0.1});
  const double change = tendon_change(bent, robot.directions[0][1]);
  EXPECT_NEAR(tendon_slack(change + 0.3, bent, robot.directions[0][1]), 0.3, 1e-15);
}

}  // namespace section_test
}  // namespace sinew::kernel
