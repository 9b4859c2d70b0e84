/// @file chain_robots.hpp
/// Robots on pseudo-rigid chains for tests, and where their rest at a pose begins.
#pragma once
#include <gtest/gtest.h>

#include "kinematics/chains/chain.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {

template <class Space>
struct ChainsAt {
  ChainLegs<Space> robot;
  typename Space::Pose pose;
  std::vector<double> curvature;  ///< of the arcs there
};

/// Of a robot of the library without motors at its bases.
template <class Space>
ChainsAt<Space> chains_at(const char* name, PrbDiscretisation model, const typename Space::Pose& pose) {
  const Robot any = *load(name);
  Workspace memory(any);
  const Inverse arcs = inverse(any, pose, {}, memory);
  EXPECT_TRUE(arcs.ok());
  return {chains_of<Space>(*any.as(Model::prb, model)),
          pose,
          {arcs.coordinates.begin(), arcs.coordinates.begin() + Space::dof}};
}

/// A pose that the 6-UFS reaches.
inline SpatialPose reached_by_6_ufs() {
  SpatialPose pose;
  pose.position = {0.01, 0, 0.18};
  return pose;
}

inline bool is_equilibrium(const Report& report) { return report.ok() || report.status == Status::slack; }

}  // namespace sinew::test
