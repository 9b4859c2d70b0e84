/// Lengths in short formats: every mean and largest error against tests/data/lsk/error_precision.json, and
/// what the arithmetic behind them is, written out here once more.
#include "analysis/number_formats.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/rough_numbers.hpp"
#include "serial_robots.hpp"
#include "sinew/kernel/fixed.h"

namespace number_formats_test {

using namespace sinew;
using namespace sinew::test;

constexpr double L = 2.375, r = 2.45;  // Table 2 [mm]
constexpr int samples = 48001;

const std::vector<FormatErrors>& table_2() {
  static const auto all = format_errors({L, r, degrees(24)}, samples);
  return all;
}

const FormatErrors& format(std::string_view name) {
  return *std::ranges::find(table_2(), name, &FormatErrors::name);
}

nlohmann::json theirs(const std::string& key) {
  return lsk_reference("error_precision")["fig9"]["result"].at(key);
}

void expect_theirs(const LengthError& error, const nlohmann::json& reference, const std::string& what,
                   double tolerance = 1e-12) {
  EXPECT_NEAR(100 * error.mean / reference["mean_pct"].get<double>(), 1, tolerance) << what;
  EXPECT_NEAR(100 * error.largest / reference["max_pct"].get<double>(), 1, tolerance) << what;
}

/// [%], of lengths over the bends of Table 2.
template <class Length>
double mean_percent(const Length& length_of) {
  double sum = 0;
  for (int k = 0; k < samples; ++k) {
    const double bend = degrees(24) * (2 * k - (samples - 1)) / (samples - 1);
    const double exact = bend == 0 ? L : 2 * (L / bend - r) * std::sin(bend / 2), length = length_of(bend);
    sum += std::isfinite(length) ? 100 * std::abs(length - exact) / exact : 100;
  }
  return sum / samples;
}

TEST(FormatErrors, AreTheirsInFixedPointHoweverItRoundsAndOverflows) {  // @verifies LSK (6), (7)
  int compared = 0;
  for (const FormatErrors& f : table_2()) {
    if (!f.coded) continue;
    const std::string name(f.name);
    const auto nearest = theirs(name + "/nearest"), down = theirs(name + "/floor");
    const char *saturated = "pcc_naive_sat_zero_guarded", *wrapped = "pcc_naive_wrap_zero_guarded";
    expect_theirs(f.nearest.quotient, nearest[saturated], name + " (6)");
    expect_theirs(f.nearest.linear, nearest["lsk"], name + " (7)");
    expect_theirs(f.coded->down.quotient, down[saturated], name + " (6) down");
    expect_theirs(f.coded->down.linear, down["lsk"], name + " (7) down");
    expect_theirs(f.coded->wrapping.quotient, nearest[wrapped], name + " (6) wrapping");
    expect_theirs(f.coded->plain.quotient, down[wrapped], name + " (6) plain");
    EXPECT_EQ(f.coded->wrapping.linear.mean, f.nearest.linear.mean) << name;  // (7) never overflows
    ++compared;
  }
  EXPECT_EQ(compared, 10);
}

TEST(FormatErrors, AreTheirsInFloatingPoint) {  // @verifies LSK (6), (7)
  expect_theirs(format("double").nearest.linear, theirs("double")["lsk"], "double");
  expect_theirs(format("float").nearest.linear, theirs("float")["lsk"], "float");
  expect_theirs(format("binary16").nearest.linear, theirs("half(binary16)")["lsk"], "binary16");
  EXPECT_LT(format("double").nearest.quotient.largest, 1e-15);  // theirs is measured by itself: 0
  // The sines of the reference are not quite the nearest floats, nor the nearest of binary16: see below.
  expect_theirs(format("float").nearest.quotient, theirs("float")["pcc_naive"], "float", 5e-4);
  expect_theirs(format("binary16").nearest.quotient, theirs("half(binary16)")["pcc_naive"], "binary16", 5e-4);
}

TEST(FormatErrors, OfTheReferencesBinary16IsOfASineRoundedTwice) {
  const auto length = [](bool twice) {
    return [twice](double bend) {
      const Binary16 b(bend), joint(L), radius(r);
      if (static_cast<double>(b) == 0) return L;
      const double sine = std::sin(static_cast<double>(b * Binary16(0.5)));
      const Binary16 quotient(static_cast<double>(joint) / static_cast<double>(b)),
          bracket = quotient - radius, rounded(twice ? static_cast<double>(static_cast<float>(sine)) : sine);
      return static_cast<double>((bracket + bracket) * rounded);
    };
  };
  const double reference = theirs("half(binary16)")["pcc_naive"]["mean_pct"].get<double>();
  EXPECT_NEAR(mean_percent(length(true)) / reference, 1, 1e-12);
  EXPECT_NEAR(mean_percent(length(false)) / (100 * format("binary16").nearest.quotient.mean), 1, 1e-12);
}

/// The reference's polynomial in fixed point ends with the square: l − l β²/24, each result rounded.
template <int Bits, int Fraction>
double shorter_polynomial() {
  using S = kernel::Fixed<Bits, Fraction>;
  return mean_percent([](double bend) {
    const S b(bend), linear = S(L) - S(S(r) * b), square = S(b * b);
    return static_cast<double>(linear - S(linear * S(square * S(1.0 / 24))));
  });
}

TEST(FormatErrors, OfTheReferencesPolynomialAreThoseOfAShorterOne) {
  const auto expect = [](const char* name, double ours) {
    EXPECT_NEAR(ours / theirs(name + std::string("/nearest"))["pcc_sinc_poly"]["mean_pct"].get<double>(), 1,
                1e-10)
        << name;
  };
  expect("Q15.16", shorter_polynomial<32, 16>());
  expect("Q7.24", shorter_polynomial<32, 24>());
  expect("Q3.28", shorter_polynomial<32, 28>());
  expect("Q7.8", shorter_polynomial<16, 8>());
  expect("Q5.10", shorter_polynomial<16, 10>());
  expect("Q4.11", shorter_polynomial<16, 11>());
  expect("Q3.12", shorter_polynomial<16, 12>());
  expect("Q2.13", shorter_polynomial<16, 13>());
  expect("Q3.4", shorter_polynomial<8, 4>());
  expect("Q2.5", shorter_polynomial<8, 5>());
}

TEST(FormatErrors, OfTheKernelsPolynomialAreNoneOfItsOwn) {  // @verifies LSK (6)
  for (const FormatErrors& f : table_2()) {
    const std::string name(f.name);
    const auto reference = theirs(f.coded ? name + "/nearest" : name == "binary16" ? "half(binary16)" : name);
    const double shorter = reference["pcc_sinc_poly"]["mean_pct"].get<double>() / 100;
    // It rounds three products where theirs rounds one, and has all terms where theirs lacks most.
    EXPECT_LT(f.nearest.chord.mean, 1.07 * shorter) << name;
    if (f.name == "Q7.24" || f.name == "Q3.28") {
      EXPECT_LT(f.nearest.chord.mean, 0.01 * shorter) << name;
    }
    // Less than one step of the format off, which is that of a length.
    if (f.coded) {
      EXPECT_LT(f.nearest.chord.mean * L, std::ldexp(1, 1 + *f.integer_bits - f.bits)) << name;
    }
  }
  EXPECT_LT(format("double").nearest.chord.largest, 1e-15);
}

TEST(FormatErrors, TheChordFactorIsNearestFrom16BitsOn) {
  for (const FormatErrors& f : table_2()) {
    if (f.bits < 16) continue;
    EXPECT_LT(f.nearest.chord.mean, f.nearest.linear.mean) << f.name;
    EXPECT_LT(f.nearest.chord.mean, f.nearest.quotient.mean) << f.name;
    EXPECT_LT(f.nearest.linear.mean, 0.01) << f.name;
    if (f.coded) {
      EXPECT_LT(f.coded->down.linear.mean, 0.01) << f.name;
    }
    if (f.bits < 64) {
      EXPECT_LT(f.inputs.mean, f.nearest.chord.mean) << f.name;
    }
    if (f.coded) {
      EXPECT_LT(f.nearest.quotient.mean, f.coded->wrapping.quotient.mean) << f.name;
    }
  }
}

TEST(FormatErrors, NotEveryFixedPointIsWorseByTheQuotient) {
  for (const FormatErrors& f : table_2()) {
    if (!f.coded) continue;
    EXPECT_EQ(f.nearest.quotient.mean < f.nearest.linear.mean, f.name == "Q15.16") << f.name;
  }
  EXPECT_LT(format("float").nearest.quotient.mean, format("float").nearest.linear.mean);
}

TEST(FormatErrors, FewerBitsBeforeThePointAreWorseForTheQuotientOnly) {
  double quotient = 0, chord = 1;
  for (const char* name : {"Q7.8", "Q5.10", "Q4.11", "Q3.12", "Q2.13"}) {
    const FormatErrors& f = format(name);
    EXPECT_GT(f.nearest.quotient.mean, quotient) << name;
    EXPECT_LT(f.nearest.chord.mean, chord) << name;
    EXPECT_NEAR(f.coded->overflows_below, L * std::ldexp(1, -*f.integer_bits), 1e-15) << name;
    quotient = f.nearest.quotient.mean;
    chord = f.nearest.chord.mean;
  }
}

TEST(FormatErrors, OfAQuotientWithManyBitsAreOverflowAlone) {
  for (const auto& [name, most] : {std::pair{"Q7.24", 128.0}, std::pair{"Q3.28", 8.0}}) {
    const auto held = [most = most](double value) { return std::clamp(value, -most, most); };
    const double clamped = mean_percent(
        [&](double bend) { return bend == 0 ? L : 2 * held(held(L / bend) - r) * std::sin(bend / 2); });
    EXPECT_NEAR(100 * format(name).nearest.quotient.mean / clamped, 1, 1e-4) << name;
  }
}

TEST(FormatErrors, EightBitsAreTooFewForTheInputs) {
  EXPECT_GT(format("Q3.4").nearest.linear.mean, 0.01);
  for (const char* name : {"Q3.4", "Q2.5"}) {
    const FormatErrors& f = format(name);
    EXPECT_GT(f.coded->down.linear.mean, 0.01) << name;
    EXPECT_GT(f.inputs.mean, 0.9 * f.nearest.linear.mean) << name;
    EXPECT_EQ(f.nearest.chord.mean, f.nearest.linear.mean) << name;  // s − 1 rounds to nothing
  }
}

TEST(FormatErrors, OfInputsAreThoseOfTheExactFormula) {
  const auto rounded = [](double value) { return std::round(value * 256) / 256; };
  const double mean = mean_percent([&](double bend) {
    const double b = rounded(bend);
    return b == 0 ? rounded(L) : 2 * (rounded(L) / b - rounded(r)) * std::sin(b / 2);
  });
  EXPECT_NEAR(100 * format("Q7.8").inputs.mean / mean, 1, 1e-12);
  EXPECT_EQ(format("double").inputs.mean, 0);
}

TEST(Binary16, RoundsToNearestEvenAndHasSubnormalsAndInfinity) {
  const auto rounded = [](double value) { return static_cast<double>(Binary16(value)); };
  EXPECT_EQ(rounded(1 + 0x1p-11), 1);           // half-way: the even one
  EXPECT_EQ(rounded(1 + 0x3p-11), 1 + 0x1p-9);  // half-way again
  EXPECT_EQ(rounded(1.0 / 3), 0x1.554p-2);
  EXPECT_EQ(rounded(65519), 65504);
  EXPECT_EQ(rounded(65520), std::numeric_limits<double>::infinity());
  EXPECT_EQ(rounded(-1e6), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(rounded(0x1p-24), 0x1p-24);  // the smallest there is
  EXPECT_EQ(rounded(0x1p-25), 0);
  EXPECT_EQ(rounded(0x1.8p-24), 0x1p-23);
}

TEST(CodedFixed, ThatRoundsToNearestAndSaturatesIsTheKernels) {
  using Kernels = kernel::Fixed<16, 10>;
  using Ours = CodedFixed<16, 10, Rounding::nearest, Overflow::saturate>;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-40, 40);
  for (int k = 0; k < 10'000; ++k) {
    const double a = value(random), b = value(random);
    EXPECT_EQ(static_cast<double>(Ours(a)), static_cast<double>(Kernels(a)));
    EXPECT_EQ(static_cast<double>(Ours(a) * Ours(b)), static_cast<double>(Kernels(Kernels(a) * Kernels(b))));
    EXPECT_EQ(static_cast<double>(Ours(a) + Ours(b)), static_cast<double>(Kernels(a) + Kernels(b)));
    EXPECT_EQ(static_cast<double>(Ours(a) - Ours(b)), static_cast<double>(Kernels(a) - Kernels(b)));
  }
}

TEST(CodedFixed, WrapsAroundAndRoundsDownAsIntegersDo) {
  using Wrapping = CodedFixed<16, 8, Rounding::nearest, Overflow::wrap>;
  EXPECT_EQ(static_cast<double>(Wrapping(100.0) + Wrapping(100.0)), 200 - 256);
  EXPECT_EQ(static_cast<double>(Wrapping(-100.0) - Wrapping(100.0)), -200 + 256);
  EXPECT_EQ(static_cast<double>(Wrapping(20.0) * Wrapping(20.0)), 400 - 512);
  using Down = CodedFixed<16, 8, Rounding::down, Overflow::saturate>;
  EXPECT_EQ(static_cast<double>(Down(-0x1p-9)), -0x1p-8);
  EXPECT_EQ(static_cast<double>(Down(-0x1p-8) * Down(0.5)), -0x1p-8);
  EXPECT_EQ(static_cast<double>(Down(0x1p-8) * Down(0.5)), 0);
}

}  // namespace number_formats_test
