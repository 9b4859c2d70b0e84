/// @file tangent_lanes.hpp
/// Eight rods in space side by side, one a SIMD lane, each a field of unit tangents on spectral elements:
/// round rods without torque. All numbers of their Newton step live here. Theory: docs/theory/tangent_rod.md
#pragma once
#include "link/lobatto.hpp"
#include "robot/rods/rod_lanes.hpp"

namespace sinew::inline v1 {

/// Most elements of a rod; they are of equal length.
inline constexpr int max_elements = 8;

/// What Newton's method moves, and what a path is resumed from.
struct TangentState {
  static constexpr int degree = static_cast<int>(element_degree);
  static constexpr int max_nodes = degree * max_elements;  ///< beside the base

  RodLane length;                     ///< L, unstretched [m]
  RodLane tangent[max_nodes + 1][3];  ///< t at the nodes from base to tip, base axes
  RodLane force[3];                   ///< n of the platform on the tip [N]
};

struct alignas(64) TangentRods : TangentState {
  using Lane = RodLane;
  using State = TangentState;

  /// A node is tied to those of its element; `first_of` them is known before it.
  static constexpr int first_of(int node) { return node <= degree ? 1 : (node - 1) / degree * degree; }
  /// 2×2 blocks left of the diagonal, of all nodes before this one.
  static constexpr int row_of(int node) {
    const int element = (node - 1) / degree, own = node - element * degree;
    if (element == 0) return (own - 1) * (own - 2) / 2;
    return degree * (degree - 1) / 2 + (element - 1) * degree * (degree + 1) / 2 + own * (own - 1) / 2;
  }
  static constexpr int max_blocks =
      degree * (degree - 1) / 2 + (max_elements - 1) * degree * (degree + 1) / 2;

  /// Columns that are carried through the elimination: the tip's position by its force, and the length.
  static constexpr int columns = 4;

  /// @name What the rods are. A lane without a rod repeats another and is not active.
  /// @{
  Lane base[3];              ///< base point [m]
  Lane platform_point[3];    ///< platform axes [m]
  Lane platform_tangent[3];  ///< of a clamp, platform axes
  Lane clamped;              ///< 1 where the platform holds the tangent at the tip, 0 at a ball joint
  Lane flexibility;          ///< 1/EI [1/(N m²)]
  Lane stretch;              ///< β = 1/EA − 1/GA [1/N]; 0, as `shear`, where the rod does neither
  Lane shear;                ///< 1/GA [1/N]
  Lane weight[3];            ///< f: force along the rod, of its unstretched length [N/m]
  Lane active;               ///< 1 or 0
  /// @}

  /// @name At the last evaluation
  /// @{
  Lane across[max_nodes + 1][2][3];  ///< with t an orthonormal frame, carried along by steps
  Lane pull[max_nodes + 1][3];       ///< dimensionless gradient g of the energy by t
  Lane gap[max_nodes + 1][2];        ///< its part across t: 0 in equilibrium but at a clamp, there the moment
  Lane tip[3], tip_gap[3];           ///< of the rod less its base; less the platform's point [m]
  Lane arm[3];                       ///< platform point from the reference point, base axes [m]
  Lane moment[3];                    ///< of the platform on the tip [N m]
  /// @}

  /// @name Factors kept from the last linearisation, H = LDLᵀ, and what they say of the tip
  /// @{
  Lane lower[max_blocks][4], inner[max_nodes + 1], pivot[max_nodes + 1][2];  ///< L, 1/D
  Lane eliminated[max_nodes + 1][2 * columns];  ///< L⁻¹ of what force and length do to the gaps
  Lane left[max_nodes + 1][2];                  ///< L⁻¹ of the gaps
  Lane tip_pivot[3];                            ///< what is left of H at the tip: 11, 12, 22
  Lane tip_soft[3];                             ///< its inverse at ball joints; at clamps 0
  Lane turned[2][3];                            ///< Q: what turns of the platform do to the tip's tangent
  Lane stiffness[6];                ///< S, tip's tangent held or free: xx, xy, xz, yy, yz, zz [N/m]
  Lane coupling[2][3], bending[3];  ///< of a clamp: force and moment by its tangent's turns
  Lane feed[6];                     ///< force and moment on the platform point by length
  Lane feed_moment[2];              ///< the moment at a clamp by length
  Lane fix[3];                      ///< force that closes the gaps at a resting platform [N]
  /// @}
};

}  // namespace sinew::inline v1
