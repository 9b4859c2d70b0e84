/// @file robot.hpp
/// A robot: what files load to and what every question is put to; and the memory of whoever asks. The robot
/// is shared, a workspace belongs to one thread. What a robot is made of is inside, in robot/parallel.hpp and
/// robot/chains.hpp, and public of arms: robot/serial.hpp, robot/arm.hpp, robot/arm_legs.hpp.
#pragma once
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/base/export.hpp"
#include "sinew/link/state.hpp"
#include "sinew/math/se2.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"

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
  /// Whether it has no more rows, inputs and rods than this build carries (24 of each); of one that has
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

class ArmLegsWorkspace;
class ArmWorkspace;
struct RodWork;
struct SerialWorkspace;

/// Memory of solvers for chains, one per thread. Sized on first use with a robot; then nothing allocates.
struct ChainWork {
  StopToken stop = {};  ///< solves that use it end with `stopped` once it is requested
  std::shared_ptr<void> planar = {}, spatial = {};  ///< the solvers' own; a copy of it is for the same thread
};

/// Memory for questions to one robot and its copies; answers are views into it. Not for two threads at once.
struct Workspace {
  /// Most solutions of one leg that are kept; an arc within a full turn either way has fewer.
  static constexpr int max_solutions = 8;

  /// Allocates all that solves of this robot need.
  SINEW_API explicit Workspace(const Robot& robot);
  SINEW_API ~Workspace();
  SINEW_API Workspace(Workspace&&) noexcept;
  SINEW_API Workspace& operator=(Workspace&&) noexcept;

  std::shared_ptr<const void> robot;  ///< identity of the robot it is for, and of that robot's copies
  StopToken stop;  ///< solves that use this workspace end with `stopped` once it is requested
  std::vector<double> coordinates;  ///< of the links, leg by leg [1/m], [rad], [m]
  std::vector<double> inputs;       ///< in leg order [m], [rad]
  std::vector<double> J;            ///< rows × dof, rows first, as all of these; units: `Reduced`
  std::vector<double> K;            ///< rows × inputs; units: `Reduced`
  std::vector<double> U;            ///< dof × inputs [m or rad per unit of input]
  std::vector<double> s;            ///< rows; units: `Reduced`
  std::vector<double> unit_J;       ///< J with rows scaled to unit lines, moments over the platform radius
  std::vector<double> unit_K;       ///< K scaled alike: units of J are gone
  std::vector<double> rates;        ///< of the inputs [m/s], [rad/s]
  std::vector<double> solutions;    ///< of each leg max_solutions times its inputs
  std::vector<int> solution_count;  ///< a leg; 1 for a leg whose inputs are another's
  std::vector<int> type_1;          ///< legs
  std::vector<LegState> legs;
  std::unique_ptr<RodWork> rods;               ///< of a robot on rods; else null
  std::unique_ptr<SerialWorkspace> serial;     ///< of a serial robot; else null
  std::unique_ptr<ArmWorkspace> arm;           ///< of an arm; else null
  std::unique_ptr<ArmLegsWorkspace> arm_legs;  ///< of a platform on arms; else null
  ChainWork chains;                            ///< of a robot by the model prb
  /// Of a robot by the model prb: that of the same on arcs, near which searches for its chains begin; else
  /// null.
  std::unique_ptr<Workspace> arcs;
};

}  // namespace sinew::inline v1
