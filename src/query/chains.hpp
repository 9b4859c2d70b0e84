/// @file chains.hpp
/// Handlers of queries about robots whose links are taken as pseudo-rigid chains (`"model": "prb"`).
#pragma once
#include "query/context.hpp"
#include "sinew/kinematics/chain.hpp"

namespace sinew::inline v0 {

void answer_chains_forward(Context& context);
void answer_chains_inverse(Context& context);
void answer_chains_velocity(Context& context);
void answer_statics(Context& context);

/// What the handlers share.
namespace chains {

/// `law`: M0w, M0 or M1.
ChainModel read_law(Context& context);

/// The robot on chains; null, with errors noted, where it has none.
std::optional<AnyChainRobot> read_robot(Context& context, ChainModel law);

/// Curvatures, and directions of clamped or motor-driven bases, of the legs at a pose on a branch, by
/// constant curvature: where searches for chains begin.
struct Arcs {
  Report report;
  std::vector<double> curvature, base_tangent;
};
Arcs arcs_at(Context& context, const AnyPose& pose, const Branch& branch);

/// First links along the tangents of the arcs, less the half of a link that they stand for.
void aim_bases(ChainRobot<Planar>& robot, const Arcs& arcs);
inline void aim_bases(ChainRobot<Spatial>&, const Arcs&) {}

}  // namespace chains
}  // namespace sinew::inline v0
