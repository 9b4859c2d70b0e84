/// @file equilibrium.hpp
/// Forward and inverse kinematics of robots whose legs bear load: where a platform on rods comes to rest
/// under a wrench, which lengths hold it at wanted coordinates, and which wrench the axial forces of six rods
/// tell, as load cells at the guides measure them. Theory: docs/theory/rod_robot.md
///
/// A robot by the model prb (`robot.as(Model::prb)`) is asked the same of its pseudo-rigid chains, but for
/// `inverse_equilibrium` at independent coordinates. Their inputs are those of arcs: lengths of tendon 1 [m],
/// before them the angles of base motors [rad]. They allocate, have no coordinates and no gravity; residuals
/// are in m; `slack` is an equilibrium in which a tendon would have to push. A robot in the plane is in the
/// plane z = 0: its wrench is (fx, fy, 0, 0, 0, m). Theory: docs/theory/chain_equilibrium.md
#pragma once
#include <optional>
#include <vector>

#include "sinew/kinematics/inverse.hpp"
#include "sinew/link/state.hpp"

namespace sinew::inline v1 {

/// A wrench (force [N], moment about the platform's reference point [N m]) in base axes, of the world on the
/// platform.
using SpatialWrench = Vec<double, 6>;

/// Load, start and bounds of a search.
struct EquilibriumOptions {
  SpatialWrench wrench = SpatialWrench::Zero();  ///< of the world on the platform [N, N m], base axes
  std::optional<Vec3<double>> gravity = {};      ///< [m/s²]; default: the robot's
  /// Where the search begins: the rods are laid to this pose, then let go. Default: the robot's home.
  std::optional<SpatialPose> start = {};
  /// Begin from the equilibrium the workspace holds, as a controller does whose inputs change a little. What
  /// is found then depends on what was solved before. Where it holds none the search begins at `start`.
  bool warm_start = false;
  /// No further step of the path is begun after so many Newton steps; a step takes a few. Default 4000.
  std::optional<int> max_iterations = {};
  /// A warm answer too is asked for stability and resolution. Without, no answer hands out coordinates, and a
  /// warm one is as quick as it can be: shapes to an estimated 1e-10 of the length, of rods that do not bend
  /// in one plane 1e-9.
  bool check_stability = true;
};

/// Views into the workspace. Where nothing was solved pose and inputs are those of the last state tried, at
/// which a path ended.
struct Equilibrium {
  Report report;  ///< `unstable` where the equilibrium does not hold by itself; all fields are then valid
  SpatialPose pose;
  std::span<const double> inputs;       ///< rod lengths [m]
  std::span<const double> coordinates;  ///< of the legs' states, whose units are their own: for `any_shape`

