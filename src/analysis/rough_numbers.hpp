/// @file rough_numbers.hpp
/// Numbers of formats that the compiler, or the kernel, has no type of: for measurements, not for speed.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sinew::inline v1 {

/// IEEE 754 binary16: 11 bits, subnormals from 2⁻¹⁴ down to 2⁻²⁴, infinite from 65520. Computed in double,
/// whose 53 bits are more than twice 11: rounding twice is rounding once.
class Binary16 {
 public:
  Binary16() = default;
  explicit Binary16(double value) : value_(nearest(value)) {}
  explicit operator double() const { return value_; }

  friend Binary16 operator+(Binary16 a, Binary16 b) { return Binary16(a.value_ + b.value_); }
  friend Binary16 operator-(Binary16 a, Binary16 b) { return Binary16(a.value_ - b.value_); }
  friend Binary16 operator*(Binary16 a, Binary16 b) { return Binary16(a.value_ * b.value_); }
  friend bool operator>(Binary16 a, Binary16 b) { return a.value_ > b.value_; }

 private:
  static double nearest(double value) {
    if (value == 0) return value;
    if (!(std::abs(value) < 65520)) return value * std::numeric_limits<double>::infinity();
    const double step = std::ldexp(1, std::max(std::ilogb(value) - 10, -24));
    return std::nearbyint(value / step) * step;
  }
  double value_ = 0;
};

enum class Rounding { nearest, down };
enum class Overflow { saturate, wrap };

/// Fixed point that rounds each product at once, by rules of which the kernel's has one only.
template <int Bits, int Fraction, Rounding rounding, Overflow overflow>
class CodedFixed {
 public:
  CodedFixed() = default;
  explicit CodedFixed(double value)
      : CodedFixed(Raw(static_cast<std::int64_t>(
            std::clamp(std::floor(std::ldexp(value, Fraction) + up), -0x1p62, 0x1p62)))) {}
  explicit operator double() const { return std::ldexp(static_cast<double>(raw_), -Fraction); }

  friend CodedFixed operator+(CodedFixed a, CodedFixed b) { return CodedFixed(Raw(a.raw_ + b.raw_)); }
  friend CodedFixed operator-(CodedFixed a, CodedFixed b) { return CodedFixed(Raw(a.raw_ - b.raw_)); }
  friend CodedFixed operator*(CodedFixed a, CodedFixed b) {
    constexpr std::int64_t half = rounding == Rounding::nearest ? std::int64_t{1} << (Fraction - 1) : 0;
    return CodedFixed(Raw((a.raw_ * b.raw_ + half) >> Fraction));
  }
  friend bool operator>(CodedFixed a, CodedFixed b) { return a.raw_ > b.raw_; }

 private:
  static_assert(Fraction > 0 && Bits <= 32, "a product fits into 64 bits");
  static constexpr double up = rounding == Rounding::nearest ? 0.5 : 0;

  /// An integer that may be too large yet.
  struct Raw {
    std::int64_t value;
    explicit Raw(std::int64_t of) : value(of) {}
  };
  explicit CodedFixed(Raw raw) {
    constexpr std::int64_t end = std::int64_t{1} << (Bits - 1);
    if constexpr (overflow == Overflow::saturate)
      raw_ = std::clamp(raw.value, -end, end - 1);
    else
      raw_ = ((raw.value + end) & (2 * end - 1)) - end;
  }
  std::int64_t raw_ = 0;
};

}  // namespace sinew::inline v1
