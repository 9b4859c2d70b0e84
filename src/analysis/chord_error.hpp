/// @file chord_error.hpp
/// What linearising costs: tendon lengths of LSK against exact piecewise constant curvature (PCC), and where
/// a robot ends up that is driven by them. Theory: docs/theory/model_error.md
///
/// The exact length past a joint bent by β is s = sinc(β/2) of the linear one, for every tendon, so
///
///   e(β) = l′/l − 1 = 1/s − 1 = Σ cₖ (β/2)²ᵏ = β²/24 + 7β⁴/5760 + …        no 0/0; |β| < 2π
///
/// All cₖ > 0: linear lengths are too long, never too short. Errors are fractions, not percent.
#pragma once
#include <cstdint>
#include <vector>

#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// e of a joint bent by β [rad], |β| < 2π.  @implements LSK (17)
double chord_error(double bend);

/// e over |β| ≤ range.
struct ChordErrors {
  double largest, mean;
};

/// @param range [rad], 0 to π
/// @implements LSK (19), (20), whose mean is a third of the largest: that of a pure square
ChordErrors chord_errors(double range);

/// Ways to put c β² through e over |β| ≤ range. Integrals, not sums over samples.
enum class QuadraticFit {
  least_squares,  ///< of c β²: what "pure quadratic" says
  with_constant,  ///< of c β² + c₀: its c is the one that the paper prints
  minimax,        ///< c β² that is off least at its worst
  taylor,         ///< 1/24: below e
  endpoint        ///< meets e at the range's end: above e
};

struct Quadratic {
  double coefficient;   ///< c [1/rad²]
  double constant;      ///< c₀; 0 but for `with_constant`
  double largest_miss;  ///< of |e − c β² − c₀| over the range
};

/// @param range [rad], above 0, to π
/// @implements LSK (18)
Quadratic fit_chord_error(QuadraticFit fit, double range);

/// A tendon of the last section from the base to its end, discs not counted [m].
struct TendonLengths {
  double exact, linear;
};

/// Every section bent by (β, β).
/// @param direction of the tendon around the discs [rad]; in the paper 45°
/// @implements LSK (21), (22)
TendonLengths lengths_at_equal_bends(const SerialRobot& robot, double bend, double direction);

/// How often all changes of a robot need the change of one tendon by one section.
struct TendonEvaluations {
  std::int64_t anew;     ///< every tendon summed from the base: LSK (5)
  std::int64_t carried;  ///< sums carried along the robot: LSK (12), and exact PCC too
};

constexpr TendonEvaluations tendon_evaluations(int sections, int tendons = 3) {
  const std::int64_t M = sections, n = tendons;
  return {n * (M * M + M) / 2, n * M};
}

/// Distances of many poses [m].
struct Distances {
  double mean = 0, p95 = 0, largest = 0;
};

struct LinearConsequences {
  /// Tip from where it was meant to be: changes by LSK, and of the bends that exact geometry then leaves free
  /// the one in the middle, whose tendons are equally slack.
  Distances commanded;
  /// The same of a tip computed by LSK from the true changes.
  Distances read_back;
  std::vector<Distances>
      slack;         ///< of each section's tendons at the bends that were meant, the mean of its n
  int left_out = 0;  ///< poses that need a chord no joint has: beyond about 57° a joint
};

/// Random bends, evenly spread over each section's limits, which must be finite, their lengths fixed. The
/// same numbers on every machine but for rounding.
LinearConsequences linear_consequences(const SerialRobot& robot, int poses, std::uint32_t seed);

/// What LSK leaves slack at most: this and all sections before it at the corner of their limits.
struct LinearSlack {
  double slack;      ///< of each tendon [m]
  double dead_zone;  ///< how far the whole section's bend can then go either way [rad]
};

/// Of each section; limits must be finite, lengths fixed.
std::vector<LinearSlack> largest_linear_slack(const SerialRobot& robot);

/// How far from a bend the exact geometry lets the first section be where its tendons were driven there by
/// LSK; in the coordinates of the bend [rad]. NaN where the set has several parts.
double linear_freedom(const Section& section, const Bend& bend);

}  // namespace sinew::inline v1
