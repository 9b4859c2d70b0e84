/// @file chain_answer.hpp
/// What questions about loaded chains may say, and what is answered about an equilibrium.
#pragma once
#include <cmath>

#include "analysis/chain_shape.hpp"
#include "io/document/reader.hpp"
#include "query/chains/chain_velocity.hpp"
#include "query/chains/chains.hpp"

namespace sinew::inline v1::chains {

/// What every question about loaded chains may say.
template <class Space>
struct Load {
  Wrench<Space> wrench = Wrench<Space>::Zero();
  Wants wanted;
  std::vector<double> twist;        ///< with `velocity`
  std::optional<double> threshold;  ///< of joints, beyond which the linear model is not to be trusted [rad]
  ChainOptions options;
};

template <class Space>
Load<Space> read_load(Context& context) {
  Load<Space> load;
  if (const auto wrench = context.query.optional("wrench")) load.wrench = read_wrench<Space>(*wrench);
  load.wanted = read_wants_of_loads(context);
  load.twist = read_twist<Space>(context, load.wanted);
  if (const auto threshold = context.query.optional("posture_threshold"))
    load.threshold = threshold->quantity(Dimension::angle, Range::positive());
  if (context.max_iterations) load.options.max_iterations = *context.max_iterations;
  return load;
}

/// Lengths [[l₁ or null, l₂ or null], ...]; a tendon without a length is loose.
std::vector<TendonConstraint> read_lengths(const Reader& list, std::size_t legs);
/// Tensions [[T₁, T₂], ...].
std::vector<TendonConstraint> read_tensions(const Reader& list, std::size_t legs);

template <class Space>
Value chain_legs_value(const ChainLegs<Space>& robot, const ChainState<Space>& state) {
  const auto platform = Space::frame(state.pose);
  Value legs = Value::list();
  Value::List angles = angles_value<Space>(robot, state.legs);
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const ChainLegState& leg = state.legs[i];
    legs.push_back({{"angles", std::move(angles[i])},
                    {"chord_force", leg.force},
                    {"tendon_lengths", leg.tendon_length},
                    {"tensions", leg.tension},
                    {"tip_wrench", Value(tip_wrench(robot.legs[i], leg.of(robot.legs[i].chain), platform))}});
    if constexpr (Space::dimension == 2)
      if (robot.has_base_motors) legs.back()["motor_torque"] = motor_torque(robot.legs[i], leg, platform);
  }
  return legs;
}

/// Left out where it is not finite.
template <class Space>
void put_matrix(Value& answer, Value::Key key, const Mat<double, Space::dof, Space::dof>& matrix) {
  const Eigen::Matrix<double, Space::dof, Space::dof, Eigen::RowMajor> rows = matrix;
  if (rows.allFinite()) answer[key] = Value(MatrixView(rows.data(), Space::dof, Space::dof));
}

/// The paper's linear model and constant curvature, beside the answer.
template <class Space>
void put_simpler_models(Context& context, const ChainLegs<Space>& robot, const ChainState<Space>& unloaded,
                        const ChainState<Space>& loaded, const Load<Space>& load, ChainWork& work) {
  Value& answer = context.answer;
  const Vec<double, Space::dof> change = linear_compliance(robot, unloaded) * loaded.wrench,
                                actual = twist_between(unloaded.pose, loaded.pose);
  if (change.allFinite()) answer["linear"] = Value(change);
  double scale = 0, gap = 0;
  for (int k = 0; k < Space::dof; ++k) {
    const double unit = k < Space::dimension ? 1 : robot.platform_radius;
    scale += std::pow(unit * actual[k], 2);
    gap += std::pow(unit * (change[k] - actual[k]), 2);
  }
  if (scale > 0 && loaded.wrench != unloaded.wrench)
    put_number(answer, "linear_error", std::sqrt(gap / scale));
  double posture = 0;
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(robot.legs[i].chain.joints()); ++j)
      posture = std::max(posture, std::abs(loaded.legs[i].angles[j] - unloaded.legs[i].angles[j]));
  answer["posture_error"] = posture;
  if (load.threshold) answer["linear_valid"] = posture <= *load.threshold;

  std::size_t held = 0;
  for (const TendonConstraint& hold : loaded.hold) held += hold.length_of >= 0 ? 1 : 0;
  ChainState<Space> even = unloaded;
  if (held == 0) {
    ChainOptions options = load.options;
    options.evenly_bent = true;
    if (!equilibrium(robot, loaded.hold, loaded.wrench, even, work, options).ok()) return;
  } else if (held == loaded.hold.size()) {
    even.wrench = loaded.wrench;  // whose curvature a length holds does not yield
    even.hold = loaded.hold;
  } else {
    return;
  }
  put_number(answer, "cc_gap", potential(robot, even) - potential(robot, loaded));
  put_number(answer, "cc_gap_estimate", constant_curvature_energy_gap(robot, unloaded, loaded.wrench));
  answer["cc_pose"] = pose_value(AnyPose(Space::tidy(even.pose)));
}

