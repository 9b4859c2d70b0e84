/// Newton's method for platforms on chains, legs eliminated, along paths of loads.
#include <algorithm>
#include <cmath>

#include "kinematics/chains/elimination.hpp"
#include "kinematics/chains/leg_system.hpp"
#include "sinew/math/linalg.hpp"

namespace sinew::inline v0 {
namespace {

/// One tendon's tension moves, or the platform does: unknowns beside those of the legs.
enum class Free { platform, tensions };

/// Newton's method at one point of the path.
template <class Space>
class Solver {
 public:
  static constexpr int dof = Space::dof, sides = dof + 1;
  using Pose = typename Space::Pose;
  using Motion = Vec<double, dof>;
  using State = ChainState<Space>;

  Solver(const ChainRobot<Space>& robot, ChainWork& work, const ChainOptions& options,
         Free free = Free::platform)
      : robot_(robot),
        work_(work),
        options_(options),
        free_(free) {
    work.moves.resize(robot.legs.size() * most_unknowns * sides);
    for (const auto& leg : robot.legs) {
      size_ = std::max(size_, leg.chain.length);
      stiffness_ = std::max(stiffness_, leg.bending_stiffness / std::pow(leg.chain.length, 3));
    }
  }

  /// Smallest over largest singular value of the platform's stiffness, as forces and lengths.
  double regularity(const ChainState<Space>& state) {
    Eigen::Matrix<double, dof, dof, Eigen::RowMajor> S =
        reduce(state.pose, state.legs, state.hold, state.wrench).S;
    for (int k = Space::dimension; k < dof; ++k) S.row(k) /= size_, S.col(k) /= size_;
    if (!S.allFinite()) return 0;
    std::array<double, max_rows> sigma;
    singular_values(MatrixView(S.data(), dof, dof), sigma);
    return sigma[dof - 1] / sigma[0];
  }

  double residual() const { return residual_; }  ///< unbalance as a length [m]
  int iterations() const { return iterations_; }
  bool has_budget() const { return iterations_ < options_.max_iterations; }

  /// What is left for the platform with the legs eliminated: S y = −g, y its motion, or the tensions.
  struct Reduced {
    Mat<double, dof, dof> S;
    Motion g;
  };

  Reduced reduce(const Pose& pose, std::span<const ChainLegState> legs, std::span<const ChainHold> hold,
                 const Motion& wrench) {
    const auto platform = Space::frame(pose);
    Reduced reduced{Mat<double, dof, dof>::Zero(), -wrench};
    Motion balance = -wrench;
    residual_ = 0;
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const auto& leg = robot_.legs[i];
      form(leg, platform, legs[i], hold[i], system_);
      if (options_.evenly_bent) bend_evenly(leg.chain, system_);
      const auto size = static_cast<std::size_t>(system_.size),
                 joints = static_cast<std::size_t>(system_.joints);
      const int columns = free_ == Free::platform ? sides : 2;
      double* const moves = moves_of(i);
      for (std::size_t j = 0; j < size; ++j) {
        double* const row = moves + j * static_cast<std::size_t>(columns);
        row[0] = -system_.r[j];
        if (free_ == Free::platform)
          for (int k = 0; k < dof; ++k) row[k + 1] = -system_.B[j][k];
        else
          row[1] = j < joints ? -system_.per_tension[j] : 0;
        const double measure = j < joints ? size_ / leg.spring(static_cast<int>(j)) : 1;
        residual_ = worse(residual_, system_.r[j] * measure);
      }
      eliminate(system_.A[0].data(), system_.size, most_unknowns, moves, columns);
      const Motion pull = legs[i].force * system_.closure.c_x;
      balance += pull;
      reduced.g += pull;
      for (std::size_t j = 0; j < size; ++j) {
        const double* const row = moves + j * static_cast<std::size_t>(columns);
        reduced.g += row[0] * system_.B[j];
        if (free_ == Free::platform)
          for (int k = 0; k < dof; ++k) reduced.S.col(k) += row[k + 1] * system_.B[j];
        else
          reduced.S.col(static_cast<Eigen::Index>(i)) += row[1] * system_.B[j];
      }
      if (free_ == Free::platform) reduced.S += legs[i].force * system_.closure.c_xx;
    }
    for (int k = 0; k < dof; ++k)
      residual_ = worse(residual_, balance[k] / stiffness_ / (k >= Space::dimension ? size_ : 1));
    return reduced;
  }

  /// A solve that turns a joint by more [rad] fails: it would be on another branch.
  void set_reach(double reach) { reach_ = reach; }

