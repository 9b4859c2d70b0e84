/// @file solver.hpp
/// Newton's method for platforms on chains, legs eliminated, and paths of its solutions. Theory:
/// docs/theory/chain_equilibrium.md
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/chains/leg_moves.hpp"
#include "sinew/math/linalg.hpp"

namespace sinew::inline v0 {

/// Newton's method at one point of the path.
template <class Space>
class Solver {
 public:
  static constexpr int dof = Space::dof;
  using Pose = typename Space::Pose;
  using Motion = Vec<double, dof>;
  using State = ChainState<Space>;

  Solver(const ChainRobot<Space>& robot, ChainWork& work, const ChainOptions& options,
         Free free = Free::platform)
      : robot_(robot),
        work_(work),
        options_(options),
        free_(free) {
    work.moves.resize(robot.legs.size() * LegMoves<Space>::rows);
    for (const auto& leg : robot.legs) {
      size_ = std::max(size_, leg.chain.length);
      stiffness_ = std::max(stiffness_, leg.bending_stiffness / std::pow(leg.chain.length, 3));
    }
  }

  /// What is left for the platform with the legs eliminated: S y = −g, y its motion, or the tensions.
  struct Reduced {
    Mat<double, dof, dof> S;
    Motion g;
  };

  /// Smallest over largest singular value of what is left for the platform, as forces and lengths: 0 where
  /// nothing says how it moves.
  double regularity(const Reduced& reduced) const {
    Eigen::Matrix<double, dof, dof, Eigen::RowMajor> S = reduced.S;
    for (int k = Space::dimension; k < dof; ++k) {
      S.row(k) /= size_;
      if (free_ == Free::platform) S.col(k) /= size_;
    }
    if (!S.allFinite()) return 0;
    std::array<double, max_rows> sigma;
    singular_values(MatrixView(S.data(), dof, dof), sigma);
    return sigma[dof - 1] / sigma[0];
  }

  /// At the last equilibrium that `solve` found, and where its first call began.
  const Reduced& reached() const { return reached_; }
  const Reduced& begun() const { return begun_; }
  double residual() const { return residual_; }  ///< unbalance as a length [m]
  int iterations() const { return iterations_; }
  int max_iterations() const { return options_.max_iterations; }

  Reduced reduce(const Pose& pose, std::span<const ChainLegState> legs, std::span<const ChainHold> hold,
                 const Motion& wrench) {
    const auto platform = Space::frame(pose);
    Reduced reduced{Mat<double, dof, dof>::Zero(), -wrench};
    Motion balance = -wrench;
    residual_ = 0;
    odd_legs_ = 0;
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const auto& leg = robot_.legs[i];
      form(leg, platform, legs[i], hold[i], system_);
      measure(leg);
      LegMoves<Space> moves = moves_of(i);
      moves.eliminate(system_);
      odd_legs_ += moves.is_odd();
      moves.add_to(system_, static_cast<Eigen::Index>(i), reduced.S, reduced.g);
      balance += legs[i].force * system_.closure.c_x;
    }
    for (int k = 0; k < dof; ++k)
      residual_ = worse(residual_, balance[k] / stiffness_ / (k >= Space::dimension ? size_ : 1));
    return reduced;
  }

  /// Of the system last reduced: legs that are unstable by themselves in an odd number of directions.
  int odd_legs() const { return odd_legs_; }
  double size() const { return size_; }  ///< of the longest chain

