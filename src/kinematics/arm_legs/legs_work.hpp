/// @file legs_work.hpp
/// What a workspace keeps for a platform on arms, and the search for an equilibrium that every question to it
/// has. Theory: docs/theory/arm_legs.md
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kinematics/arm_legs/group/arm_group.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {

struct ArmLegsWorkspace::Impl {
  std::shared_ptr<const char> robot;
  ArmModel model = ArmModel::subsegment_rod;
  int order = -2, elements = 0;
  LegsBreaks breaks;  ///< of all levels
  std::vector<std::unique_ptr<ArmGroup>> levels;
  int level = -1;  ///< of the last equilibrium; −1: none was
  ArmLegsState state;

  /// Whether there is an equilibrium to go on from.
  bool has_last() const { return level >= 0 && state.report.ok(); }
  ArmGroup& group() { return *levels[static_cast<std::size_t>(level)]; }
};

/// What an equilibrium is asked of.
struct LegsProblem {
  std::vector<TendonCommand> commands;
  ArmGroup::Wrench wrench = ArmGroup::Wrench::Zero();
  LegsLoads loads;
  std::optional<ArmGroup::Frame> held = {};  ///< the platform there, whatever wrench that takes

  LegsProblem(const ArmLegs& robot, std::span<const TendonCommand> tendons, const ArmLegsLoad& load);
};

struct LegsFound {
  Status status = Status::converged;
  int iterations = 0;
  double residual = 0;
  Status last =
      Status::converged;  ///< of the last step that was tried, where all of them together are stalled
};

/// What does not fit the robot, in words; empty if all does. The status is `bad_input`, but `unsupported` of
/// a balance that is not by energy.
Report legs_misfit(const ArmLegs& robot, std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                   const ArmOptions& options, const ArmLegsWorkspace& work);

/// Newton's method at one share of inputs and loads.
/// @param is_held the platform stays where it is; @param spent of options' iterations
LegsFound iterate_legs(ArmGroup& group, bool is_held, const ArmOptions& options, const StopToken& stop,
                       int spent);
/// From the rest, or where the group is at share 0; the platform is free.
LegsFound grow_legs(ArmGroup& group, const ArmOptions& options, const StopToken& stop, double& reached);
/// The bases of the options' polynomials, coarse to fine.
std::vector<ArmBasis> bases_of(const ArmOptions& options);
/// By how much polynomials that are finer move the platform, or would if it were free [m].
double moved_by(ArmGroup& coarse, ArmGroup& fine, bool is_held);
/// Makes room for groups of these options and breaks; those of others go.
void prepare_levels(const ArmOptions& options, const LegsBreaks& breaks, ArmLegsWorkspace& work);

/// How a search for an equilibrium may end.
enum class LegsEnd {
  anywhere,    ///< where the last equilibrium leads to none, at what the rest grows into
  on_the_way,  ///< there the workspace stays
  coarse,      ///< `anywhere`, and finer polynomials are not tried
};

/// The equilibrium into which the rest grows, or where options say so the last one; the workspace's state is
/// of it. Where `held` is asked the group's wrench is in the end what holds the platform.
void solve_legs(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                ArmLegsWorkspace& work, LegsEnd end = LegsEnd::anywhere);

/// From the workspace's equilibrium, at the polynomials it has: all that differs changes evenly, in steps as
/// short as they have to be. Where that ends early the group is at the last one that was found.
/// @param reached share of the way; @param parts most equilibria on it, 0: any number
LegsFound walk_legs(ArmGroup& group, const LegsProblem& problem, const ArmOptions& options,
                    const StopToken& stop, double& reached, int parts = 0);

/// Equilibria that differ little, one after the other: the first as asked, the others from the one before at
/// its polynomials. Where one is not found the workspace stays at the one before.
class LegsWalk {
 public:
  /// @param first how the first one ends
  LegsWalk(const ArmLegs& robot, const ArmOptions& options, ArmLegsWorkspace& work, LegsEnd first)
      : robot_(robot),
        options_(options),
        work_(work),
        first_(first) {}
  Report go(const LegsProblem& problem, bool from_last);
  void keep();        ///< what was found last
  void bring_back();  ///< what was kept, from where the workspace's question is then

 private:
  const ArmLegs& robot_;
  ArmOptions options_;
  ArmLegsWorkspace& work_;
  LegsEnd first_;
  std::optional<LegsProblem> before_ = {};
  LimbState state_ = {};
  struct Kept {
    LegsProblem problem;
    LimbState state;
    int level;
    LegsBreaks breaks;
  };
  std::optional<Kept> kept_ = {};
};

/// Of the group, but for the report, `stable`, `resolution` and `reached`.
void write_legs_state(const ArmLegs& robot, const ArmGroup& group, ArmLegsState& state);

/// Whether the robot is one in the plane and the pose is not.
bool leaves_plane(const ArmLegs& robot, const SE3<double>& pose);

/// The longest leg [m].
double legs_size(const ArmLegs& robot);

}  // namespace sinew::inline v1
