/// @file insertion.hpp
/// A way in: stage and bends of a serial robot, step by step, from outside to where its tip is to get.
/// Theory: docs/theory/insertion.md
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sinew/base/stop.hpp"
#include "sinew/plan/check.hpp"
#include "sinew/plan/scene.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

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
