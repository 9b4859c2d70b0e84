/// @file leg_factors.hpp
/// A chain's own equations, factored: how it moves with its platform, in work that grows as its joints do.
///
/// By the directions ψⱼ of its links, the sums of the joints' angles, springs couple neighbours and the force
/// acts on each link by itself, but for the turn of its line, which all of them share:
///
///     T ψ + s ω η + γ f + τ t = −ρ     s ωᵀψ − ε η = −ε (f/s) v·δx     γᵀψ = −c − c_x·δx     τᵀψ = −(l − l*)
///
/// with s² = |f σ|, ε the sign of f σ and s η the moment of that turn. The matrix is symmetric, T
/// tridiagonal: T = L D Lᵀ with blocks of one link or of two, where a pivot is small, up to the last one or
/// two, which join the others. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/limits.hpp"
#include "kinematics/chains/leg_system.hpp"
#include "math/symmetric_factors.hpp"

namespace sinew::inline v1 {

/// The unknowns of a leg, to first order in what moves them: its own imbalance, the platform, and its feed,
/// the tension of the inner tendon or the length that is held.
template <class Space>
class LegFactors {
 public:
  static constexpr int dof = Space::dof;
  using Motion = Vec<double, dof>;
  enum Side : std::size_t { own, platform, feed = platform + dof, sides };  ///< from `platform` on as a twist

  /// Of a leg that does not yield all that follows is no number.
  /// @param is_even the joints bend in proportion to `even_bend`: one angle in place of all
  void factor(const PseudoRigid& chain, const LegSystem<Space>& system, bool is_even) {
    is_even_ = is_even;
    links_ = static_cast<std::size_t>(system.joints);
    holds_length_ = system.holds_length;
    force_ = system.force;
    const double turning = force_ * system.closure.sway;
    line_ = std::sqrt(std::abs(turning));
    line_sign_ = turning < 0 ? -1 : 1;
    to_links(system);
    if (is_even_) bend_evenly(chain);
    sweep();
    factor_border();
    solve_border(system);
    if (!system.yields)  // nothing is to be read off what rounding leaves
      for (auto& side : by_) side.fill(std::numeric_limits<double>::quiet_NaN());
  }

  /// Unstable directions with the platform held: negative eigenvalues beyond those of the constraints and of
  /// the line.
  int unstable() const {
    return std::max(0, swept_ + border_.negatives() - (holds_length_ ? 2 : 1) - (line_sign_ > 0 ? 1 : 0));
  }

  /// What the leg's force and its line do to the platform.
  Motion push(const LegSystem<Space>& system, std::size_t side) const {
    const auto& closure = system.closure;
    double turned = line_ * by_[side][line];
    if (side >= platform && side < feed)
      turned -= force_ * closure.turn[static_cast<Eigen::Index>(side - platform)];
    return closure.turn * (turned / closure.sway) + closure.c_x * by_[side][force];
  }
  double force_by(std::size_t side) const { return by_[side][force]; }      ///< of chord or strut
  double tension_by(std::size_t side) const { return by_[side][tension]; }  ///< of the tendon that is fed

  /// How the leg moves by its own imbalance, the platform and the feed; returns the largest turn of a joint.
  double plan(const PseudoRigid& chain, const Motion& twist, double fed) {
    change_ = by_[own];
    for (std::size_t i = 0; i < border_size; ++i) {
      for (std::size_t k = 0; k < dof; ++k)
        change_[i] += by_[platform + k][i] * twist[static_cast<Eigen::Index>(k)];
      change_[i] += by_[feed][i] * fed;
    }
    put_back(turns_);
    const double even = turns_[0];
    double most = 0, before = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(chain.joints()); ++j) {
      const double direction = turns_[j];
      turns_[j] = is_even_ ? even * even_bend(chain, static_cast<int>(j)) : direction - before;
      before = direction;
      most = worse(most, turns_[j]);
    }
    return most;
  }
  void move(const PseudoRigid& chain, ChainLegState& leg, std::size_t tendon) const {
    for (std::size_t j = 0; j < static_cast<std::size_t>(chain.joints()); ++j) leg.angles[j] += turns_[j];
    leg.force += change_[force];
    leg.tension[tendon] += change_[tension];
  }