  /// The largest turn of a joint as the platform, or the tensions, move from where they were last reduced.
  double move(std::vector<ChainLegState>& legs, std::span<const ChainHold> hold, const Motion& motion) {
    double step = 0;
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const std::span<const double> all(motion.data(), static_cast<std::size_t>(dof));
      step =
          worse(step, moves_of(i).move(free_ == Free::tensions ? all.subspan(i, 1) : all, hold[i], legs[i]));
    }
    return step;
  }

  /// From where pose and legs are; false where it does not get there.
  bool solve(Pose& pose, std::vector<ChainLegState>& legs, std::span<const ChainHold> hold,
             const Motion& wrench) {
    for (std::size_t i = 0; i < legs.size(); ++i)
      for (int k = 0; k < 2; ++k)
        if (hold[i].length_of != k && free_ == Free::platform)
          legs[i].tension[static_cast<std::size_t>(k)] = hold[i].tension[static_cast<std::size_t>(k)];
    constexpr double reach = 0.5;  // [rad]: who turns a joint by more would be on another branch
    double walked = 0;
    for (int round = 0; round < 25 && iterations_ < options_.max_iterations; ++round) {
      Reduced reduced = reduce(pose, legs, hold, wrench);
      if (!std::isfinite(residual_)) return false;
      if (iterations_++ == 0) begun_ = reduced;
      const Motion motion = solution(reduced.S, -reduced.g);
      const double step = move(legs, hold, motion);
      if (free_ == Free::platform) pose = Space::moved(pose, motion);
      walked += step;
      if (!(walked < reach)) return false;
      if (step < 1e-11 || (residual_ < 1e-13 * size_ && step < 1e-9)) {
        reached_ = reduce(pose, legs, hold, wrench);
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
  LegMoves<Space> moves_of(std::size_t leg) {
    return {robot_.legs[leg].chain, options_.evenly_bent, free_,
            work_.moves.data() + leg * LegMoves<Space>::rows};
  }

  /// What the leg's own equations leave, as lengths.
  void measure(const ChainLeg<Space>& leg) {
    residual_ = worse(worse(residual_, system_.closure.c), system_.length_error);
    double even = 0;
    for (int joint = 0; joint < system_.joints; ++joint) {
      const auto j = static_cast<std::size_t>(joint);
      even += even_bend(leg.chain, joint) * system_.balance[j];
      if (!options_.evenly_bent)
        residual_ = worse(residual_, system_.balance[j] * (size_ / leg.spring(joint)));
    }
    if (options_.evenly_bent) residual_ = worse(residual_, even * (size_ / leg.spring(0)));
  }

  const ChainRobot<Space>& robot_;
  ChainWork& work_;
  ChainOptions options_;
  Free free_;
  LegSystem<Space> system_;
  Reduced begun_{Mat<double, dof, dof>::Zero(), Motion::Zero()}, reached_ = begun_;
  double size_ = 0, stiffness_ = 0, residual_ = 0;
  int iterations_ = 0, odd_legs_ = 0;
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

/// A tendon that pushes by less counts as loose [N].
inline constexpr double slack_tolerance = 1e-9;

template <class Space>
void name_slack(const ChainState<Space>& state, Report& report) {
  for (std::size_t i = 0; i < state.legs.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k)
      if (state.legs[i].tension[k] < -slack_tolerance)
        return say_leg(report, Status::slack, i,
                       k == 0 ? ": tendon 1 would have to push" : ": tendon 2 would have to push");
}

/// Whether a length that is held leaves a leg's joints nothing: one equation for the length, one for the
/// closure, which of evenly bent free ends are the same where there are but two joints.
template <class Space>
bool is_rigid(const ChainLeg<Space>& leg, const ChainHold& hold) {
  return hold.length_of >= 0 && leg.chain.joints() <= (leg.has_strut() ? 1 : 2);
}

/// The largest change of a tendon's length that no joint needs half a turn for [m].
template <class Space>
double most_change(const ChainLeg<Space>& leg) {
  double most = 0;
  for (int j = 0; j < leg.chain.joints(); ++j)
    most += std::numbers::pi * leg.tendon_offset * leg.chain.turn_weight(j);
  return most;
}

/// Why no path can lead to that; ok where one may.
template <class Space>
Report check_hold(const ChainRobot<Space>& robot, std::span<const ChainHold> hold) {
  Report report;
  for (std::size_t i = 0; i < hold.size() && report.ok(); ++i) {
    const ChainLeg<Space>& leg = robot.legs[i];
    if (is_rigid(leg, hold[i])) {
      say_leg(report, Status::singular, i,
              " has so few joints that none can yield while its tendon's length is held; give the link more "
              "joints, or hold tensions");
    } else if (hold[i].length_of >= 0 && !(std::abs(hold[i].length - leg.chain.length) < most_change(leg))) {
      say_leg(report, Status::left_domain, i, ": a tendon that is ");
      append_mm(report.message, hold[i].length);
      report.message.append(
          " long would fold every joint by half a turn; its length at rest changes by at most ");
      append_mm(report.message, most_change(leg));
    }
  }
  return report;
}

/// `singular` where the platform is not held at all.
template <class Space>
void check_regularity(const Solver<Space>& solver, const typename Solver<Space>::Reduced& reduced,
                      Report& report) {
  if (solver.regularity(reduced) > 1e-10) return;
  report.status = Status::singular;
  report.message = {};
  report.message.append("the platform can move with everything held: a type II singularity, see velocity");
}

}  // namespace sinew::inline v0