  /// From where pose and legs are; false where it does not get there.
  bool solve(Pose& pose, std::vector<ChainLegState>& legs, std::span<const ChainHold> hold,
             const Motion& wrench) {
    for (std::size_t i = 0; i < legs.size(); ++i)
      for (int k = 0; k < 2; ++k)
        if (hold[i].length_of != k && free_ == Free::platform)
          legs[i].tension[static_cast<std::size_t>(k)] = hold[i].tension[static_cast<std::size_t>(k)];
    double walked = 0;
    for (int round = 0; round < 25 && has_budget(); ++round) {
      Reduced reduced = reduce(pose, legs, hold, wrench);
      if (!std::isfinite(residual_)) return false;
      ++iterations_;
      const Motion motion = solution(reduced.S, -reduced.g);
      const double step = move(legs, hold, motion);
      if (free_ == Free::platform) pose = Space::moved(pose, motion);
      walked += step;
      if (!(walked < reach_)) return false;
      if (step < 1e-11 || (residual_ < 1e-13 * size_ && step < 1e-9)) {
        reduce(pose, legs, hold, wrench);
        return residual_ < 1e-11 * size_;
      }
    }
    return false;
  }

  static Motion solution(Mat<double, dof, dof> S, Motion right) {
    Eigen::Matrix<double, dof, dof, Eigen::RowMajor> rows = S;
    eliminate(rows.data(), dof, dof, right.data(), 1);
    return right;
  }

 private:
  double* moves_of(std::size_t leg) { return work_.moves.data() + leg * most_unknowns * sides; }

  /// The largest turn of a joint.
  double move(std::vector<ChainLegState>& legs, std::span<const ChainHold> hold, const Motion& motion) {
    double step = 0;
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const PseudoRigid& chain = robot_.legs[i].chain;
      const std::size_t inner = inner_tendon(legs[i], chain);
      const double* const moves = moves_of(i);
      const auto change = [&](std::size_t j) {
        if (free_ == Free::tensions)
          return moves[2 * j] + moves[2 * j + 1] * motion[static_cast<Eigen::Index>(i)];
        double sum = moves[sides * j];
        for (std::size_t k = 0; k < dof; ++k)
          sum += moves[sides * j + k + 1] * motion[static_cast<Eigen::Index>(k)];
        return sum;
      };
      std::size_t next = 0;
      const double even = options_.evenly_bent ? change(next++) : 0;
      for (std::size_t j = 0; j < static_cast<std::size_t>(chain.joints()); ++j) {
        const double turn =
            options_.evenly_bent ? even * even_bend(chain, static_cast<int>(j)) : change(next++);
        legs[i].angles[j] += turn;
        step = worse(step, turn);
      }
      legs[i].force += change(next);
      if (free_ == Free::tensions)
        legs[i].tension[inner] += motion[static_cast<Eigen::Index>(i)];
      else if (hold[i].length_of >= 0)
        legs[i].tension[static_cast<std::size_t>(hold[i].length_of)] += change(next + 1);
    }
    return step;
  }

  const ChainRobot<Space>& robot_;
  ChainWork& work_;
  ChainOptions options_;
  Free free_;
  LegSystem<Space> system_;
  double size_ = 0, stiffness_ = 0, residual_ = 0, reach_ = 0.5;
  int iterations_ = 0;
};

void measure_tendons(const auto& leg, ChainLegState& state) {
  for (const int side : {1, -1})
    state.tendon_length[side > 0 ? 0 : 1] =
        leg.chain.tendon_length(state.of(leg.chain), leg.tendon_offset, side);
}

template <class Space>
void measure_tendons(const ChainRobot<Space>& robot, ChainState<Space>& state) {
  for (std::size_t i = 0; i < robot.legs.size(); ++i) measure_tendons(robot.legs[i], state.legs[i]);
}

template <class Space>
void name_slack(const ChainState<Space>& state, Report& report) {
  for (std::size_t i = 0; i < state.legs.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k)
      if (state.legs[i].tension[k] < -1e-9)
        return say_leg(report, Status::slack, i,
                       k == 0 ? ": tendon 1 would have to push" : ": tendon 2 would have to push");
}

/// Tries points ever farther on a path from 0 to `to`, in smaller steps where one fails; the last one
/// reached.
/// @param finest shortest step, relative to what was reached, or to the first one
template <class Attempt>
double walk(double to, double stride, double finest, Attempt&& attempt) {
  const double first = stride;
  double done = 0;
  while (done < to) {
    const double next = stride < to - done ? done + stride : to;
    if (attempt(next)) {
      done = next;
      stride *= 2;
    } else {
      stride = std::min(stride, to - done) / 4;
      if (!(stride > finest * std::max(done, first))) break;
    }
  }
  return done;
}

