/// @file planar_robots.hpp
/// Robots for tests, built in C++ as a user would build them.
#pragma once
#include "robot/parallel.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {

inline std::vector<double> values(std::span<const double> view) { return {view.begin(), view.end()}; }

using RfrLeg = Leg<Planar, Arc, TendonPair, Chord>;
using FrrLeg = Leg<Planar, Arc, TendonPair, Strut>;
using RfrrLeg = Leg<Planar, Swivel<Arc>, SwivelDrive, Strut>;

/// Legs of a 3-RFR of the paper's sizes, without a file.
inline std::vector<RfrLeg> rfr_legs() {
  std::vector<RfrLeg> legs;
  for (int i = 0; i < 3; ++i) {
    const double foot = (90 + 120 * i) * std::numbers::pi / 180,
                 head = (30 + 120 * i) * std::numbers::pi / 180;
    RfrLeg leg{};
    leg.base = SE2<double>::from(0.19 * std::cos(foot), 0.19 * std::sin(foot), 0.0);
    leg.link = {.length = 0.2};
    leg.drive = {.offset = 0.005};
    leg.platform_point = Vec2<double>(0.05 * std::cos(head), 0.05 * std::sin(head));
    legs.push_back(leg);
  }
  return legs;
}

inline Robot rfr_in_code(std::span<const int> tied = {}) {
  return {"3-RFR in code", ParallelRobot<RfrLeg>(rfr_legs(), {}, 0.05, tied)};
}

}  // namespace sinew::test
