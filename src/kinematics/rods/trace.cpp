#include "kinematics/rods/trace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "base/at.hpp"
#include "kinematics/rods/energy.hpp"
#include "kinematics/rods/tracer.hpp"
#include "kinematics/rods/verdict.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v0 {
namespace {

using Step = Vec<double, 7>;
using Signs = CurveSigns;

/// Under one the stiffness is no symmetric matrix.
template <class System>
bool has_moment(const System& system) {
  return system.wrench().template tail<3>() != Vec3<double>::Zero();
}

/// Follows curves and writes down what is met.
template <class System>
class CurveWriter {
 public:
  CurveWriter(RodWorkOf<System>& work, const RodWay& way, const CurveOptions& how)
      : system_(work.system),
        how_(how),
        stop_(work.stop),
        tracer_(work, way, 0),
        first_{system_.snapshot()} {}

  std::vector<EquilibriumCurve> run() {
    tracer_.save(first_);
    if (how_.is_backward) first_.tangent = -first_.tangent;
    std::vector<EquilibriumCurve> curves(1);
    tracer_.restore(first_);
    write(curves[0], CurveEvent::begin);
    follow(curves[0], true);
    if (!how_.follows_branches) return curves;
    std::vector<Branching> found;
    found.swap(branchings_);
    for (Branching& one : found) leave(one, curves);
    return curves;
  }

 private:
  using Place = RodPlace<System>;
  /// Where other curves cross the first: the state, directions square to it, and which point it is.
  struct Branching {
    Place place;
    std::vector<Step> directions;
    int point;
  };

  static constexpr double first_stride = 0.01, longest_stride = 0.05, shortest_stride = 1e-7;
  static constexpr double longest_rod = 10, null_tolerance = 0.1;
  static constexpr int most_curves = 64;

  /// Where the tracer is. @param unstable directions; −1: those there
  CurvePoint point(CurveEvent event, int unstable = -1) const {
    CurvePoint point;
    point.parameter = tracer_.lambda();
    point.event = event;
    point.pose = spatial_pose(system_.platform());
    point.inputs.resize(at(system_.inputs()));
    for (int k = 0; k < system_.feeds(); ++k) point.inputs[at(system_.input_of(k))] = system_.length(k);
    point.unstable_directions = unstable >= 0 ? unstable : unstable_directions(system_);
    point.residual = tracer_.residual();
    point.potential = potential_of(system_);
    return point;
  }
  void write(EquilibriumCurve& curve, CurveEvent event, int unstable = -1) {
    curve.points.push_back(point(event, unstable));
  }

  /// On from where the tracer is, until the curve ends.
  void follow(EquilibriumCurve& curve, bool notes_branchings) {
    double stride = first_stride * tracer_.size();
    const double longest = longest_stride * tracer_.size();
    Place& before = tracer_.before();
    Signs last = tracer_.signs();
    curve.end = CurveEnd::max_points;
    while (static_cast<int>(curve.points.size()) < how_.max_points) {
      if (stop_.stop_requested()) {
        curve.end = CurveEnd::stopped;
        return;
      }
      tracer_.save(before);
      begun_ = before;
      const double taken = stride;
      const bool was_written = step(curve, last, stride, notes_branchings);
      if (was_written && curve.end != CurveEnd::max_points) return;
      if (was_written) {
        stride = taken;
        if (is_far()) {
          curve.end = CurveEnd::far;
          return;
        }
        if (tracer_.corrections() <= 3) stride = std::min(1.6 * stride, longest);
        continue;
      }
      tracer_.restore(begun_);
      stride = taken / 3;
      if (stride > shortest_stride * tracer_.size()) continue;
      curve.end = why_stuck();
      return;
    }
  }

