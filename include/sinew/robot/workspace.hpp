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

class ArmLegsWorkspace;
class ArmWorkspace;
struct RodWork;
struct SerialWorkspace;

/// Memory of solvers for chains, one per thread. Sized on first use with a robot; then nothing allocates.
struct ChainWork {
  StopToken stop = {};  ///< solves that use it end with `stopped` once it is requested
  std::shared_ptr<void> planar = {}, spatial = {};  ///< the solvers' own; a copy of it is for the same thread
};

/// Memory for questions to one robot and its copies; answers are views into it. Not for two threads at once.
struct Workspace {
  /// Most solutions of one leg that are kept; an arc within a full turn either way has fewer.
  static constexpr int max_solutions = 8;

  /// Allocates all that solves of this robot need.
  SINEW_API explicit Workspace(const Robot& robot);
  SINEW_API ~Workspace();
  SINEW_API Workspace(Workspace&&) noexcept;
  SINEW_API Workspace& operator=(Workspace&&) noexcept;

  std::shared_ptr<const void> robot;  ///< identity of the robot it is for, and of that robot's copies
  StopToken stop;  ///< solves that use this workspace end with `stopped` once it is requested
  std::vector<double> coordinates;  ///< of the links, leg by leg [1/m], [rad], [m]
  std::vector<double> inputs;       ///< in leg order [m], [rad]
  std::vector<double> J;            ///< rows × dof, rows first, as all of these; units: `Reduced`
  std::vector<double> K;            ///< rows × inputs; units: `Reduced`
  std::vector<double> U;            ///< dof × inputs [m or rad per unit of input]
  std::vector<double> s;            ///< rows; units: `Reduced`
  std::vector<double> unit_J;       ///< J with rows scaled to unit lines, moments over the platform radius
  std::vector<double> unit_K;       ///< K scaled alike: units of J are gone
  std::vector<double> rates;        ///< of the inputs [m/s], [rad/s]
  std::vector<double> solutions;    ///< of each leg max_solutions times its inputs
  std::vector<int> solution_count;  ///< a leg; 1 for a leg whose inputs are another's
  std::vector<int> type_1;          ///< legs
  std::vector<LegState> legs;
  std::unique_ptr<RodWork> rods;               ///< of a robot on rods; else null
  std::unique_ptr<SerialWorkspace> serial;     ///< of a serial robot; else null
  std::unique_ptr<ArmWorkspace> arm;           ///< of an arm; else null
  std::unique_ptr<ArmLegsWorkspace> arm_legs;  ///< of a platform on arms; else null
  ChainWork chains;                            ///< of a robot by the model prb
  /// Of a robot by the model prb: that of the same on arcs, near which searches for its chains begin; else
  /// null.
  std::unique_ptr<Workspace> arcs;
};

}  // namespace sinew::inline v1
