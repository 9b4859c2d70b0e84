/// @file report.hpp
/// What a solver says of its answer. A solver that does not converge is an answer, never an exception.
#pragma once
#include <string>
#include <string_view>

#include "sinew/base/export.hpp"
#include "sinew/base/fixed_text.hpp"

namespace sinew::inline v1 {

/// How a solve ended. Of the first eight the first that holds is reported. The numbers stand in result files:
/// new statuses are appended.
enum class Status {
  unreachable = 0,  ///< no solution exists; the message names what cannot be met
  left_domain,      ///< an input or iterate lies outside the model's domain
  slack,            ///< a tendon would have to push
  singular,         ///< the linear system has no unique answer here
  stalled,          ///< no step lowers the residual any more, and it is not zero
  iteration_limit,  ///< the bound on iterations was met
  unstable,         ///< an equilibrium that does not hold by itself
  converged,
  stopped = 8,  ///< the caller asked it to stop (StopToken); the best iterate so far is returned
  bad_input =
      9,  ///< the arguments do not fit the robot, e.g. a planar pose and a spatial robot; nothing was solved
  unsupported = 10,  ///< this question is not for this kind of robot, or not for this model of its links
};

/// Its name: `iteration_limit`.
SINEW_API std::string_view to_string(Status status) noexcept;

/// Status with its evidence. `residual` is that of the best iterate, which is always handed back.
struct Report {
  Status status = Status::converged;
  int iterations = 0;
  double residual =
      0;  ///< largest closure error of a leg [m]; of rods, chains and arms an error over their size, no unit
  FixedText<240> message;  ///< why not converged, in words; empty otherwise

  /// Solved; of loaded robots also stable, where that was asked.
  bool ok() const noexcept { return status == Status::converged; }
  /// Of loaded robots: whether there is an equilibrium, which may be unstable.
  bool is_solved() const noexcept { return ok() || status == Status::unstable; }
};

/// One line: `converged in 4 iterations, residual 5e-14`.
SINEW_API std::string to_string(const Report& report);

/// One iterate of a solver, recorded on request.
struct TraceStep {
  int iteration;
  double residual;  ///< largest closure error [m]
  double step;      ///< fraction of the Newton step taken to get here; 0 for the start
};

}  // namespace sinew::inline v1
