/// @file simulated_arm.hpp
/// A tendon-driven arm on a linear stage with its drives: motors of limited speed with encoders, backlash,
/// and tendons that can be cut or get stuck. Theory: docs/theory/simulated_arm.md
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulator/arm_statics.hpp"

namespace sinew::firmware {

struct ArmDrives {
  TendonMotor motor{.lead = 2e-3, .counts = 4096};  ///< of the tendons, and of the stage
  double speed = 0.03;                              ///< at which a tendon's goes at most [m/s],
  double stage_speed = 0.1;                         ///< and the stage's
  double backlash = 0.02e-3;                        ///< between motor and tendon [m]
  double min_slack = 0.5e-3, max_slack = 3e-3;      ///< with which tendons begin, at counts of 0 [m]
  unsigned seed = 1;                                ///< of which
};

class SimulatedArm {
 public:
  explicit SimulatedArm(const SerialRobot& robot, const ArmDrives& drives = {},
                        const ArmMaterial& material = {});

  std::size_t tendon_count() const { return statics_.tendons.size(); }
  std::size_t drive_count() const { return tendon_count() + 1; }

  /// So much later [s].
  /// @param setpoints [counts] of tendons and stage, which enabled drives follow
  void advance(double time, std::span<const std::int32_t> setpoints, bool are_enabled);

  std::int32_t count(std::size_t drive) const;  ///< of its encoder
  double tension(std::size_t tendon) const;     ///< at its motor [N]
  double stage() const;                         ///< [m]
  std::span<const Bend> bends() const { return statics_.bends; }

  /// @name Faults
  /// @{
  void cut(std::size_t tendon);
  void mend();  ///< all that are cut
  /// It moves no more where it enters the arm.
  void stick(std::size_t tendon);
  void free();  ///< all that are stuck
  /// @}

  /// The truth in one line of JSON, without a newline.
  std::string state() const;

  ArmStatics& statics() { return statics_; }

 private:
  struct Motor {
    double position = 0;  ///< [counts]
    double moved = 0;     ///< of the tendon, with the backlash [m]
    double slack = 0;     ///< where its count is 0 [m]
    bool is_stuck = false;
    double stuck_at = 0;  ///< paid out where it enters the arm [m]
  };
  bool drive(Motor& motor, double setpoint, double way) const;
  double paid_out(const Motor& motor) const { return motor.slack + motor.moved; }
  void pull(std::size_t tendon);

  ArmStatics statics_;
  ArmDrives drives_;
  std::vector<Motor> motors_;
  bool is_settled_ = false;
};

}  // namespace sinew::firmware
