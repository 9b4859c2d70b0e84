/// @file check.hpp
/// Whether a robot that goes in along given steps touches anything, found by FCL independently of the search:
/// distances of every step, and a proof for what lies between. Theory: docs/theory/insertion.md
#pragma once
#include <chrono>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/stop.hpp"
#include "sinew/plan/scene.hpp"
#include "sinew/plan/steps.hpp"

namespace sinew::inline v1 {

/// Whether a robot touches anything.
enum class InsertionVerdict {
  clear = 0,      ///< also where the robot is as far off as it may be
  clear_if_taut,  ///< as planned, but not where it is as far off as it may be
  touches         ///< as planned, or the proof failed
};

/// Its name: `clear_if_taut`.
SINEW_API std::string_view to_string(InsertionVerdict verdict) noexcept;

/// Where robot and solids are nearest.
struct TightSpot {
  double distance = 0;             ///< [m], < 0: they overlap
  int section = -1;                ///< of the robot
  int solid = -1, triangle = -1;   ///< of the scene; −1: none is within reach
  Vec3<double> on_robot{0, 0, 0};  ///< point of the backbone [m]
  Vec3<double> on_solid{0, 0, 0};  ///< [m]
};

/// A step, with where it is tightest.
struct CheckedStep {
  double stage = 0;  ///< [m]
  TightSpot spot;
  InsertionVerdict verdict = InsertionVerdict::touches;
};

/// How far the tip may be off, at most [m].
struct InsertionOff {
  double tendons = 0;  ///< what their tolerance leaves free, and what tension stretches them by
  double sag = 0;      ///< by the robot's weight
  double model = 0;    ///< what its kinematics are off
  double sum() const { return tendons + sag + model; }  ///< all of them
};

/// The verdict on a way in, with its evidence.
struct InsertionCheck {
  InsertionVerdict verdict = InsertionVerdict::touches;
  std::vector<CheckedStep> steps;  ///< as many as were asked about
  double clearance = 0;            ///< least of them [m]
  std::size_t worst = 0;           ///< step that has it
  /// Where it is clear only if taut: it would be clear where all of `off` was this share of it.
  double allowed_share = 1;
  InsertionOff off;
  std::size_t poses = 0;    ///< looked at for the proof
  bool is_stopped = false;  ///< not all was looked at
};

/// Bounds of a check.
struct InsertionCheckOptions {
  double reach = 10e-3;      ///< distances beyond this are not told apart [m]
  double min_motion = 1e-6;  ///< the proof gives up where steps move the robot by less [m]
  unsigned threads = 0;
  StopToken stop;
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
};

/// @param steps as planned, or of a file, each of as many bends as the robot has sections, finite; else
/// `touches`, without steps
SINEW_API InsertionCheck check_insertion(const InsertionScene& scene, std::span<const InsertionStep> steps,
                                         const InsertionCheckOptions& options = {});

/// Which limit a step exceeds, of a bend or of the stage, in words; empty: none.
SINEW_API std::string exceeded_limit(const InsertionScene& scene, const InsertionStep& step);

}  // namespace sinew::inline v1
