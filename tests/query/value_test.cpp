/// Numbers of answers as they are written.
#include "query/answer/value.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

namespace sinew {
namespace value_test {

/// As fmt writes it, with a point.
std::string expected(double value) {
  std::string digits = fmt::format("{}", value);
  if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
  return digits;
}

void expect_same(double value) {
  const std::string written = Value(value).json();
  ASSERT_EQ(written, expected(value));
  ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(written.c_str(), nullptr)),
            std::bit_cast<std::uint64_t>(value))
      << written;
}

TEST(Value, NumbersAreTheShortestThatReadBack) {
  using Limits = std::numeric_limits<double>;
  for (const double value : {0.0,           -0.0,          1.0,
                             -1.0,          0.1,           10.0,
                             123456.0,      1e15,          9999999999999998.0,
                             1e16,          1e17,          1e-4,
                             9.999e-5,      1e-5,          0.00012,
                             5e-324,        1e22,          1e23,
                             1e100,         1e-100,        123.456,
                             Limits::max(), Limits::min(), Limits::epsilon(),
                             0.3,           2.0 / 3}) {
    expect_same(value);
    expect_same(-value);
  }
  std::mt19937_64 random(3);
  for (int k = 0; k < 200000; ++k) {
    const double any = std::bit_cast<double>(random());
    if (std::isfinite(any)) expect_same(any);
    const double usual =
        std::ldexp(static_cast<double>(random() >> 11U), static_cast<int>(random() % 80) - 75);
    expect_same(k % 2 == 0 ? usual : -usual);
    expect_same(std::round(usual * 1000) / 1000);
  }
  EXPECT_EQ(Value(Limits::quiet_NaN()).json(), "null");
  EXPECT_EQ(Value(Limits::infinity()).json(), "null");
}

}  // namespace value_test
}  // namespace sinew
