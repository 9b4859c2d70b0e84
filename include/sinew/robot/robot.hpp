/// @file robot.hpp
/// A robot: what files load to and what every question is put to. What it is made of is in
/// robot/parallel.hpp, robot/chains.hpp, robot/serial.hpp and robot/arm.hpp; who only asks needs none of it.
#pragma once
#include <memory>
#include <string>
#include <variant>

#include "sinew/base/error.hpp"
#include "sinew/base/export.hpp"
#include "sinew/link/prb_discretisation.hpp"
#include "sinew/math/se2.hpp"
#include "sinew/math/se3.hpp"

namespace sinew::inline v1 {

/// Legs of one kind and a platform: robot/parallel.hpp.
template <class LegT>
struct ParallelRobot;
struct PlanarRobot;
struct SpatialRobot;
struct SerialRobot;
struct Arm;
struct ArmLegs;
/// Legs as chains of rigid links: robot/chains.hpp.
template <class Space>
struct ChainLegs;
struct Planar;
struct Spatial;

/// A pose of the robot's space.
using AnyPose = std::variant<PlanarPose, SpatialPose>;

/// What weighs on a robot whose legs bear load.
struct Weight {
  Vec3<double> gravity = Vec3<double>::Zero();  ///< [m/s²], base axes
  double platform_mass = 0;                     ///< at the platform's reference point [kg]
};

/// What a robot's links are taken for.
enum class Model {
  cc,   ///< of constant curvature
  prb,  ///< pseudo-rigid bodies: chains of rigid links with springs between them, in place of the arcs of cc
  rod,  ///< elastic rods
  rigid,  ///< without elastic links
};
SINEW_API std::string_view to_string(Model model) noexcept;  ///< `cc`, `prb`, `rod`, `rigid`

/// Constant once built and shared between threads; a copy is the same robot. All memory that changes is in a
/// Workspace.
class Robot {
 public:
  SINEW_API Robot();  ///< in the plane, without legs
  /// @param geometry_inferred the source does not print the geometry; it was inferred from its results
  SINEW_API Robot(std::string name, PlanarRobot legs, bool geometry_inferred = false);
  SINEW_API Robot(std::string name, SpatialRobot legs, const Weight& weight = {},
                  bool geometry_inferred = false);
  SINEW_API explicit Robot(SerialRobot sections);
  SINEW_API explicit Robot(Arm arm);
  SINEW_API explicit Robot(ArmLegs legs);
  /// Of legs all alike; needs robot/parallel.hpp.
  template <class LegT>
  Robot(std::string name, const ParallelRobot<LegT>& legs);
  Robot(const Robot&) = default;
  Robot& operator=(const Robot&) = default;

  SINEW_API const std::string& name() const;  ///< as its file says
  SINEW_API const Weight& weight() const;     ///< what weighs on it
  SINEW_API bool geometry_inferred() const;   ///< not printed in its source but inferred from results

  /// What its links are taken for.
  Model model() const { return model_; }
  /// The same robot by another model, which is again a robot: every question that the model can answer may be
  /// put to it. Its file's model and, where its links are arcs, prb; of an arm cc is the serial robot whose
  /// shape the lengths of its tendons give. An error names what a leg lacks for that: `joints`, `material`,
  /// `diameter`, what of an arm's tendons runs otherwise, or that its links have no such model.
  SINEW_API Expected<Robot> as(Model model,
                               PrbDiscretisation discretisation = PrbDiscretisation::weighted) const;

  /// Its sections, of a serial robot, which has no legs and no platform; else null.
  const SerialRobot* serial() const { return serial_; }
  /// Of a tendon-driven arm that bears loads, which has no legs and no platform; else null.
  const Arm* arm() const { return arm_; }
  /// Of a platform on arms, whose questions are in kinematics/arm_legs.hpp; else null.
  const ArmLegs* arm_legs() const { return arm_legs_; }

  /// Its legs; null of a robot of the other space.
  const PlanarRobot* planar() const { return planar_; }
  const SpatialRobot* spatial() const { return spatial_; }  ///< see `planar`

  /// Its legs by the model prb; null of a robot of the other space or by another model.
  SINEW_API const ChainLegs<Planar>* planar_chains() const;
  SINEW_API const ChainLegs<Spatial>* spatial_chains() const;  ///< see `planar_chains`

  /// The robot with another weight: one of its own.
  SINEW_API Robot under(const Weight& weight) const;

  /// Elastic rods among its legs.
  int rod_count() const { return rods_; }
  /// Whether it has no more rows, inputs and rods than this build carries (base/limits.hpp); of one that has
  /// more every question is answered by `bad_input`.
  bool is_within_limits() const { return is_within_limits_; }

  /// One for a robot and its copies: by it a workspace knows the robot that it was made for ...
  const void* identity() const { return data_.get(); }
  /// ... while it keeps it.
  std::shared_ptr<const void> shared() const { return data_; }

 private:
  struct Data;
  explicit Robot(std::shared_ptr<const Data> data);

  std::shared_ptr<const Data> data_;
  const PlanarRobot* planar_ = nullptr;
  const SpatialRobot* spatial_ = nullptr;
  const SerialRobot* serial_ = nullptr;
  const Arm* arm_ = nullptr;
  const ArmLegs* arm_legs_ = nullptr;
  Model model_ = Model::rigid;
  int rods_ = 0;
  bool is_within_limits_ = true;
};

/// Whether legs of this robot are elastic rods.
inline bool has_rods(const Robot& robot) { return robot.rod_count() > 0; }
/// Whether legs of this robot bear load: it then has equilibria (kinematics/equilibrium.hpp).
inline bool bears_load(const Robot& robot) {
  return robot.model() == Model::rod || robot.model() == Model::prb;
}
SINEW_API bool has_weight(const Robot& robot);  ///< gravity does something to it

}  // namespace sinew::inline v1
