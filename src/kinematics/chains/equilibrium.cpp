/// Equilibria of platforms on chains: at rest, along paths to a load, with the pose held.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/limits.hpp"
#include "kinematics/chains/path.hpp"
#include "math/linalg.hpp"
#include "solve/message.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

TendonConstraint between(const TendonConstraint& from, const TendonConstraint& to, double part) {
  TendonConstraint hold = to;
  hold.length = std::lerp(from.length, to.length, part);
  for (std::size_t k = 0; k < 2; ++k) hold.tension[k] = std::lerp(from.tension[k], to.tension[k], part);
  return hold;
}

/// What the state itself has of the things a leg is to hold.
TendonConstraint present(const ChainLegState& leg, const TendonConstraint& to) {
  TendonConstraint hold{to.length_of, 0, leg.tension};
  if (to.length_of >= 0) hold.length = leg.tendon_length[static_cast<std::size_t>(to.length_of)];
  return hold;
}

void say_how_far(Report& report, double done) {
  report.message.append(report.status == Status::iteration_limit ? "the iterations ran out at "
                                                                 : "the path of equilibria ends at ");
  const int per_mille = static_cast<int>(1000 * done);
  append_number(report.message, per_mille / 10);
  report.message.append(".");
  append_number(report.message, per_mille % 10);
  report.message.append(" % of the way to these inputs and this wrench");
  if (report.status != Status::iteration_limit)
    report.message.append(": it folds, or is lost; another branch (bending) or start may lead on");
}

Report wrong_sizes() {
  Report report;
  report.status = Status::bad_input;
  report.message.append(
      "each leg of the robot needs one value, and a state of its own: give those of this robot");
  return report;
}

/// What the tensions of the inner tendons do to the platform at rest, a column a leg.
template <class Space>
auto pulls_of(const ChainGroup<Space>& group) {
  Eigen::Matrix<double, Space::dof, Eigen::Dynamic, Eigen::RowMajor, Space::dof, max_rows> pulls(
      Space::dof, group.limbs());
  for (int i = 0; i < group.limbs(); ++i) pulls.col(i) = group.input_wrench_jacobian(i);
  return pulls;
}

/// Newton's step of those tensions, to the ones nearest to `near`. Infinite where there is none.
template <class Space>
double plan_tensions(ChainGroup<Space>& group, std::span<const double> near) {
  const auto pulls = pulls_of(group);
  Vec<double, Space::dof> wanted = group.wrench_residual();
  std::array<double, max_rows> fed{};
  const std::span<double> steps(fed.data(), near.size());
  const MatrixView A(pulls.data(), pulls.rows(), pulls.cols());
  if (pulls.cols() == Space::dof) {
    if (!solve(A, MatrixView(wanted.data(), Space::dof, 1), steps))
      return std::numeric_limits<double>::infinity();
  } else {
    for (int i = 0; i < group.limbs(); ++i)
      wanted += pulls.col(i) * (group.effort(i) - near[static_cast<std::size_t>(i)]);
    least_norm(A, {wanted.data(), static_cast<std::size_t>(Space::dof)}, steps);
    for (int i = 0; i < group.limbs(); ++i)
      steps[static_cast<std::size_t>(i)] -= group.effort(i) - near[static_cast<std::size_t>(i)];
  }
  return group.plan(Vec<double, Space::dof>::Zero(), steps);
}

/// Follows a path to a wrench into `state`, where `find_step` plans Newton's steps, and tells how far it
/// came.
/// @param how_regular says what keeps the platform where it is; asked where it begins and where it ends
template <class Space, class Put, class FindStep, class Regular>
Report follow(ChainMemory<Space>& memory, StopToken stop, const ChainOptions& options,
              ChainState<Space>& state, Put&& put, FindStep&& find_step, Regular&& how_regular) {
  auto& group = memory.group;
  Report report;
  double begun = 1;
  bool has_begun = false;
  const ChainSteps steps{[&] { return group.error(); },
                         [&] {
                           if (!std::exchange(has_begun, true)) begun = how_regular();
                           return find_step();
                         }};
  const ParameterPath end = follow_path(memory, stop, options.max_iterations, put, steps);
  report.iterations = end.iterations;
  report.residual = group.error() * group.radius();
  if (!end.arrived) {
    report.status = end.ran_out ? Status::iteration_limit : Status::stalled;
    if (!note_stop(stop, report)) say_how_far(report, end.progress);
  }
  group.measure();
  state = group.state();
  if (end.arrived) name_slack(state, report);
  check_regularity(begun, report);  // from a singular start a step may lead anywhere
  if (end.arrived) check_regularity(how_regular(), report);
  return report;
}

