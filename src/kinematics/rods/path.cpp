#include "kinematics/rods/path.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "math/linalg.hpp"

namespace sinew::inline v1 {
namespace {

/// A step of the platform as one length [m].
double size_of(const Vec<double, 6>& twist, double radius) {
  return std::hypot(twist.head<3>().norm(), radius * twist.tail<3>().norm());
}

void set(RodGroup& system, const RodTarget& from, const RodTarget& to, double part) {
  for (int k = 0; k < system.feeds(); ++k)
    system.set_feed(k, std::lerp(from.lengths[at(k)], to.lengths[at(k)], part));  // exact at the end
  system.set_wrench(from.wrench + part * (to.wrench - from.wrench));
}

}  // namespace

bool correct(RodGroup& system, int& iterations, double& residual, double tolerance) {
  const auto step = [&] {
    if (!system.linearise()) return false;
    system.move(system.step(true));
    return true;
  };
  return contract([&] { return system.evaluate(); }, step, tolerance, rod_rounding, iterations, residual);
}

RodTarget present(const RodGroup& system) {
  RodTarget target;
  for (int k = 0; k < system.feeds(); ++k) target.lengths[at(k)] = system.held(k);
  target.wrench = system.wrench();
  return target;
}

namespace {

/// One path being followed.
class Follower {
 public:
  Follower(RodGroup& system, const RodTarget& target, const RodPathOptions& options, LimbState& spare)
      : system_(system),
        from_(present(system)),
        to_(target),
        options_(options),
        spare_(spare) {}

  RodPathEnd run() {
    signs_ = signs_of(system_);
    const ParameterOptions how{{1, least, options_.stop}, shortest, options_.max_iterations};
    follow_parameter(end_, how, [&](double next, double taken) { return attempt(next, taken); });
    return end_;
  }

 private:
  /// A path ends where its strides are shorter than this part of what is behind, or of the whole.
  static constexpr double shortest = 1e-9, least = 1e-18;
  static constexpr double longest = 0.15;   ///< predictor, over a rod's length
  static constexpr double crossing = 1e-5;  ///< ... over which signs may change

  ParameterStep attempt(double next, double taken) {
    system_.save(spare_);
    if (!reach(next)) {
      retreat();
      const double fits = 0.9 * longest * system_.length(0) / predicted_;
      return {ParameterStep::failed, taken * (fits > 1e-6 ? std::min(fits, 0.25) : 1e-6)};  // NaN too
    }
    const double verifiable = crossing * system_.length(0) / predicted_ * taken;
    const LimbSigns now = options_.may_stray ? signs_ : signs_of(system_);
    const bool changes = now != signs_;
    if (changes && predicted_ > crossing * system_.length(0)) {
      retreat();
      return {ParameterStep::crossed, 0, verifiable};
    }
    signs_ = now;
    return {changes ? ParameterStep::reached_other_side : ParameterStep::reached, quick_ ? 2 * taken : taken,
            verifiable};
  }

  /// Predictor with the last factors, Newton's method after it. The corrections must stay small beside the
  /// prediction: else it may have found another branch.
  bool reach(double part) {
    set(system_, from_, to_, part);
    system_.evaluate();
    const Vec<double, 6> ahead = system_.step(false);
    predicted_ = size_of(ahead, system_.radius());
    if (!(predicted_ <= longest * system_.length(0))) return false;
    system_.move(ahead);
    const SE3<double> predicted = system_.platform();
    const int before = end_.iterations;
    double residual = 0;
    if (!correct(system_, end_.iterations, residual, options_.tolerance)) return false;
    Vec<double, 6> correction;
    correction << system_.platform().p - predicted.p,
        predicted.R.inverse().compose(system_.platform().R).log();
    if (size_of(correction, system_.radius()) > (options_.may_stray ? 0.5 : 0.3) * predicted_ + 1e-9)
      return false;
    while (!system_.is_finest() && system_.truncation() > coarse_truncation) {
      system_.refine();
      if (!correct(system_, end_.iterations, residual, options_.tolerance)) return false;
    }
    if (!system_.linearise()) return false;
    quick_ = end_.iterations - before <= 4;
    end_.residual = residual;
    return true;
  }

  void retreat() {
    system_.restore(spare_);
    system_.evaluate();
    system_.linearise();
  }

  RodGroup& system_;
  RodTarget from_;
  const RodTarget& to_;
  const RodPathOptions& options_;
  LimbState& spare_;
  RodPathEnd end_;
  LimbSigns signs_;
  bool quick_ = false;
  double predicted_ = 0;  ///< length of the last predictor [m]
};

}  // namespace

RodPathEnd follow(RodGroup& system, const RodTarget& target, const RodPathOptions& options,
                  LimbState& spare) {
  return Follower(system, target, options, spare).run();
}

}  // namespace sinew::inline v1