  /// One stride from `begun_`, or less of it where something ends there, with all that happened on it. False,
  /// with the state lost and nothing written, where none is found that stays on the curve.
  bool step(EquilibriumCurve& curve, Signs& last, double stride, bool notes_branchings) {
    const Step ahead = begun_.tangent;
    if (!tracer_.step(stride)) return false;
    CurveEvent event = CurveEvent::none;
    // a step ends at a fold at the latest, so that λ goes one way in it
    if ((last.along > 0) != (tracer_.tangent()[6] > 0)) {
      const auto there = tracer_.locate(ahead, stride, [&] { return tracer_.tangent()[6]; });
      if (!there) return false;
      event = CurveEvent::fold;
      stride = *there;
    }
    CurveEnd end = CurveEnd::max_points;
    if (ends_range(tracer_.lambda())) {
      const double bound = tracer_.lambda() >= how_.highest ? how_.highest : how_.lowest;
      tracer_.before() = begun_;
      const auto there = tracer_.locate(ahead, stride, [&] { return tracer_.lambda() - bound; });
      if (!there || !tracer_.settle_at(bound)) return false;
      stride = *there;
      event = mark_of(bound);
      end = CurveEnd::left_range;
    }
    const Signs next = tracer_.signs();
    tracer_.save(reached_);
    const auto unstable = note_events(curve, last, next, stride, notes_branchings);
    if (!unstable) return false;
    tracer_.restore(reached_);
    write(curve, event, event == CurveEvent::fold ? *unstable : next.unstable);
    if (curve.end == CurveEnd::max_points) curve.end = end;
    last = next;
    return true;
  }

  bool is_far() const {
    for (int k = 0; k < system_.rods(); ++k)
      if (system_.length(k) > longest_rod * tracer_.size()) return true;
    return false;
  }

  CurveEnd why_stuck() const {
    if (system_.is_finest() && system_.truncation() > coarse_truncation) return CurveEnd::sharp;
    return is_pulled_straight(system_) ? CurveEnd::straight : CurveEnd::stalled;
  }

  /// On an end of the range and on the way out, or beyond it.
  bool ends_range(double parameter) const {
    const bool rises = begun_.tangent[6] > 0;
    return parameter > how_.highest || parameter < how_.lowest ||
           (rises ? parameter == how_.highest : parameter == how_.lowest);
  }

  /// What happened between the place before and the one reached, in its order. Unstable directions before the
  /// latter; nothing where the place reached is not on the curve.
  std::optional<int> note_events(EquilibriumCurve& curve, const Signs& last, const Signs& next, double stride,
                                 bool notes_branchings) {
    found_.clear();
    const auto unstable = note_crossings(last, next, stride, notes_branchings);
    if (!unstable) return {};
    note_marks(curve, stride);
    std::ranges::stable_sort(found_, {}, &Found::along);
    for (Found& one : found_) {
      if (one.branching) {
        one.branching->point = static_cast<int>(curve.points.size());
        branchings_.push_back(std::move(*one.branching));
      }
      curve.points.push_back(std::move(one.point));
    }
    return unstable;
  }

  /// Where other curves cross, or stability changes without a fold. Unstable directions after the last of
  /// them; nothing where what changed over the stride did not change on it: it led to another curve.
  std::optional<int> note_crossings(Signs last, const Signs& next, double stride, bool notes_branchings) {
    const bool is_fold = (last.along > 0) != (next.along > 0);
    tracer_.before() = begun_;
    double along = 0;
    constexpr int most = 12;
    for (int k = 0; k < most && along < stride; ++k) {
      const int gained = next.unstable - last.unstable;
      const bool crosses = last.is_odd != next.is_odd;
      // a fold alone changes one direction of a robot whose inputs are held; under a moment the symmetric
      // part of the stiffness, which counts them, loses it before
      if (!crosses && (gained == 0 || (is_fold && std::abs(gained) == 1 && !has_moment(system_)))) break;
      const auto sign = [&] {
        const Signs here = tracer_.signs();
        return here.is_odd != last.is_odd || here.unstable != last.unstable ? 1.0 : -1.0;
      };
      const auto there = tracer_.locate(begun_.tangent, stride - along, sign, false);
      if (!there) return {};
      along += *there;
      const Signs beyond = tracer_.signs();
      auto event = event_of(last, beyond, is_fold);
      if (event == CurveEvent::none && stride - along > 1e-7 * tracer_.size()) event = CurveEvent::stability;
      if (event == CurveEvent::none) break;  // the fold, at the end
      Found one{along, point(event, last.unstable), {}};
      if (event == CurveEvent::bifurcation && notes_branchings && how_.follows_branches)
        one.branching = branching();
      found_.push_back(std::move(one));
      tracer_.save(tracer_.before());
      last = beyond;
    }
    return last.unstable;
  }

