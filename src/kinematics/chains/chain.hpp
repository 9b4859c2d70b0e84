/// @file chain.hpp
/// Equilibria of robots whose links are pseudo-rigid chains, under tendons and a wrench, subject to the
/// closures. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include <limits>
#include <vector>

#include "base/limits.hpp"
#include "robot/chains.hpp"
#include "sinew/robot/robot.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// What the motors of a leg hold: tensions, or the length of one tendon.
struct TendonConstraint {
  int length_of = -1;               ///< the tendon whose length is held, 0 or 1; −1: neither
  double length = 0;                ///< of that one [m]
  std::array<double, 2> tension{};  ///< of those whose length is not held [N]
};

/// What a chain and its tendons do.
struct ChainLegState {
  std::array<double, max_chain_joints> angles{};  ///< of the sprung joints [rad]
  double force = 0;                               ///< of the chord or the strut [N]; > 0 pulls the platform
  std::array<double, 2> tension{};                ///< of tendons 1 and 2 [N]
  std::array<double, 2> tendon_length{};          ///< [m]

  std::span<const double> of(const PseudoRigid& chain) const {
    return {angles.data(), static_cast<std::size_t>(chain.joints())};
  }
};

/// An equilibrium, with what holds it: a solver starts from one and leaves another.
template <class SpaceT>
struct ChainState {
  typename SpaceT::Pose pose;
  std::vector<ChainLegState> legs;
  std::vector<TendonConstraint> hold;
  Vec<double, SpaceT::dof> wrench = Vec<double, SpaceT::dof>::Zero();
};

/// Whether the state is one of this robot's, as far as its sizes tell. Functions answer one that is not with
/// `bad_input`, or with numbers that are not.
template <class Space>
bool fits(const ChainLegs<Space>& robot, const ChainState<Space>& state) {
  return state.legs.size() == robot.legs.size() && state.hold.size() == robot.legs.size();
}

/// Chains at a pose without a wrench, held by the tension of one tendon a leg, the inner one; the other is
/// loose. They bend evenly, as under a moment, but for straight tendons on a clamped base (M1). Lengths of
/// the inner tendons are held, or tensions. Allocates.
/// @param curvature of each leg [1/m], near it: of a leg without a strut its sign is enough
/// @return `unreachable` where a leg has no such shape near it
template <class Space>
Report unloaded_equilibrium(const ChainLegs<Space>& robot, const typename Space::Pose& pose,
                            std::span<const double> curvature, bool holds_lengths, ChainState<Space>& state);

struct ChainOptions {
  int max_iterations = 2000;  ///< Newton steps of the whole path
  /// Every chain bends evenly, as a constant-curvature link: one freedom a leg.
  bool evenly_bent = false;
};

/// The equilibrium under this wrench with the motors holding that, on a straight path of both from the one in
/// `state`, which is replaced. One Newton iteration on pose, angles, forces and tensions together, the legs
/// eliminated within each step. Residual: the largest of closure error, of what joints are out of balance by,
/// as angles times ℓ, and of the platform's imbalance over the stiffness EI/ℓ³ [m].
///
/// Not converged, with the last equilibrium on the path in `state`: `stalled` where the path folds, or is
/// lost; `iteration_limit`; `singular` where the platform can move with everything held (type II), or a leg
/// has so few joints that a tendon's length and its closure leave none to yield; `left_domain` for a length
/// that asks joints for half a turn. `slack` (all fields are
/// valid) where a tendon would have to push.
template <class Space>
Report equilibrium(const ChainLegs<Space>& robot, std::span<const TendonConstraint> hold,
                   const Vec<double, Space::dof>& wrench, ChainState<Space>& state, ChainWork& work,
                   const ChainOptions& options = {});

/// Tensions of the inner tendons that hold the platform there under this wrench, from the equilibrium in
/// `state`, of that pose; what its motors hold, tensions or lengths, is what they then have. Of more legs
/// than freedoms the tensions are those nearest to the ones in `state`, in least squares. `unreachable` where
/// legs are fewer, `stalled` where the path to the wrench is lost.
template <class Space>
Report inverse_statics(const ChainLegs<Space>& robot, const Vec<double, Space::dof>& wrench,
                       ChainState<Space>& state, ChainWork& work, const ChainOptions& options = {});

/// What the motor at a base exerts on the first link, counter-clockwise [N m]: the energy's derivative by the
/// motor's angle, whatever else is held. Theory: docs/theory/chain_equilibrium.md
double motor_torque(const ChainLeg<Planar>& leg, const ChainLegState& state, const SE2<double>& platform);