/// Tensions and shapes that hold the pose without a wrench, from nearly so: no leg pulls or pushes.
template <class Space>
Report settle(const ChainLegs<Space>& robot, ChainState<Space>& state) {
  ChainWork work;
  auto& group = memory_of(work, robot, state).group;
  std::vector<double> fed(robot.legs.size());
  const auto find_step = [&] {
    for (std::size_t i = 0; i < fed.size(); ++i) fed[i] = group.relief(static_cast<int>(i));
    return group.plan(Vec<double, Space::dof>::Zero(), fed);
  };
  Report report;
  int iterations = 0;
  if (!correct(group, iterations, ChainSteps{[&] { return group.error(); }, find_step})) {
    report.status = Status::unreachable;
    report.message.append("no tensions hold the chains at this pose");
  }
  report.residual = group.error() * group.radius();
  group.measure();
  state = group.state();
  return report;
}

}  // namespace

template <class Space>
Report unloaded_equilibrium(const ChainLegs<Space>& robot, const typename Space::Pose& pose,
                            std::span<const double> curvature, bool holds_lengths, ChainState<Space>& state) {
  if (curvature.size() != robot.legs.size()) return wrong_sizes();
  state.pose = pose;
  state.legs.assign(robot.legs.size(), {});
  state.hold.assign(robot.legs.size(), {});
  state.wrench.setZero();
  Report report;
  const auto platform = Space::frame(pose);
  ChainClosure<Space> at;
  bool is_even = true;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const auto& leg = robot.legs[i];
    ChainLegState& own = state.legs[i];
    const auto n = static_cast<std::size_t>(leg.chain.joints());
    const auto bend = [&](double angle) {
      for (std::size_t j = 0; j < n; ++j) own.angles[j] = angle * even_bend(leg.chain, static_cast<int>(j));
      close_chain(leg, platform, own.of(leg.chain), at);
    };
    double angle = -curvature[i] * leg.chain.link_length();
    if (!leg.has_strut()) {  // the chord shrinks with the bend: start where a series puts it
      bend(0);
      const double short_by = std::max(0.0, -at.c / leg.chain.length);
      const double turn = std::min(5.0, std::sqrt(24 * short_by));
      angle = (curvature[i] < 0 ? 1 : -1) * std::max(turn, 1e-3) / static_cast<double>(n + 1);
    }
    for (int round = 0; round < 50; ++round) {
      bend(angle);
      double slope = 0;
      for (std::size_t j = 0; j < n; ++j) slope += at.c_q[j] * even_bend(leg.chain, static_cast<int>(j));
      const double step = at.c / slope;
      if (!std::isfinite(step)) break;
      angle -= std::clamp(step, -0.2, 0.2);
      if (std::abs(step) < 1e-15) break;
    }
    bend(angle);
    report.residual = worse(report.residual, at.c);
    if (!(std::abs(at.c) < 1e-11 * leg.chain.length) && report.ok())
      say_leg(report, Status::unreachable, i, " has no even bend at this pose near the curvature given");
    const std::size_t inner = inner_tendon(own, leg.chain), last = n - 1;
    const auto pull = leg.chain.tendon_bend(static_cast<int>(last), own.angles[last], leg.tendon_offset,
                                            inner == 0 ? 1 : -1);
    own.tension[inner] = std::abs(leg.spring(static_cast<int>(last)) * own.angles[last] / pull.rate);
    measure_tendons(leg, own);
    // straight tendons pull less at a clamped first joint than at the others: even is no rest there
    is_even =
        is_even && !(leg.chain.model == PrbDiscretisation::discs && leg.chain.base == ChainBase::clamped);
  }
  if (report.ok() && !is_even) report = settle(robot, state);
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    state.hold[i] = present(
        state.legs[i],
        {holds_lengths ? static_cast<int>(inner_tendon(state.legs[i], robot.legs[i].chain)) : -1, 0, {}});
  return report;
}

