#include "link/rail.hpp"

#include <gtest/gtest.h>

#include "check_jacobian.hpp"

namespace sinew::test {
namespace rail_test {

TEST(Rail, ItsTipIsTheSlideAlongY) {  // @verifies 3PFS (13)
  const Rail rail;
  const auto tip = [&](const auto& q) { return rail.tip(q).position; };
  for (const double slide : {-0.3, 0.0, 1e-9, 0.25}) {
    const Vec<double, 1> q(slide);
    EXPECT_EQ(rail.tip(q).position, Vec3<double>(0, slide, 0));
    EXPECT_EQ(rail.slide(q), slide);
    EXPECT_LT(check_jacobian(tip, q, rail.tip(q).rate), 1e-10);
  }
}

}  // namespace rail_test
}  // namespace sinew::test
