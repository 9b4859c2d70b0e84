#include "robot/rods/rod_work.hpp"

#include <algorithm>

#include "robot/rods/elastica_system.hpp"
#include "robot/rods/general_system.hpp"
#include "robot/rods/mechanism.hpp"
#include "robot/rods/tangent_system.hpp"

namespace sinew::inline v1 {

bool is_elastica(const Robot& robot) {
  const SpatialRobot* legs = robot.spatial();
  return legs && legs->rods > 0 && legs->rods == legs->leg_count() &&
         std::ranges::all_of(legs_of<RodLeg>(*legs).legs, &RodLeg::is_elastica);
}

std::unique_ptr<RodGroup> rod_group(const Robot& robot) {
  const SpatialRobot& legs = *robot.spatial();
  const std::vector<RodLeg> rods = legs_of<RodLeg>(legs).legs;
  if (is_elastica(robot)) return std::make_unique<Mechanism<ElasticaSystem>>(legs);
  std::unique_ptr<RodGroup> heavy;
  if (std::ranges::all_of(rods, &RodLeg::is_torque_free))
    heavy = std::make_unique<Mechanism<TangentSystem>>(legs);
  else
    heavy = std::make_unique<Mechanism<GeneralSystem>>(legs);
  heavy->set_gravity(robot.weight().gravity);
  return heavy;
}

}  // namespace sinew::inline v1
