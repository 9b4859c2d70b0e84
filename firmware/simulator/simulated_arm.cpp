#include "simulator/simulated_arm.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace sinew::firmware {

SimulatedArm::SimulatedArm(const SerialRobot& robot, const ArmDrives& drives, const ArmMaterial& material)
    : statics_(robot, material),
      drives_(drives),
      motors_(drive_count()) {
  std::mt19937 random(drives.seed);
  for (std::size_t i = 0; i < tendon_count(); ++i) {
    // By hand: the library's distributions differ from machine to machine.
    const double share = static_cast<double>(random() % 65536) / 65536;
    motors_[i].slack = drives.min_slack + share * (drives.max_slack - drives.min_slack);
    pull(i);
  }
}

/// Towards its setpoint, so far at most [m]. Whether it moves.
bool SimulatedArm::drive(Motor& motor, double setpoint, double way) const {
  const double scale = drives_.motor.counts_per_length(), most = way * scale;
  const double step = std::clamp(setpoint - motor.position, -most, most);
  if (step == 0) return false;
  motor.position += step;
  const double at = motor.position / scale, half = 0.5 * drives_.backlash;
  motor.moved = std::clamp(motor.moved, at - half, at + half);
  return true;
}

/// What the statics know of a tendon, from its motor or from where it is stuck.
void SimulatedArm::pull(std::size_t i) {
  const Motor& motor = motors_[i];
  Tendon& tendon = statics_.tendons[i];
  const double inner = statics_.inner_stiffness(i), outer = statics_.outer_stiffness(i);
  tendon.stiffness = motor.is_stuck ? inner : inner * outer / (inner + outer);
  tendon.paid_out = motor.is_stuck ? motor.stuck_at : paid_out(motor);
  is_settled_ = false;
}

void SimulatedArm::advance(double time, std::span<const std::int32_t> setpoints, bool are_enabled) {
  for (std::size_t i = 0; are_enabled && i < motors_.size(); ++i) {
    const bool is_stage = i == tendon_count();
    const double way = time * (is_stage ? drives_.stage_speed : drives_.speed);
    if (drive(motors_[i], setpoints[i], way) && !is_stage) pull(i);
  }
  if (!is_settled_) is_settled_ = !statics_.settle();
}

std::int32_t SimulatedArm::count(std::size_t drive) const {
  return static_cast<std::int32_t>(std::lround(motors_[drive].position));
}

double SimulatedArm::tension(std::size_t i) const {
  const Motor& motor = motors_[i];
  if (statics_.tendons[i].is_cut) return 0;
  if (motor.is_stuck) return statics_.outer_stiffness(i) * std::max(motor.stuck_at - paid_out(motor), 0.0);
  return statics_.tendons[i].tension;
}

double SimulatedArm::stage() const { return motors_.back().position / drives_.motor.counts_per_length(); }

void SimulatedArm::cut(std::size_t tendon) {
  statics_.tendons[tendon].is_cut = true;
  is_settled_ = false;
}
void SimulatedArm::mend() {
  for (Tendon& tendon : statics_.tendons) tendon.is_cut = false;
  is_settled_ = false;
}
void SimulatedArm::stick(std::size_t tendon) {
  Motor& motor = motors_[tendon];
  if (motor.is_stuck) return;
  // Its tension has stretched what is outside the arm by as much.
  motor.stuck_at = paid_out(motor) + tension(tendon) / statics_.outer_stiffness(tendon);
  motor.is_stuck = true;
  pull(tendon);
}
void SimulatedArm::free() {
  for (std::size_t i = 0; i < tendon_count(); ++i) {
    motors_[i].is_stuck = false;
    pull(i);
  }
}

}  // namespace sinew::firmware