  CurveEvent event_of(const Signs& last, const Signs& beyond, bool is_fold) const {
    if (tracer_.null_space(null_tolerance).multiplicity > 0 && (last.along > 0) == (beyond.along > 0))
      return CurveEvent::bifurcation;
    if (beyond.own != last.own) return CurveEvent::rod_bifurcation;
    if (beyond.is_odd != last.is_odd) return CurveEvent::bifurcation;
    return is_fold && std::abs(beyond.unstable - last.unstable) == 1 ? CurveEvent::none  // the fold itself
                                                                     : CurveEvent::stability;
  }

  /// Of the point where the tracer is: directions in which other curves may leave.
  Branching branching() {
    const auto [vectors, multiplicity] = tracer_.null_space(null_tolerance);
    Branching one{{system_.snapshot()}, {}, 0};
    tracer_.save(one.place);
    // of the null space what is square to the curve
    const Step along = tracer_.before().tangent;
    std::vector<Step> basis;
    for (int k = 6; k >= 6 - multiplicity && static_cast<int>(basis.size()) < multiplicity; --k) {
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

  /// The curves that leave the first one there.
  void leave(Branching& one, std::vector<EquilibriumCurve>& curves) {
    std::vector<Vec<double, 6>> begun;
    for (const Step& direction : one.directions) {
      if (curves.size() >= most_curves || stop_.stop_requested()) return;
      if (!step_aside(one.place, direction)) continue;
      const SE3<double> from = one.place.state.platform, here = system_.platform();
      Vec<double, 6> way;
      way << here.p - from.p, system_.radius() * here.R.compose(from.R.inverse()).log();
      way.normalize();
      constexpr double same = 0.95;  // cosine; by symmetry they are 60 degrees apart or more
      if (std::ranges::any_of(begun, [&](const auto& other) { return dot(other, way) > same; })) continue;
      begun.push_back(way);
      EquilibriumCurve curve;
      curve.from_curve = 0;
      curve.from_point = one.point;
      write(curve, CurveEvent::none);
      follow(curve, false);
      curves.push_back(std::move(curve));
    }
  }

  static CurveEvent mark_of(double parameter) {
    return parameter == 1 ? CurveEvent::target : parameter == 0 ? CurveEvent::begin : CurveEvent::none;
  }

  bool is_same(const CurvePoint& one, const CurvePoint& other) const {
    double apart = (one.pose.position - other.pose.position).norm();
    for (std::size_t k = 0; k < one.inputs.size(); ++k)
      apart = std::max(apart, std::abs(one.inputs[k] - other.inputs[k]));
    return apart < 1e-8 * tracer_.size();
  }

  /// The equilibria with the parameter of the beginning and of the target.
  void note_marks(EquilibriumCurve& curve, double stride) {
    for (const double mark : {0.0, 1.0}) {
      if ((begun_.lambda < mark) == (reached_.lambda < mark) || begun_.lambda == mark ||
          reached_.lambda == mark)
        continue;
      tracer_.before() = begun_;
      const auto there = tracer_.locate(begun_.tangent, stride, [&] { return tracer_.lambda() - mark; });
      if (!there || !tracer_.settle_at(mark)) continue;
      found_.push_back({*there, point(mark_of(mark), -1), {}});
      const CurvePoint& now = found_.back().point;
      for (const CurvePoint& other : curve.points)
        if (other.event == now.event && is_same(other, now)) curve.end = CurveEnd::closed;
    }
  }

  System& system_;
  const CurveOptions& how_;
  StopToken stop_;
  Tracer<System> tracer_;
  Place first_, reached_{first_}, begun_{first_};  ///< `begun_`: where a step began
  std::vector<Branching> branchings_;
  /// Met within one step, so far along it.
  struct Found {
    double along;
    CurvePoint point;
    std::optional<Branching> branching;
  };
  std::vector<Found> found_;
};

}  // namespace

RodTarget RodWay::at(double parameter, int rods) const {
  RodTarget now;
  for (std::size_t k = 0; k < static_cast<std::size_t>(rods); ++k)
    now.lengths[k] = std::lerp(begin.lengths[k], target.lengths[k], parameter);
  now.wrench = begin.wrench + parameter * (target.wrench - begin.wrench);
  return now;
}

SE3<double> RodWay::pose(double parameter) const {
  if (parameter == 1) return to;
  const Vec<double, 6> way = between(from, to);
  return {from.p + parameter * way.head<3>(), SO3<double>::exp(parameter * way.tail<3>()).compose(from.R)};
}

template <class System>
std::vector<EquilibriumCurve> trace_rods(RodWorkOf<System>& work, const RodWay& way,
                                         const CurveOptions& how) {
  return CurveWriter<System>(work, way, how).run();
}

namespace {

/// Steps along the curve until `is_done(direction, stride)` after one of them, or no step succeeds; false
/// then. Over a long step signs may not change: it may have led to a curve that passes near by.
template <class System, class IsDone>
bool walk(Tracer<System>& tracer, StopToken stop, int most, IsDone&& is_done) {
  double stride = 1e-3 * tracer.size();
  bool is_odd = tracer.signs().is_odd;
  for (int k = 0; k < most && stride > 1e-8 * tracer.size() && !stop.stop_requested();) {
    tracer.save(tracer.before());
    const Step ahead = tracer.before().tangent;
    const bool is_reached = tracer.step(stride);
    const bool now = is_reached && tracer.signs().is_odd;
    const bool crosses = is_reached && now != is_odd && stride > tracer.shortest_verified * tracer.size();
    if (!is_reached || crosses) {
      tracer.restore(tracer.before());
      stride /= 3;
      continue;
    }
    is_odd = now;
    if (is_done(ahead, stride)) return true;
    if (tracer.corrections() <= 3) stride = std::min(1.6 * stride, 0.05 * tracer.size());
    ++k;
  }
  return false;
}

}  // namespace

template <class System>
RodFold find_fold(RodWorkOf<System>& work, const RodWay& way, double parameter) {
  Tracer<System> tracer(work, way, parameter);
  auto &start = work.places[2], &begun = work.places[3];
  tracer.save(start);
  RodFold fold;
  const auto is_beyond = [&](const Step& ahead, double stride) {
    const bool turns = tracer.tangent()[6] <= 0;
    if (!turns && tracer.lambda() < 1) return false;
    begun = tracer.before();
    if (turns) {
      const auto there = tracer.locate(ahead, stride, [&] { return tracer.tangent()[6]; });
      if (!there) return true;  // lost: none is claimed
      stride = *there;
    }
    if (tracer.lambda() >= 1) {  // before it turns
      tracer.before() = begun;
      fold.arrived = tracer.locate(ahead, stride, [&] { return tracer.lambda() - 1; }) && tracer.settle_at(1);
      return true;
    }
    fold.is_found = turns;
    fold.parameter = tracer.lambda();
    fold.platform = work.system.platform();
    return true;
  };
  constexpr int most = std::is_base_of_v<GeneralSystem, System> ? 40 : 200;
  walk(tracer, work.stop, most, is_beyond);
  fold.residual = tracer.residual();
  if (!fold.arrived) tracer.restore(start);
  return fold;
}

template <class System>
bool pass_fold(RodWorkOf<System>& work, const RodWay& way, double parameter) {
  constexpr double longest_rod = 3;
  Tracer<System> tracer(work, way, parameter);
  auto& start = work.places[2];
  tracer.save(start);
  bool arrives = false;
  const auto is_done = [&](const Step& ahead, double stride) {
    for (int k = 0; k < work.system.rods(); ++k)
      if (work.system.length(k) > longest_rod * tracer.size()) return true;
    if (tracer.lambda() < 1) return false;
    arrives = tracer.locate(ahead, stride, [&] { return tracer.lambda() - 1; }) && tracer.settle_at(1);
    return true;
  };
  walk(tracer, work.stop, 200, is_done);
  if (!arrives) tracer.restore(start);
  return arrives;
}

namespace {

/// Directions in which the whole gives way by itself: those of its rods, and of the platform's stiffness over
/// its radius the eigenvalues left of zero. Under a moment that is no symmetric matrix, and what its
/// symmetric part says is more.
template <class System>
int giving_way(const System& system, const CurveSigns& signs) {
  if (signs.unstable == 0) return 0;  // whose symmetric part is definite
  const auto stiffness = system.stiffness();
  Eigen::Matrix<double, 6, 6> scaled;
  const double radius = system.radius();
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c)
      scaled(r, c) = stiffness(r, c) / ((r < 3 ? 1 : radius) * (c < 3 ? 1 : radius));
  const Eigen::EigenSolver<Eigen::Matrix<double, 6, 6>> solved(scaled, false);
  int count = signs.own;
  for (int k = 0; k < 6; ++k) count += solved.eigenvalues()[k].real() < 0;
  return count;
}

/// A load that grows, by arc length.
template <class System>
class LoadWalk {
 public:
  LoadWalk(RodWorkOf<System>& work, const RodWay& way, double highest)
      : work_(work),
        system_(work.system),
        tracer_(work, way, 0),
        begun_(work.places[2]),
        highest_(highest) {}