  /// Solved, stable or not.
  bool is_solved() const noexcept { return report.is_solved(); }
};

/// The platform on rods of these lengths [m], under a wrench. One Newton iteration on pose and rods together,
/// along a path from the start: first the lengths, then the load. Residual: the largest of closure error over
/// leg length, of force error over EI/L² of the stiffest rod, and of the rods' own equations. Where the path
/// ends early the report says why: rods pulled straight, a fold of the inputs, buckling under the load. No
/// heap, no throw, bounded work.
/// @implements 3PFS (25)-(30)
SINEW_API Equilibrium equilibrium(const Robot& robot, Numbers inputs, const EquilibriumOptions& options,
                                  Workspace& work);

/// Lengths that hold the platform at z, e₁, e₂, and where the parasitic coordinates x, y, e₃ come to rest.
SINEW_API Equilibrium inverse_equilibrium(const Robot& robot, const IndependentPose& wanted,
                                          const EquilibriumOptions& options, Workspace& work);

/// Six inputs that hold the platform at a pose. Begins at home, or from the last answer: `start` is not
/// asked, here and above. Allocates where the straight way there ends early, to find the fold and other ways.
SINEW_API Equilibrium inverse_equilibrium(const Robot& robot, const SpatialPose& wanted,
                                          const EquilibriumOptions& options, Workspace& work);

/// Whether `equilibrium_batch` walks the robot's rods in lanes: all its legs are rods that bend in one plane
/// each.
SINEW_API bool has_equilibrium_batch(const Robot& robot);

/// Where the search for each of many equilibria begins.
enum class RowStart {
  row_before,  ///< at the one before, as on a path: neighbouring rows should be near each other
  home,        ///< at home, whatever the other rows are
};

/// Many equilibria under one wrench [N, N m]: `rows` holds the inputs of each [m], one after the other,
/// `poses` and `statuses` have one entry each. Eight stretches of rows are walked at once in SIMD lanes, or
/// eight rows from home, and a row that does not come at once, or whose rods bend more sharply than the lanes
/// resolve, is solved alone; rods that do not bend in one plane go row by row. Shapes to the estimate of
/// quick resumed answers. Gravity is the robot's. Where a status is neither `converged` nor `unstable` the
/// pose is not one. Allocates once a call.
/// @param check_stability whether it is asked if equilibria hold by themselves, and where they do not whether
///     home leads to one that does; else they are all `converged`
/// @param residuals as that of `equilibrium`, no unit: one a row, or none
SINEW_API void equilibrium_batch(const Robot& robot, Numbers rows, const SpatialWrench& wrench,
                                 std::span<SpatialPose> poses, std::span<Status> statuses, Workspace& work,
                                 bool check_stability = false, std::span<double> residuals = {},
                                 RowStart start = RowStart::row_before);

/// The equilibrium that the workspace holds now: also after a load was followed, or a wrench sensed. Where it
/// holds none the report is not one of success.
SINEW_API Equilibrium held_equilibrium(const Robot& robot, Workspace& work);

/// What a pseudo-rigid chain of a leg does, in the order of its joints from the base.
struct ChainResult {
  std::vector<double> angles;             ///< of the sprung joints [rad]
  double chord_force = 0;                 ///< of the chord or the strut [N]; > 0 pulls the platform
  std::array<double, 2> tension{};        ///< of tendons 1 and 2 [N]; below 0 where it would have to push
  std::array<double, 2> tendon_length{};  ///< of tendons 1 and 2 [m]
  SpatialWrench tip_wrench = SpatialWrench::Zero();  ///< that its joints tell of, at its tip [N, N m]
  double base_angle = LegState::absent;    ///< of the first link from x [rad]; NaN without a motor there
  double motor_torque = LegState::absent;  ///< of the motor on the first link [N m]; NaN without
};

/// What is known of the equilibrium a workspace holds, on rods or on chains. In the plane rows and columns
/// of z and of turns about x and y are 0.
struct RodAnalysis {
  /// ∂(F, M)/∂(p, φ) at fixed inputs, 6 × 6, rows first [N/m, N; N, N m]; 0 for motions that closing legs
  /// forbid.
  std::array<double, 36> stiffness{};
  std::vector<double> feed;  ///< −∂(F, M)/∂inputs at a resting platform, 6 × inputs, rows first [N/m, N]
  std::vector<double> sensitivity;  ///< ∂(p, φ)/∂inputs at fixed load, 6 × inputs, rows first [1, 1/m]
  int unstable_directions = 0;      ///< of the second variation, all rods free to move
  /// Twists [m, rad], of norm 1, along which the platform's stiffness is negative
  std::vector<std::array<double, 6>> unstable;
  std::vector<std::array<int, 2>> unstable_rods;  ///< tip held: in the rod's plane, out of it
  std::vector<RodResult> rods;                    ///< in the order of the legs; none of chains
  std::vector<ChainResult> chains;                ///< in the order of the legs; none of rods
  std::vector<Vec3<double>>
      closing_forces;  ///< of the platform on each closing leg, at its point, base axes [N]
  double energy = 0;   ///< elastic, of all rods, or springs of chains [J]
  /// Of rods and load, of chains with tendons held at tensions [J]; with a moment in space there is none: NaN
  double potential = 0;
  /// Of the platform's stiffness, as a share of the largest: 0 at a fold. Of chains by singular values.
  double smallest_pivot = 0;
  /// Of bending, anywhere on a rod: κ d/2, of a strip at a corner [1]; NaN of chains without a diameter
  double largest_strain = 0;
  /// Of chains: of the energy's Hessian along what closures and held lengths leave free [N m], > 0 where the
  /// equilibrium holds by itself. NaN of rods, whose unstable directions are counted without.
  double smallest_eigenvalue = LegState::absent;
  bool is_in_plane = false;  ///< the robot can only move in the plane z = 0

  /// The platform can move with all lengths held.
  bool is_singular() const { return !(smallest_pivot >= 1e-10); }

