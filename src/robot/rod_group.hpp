/// @file rod_group.hpp
/// What every group of rods on a platform holds beside the rods themselves: which inputs feed them, the
/// platform's pose, and the factors of its stiffness.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "robot/lu6.hpp"
#include "sinew/leg/rod_leg.hpp"
#include "sinew/math/linalg.hpp"
#include "sinew/robot/parallel.hpp"

namespace sinew::inline v0 {

class RodGroup {
 public:
  using Wrench = Vec<double, 6>;
  using Twist = Vec<double, 6>;

  explicit RodGroup(const ParallelRobot<RodLeg>& robot)  ///< allocates
      : rods_(robot.leg_count()),
        inputs_(robot.total.input),
        platform_(SE3<double>::from(robot.home)),
        radius_(robot.platform_radius) {
    for (const LegPlace& place : robot.places) {
      input_of_.push_back(place.input);
      coordinate_of_.push_back(place.coordinate);
    }
  }

  int rods() const { return rods_; }
  int inputs() const { return inputs_; }
  int input_of(int rod) const { return input_of_[static_cast<std::size_t>(rod)]; }
  /// Where a rod's coordinates begin among the robot's.
  int coordinate_of(int rod) const { return coordinate_of_[static_cast<std::size_t>(rod)]; }
  bool in_domain(int, double length) const { return length > 0 && std::isfinite(length); }
  double radius() const { return radius_; }  ///< of the platform [m]: makes moments comparable with forces
  const SE3<double>& platform() const { return platform_; }
  void set_platform(const SE3<double>& pose) { platform_ = pose; }

 protected:
  /// Turned by half-angle quaternion: like the exponential to second order, and exactly a rotation.
  void move_platform(const Twist& twist) {
    const SO3<double> turn{1, Vec3<double>(twist.tail<3>()) / 2};
    platform_ = {platform_.p + twist.head<3>(), turn.compose(platform_.R).normalised()};
  }

  std::vector<int> input_of_, coordinate_of_;
  int rods_, inputs_;
  SE3<double> platform_;
  double radius_;
  Lu6 lu_;
};

/// Of rods that may be heavy.
class HeavyRodGroup : public RodGroup {
 public:
  explicit HeavyRodGroup(const ParallelRobot<RodLeg>& robot) : RodGroup(robot) {
    for (const RodLeg& leg : robot.legs) {
      mass_.push_back(leg.link.mass_per_length());
      load_.push_back(leg.link.load);
    }
  }
  const Vec3<double>& gravity() const { return gravity_; }  ///< on the rods [m/s²], beside their own load
  bool has_mass() const {
    return std::ranges::any_of(mass_, [](double mass) { return mass > 0; });
  }

 protected:
  /// On a rod along its length [N/m].
  Vec3<double> weight_of(int rod) const {
    const auto k = static_cast<std::size_t>(rod);
    return gravity_ * mass_[k] + load_[k];
  }

  Vec3<double> gravity_ = Vec3<double>::Zero();

 private:
  std::vector<double> mass_;        ///< of each rod along its length [kg/m]
  std::vector<Vec3<double>> load_;  ///< beside its weight [N/m]
};

}  // namespace sinew::inline v0
