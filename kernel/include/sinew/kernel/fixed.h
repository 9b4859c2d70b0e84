/// @file fixed.h
/// Fixed-point numbers whose format is part of their type: a product is exact in twice the bits, a sum of
/// products stays there, and one rounding brings it back. What does not fit saturates. Freestanding C++14, no
/// includes, no heap.
#ifndef SINEW_KERNEL_FIXED_H
#define SINEW_KERNEL_FIXED_H

namespace sinew {
namespace kernel {

/// The integer of so many bits.
template <int Bits>
struct Integer;
template <>
struct Integer<8> {
  using type = __INT8_TYPE__;
};
template <>
struct Integer<16> {
  using type = __INT16_TYPE__;
};
template <>
struct Integer<32> {
  using type = __INT32_TYPE__;
};
template <>
struct Integer<64> {
  using type = __INT64_TYPE__;
};

namespace detail {
/// The same bits without a sign: sums of these wrap, those of signed integers are undefined.
template <class Raw>
struct Unsigned;
template <>
struct Unsigned<__INT8_TYPE__> {
  using type = __UINT8_TYPE__;
};
template <>
struct Unsigned<__INT16_TYPE__> {
  using type = __UINT16_TYPE__;
};
template <>
struct Unsigned<__INT32_TYPE__> {
  using type = __UINT32_TYPE__;
};
template <>
struct Unsigned<__INT64_TYPE__> {
  using type = __UINT64_TYPE__;
};
}  // namespace detail

/// raw / 2^Fraction, in Bits bits with the sign: `Fixed<16, 13>` holds −4 to 4 in steps of 0.00012. Numbers
/// that are all small may have more than Bits of them behind the point.
template <int Bits, int Fraction>
struct Fixed {
  static_assert(Fraction >= 0 && Fraction < 2 * Bits && Fraction < 63, "steps of at most 1");
  using Raw = typename Integer<Bits>::type;
  static constexpr int bits = Bits;          ///< of the integer, with the sign
  static constexpr int fraction = Fraction;  ///< of them behind the point
  /// The integer of the largest number, and that of the smallest.
  static constexpr Raw largest = static_cast<Raw>(~(static_cast<Raw>(1) << (Bits - 1)));
  /// See `largest`.
  static constexpr Raw smallest = static_cast<Raw>(-largest - 1);

  Raw raw;

  constexpr Fixed() : raw(0) {}
  /// The nearest there is. Meant for constants: on a small controller this is floating-point work.
  explicit constexpr Fixed(double value) : raw(nearest(value)) {}
  /// Rounded to nearest from another format, halves upwards.
  template <int OtherBits, int OtherFraction>
  explicit constexpr Fixed(Fixed<OtherBits, OtherFraction> other) : raw(rounded(other)) {}

  /// raw_value / 2^Fraction.
  static constexpr Fixed from_raw(Raw raw_value) {
    Fixed result;
    result.raw = raw_value;
    return result;
  }
  explicit constexpr operator double() const {
    return static_cast<double>(raw) /
           static_cast<double>(static_cast<typename Integer<64>::type>(1) << Fraction);
  }