  RodLoad run() {
    tracer_.save(begun_);
    last_ = signs();
    first_ = last_;
    double stride = 0.01 * tracer_.size();
    constexpr int most = std::is_base_of_v<GeneralSystem, System> ? 400 : 4000;
    for (int k = 0; k < most; ++k) {
      if (work_.stop.stop_requested()) return end(LoadEnd::stopped);
      const auto what = step(stride);
      if (what == Found::end) return load_;
      if (what == Found::nothing) {
        tracer_.restore(begun_);
        stride /= 3;
        if (!(stride > 1e-8 * tracer_.size())) return end(why_stuck());
        continue;
      }
      tracer_.save(begun_);
      if (tracer_.corrections() <= 3) stride = std::min(1.6 * stride, longest());
    }
    return end(LoadEnd::iterations);
  }

 private:
  enum class Found { nothing, step, end };
  struct Signs : CurveSigns {
    int giving_way = 0;
  };
  Signs signs() {
    Signs signs{tracer_.signs()};
    signs.giving_way = v0::giving_way(system_, signs);
    return signs;
  }

  /// The platform moves so far at most; where it hardly moves the load grows by a quarter.
  double longest() const {
    const Step& t = tracer_.tangent();
    const double least = 0.05 * tracer_.size(), load = std::abs(t[6]), moved = t.head<6>().norm();
    return std::max(least, std::min(least / moved, 0.25 * tracer_.lambda() * tracer_.scale() / load));
  }

