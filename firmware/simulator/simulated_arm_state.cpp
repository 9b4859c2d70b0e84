/// What a simulated arm says of itself.
#include <nlohmann/json.hpp>

#include "simulator/simulated_arm.hpp"

namespace sinew::firmware {

std::string SimulatedArm::state() const {
  using Json = nlohmann::ordered_json;
  Json bends = Json::array(), tensions = bends, paid = bends, counts = bends, cut = bends, stuck = bends;
  for (const Bend& bend : statics_.bends) bends.push_back({bend[0], bend[1]});
  for (std::size_t i = 0; i < tendon_count(); ++i) {
    tensions.push_back(tension(i));
    paid.push_back(paid_out(motors_[i]));
    if (statics_.tendons[i].is_cut) cut.push_back(i);
    if (motors_[i].is_stuck) stuck.push_back(i);
  }
  for (std::size_t i = 0; i < drive_count(); ++i) counts.push_back(count(i));
  return Json{{"bends", bends}, {"tensions", tensions}, {"paid_out", paid}, {"counts", counts},
              {"cut", cut},     {"stuck", stuck},       {"stage", stage()}}
      .dump();
}

}  // namespace sinew::firmware
