/// @file chains.hpp
/// What a robot by the pseudo-rigid model is made of: legs whose links are chains, and a platform. Theory:
/// docs/theory/pseudo_rigid.md
#pragma once
#include <span>
#include <vector>

#include "leg/space.hpp"
#include "link/pseudo_rigid.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

/// A leg whose link is a chain. Without a strut it turns freely at both ends and keeps its chord; with one
/// (in the plane) its base is held, +y of the base frame being the base tangent of a clamped chain and the
/// first link of a pinned one, and the strut leads from its tip to the platform.
template <class SpaceT>
struct ChainLeg {
  using Space = SpaceT;
  typename Space::template Frame<double> base;
  PseudoRigid chain;
  double bending_stiffness = 0;  ///< EI [N m²], > 0
  double tendon_offset = 0;      ///< d [m], > 0
  double strut = 0;              ///< its length [m]; 0: there is none
  Vec<double, Space::dimension> platform_point = Vec<double, Space::dimension>::Zero();
  double diameter = 0;  ///< of the round backbone [m]; 0: not known

  bool has_strut() const { return strut > 0; }
  /// Stiffness of a joint [N m/rad].
  double spring(int joint) const { return bending_stiffness / chain.link_length() * chain.spring(joint); }
};

/// All legs, with as many joints as the robot's file gives (n of a spatial leg counts both axes of its
/// universal joint, [TDPCR] section 4.1).
template <class SpaceT>
struct ChainLegs {
  using Space = SpaceT;
  std::vector<ChainLeg<SpaceT>> legs;
  double platform_radius = 0;  ///< homogenises moments [m], > 0
  /// Base motors turn the first links: the directions of the base frames are inputs.
  bool has_base_motors = false;
};

/// Calls `use` with the chains of a robot whose model is prb.
template <class Use>
decltype(auto) with_chains(const Robot& robot, Use&& use) {
  if (const auto* planar = robot.planar_chains()) return use(*planar);
  return use(*robot.spatial_chains());
}
/// Those of a robot whose model is prb, in this space.
template <class Space>
const ChainLegs<Space>& chains_of(const Robot& robot) {
  if constexpr (Space::dimension == 2)
    return *robot.planar_chains();
  else
    return *robot.spatial_chains();
}

/// The chain's own frame, x beside its first link and y along it: held by the base where there is a strut,
/// else turned so that the tip lies towards the platform point.
template <class Space>
typename Space::template Frame<double> chain_frame(const ChainLeg<Space>& leg, std::span<const double> angles,
                                                   const typename Space::template Frame<double>& platform) {
  if (leg.has_strut()) return leg.base;
  const auto r = (platform.point(leg.platform_point) - leg.base.p).eval();
  return Space::aimed(leg.base, r, leg.chain.tip(angles).position);
}

/// Base point, joints and tip of a chain, base axes, where it leads to the platform. Allocates.
template <class Space>
std::vector<Vec<double, Space::dimension>> chain_points(
    const ChainLeg<Space>& leg, std::span<const double> angles,
    const typename Space::template Frame<double>& platform);

}  // namespace sinew::inline v1
