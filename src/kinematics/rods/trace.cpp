#include "kinematics/rods/trace.hpp"

#include <cmath>

#include "kinematics/rods/curve_problem.hpp"

namespace sinew::inline v1 {
namespace {

/// In the first two places of the memory.
Tracer<RodProblem> tracer_of(RodWork& work, const RodWay& way, double parameter) {
  return {RodProblem(*work.system, way), parameter, work.places[0], work.places[1]};
}

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
  const Vec<double, 6> way = twist_between(from, to);
  return {from.p + parameter * way.head<3>(), SO3<double>::exp(parameter * way.tail<3>()).compose(from.R)};
}

std::vector<EquilibriumCurve> trace_rods(RodWork& work, const RodWay& way, const CurveOptions& how) {
  auto tracer = tracer_of(work, way, 0);
  const CurveRange range{how.lowest,      how.highest,          how.max_points,
                         how.is_backward, how.follows_branches, how.max_total_points};
  return CurveWriter<RodProblem>(tracer, range, work.stop).run();
}

namespace {

/// Steps along the curve until `is_done(stride)` after one of them; false where none succeeds. Over a long
/// step signs may not change: it may have led to a curve that passes near by.
template <class IsDone>
bool walk_on(RodWork& work, Tracer<RodProblem>& tracer, int most, IsDone&& is_done) {
  const double size = tracer.size();
  bool is_odd = tracer.signs().is_odd;
  int taken = 0;
  const auto step = [&](double stride) {
    if (!tracer.step(stride)) return CurveStep::failed;
    const bool now = tracer.signs().is_odd;
    if (now != is_odd && stride > tracer.shortest_verified * size) return CurveStep::failed;
    is_odd = now;
    ++taken;
    return is_done(stride) ? CurveStep::last : CurveStep::taken;
  };
  return walk(
             tracer, work.places[3], {1e-3 * size, 1e-8 * size, work.stop}, [&] { return taken < most; },
             [&] { return 0.05 * size; }, step) == StepsEnd::done;
}

}  // namespace

RodFold find_fold(RodWork& work, const RodWay& way, double parameter) {
  auto tracer = tracer_of(work, way, parameter);
  auto &start = work.places[2], &begun = work.places[3];
  tracer.save(start);
  RodFold fold;
  const auto is_beyond = [&](double stride) {
    const bool turns = tracer.along() <= 0;
    if (!turns && tracer.lambda() < 1) return false;
    if (turns) {
      const auto there = tracer.locate(begun.tangent, stride, [&] { return tracer.along(); });
      if (!there) return true;  // lost: none is claimed
      stride = *there;
    }
    if (tracer.lambda() >= 1) {  // before it turns
      fold.arrived = tracer.settle_between(begun, stride, 1).has_value();
      return true;
    }
    fold.is_found = turns;
    fold.parameter = tracer.lambda();
    fold.platform = work.system->platform();
    return true;
  };
  walk_on(work, tracer, 200, is_beyond);
  fold.residual = tracer.residual();
  if (!fold.arrived) tracer.restore(start);
  return fold;
}

bool pass_fold(RodWork& work, const RodWay& way, double parameter) {
  constexpr double longest_rod = 3;
  auto tracer = tracer_of(work, way, parameter);
  auto& start = work.places[2];
  tracer.save(start);
  bool arrives = false;
  walk_on(work, tracer, 200, [&](double stride) {
    if (tracer.problem().is_far(longest_rod)) return true;
    if (tracer.lambda() < 1) return false;
    arrives = tracer.settle_between(work.places[3], stride, 1).has_value();
    return true;
  });
  if (!arrives) tracer.restore(start);
  return arrives;
}

}  // namespace sinew::inline v1