ChainHold between(const ChainHold& from, const ChainHold& to, double part) {
  ChainHold hold = to;
  hold.length = std::lerp(from.length, to.length, part);
  for (std::size_t k = 0; k < 2; ++k) hold.tension[k] = std::lerp(from.tension[k], to.tension[k], part);
  return hold;
}

/// What the state itself has of the things a leg is to hold.
ChainHold present(const ChainLegState& leg, const ChainHold& to) {
  ChainHold hold{to.length_of, 0, leg.tension};
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

/// Whether a length that is held leaves a leg's joints nothing: one equation for the length, one for the
/// closure, which of evenly bent free ends are the same where there are but two joints.
template <class Space>
bool is_rigid(const ChainLeg<Space>& leg, const ChainHold& hold) {
  return hold.length_of >= 0 && leg.chain.joints() <= (leg.has_strut() ? 1 : 2);
}

/// Why no path can begin at the state; ok where it can.
template <class Space>
Report check_start(Solver<Space>& solver, const ChainRobot<Space>& robot, std::span<const ChainHold> hold,
                   const ChainState<Space>& state, bool is_free) {
  Report report;
  for (std::size_t i = 0; i < hold.size(); ++i)
    if (is_rigid(robot.legs[i], hold[i])) {
      say_leg(report, Status::singular, i,
              " has so few joints that none can yield while its tendon's length is held; give the link more "
              "joints, or hold tensions");
      return report;
    }
  if (!is_free || solver.regularity(state) > 1e-10) return report;
  report.status = Status::singular;
  report.message.append("the platform can move with everything held: a type II singularity, see velocity");
  return report;
}

/// A path to a wrench, and to what is held where the platform is free.
template <class Space>
Report follow(Solver<Space>& solver, const ChainRobot<Space>& robot, std::span<const ChainHold> hold,
              const Vec<double, Space::dof>& wrench, ChainState<Space>& state, ChainWork& work) {
  work.first.resize(hold.size());
  for (std::size_t i = 0; i < hold.size(); ++i) work.first[i] = present(state.legs[i], hold[i]);
  work.hold.resize(hold.size());
  const Vec<double, Space::dof> first = state.wrench;
  const auto put = [&](double part) {
    for (std::size_t i = 0; i < hold.size(); ++i) work.hold[i] = between(work.first[i], hold[i], part);
  };
  const double done = walk(1, 1, 1e-6, [&](double next) {
    if (!solver.has_budget()) return false;
    put(next);
    const Vec<double, Space::dof> load = first + next * (wrench - first);
    auto pose = state.pose;
    work.legs = state.legs;
    if (!solver.solve(pose, work.legs, work.hold, load)) return false;
    state.pose = pose;
    std::swap(state.legs, work.legs);
    state.wrench = load;
    return true;
  });
  put(done);
  state.hold.assign(work.hold.begin(), work.hold.end());
  measure_tendons(robot, state);
  solver.reduce(state.pose, state.legs, state.hold, state.wrench);
  Report report;
  report.residual = solver.residual();
  report.iterations = solver.iterations();
  if (done < 1) {
    report.status = solver.has_budget() ? Status::stalled : Status::iteration_limit;
    say_how_far(report, done);
  } else {
    name_slack(state, report);
  }
  return report;
}

/// Tensions and shapes that hold the pose without a wrench, from nearly so.
template <class Space>
Report settle(const ChainRobot<Space>& robot, ChainState<Space>& state) {
  ChainWork work;
  Solver<Space> solver(robot, work, {}, Free::tensions);
  Report report;
  if (!solver.solve(state.pose, state.legs, state.hold, state.wrench)) {
    report.status = Status::unreachable;
    report.message.append("no tensions hold the chains at this pose");
  }
  report.residual = solver.residual();
  measure_tendons(robot, state);
  return report;
}

}  // namespace

template <class Space>
Report rest(const ChainRobot<Space>& robot, const typename Space::Pose& pose,
            std::span<const double> curvature, bool holds_lengths, ChainState<Space>& state) {
  SINEW_EXPECTS(curvature.size() == robot.legs.size());
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
    is_even = is_even && !(leg.chain.model == ChainModel::discs && leg.chain.base == ChainBase::clamped);
  }
  if (report.ok() && !is_even) report = settle(robot, state);
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    state.hold[i] = present(
        state.legs[i],
        {holds_lengths ? static_cast<int>(inner_tendon(state.legs[i], robot.legs[i].chain)) : -1, 0, {}});
  return report;
}

