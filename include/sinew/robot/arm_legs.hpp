/// @file arm_legs.hpp
/// A platform on arms: legs of elastic sections, each pulled by tendons; and memory for questions to it.
/// Theory: docs/theory/arm_legs.md
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/robot/arm.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// An arm between the base and the platform.
struct ArmLeg {
  Arm arm;                ///< its gravity and what its tip carries do not count: those of the robot do
  SE3<double> base = {};  ///< of its first section, z along the arm, base axes [m]
  Vec3<double> platform_point = Vec3<double>::Zero();  ///< where its tip is, in the platform's axes [m]
  /// Its tip is fixed to the platform; else it turns there freely, as in a ball joint.
  bool is_clamped = false;
  SO3<double> mount = {};  ///< of a clamped tip's axes, in the platform's [1]
  /// @name Of a robot in the plane
  /// @{
  bool turns_at_base = false;  ///< its first section turns freely about the base point
  /// Length of a rigid bar without mass from the tip to the platform, free to turn at both ends [m]; 0: none.
  double strut = 0;
  /// @}
};

/// Constant once built, and shared between threads.
struct ArmLegs {
  std::string name;
  std::vector<ArmLeg> legs;
  /// All of it moves in the plane of the base's x and y, and only forces in it count: legs bend about z,
  /// about which every leg's y axis is, and shear and stretch in the plane. Whether it would leave the plane
  /// by itself is not asked.
  bool is_planar = false;
  SpatialPose home;                        ///< of the platform, with all legs at rest
  std::array<double, 3> gravity{0, 0, 0};  ///< base axes [m/s²]
  double platform_mass = 0;                ///< at the platform's reference point [kg], ≥ 0
  bool geometry_inferred = false;          ///< not printed in its source but inferred from results
  /// One for a robot and its copies; by it a workspace knows the robot that it was made for.
  std::shared_ptr<const char> identity = std::make_shared<const char>();

  /// Tendons of all legs [1].
  std::size_t tendons() const {
    std::size_t count = 0;
    for (const ArmLeg& leg : legs) count += leg.arm.tendons.size();
    return count;
  }
};

/// Memory for questions to one platform on arms; the equilibrium that the last one found stays in it. One per
/// thread.
class ArmLegsWorkspace {
 public:
  /// For this robot and its copies.
  SINEW_API explicit ArmLegsWorkspace(const ArmLegs& robot);
  SINEW_API ~ArmLegsWorkspace();
  SINEW_API ArmLegsWorkspace(ArmLegsWorkspace&&) noexcept;
  SINEW_API ArmLegsWorkspace& operator=(ArmLegsWorkspace&&) noexcept;

  StopToken stop;  ///< searches end with `stopped` once it is requested

  struct Impl;
  /// What solvers keep in it.
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::inline v1
