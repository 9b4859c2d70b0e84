/// @file growing_load.hpp
/// A load that grows with λ until the equilibrium gives way: along its curve, so that the load is exact to
/// rounding there. Theory: docs/theory/continuation.md
#pragma once
#include "solve/curve_walk.hpp"

namespace sinew::inline v1 {

enum class GrowthEnd {
  limit,        ///< the limit was reached
  fold,         ///< no equilibrium is nearby beyond this load
  bifurcation,  ///< the equilibrium goes on without holding by itself: another curve crosses
  stability,    ///< ... and none crosses: the load is none of a potential
  bound,        ///< what the problem allows ends
  lost,         ///< no step however short succeeds
  ran_out,
  stopped,
};

struct Growth {
  GrowthEnd end = GrowthEnd::limit;
  double parameter = 0;
  double definite_until = -1;  ///< where more directions became unstable before any gave way; else below 0
};

/// Of a problem that is asked also for
///
///     int giving_way(signs);   directions in which the whole gives way by itself
///     bool is_symmetric();     whether there are as many of them as unstable ones
///     double margin();         to where what it allows ends: positive on this side
template <class Problem>
class GrowingLoad {
 public:
  using Place = typename Problem::Place;

  /// From where the tracer is, λ = 0. @param begun, reached memory
  GrowingLoad(Tracer<Problem>& tracer, Place& begun, Place& reached)
      : tracer_(tracer),
        begun_(begun),
        reached_(reached) {}

  /// The tracer is then at the last equilibrium that holds.
  template <class HasBudget>
  Growth run(double highest, StopToken stop, HasBudget&& has_budget) {
    highest_ = highest;
    last_ = first_ = signs();
    const double size = tracer_.size();
    const auto longest = [&] { return longest_stride(); };
    const auto step = [&](double stride) { return take(stride); };
    const StepsEnd end = walk(tracer_, begun_, {0.01 * size, 1e-8 * size, stop}, has_budget, longest, step);
    if (end != StepsEnd::done) {
      growth_.end = end == StepsEnd::lost      ? GrowthEnd::lost
                    : end == StepsEnd::stopped ? GrowthEnd::stopped
                                               : GrowthEnd::ran_out;
    }
    tracer_.restore(begun_);
    growth_.parameter = growth_.end == GrowthEnd::limit ? highest : tracer_.lambda();
    if (growth_.end < GrowthEnd::lost && growth_.end != GrowthEnd::limit &&
        growth_.definite_until >= growth_.parameter * (1 - 1e-9))
      growth_.definite_until = -1;  // told only where it is before the end
    return growth_;
  }

 private:
  struct Signs : CurveSigns {
    int giving_way = 0;
  };
  Signs signs() const {
    Signs signs{tracer_.signs()};
    signs.giving_way = tracer_.problem().giving_way(signs);
    return signs;
  }

  /// The unknowns move so far at most; where they hardly move the load grows by a quarter.
  double longest_stride() const {
    const auto& t = tracer_.tangent();
    const double least = 0.05 * tracer_.size(), load = std::abs(tracer_.along()),
                 moved = t.template head<Problem::unknowns>().norm();
    return std::max(least, std::min(least / moved, 0.25 * tracer_.lambda() * tracer_.scale() / load));
  }

  bool holds_on(const Signs& here) const {
    return here.along > 0 && here.is_odd == last_.is_odd && here.giving_way <= first_.giving_way &&
           tracer_.problem().margin() > 0;
  }

  CurveStep take(double stride) {
    const auto ahead = begun_.tangent;
    if (!tracer_.step(stride)) return CurveStep::failed;
    bool arrives = tracer_.lambda() >= highest_;
    if (!arrives && tracer_.along() <= 0) {  // it may have been there on its way to a fold
      if (!tracer_.locate(ahead, stride, [&] { return tracer_.along(); })) return CurveStep::failed;
      arrives = tracer_.lambda() >= highest_;
      tracer_.before() = begun_;
      if (!arrives) {
        tracer_.restore(begun_);
        if (!tracer_.advance(ahead, stride)) return CurveStep::failed;
      }
    }
    if (arrives) {
      const auto there = tracer_.settle_between(begun_, stride, highest_);
      if (!there) return CurveStep::failed;
      stride = *there;
    }
    const Signs next = signs();
    tracer_.save(reached_);
    if (!note_definiteness(next, stride)) return CurveStep::failed;
    if (!holds_on(next)) return end_between(stride) ? CurveStep::last : CurveStep::failed;
    tracer_.restore(reached_);
    last_ = next;
    if (!arrives) return CurveStep::taken;
    begun_ = reached_;
    return CurveStep::last;
  }

  /// To the last that holds, between the place begun and `stride` beyond. False where all of them do.
  bool end_between(double stride) {
    tracer_.before() = begun_;
    const auto holds = [&] { return holds_on(signs()) ? 1.0 : -1.0; };
    if (!tracer_.locate(begun_.tangent, stride, holds, false)) return false;
    const Signs beyond = signs();
    constexpr double level = 1e-4;  // dλ/ds at a fold, to rounding
    const bool crosses = beyond.is_odd != last_.is_odd || beyond.own != last_.own;
    growth_.end = !(tracer_.problem().margin() > 0)             ? GrowthEnd::bound
                  : std::abs(beyond.along) < level              ? GrowthEnd::fold
                  : crosses || tracer_.problem().is_symmetric() ? GrowthEnd::bifurcation
                                                                : GrowthEnd::stability;
    begun_ = tracer_.before();
    return true;
  }

  /// Where more directions become unstable. False where that is not on the curve.
  bool note_definiteness(const Signs& next, double stride) {
    if (growth_.definite_until >= 0 || next.unstable <= first_.unstable || tracer_.problem().is_symmetric())
      return true;
    tracer_.before() = begun_;
    const auto is_kept = [&] { return tracer_.signs().unstable <= first_.unstable ? 1.0 : -1.0; };
    if (!tracer_.locate(begun_.tangent, stride, is_kept, false)) return false;
    growth_.definite_until = tracer_.before().lambda;
    return true;
  }

  Tracer<Problem>& tracer_;
  Place &begun_, &reached_;
  double highest_ = 0;
  Signs first_, last_;
  Growth growth_;
};

}  // namespace sinew::inline v1
