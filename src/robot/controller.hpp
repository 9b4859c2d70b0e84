/// @file controller.hpp
/// A serial robot as a controller has it: constants multiplied out in mm and rad, and the formats of integers
/// that hold them and everything that is made of them. Theory: docs/theory/controller.md
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// Bits behind the point of the 16-bit numbers of a controller, as in kernel::ShortFormat.
struct ShortBits {
  int angle = 0, length = 0, row = 0, back = 0, half = 0;
  static constexpr int share = 13, loss = 15;
};

/// One section's constants [mm, rad]; those of kernel::LinearTable and kernel::ExactTable.
struct ControllerSection {
  kernel::Backbone backbone = kernel::Backbone::twin_pivot;
  double limit = 0;                         ///< of its bend [rad]
  double share = 1;                         ///< its gain over the greatest
  double half_length = 0;                   ///< N L/2 [mm]
  double most_common = 0;                   ///< that exact PCC takes from tendons alike, at its limit [mm]
  std::vector<std::array<double, 2>> rows;  ///< of each tendon −g (cos d, sin d) [mm], g the greatest
  std::vector<std::array<double, 2>> back;  ///< −2/(n g) (cos d, sin d) [1/mm]
  std::vector<double> series;               ///< of the chord's loss by the square of the bend
};

struct ControllerTable {
  std::string robot;
  std::vector<ControllerSection> sections;
  kernel::Model model = kernel::Model::linear;  ///< by which a controller drives its tendons
  int tendons = 0;                              ///< of each section
  bool alike = true;                            ///< one gain, one joint, one backbone
  double tolerance = 0;                         ///< of a tendon [mm]
  double counts_per_mm = 0;                     ///< of the motors' encoders; 0: the robot names no motors
  ShortBits bits;
  double angle_step() const;   ///< [rad]
  double length_step() const;  ///< [mm]
  double rounding() const;     ///< of a change of tendon against LSK of the same bends [mm], at most
  /// Counts in one step of a length, in 1/65536; without motors a step is a count.
  std::int32_t counts_per_step() const;
  /// The tolerance, and at least what rounding makes of tendons that are exact.
  std::int64_t short_tolerance() const;
  /// The section's limit, downwards: what is within it is allowed.
  std::int64_t short_limit(const ControllerSection& section) const;
  /// Of all its integers: what a controller and who talks to it must have in common.
  std::uint32_t hash() const;
};

/// The nearest integer with so many bits behind the point; what does not fit `bits` saturates.
std::int64_t fixed_point(double value, int fraction, int bits = 16);

/// Errors: `extensible`, `unlike_tendons`, `no_limit`, `unlike_gains`, `out_of_range`.
Expected<ControllerTable> make_controller_table(const SerialRobot& robot,
                                                kernel::Model model = kernel::Model::linear);

}  // namespace sinew::inline v1