  RodLoad end(LoadEnd why) {
    tracer_.restore(begun_);
    load_.end = why;
    load_.parameter = tracer_.lambda();
    return load_;
  }

  LoadEnd why_stuck() const {
    if (system_.is_finest() && system_.truncation() > coarse_truncation) return LoadEnd::sharp;
    return is_pulled_straight(system_) ? LoadEnd::straight : LoadEnd::stalled;
  }

  bool holds_on(const Signs& here) const {
    return here.along > 0 && here.is_odd == last_.is_odd && here.giving_way <= first_.giving_way;
  }

  Found step(double stride) {
    tracer_.before() = begun_;
    const Step ahead = begun_.tangent;
    if (!tracer_.step(stride)) return Found::nothing;
    bool arrives = tracer_.lambda() >= highest_;
    if (!arrives && tracer_.tangent()[6] <= 0) {  // it may have been there on its way to a fold
      if (!tracer_.locate(ahead, stride, [&] { return tracer_.tangent()[6]; })) return Found::nothing;
      arrives = tracer_.lambda() >= highest_;
      tracer_.before() = begun_;
      if (!arrives) {
        tracer_.restore(begun_);
        if (!tracer_.advance(ahead, stride)) return Found::nothing;
      }
    }
    if (arrives) {
      const auto there = tracer_.locate(ahead, stride, [&] { return tracer_.lambda() - highest_; });
      if (!there || !tracer_.settle_at(highest_)) return Found::nothing;
      stride = *there;
    }
    const Signs next = signs();
    tracer_.save(work_.places[3]);  // what it reached
    if (!note_definiteness(next, ahead, stride)) return Found::nothing;
    if (!holds_on(next)) {
      tracer_.before() = begun_;
      if (!tracer_.locate(
              ahead, stride, [&] { return holds_on(signs()) ? 1.0 : -1.0; }, false))
        return Found::nothing;
      const Signs beyond = signs();
      constexpr double level = 1e-4;  // dλ/ds at a fold, to rounding
      const LoadEnd why = std::abs(beyond.along) < level ? LoadEnd::fold
                          : beyond.is_odd != last_.is_odd || beyond.own != last_.own || !has_moment(system_)
                              ? LoadEnd::bifurcation
                              : LoadEnd::stability;
      begun_ = tracer_.before();  // the last that holds
      end(why);
      forget_definiteness();
      return Found::end;
    }
    tracer_.restore(work_.places[3]);
    last_ = next;
    if (!arrives) return Found::step;
    begun_ = work_.places[3];
    end(LoadEnd::limit);
    load_.parameter = highest_;
    return Found::end;
  }

