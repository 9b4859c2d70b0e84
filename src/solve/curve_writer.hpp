/// @file curve_writer.hpp
/// Curves followed to their ends, with what is met on them: folds, bifurcations and the curves that cross
/// there, changes of stability, the parameters 0 and 1. Theory: docs/theory/continuation.md
#pragma once
#include <numbers>
#include <vector>

#include "solve/curve_walk.hpp"

namespace sinew::inline v1 {

/// What is special about a point of a curve.
enum class CurveMark {
  none,
  begin,   ///< λ = 0
  target,  ///< λ = 1
  fold,
  bifurcation,
  own_bifurcation,  ///< of what the problem has eliminated, which the rest does not feel at first
  stability,        ///< gained or lost with neither
};

enum class CurveStop { left_range, closed, max_points, far, stopped, stuck, not_followed };

struct CurveRange {
  double lowest = 0, highest = 1;  ///< of λ
  int max_points = 500;            ///< on each curve
  bool is_backward = false;
  bool follows_branches = false;
  int max_total_points = 200000;  ///< no other curve is begun where all have as many
};

/// Follows curves and writes down what is met. The problem is asked also for
///
///     using Curve;                            { points, end, from_curve, from_point }; `points` a vector
///     Place place();                          memory of one
///     point(lambda, residual, mark, unstable);  of a curve, where it is
///     is_same(point, point);                  one equilibrium
///     way_from(state);                        unit vector of the unknowns' motion from there
///     is_far(), is_symmetric();               see CurveStop and GrowingLoad
///     end_of(stop);                           in the words of Curve
template <class Problem>
class CurveWriter {
 public:
  static constexpr int N = Problem::unknowns;
  using Place = typename Problem::Place;
  using Step = typename Tracer<Problem>::Step;
  using Curve = typename Problem::Curve;
  using Point = typename decltype(Curve::points)::value_type;

  CurveWriter(Tracer<Problem>& tracer, const CurveRange& how, StopToken stop)
      : tracer_(tracer),
        problem_(tracer.problem()),
        how_(how),
        stop_(stop),
        first_(problem_.place()) {}

  std::vector<Curve> run() {
    tracer_.save(first_);
    if (how_.is_backward) first_.tangent = -first_.tangent;
    std::vector<Curve> curves(1);
    tracer_.restore(first_);
    write(curves[0], CurveMark::begin);
    follow(curves[0], true);
    if (!how_.follows_branches) return curves;
    std::vector<Branching> found;
    found.swap(branchings_);
    for (Branching& one : found) leave(one, curves);
    return curves;
  }

 private:
  /// Where other curves cross the first: the state, directions square to it, and which point it is.
  struct Branching {
    Place place;
    std::vector<Step> directions;
    int point;
  };

  static constexpr double first_stride = 0.01, longest_stride = 0.05, shortest_stride = 1e-7;
  static constexpr double null_tolerance = 0.1;

  /// Where the tracer is. @param unstable directions
  Point point(CurveMark mark, int unstable) const {
    return problem_.point(tracer_.lambda(), tracer_.residual(), mark, unstable);
  }
  void write(Curve& curve, CurveMark mark) { curve.points.push_back(point(mark, problem_.signs().unstable)); }

  /// On from where the tracer is, until the curve ends.
  void follow(Curve& curve, bool notes_branchings) {
    const double size = tracer_.size();
    last_ = tracer_.signs();
    std::optional<CurveStop> stop;
    const auto has_budget = [&] { return static_cast<int>(curve.points.size()) < how_.max_points; };
    const auto step = [&](double stride) {
      if (!take(curve, stride, notes_branchings, stop)) return CurveStep::failed;
      if (!stop && problem_.is_far()) stop = CurveStop::far;
      return stop ? CurveStep::last : CurveStep::taken;
    };
    const StepsEnd end = walk(
        tracer_, begun_, {first_stride * size, shortest_stride * size, stop_}, has_budget,
        [&] { return longest_stride * size; }, step);
    curve.end = problem_.end_of(end == StepsEnd::done      ? *stop
                                : end == StepsEnd::ran_out ? CurveStop::max_points
                                : end == StepsEnd::stopped ? CurveStop::stopped
                                                           : CurveStop::stuck);
  }

