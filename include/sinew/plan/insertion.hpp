/// @file insertion.hpp
/// A way in: stage and bends of a serial robot, step by step, from outside to where its tip is to get; and
/// whether it touches anything on it, found by FCL independently of the search: distances of every step, and
/// a proof for what lies between. Theory: docs/theory/insertion.md
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/kinematics/trajectory.hpp"
#include "sinew/plan/scene.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// A posture on the way in, with what is nearest to the robot.
struct InsertionStep : SerialPosture {
  double clearance = 0;         ///< least distance between robot and solids [m]; < 0: they overlap
  int solid = -1;               ///< where it is; −1: none is near
  Vec3<double> place{0, 0, 0};  ///< point of the backbone there [m]
};

/// More steps on the curves through these: by the stage, shape-preserving (Fritsch, Butland), so that no bend
/// leaves the interval of its neighbours. The given steps are among them.
/// @param max_stage between two of the answer [m], > 0
SINEW_API std::vector<InsertionStep> interpolated(std::span<const InsertionStep> steps, double max_stage);

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

/// What keeps a robot from a way in, where none was found.
struct Blocked {
  std::string solid;            ///< its name; empty: it is not a solid that is in the way
  Vec3<double> place{0, 0, 0};  ///< point of the backbone [m]
  double stage = 0;             ///< there [m]
  double missing = 0;           ///< clearance that the best attempt lacks there [m]
};

/// How far a search is.
struct InsertionProgress {
  std::string_view phase;  ///< `final pose`, `way out`, `smoothing`, `check`
  double share = 0;        ///< share of this phase that is done, 0 to 1
};

/// Bounds of a search.
struct InsertionOptions {
  std::uint64_t seed = 1;  ///< one seed, one answer
  int starts = 960;        ///< of the search for the final pose, at most
  double step = 1e-3;      ///< of the stage in the search, at most; the answer has two for one [m]
  double time_limit = 60;  ///< [s]; the answer is `stopped` after it
  unsigned threads = 0;    ///< 0: as many as there are
  std::function<void(const InsertionProgress&)> progress;
  StopToken stop;
};

/// A way in, checked, or why there is none.
struct InsertionPlan {
  /// `converged`; `unreachable`: no final pose or no way to it was found, `blocked` says why; `stopped`.
  Report report;
  std::vector<InsertionStep> steps;  ///< from stage 0 on; empty without a way
  InsertionCheck check;              ///< of these steps
  Blocked blocked;
  double tip_error = 0;      ///< at the end [m]
  int starts = 0, ways = 0;  ///< final poses tried, and ways out of them
  double seconds = 0;        ///< that it took [s]
};

/// Searches a way in and checks it; lengths in m, in scene axes. One scene and one seed have one answer,
/// where the time limit does not end the search.
SINEW_API InsertionPlan plan_insertion(const InsertionScene& scene, const InsertionOptions& options = {});

}  // namespace sinew::inline v1
