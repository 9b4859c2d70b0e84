/// Loads on platforms on chains that grow until they cannot.
#include <algorithm>
#include <cmath>

#include "kinematics/chains/solver.hpp"
#include "solve/continuation.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v0 {

std::string_view to_string(ChainLoadEnd end) noexcept {
  constexpr std::string_view names[] = {"limit", "fold", "bifurcation", "slack", "iterations"};
  return names[static_cast<std::size_t>(end)];
}

namespace {

/// Whether a load moves what is softest near the end of its path: then the path turns back there, else
/// another one crosses it.
template <class Space>
bool answers(const ChainRobot<Space>& robot, const Vec<double, Space::dof>& direction,
             const ChainState<Space>& state, ChainWork& work) {
  Mat<double, Space::dof, Space::dof> C = compliance(robot, state, work);
  Vec<double, Space::dof> load = direction;
  double size = 0;
  for (const auto& leg : robot.legs) size = std::max(size, leg.chain.length);
  for (int k = Space::dimension; k < Space::dof; ++k) {
    C.row(k) *= size, C.col(k) *= size;
    load[k] /= size;
  }
  return std::sqrt(squared_norm(Vec<double, Space::dof>(C * load))) >
         0.01 * C.norm() * std::sqrt(squared_norm(load));
}

/// A load that moves the platform by about a hundredth of a leg's length.
template <class Space>
double first_stride(const ChainRobot<Space>& robot, const Vec<double, Space::dof>& direction,
                    const ChainState<Space>& state, ChainWork& work) {
  double size = 0;
  for (const auto& leg : robot.legs) size = std::max(size, leg.chain.length);
  Vec<double, Space::dof> motion = compliance(robot, state, work) * direction;
  for (int k = Space::dimension; k < Space::dof; ++k) motion[k] *= size;
  return 0.01 * size / std::sqrt(squared_norm(motion));
}

}  // namespace

template <class Space>
ChainLoadPath follow_load(const ChainRobot<Space>& robot, const Vec<double, Space::dof>& direction,
                          double limit, ChainState<Space>& state, ChainWork& work,
                          const ChainOptions& options) {
  const double largest = direction.cwiseAbs().maxCoeff();
  const int scale = largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
  if (std::abs(scale) > 100) {  // its squares overflow or vanish; by a power of two, exactly
    Vec<double, Space::dof> scaled = direction;
    for (double& part : scaled) part = std::scalbn(part, -scale);
    ChainLoadPath path = follow_load(robot, scaled, std::scalbn(limit, scale), state, work, options);
    path.load = std::scalbn(path.load, -scale);
    return path;
  }
  ChainLoadPath path;
  if (!fits(robot, state)) {
    path.report.status = Status::bad_input;
    path.report.message.append("the state is of another robot");
    return path;
  }
  Solver<Space> solver(robot, work, options);
  path.report = check_hold(robot, state.hold);
  if (!path.report.ok()) return path;
  solver.set_reach(0.1);
  const bool was_stable = least_curvature(robot, state) > 0;
  const Vec<double, Space::dof> first = state.wrench;
  ChainState<Space> ahead = state;
  const auto attempt = [&](double next) {
    ahead = state;
    ahead.wrench = first + next * direction;
    path.end = solver.has_budget() ? ChainLoadEnd::fold : ChainLoadEnd::iterations;
    if (!solver.solve(ahead.pose, ahead.legs, ahead.hold, ahead.wrench)) return false;
    measure_tendons(robot, ahead);
    path.end = ChainLoadEnd::slack;
    Report report;
    name_slack(ahead, report);
    if (!report.ok()) return false;
    path.end = ChainLoadEnd::fold;
    if (was_stable && !(least_curvature(robot, ahead) > 0)) return false;
    std::swap(state, ahead);
    path.end = ChainLoadEnd::limit;
    return true;
  };
  double done = 0;
  const double begin = std::min(limit, first_stride(robot, direction, state, work));
  const auto step = [&](double stride) -> std::optional<double> {
    const double next = stride < limit - done ? done + stride : limit;
    if (!attempt(next)) {
      const double shorter = std::min(stride, limit - done) / 4;
      return shorter > 1e-8 * std::max(done, begin) ? shorter : 0;
    }
    done = next;
    return done < limit ? std::optional(2 * stride) : std::nullopt;
  };
  if (begin > 0)
    take_steps(
        {begin, 0, work.stop}, [] { return true; }, step);
  path.load = done;
  if (path.end == ChainLoadEnd::fold && !answers(robot, direction, state, work))
    path.end = ChainLoadEnd::bifurcation;
  const auto reduced = solver.reduce(state.pose, state.legs, state.hold, state.wrench);
  path.report.residual = solver.residual();
  path.report.iterations = solver.iterations();
  if (note_stop(work.stop, path.report)) {
    path.end = ChainLoadEnd::iterations;
  } else if (path.end == ChainLoadEnd::iterations) {
    path.report.status = Status::iteration_limit;
    path.report.message.append("the iterations ran out before the load stopped growing");
  }
  if (done == 0) check_regularity(solver, reduced, path.report);
  return path;
}

#define SINEW_OF(Space)                                                                                  \
  template SINEW_API ChainLoadPath follow_load(const ChainRobot<Space>&, const Vec<double, Space::dof>&, \
                                               double, ChainState<Space>&, ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v0
