/// @file rod_bvp.hpp
/// A general elastic rod held at both ends: the forces that hold it, what they become when the tip moves or
/// the rod is fed, and whether it stays where it is. Theory: docs/theory/spatial_rod.md
#pragma once
#include "shooting_rod/shooting_rod.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Where a search begins: what is known of a rod nearby.
struct RodStart {
  Vec3<double> force{0, 0, 0};   ///< n(0) [N], base axes
  Vec3<double> moment{0, 0, 0};  ///< m(0) [N m]
  double axial_rotation = 0;     ///< [rad]
};

struct HoldOptions {
  int steps = 0;             ///< of the integration; 0: as many as the tolerance asks for
  double tolerance = 1e-11;  ///< on closure and integration, of the length and in rad
  int max_iterations = 60;   ///< of each of at most 100 solves on the way
};

struct RodBvpSolution {
  Report report;              ///< `residual`: position, turn × L, free moment × L²/EI, the largest [m]
  RodState<double> base;      ///< with force and moment at the base, and the frame after its axial rotation
  RodState<double> tip;       ///< its n and m are what holds the tip on the rod
  double axial_rotation = 0;  ///< of the base frame about its z [rad]; 0 where nothing depends on it
  double energy = 0;          ///< elastic energy and potential of the load, as RodTip::energy [J]
  double error = 0;           ///< of the integration, estimated, of the length and in rad
  int steps = 0;              ///< of the integration

  /// ∂(n, m at the tip)/∂(translation, rotation vector of the tip), base axes, length held. Zero for what the
  /// tip leaves free. NaN where the report is not `converged`.
  Mat<double, 6, 6> stiffness;
  /// ∂(n, m at the tip)/∂L, tip held: the rod is fed through its base.
  Vec<double, 6> feed;
};

/// An equilibrium of the rod from `base` to `tip` (of whose frame the ends say what counts). With a start,
/// the nearest that Newton's method finds. Without, or where that finds none: followed from an unloaded arc
/// whose ends are turned while it is loaded; stable, if one of four arcs leads to a stable one.
/// - `unreachable`: an inextensible rod shorter than the way.
/// - `singular`: the ends are met, but do not determine the forces (straight; free to turn; about to jump).
/// - `stalled`: none was found; the numbers are those of the last iterate, and meet nothing.
RodBvpSolution solve_rod_bvp(const SpatialRod& rod, const SE3<double>& base, double length,
                             const RodEnds& ends, const SE3<double>& tip, const HoldOptions& options = {});
RodBvpSolution solve_rod_bvp(const SpatialRod& rod, const SE3<double>& base, double length,
                             const RodEnds& ends, const SE3<double>& tip, const RodStart& start,
                             const HoldOptions& options = {});

/// In how many directions the energy of an equilibrium falls with its ends held so: 0 where it is stable, −1
/// where it cannot be counted. A rod that does not stretch is counted as one with 1/EA = 10⁻⁸ L²/EI.
/// @param base state at the base, as in RodBvpSolution
int unstable_directions(const SpatialRod& rod, double length, const RodState<double>& base,
                        const RodEnds& ends);

}  // namespace sinew::inline v1