 private:
  /// Unknowns of the border: the turn of the force's line, the force, a tension, and the last links.
  enum Border : std::size_t { line, force, tension, last, border_size = last + 2 };
  /// Columns that are swept along with T.
  enum Column : std::size_t { of_line, of_force, of_tension, right, columns };
  struct Link {
    double pivot, next;  ///< of T; below
    std::array<double, columns> by;
    bool is_paired;  ///< with the next link in one block
  };

  void to_links(const LegSystem<Space>& system) {
    const auto& closure = system.closure;
    for (std::size_t j = 0; j < links_; ++j) {
      const bool has_next = j + 1 < links_;
      const auto difference = [&](const auto& of) { return of[j] - (has_next ? of[j + 1] : 0); };
      const double after = has_next ? system.stiffness[j + 1] : 0, across = difference(closure.across);
      link_[j] = {
          system.stiffness[j] + after + force_ * across,
          -after,
          {line_ * across, difference(closure.c_q), difference(system.tendon), -difference(system.balance)},
          false};
    }
  }

  /// One link whose direction stands for all.
  void bend_evenly(const PseudoRigid& chain) {
    Link one{};
    double direction = 0;
    for (std::size_t j = 0; j < links_; ++j) {
      direction += even_bend(chain, static_cast<int>(j));
      const double ahead = j + 1 < links_ ? direction + even_bend(chain, static_cast<int>(j + 1)) : 0;
      one.pivot += direction * (link_[j].pivot * direction + 2 * link_[j].next * ahead);
      for (std::size_t k = 0; k < columns; ++k) one.by[k] += direction * link_[j].by[k];
    }
    link_[0] = one;
    links_ = 1;
  }

  /// All links but the last, or the last two, out of the others and of the border.
  void sweep() {
    constexpr double alpha = 0.6180339887498949;  // (√5 − 1)/2 (Bunch 1974): bounds how much entries grow
    for (auto& row : schur_) row.fill(0);
    swept_ = 0;
    std::size_t k = 0;
    while (k + 1 < links_) {
      Link &here = link_[k], &next = link_[k + 1];
      const double beside = std::abs(here.next);
      const double largest = std::max({beside, std::abs(next.pivot), std::abs(next.next)});
      here.is_paired = std::abs(here.pivot) * largest < alpha * beside * beside;
      if (!here.is_paired) {
        sweep_one(here, next);
        ++k;
      } else if (k + 2 < links_) {
        sweep_pair(here, next, link_[k + 2]);
        k += 2;
      } else {
        break;
      }
    }
    swept_links_ = k;
  }
  void sweep_one(Link& here, Link& next) {
    swept_ += here.pivot < 0;
    const double inverse = 1 / here.pivot, share = here.next * inverse;
    next.pivot -= share * here.next;
    for (std::size_t c = 0; c < columns; ++c) next.by[c] -= share * here.by[c];
    for (std::size_t r = 0; r < right; ++r)
      for (std::size_t c = r; c < columns; ++c) schur_[r][c] -= inverse * here.by[r] * here.by[c];
  }
  void sweep_pair(const Link& here, const Link& next, Link& after) {
    ++swept_;  // the block is indefinite
    const Pair block(here, next);
    const auto [first, second] = block.solve(0, next.next);
    after.pivot -= second * next.next;
    for (std::size_t c = 0; c < columns; ++c) after.by[c] -= first * here.by[c] + second * next.by[c];
    for (std::size_t c = 0; c < columns; ++c) {
      const auto [x, y] = block.solve(here.by[c], next.by[c]);
      for (std::size_t r = 0; r < right && r <= c; ++r) schur_[r][c] -= here.by[r] * x + next.by[r] * y;
    }
  }
  struct Pair {
    double a, b, c, per;
    Pair(const Link& here, const Link& next)
        : a(here.pivot),
          b(here.next),
          c(next.pivot),
          per(1 / (a * c - b * b)) {}
    std::pair<double, double> solve(double x, double y) const {
      return {per * (c * x - b * y), per * (a * y - b * x)};
    }
  };

