/// @file legs_work.hpp
/// What a workspace keeps for a platform on arms, and what an equilibrium is asked of. Theory:
/// docs/theory/arm_legs.md
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kinematics/arm_legs/group/arm_group.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {

struct ArmLegsWorkspace::Impl {
  std::shared_ptr<const char> robot;
  ArmModel model = ArmModel::subsegment_rod;
  int order = -2, elements = 0;
  LegsBreaks breaks;  ///< of all levels
  std::vector<std::unique_ptr<ArmGroup>> levels;
  int level = -1;  ///< of the last equilibrium; −1: none was
  ArmLegsState state;

  /// Whether there is an equilibrium to go on from.
  bool has_last() const {
    return level >= 0 && static_cast<std::size_t>(level) < levels.size() &&
           levels[static_cast<std::size_t>(level)] && state.report.ok();
  }
  ArmGroup& group() { return *levels[static_cast<std::size_t>(level)]; }
};

/// What an equilibrium is asked of.
struct LegsProblem {
  std::vector<TendonCommand> commands;
  ArmGroup::Wrench wrench = ArmGroup::Wrench::Zero();
  LegsLoads loads;
  std::optional<ArmGroup::Frame> prescribed_pose = {};  ///< of the platform, whatever wrench that takes

  LegsProblem(const ArmLegs& robot, std::span<const TendonCommand> tendons, const ArmLegsLoad& load);
};

/// Of the group, but for the report, `stable`, `resolution` and `reached`.
void write_legs_state(const ArmLegs& robot, const ArmGroup& group, ArmLegsState& state);

/// The longest leg [m].
double legs_size(const ArmLegs& robot);

}  // namespace sinew::inline v1
