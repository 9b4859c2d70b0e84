#include "sinew/robot/robot.hpp"

#include <algorithm>
#include <utility>

#include "sinew/base/limits.hpp"
#include "sinew/robot/parallel.hpp"

namespace sinew::inline v0 {

struct Robot::Data {
  std::string name;
  std::variant<PlanarRobot, SpatialRobot> legs;
  Weight weight;
  bool geometry_inferred;
};

Robot::Robot(std::shared_ptr<const Data> data)
    : data_(std::move(data)),
      planar_(std::get_if<PlanarRobot>(&data_->legs)),
      spatial_(std::get_if<SpatialRobot>(&data_->legs)),
      rods_(spatial_ ? spatial_->rods : 0) {
  is_within_limits_ = with_legs(*this, [](const auto& legs) {
    return std::max(legs.total.row, legs.total.input) <= max_rows && legs.rods <= max_rods;
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

const std::string& Robot::name() const { return data_->name; }
const Weight& Robot::weight() const { return data_->weight; }
bool Robot::geometry_inferred() const { return data_->geometry_inferred; }

Robot Robot::under(const Weight& weight) const {
  Data data = *data_;
  data.weight = weight;
  return Robot(std::make_shared<const Data>(std::move(data)));
}

bool has_weight(const Robot& robot) {
  bool has = robot.weight().platform_mass > 0;
  for_each_rod(robot, [&](const RodLeg& leg, const LegPlace&, int) { has = has || leg.link.density > 0; });
  return has;
}

}  // namespace sinew::inline v0
