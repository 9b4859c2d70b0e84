/// @file serial_workspace.hpp
/// Memory for questions to a serial robot: answers are read from it.
#pragma once
#include <span>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/base/stop.hpp"
#include "sinew/math/linalg.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

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
