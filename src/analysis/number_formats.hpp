/// @file number_formats.hpp
/// What the number formats of small controllers make of the length of a tendon past one joint: by (6) as it
/// is printed, by its linearisation (7), and by the kernel's chord factor, all computed in the format
/// throughout. Theory: docs/theory/model_error.md
///
/// (6) divides by the bend: L/β of a small bend is beyond the format's largest number. Neither (7) nor the
/// chord factor has a value larger than L + r|β|. Errors are fractions of the exact length, not percent.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

namespace sinew::inline v1 {

/// A tendon in the plane of a joint's bend, at δ = 0. A fixed-point number knows no unit: lengths are in the
/// one that the controller counts in, which in [LSK] is mm.
struct JointTendon {
  double length;  ///< L
  double radius;  ///< r
  double range;   ///< bends go from −range to range [rad]
};

/// Over the bends; a length that is infinite is off by 1.
struct LengthError {
  double mean = 0, largest = 0;
};

struct LengthErrors {
  /// (6) at its best: the sine correctly rounded, L where the bend is 0, in fixed point doubled at last.
  LengthError quotient;
  LengthError linear;  ///< (7), the kernel's
  LengthError chord;   ///< (6) by the chord factor, the kernel's
};

struct FormatErrors {
  std::string_view name;  ///< `float`; `Q7.8` has 7 bits before the point, 8 behind it, and a sign
  int bits;
  std::optional<int> integer_bits;  ///< before the point, without the sign; none of floating point
  /// Every result rounded to nearest. Fixed point saturates.
  LengthErrors nearest;
  LengthError inputs;  ///< what rounding L, r and β costs, were all else exact
  /// Fixed point as it is often coded.
  struct Coded {
    LengthErrors down;       ///< rounded down by a shift, saturating
    LengthErrors wrapping;   ///< rounded to nearest, what does not fit wraps around
    LengthErrors plain;      ///< rounded down, wrapping
    double overflows_below;  ///< L/β of smaller bends does not fit [rad]
  };
  std::optional<Coded> coded;
};

/// double, float, binary16, then fixed point from many bits to few.
/// @param samples at least 2, evenly spaced, both ends among them
std::vector<FormatErrors> format_errors(const JointTendon& tendon, int samples);

}  // namespace sinew::inline v1