 private:
  static constexpr Raw nearest(double value) {
    const double scaled = value * static_cast<double>(static_cast<typename Integer<64>::type>(1) << Fraction);
    if (scaled >= static_cast<double>(largest)) return largest;
    if (!(scaled > static_cast<double>(smallest))) return smallest;  // NaN too: no undefined conversion
    return static_cast<Raw>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
  }
  template <int OtherBits, int OtherFraction>
  static constexpr Raw rounded(Fixed<OtherBits, OtherFraction> other) {
    constexpr int wide = OtherBits > Bits ? OtherBits : Bits;
    using Wide = typename Integer<wide>::type;
    constexpr int down = OtherFraction > Fraction ? OtherFraction - Fraction : 0;
    constexpr int up = Fraction > OtherFraction ? Fraction - OtherFraction : 0;
    static_assert(up < wide && down <= wide, "formats that have bits in common");
    // Limits before the shift up, so that the shift never overflows; a shift down first, so that rounding
    // never does.
    Wide value = other.raw;
    if (down == 1) value = static_cast<Wide>((value >> 1) + (value & 1));
    if (down > 1) value = static_cast<Wide>(((value >> (down > 1 ? down - 1 : 0)) + 1) >> 1);
    const Wide high = static_cast<Wide>(static_cast<Wide>(largest) >> up),
               low = static_cast<Wide>(static_cast<Wide>(smallest) >> up);
    if (value > high) return largest;
    if (value < low) return smallest;
    return static_cast<Raw>(
        static_cast<Wide>(static_cast<typename detail::Unsigned<Wide>::type>(value) << up));
  }
};

template <int Bits, int A, int B>
constexpr Fixed<2 * Bits, A + B> operator*(Fixed<Bits, A> a, Fixed<Bits, B> b) {
  using Wide = typename Integer<2 * Bits>::type;
  return Fixed<2 * Bits, A + B>::from_raw(
      static_cast<Wide>(static_cast<Wide>(a.raw) * static_cast<Wide>(b.raw)));
}
template <int Bits, int Fraction>
constexpr Fixed<Bits, Fraction> operator+(Fixed<Bits, Fraction> a, Fixed<Bits, Fraction> b) {
  using Number = Fixed<Bits, Fraction>;
  using Raw = typename Number::Raw;
  const bool over = b.raw > 0 && a.raw > static_cast<Raw>(Number::largest - b.raw);
  const bool under = b.raw < 0 && a.raw < static_cast<Raw>(Number::smallest - b.raw);
  return Number::from_raw(over    ? Number::largest
                          : under ? Number::smallest
                                  : static_cast<Raw>(a.raw + b.raw));
}
template <int Bits, int Fraction>
constexpr Fixed<Bits, Fraction> operator-(Fixed<Bits, Fraction> a) {
  using Number = Fixed<Bits, Fraction>;
  using Raw = typename Number::Raw;
  return Number::from_raw(a.raw == Number::smallest ? Number::largest : static_cast<Raw>(-a.raw));
}
template <int Bits, int Fraction>
constexpr Fixed<Bits, Fraction> operator-(Fixed<Bits, Fraction> a, Fixed<Bits, Fraction> b) {
  using Number = Fixed<Bits, Fraction>;
  using Raw = typename Number::Raw;
  const bool over = b.raw < 0 && a.raw > static_cast<Raw>(Number::largest + b.raw);
  const bool under = b.raw > 0 && a.raw < static_cast<Raw>(Number::smallest + b.raw);
  return Number::from_raw(over    ? Number::largest
                          : under ? Number::smallest
                                  : static_cast<Raw>(a.raw - b.raw));
}
/// Rounded towards 0; what has no quotient saturates.
template <int Bits, int Fraction>
constexpr Fixed<Bits, Fraction> operator/(Fixed<Bits, Fraction> a, Fixed<Bits, Fraction> b) {
  using Number = Fixed<Bits, Fraction>;
  using Wide = typename Integer<2 * Bits>::type;
  static_assert(Fraction < Bits, "the quotient of the ends of the range fits twice the bits");
  if (b.raw == 0) return Number::from_raw(a.raw < 0 ? Number::smallest : Number::largest);
  const Wide value = static_cast<Wide>(static_cast<Wide>(a.raw) * (static_cast<Wide>(1) << Fraction) /
                                       static_cast<Wide>(b.raw));
  return Number(Fixed<2 * Bits, Fraction>::from_raw(value));
}
template <int Bits, int Fraction>
constexpr Fixed<Bits, Fraction>& operator+=(Fixed<Bits, Fraction>& a, Fixed<Bits, Fraction> b) {
  return a = a + b;
}
template <int Bits, int Fraction>
constexpr bool operator<(Fixed<Bits, Fraction> a, Fixed<Bits, Fraction> b) {
  return a.raw < b.raw;
}
template <int Bits, int Fraction>
constexpr bool operator>(Fixed<Bits, Fraction> a, Fixed<Bits, Fraction> b) {
  return a.raw > b.raw;
}
template <int Bits, int Fraction>
constexpr bool operator==(Fixed<Bits, Fraction> a, Fixed<Bits, Fraction> b) {
  return a.raw == b.raw;
}

}  // namespace kernel
}  // namespace sinew

#endif