  /// One stride from `begun_`, or less of it where something ends there, with all that happened on it. False,
  /// with the state lost and nothing written, where none is found that stays on the curve.
  bool take(Curve& curve, double stride, bool notes_branchings, std::optional<CurveStop>& stop) {
    if (!tracer_.step(stride)) return false;
    CurveMark mark = CurveMark::none;
    // a step ends at a fold at the latest, so that λ goes one way in it
    if (last_.along != 0 && (last_.along > 0) != (tracer_.along() > 0)) {
      const auto there = tracer_.locate(begun_.tangent, stride, [&] { return tracer_.along(); });
      if (!there) return false;
      mark = CurveMark::fold;
      stride = *there;
    }
    const bool ends = ends_range(tracer_.lambda());
    if (ends) {
      const double bound = tracer_.lambda() >= how_.highest ? how_.highest : how_.lowest;
      const auto there = tracer_.settle_between(begun_, stride, bound);
      if (!there) return false;
      stride = *there;
      mark = mark_of(bound);
    }
    const CurveSigns next = tracer_.signs();
    tracer_.save(reached_);
    found_.clear();
    const auto unstable = note_crossings(next, stride, mark == CurveMark::fold, notes_branchings);
    if (!unstable) return false;
    if (note_marks(curve, stride)) stop = CurveStop::closed;
    write_found(curve);
    tracer_.restore(reached_);
    curve.points.push_back(point(mark, mark == CurveMark::fold ? *unstable : next.unstable));
    if (!stop && ends) stop = CurveStop::left_range;
    last_ = next;
    return true;
  }

  /// On an end of the range and on the way out, or beyond it.
  bool ends_range(double parameter) const {
    const bool rises = begun_.tangent[N] > 0;
    return parameter > how_.highest || parameter < how_.lowest ||
           (rises ? parameter == how_.highest : parameter == how_.lowest);
  }

  /// What happened between the place before and the one reached, in its order.
  void write_found(Curve& curve) {
    std::ranges::stable_sort(found_, {}, &Found::along);
    for (Found& one : found_) {
      if (one.branching) {
        one.branching->point = static_cast<int>(curve.points.size());
        branchings_.push_back(std::move(*one.branching));
      }
      curve.points.push_back(std::move(one.point));
    }
  }

  /// Where other curves cross, or stability changes without a fold. Unstable directions after the last of
  /// them; nothing where what changed over the stride did not change on it: it led to another curve.
  std::optional<int> note_crossings(const CurveSigns& next, double stride, bool is_fold,
                                    bool notes_branchings) {
    CurveSigns last = last_;
    tracer_.before() = begun_;
    double along = 0;
    constexpr int most = 12;
    for (int k = 0; k < most && along < stride; ++k) {
      const int gained = next.unstable - last.unstable;
      const bool crosses = last.is_odd != next.is_odd;
      // a fold alone changes one direction at fixed λ; where A is not symmetric its symmetric part, which
      // counts them, loses it before
      if (!crosses && (gained == 0 || (is_fold && std::abs(gained) == 1 && problem_.is_symmetric()))) break;
      const auto sign = [&] {
        const CurveSigns here = tracer_.signs();
        return here.is_odd != last.is_odd || here.unstable != last.unstable ? 1.0 : -1.0;
      };
      const auto there = tracer_.locate(begun_.tangent, stride - along, sign, false);
      if (!there) return {};
      along += *there;
      const CurveSigns beyond = tracer_.signs();
      auto mark = mark_of(last, beyond, is_fold);
      if (mark == CurveMark::none && stride - along > 1e-7 * tracer_.size()) mark = CurveMark::stability;
      if (mark == CurveMark::none) break;  // the fold, at the end
      Found one{along, point(mark, last.unstable), {}};
      if (mark == CurveMark::bifurcation && notes_branchings && how_.follows_branches)
        one.branching = branching();
      found_.push_back(std::move(one));
      tracer_.save(tracer_.before());
      last = beyond;
    }
    return last.unstable;
  }

  CurveMark mark_of(const CurveSigns& last, const CurveSigns& beyond, bool is_fold) const {
    if (tracer_.null_space(null_tolerance).multiplicity > 0 && (last.along > 0) == (beyond.along > 0))
      return CurveMark::bifurcation;
    if (beyond.own != last.own) return CurveMark::own_bifurcation;
    if (beyond.is_odd != last.is_odd) return CurveMark::bifurcation;
    return is_fold && std::abs(beyond.unstable - last.unstable) == 1 ? CurveMark::none  // the fold itself
                                                                     : CurveMark::stability;
  }

