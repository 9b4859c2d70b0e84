/// @file arm_work.hpp
/// What a workspace keeps for an arm: the rod at every resolution that a question has needed.
#pragma once
#include <memory>

#include "kinematics/arms/ladder.hpp"
#include "robot/arms/arm_model.hpp"
#include "sinew/kinematics/arm.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1 {

/// A rod of an arm and its memory.
struct ArmRod {
  strain::RodModel model;
  strain::LoadedRod rod;
  std::unique_ptr<ArmRod> lean = {};  ///< with fewer elements, whose Hessian its steps take; may be none
  explicit ArmRod(strain::RodModel made) : model(std::move(made)), rod(model) {}
  ArmRod(const ArmRod&) = delete;
  ArmRod& operator=(const ArmRod&) = delete;
};

/// What arm_follow remembers: follow.cpp.
struct ArmPath;

struct ArmWorkspace::Impl : Rung {
  explicit Impl(const Arm& arm);

  std::shared_ptr<const char> robot;  ///< identity of the arm it is for
  bool knows_rest = false;
  std::vector<double> rest_lengths;  ///< of tendons, straight or as the rest shape has them [m]

  /// What the rods below are made for.
  ArmModel model = ArmModel::subsegment_rod;
  ArmBalance balance = ArmBalance::energy;
  int order = -2, elements = 0;
  std::vector<double> breaks;
  std::vector<std::unique_ptr<ArmRod>> levels;  ///< coarse to fine; made when needed

  std::vector<TendonCommand> commands;  ///< of the last equilibrium
  bool balances = false;                ///< whether it was found
  bool may_grow = true;                 ///< see strain::RelaxOptions
  bool grew = false;                    ///< a search since this was set to false
  ArmState state;

  std::shared_ptr<ArmPath> path;  ///< of arm_follow; none: it begins anew
  bool rubs = false;              ///< tensions of the last equilibrium differ along tendons

  /// The rod of a level for this question.
  ArmRod& at(const Arm& arm, const ArmOptions& options, const std::vector<double>& at_breaks, int wanted);
  strain::LoadedRod& rod() { return levels[static_cast<std::size_t>(level)]->rod; }
};

SE3<double> pose_of(const strain::RodFrame& frame);
/// Twists of the tip by coordinates, in base axes: 6 rows of `size`.
std::vector<double> tip_rows(const strain::RodModel& model, const strain::RodWork& work);
/// What does not fit the arm, or one option the other, in words; empty if all does.
FixedText<240> misfit(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
                      const ArmOptions& options);
/// A load as what falls to each node.
void set_loads(const Arm& arm, const ArmLoad& load, const strain::RodModel& model,
               std::vector<strain::NodeLoad>& loads);

/// Strains of one rod as coordinates of another of the same arm.
void carry_over(const strain::RodModel& from, const strain::RodWork& work, const strain::RodModel& to,
                std::vector<double>& y);

/// Coordinates of the shape with these mean curvatures of equal parts [rad/m].
void take_curvatures(std::span<const std::array<double, 3>> curvatures, const strain::RodModel& model,
                     std::vector<double>& y);

/// The strain at a place from the base [m].
/// @param near an element to look from; becomes the one that the place is in
strain::Six strain_at(const strain::RodModel& model, const strain::RodWork& work, double place, int& near);

}  // namespace sinew::inline v1
