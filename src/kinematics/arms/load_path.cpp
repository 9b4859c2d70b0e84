#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "kinematics/arms/arm_work.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double buckled = 1e-6;   ///< a margin that counts as none
constexpr double shortest = 1e-9;  ///< a step over what was reached that is not worth another
constexpr int most_steps = 2000;
constexpr int most_iterations = 20000;  ///< of all steps, and of ways back
constexpr int most_in_a_step = 60;      ///< iterations: a shorter step pays, then

/// An equilibrium on the way.
struct Place {
  double load = 0, margin = 0;
  double speed = 0;  ///< of the tip over the arm's length, by the factor
  Vec3<double> tip;
};

class LoadWalk {
 public:
  LoadWalk(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
           const std::array<double, 6>& direction, double limit, const ArmOptions& options,
           ArmWorkspace& work)
      : arm_(arm),
        commands_(commands),
        load_(load),
        start_(load.wrench),
        direction_(direction),
        limit_(limit),
        options_(options),
        work_(work) {}

  ArmLoadPath run() {
    path_.state = arm_forward(arm_, commands_, load_, options_, work_);
    if (!path_.state.report.ok()) {
      path_.end = path_.state.report.status == Status::stopped ? LoadEnd::stopped : LoadEnd::stalled;
      return path_;
    }
    options_.from_last = true;
    options_.accuracy = 0;  // the resolution stays
    full_iterations_ = options_.max_iterations;
    options_.max_iterations = std::min(full_iterations_, most_in_a_step);
    last_ = measured(0);
    path_.margin = last_.margin;
    first_ = before_ = last_;
    double step = std::min(limit_, last_.speed > 0 ? 0.02 / last_.speed : limit_);
    while (path_.load < limit_ && path_.end == LoadEnd::limit) step = advance(step);
    return path_;
  }

 private:
  bool has_potential() const { return work_.impl().rod().has_potential(); }

  const ArmState& solve(double factor) {
    for (std::size_t i = 0; i < 6; ++i) load_.wrench[i] = start_[i] + factor * direction_[i];
    const ArmState& state = arm_forward(arm_, commands_, load_, options_, work_);
    iterations_ += state.report.iterations;
    return state;
  }

  /// The equilibrium that the workspace holds.
  Place measured(double factor) {
    const ArmRates rates = arm_rates(arm_, work_);
    Vec3<double> velocity(0, 0, 0);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        velocity[static_cast<Eigen::Index>(i)] += rates.compliance[6 * i + j] * direction_[j];
    return {factor, rates.margin, velocity.norm() / arm_.length(), work_.impl().state.tip.p};
  }

  /// Where the margin falls linearly as where an arm buckles, how far it is until it is used up ...
  double buckles_in() const {
    return (last_.load - before_.load) * last_.margin / (before_.margin - last_.margin);
  }
  /// ... and where it falls as a root, as where an arm snaps.
  double snaps_in() const {
    const double a = before_.margin * before_.margin, b = last_.margin * last_.margin;
    return (last_.load - before_.load) * b / (a - b);
  }
  /// Where there is no potential the tip's speed alone tells where an arm snaps: it grows as one over the
  /// root.
  double turns_in() const {
    const double a = 1 / (before_.speed * before_.speed), b = 1 / (last_.speed * last_.speed);
    return (last_.load - before_.load) * b / (a - b);
  }
  /// Iterations that may be spent: fewer of a rod of many elements, each of which takes longer.
  int budget() const {
    const auto elements = static_cast<int>(work_.impl().rod().model().elements.size());
    return std::clamp(400000 / elements, 1500, most_iterations);
  }
  /// How far there is nothing to fear.
  double room() const {
    constexpr double any = std::numeric_limits<double>::infinity();
    if (!(last_.load > before_.load)) return any;
    if (!has_potential()) return last_.speed > before_.speed ? turns_in() : any;
    return last_.margin < before_.margin ? std::min(buckles_in(), snaps_in()) : any;
  }