template <class Space>
Report equilibrium(const ChainLegs<Space>& robot, std::span<const TendonConstraint> hold,
                   const Vec<double, Space::dof>& wrench, ChainState<Space>& state, ChainWork& work,
                   const ChainOptions& options) {
  if (hold.size() != robot.legs.size() || state.legs.size() != robot.legs.size()) return wrong_sizes();
  if (const Report checked = check_hold(robot, hold); !checked.ok() && !options.evenly_bent) return checked;
  state.hold.resize(robot.legs.size());
  auto& memory = memory_of(work, robot, state, options);
  auto& group = memory.group;
  const auto put = [&](double part) {
    for (std::size_t i = 0; i < hold.size(); ++i)
      group.hold_leg(i, between(present(state.legs[i], hold[i]), hold[i], part));
    group.set_wrench(state.wrench + part * (wrench - state.wrench));
  };
  return follow(
      memory, work.stop, options, state, put, [&] { return group.plan(group.step(true)); },
      [&] { return regularity(group); });
}

template <class Space>
Report inverse_statics(const ChainLegs<Space>& robot, const Vec<double, Space::dof>& wrench,
                       ChainState<Space>& state, ChainWork& work, const ChainOptions& options) {
  if (robot.legs.size() < static_cast<std::size_t>(Space::dof)) {
    Report report;
    report.status = Status::unreachable;
    report.message.append(
        "fewer legs than the platform has freedoms hold no pose under load; give the robot more legs");
    return report;
  }
  if (!fits(robot, state) || robot.legs.size() > static_cast<std::size_t>(max_rows)) return wrong_sizes();
  const std::vector<TendonConstraint> held =
      std::exchange(state.hold, std::vector<TendonConstraint>(robot.legs.size()));
  std::array<double, max_rows> near;
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    near[i] = state.legs[i].tension[inner_tendon(state.legs[i], robot.legs[i].chain)];
  auto& memory = memory_of(work, robot, state, options);
  auto& group = memory.group;
  const Vec<double, Space::dof> first = state.wrench;
  const Report report = follow(
      memory, work.stop, options, state,
      [&](double part) { group.set_wrench(first + part * (wrench - first)); },
      [&] { return plan_tensions(group, std::span(near).first(held.size())); },
      [&] {
        const auto pulls = pulls_of(group);
        return regularity<Space>(MatrixView(pulls.data(), pulls.rows(), pulls.cols()), group.radius(), 1);
      });
  for (std::size_t i = 0; i < held.size(); ++i) state.hold[i] = present(state.legs[i], held[i]);
  return report;
}

template <class Space>
Mat<double, Space::dof, Space::dof> stiffness(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                              ChainWork& work) {
  if (!fits(robot, state))
    return Mat<double, Space::dof, Space::dof>::Constant(std::numeric_limits<double>::quiet_NaN());
  return linearised(work, robot, state).stiffness();
}

template <class Space>
Mat<double, Space::dof, Space::dof> compliance(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                               ChainWork& work) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Mat<double, Space::dof, Space::dof> C = Mat<double, Space::dof, Space::dof>::Constant(none);
  if (!fits(robot, state)) return C;
  const auto& factors = linearised(work, robot, state).factors();
  for (int k = 0; k < Space::dof; ++k)
    factors.solve(Vec<double, Space::dof>::Unit(k).eval().data(), C.col(k).data());
  return C;
}

#define SINEW_OF(Space)                                                                                      \
  template Report unloaded_equilibrium(const ChainLegs<Space>&, const Space::Pose&, std::span<const double>, \
                                       bool, ChainState<Space>&);                                            \
  template Report equilibrium(const ChainLegs<Space>&, std::span<const TendonConstraint>,                    \
                              const Vec<double, Space::dof>&, ChainState<Space>&, ChainWork&,                \
                              const ChainOptions&);                                                          \
  template Report inverse_statics(const ChainLegs<Space>&, const Vec<double, Space::dof>&,                   \
                                  ChainState<Space>&, ChainWork&, const ChainOptions&);                      \
  template Mat<double, Space::dof, Space::dof> stiffness(const ChainLegs<Space>&, const ChainState<Space>&,  \
                                                         ChainWork&);                                        \
  template Mat<double, Space::dof, Space::dof> compliance(const ChainLegs<Space>&, const ChainState<Space>&, \
                                                          ChainWork&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
