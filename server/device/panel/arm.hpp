/// @file arm.hpp
/// The robot as the panel needs it: what its controller's integers mean, what bends ask of the drives, where
/// the tip is.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "robot/controller.hpp"
#include "server/device/wire/frames.hpp"
#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::server::device {

using Bends = std::vector<Bend>;

/// Where the arm is or shall be.
struct Posture {
  Bends bends;
  double stage = 0;  ///< [m]
};

class Arm {
 public:
  /// Errors: those of the file; `not_serial`, `no_motor`; those of a controller's table.
  /// @param stage_motor by which the stage counts; none: as the tendons do
  static Expected<Arm> read(const Document& document, const std::optional<TendonMotor>& stage_motor = {});

  const SerialRobot& robot() const { return robot_; }
  std::size_t sections() const { return robot_.sections.size(); }
  std::size_t tendons() const { return static_cast<std::size_t>(robot_.sections[0].tendons); }
  std::size_t tendon_drives() const { return sections() * tendons(); }

  /// Takes the model by which this controller drives. False where it has another robot's table.
  bool fits(const Hello& hello);
  kernel::Model model() const { return model_; }

  std::vector<double> changes(std::span<const Bend> bends);                 ///< of the tendons [m]
  std::vector<double> lengths(std::span<const std::int32_t> counts) const;  ///< [m] of tendons and stage
  /// What drives have to count there, to a few counts: the controller rounds twice.
  std::vector<std::int32_t> counts(const Posture& posture, bool has_stage);
  std::int32_t tendon_counts(double length) const;
  double tendon_length(std::int32_t count) const { return count / counts_per_metre_; }
  double stage_length(std::int32_t count) const { return count / stage_counts_per_metre_; }
  std::int32_t stage_counts(double length) const;
  /// As a controller has them, within its limits.
  std::vector<std::int16_t> raw(std::span<const Bend> bends, const Hello& hello) const;
  Bends bends(std::span<const std::int16_t> raw, const Hello& hello) const;
  bool is_within_limits(std::span<const Bend> bends) const;
  Vec3<double> tip(std::span<const Bend> bends);

 private:
  Arm(SerialRobot robot, ControllerTable linear, ControllerTable exact, double stage_counts_per_metre);

  SerialRobot robot_;
  SerialWorkspace work_;
  ControllerTable linear_, exact_;
  kernel::Model model_ = kernel::Model::linear;
  double counts_per_metre_, stage_counts_per_metre_;
};

}  // namespace sinew::server::device
