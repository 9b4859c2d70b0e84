/// @file units.hpp
/// Dimensions and ranges of quantities. Inside the library every number is SI and radians (DESIGN: a bare
/// number is SI, a string may carry a unit whose dimension is checked). The spelling of units is in
/// io/quantity.hpp.
#pragma once
#include <limits>

#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// What a number measures. `number` is dimensionless; `count` is a whole number.
enum class Dimension {
  number,
  count,
  length,
  angle,
  curvature,
  force,
  moment,
  pressure,
  mass,
  density,
  acceleration,
  time,
  line_load,  ///< force per length
  speed,
  angular_speed,
  angular_acceleration,
  rigidity,    ///< in bending or torsion: moment per curvature
  compliance,  ///< length per force
  line_mass,   ///< mass per length
  // the last: who goes through all ends here
};

/// An interval of allowed values, in the SI unit of what they measure; a bound may be excluded.
struct Range {
  double low = -std::numeric_limits<double>::infinity();  ///< the lower bound
  double high = std::numeric_limits<double>::infinity();  ///< the upper bound
  bool low_excluded = false;
  bool high_excluded = false;

  /// Whether the value is allowed; NaN is in no range.
  constexpr bool contains(double value) const {
    return (low_excluded ? value > low : value >= low) && (high_excluded ? value < high : value <= high);
  }

  static constexpr Range any() { return {}; }                                     ///< every number
  static constexpr Range positive() { return {.low = 0, .low_excluded = true}; }  ///< > 0
  static constexpr Range not_negative() { return {.low = 0}; }                    ///< ≥ 0
  /// Sizes of parts [m]: a nanometre to a million kilometres, so that no square over- or underflows.
  static constexpr Range size() { return {.low = 1e-9, .high = 1e9}; }
  /// Coordinates of points [m].
  static constexpr Range place() { return {.low = -1e9, .high = 1e9}; }
  /// Angles [rad] that still have a sine in doubles.
  static constexpr Range turn() { return {.low = -1e6, .high = 1e6}; }
  /// Both bounds included.
  static constexpr Range between(double low, double high) { return {.low = low, .high = high}; }
};

}  // namespace sinew::inline v1
