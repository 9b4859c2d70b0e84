/// @file motion.hpp
/// Where set-points go next: towards a target, back along the recorded insertion, or on behind the tip, never
/// faster than the jog speed.
#pragma once
#include <optional>
#include <vector>

#include "arm.hpp"
#include "sinew/kinematics/trajectory.hpp"

namespace sinew::server::device {

/// Straight from the one to the other: stage and all bends in proportion.
Posture between(const Posture& from, const Posture& to, double share);

/// The way that the arm was inserted, by which it can be drawn back.
class Path {
 public:
  /// Further on; of a posture farther out than the last ones these are forgotten.
  void record(const Posture& posture);
  /// Of a posture on the way back: what lies behind it is forgotten.
  void rewind(const Posture& posture);
  void forget() { postures_.clear(); }
  bool is_empty() const { return postures_.empty(); }
  const Posture& last() const { return postures_.back(); }
  /// The last one is reached, and it is not where the way began.
  bool pop();
  std::size_t size() const { return postures_.size(); }

 private:
  std::vector<Posture> postures_;
};

class Motion {
 public:
  Motion(Arm& arm, double stage_limit) : arm_(arm), follower_(arm.robot()), stage_limit_(stage_limit) {}

  /// Where set-points are; what follows goes on from there.
  void begin(const Posture& posture, bool follows);
  const Posture& set() const { return set_; }

  /// The next set-points, with no tendon and no stage farther than `way` [m]. False: there is nothing left
  /// to go.
  bool go_to(const Posture& target, double way);
  bool go_back(Path& path, double way);
  bool advance(const Bends& lead, double way);

  /// What the drives do to get to a posture, at most [m].
  double distance(const Posture& a, const Posture& b);

 private:
  Arm& arm_;
  FollowTheLeader follower_;
  Posture set_;
  double stage_limit_;
};

}  // namespace sinew::server::device
