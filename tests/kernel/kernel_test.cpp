#include <gtest/gtest.h>

#include "sinew/kernel/tendon_pair.h"

namespace sinew::kernel {
namespace kernel_test {

TEST(Kernel, TendonPairIsComputedAtCompileTimeInFloat) {
  constexpr TendonPair<float> pair{0.2F, 0.005F};
  static_assert(pair.curvature_rate() == -1 / (0.005F * 0.2F));
  static_assert(pair.tendon_1(0.0F) == 0.2F);
  EXPECT_NEAR(static_cast<double>(pair.curvature(pair.tendon_1(5.0F))), 5.0, 1e-4);
}

}  // namespace kernel_test
}  // namespace sinew::kernel
