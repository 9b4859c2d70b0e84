/// @file example51_chains.hpp
/// The example of TDPCR section 5.1 on pseudo-rigid chains: n = 6 links, even springs, joints moved by the
/// least norm from the evenly bent first pose.
#pragma once
#include <vector>

#include "analysis/chain_velocity.hpp"
#include "sinew/base/error.hpp"
#include "study/tdpcr/example51.hpp"

namespace sinew::inline v1::example51 {

struct ChainSample {
  double eta;
  PlanarPose pose;
  std::vector<ChainLegState> legs;
  ChainVelocity<Planar> velocity;
};

Expected<ChainLegs<Planar>> chains(const Robot& robot);

/// Bent evenly towards positive curvature.
Expected<std::vector<ChainLegState>> evenly_bent(const ChainLegs<Planar>& robot, const PlanarPose& pose);

/// η = k/59 for k = 0 … 59. @param rk4_steps between poses; 0: the flow itself
Expected<std::vector<ChainSample>> trajectory(ChainLegs<Planar> robot, int rk4_steps);

/// At η < 1, by the flow from the first pose.
Expected<ChainSample> sample(ChainLegs<Planar> robot, double eta);

/// Limits of index·(π/3 − φ) for the drive |gᵢ| of the last pose's joints in place of tendons.
Rates rates(const Sample& last, const ChainSample& chains);

}  // namespace sinew::inline v1::example51