  /// One step, or a shorter one to try; returns the next one's length.
  double advance(double step) {
    const double left = room();
    const bool is_at_end = left < shortest * std::max(last_.load, first_step_);
    if (is_at_end || (has_potential() && last_.margin < buckled)) {
      const bool turns = last_.speed * last_.margin > 1e-3 * first_.speed * first_.margin;
      path_.end = turns || !has_potential() ? LoadEnd::fold : LoadEnd::bifurcation;
      if (std::isfinite(left))
        path_.load = last_.load + (!has_potential() ? turns_in() : turns ? snaps_in() : buckles_in());
      return 0;
    }
    step = std::min({step, 0.5 * left, limit_ - last_.load});
    const std::vector<double> held = work_.impl().rod().work().y;
    const ArmState& state = solve(last_.load + step);
    ++path_.steps;
    if (state.report.status == Status::stopped) return end_at(held, LoadEnd::stopped);
    const double moved = (state.tip.p - last_.tip).norm() / arm_.length();
    const bool follows = state.report.ok() && moved <= 4 * step * last_.speed + 1e-4 && moved < 0.1;
    const bool is_spent = path_.steps >= most_steps || iterations_ >= budget();
    if (!follows) {
      if (is_spent) return end_at(held, LoadEnd::iterations);
      take_back(held);
      growth_ = 1.1;
      if (step > shortest * std::max(last_.load, first_step_)) return 0.5 * step;
      options_.max_iterations = full_iterations_;
      const Status status = solve(last_.load + step).report.status;
      return end_at(held, !has_potential() && status == Status::unstable ? LoadEnd::stability
                          : has_potential()                              ? LoadEnd::fold
                                                                         : LoadEnd::stalled);
    }
    if (first_step_ == 0) first_step_ = step;
    before_ = last_;
    last_ = measured(last_.load + step);
    path_.load = last_.load, path_.margin = last_.margin, path_.state = work_.impl().state;
    if (!has_potential() && last_.margin < 0 && path_.definite_until < 0) path_.definite_until = before_.load;
    if (is_spent) path_.end = LoadEnd::iterations;
    const double next = moved < 0.03 ? growth_ * step : step;
    growth_ = std::min(1.6, 1.06 * growth_);
    return next;
  }

  void take_back(const std::vector<double>& held) {
    work_.impl().rod().work().y = held;
    solve(last_.load);
  }
  double end_at(const std::vector<double>& held, LoadEnd end) {
    take_back(held);
    path_.end = end;
    return 0;
  }

  const Arm& arm_;
  std::span<const TendonCommand> commands_;
  ArmLoad load_;
  std::array<double, 6> start_, direction_;
  double limit_;
  ArmOptions options_;
  ArmWorkspace& work_;
  ArmLoadPath path_;
  Place first_, before_, last_;
  double first_step_ = 0;
  double growth_ = 1.6;  ///< of steps; less after one that failed, which costs as much as many
  int iterations_ = 0, full_iterations_ = 0;
};

}  // namespace

ArmLoadPath arm_follow_load(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
                            const std::array<double, 6>& direction, double limit, const ArmOptions& options,
                            ArmWorkspace& work) {
  double size = 0;
  for (const double one : direction) size = std::isfinite(one) ? std::max(size, std::abs(one)) : 1e300;
  if (!(size > 0 && size < 1e300) || !(limit > 0 && std::isfinite(limit)) ||
      options.balance != ArmBalance::energy) {
    ArmLoadPath path;
    path.end = LoadEnd::stalled;
    path.state.report = {
        Status::bad_input, 0, 0,
        FixedText<240>("a load that grows has a direction other than 0, a limit above 0, and "
                       "balance by energy")};
    return path;
  }
  return LoadWalk(arm, commands, load, direction, limit, options, work).run();
}

}  // namespace sinew::inline v1