template <class Space>
void put_wanted(Context& context, const ChainLegs<Space>& robot, const ChainState<Space>& state,
                const ChainStability<Space>& stability, const Load<Space>& load, ChainWork& work) {
  Value& answer = context.answer;
  const Wants wanted = load.wanted;
  if (wanted.has(Want::velocity))
    put_velocity(context, chain_velocity(robot, state.pose, state.legs), load.twist);
  if (wanted.has(Want::shape)) {
    put_shape(answer, chain_shape(robot, state.pose, state.legs));
    answer["frames"] = Value::list({pose_value(AnyPose(Space::tidy(state.pose)))});
  }
  if (wanted.has(Want::stability)) {
    Value twists = Value::list();
    for (const auto& twist : stability.unstable) twists.push_back(Value(twist));
    answer["unstable"] = std::move(twists);
    answer["unstable_legs"] = std::span<const int>(stability.unstable_legs);
  }
  if (wanted.has(Want::margins)) {
    const ChainMargins found = margins(robot, state, work);
    answer["margins"] = Value::map();
    put_number(answer["margins"], "fold", found.fold);
    put_number(answer["margins"], "strain", found.strain);
  }
  if (wanted.has(Want::sensitivity))
    if (const auto rows = rows_of_inputs(twin_of(context), robot, state, work).sensitivity; rows.allFinite())
      answer["sensitivity"] = Value(MatrixView(rows.data(), Space::dof, rows.cols()));
}

/// @param unloaded what simpler models start from, if it is known
template <class Space>
void put_equilibrium(Context& context, const ChainLegs<Space>& robot, const ChainState<Space>& state,
                     Report report, const ChainState<Space>* unloaded, const Load<Space>& load,
                     ChainWork& work) {
  Value& answer = context.answer;
  const bool is_found = is_solved(report);
  ChainStability<Space> stability{};
  if (is_found) stability = note_stability(robot, state, work, report);
  context.report(report);
  answer["iterations"] = report.iterations;
  put_number(answer, "residual", report.residual);
  if (!is_found) return;
  const AnyPose pose = Space::tidy(state.pose);
  context.remember(pose);
  const bool in_full = load.wanted.has(Want::legs);
  if (load.wanted.has(Want::pose)) answer["pose"] = pose_value(pose);
  if (in_full) answer["legs"] = chain_legs_value(robot, state);
  answer["wrench"] = Value(state.wrench);
  if (in_full || load.wanted.has(Want::stiffness)) {
    put_matrix<Space>(answer, "stiffness", stiffness(robot, state, work));
    put_matrix<Space>(answer, "compliance", compliance(robot, state, work));
  }
  answer["stable"] = stability.is_stable();
  answer["unstable_directions"] = stability.unstable_directions;
  put_number(answer, "smallest_eigenvalue", stability.smallest_eigenvalue);
  put_number(answer, "potential", potential(robot, state));
  put_wanted(context, robot, state, stability, load, work);
  if (unloaded && in_full) put_simpler_models(context, robot, *unloaded, state, load, work);
}

}  // namespace sinew::inline v1::chains
