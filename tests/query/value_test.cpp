/// Numbers of answers as they are written.
#include "query/answer/value.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
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

TEST(Value, BlocksOfFewAndOfManyNumbersGrowAndAreCopied) {
  Value grown({1.0});
  std::string text = "[1.0";
  for (int k = 2; k <= 9; ++k) {  // few lie in the block, more elsewhere
    const Value before = grown;
    Value moved = grown;
    grown.push_back(k);
    EXPECT_EQ(before.json(), text + "]");
    text += fmt::format(",{}.0", k);
    EXPECT_EQ(grown.json(), text + "]");
    moved = std::move(grown);
    grown = moved;
    EXPECT_EQ(grown.json(), moved.json());
  }
  grown.push_front(0.5);
  EXPECT_EQ(grown.json(), "[0.5" + ("," + text.substr(1)) + "]");
  const std::array<double, 6> rows{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(Value(rows, 3).json(), "[[1.0,2.0,3.0],[4.0,5.0,6.0]]");
  EXPECT_EQ(Value(std::span(rows).first(4), 2).block()->row(1)[0], 3);
}

TEST(Value, AnAnswerIsWrittenBehindWhatATextHolds) {
  Value answer{{"a", "text \n"}, {"b", {1.0, 2.5}}, {"c", true}, {"d", Value::list()}, {"e", Value::map()}};
  answer["f"] = 7;
  answer["g"] = std::string(5000, 'x');
  std::string text = "before ";
  answer.append_json(text);
  EXPECT_EQ(text, "before " + answer.json());
  EXPECT_TRUE(
      text.starts_with(R"(before {"a":"text \n","b":[1.0,2.5],"c":true,"d":[],"e":{},"f":7,"g":"xxxxx)"))
      << text;
  EXPECT_TRUE(text.ends_with("xxx\"}"));
}

}  // namespace value_test
}  // namespace sinew
