/// @file serial.hpp
/// A serial robot: sections one after the other, each with tendons of its own that pass all sections before
/// it. Theory: docs/theory/section.md
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/robot/section.hpp"

namespace sinew::inline v1 {

/// How a motor moves a tendon: turns of a lead screw, counted by an encoder.
struct TendonMotor {
  double lead = 0;    ///< of the screw [m] a turn, > 0
  double counts = 0;  ///< number of steps of the encoder a turn of the motor, > 0
  double gear = 1;    ///< ratio: turns of the motor a turn of the screw, > 0
  double counts_per_length() const { return counts * gear / lead; }  ///< [1/m]
};

/// What a tendon gives way under tension.
struct TendonStretch {
  double stiffness = 0;  ///< EA [N], > 0
  double outside = 0;    ///< its length between motor and robot [m], ≥ 0
};

/// Constant once built, and shared between threads; memory that changes is in a SerialWorkspace.
struct SerialRobot {
  std::string name;
  bool geometry_inferred = false;
  std::vector<Section> sections;
  double tolerance = 0;  ///< of a tendon [m]: encoder step, friction, stretch; ≥ 0
  std::optional<TendonMotor> motor;
  std::optional<TendonStretch> stretch;
  /// One for a robot and its copies; by it a workspace knows the robot that it was made for.
  std::shared_ptr<const char> identity = std::make_shared<const char>();

  /// Number of sections.
  int section_count() const { return static_cast<int>(sections.size()); }
  /// Tendons of all sections.
  int tendon_count() const {
    int count = 0;
    for (const Section& section : sections) count += section.tendons;
    return count;
  }
  /// From base to tip, straight and at rest [m].
  double length() const {
    double length = 0;
    for (const Section& section : sections) length += section.length();
    return length;
  }
  /// Every section longer than at rest by so much [m].
  SerialRobot extended(std::span<const double> extensions) const {
    SerialRobot longer = *this;
    for (std::size_t m = 0; m < sections.size(); ++m)
      longer.sections[m] = sections[m].extended(extensions[m]);
    return longer;
  }
  /// Its length, straight and made as long as it can be [m].
  double longest() const {
    double length = 0;
    for (const Section& section : sections) length += section.length() + section.max_extension;
    return length;
  }
  /// Whether the length of a section varies.
  bool is_extensible() const {
    for (const Section& section : sections)
      if (section.is_extensible()) return true;
    return false;
  }
};

}  // namespace sinew::inline v1
