#include "kinematics/arm_legs/search/search.hpp"

#include <algorithm>
#include <utility>

#include "base/at.hpp"
#include "kinematics/arm_legs/search/continuation.hpp"
#include "kinematics/arm_legs/search/first_equilibrium.hpp"
#include "kinematics/arm_legs/search/resolution.hpp"
#include "kinematics/arm_legs/search/search_words.hpp"

namespace sinew::inline v1 {
namespace {

class EquilibriumSearch {
 public:
  EquilibriumSearch(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                    ArmLegsWorkspace& work, LegsEnd end)
      : robot_(robot),
        problem_(problem),
        options_(options),
        work_(work),
        impl_(work.impl()),
        end_(end),
        budget_(options, work.stop),
        bases_(bases_of(options)),
        is_pose_prescribed_(problem.prescribed_pose.has_value()),
        goes_on_(options.from_last && levels_are_for(options, impl_) && impl_.has_last()) {}
  void run() {
    make_room();
    impl_.state = {};
    if (goes_on_) go_on_from_last();
    if (!goes_on_ || begins_anew_) begin_anew();
    impl_.level = static_cast<int>(level_);
    if (end_ != LegsEnd::coarse)
      found_ = refine_levels(robot_, problem_, options_, work_, {true, goes_on_ && !begins_anew_}, budget_,
                             found_);
    group_ = &impl_.group();
    come_to_least_tensions(*group_, is_pose_prescribed_, budget_, found_);
    write_report();
    write_stability();
    write_legs_state(robot_, *group_, impl_.state);
  }

 private:
  /// Rods have nodes where loads act: groups are made anew where others are to. Loads that go need theirs on
  /// the way, and no longer.
  void make_room() {
    const LegsBreaks breaks = breaks_for(robot_, problem_.loads);
    if (!goes_on_) {
      prepare_levels(options_, breaks, work_);
    } else if (!has_all(impl_.breaks, breaks)) {
      parted_ = std::move(impl_.levels[at(impl_.level)]);
      prepare_levels(options_, together(breaks, breaks_for(robot_, parted_->loads())), work_);
    }
  }
  /// The coarsest group at rest; made anew, since its shapes are those at rest only then.
  void put_at_rest() {
    impl_.levels[0] = std::make_unique<ArmGroup>(robot_, bases_[0], impl_.breaks);
    group_ = impl_.levels[0].get();
    group_->set_problem(problem_.commands, problem_.wrench, problem_.loads);
  }
  void go_on_from_last() {
    // One level coarser: the next one then says how far both are off.
    level_ = at(std::max(0, impl_.level - 1));
    const ArmGroup& last = parted_ ? *parted_ : impl_.group();
    if (!impl_.levels[level_])
      impl_.levels[level_] = std::make_unique<ArmGroup>(robot_, bases_[level_], impl_.breaks);
    group_ = impl_.levels[level_].get();
    if (group_ != &last) {
      std::vector<TendonCommand> commands = problem_.commands;
      for (std::size_t i = 0; i < commands.size(); ++i)
        commands[i].value = last.value_of(static_cast<int>(i), commands[i].held);
      group_->carry_over_from(last);
      group_->set_problem(commands, last.wrench(), last.loads());
      group_->set_share(1);
    }
    found_ = walk_legs(*group_, problem_, budget_, impl_.state.reached);
    begins_anew_ = end_ != LegsEnd::on_the_way && found_.status != Status::converged &&
                   found_.status != Status::stopped && found_.status != Status::iteration_limit;
  }
  void begin_anew() {
    double& reached = impl_.state.reached;
    level_ = 0;
    put_at_rest();
    found_ = begin_at_rest(*group_, problem_, budget_, reached);
    if (is_pose_prescribed_ && found_.status == Status::stalled && reached == 0) {
      put_at_rest();
      found_ = begin_unloaded(*group_, problem_, budget_, reached);
    }
    if (found_.status == Status::stalled &&
        std::ranges::any_of(problem_.commands,
                            [](const TendonCommand& command) { return command.held == TendonHeld::change; }))
      try_softened();
  }
  /// Where that leads to nothing either, all is as it was.
  void try_softened() {
    const LimbState before = group_->state();
    double reached = 0;
    put_at_rest();
    if (const LegsFound found = begin_softened(*group_, problem_, budget_, reached);
        found.status == Status::converged || found.status == Status::stopped ||
        found.status == Status::unreachable) {
      found_ = found;
      if (found.status == Status::converged) impl_.state.reached = reached;
      if (found.status != Status::unreachable) return;
    }
    group_->restore(before);
    group_->evaluate();
  }
  void write_report() {
    ArmLegsState& state = impl_.state;
    Report& report = state.report;
    const Status status = found_.status;
    report.status = status;
    report.iterations = budget_.iterations;
    report.residual = found_.residual;
    if (status == Status::unstable || status == Status::singular)
      report.message = FixedText<240>("what coarser polynomials found does not hold by finer ones");
    else if (status != Status::converged)
      report.message = FixedText<240>(
          words_of_search(robot_, problem_, found_, group_->loads_have_potential(), state.reached));
    else if (begins_anew_)
      report.message = FixedText<240>(
          "from the last equilibrium none that holds was found on the way here; this is what the rest grows "
          "into");
    if (report.ok())
      report_coarse(state.resolution, options_.accuracy, legs_size(robot_), "platform", report);
  }
  /// A platform at a prescribed pose is let go under the wrench that keeps it there.
  void write_stability() {
    ArmLegsState& state = impl_.state;
    state.stable = found_.status == Status::converged;
    if (!is_pose_prescribed_ || !state.stable) return;
    group_->set_wrench(problem_.wrench + constraint_wrench(*group_));
    group_->evaluate();
    state.stable = is_stable(*group_, false);
  }

  const ArmLegs& robot_;
  const LegsProblem& problem_;
  const ArmOptions& options_;
  ArmLegsWorkspace& work_;
  ArmLegsWorkspace::Impl& impl_;
  LegsEnd end_;
  NewtonBudget budget_;
  std::vector<ArmBasis> bases_;
  bool is_pose_prescribed_, goes_on_;
  std::unique_ptr<ArmGroup> parted_;  ///< the last equilibrium's, where loads act at other places
  bool begins_anew_ = false;          ///< the last equilibrium led to none
  LegsFound found_;
  ArmGroup* group_ = nullptr;
  std::size_t level_ = 0;
};

}  // namespace

void solve_legs(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                ArmLegsWorkspace& work, LegsEnd end) {
  EquilibriumSearch(robot, problem, options, work, end).run();
}

}  // namespace sinew::inline v1
