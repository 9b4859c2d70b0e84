/// @file arm_model.hpp
/// An arm and a choice of strains as a rod.
#pragma once
#include <string>

#include "sinew/robot/arm.hpp"
#include "strain/rod_model.hpp"

namespace sinew::inline v1 {

/// Of the bases of an arm's strains. What is 0 is chosen by the model.
struct ArmBasis {
  ArmModel model = ArmModel::subsegment_rod;
  int order = -1;    ///< of bending and torsion; −1: 3 along a section, 2 from disc to disc
  int elements = 0;  ///< of a section, or between two discs; of prb joints between two discs
  /// What lies between discs (subsegment_cc, prb) only bends, and twists at its end, at the disc. The joints
  /// of prb are then three, where they follow a beam under a moment and a force at its end.
  bool twist_at_discs = false;
  /// Strains in the section's plane of z and x alone: stretch, shear along x, bending about y.
  bool in_plane = false;
  /// @name Joints without stiffness about y, of a leg in the plane: RodModel::pivots
  /// @{
  bool turns_at_base = false;  ///< one before the first section
  double strut = 0;            ///< length of a rigid bar on one after the last section [m]; 0: none
  double strut_angle = 0;      ///< of the bar to the last section at rest, about y [rad]
  /// @}
};

/// How many elements a basis has: where it says none, as many as its order needs, so that an error is that of
/// the polynomials and not that of the quadrature.
int elements_of(const ArmBasis& basis);
/// The order at most that so many elements determine. Elasticity is seen at their Gauss points, two in each:
/// more coefficients than points would leave shapes that bend and cost no energy.
constexpr int most_order(int elements) { return 2 * elements - 1; }
/// Why these polynomials are not determined by so many elements, in words; empty if they are.
std::string basis_misfit(ArmModel model, int order, int elements);
/// The order of bending and torsion: where the basis says none, the model's, or what its elements determine.
int order_of(const ArmBasis& basis);

/// @param breaks where point loads act, from the base [m]: nodes are there
strain::RodModel make_rod(const Arm& arm, const ArmBasis& basis, const std::vector<double>& breaks = {});

}  // namespace sinew::inline v1
