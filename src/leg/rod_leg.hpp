/// @file rod_leg.hpp
/// A leg that bears load: a rod between a guide in the base and a joint on the platform. What it hands
/// over is a force that depends on where the platform is; a robot of such legs is in equilibrium, not merely
/// closed. Theory: docs/theory/rod_robot.md
#pragma once
#include <array>

#include "leg/space.hpp"
#include "link/rod.hpp"
#include "tendon/input_kind.hpp"
#include "tendon/pair.hpp"

namespace sinew::inline v1 {

/// The joint at the tip: no moment, no torque.
struct Ball {
  static constexpr std::string_view name = "ball";
};

/// The tip's tangent is held by the platform, and its spin: without torque where the guide lets the rod spin.
struct Clamp {
  static constexpr std::string_view name = "clamp";
};

/// The input of a rod.
struct RodLengthDrive {
  static constexpr int inputs = 1;
  static constexpr std::array input_kinds{InputKind{"length", Dimension::length}};
};

struct RodLeg {
  using Space = Spatial;
  using Link = Rod;
  using Drive = RodLengthDrive;
  using Closure = Ball;
  using Frame = SE3<double>;
  using Point = Vec3<double>;
  static constexpr bool bears_load = true;
  static constexpr bool is_redundant = false, has_elbow = false, has_plane = false;
  static constexpr int dimension = 3;
  static constexpr int rows = 0;  ///< it constrains nothing; the platform's six balances are the robot's
  static constexpr int driven_rows = 0;
  static constexpr int inputs = 1;
  /// Of a rod that bends in one plane: θ at the nodes [rad], lateral and axial tip force [N], length [m];
  /// then zeros. Of another without torque: tangents at rod_tangents points, base to tip, tip force [N],
  /// length [m]. Of any: rotation vectors of its sections at those points, tip force [N], length [m].
  static constexpr int coordinates = 3 * rod_tangents + 4;
  using Coordinates = Vec<double, coordinates>;

  Frame base;                 ///< base point; +y along the base tangent, +x that of the section
  bool is_spin_held = false;  ///< the guide holds the rod's section; else the rod spins freely in it
  Link link;
  Point platform_point = Point::Zero();  ///< in the platform's frame [m]
  bool is_clamped = false;               ///< at the tip: a Clamp, else a Ball
  /// Where the tip points at a clamp, away from the rod: unit vector in the platform's frame.
  Vec3<double> platform_tangent = Vec3<double>(0, 0, 1);

  /// The section's x at a clamp: unit vector in the platform's frame, square to `platform_tangent`.
  Vec3<double> platform_across = Vec3<double>(1, 0, 0);
  bool is_tip_spin_free = false;  ///< the clamp lets the rod spin

  Vec3<double> tangent() const { return base.rotate(Vec3<double>(0, 1, 0)); }
  /// Without torque whatever the load of the platform: a field of tangents says all.
  bool is_torque_free() const {
    return link.is_round() && link.precurvature.isZero(0) &&
           !(is_spin_held && is_clamped && !is_tip_spin_free);
  }
  /// Bends in one plane whatever the load of the platform: the closed form and its fast kernels hold.
  bool is_elastica() const {
    return is_torque_free() && !is_clamped && !link.is_cosserat && link.density == 0 && link.load.isZero(0);
  }
};

/// Most rods of a robot.
inline constexpr int max_rods = 24;

}  // namespace sinew::inline v1
