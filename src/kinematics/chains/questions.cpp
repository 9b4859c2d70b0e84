#include "kinematics/chains/questions.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/chains/asked.hpp"
#include "kinematics/chains/chain_curve.hpp"
#include "kinematics/chains/chain_sensing.hpp"
#include "kinematics/chains/solutions.hpp"

namespace sinew::inline v1 {
namespace {

Equilibrium refused_question(const Report& report) {
  Equilibrium answer;
  answer.report = report;
  return answer;
}

/// Keeps an equilibrium, and what is seen of it.
template <class Space>
Equilibrium keep_found(const Robot& robot, std::shared_ptr<HeldChains<Space>> found, bool checks_stability,
                       std::optional<Numbers> inputs, Workspace& work) {
  if (checks_stability && is_solved(found->report))
    note_stability(found->robot, found->state, solver_memory(work), found->report);
  Equilibrium answer;
  answer.report = found->report;
  answer.pose = in_space(found->state.pose);
  if (inputs)
    work.inputs.assign(inputs->begin(), inputs->end());
  else
    work.inputs = inputs_of(ArcTwin(robot, work), found->robot, found->state);
  answer.inputs = work.inputs;
  if (is_solved(found->report) || found->report.status == Status::unstable)
    held_in<Space>(work) = std::move(found);
  return answer;
}

template <class Space>
Equilibrium find_near(const Robot& robot, Numbers inputs, const EquilibriumOptions& options,
                      Workspace& work) {
  std::optional<AnyPose> start;
  if (const Report report = check_options<Space>(options, start); !report.ok())
    return refused_question(report);
  if (const auto& last = held_in<Space>(work); options.warm_start && last) start = AnyPose(last->state.pose);
  held_in<Space>(work).reset();
  const HeldInputs held = hold_inputs(ArcTwin(robot, work), chains_of<Space>(robot), inputs, start,
                                      options.max_iterations.value_or(100));
  if (!held.arcs.report.ok()) {
    Equilibrium answer = refused_question(held.arcs.report);
    answer.pose = in_space(held.pose);
    return answer;
  }
  auto found = std::make_shared<HeldChains<Space>>(HeldChains<Space>{chains_of<Space>(robot), {}, {}});
  const ChainOptions how = chain_options(options);
  found->report = unloaded(found->robot, held, found->state, solver_memory(work), how);
  if (found->state.legs.empty()) return refused_question(found->report);
  if (is_solved(found->report))
    found->report = equilibrium(found->robot, std::vector<TendonConstraint>(found->state.hold),
                                own_wrench<Space>(options.wrench), found->state, solver_memory(work), how);
  return keep_found(robot, std::move(found), options.check_stability, inputs, work);
}

template <class Space>
Equilibrium find_at(const Robot& robot, const SpatialPose& wanted, const EquilibriumOptions& options,
                    Workspace& work) {
  std::optional<AnyPose> start;
  AnyPose pose;
  if (const Report report = check_options<Space>(options, start); !report.ok())
    return refused_question(report);
  if (const Report report = read_own<Space>(wanted, "the pose", pose); !report.ok())
    return refused_question(report);
  held_in<Space>(work).reset();
  auto found = std::make_shared<HeldChains<Space>>(HeldChains<Space>{chains_of<Space>(robot), {}, {}});
  found->report = rest_near(found->robot, pose, arcs_at(ArcTwin(robot, work), pose, {}), true, found->state);
  if (!found->report.ok()) return refused_question(found->report);
  found->report = inverse_statics(found->robot, own_wrench<Space>(options.wrench), found->state,
                                  solver_memory(work), chain_options(options));
  return keep_found(robot, std::move(found), options.check_stability, {}, work);
}

template <class Space>
LoadPath load_until(const SpatialWrench& direction, double limit, Workspace& work) {
  LoadPath path;
  path.end = LoadEnd::stalled;
  HeldChains<Space>* held = held_in<Space>(work).get();
  if (!held || !check_wrench<Space>(direction).ok() || direction == SpatialWrench::Zero() || !(limit > 0))
    return path;
  const ChainLoadPath grown =
      follow_load(held->robot, own_wrench<Space>(direction), limit, held->state, solver_memory(work));
  constexpr LoadEnd ends[] = {LoadEnd::limit, LoadEnd::fold,       LoadEnd::bifurcation,
                              LoadEnd::slack, LoadEnd::iterations, LoadEnd::stability};
  path.end = grown.report.status == Status::stopped ? LoadEnd::stopped : ends[static_cast<int>(grown.end)];
  path.load = grown.load;
  path.pose = in_space(held->state.pose);
  path.residual = grown.report.residual;
  held->report = grown.report;
  path.unstable_directions =
      check_stability(held->robot, held->state, solver_memory(work)).unstable_directions;
  return path;
}

template <class Space>
FoundEquilibrium found_of(const FoundChains<Space>& one, std::vector<double> inputs) {
  return {.pose = in_space(one.state.pose),
          .inputs = std::move(inputs),
          .rods = {},
          .residual = one.report.residual,
          .potential = one.potential,
          .unstable_directions = one.stability.unstable_directions};
}

template <class Space>
std::vector<FoundEquilibrium> find_all(const Robot& robot, Numbers inputs, const EquilibriumOptions& options,
                                       Workspace& work) {
  std::vector<FoundEquilibrium> all;
  std::optional<AnyPose> start;
  if (!check_options<Space>(options, start).ok()) return all;
  const ArcTwin twin(robot, work);
  const HeldInputs held =
      hold_inputs(twin, chains_of<Space>(robot), inputs, {}, options.max_iterations.value_or(100));
  if (!held.arcs.report.ok()) return all;
  for (const auto& one :
       equilibria_of_inputs(twin, chains_of<Space>(robot), held, inputs, own_wrench<Space>(options.wrench),
                            solver_memory(work), chain_options(options)))
    all.push_back(found_of(one, {inputs.begin(), inputs.end()}));
  return all;
}

template <class Space>
std::vector<FoundEquilibrium> find_all_at(const Robot& robot, const SpatialPose& wanted,
                                          const EquilibriumOptions& options, Workspace& work) {
  std::vector<FoundEquilibrium> all;
  std::optional<AnyPose> start;
  AnyPose pose;
  if (!check_options<Space>(options, start).ok() || !read_own<Space>(wanted, "the pose", pose).ok())
    return all;
  for (const ChainsAtPose<Space>& one :
       equilibria_at_pose(ArcTwin(robot, work), chains_of<Space>(robot), pose, {},
                          own_wrench<Space>(options.wrench), solver_memory(work), chain_options(options))
           .found)
    all.push_back(found_of<Space>(one, one.inputs));
  return all;
}

/// Into rows of twists and wrenches in space, row by row.
template <class Space>
void put_rows(const Eigen::Matrix<double, Space::dof, Eigen::Dynamic, Eigen::RowMajor>& own,
              std::vector<double>& rows) {
  const auto columns = static_cast<std::size_t>(own.cols());
  rows.assign(6 * columns, 0.0);
  if (columns == 0) return;
  for (std::size_t r = 0; r < axes_of<Space>().size(); ++r)
    std::copy_n(own.row(static_cast<Eigen::Index>(r)).data(), columns,
                &rows[static_cast<std::size_t>(axes_of<Space>()[r]) * columns]);
}

template <class Space>
ChainResult chain_result(const ChainLegs<Space>& robot, const ChainState<Space>& state, std::size_t i) {
  const ChainLeg<Space>& leg = robot.legs[i];
  const ChainLegState& own = state.legs[i];
  const auto platform = Space::frame(state.pose);
  ChainResult result;
  const auto angles = own.of(leg.chain);
  result.angles.assign(angles.begin(), angles.end());
  result.chord_force = own.force;
  result.tension = own.tension;
  result.tendon_length = own.tendon_length;
  const auto wrench = tip_wrench(leg, angles, platform);
  for (std::size_t k = 0; k < axes_of<Space>().size(); ++k)
    result.tip_wrench[axes_of<Space>()[k]] = wrench[static_cast<Eigen::Index>(k)];
  if constexpr (Space::dimension == 2) {
    if (robot.has_base_motors) {
      result.base_angle = wrap_angle(leg.base.angle() + std::numbers::pi / 2);
      result.motor_torque = motor_torque(leg, own, platform);
    }
  }
  return result;
}

template <class Space>
RodAnalysis analyse(const Robot& robot, Workspace& work) {
  const HeldChains<Space>* held = held_in<Space>(work).get();
  if (!held) return {};
  const ChainLegs<Space>& chains = held->robot;
  const ChainState<Space>& state = held->state;
  ChainWork& memory = solver_memory(work);
  RodAnalysis analysis;
  analysis.is_in_plane = Space::dimension == 2;
  const ChainStability<Space> stability = check_stability(chains, state, memory);
  analysis.smallest_eigenvalue = stability.smallest_eigenvalue;
  analysis.unstable_directions = stability.unstable_directions;
  for (const auto& twist : stability.unstable) {
    auto& whole = analysis.unstable.emplace_back();
    whole.fill(0);
    for (std::size_t k = 0; k < axes_of<Space>().size(); ++k)
      whole[static_cast<std::size_t>(axes_of<Space>()[k])] = twist[static_cast<Eigen::Index>(k)];
  }
  const ChainMargins known = margins(chains, state, memory);
  analysis.smallest_pivot = known.fold;
  analysis.largest_strain = known.strain;
  analysis.potential = potential(chains, state);
  const InputRows<Space> rows = rows_of_inputs(ArcTwin(robot, work), chains, state, memory);
  put_rows<Space>(rows.sensitivity, analysis.sensitivity);
  put_rows<Space>(-rows.needed_wrench, analysis.feed);
  const ChainGroup<Space>& group = linearised(memory, chains, state);
  analysis.energy = group.energy();
  constexpr auto axes = axes_of<Space>();
  for (std::size_t r = 0; r < axes.size(); ++r)
    for (std::size_t c = 0; c < axes.size(); ++c)
      analysis.stiffness[static_cast<std::size_t>(6 * axes[r] + axes[c])] =
          group.stiffness()(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
  for (std::size_t i = 0; i < chains.legs.size(); ++i) {
    analysis.unstable_rods.push_back(group.unstable_with_tip_held(static_cast<int>(i)));
    analysis.chains.push_back(chain_result(chains, state, i));
  }
  return analysis;
}

/// Lengths of the tendons that are held where the curve begins, at these inputs. None where other tendons
/// would be held there, or motors turn bases: along a curve they stay.
template <class Space>
std::vector<TendonConstraint> hold_at(const HeldChains<Space>& held, Numbers inputs) {
  const auto& legs = held.robot.legs;
  if (held.robot.has_base_motors || inputs.size() != legs.size()) return {};
  std::vector<TendonConstraint> hold;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    hold.push_back(hold_of_input(legs[i].chain, inputs[i]));
    if (hold[i].length_of != held.state.hold[i].length_of) return {};
  }
  return hold;
}

template <class Space>
std::vector<EquilibriumCurve> curves_of(const Robot& robot, const CurveOptions& how, Workspace& work) {
  const std::shared_ptr<HeldChains<Space>> held = held_in<Space>(work);
  if (!held || how.pose || !check_wrench<Space>(how.added_wrench).ok()) return {};
  ChainCurveOptions<Space> own{.hold = {},
                               .added_wrench = own_wrench<Space>(how.added_wrench),
                               .lowest = how.lowest,
                               .highest = how.highest,
                               .max_points = how.max_points,
                               .is_backward = how.is_backward,
                               .follows_branches = how.follows_branches,
                               .max_total_points = how.max_total_points};
  if (!how.inputs.empty()) {
    own.hold = hold_at(*held, how.inputs);
    if (own.hold.empty()) return {};
  }
  std::vector<EquilibriumCurve> curves;
  for (const ChainCurve<Space>& found : chain_curves(held->robot, held->state, own, solver_memory(work))) {
    EquilibriumCurve& curve = curves.emplace_back();
    curve.end = found.end;
    curve.from_curve = found.from_curve;
    curve.from_point = found.from_point;
    for (const ChainCurvePoint<Space>& point : found.points)
      curve.points.push_back({.parameter = point.parameter,
                              .event = point.event,
                              .pose = in_space(point.state.pose),
                              .inputs = inputs_of(ArcTwin(robot, work), held->robot, point.state),
                              .unstable_directions = point.unstable_directions,
                              .residual = point.residual,
                              .potential = point.potential});
  }
  if (!curves.empty()) held_in<Space>(work).reset();
  return curves;
}

template <class Space>
SensedWrench sense_of(const Robot& robot, Numbers inputs, Numbers tensions, Numbers deviations,
                      const EquilibriumOptions& options, Workspace& work) {
  SensedWrench sensed{};
  constexpr auto count = static_cast<std::size_t>(Space::dof);
  const auto is_number = [](double x) { return std::isfinite(x); };
  if (chains_of<Space>(robot).legs.size() != count) {
    sensed.report =
        refusal(Status::unsupported, "a wrench is told by as many legs as the platform has freedoms");
    return sensed;
  }
  if (tensions.size() != count || deviations.size() != count || !std::ranges::all_of(tensions, is_number) ||
      !std::ranges::all_of(deviations, is_number)) {
    sensed.report =
        refusal(Status::bad_input, "give a tension of each leg's tendon that is held, and its deviation");
    return sensed;
  }
  EquilibriumOptions without_load = options;
  without_load.wrench.setZero();
  without_load.check_stability = false;
  const Equilibrium begun = find_near<Space>(robot, inputs, without_load, work);
  sensed.report = begun.report;
  sensed.pose = begun.pose;
  HeldChains<Space>* held = held_in<Space>(work).get();
  if (!held) return sensed;
  std::vector<MeasuredTension> measured;
  for (std::size_t k = 0; k < count; ++k) measured.push_back({static_cast<int>(k), tensions[k]});
  const SensedLoad<Space> found = sense_wrench(held->robot, std::span<const MeasuredTension>(measured),
                                               held->state, solver_memory(work), chain_options(options));
  sensed.report = held->report = found.report;
  sensed.pose = in_space(held->state.pose);
  if (!is_solved(found.report)) {
    held_in<Space>(work).reset();
    return sensed;
  }
  if (options.check_stability) note_stability(held->robot, held->state, solver_memory(work), sensed.report);
  constexpr auto axes = axes_of<Space>();
  const auto covariance = covariance_of<Space::dof>(found.sensitivity, deviations);
  sensed.wrench.setZero();
  for (std::size_t r = 0; r < count; ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    sensed.wrench[axes[r]] = held->state.wrench[row];
    for (std::size_t c = 0; c < count; ++c) {
      const auto column = static_cast<Eigen::Index>(c);
      sensed.sensitivity[static_cast<std::size_t>(6 * axes[r]) + c] = found.sensitivity(row, column);
      sensed.covariance[static_cast<std::size_t>(6 * axes[r] + axes[c])] = covariance(row, column);
    }
  }
  return sensed;
}

}  // namespace

Equilibrium equilibrium_of_chains(const Robot& robot, Numbers inputs, const EquilibriumOptions& options,
                                  Workspace& work) {
  if (const Report fit = check_workspace(robot, work); !fit.ok()) return refused_question(fit);
  return robot.planar_chains() ? find_near<Planar>(robot, inputs, options, work)
                               : find_near<Spatial>(robot, inputs, options, work);
}

Equilibrium inverse_equilibrium_of_chains(const Robot& robot, const SpatialPose& wanted,
                                          const EquilibriumOptions& options, Workspace& work) {
  if (const Report fit = check_workspace(robot, work); !fit.ok()) return refused_question(fit);
  return robot.planar_chains() ? find_at<Planar>(robot, wanted, options, work)
                               : find_at<Spatial>(robot, wanted, options, work);
}

Equilibrium held_equilibrium_of_chains(const Robot& robot, Workspace& work) {
  if (const Report fit = check_workspace(robot, work); !fit.ok()) return refused_question(fit);
  const auto answer = [&](const auto& held) {
    if (!held) return refused_question(refusal(Status::bad_input, "the workspace holds no equilibrium"));
    Equilibrium known;
    known.report = held->report;
    known.pose = in_space(held->state.pose);
    known.inputs = work.inputs;
    return known;
  };
  return robot.planar_chains() ? answer(held_in<Planar>(work)) : answer(held_in<Spatial>(work));
}

LoadPath follow_load_of_chains(const Robot& robot, const SpatialWrench& direction, double limit,
                               Workspace& work) {
  if (!check_workspace(robot, work).ok()) {
    LoadPath path;
    path.end = LoadEnd::stalled;
    return path;
  }
  return robot.planar_chains() ? load_until<Planar>(direction, limit, work)
                               : load_until<Spatial>(direction, limit, work);
}

std::vector<FoundEquilibrium> equilibria_of_chains(const Robot& robot, Numbers inputs,
                                                   const EquilibriumOptions& options, Workspace& work) {
  if (!check_workspace(robot, work).ok()) return {};
  return robot.planar_chains() ? find_all<Planar>(robot, inputs, options, work)
                               : find_all<Spatial>(robot, inputs, options, work);
}

std::vector<FoundEquilibrium> inverse_equilibria_of_chains(const Robot& robot, const SpatialPose& wanted,
                                                           const EquilibriumOptions& options,
                                                           Workspace& work) {
  if (!check_workspace(robot, work).ok()) return {};
  return robot.planar_chains() ? find_all_at<Planar>(robot, wanted, options, work)
                               : find_all_at<Spatial>(robot, wanted, options, work);
}

RodAnalysis analyse_equilibrium_of_chains(const Robot& robot, Workspace& work) {
  if (!check_workspace(robot, work).ok()) return {};
  return robot.planar_chains() ? analyse<Planar>(robot, work) : analyse<Spatial>(robot, work);
}

std::vector<EquilibriumCurve> equilibrium_curves_of_chains(const Robot& robot, const CurveOptions& how,
                                                           Workspace& work) {
  if (!check_workspace(robot, work).ok()) return {};
  return robot.planar_chains() ? curves_of<Planar>(robot, how, work) : curves_of<Spatial>(robot, how, work);
}

SensedWrench sense_wrench_of_chains(const Robot& robot, Numbers inputs, Numbers tensions, Numbers deviations,
                                    const EquilibriumOptions& options, Workspace& work) {
  if (const Report fit = check_workspace(robot, work); !fit.ok()) {
    SensedWrench sensed{};
    sensed.report = fit;
    return sensed;
  }
  return robot.planar_chains() ? sense_of<Planar>(robot, inputs, tensions, deviations, options, work)
                               : sense_of<Spatial>(robot, inputs, tensions, deviations, options, work);
}

}  // namespace sinew::inline v1
