/// @file products.h
/// Sums of products that are rounded once, in floating point, in fixed point, and of 16 bits in the
/// instructions of an AVR. All ways in fixed point give the same bits. Freestanding C++14, no includes but
/// its neighbour, no heap.
#ifndef SINEW_KERNEL_PRODUCTS_H
#define SINEW_KERNEL_PRODUCTS_H

#include "sinew/kernel/fixed.h"

namespace sinew {
namespace kernel {

/// How a table keeps a number: fixed point as its bare integer, so that tables are lists of numbers.
template <class S>
struct Stored {
  using type = S;
  /// The number that is kept so.
  static constexpr S load(S value) { return value; }
};
template <int Bits, int Fraction>
struct Stored<Fixed<Bits, Fraction>> {
  using type = typename Fixed<Bits, Fraction>::Raw;
  static constexpr Fixed<Bits, Fraction> load(type raw) { return Fixed<Bits, Fraction>::from_raw(raw); }
};

namespace detail {
/// Modulo 2ⁿ.
template <class Raw>
constexpr Raw wrapped(Raw a, Raw b) {
  using Bare = typename Unsigned<Raw>::type;
  return static_cast<Raw>(static_cast<Bare>(static_cast<Bare>(a) + static_cast<Bare>(b)));
}
}  // namespace detail

/// a + b, of integers modulo 2ⁿ.
template <class S>
constexpr S wrapped_sum(S a, S b) {
  return a + b;
}
template <int Bits, int Fraction>
constexpr Fixed<Bits, Fraction> wrapped_sum(Fixed<Bits, Fraction> a, Fixed<Bits, Fraction> b) {
  return Fixed<Bits, Fraction>::from_raw(detail::wrapped(a.raw, b.raw));
}
/// a − b, of integers modulo 2ⁿ.
template <class S>
constexpr S wrapped_difference(S a, S b) {
  return a - b;
}
template <int Bits, int Fraction>
constexpr Fixed<Bits, Fraction> wrapped_difference(Fixed<Bits, Fraction> a, Fixed<Bits, Fraction> b) {
  using Raw = typename Fixed<Bits, Fraction>::Raw;
  return Fixed<Bits, Fraction>::from_raw(
      detail::wrapped(a.raw, detail::wrapped(static_cast<Raw>(~b.raw), Raw(1))));
}

/// Σ a x, as wide as its products.
template <class A, class S>
class Products {
 public:
  constexpr Products() : sum_(0) {}
  /// Adds a x.
  constexpr void add(A a, S x) { sum_ += a * x; }
  /// What was added up.
  constexpr S sum() const { return sum_; }

 private:
  S sum_;
};
template <int Bits, int A, int B>
class Products<Fixed<Bits, A>, Fixed<Bits, B>> {
 public:
  using Wide = Fixed<2 * Bits, A + B>;
  constexpr Products() : sum_(0) {}
  constexpr void add(Fixed<Bits, A> a, Fixed<Bits, B> x) { sum_ = detail::wrapped(sum_, (a * x).raw); }
  constexpr Wide sum() const { return Wide::from_raw(sum_); }

 private:
  typename Wide::Raw sum_;
};

/// a x + b y in the language itself.
struct Portable {
  template <class Result, class A, class S>
  static constexpr Result rounded_sum(A a, S x, A b, S y) {
    return a * x + b * y;
  }
  /// Rounded to nearest, halves upwards, modulo 2ⁿ.
  template <class Result, int Bits, int A, int B>
  static constexpr Result rounded_sum(Fixed<Bits, A> a, Fixed<Bits, B> x, Fixed<Bits, A> b,
                                      Fixed<Bits, B> y) {
    using Raw = typename Result::Raw;
    using Wide = typename Integer<2 * Bits>::type;
    constexpr int down = A + B - Result::fraction;
    static_assert(down >= 1 && Result::bits == Bits,
                  "a result of the operands' width, and less fine than products");
    Wide sum = detail::wrapped((a * x).raw, (b * y).raw);
    sum = detail::wrapped(sum, static_cast<Wide>(static_cast<Wide>(1) << (down - 1)));
    return Result::from_raw(static_cast<Raw>(sum >> down));
  }
};

#ifdef __AVR__
/// The same of 16 bits whose result is the upper half: 45 cycles, whatever the numbers.
struct AvrInstructions : Portable {
  using Portable::rounded_sum;
  template <class Result, int A, int B>
  __attribute__((always_inline)) static inline Result rounded_sum(Fixed<16, A> a, Fixed<16, B> x,
                                                                  Fixed<16, A> b, Fixed<16, B> y) {
    static_assert(A + B - Result::fraction == 16, "the upper half");
    __INT16_TYPE__ high;
    __UINT16_TYPE__ low;
    unsigned char zero;
    // Bytes B (upper, signed) and A (lower): first the outer products of a x side by side, then all others
    // added.
    asm("clr %[zero]\n\t"
        "mul %A[a], %A[x]\n\t movw %A[low], r0\n\t"
        "muls %B[a], %B[x]\n\t movw %A[high], r0\n\t"
        "mulsu %B[a], %A[x]\n\t sbc %B[high], %[zero]\n\t"
        "add %B[low], r0\n\t adc %A[high], r1\n\t adc %B[high], %[zero]\n\t"
        "mulsu %B[x], %A[a]\n\t sbc %B[high], %[zero]\n\t"
        "add %B[low], r0\n\t adc %A[high], r1\n\t adc %B[high], %[zero]\n\t"
        "mul %A[b], %A[y]\n\t"
        "add %A[low], r0\n\t adc %B[low], r1\n\t adc %A[high], %[zero]\n\t adc %B[high], %[zero]\n\t"
        "muls %B[b], %B[y]\n\t add %A[high], r0\n\t adc %B[high], r1\n\t"
        "mulsu %B[b], %A[y]\n\t sbc %B[high], %[zero]\n\t"
        "add %B[low], r0\n\t adc %A[high], r1\n\t adc %B[high], %[zero]\n\t"
        "mulsu %B[y], %A[b]\n\t sbc %B[high], %[zero]\n\t"
        "add %B[low], r0\n\t adc %A[high], r1\n\t adc %B[high], %[zero]\n\t"
        "lsl %B[low]\n\t adc %A[high], %[zero]\n\t adc %B[high], %[zero]\n\t"  // halves upwards
        "clr r1"                                                               // as compiled code expects it
        : [high] "=&r"(high), [low] "=&r"(low), [zero] "=&r"(zero)
        : [a] "a"(a.raw), [x] "a"(x.raw), [b] "a"(b.raw), [y] "a"(y.raw));
    return Result::from_raw(high);
  }
};
/// The quickest way on this machine.
using Native = AvrInstructions;
#else
/// The quickest way on this machine.
using Native = Portable;
#endif

}  // namespace kernel
}  // namespace sinew

#endif
