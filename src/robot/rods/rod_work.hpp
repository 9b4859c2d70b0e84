/// @file rod_work.hpp
/// What a workspace keeps for a robot of rods.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "robot/limbs/limb_signs.hpp"
#include "robot/rods/rod_group.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

/// The rods of a robot that bears load, with the legs that close beside them: of the quickest kind that holds
/// for all of them.
std::unique_ptr<RodGroup> rod_group(const Robot& robot);

/// Whether all legs are rods that bend in one plane each.
bool is_elastica(const Robot& robot);

struct RodWork {
  explicit RodWork(std::unique_ptr<RodGroup> rods) : system(std::move(rods)) {}

  std::unique_ptr<RodGroup> system;
  LimbState home = system->state(), before = system->state(), spare = system->state();
  LimbPlaces<Spatial> places = places_of(*system);
  StopToken stop;           ///< that of the workspace
  bool knows_home = false;  ///< `home` is in equilibrium
  bool is_solved =
      false;  ///< `system` is in equilibrium, with factors found there or, after a quick warm answer, near by
  SmallLu<6> feeding;  ///< factors of what the inputs do to the wrench, of the last pose that was held
  bool knows_feeding = false;
  /// Of each rod, its tip held: counted once for an answer.
  std::vector<std::array<int, 2>> unstable_rods =
      std::vector<std::array<int, 2>>(static_cast<std::size_t>(system->limbs()));
  /// Of the state that `system` is in, and is linearised at, once they are counted.
  std::optional<LimbSigns> signs;
  bool holds_last = false;  ///< `system` is in the equilibrium that a session calls `last`
};

/// Those of a workspace, which stop as it does, for a question that may move them.
inline RodWork& rods_of(Workspace& work) {
  work.rods->stop = work.stop;
  work.rods->signs.reset();
  work.rods->holds_last = false;
  return *work.rods;
}

}  // namespace sinew::inline v1
