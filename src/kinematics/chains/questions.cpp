#include "kinematics/chains/questions.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/chain_analysis.hpp"
#include "kinematics/chain_equilibria.hpp"
#include "kinematics/chain_sensing.hpp"
#include "kinematics/chains/arcs.hpp"
#include "kinematics/chains/path.hpp"
#include "robot/arguments.hpp"
#include "sinew/kinematics/forward.hpp"

namespace sinew::inline v1 {
namespace {

/// The equilibrium that a workspace holds, if it does.
template <class Space>
std::shared_ptr<HeldChains<Space>>& held_in(Workspace& work) {
  return memory_in<Space>(work.chains).held;
}

/// Which numbers of a twist in space a robot of this space has.
template <class Space>
constexpr std::array<Eigen::Index, static_cast<std::size_t>(Space::dof)> axes_of() {
  if constexpr (Space::dimension == 2)
    return {0, 1, 5};
  else
    return {0, 1, 2, 3, 4, 5};
}

SpatialPose in_space(const SpatialPose& pose) { return spatial_pose(SE3<double>::from(pose)); }
SpatialPose in_space(const PlanarPose& pose) {
  const double half = wrap_angle(pose.phi) / 2;
  return {Vec3<double>(pose.x, pose.y, 0), {std::cos(half), 0, 0, std::sin(half)}};
}
SpatialPose in_space(const AnyPose& pose) {
  return std::visit([](const auto& own) { return in_space(own); }, pose);
}

template <class Space>
Vec<double, Space::dof> own_wrench(const SpatialWrench& wrench) {
  Vec<double, Space::dof> own;
  for (std::size_t k = 0; k < axes_of<Space>().size(); ++k)
    own[static_cast<Eigen::Index>(k)] = wrench[axes_of<Space>()[k]];
  return own;
}

Report refusal(Status status, std::string_view why) {
  Report report;
  report.status = status;
  report.message.append(why);
  return report;
}

/// What no robot of this space, or no chain, can be asked.
template <class Space>
Report check_wrench(const SpatialWrench& wrench) {
  if (!wrench.allFinite()) return refusal(Status::bad_input, "the wrench has numbers that are not finite");
  if constexpr (Space::dimension == 2)
    if (wrench[2] != 0 || wrench[3] != 0 || wrench[4] != 0)
      return refusal(Status::bad_input,
                     "the robot is in the plane z = 0: a wrench on it is (fx, fy, 0, 0, 0, m)");
  return {};
}

/// The pose in the robot's own space; of one in the plane it has to lie there.
template <class Space>
Report read_own(const SpatialPose& pose, std::string_view name, AnyPose& own) {
  const auto& q = pose.quaternion;
  const bool finite =
      pose.position.allFinite() && std::ranges::all_of(q, [](double x) { return std::isfinite(x); });
  if (!finite || std::ranges::all_of(q, [](double x) { return x == 0; }))
    return refusal(Status::bad_input, "a pose has finite numbers, and a quaternion other than 0");
  if constexpr (Space::dimension == 3) {
    own = pose;
  } else {
    if (pose.position[2] != 0 || q[1] != 0 || q[2] != 0) {
      Report report = refusal(Status::bad_input, "the robot is in the plane z = 0, ");
      report.message.append(name);
      report.message.append(" is not: z and the quaternion's x and y have to be 0");
      return report;
    }
    own = PlanarPose{pose.position[0], pose.position[1], wrap_angle(2 * std::atan2(q[3], q[0]))};
  }
  return {};
}

template <class Space>
Report check_options(const EquilibriumOptions& options, std::optional<AnyPose>& start) {
  if (options.gravity)
    return refusal(Status::unsupported, "chains have no weight; leave gravity out, or give its wrench");
  if (options.max_iterations && *options.max_iterations < 0)
    return refusal(Status::bad_input, "max_iterations is 0 or more");
  if (const Report report = check_wrench<Space>(options.wrench); !report.ok()) return report;
  if (!options.start) return {};
  AnyPose own;
  const Report report = read_own<Space>(*options.start, "start", own);
  start = own;
  return report;
}

ChainOptions chain_options(const EquilibriumOptions& options) {
  ChainOptions how;
  if (options.max_iterations) how.max_iterations = *options.max_iterations;
  return how;
}

/// The solvers' memory, which is asked to stop when the workspace is.
ChainWork& solver_memory(Workspace& work) {
  work.chains.stop = work.stop;
  return work.chains;
}

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
    judge(found->robot, found->state, solver_memory(work), found->report);
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
std::vector<FoundEquilibrium> find_all(const Robot& robot, Numbers inputs, const EquilibriumOptions& options,
                                       Workspace& work) {
  std::vector<FoundEquilibrium> all;
  std::optional<AnyPose> start;
  if (!check_options<Space>(options, start).ok()) return all;
  using Pose = typename Space::Pose;
  const ArcTwin twin(robot, work);
  const HeldInputs held =
      hold_inputs(twin, chains_of<Space>(robot), inputs, {}, options.max_iterations.value_or(100));
  if (!held.arcs.report.ok()) return all;
  std::vector<ChainStart<Space>> starts{{std::get<Pose>(held.pose), held.arcs.curvature}};
  const AssemblyModes modes = assembly_modes(twin.robot, inputs, twin.work);
  for (const AnyPose& pose : modes.poses) starts.push_back({std::get<Pose>(pose), held.arcs.curvature});
  const std::span<const ChainStart<Space>> from(starts);
  for (const auto& one :
       chain_equilibria(chains_of<Space>(robot), from, held.hold, own_wrench<Space>(options.wrench),
                        solver_memory(work), chain_options(options)))
    all.push_back({.pose = in_space(one.state.pose),
                   .inputs = {inputs.begin(), inputs.end()},
                   .rods = {},
                   .residual = one.report.residual,
                   .potential = one.potential,
                   .unstable_directions = one.stability.unstable_directions});
  return all;
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
  if (options.check_stability) judge(held->robot, held->state, solver_memory(work), sensed.report);
  constexpr auto axes = axes_of<Space>();
  Vec<double, Space::dof> spread(deviations.data());
  const auto scaled = (found.sensitivity * spread.asDiagonal()).eval();
  const auto covariance = (scaled * scaled.transpose()).eval();
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