template <class Space>
Report equilibrium(const ChainRobot<Space>& robot, std::span<const ChainHold> hold,
                   const Vec<double, Space::dof>& wrench, ChainState<Space>& state, ChainWork& work,
                   const ChainOptions& options) {
  SINEW_EXPECTS(hold.size() == robot.legs.size() && state.legs.size() == robot.legs.size());
  Solver<Space> solver(robot, work, options);
  const Report report = check_start(solver, robot, hold, state, !options.evenly_bent);
  return report.ok() ? follow(solver, robot, hold, wrench, state, work) : report;
}

template <class Space>
Report hold_pose(const ChainRobot<Space>& robot, const Vec<double, Space::dof>& wrench,
                 ChainState<Space>& state, ChainWork& work, const ChainOptions& options) {
  if (robot.legs.size() != static_cast<std::size_t>(Space::dof)) {
    Report report;
    report.status = Status::unreachable;
    report.message.append(
        "a pose under load is held by as many legs as the platform has freedoms, one tendon each");
    return report;
  }
  Solver<Space> solver(robot, work, options, Free::tensions);
  const std::vector<ChainHold> held = state.hold;
  const std::vector<ChainHold> hold(held.size());  // whatever tensions come out
  const Report report = follow(solver, robot, hold, wrench, state, work);
  for (std::size_t i = 0; i < hold.size(); ++i) state.hold[i] = present(state.legs[i], held[i]);
  return report;
}

template <class Space>
Mat<double, Space::dof, Space::dof> stiffness(const ChainRobot<Space>& robot, const ChainState<Space>& state,
                                              ChainWork& work) {
  Solver<Space> solver(robot, work, {});
  return solver.reduce(state.pose, state.legs, state.hold, state.wrench).S;
}

template <class Space>
Mat<double, Space::dof, Space::dof> compliance(const ChainRobot<Space>& robot, const ChainState<Space>& state,
                                               ChainWork& work) {
  const auto S = stiffness(robot, state, work);
  Mat<double, Space::dof, Space::dof> C;
  for (int k = 0; k < Space::dof; ++k)
    C.col(k) = Solver<Space>::solution(S, Vec<double, Space::dof>::Unit(k));
  return C;
}

std::string_view to_string(ChainLoadEnd end) noexcept {
  constexpr std::string_view names[] = {"limit", "fold", "bifurcation", "slack", "iterations"};
  return names[static_cast<std::size_t>(end)];
}

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

template <class Space>
ChainLoadPath follow_load(const ChainRobot<Space>& robot, const Vec<double, Space::dof>& direction,
                          double limit, ChainState<Space>& state, ChainWork& work,
                          const ChainOptions& options) {
  ChainLoadPath path;
  Solver<Space> solver(robot, work, options);
  path.report = check_start(solver, robot, state.hold, state, true);
  if (!path.report.ok()) return path;
  solver.set_reach(0.1);
  const bool was_stable = least_curvature(robot, state) > 0;
  const Vec<double, Space::dof> first = state.wrench;
  ChainState<Space> ahead = state;
  const double done =
      walk(limit, std::min(limit, first_stride(robot, direction, state, work)), 1e-8, [&](double next) {
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
      });
  path.load = done;
  if (path.end == ChainLoadEnd::fold && !answers(robot, direction, state, work))
    path.end = ChainLoadEnd::bifurcation;
  solver.reduce(state.pose, state.legs, state.hold, state.wrench);
  path.report.residual = solver.residual();
  path.report.iterations = solver.iterations();
  if (path.end == ChainLoadEnd::iterations) {
    path.report.status = Status::iteration_limit;
    path.report.message.append("the iterations ran out before the load stopped growing");
  }
  return path;
}

#define SINEW_OF(Space)                                                                                    \
  template SINEW_API Report rest(const ChainRobot<Space>&, const Space::Pose&, std::span<const double>,    \
                                 bool, ChainState<Space>&);                                                \
  template SINEW_API Report equilibrium(const ChainRobot<Space>&, std::span<const ChainHold>,              \
                                        const Vec<double, Space::dof>&, ChainState<Space>&, ChainWork&,    \
                                        const ChainOptions&);                                              \
  template SINEW_API Report hold_pose(const ChainRobot<Space>&, const Vec<double, Space::dof>&,            \
                                      ChainState<Space>&, ChainWork&, const ChainOptions&);                \
  template SINEW_API Mat<double, Space::dof, Space::dof> stiffness(const ChainRobot<Space>&,               \
                                                                   const ChainState<Space>&, ChainWork&);  \
  template SINEW_API Mat<double, Space::dof, Space::dof> compliance(const ChainRobot<Space>&,              \
                                                                    const ChainState<Space>&, ChainWork&); \
  template SINEW_API ChainLoadPath follow_load(const ChainRobot<Space>&, const Vec<double, Space::dof>&,   \
                                               double, ChainState<Space>&, ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v0