  /// Kinematic sensitivities: 2-norms of the blocks of `sensitivity`, position [m/m], rotation [rad/m].
  SINEW_API double position_index() const;
  SINEW_API double rotation_index() const;  ///< [rad/m], see `position_index`
};

/// Of robots on rods or chains. Where the workspace holds no equilibrium, and of other robots, the lists are
/// empty. Allocates.
SINEW_API RodAnalysis analyse_equilibrium(const Robot& robot, Workspace& work);
/// The same without derivatives and stability: rods, closing forces [N], energies [J] and the largest strain
/// [1], in half of the time.
SINEW_API RodAnalysis read_rods(const Robot& robot, Workspace& work);

/// Why a load path ended.
enum class LoadEnd {
  limit,        ///< the limit was reached
  bifurcation,  ///< the equilibrium goes on, but no longer holds by itself: another curve crosses
  fold,         ///< there is no equilibrium nearby beyond this load
  stability,    ///< the equilibrium goes on, and a moment drives it away: none crosses
  straight,     ///< a rod is pulled straight
  sharp,        ///< the rods bend more sharply than is resolved
  iterations,   ///< the bound on steps was met
  stopped,      ///< on request
  stalled,      ///< none of these, and no step however short succeeds
  slack,        ///< a tendon of a chain would have to push
};
/// Its name: `bifurcation`.
SINEW_API std::string_view to_string(LoadEnd end) noexcept;

/// The last equilibrium of a growing load.
struct LoadPath {
  double load = 0;  ///< factor of the direction that was reached, no unit
  LoadEnd end = LoadEnd::limit;
  SpatialPose pose;     ///< there
  double residual = 0;  ///< there, as that of `equilibrium`, no unit
  /// With a moment the stiffness is not symmetric: from this factor on, before `load`, its symmetric part is
  /// not definite, and what the load does depends on the way the platform moves. Below 0 where that is not
  /// so.
  double definite_until = -1;
  int unstable_directions = 0;  ///< there, as RodAnalysis
};

/// Adds `direction` times a growing factor to the wrench of the equilibrium the workspace holds, up to
/// `limit`. Afterwards the workspace holds the last equilibrium that holds by itself. Where it held none, or
/// the direction or limit is no load, the factor is 0 and the end `stalled`.
SINEW_API LoadPath follow_load(const Robot& robot, const SpatialWrench& direction, double limit,
                               Workspace& work);

/// One of several equilibria under the same load: of the same inputs, or of the same pose.
struct FoundEquilibrium {
  SpatialPose pose;
  std::vector<double> inputs;  ///< rod lengths [m]
  std::vector<RodResult> rods;
  double residual = 0;   ///< as that of `equilibrium`, no unit
  double potential = 0;  ///< of rods and load [J]
  int unstable_directions = 0;
};

/// Equilibria at these rod lengths [m] found from many starts around home, in ascending order of energy: a
/// lower bound of their number, never proven to be all. Allocates; takes tens of milliseconds, of rods that
/// bear torque about a second.
/// @param options of every search; its start is not asked
SINEW_API std::vector<FoundEquilibrium> equilibria(const Robot& robot, Numbers inputs,
                                                   const EquilibriumOptions& options, Workspace& work);

/// Equilibria of one pose on several branches, each with its inputs, found by ways from home through many
/// poses around it; as `equilibria` else. The first way is that of `inverse_equilibrium`. On chains they are
/// those of the arcs' working modes.
SINEW_API std::vector<FoundEquilibrium> inverse_equilibria(const Robot& robot, const SpatialPose& wanted,
                                                           const EquilibriumOptions& options,
                                                           Workspace& work);

/// Rates of the inputs [m/s] that move the platform so, into `rates`: those for which K·(rates) = J·(twist),
/// of fewer rows where legs close beside the rods. `singular` where none do, within 1e-9.
/// @param twist six numbers [m/s, rad/s], base axes; or three: of a robot in the plane vx, vy, ω, of another
/// with three inputs ż, ωx, ωy, the others follow. No heap.
SINEW_API Report rod_rates(const RodAnalysis& analysis, Numbers twist, std::span<double> rates);

/// What the platform does at these rates of the inputs [m/s]: U·(rates) [m/s, rad/s], base axes. `singular`
/// where the platform can move with all inputs held. No heap.
SINEW_API Report rod_twist(const RodAnalysis& analysis, Numbers rates, std::span<double, 6> twist);

/// A wrench with what it is uncertain by.
struct SensedWrench {
  Report report;
  SpatialPose pose;
  SpatialWrench wrench;  ///< of the world on the platform [N, N m], base axes; what gravity does is taken off
  std::array<double, 36> sensitivity;  ///< ∂wrench/∂axial, 6 × 6, rows first: forces [1], moments [m]
  /// Of the wrench, 6 × 6, rows first [N², N² m, N² m²], by that of the measured forces
  std::array<double, 36> covariance;
};

/// The wrench under which the rods of these lengths pull so at their guides. In the place of the wrench the
/// pose is the unknown: at fixed lengths it makes all forces, and the wrench is what they leave over.
/// `singular` where the forces do not tell (or no pose near the unloaded one makes them).
/// Of chains (model prb) of as many legs as the platform has freedoms the same of the tendons whose lengths
/// are held, one a leg: where tendon 1 is the outer one, of the inner one. In the plane sensitivity and
/// covariance are 0 but for fx, fy and m, and sensitivity has a column for each of the three legs.
/// @param inputs lengths of the six rods [m]
/// @param axial of each of six rods, pull > 0 [N]
/// @param deviations standard deviations of these, independent of each other [N]
/// @param options of the unloaded platform, from which the search begins; its wrench is not asked
SINEW_API SensedWrench sense_wrench(const Robot& robot, Numbers inputs, Numbers axial, Numbers deviations,
                                    const EquilibriumOptions& options, Workspace& work);

}  // namespace sinew::inline v1
