/// @file solver.hpp
/// Newton's method for platforms on chains, legs eliminated, and paths of its solutions. Theory:
/// docs/theory/chain_equilibrium.md
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/chains/leg_moves.hpp"
#include "sinew/kinematics/chain_sensing.hpp"
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
    work.pulls.resize(robot.legs.size());
    work.step.resize(free == Free::tensions ? robot.legs.size() : static_cast<std::size_t>(dof));
    for (const auto& leg : robot.legs) {
      size_ = std::max(size_, leg.chain.length);
      stiffness_ = std::max(stiffness_, leg.bending_stiffness / std::pow(leg.chain.length, 3));
    }
  }

  /// From now on the platform's equation is that tensions of lengths that are held are these, whatever the
  /// wrench: that is `balance` then, if 0 is given.
  void measure(std::span<const MeasuredTension> measured) { measured_ = measured; }
  /// Of the platform, what is left of its forces less the wrench.
  const Motion& balance() const { return balance_; }

  /// What is left for the platform with the legs eliminated: S y = −g, y its motion, or the tensions; of
  /// tensions that are not as many as freedoms A Aᵀ in place of S, for the work's `pulls` A.
  struct Reduced {
    Mat<double, dof, dof> S;
    Motion g;
  };

  /// Smallest over largest singular value of what is left for the platform, as forces and lengths: 0 where
  /// nothing says how it moves.
  double regularity(const Reduced& reduced) const {
    Eigen::Matrix<double, dof, dof, Eigen::RowMajor> S = reduced.S;
    for (int k = Space::dimension; k < dof; ++k) {
      if (measured_.empty()) S.row(k) /= size_;
      if (free_ == Free::platform) S.col(k) /= size_;
    }
    if (free_ == Free::tensions && !is_square()) S.rightCols(dof - Space::dimension) /= size_;
    if (!S.allFinite()) return 0;
    std::array<double, max_rows> sigma;
    singular_values(MatrixView(S.data(), dof, dof), sigma);
    const double ratio = sigma[dof - 1] / sigma[0];
    return free_ == Free::platform || is_square() ? ratio : std::sqrt(ratio);
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
    balance_ = -wrench;
    residual_ = 0;
    odd_legs_ = 0;
    for (std::size_t i = 0; i < legs.size(); ++i) {
      const auto& leg = robot_.legs[i];
      form(leg, platform, legs[i], hold[i], system_);
      measure(leg);
      LegMoves<Space> moves = moves_of(i);
      moves.eliminate(system_);
      odd_legs_ += moves.is_odd();
      if (measured_.empty())
        moves.add_to(system_, reduced.S, reduced.g);
      else
        add_reading(moves, i, legs[i], reduced);
      if (free_ == Free::tensions) add_pull(moves, i, reduced.S);
      balance_ += legs[i].force * system_.closure.c_x;
    }
    for (int k = 0; k < dof && measured_.empty(); ++k)
      residual_ = worse(residual_, balance_[k] / stiffness_ / (k >= Space::dimension ? size_ : 1));
    return reduced;
  }

  /// Of the system last reduced: legs that are unstable by themselves in an odd number of directions.
  int odd_legs() const { return odd_legs_; }
  double size() const { return size_; }  ///< of the longest chain

  /// The largest turn of a joint as the platform, or the tensions, move from where they were last reduced.
  double move(std::vector<ChainLegState>& legs, std::span<const ChainHold> hold,
              std::span<const double> all) {
    double step = 0;
    for (std::size_t i = 0; i < legs.size(); ++i)
      step =
          worse(step, moves_of(i).move(free_ == Free::tensions ? all.subspan(i, 1) : all, hold[i], legs[i]));
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
      find_step(reduced, legs);
      const double step = move(legs, hold, work_.step);
      if (free_ == Free::platform) pose = Space::moved(pose, Motion(work_.step.data()));
      walked += step;
      if (!(walked < reach)) return false;
      if (step < 1e-11 || (residual_ < 1e-13 * size_ && step < 1e-9)) {
        reached_ = reduce(pose, legs, hold, wrench);
        if (residual_ < 1e-11 * size_) return true;  // or else the platform moves, and no joint yet
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
  bool is_square() const { return robot_.legs.size() == static_cast<std::size_t>(dof); }

  void add_pull(const LegMoves<Space>& moves, std::size_t leg, Mat<double, dof, dof>& S) {
    const Motion pull = moves.pull(system_);
    auto& row = work_.pulls[leg];
    std::copy_n(pull.data(), dof, row.begin());
    row[relief] = moves.relief(system_);
    if (is_square())
      S.col(static_cast<Eigen::Index>(leg)) = pull;
    else
      S += pull * pull.transpose();
  }

  /// A tension that is measured, as an equation for the platform.
  void add_reading(const LegMoves<Space>& moves, std::size_t leg, const ChainLegState& state,
                   Reduced& reduced) {
    for (std::size_t k = 0; k < measured_.size(); ++k) {
      if (measured_[k].leg != static_cast<int>(leg)) continue;
      const auto row = static_cast<Eigen::Index>(k);
      const auto by = moves.tension_moves();
      const double gap =
          state.tension[static_cast<std::size_t>(work_.hold[leg].length_of)] - measured_[k].tension;
      reduced.g[row] = gap + by[0];
      for (int j = 0; j < dof; ++j) reduced.S(row, j) = by[static_cast<std::size_t>(j) + 1];
      residual_ = worse(residual_, gap * robot_.legs[leg].tendon_offset / size_ / stiffness_);
    }
  }

  /// Tensions that are not as many as freedoms: the nearest ones to the work's `near`, or without those the
  /// ones that leave every leg without force.
  void find_step(const Reduced& reduced, std::span<const ChainLegState> legs) {
    if (free_ == Free::platform || is_square()) {
      const Motion step = solution(reduced.S, -reduced.g);
      std::copy_n(step.data(), dof, work_.step.begin());
      return;
    }
    const auto column = [&](std::size_t i) { return Motion(work_.pulls[i].data()); };
    const auto gone = [&](std::size_t i) {
      return legs[i].tension[inner_tendon(legs[i], robot_.legs[i].chain)] - work_.near[i];
    };
    Motion right = -reduced.g;
    for (std::size_t i = 0; i < work_.near.size(); ++i) right += gone(i) * column(i);
    const Motion share = solution(reduced.S, right);
    for (std::size_t i = 0; i < legs.size(); ++i)
      work_.step[i] = work_.near.empty() ? work_.pulls[i][relief] : dot(column(i), share) - gone(i);
  }

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
  std::span<const MeasuredTension> measured_ = {};
  Motion balance_ = Motion::Zero();
  Reduced begun_{Mat<double, dof, dof>::Zero(), Motion::Zero()}, reached_ = begun_;
  double size_ = 0, stiffness_ = 0, residual_ = 0;
  int iterations_ = 0, odd_legs_ = 0;
  static constexpr std::size_t relief = 7;  ///< behind a leg's pull
};

}  // namespace sinew::inline v0
