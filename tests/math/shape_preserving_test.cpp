#include "math/shape_preserving.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sinew {
namespace shape_preserving_test {

TEST(ShapePreservingCurve, PassesItsPointsAndStaysBetweenThem) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> draw(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t points = 2 + static_cast<std::size_t>(trial % 7), coordinates = 3;
    std::vector<double> parameters{-1}, values;
    for (std::size_t k = 1; k < points; ++k) parameters.push_back(parameters.back() + 1e-3 + draw(random));
    for (std::size_t i = 0; i < points * coordinates; ++i)
      values.push_back(draw(random) < 0.3 ? 0 : draw(random));
    const ShapePreservingCurve curve(parameters, values);
    ASSERT_EQ(curve.pieces(), points - 1);
    for (std::size_t k = 0; k + 1 < points; ++k)
      for (std::size_t c = 0; c < coordinates; ++c) {
        const double a = values[k * coordinates + c], b = values[(k + 1) * coordinates + c];
        const double begin = parameters[k], width = parameters[k + 1] - begin;
        EXPECT_NEAR(curve.value(k, c, begin), a, 1e-14);
        EXPECT_NEAR(curve.value(k, c, begin + width), b, 1e-13);
        if (k > 0) {  // slopes meet
          EXPECT_NEAR(curve.first_derivative(k, c, begin), curve.first_derivative(k - 1, c, begin), 1e-9);
        }
        for (double t = 0; t <= 1; t += 0.05) {
          const double s = begin + t * width, h = 1e-5 * width;
          EXPECT_GE(curve.value(k, c, s), std::min(a, b) - 1e-13);
          EXPECT_LE(curve.value(k, c, s), std::max(a, b) + 1e-13);
          EXPECT_NEAR(curve.first_derivative(k, c, s) * width,
                      (curve.value(k, c, s + h) - curve.value(k, c, s - h)) / (2 * h) * width, 1e-7);
          EXPECT_NEAR(
              curve.second_derivative(k, c, s) * width,
              (curve.first_derivative(k, c, s + h) - curve.first_derivative(k, c, s - h)) / (2 * h) * width,
              1e-5 / width);
        }
      }
  }
}

TEST(ShapePreservingCurve, OfFewerThanTwoPointsHasNoPiece) {
  EXPECT_EQ(ShapePreservingCurve({}, {}).pieces(), 0U);
  EXPECT_EQ(ShapePreservingCurve({0}, {1, 2}).pieces(), 0U);
}

}  // namespace shape_preserving_test
}  // namespace sinew
