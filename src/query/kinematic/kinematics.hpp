/// @file kinematics.hpp
/// Questions to robots whose legs bear no load, as they are read.
#pragma once
#include "query/handlers.hpp"

namespace sinew::inline v1 {

/// What is wanted of a configuration, with the fields of its words.
struct KinematicWants {
  Wants words;
  std::vector<double> twist;   ///< of `velocity`
  std::optional<Along> along;  ///< likewise
  int samples = 0;             ///< of `shape`
};

struct KinematicInverse {
  AskedPose at;
  Branch branch;
  std::vector<double> start;
  bool wants_all = false;
  KinematicWants wanted;
};
KinematicInverse read_kinematic_inverse(Context& context);

/// Of `velocity` and `shape`.
struct KinematicConfiguration {
  Configuration given;
  KinematicWants wanted;
};
KinematicConfiguration read_kinematic_configuration(Context& context);

void answer_kinematic_track(Context& context);

}  // namespace sinew::inline v1