/// What a growing load comes to.
enum class ChainLoadEnd {
  limit,
  fold,         ///< the path turns back
  bifurcation,  ///< an equilibrium beside it takes its place
  slack,        ///< a tendon would have to push
  iterations,   ///< the bound on them was met
  stability,    ///< the path goes on, but under this moment does not hold by itself: none takes its place
};
std::string_view to_string(ChainLoadEnd end) noexcept;

struct ChainLoadPath {
  ChainLoadEnd end = ChainLoadEnd::limit;
  double load = 0;  ///< times the direction that was added
  Report report;    ///< of the last equilibrium, iterations of all; `iteration_limit` where these ended it
};

/// Adds `direction` times a growing factor to the wrench until it is `limit`, or something else ends it, by
/// arc length: that load is exact to rounding. `state` is the last equilibrium before. Allocates.
template <class Space>
ChainLoadPath follow_load(const ChainLegs<Space>& robot, const Vec<double, Space::dof>& direction,
                          double limit, ChainState<Space>& state, ChainWork& work,
                          const ChainOptions& options = {});

/// Smallest eigenvalue of the energy's Hessian in pose and angles along what the closures, and lengths that
/// are held, leave free: > 0 where the equilibrium holds by itself, infinite where they leave nothing.
/// Allocates.
template <class Space>
double smallest_hessian_eigenvalue(const ChainLegs<Space>& robot, const ChainState<Space>& state);

/// ∂(wrench)/∂(pose) and ∂(pose)/∂(wrench) with everything held: twist order. Under a moment in space not
/// symmetric.
template <class Space>
Mat<double, Space::dof, Space::dof> stiffness(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                              ChainWork& work);
template <class Space>
Mat<double, Space::dof, Space::dof> compliance(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                               ChainWork& work);

/// Springs, tendons that are held at tensions, and the wrench [J]: Σ ½ k θ² + Σ T l − W·x. Rotations in space
/// bear no potential of a moment: NaN where there is one.
template <class Space>
double potential(const ChainLegs<Space>& robot, const ChainState<Space>& state);

/// Rows of the velocity equations of chains, J·t = K·θ̇ as [TDPCR] has them: row i of J is ρ or the strut's
/// length times the leg's line, row i of K has columns of leg i alone.
template <class Space>
struct ChainRates {
  template <class T>
  using OfLegs = std::array<T, max_rows>;  ///< of more legs there are none
  Eigen::Matrix<double, Eigen::Dynamic, Space::dof, Eigen::DontAlign, max_rows, Space::dof> J;
  OfLegs<std::array<double, max_chain_joints + 1>> K{};
  OfLegs<int> columns{};     ///< sprung joints, after the base motor's angle where there is one
  double closure_error = 0;  ///< largest [m]; NaN where one is

  std::size_t legs() const { return static_cast<std::size_t>(J.rows()); }
};
/// @implements TDPCR (34), (36)-(38), (60)-(62)
template <class Space>
ChainRates<Space> chain_rates(const ChainLegs<Space>& robot, const typename Space::Pose& pose,
                              std::span<const ChainLegState> legs);

/// The paper's linear model of a load: ∂(pose)/∂(wrench) = U k⁻¹ Uᵀ with U = J⁻¹ K of the unloaded robot, of
/// more legs than freedoms the inverse of the sum of their stiffnesses. It leaves out the geometric
/// stiffness; where lengths are held, motions that keep them. @implements TDPCR (44), (45), (46)
template <class Space>
Mat<double, Space::dof, Space::dof> linear_compliance(const ChainLegs<Space>& robot,
                                                      const ChainState<Space>& state);

/// How much more energy the unloaded robot's chains would store under this wrench if they bent evenly [J], to
/// first order in the chord forces: what constant curvature misses. Of springs alone: low under M1, whose
/// tendons soften them. Theory: docs/theory/chain_equilibrium.md
template <class Space>
double constant_curvature_energy_gap(const ChainLegs<Space>& robot, const ChainState<Space>& unloaded,
                                     const Vec<double, Space::dof>& wrench);

/// Force and moment at a link's tip that joint torques tell of, in base axes, by least squares of τ = J_pᵀ
/// F, whose last row is what the tip turns by (of M0w each joint's weight); `closure_error` of the torques,
/// relative: 0 where the tendons' moment is that of M0 or M0w. @implements TDPCR (54), (55)
struct TipWrench {
  Vec2<double> force;  ///< in the chain's plane: beside and along the first link [N]
  double moment;       ///< [N m]
  double closure_error;
};
TipWrench tip_wrench(const PseudoRigid& chain, std::span<const double> torques,
                     std::span<const double> angles);

/// The same of a leg whose springs are bent so, in base axes: force, then moment. Allocates.
template <class Space>
Vec<double, Space::dof> tip_wrench(const ChainLeg<Space>& leg, std::span<const double> angles,
                                   const typename Space::template Frame<double>& platform);

}  // namespace sinew::inline v1
