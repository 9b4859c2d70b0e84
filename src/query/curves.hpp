/// @file curves.hpp
/// Curves of equilibria as they are asked for and answered, of rods and of chains.
#pragma once
#include <algorithm>

#include "query/context.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"

namespace sinew::inline v1 {

/// `range`, `samples`, `backward` and `branches` into the options of a curve.
template <class Options>
void read_extent(Context& context, Options& how) {
  constexpr int max_points = 20000;
  if (const auto range = context.query.optional("range")) {
    const auto ends = range->items(2);
    if (ends.size() == 2) {
      how.lowest = ends[0].number({.high = 0});
      how.highest = ends[1].number({.low = 0});
    }
  }
  if (const auto samples = context.query.optional("samples"))
    how.max_points = samples->integer(Range::between(2, max_points));
  if (const auto backward = context.query.optional("backward")) {
    how.is_backward = backward->boolean();
    if (how.is_backward && how.lowest == 0)
      backward->fail("no_effect", "the curve would leave its range at once; give range, from below 0");
  }
  if (const auto branches = context.query.optional("branches")) how.follows_branches = branches->boolean();
}

/// Why the first curve, which ends so, does not come to its target; @param fold where it folds, if it does.
std::string curve_in_words(CurveEnd end, const double* fold);
/// That at so many bifurcations other curves were not looked for, since all have so many points already.
std::string unfollowed_in_words(std::size_t bifurcations, std::size_t points);
/// Notes it where a curve was stopped.
void note_stopped_curve(Context& context);

template <class Point>
void put_stability(Value& row, const Point& point) {
  row["stable"] = point.unstable_directions == 0;
  row["unstable_directions"] = point.unstable_directions;
}

/// @param where_of(point) pose and inputs of a point, as they are answered
template <class Curve, class WhereOf>
Value curve_value(const Curve& curve, WhereOf&& where_of) {
  Value answer;
  if (curve.from_curve >= 0) answer["from"] = {{"curve", curve.from_curve}, {"row", curve.from_point}};
  answer["why"] = to_string(curve.end);
  Value rows = Value::list();
  for (const auto& point : curve.points) {
    Value row{{"parameter", point.parameter}};
    row.merge(where_of(point));
    put_stability(row, point);
    row["residual"] = point.residual;
    put_number(row, "potential", point.potential);
    if (point.event != CurveEvent::none) row["event"] = to_string(point.event);
    rows.push_back(std::move(row));
  }
  answer["rows"] = std::move(rows);
  return answer;
}

/// All curves, and every equilibrium on them at the target.
template <class Curve, class WhereOf>
void put_curves(Context& context, const std::vector<Curve>& curves, WhereOf&& where_of) {
  Value &answer = context.answer, equilibria = Value::list(), list = Value::list();
  bool arrives = false, is_stopped = false;
  double worst = 0;
  std::size_t points = 0, unfollowed = 0;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    is_stopped = is_stopped || curves[c].end == CurveEnd::stopped;
    if (curves[c].end == CurveEnd::not_followed)
      ++unfollowed;
    else
      points += curves[c].points.size();
    for (std::size_t k = 0; k < curves[c].points.size(); ++k) {
      const auto& point = curves[c].points[k];
      worst = std::max(worst, point.residual);
      if (point.event != CurveEvent::target) continue;
      arrives = arrives || c == 0;
      Value one{{"curve", c}, {"row", k}};
      one.merge(where_of(point));
      put_stability(one, point);
      equilibria.push_back(std::move(one));
    }
    list.push_back(curve_value(curves[c], where_of));
  }
  answer["status"] = to_string(arrives ? Status::converged : Status::singular);
  answer.erase("message");
  const auto& first = curves.front();
  using Point = typename decltype(Curve::points)::value_type;
  const auto fold = std::ranges::find(first.points, CurveEvent::fold, &Point::event);
  if (!arrives)
    answer["message"] = curve_in_words(first.end, fold == first.points.end() ? nullptr : &fold->parameter);
  if (is_stopped) note_stopped_curve(context);
  if (unfollowed > 0) context.add_message(unfollowed_in_words(unfollowed, points));
  answer["residual"] = worst;
  answer["equilibria"] = std::move(equilibria);
  answer["curves"] = std::move(list);
}

}  // namespace sinew::inline v1
