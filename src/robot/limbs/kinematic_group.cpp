#include "robot/limbs/kinematic_group.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "leg/input_limits.hpp"
#include "leg/leg_curvature.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {
namespace {

template <class LegT>
typename LegT::Coordinates commanded(const LegT& leg, const LegPlace& place, Numbers inputs) {
  return leg.coordinates_of(inputs.subspan(at(place.input), LegT::inputs));
}

/// Of the last input of a leg, which moves its link.
template <class LegT>
void say_beyond_domain(const LegT& leg, int input, double value, Report& report) {
  auto& text = report.message;
  report.status = Status::left_domain;
  text.append("inputs[");
  append_number(text, input);
  text.append(std::isfinite(value) ? "] = " : "] is ");
  append_mm(text, value);
  text.append(std::isfinite(value) ? " " : ", which ");
  text.append(LegT::Link::beyond_domain);
  if constexpr (HasArc<typename LegT::Link>) {
    const auto [least, most] = input_limits(leg);
    text.append("; give a length between ");
    append_mm(text, least);
    text.append(" and ");
    append_mm(text, most);
  }
}

}  // namespace

template <class Any>
Report KinematicGroup<Any>::to_coordinates(Numbers inputs, std::span<double> coordinates) const {
  Report report;
  robot_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
    const auto q = commanded(leg, place, inputs);
    std::copy(q.begin(), q.end(), coordinates.begin() + place.coordinate);
    if (report.ok() && !leg.in_domain(q))
      say_beyond_domain(leg, place.input + L::inputs - 1, inputs[at(place.input + L::inputs - 1)], report);
  });
  return report;
}

template <class Any>
void KinematicGroup<Any>::to_inputs(Numbers coordinates, std::span<double> inputs) const {
  robot_.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int) {
    const auto a = leg.inputs_of(own_coordinates(leg, place, coordinates));
    std::copy(a.begin(), a.end(), inputs.begin() + place.input);
  });
}

template <class Any>
bool KinematicGroup<Any>::in_domain(int input, double value) const {
  bool is = std::isfinite(value);
  robot_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
    if (input < place.input || input >= place.input + L::inputs || !is) return;
    std::array<double, std::size_t{L::inputs}> inputs;
    inputs.fill(value);
    is = leg.in_domain(leg.coordinates_of(inputs));
  });
  return is;
}

template <class Any>
auto KinematicGroup<Any>::evaluate(const Frame& platform, Numbers coordinates, const Rows& rows) const
    -> ClosureError {
  constexpr std::size_t dof = Space::dof;
  const std::size_t inputs = at(robot_.total.input);
  std::ranges::fill(rows.K, 0.0);
  ClosureError closure_error;
  robot_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int i) {
    const auto q = own_coordinates(leg, place, coordinates);
    const auto blocks = leg.template blocks<double>(platform, leg.template tip<double>(q));
    const Mat<double, L::rows, L::inputs> g_a = blocks.g_q * leg.input_rate();
    for (int k = 0; k < L::rows; ++k) {
      const std::size_t row = at(place.template row_of<L>(k));
      for (int j = 0; j < Space::dof; ++j) rows.J[row * dof + at(j)] = blocks.g_x(k, j);
      for (int j = 0; j < L::inputs; ++j) rows.K[row * inputs + at(place.input + j)] = -g_a(k, j);
      rows.s[row] = -blocks.g[k];
    }
    double distance = L::closure_error(blocks);
    if (!std::isfinite(distance)) distance = std::numeric_limits<double>::infinity();
    if (distance > closure_error.distance) closure_error = {distance, i};
  });
  return closure_error;
}

template <class Any>
void KinematicGroup<Any>::curvature(const Frame& platform, Numbers coordinates, Numbers multipliers,
                                    Change& by_platform, ChangeByInput& by_input) const {
  by_platform.setZero();
  by_input.setZero(Space::dof, robot_.total.input);
  robot_.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
    Vec<double, L::rows> own;
    for (int k = 0; k < L::rows; ++k) own[k] = multipliers[at(place.template row_of<L>(k))];
    const auto change = leg_curvature(leg, platform, own_coordinates(leg, place, coordinates), own);
    by_platform += change.by_platform;
    by_input.template middleCols<L::inputs>(place.input) += change.by_coordinates * leg.input_rate();
  });
}

template <class Any>
bool KinematicGroup<Any>::close_at(const Frame& platform, std::span<double> inputs) const {
  bool closes = true;
  robot_.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int) {
    const auto nearest = leg.nearest_solution(platform, SolutionPreference{});
    closes = closes && nearest.count > 0;
    if (nearest.count < 1) return;
    const auto a = leg.inputs_of(nearest.q);
    std::copy(a.begin(), a.end(), inputs.begin() + place.input);
  });
  return closes;
}

template class KinematicGroup<AnyPlanarLeg>;
template class KinematicGroup<AnySpatialLeg>;

}  // namespace sinew::inline v1
