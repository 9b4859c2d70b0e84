/// @file follow_the_leader.hpp
/// Follow-the-leader: a serial robot on a stage advances along the curve that its tip draws.
#pragma once
#include <deque>
#include <span>
#include <vector>

#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// The curve is kept as bend per length; a section takes the mean of what it lies on. The base moves on a
/// straight line, so the body stays on the curve as far as the curve began straight; where the robot was bent
/// at its base, it leaves it there. Extensible sections stay at rest length.
class SINEW_API FollowTheLeader {
 public:
  /// Without a curve: `begin` comes before `advance`.
  explicit FollowTheLeader(const SerialRobot& robot);

  /// The curve is where the robot is.
  /// @param bends of every section [rad]
  void begin(std::span<const Bend> bends);
  /// Bends of every section [rad] once the stage is further by `way` [m], >= 0.
  /// @param leader bend of the last section, which the new end of the curve has [rad]
  std::vector<Bend> advance(double way, const Bend& leader);

 private:
  struct Piece {
    double end;         ///< [m] from the base
    Vec2<double> bend;  ///< per length [rad/m]
  };
  Vec2<double> mean(double from, double to) const;

  std::vector<double> ends_;    ///< of the sections, from the base [m]
  std::vector<double> shares_;  ///< bend of a section where the curve bends by 1 rad/m
  std::deque<Piece> curve_;     ///< from the base to the tip
};

}  // namespace sinew::inline v1
