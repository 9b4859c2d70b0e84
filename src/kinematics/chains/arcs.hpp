/// @file arcs.hpp
/// Chains and the arcs whose place they take: searches for chains begin near arcs, and inputs of the robot
/// are what arcs command. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include <optional>

#include "kinematics/chains/chain.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {

/// A robot by the model prb on its arcs, and the memory for these in its workspace.
struct ArcTwin {
  Robot robot;
  Workspace& work;
  ArcTwin(const Robot& on_chains, Workspace& memory) : robot(*on_chains.as(Model::cc)), work(*memory.arcs) {
    work.stop = memory.stop;
  }
};

/// Curvatures of the legs by constant curvature, and directions of clamped or motor-driven bases.
struct Arcs {
  Report report;
  std::vector<double> curvature, base_tangent;
};
/// At a pose on a branch.
Arcs arcs_at(ArcTwin twin, const AnyPose& pose, const InverseOptions& branch);
/// At a pose with these coordinates.
Arcs arcs_of(ArcTwin& twin, const AnyPose& pose, std::vector<double> coordinates);

/// The chains rest at a pose near arcs, on whose bases the motors put the first links.
template <class Space>
Report rest_near(ChainLegs<Space>& robot, const AnyPose& pose, const Arcs& arcs, bool holds_lengths,
                 ChainState<Space>& state);

/// What arcs of some inputs say of the chains: where searches begin, and which tendon lengths are held.
/// Motors hold what `arcs` aim the bases at, which the inputs alone decide.
struct HeldInputs {
  AnyPose pose;
  Arcs arcs;
  std::vector<TendonConstraint> hold;
};
/// At this length of tendon 1: where that is the outer one the inner is held, whose length is as much
/// shorter.
TendonConstraint hold_of_input(const PseudoRigid& chain, double length);
/// By the arcs' lengths. Of more legs than freedoms, whose lengths chains need not agree on, arcs begin where
/// the search does.
template <class Space>
HeldInputs hold_inputs(ArcTwin twin, const ChainLegs<Space>& robot, Numbers inputs,
                       const std::optional<AnyPose>& start, int max_iterations);

/// What motors hold, without load, from rest near arcs at a pose.
template <class Space>
Report unloaded(ChainLegs<Space>& robot, const HeldInputs& held, ChainState<Space>& state, ChainWork& work,
                const ChainOptions& options);

/// In the order of the robot's inputs.
template <class Space>
std::vector<double> inputs_of(ArcTwin twin, const ChainLegs<Space>& robot, const ChainState<Space>& state);

/// What inputs do, in the robot's order where lengths are held: those of tendon 1, and θ that puts a first
/// link farther with its tendon; where tensions are, those of both tendons.
template <class Space>
struct InputRows {
  using Rows = Eigen::Matrix<double, Space::dof, Eigen::Dynamic, Eigen::RowMajor>;
  Rows needed_wrench;  ///< ∂(wrench needed)/∂(inputs), the platform resting
  Rows sensitivity;    ///< ∂(pose)/∂(inputs) at fixed wrench
};
template <class Space>
InputRows<Space> rows_of_inputs(ArcTwin twin, const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                ChainWork& work);

/// Whether there is an equilibrium; tendons that would have to push are told of, not forbidden.
inline bool is_solved(const Report& report) { return report.ok() || report.status == Status::slack; }

}  // namespace sinew::inline v1
