/// @file serial.hpp
/// A serial robot: sections one after the other, each with tendons of its own that pass all sections before
/// it; and memory for questions to it. Theory: docs/theory/section.md
#pragma once
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/kernel/direction.h"
#include "sinew/kernel/section.h"
#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Bend of a section [rad]: (β₁, β₂) of each joint of a twin-pivot backbone, θ (cos φ, sin φ) of a neutral
/// one.
using Bend = Vec2<double>;

/// Sizes of a section, and its kinematics: pose of its end, derivatives, directions of tendons.
struct Section {
  kernel::Backbone backbone = kernel::Backbone::twin_pivot;
  int segments = 8;           ///< N ≥ 1; of twin pivots even: they bend about two axes in turn
  double joint = 0;           ///< arc length L of one joint [m], > 0
  double disc_height = 0;     ///< h of the disc after it [m]
  double disc_radius = 0;     ///< of the disc [m]; 0: the section has none
  int tendons = 3;            ///< n ≥ 3
  double tendon_radius = 0;   ///< r_c, distance of every tendon from the backbone [m], > 0
  double tendon_angle = 0;    ///< δ of tendon 0 [rad]; the others follow evenly spread ...
  bool is_clockwise = false;  ///< ... counter-clockwise, seen from the tip, or the other way
  /// Largest bend [rad]: |β| of a joint about either axis, θ of a section with a neutral backbone.
  double limit = std::numeric_limits<double>::infinity();
  /// How much longer than at rest its backbone can be made [m], evenly over its joints: least ≤ 0 ≤
  /// most. The third coordinate of a neutral backbone; 0 and 0: the length is fixed.
  double min_extension = 0;
  double max_extension = 0;  ///< [m], see `min_extension`

  bool is_extensible() const { return min_extension < max_extension; }  ///< its length varies
  /// The section made longer by so much [m].
  Section extended(double extension) const {
    Section longer = *this;
    longer.joint += extension / segments;
    return longer;
  }
  /// How fast its end moves when it is made longer [m/m], in its base's frame, at this bend [rad].
  SINEW_API Vec3<double> extension_motion(const Bend& bend) const;

  bool is_twin() const { return backbone == kernel::Backbone::twin_pivot; }  ///< a twin-pivot backbone
  double arc_length() const { return segments * joint; }                     ///< N L [m]
  double length() const { return segments * (joint + disc_height); }         ///< of the whole section [m]

  /// Of a section's bend [rad] what its k-th joint has; of twin pivots the proximal one of a pair bends by
  /// β₂.
  Bend joint_bend(const Bend& bend, int k) const {
    if (!is_twin()) return bend / segments;
    return k % 2 == 0 ? Bend(0, bend.y()) : Bend(bend.x(), 0);
  }
  /// Of the tube that holds discs and tendons [m].
  double outer_radius() const { return disc_radius > tendon_radius ? disc_radius : tendon_radius; }

  /// What the kernel needs of it to map bends and tendons [m].
  kernel::Section<double> map() const {
    return kernel::make_section<double>(backbone, segments, joint, tendon_radius);
  }
  /// Of a tendon around the disc, from +x [rad].
  double angle_of(int tendon) const {
    return tendon_angle + (is_clockwise ? -2 : 2) * std::numbers::pi * tendon / tendons;
  }
  /// Cosine and sine of `angle_of` [1].
  kernel::Direction<double> direction(int tendon) const {
    return kernel::direction<double>(angle_of(tendon));
  }

  /// Pose of its end on its base [m], z distal, at this bend [rad].
  SINEW_API SE3<double> pose(const Bend& bend) const;
};

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

/// How tip and tendons move with the extension of a section.
struct ExtensionMotion {
  Vec3<double> tip;    ///< velocity of the tip per extension rate [m/m], base axes; it does not turn
  double tendons = 0;  ///< rate of every tendon that passes the section, per extension rate [m/m]
};

/// Memory for questions to one serial robot, and the lengths its sections have; one per thread. `J` and `K`
/// are rows first.
struct SerialWorkspace {
  std::shared_ptr<const char> robot;  ///< identity of the robot it is for, and of that robot's copies
  StopToken stop;               ///< searches that use this workspace end with `stopped` once it is requested
  std::vector<Bend> bends;      ///< per section [rad]
  std::vector<double> changes;  ///< Δl of every tendon [m], section by section; > 0 pays out
  std::vector<double> slack;    ///< what every tendon has beyond what the bends need [m]
  std::vector<SE3<double>> ends;        ///< pose of every section's end, base frame [m]
  std::vector<double> J;                ///< tip twist (base axes, of the tip) per bend rate: 6 × 2M [m, rad]
  std::vector<double> K;                ///< tendon rates per bend rate: tendons × 2M [m]
  std::vector<double> extensions;       ///< of every section [m], by `set_extensions`; 0 at first
  std::vector<double> bend_rates;       ///< by `resolved_rate`, section by section [rad/s]
  std::vector<double> extension_rates;  ///< of every section [m/s]
  std::vector<double> tendon_rates;     ///< of Δl [m/s], section by section; > 0 pays out
  std::vector<ExtensionMotion> extension_jacobians;   ///< of every section, by `extension_jacobians`
  std::vector<Section> sections;                      ///< as long as they are
  std::vector<kernel::Section<double>> maps;          ///< of the sections at rest [m]
  std::vector<kernel::Direction<double>> directions;  ///< of every tendon: cosine and sine, no unit
  std::vector<int> tendons;                           ///< of every section

  /// Allocates all there is; the sections as they are at rest.
  SINEW_API explicit SerialWorkspace(const SerialRobot& robot);
  /// Whether it was made for this robot; bends, extensions, ... are of as many sections.
  bool fits(const SerialRobot& asked) const { return robot && robot == asked.identity; }
  template <class PerSection>
  bool fits(std::span<PerSection> values) const {
    return values.size() == maps.size();
  }

  /// `J` as a matrix of 6 rows: twist of the tip in base axes per bend rate [m], [1].
  MatrixView jacobian() const { return {J.data(), 6, static_cast<Eigen::Index>(2 * bends.size())}; }
  /// `K` as a matrix, a row for each tendon [m/rad].
  MatrixView tendon_jacobian() const {
    return {K.data(), static_cast<Eigen::Index>(changes.size()), static_cast<Eigen::Index>(2 * bends.size())};
  }
};

}  // namespace sinew::inline v1
