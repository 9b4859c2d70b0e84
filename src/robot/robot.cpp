#include "sinew/robot/robot.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/limits.hpp"
#include "robot/arms/arm_sections.hpp"
#include "robot/arms/arm_weight.hpp"
#include "robot/make_chains.hpp"
#include "sinew/robot/arm.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "sinew/robot/assembly.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

struct Robot::Data {
  std::string name;
  AnyLegs legs;
  Weight weight;
  bool geometry_inferred;
  std::optional<SerialRobot> sections = {};
  std::optional<Arm> arm = {};
  std::optional<ArmLegs> arm_legs = {};
  /// By the model prb: chains in place of the arcs, and the robot on these.
  std::optional<AnyChains> chains = {};
  PrbDiscretisation discretisation = {};
  std::shared_ptr<const Data> arcs = {};
};

Robot::Robot(std::shared_ptr<const Data> data)
    : data_(std::move(data)),
      planar_(std::get_if<PlanarRobot>(&data_->legs)),
      spatial_(std::get_if<SpatialRobot>(&data_->legs)),
      serial_(data_->sections ? &*data_->sections : nullptr),
      arm_(data_->arm ? &*data_->arm : nullptr),
      arm_legs_(data_->arm_legs ? &*data_->arm_legs : nullptr),
      rods_(spatial_ ? spatial_->rods : 0) {
  model_ = data_->chains                    ? Model::prb
           : rods_ > 0 || arm_ || arm_legs_ ? Model::rod
           : serial_ || has_arc(*this)      ? Model::cc
                                            : Model::rigid;
  is_within_limits_ = with_legs(*this, [](const auto& legs) {
    int feeds = legs.rods;  // beside rods a tied leg is fed, too
    legs.for_each_closing_leg([&]<class L>(const L&, const LegPlace&, int) { feeds += L::inputs; });
    return std::max(legs.total.row, legs.total.input) <= max_rows && (legs.rods == 0 || feeds <= max_rods);
  });
}

Robot::Robot() : Robot(std::string(), PlanarRobot()) {}
Robot::Robot(std::string name, PlanarRobot legs, bool geometry_inferred)
    : Robot(
          std::make_shared<const Data>(Data{std::move(name), std::move(legs), Weight{}, geometry_inferred})) {
}
Robot::Robot(std::string name, SpatialRobot legs, const Weight& weight, bool geometry_inferred)
    : Robot(std::make_shared<const Data>(Data{std::move(name), std::move(legs), weight, geometry_inferred})) {
}

Robot::Robot(SerialRobot sections)
    : Robot([&] {
        Data data{sections.name, SpatialRobot(), Weight{}, sections.geometry_inferred};
        data.sections = std::move(sections);
        return std::make_shared<const Data>(std::move(data));
      }()) {}

Robot::Robot(Arm arm)
    : Robot([&] {
        const auto& [x, y, z] = arm.gravity;
        Data data{arm.name, SpatialRobot(), Weight{.gravity = {x, y, z}}, arm.geometry_inferred};
        data.arm = std::move(arm);
        return std::make_shared<const Data>(std::move(data));
      }()) {}

Robot::Robot(ArmLegs legs)
    : Robot([&] {
        const auto& [x, y, z] = legs.gravity;
        Data data{legs.name, SpatialRobot(),
                  Weight{.gravity = {x, y, z}, .platform_mass = legs.platform_mass}, legs.geometry_inferred};
        data.arm_legs = std::move(legs);
        return std::make_shared<const Data>(std::move(data));
      }()) {}

const std::string& Robot::name() const { return data_->name; }
const Weight& Robot::weight() const { return data_->weight; }
bool Robot::geometry_inferred() const { return data_->geometry_inferred; }

Robot Robot::under(const Weight& weight) const {
  Data data = *data_;
  data.weight = weight;
  if (data.arm) {
    data.arm->gravity = {weight.gravity.x(), weight.gravity.y(), weight.gravity.z()};
    data.arm->identity = std::make_shared<const char>();
  }
  if (data.arm_legs) {
    data.arm_legs->gravity = {weight.gravity.x(), weight.gravity.y(), weight.gravity.z()};
    data.arm_legs->platform_mass = weight.platform_mass;
    data.arm_legs->identity = std::make_shared<const char>();
  }
  return Robot(std::make_shared<const Data>(std::move(data)));
}

std::string_view to_string(Model model) noexcept {
  constexpr std::string_view names[] = {"cc", "prb", "rod", "rigid"};
  return names[static_cast<std::size_t>(model)];
}

Expected<Robot> Robot::as(Model wanted, PrbDiscretisation discretisation) const {
  if (wanted == model_ && (wanted != Model::prb || discretisation == data_->discretisation)) return *this;
  if (arm_ && wanted == Model::cc)
    return constant_curvature_sections(*arm_).map(
        [](SerialRobot sections) { return Robot(std::move(sections)); });
  const std::shared_ptr<const Data>& own = data_->arcs ? data_->arcs : data_;
  if (data_->arcs && wanted == Model::cc) return Robot(own);
  if (wanted != Model::prb)
    return failure(
        "not_available", "model",
        fmt::format("the model of this robot is {}{}; its links have no model {}.",
                    to_string(Robot(own).model()), has_arc(*this) ? ", or prb" : "", to_string(wanted)));
  if (rods_ > 0)
    return failure("not_available", "legs",
                   "the legs are rods, which have a model of their own: leave model out.");
  auto chains = make_chains(own->legs, discretisation);
  if (!chains) return tl::unexpected(std::move(chains.error()));
  Data data = *own;
  data.chains = std::move(*chains);
  data.discretisation = discretisation;
  data.arcs = own;
  return Robot(std::make_shared<const Data>(std::move(data)));
}

const ChainLegs<Planar>* Robot::planar_chains() const {
  return data_->chains ? std::get_if<ChainLegs<Planar>>(&*data_->chains) : nullptr;
}
const ChainLegs<Spatial>* Robot::spatial_chains() const {
  return data_->chains ? std::get_if<ChainLegs<Spatial>>(&*data_->chains) : nullptr;
}

bool has_weight(const Robot& robot) {
  bool has = robot.weight().platform_mass > 0;
  if (const Arm* arm = robot.arm()) has = has_weight(*arm);
  if (const ArmLegs* legs = robot.arm_legs()) has = has || has_weight(*legs);
  for_each_rod(robot, [&](const RodLeg& leg, const LegPlace&, int) { has = has || leg.link.density > 0; });
  return has;
}

}  // namespace sinew::inline v1
