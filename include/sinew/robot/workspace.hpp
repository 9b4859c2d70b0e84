/// @file workspace.hpp
/// All memory a solve needs, taken once. Answers are views into it and hold until its next use.
/// One workspace a thread; the robot itself is shared.
#pragma once
#include <memory>
#include <vector>

#include "sinew/base/stop.hpp"
#include "sinew/leg/state.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

struct RodWork;
struct SerialWorkspace;

/// Memory of solvers for chains, one per thread. Sized on first use with a robot; then nothing allocates.
struct ChainWork {
  StopToken stop = {};  ///< solves that use it end with `stopped` once it is requested
  std::shared_ptr<void> planar = {}, spatial = {};  ///< the solvers' own; a copy of it is for the same thread
};

struct Workspace {
  /// Most solutions of one leg that are kept; an arc within a full turn either way has fewer.
  static constexpr int max_solutions = 8;

  SINEW_API explicit Workspace(const Robot& robot);
  SINEW_API ~Workspace();
  SINEW_API Workspace(Workspace&&) noexcept;
  SINEW_API Workspace& operator=(Workspace&&) noexcept;

  std::shared_ptr<const void> robot;  ///< identity of the robot it is for, and of that robot's copies
  StopToken stop;  ///< solves that use this workspace end with `stopped` once it is requested
  std::vector<double> coordinates;  ///< link coordinates, leg by leg
  std::vector<double> inputs;
  std::vector<double> J, K, U, s;      ///< row-major: rows × dof, rows × inputs, dof × inputs, rows
  std::vector<double> unit_J, unit_K;  ///< J and K with rows scaled to unit lines
  std::vector<double> rates;           ///< inputs
  std::vector<double> solutions;       ///< of each leg max_solutions times its inputs
  std::vector<int> solution_count;     ///< a leg; 1 for a leg whose inputs are another's
  std::vector<int> type_1;             ///< legs
  std::vector<LegState> legs;
  std::unique_ptr<RodWork> rods;            ///< of a robot on rods; else null
  std::unique_ptr<SerialWorkspace> serial;  ///< of a serial robot; else null
  ChainWork chains;                         ///< of a robot by the model prb
  /// Of a robot by the model prb: that of the same on arcs, near which searches for its chains begin; else
  /// null.
  std::unique_ptr<Workspace> arcs;
};

}  // namespace sinew::inline v1
