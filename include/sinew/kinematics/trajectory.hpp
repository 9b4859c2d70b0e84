/// @file trajectory.hpp
/// When a serial robot on a linear stage is where: the quickest motion along given postures within limits of
/// speed and acceleration; and follow-the-leader, by which its body stays on the curve that its tip draws.
/// Theory: docs/theory/trajectory.md
#pragma once
#include <deque>
#include <span>
#include <vector>

#include "sinew/robot/serial.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Where a serial robot on a linear stage is.
struct SerialPosture {
  double stage = 0;         ///< how far the base was moved [m]
  std::vector<Bend> bends;  ///< of every section [rad]
};

/// Of every coordinate alike; all > 0.
struct TrajectoryLimits {
  double stage_speed = 5e-3;           ///< [m/s]
  double stage_acceleration = 25e-3;   ///< [m/s²]
  double bend_speed = 0.5;             ///< of each of a section's two bends [rad/s]
  double bend_acceleration = 2;        ///< [rad/s²]
  double tendon_speed = 10e-3;         ///< of each tendon, exact PCC [m/s]
  double tendon_acceleration = 50e-3;  ///< [m/s²]
};

/// Where everything is at a time, and how it moves.
struct TrajectoryPoint {
  double time = 0;  ///< [s]
  SerialPosture posture;
  double stage_speed = 0;                ///< [m/s]
  double stage_acceleration = 0;         ///< [m/s²]
  std::vector<Bend> bend_speeds;         ///< of every section [rad/s]
  std::vector<Bend> bend_accelerations;  ///< of every section [rad/s²]
};

/// A motion from rest to rest.
struct Trajectory {
  /// `converged`; `bad_input`; `left_domain`: a posture, or the way to it, is beyond the robot's limits, or
  /// the stage below 0; the message says which.
  Report report;
  std::vector<TrajectoryPoint> points;  ///< from rest at time 0 to rest at `duration`, evenly but the last
  double duration = 0;                  ///< [s]
  TrajectoryLimits greatest{0, 0, 0, 0, 0, 0};  ///< speeds and accelerations that it reaches
};

/// The quickest motion from rest at the first posture to rest at the last, on a smooth curve that passes all
/// and on which no coordinate leaves the interval of its neighbours (`ShapePreservingCurve`). Postures that
/// repeat the one before are left out. Extensible sections stay at rest length.
/// @param period between points [s], > 0
SINEW_API Trajectory time_optimal_trajectory(const SerialRobot& robot,
                                             std::span<const SerialPosture> postures,
                                             const TrajectoryLimits& limits, double period);

/// Most points that a trajectory may have.
inline constexpr std::size_t trajectory_point_limit = 1'000'000;

/// Follow-the-leader: a serial robot on a stage advances along the curve that its tip draws.
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
