/// @file frame_lanes.hpp
/// Eight rods in space side by side, one a SIMD lane, each a field of frames on spectral elements: they bend
/// and twist, of any section, precurved, loaded. All numbers of their Newton step live here. Theory:
/// docs/theory/spatial_rod.md
#pragma once
#include "link/lobatto.hpp"
#include "robot/rods/tangent_lanes.hpp"

namespace sinew::inline v1 {

/// What Newton's method moves, and what a path is resumed from.
struct FrameState {
  static constexpr int degree = static_cast<int>(element_degree);
  static constexpr int max_nodes = degree * max_elements;  ///< beside the base

  RodLane length;                   ///< L, unstretched [m]
  RodLane frame[max_nodes + 1][4];  ///< of the section to base axes: w, x, y, z, from base to tip
  RodLane force[3];                 ///< n of the platform on the tip [N]
};

/// Of a lower triangle, row after row.
constexpr int triangle_place(int row, int column) { return row * (row + 1) / 2 + column; }

/// Lengths are over L, forces over EI/L², moments over EI/L: what the kernels compute with.
struct alignas(64) FrameRods : FrameState {
  using Lane = RodLane;

  /// An element's matrix: turns of its nodes, tip force, ln L. All but its last node are eliminated.
  static constexpr int nodes = degree + 1, turns = 3 * nodes, eliminated = 3 * degree;
  static constexpr int force_at = turns, length_at = turns + 3, rows = turns + 4;
  /// What is left of all: turns of the tip, its force, ln L.
  static constexpr int left = rows - eliminated;
  static constexpr int triangle = triangle_place(rows, 0), left_triangle = triangle_place(left, 0);

  /// @name What the rods are. A lane without a rod repeats another.
  /// @{
  Lane unit;             ///< EI, the geometric mean of both ways [N m²]
  Lane stiffness[3];     ///< of bending about x and y and of torsion, over EI
  Lane compliance[3];    ///< of shear along x and y and of stretch [1/N]
  Lane precurvature[3];  ///< u* [1/m]
  Lane weight[3];        ///< f: force along the rod, of its unstretched length [N/m]
  Lane turns_at_base;    ///< 1 where the guide lets the section turn and something depends on it
  /// @}

  /// @name At the last evaluation
  /// @{
  Lane gap[max_nodes + 1][3];  ///< gradient of the energy by the nodes' turns, in the sections' axes
  Lane reached[3];             ///< the tip less the base
  Lane error;                  ///< largest gap between base and tip
  /// @}

  /// @name Kept from the last linearisation
  /// @{
  Lane factors[max_elements][triangle];  ///< L, on the diagonal 1/D
  Lane condensed[left_triangle];         ///< what is left at the tip
  /// @}

  /// @name By the gaps, with the factors kept
  /// @{
  Lane reduced[max_elements][eliminated];  ///< L⁻¹ of them
  Lane open[6];                            ///< what is left of them: the tip's turns, and its place by force
  /// @}

  /// A step: turns of the tip, its force, ln L.
  Lane step[left];
};

}  // namespace sinew::inline v1
