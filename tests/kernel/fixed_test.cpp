#include "sinew/kernel/fixed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace sinew::kernel {
namespace fixed_test {

// What overflows is no constant: these compile only where nothing does.
static_assert(Fixed<32, 16>(Fixed<32, 17>::from_raw(2147483647)).raw == 1073741824);
static_assert(Fixed<32, 31>(Fixed<32, 0>::from_raw(-1)).raw == -2147483647 - 1);
static_assert(Fixed<64, 8>(Fixed<64, 9>::from_raw(9223372036854775807)).raw == 4611686018427387904);
static_assert(Fixed<32, 16>::from_raw(-2147483647 - 1) / Fixed<32, 16>::from_raw(-1) ==
              Fixed<32, 16>::from_raw(2147483647));

/// The nearest number of the format, halves upwards, in integers that are wide enough for all.
template <class To, class From>
std::int64_t nearest(From from) {
  const std::int64_t fine = std::int64_t{from.raw} * (std::int64_t{1} << 32);
  const std::int64_t step = std::int64_t{1} << (32 + From::fraction - To::fraction);
  const std::int64_t shifted = fine + step / 2;
  const std::int64_t quotient = shifted / step - (shifted % step < 0 ? 1 : 0);
  return std::clamp<std::int64_t>(quotient, To::smallest, To::largest);
}

template <class From, class To>
void expect_nearest() {
  for (int raw = From::smallest; raw <= From::largest; ++raw) {
    const From from = From::from_raw(static_cast<typename From::Raw>(raw));
    ASSERT_EQ(To(from).raw, nearest<To>(from)) << raw;
  }
}

TEST(Fixed, ConversionsGiveTheNearest) {
  expect_nearest<Fixed<16, 13>, Fixed<16, 12>>();
  expect_nearest<Fixed<16, 13>, Fixed<16, 10>>();
  expect_nearest<Fixed<16, 15>, Fixed<16, 0>>();
  expect_nearest<Fixed<16, 12>, Fixed<16, 13>>();
  expect_nearest<Fixed<16, 0>, Fixed<16, 15>>();
  expect_nearest<Fixed<16, 13>, Fixed<32, 16>>();
  expect_nearest<Fixed<16, 13>, Fixed<8, 5>>();
  expect_nearest<Fixed<8, 7>, Fixed<16, 13>>();
  expect_nearest<Fixed<8, 0>, Fixed<8, 7>>();
}

}  // namespace fixed_test
}  // namespace sinew::kernel
