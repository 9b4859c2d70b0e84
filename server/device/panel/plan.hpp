/// @file plan.hpp
/// A planned way in, and how far along it the arm is. Between two steps the stage and all bends go straight
/// from the one to the other, in proportion: it is for this motion that the planner's check holds
/// (sinew/plan/steps.hpp, "Check" in docs/theory/insertion.md).
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "arm.hpp"
#include "outcome.hpp"

namespace sinew::server::device {

class Motion;

struct DrivePlan {
  std::string name;
  std::vector<Posture> steps;
  std::vector<double> clearance;  ///< of each step [m]; empty: not known
};

/// Limits of a plan.
inline constexpr std::size_t max_steps = 4000;
inline constexpr double max_stage_step = 5e-3;  ///< [m] from one step to the next
inline constexpr double max_bend_step = 0.1;    ///< [rad] of a section

/// What is wrong with a plan for this arm, with its step; nothing: it can be driven.
/// @param stage_limit [m]; 0: there is no stage
Outcome check_plan(const DrivePlan& plan, const Arm& arm, double stage_limit);

/// How far a posture is from a path.
struct OffPath {
  double bend = 0;  ///< the most of all sections [rad]
  std::size_t section = 0;
  double stage = 0;  ///< [m]

  static constexpr double max_bend = 0.02, max_stage = 1e-3;  ///< of an arm that is on the path
  /// Of what an arm on the path may be off.
  double share() const { return std::max(bend / max_bend, stage / max_stage); }
};

/// A plan that is driven.
class FollowedPlan {
 public:
  explicit FollowedPlan(DrivePlan plan) : plan_(std::move(plan)) {}
  const DrivePlan& plan() const { return plan_; }
  double last() const { return static_cast<double>(plan_.steps.size() - 1); }

  /// Where the arm is measured.
  void look(const Posture& measured);
  const OffPath& off() const { return off_; }
  bool is_on_path() const { return off_.share() <= 1; }
  /// So far from the path that following it has to end.
  bool is_lost() const { return off_.share() > 2; }

  /// How far it has come, in steps: where set-points were left, or the nearest point of the path where
  /// something else has moved them.
  double at() const;
  Posture here() const;
  /// The lesser one of the two steps it is between [m]; none: not known.
  std::optional<double> clearance() const;

  /// Set-points begin at `at()`.
  void enter();
  /// Set-points are the business of others.
  void leave() { is_entered_ = false; }
  /// The next set-point, into `motion`, with no tendon and no stage farther than `way` [m]. False: there is
  /// nothing left to go.
  bool go(Motion& motion, bool is_back, double way);

 private:
  Posture posture(double at) const;

  DrivePlan plan_;
  double at_ = 0, nearest_ = 0;
  bool is_entered_ = false;
  OffPath off_{1e9, 0, 1e9}, off_here_{1e9, 0, 1e9};
};

}  // namespace sinew::server::device
