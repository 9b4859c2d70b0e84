/// @file legs_walk.hpp
/// Equilibria one after the other, as searches for tensions and wrenches ask for them.
#pragma once
#include <optional>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/search/search.hpp"

namespace sinew::inline v1 {

/// Equilibria that differ little: the first as asked, the others from the one before at its polynomials.
/// Where one is not found the workspace stays at the one before.
class LegsWalk {
 public:
  /// @param first how the first one ends
  LegsWalk(const ArmLegs& robot, const ArmOptions& options, ArmLegsWorkspace& work, LegsEnd first)
      : robot_(robot),
        options_(options),
        work_(work),
        first_(first) {}
  Report go(const LegsProblem& problem, bool from_last);
  void keep();        ///< what was found last
  void bring_back();  ///< what was kept, from where the workspace's question is then

 private:
  Report go_first(const LegsProblem& problem, bool from_last);

  const ArmLegs& robot_;
  ArmOptions options_;
  ArmLegsWorkspace& work_;
  LegsEnd first_;
  std::optional<LegsProblem> before_ = {};
  LimbState state_ = {};
  struct Kept {
    LegsProblem problem;
    LimbState state;
    int level;
    LegsBreaks breaks;
  };
  std::optional<Kept> kept_ = {};
};

}  // namespace sinew::inline v1