  /// Where the symmetric part of the stiffness loses its definiteness. False where that is not on the curve.
  bool note_definiteness(const Signs& next, const Step& ahead, double stride) {
    if (load_.definite_until >= 0 || next.unstable <= first_.unstable || !has_moment(system_)) return true;
    tracer_.before() = begun_;
    const auto is_kept = [&] { return tracer_.signs().unstable <= first_.unstable ? 1.0 : -1.0; };
    if (!tracer_.locate(ahead, stride, is_kept, false)) return false;
    load_.definite_until = tracer_.before().lambda;
    return true;
  }
  /// Told only where it is before the end.
  void forget_definiteness() {
    if (load_.definite_until >= load_.parameter * (1 - 1e-9)) load_.definite_until = -1;
  }

  RodWorkOf<System>& work_;
  System& system_;
  Tracer<System> tracer_;
  RodPlace<System>& begun_;
  double highest_;
  Signs first_, last_;
  RodLoad load_;
};

}  // namespace

template <class System>
RodLoad load_rods(RodWorkOf<System>& work, const Vec<double, 6>& direction, double limit) {
  System& system = work.system;
  double unit = 0;  // what bends the rods, roughly
  for (int k = 0; k < system.rods(); ++k) unit += system.stiffness(k) / (system.length(k) * system.length(k));
  const double largest = direction.cwiseAbs().maxCoeff();
  const Vec<double, 6> whole = direction / largest * unit;
  RodWay way{present(system), present(system), false, {}, {}};
  way.target.wrench += whole;
  RodLoad load = LoadWalk<System>(work, way, limit * largest / unit).run();
  const double factor = unit / largest;
  load.parameter = load.end == LoadEnd::limit ? limit : load.parameter * factor;
  if (load.definite_until >= 0) load.definite_until *= factor;
  return load;
}

#define SINEW_FOR(System)                                                                                    \
  template std::vector<EquilibriumCurve> trace_rods(RodWorkOf<System>&, const RodWay&, const CurveOptions&); \
  template RodFold find_fold(RodWorkOf<System>&, const RodWay&, double);                                     \
  template bool pass_fold(RodWorkOf<System>&, const RodWay&, double);                                        \
  template RodLoad load_rods(RodWorkOf<System>&, const Vec<double, 6>&, double);
SINEW_FOR_EACH_ROD_SYSTEM(SINEW_FOR)
#undef SINEW_FOR

}  // namespace sinew::inline v0