  /// Of the point where the tracer is: directions in which other curves may leave.
  Branching branching() {
    const auto [vectors, multiplicity] = tracer_.null_space(null_tolerance);
    Branching one{problem_.place(), {}, 0};
    tracer_.save(one.place);
    // of the null space what is square to the curve
    const Step along = tracer_.before().tangent;
    std::vector<Step> basis;
    for (int k = N; k >= N - multiplicity && static_cast<int>(basis.size()) < multiplicity; --k) {
      Step v = vectors.col(k) - along * dot(along, Step(vectors.col(k)));
      for (const Step& other : basis) v -= other * dot(other, v);
      if (v.norm() > 0.1) basis.push_back(v.normalized());
    }
    constexpr int around = 24;  // directions in a plane of them: more than symmetry has branches
    for (int k = 0; k < (basis.size() < 2 ? 2 : around) && !basis.empty(); ++k) {
      const double angle = 2 * std::numbers::pi * k / (basis.size() < 2 ? 2 : around);
      one.directions.push_back(basis.size() < 2
                                   ? Step(k == 0 ? basis[0] : Step(-basis[0]))
                                   : Step(std::cos(angle) * basis[0] + std::sin(angle) * basis[1]));
    }
    return one;
  }

  /// From a bifurcation onto another curve: a step of one length or another leads there.
  bool step_aside(const Place& place, const Step& direction) {
    for (const double stride : {1.0, 2.0, 0.5, 4.0, 0.25}) {
      tracer_.restore(place);
      if (tracer_.advance(direction, stride * first_stride * tracer_.size(), 2)) return true;
    }
    return false;
  }

  /// Whether no other curve is to be begun, and why: on request, or since memory is not endless.
  std::optional<CurveStop> why_no_more(const std::vector<Curve>& curves) const {
    if (stop_.stop_requested()) return CurveStop::stopped;
    std::size_t points = 0;
    for (const Curve& curve : curves) points += curve.points.size();
    return points < static_cast<std::size_t>(how_.max_total_points) ? std::nullopt
                                                                    : std::optional(CurveStop::not_followed);
  }

  /// The curves that leave the first one there. Where no more are begun, one that has not left it stands for
  /// those that were not looked for.
  void leave(Branching& one, std::vector<Curve>& curves) {
    std::vector<Vec<double, N>> begun;
    Curve curve;
    curve.from_curve = 0;
    curve.from_point = one.point;
    for (const Step& direction : one.directions) {
      if (const auto why = why_no_more(curves)) {
        curve.points.push_back(curves[0].points[static_cast<std::size_t>(one.point)]);
        curve.end = problem_.end_of(*why);
        curves.push_back(std::move(curve));
        return;
      }
      if (!step_aside(one.place, direction)) continue;
      const Vec<double, N> way = problem_.way_from(one.place.state);
      constexpr double same = 0.95;  // cosine; by symmetry they are 60 degrees apart or more
      if (std::ranges::any_of(begun, [&](const auto& other) { return dot(other, way) > same; })) continue;
      begun.push_back(way);
      curves.push_back(curve);
      write(curves.back(), CurveMark::none);
      follow(curves.back(), false);
    }
  }

  static CurveMark mark_of(double parameter) {
    return parameter == 1 ? CurveMark::target : parameter == 0 ? CurveMark::begin : CurveMark::none;
  }

  /// The points with the parameter of the beginning and of the target. Whether the curve has been there.
  bool note_marks(const Curve& curve, double stride) {
    bool is_closed = false;
    for (const double mark : {0.0, 1.0}) {
      if ((begun_.lambda < mark) == (reached_.lambda < mark) || begun_.lambda == mark ||
          reached_.lambda == mark)
        continue;
      const auto there = tracer_.settle_between(begun_, stride, mark);
      if (!there) continue;
      found_.push_back({*there, point(mark_of(mark), problem_.signs().unstable), {}});
      const Point& now = found_.back().point;
      for (const Point& other : curve.points)
        is_closed = is_closed || (other.event == now.event && problem_.is_same(other, now));
    }
    return is_closed;
  }

  Tracer<Problem>& tracer_;
  const Problem& problem_;
  CurveRange how_;
  StopToken stop_;
  Place first_, reached_{first_}, begun_{first_};  ///< `begun_`: where a step began
  CurveSigns last_;                                ///< there
  std::vector<Branching> branchings_;
  /// Met within one step, so far along it.
  struct Found {
    double along;
    Point point;
    std::optional<Branching> branching;
  };
  std::vector<Found> found_;
};

}  // namespace sinew::inline v1