  std::size_t last_links() const { return links_ - swept_links_; }

  /// Rows of the border's matrix in the order of `Border`, without the tension where it is fed: it is then
  /// the last links' place that follows the force.
  void factor_border() {
    typename SymmetricFactors<border_size>::Square M{};
    const std::size_t first = holds_length_ ? last : tension, count = last_links();
    for (std::size_t r = 0; r < first; ++r)
      for (std::size_t c = r; c < first; ++c) M[r][c] = M[c][r] = schur_[r][c];
    M[line][line] -= line_sign_;
    for (std::size_t k = 0; k < count; ++k) {
      const Link& link = link_[swept_links_ + k];
      for (std::size_t c = 0; c < first; ++c) M[c][first + k] = M[first + k][c] = link.by[c];
      M[first + k][first + k] = link.pivot;
      if (k > 0) M[first][first + 1] = M[first + 1][first] = link_[swept_links_].next;
    }
    border_.factor(M, first + count);
  }

  void solve_border(const LegSystem<Space>& system) {
    const auto& closure = system.closure;
    const std::size_t first = holds_length_ ? last : tension, count = last_links();
    const double per_line = line_ > 0 ? -line_sign_ * force_ / line_ : 0;
    for (std::size_t side = 0; side < sides; ++side) {
      auto& to = by_[side];
      to.fill(0);
      if (side == own) {
        for (std::size_t r = 0; r < first; ++r) to[r] = schur_[r][right];
        to[force] -= closure.c;
        if (holds_length_) to[tension] -= system.length_error;
        for (std::size_t k = 0; k < count; ++k) to[first + k] = link_[swept_links_ + k].by[right];
      } else if (side < feed) {
        const auto k = static_cast<Eigen::Index>(side - platform);
        to[line] = per_line * closure.turn[k];
        to[force] = -closure.c_x[k];
      } else if (holds_length_) {
        to[tension] = 1;
      } else {
        to[line] = -schur_[line][of_tension];
        to[force] = -schur_[force][of_tension];
        for (std::size_t k = 0; k < count; ++k) to[first + k] = -link_[swept_links_ + k].by[of_tension];
      }
      border_.solve(to);
      if (holds_length_) continue;
      for (std::size_t k = count; k-- > 0;) to[last + k] = to[first + k];
      to[tension] = side == feed ? 1 : 0;
    }
  }

  /// The directions of all links from those of the border's unknowns.
  void put_back(std::array<double, max_chain_joints>& direction) const {
    const auto& z = change_;
    for (std::size_t k = swept_links_; k < links_; ++k) direction[k] = z[last + k - swept_links_];
    const auto left = [&](const Link& link) {
      return link.by[right] - link.by[of_line] * z[line] - link.by[of_force] * z[force] -
             link.by[of_tension] * z[tension];
    };
    for (std::size_t k = swept_links_; k-- > 0;) {
      if (k > 0 && link_[k - 1].is_paired) {
        --k;
        const Link &here = link_[k], &next = link_[k + 1];
        std::tie(direction[k], direction[k + 1]) =
            Pair(here, next).solve(left(here), left(next) - next.next * direction[k + 2]);
      } else {
        direction[k] = (left(link_[k]) - link_[k].next * direction[k + 1]) / link_[k].pivot;
      }
    }
  }

  std::size_t links_ = 0, swept_links_ = 0;
  bool is_even_ = false, holds_length_ = false;
  double force_ = 0, line_ = 0, line_sign_ = 1;
  int swept_ = 0;  ///< negative eigenvalues of what is swept
  std::array<Link, max_chain_joints> link_;
  std::array<std::array<double, columns>, right> schur_;  ///< what the sweep leaves of the border, above
  SymmetricFactors<border_size> border_;
  std::array<std::array<double, border_size>, sides> by_;  ///< the border's unknowns
  std::array<double, border_size> change_{};               ///< ... as planned
  std::array<double, max_chain_joints> turns_{};           ///< of the joints, as planned [rad]
};

}  // namespace sinew::inline v1
