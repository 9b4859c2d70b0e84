/// @file leg_moves.hpp
/// How a leg on a chain moves with its platform: its own unknowns eliminated, in work that grows as its
/// joints do.
///
/// By the directions ψⱼ of its links, the sums of the joints' angles, springs couple neighbours and the force
/// acts on each link by itself, but for the turn of its line, which all of them share:
///
///     T ψ + ω y + γ f + τ t = −ρ        y = f (σ ωᵀψ + v·δx)        γᵀψ + c_x·δx = −c        τᵀψ = −(l − l*)
///
/// T is tridiagonal. It may be singular, as that of a chain that buckles, so the last link's equation joins
/// those of y, f and t. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include <array>
#include <cmath>

#include "kinematics/chains/elimination.hpp"
#include "kinematics/chains/leg_system.hpp"

namespace sinew::inline v0 {

/// What is free beside the legs' own unknowns: the platform, or the tension of each leg's inner tendon.
enum class Free { platform, tensions };

/// The unknowns of a leg, to first order in what is free: `dof` numbers, or one. A view of memory of the
/// solver's.
template <class Space>
class LegMoves {
 public:
  static constexpr int dof = Space::dof;
  static constexpr std::size_t sides = dof + 1;  ///< a constant, and what is free
  using Motion = Vec<double, dof>;
  using Rows = ChainWork::Rows;
  static constexpr std::size_t rows = max_chain_joints + 5;  ///< of memory that a leg needs

  /// @param is_even the joints bend in proportion to `even_bend`: one angle in place of all
  LegMoves(const PseudoRigid& chain, bool is_even, Free free, Rows::value_type* memory)
      : chain_(chain),
        is_even_(is_even),
        free_(free),
        links_(is_even ? 1 : static_cast<std::size_t>(chain.joints())),
        border_(memory),
        row_(memory + 5) {}

  void eliminate(const LegSystem<Space>& system) {
    Slopes slopes;
    to_links(system, slopes);
    if (is_even_) bend_evenly(static_cast<std::size_t>(system.joints), slopes);
    const bool swept = sweep(), joined = join(system, slopes);
    is_odd_ = (swept != joined) != (system.holds_length && free_ == Free::platform);
  }
  /// Whether an odd number of its directions is unstable with the platform held.
  bool is_odd() const { return is_odd_; }

  /// What the leg adds to the platform's equation S y = −g, y the platform's motion; of free tensions to g
  /// alone.
  void add_to(const LegSystem<Space>& system, Mat<double, dof, dof>& S, Motion& g) const {
    g += system.force * system.closure.c_x + push(system, 0);
    if (free_ == Free::tensions) return;
    for (int k = 0; k < dof; ++k) S.col(k) += push(system, static_cast<std::size_t>(k) + 1);
    S += system.force * system.closure.c_xx;
  }
  /// What the leg's own imbalance does to the platform, once its unknowns have made up for it.
  Motion shift(const LegSystem<Space>& system) const { return push(system, 0); }
  /// What a change of the tension that is free does to the platform.
  Motion pull(const LegSystem<Space>& system) const { return push(system, 1); }
  /// How the tension of a length that is held changes: a constant, and by the platform's motion.
  std::span<const double> tension_moves() const { return border_[tension]; }
  /// The change of that tension that leaves the platform without the leg's force.
  double relief(const LegSystem<Space>& system) const {
    return -(system.force + border_[force][0]) / border_[force][1];
  }

  /// Moves the leg along with y; returns the largest turn of a joint.
  double move(std::span<const double> y, const ChainHold& hold, ChainLegState& leg) const {
    std::array<double, 4> by;
    for (std::size_t i = 0; i < 4; ++i) {
      by[i] = border_[i][0];
      for (std::size_t k = 0; k < y.size(); ++k) by[i] += border_[i][k + 1] * y[k];
    }
    const bool holds_length = free_ == Free::platform && hold.length_of >= 0;
    const auto pulled = holds_length ? static_cast<std::size_t>(hold.length_of) : inner_tendon(leg, chain_);
    double most = 0, before = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(chain_.joints()); ++j) {
      double turn = is_even_ ? by[last] * even_bend(chain_, static_cast<int>(j)) : 0;
      if (!is_even_) {
        const double direction = link(j, by);
        turn = direction - before;
        before = direction;
      }
      leg.angles[j] += turn;
      most = worse(most, turn);
    }
    leg.force += by[force];
    leg.tension[pulled] += by[tension];
    return most;
  }

 private:
  Motion push(const LegSystem<Space>& system, std::size_t side) const {
    return system.force * system.closure.turn * border_[across][side] +
           system.closure.c_x * border_[force][side];
  }

  /// Unknowns of the border: the direction of the last link, the turn of the force's line, the force, a
  /// tension; and how far the tip moves across that line.
  enum Border : std::size_t { last, line, force, tension, across };
  /// Of a link's row: its entries of T, then the right-hand side, ω, γ and τ, and the last link's, once
  /// eliminated.
  enum Entry : std::size_t { diagonal, next, second, right, of_line, of_force, of_tension, of_last };
  using Slopes = std::array<std::array<double, 3>, max_chain_joints>;  ///< ω, γ and τ

  void to_links(const LegSystem<Space>& system, Slopes& slopes) const {
    const auto& closure = system.closure;
    const auto joints = static_cast<std::size_t>(system.joints);
    for (std::size_t j = 0; j < joints; ++j) {
      const bool has_next = j + 1 < joints;
      const auto difference = [&](const auto& of) { return of[j] - (has_next ? of[j + 1] : 0); };
      const double after = has_next ? system.stiffness[j + 1] : 0;
      slopes[j] = {difference(closure.across), difference(closure.c_q), difference(system.tendon)};
      row_[j] = {system.stiffness[j] + after + system.force * slopes[j][0],
                 -after,
                 0,
                 -difference(system.balance),
                 slopes[j][0],
                 slopes[j][1],
                 slopes[j][2],
                 0};
    }
  }

  /// One link whose direction stands for all.
  void bend_evenly(std::size_t joints, Slopes& slopes) const {
    typename Rows::value_type one{};
    std::array<double, 3> slope{};
    double direction = 0;
    for (std::size_t j = 0; j < joints; ++j) {
      direction += even_bend(chain_, static_cast<int>(j));
      const double ahead = j + 1 < joints ? direction + even_bend(chain_, static_cast<int>(j + 1)) : 0;
      one[diagonal] += direction * (row_[j][diagonal] * direction + 2 * row_[j][next] * ahead);
      for (std::size_t k = right; k <= of_tension; ++k) one[k] += direction * row_[j][k];
      for (std::size_t k = 0; k < 3; ++k) slope[k] += direction * slopes[j][k];
    }
    row_[0] = one;
    slopes[0] = slope;
  }

  /// Gauss, exchanging neighbours, of all links but the last; then each link's direction by the border's
  /// unknowns: ψ = right − of_line y − of_force f − of_tension t − of_last ψ_last.
  /// Whether the pivots' product is negative.
  bool sweep() const {
    bool is_negative = false;
    double below = links_ > 1 ? row_[0][next] : 0;  // T is symmetric until its rows are exchanged
    for (std::size_t k = 0; k + 1 < links_; ++k) {
      auto &pivot = row_[k], &row = row_[k + 1];
      const double coming = row[next];
      if (std::abs(below) > std::abs(pivot[diagonal])) {
        is_negative = !is_negative;
        std::swap(pivot[diagonal], below);
        std::swap(pivot[next], row[diagonal]);
        std::swap(pivot[second], row[next]);
        for (std::size_t s = right; s <= of_tension; ++s) std::swap(pivot[s], row[s]);
      }
      is_negative ^= pivot[diagonal] < 0;
      const double share = below / pivot[diagonal];
      row[diagonal] -= share * pivot[next];
      row[next] -= share * pivot[second];
      for (std::size_t s = right; s <= of_tension; ++s) row[s] -= share * pivot[s];
      below = coming;
    }
    for (std::size_t k = links_ - 1; k-- > 0;) {
      auto& row = row_[k];
      const double inverse = 1 / row[diagonal];
      put_in(row, next, k + 1);
      put_in(row, second, k + 2);
      for (std::size_t s = right; s <= of_last; ++s) row[s] *= inverse;
    }
    return is_negative;
  }
  void put_in(typename Rows::value_type& row, Entry entry, std::size_t link) const {
    if (link + 1 == links_) row[of_last] += row[entry];
    if (link + 1 >= links_) return;
    for (std::size_t s = right; s <= of_last; ++s) row[s] -= row[entry] * row_[link][s];
  }

  /// The border's equations, the directions of all links but the last put in. Whether their determinant is
  /// negative.
  bool join(const LegSystem<Space>& system, const Slopes& slopes) const {
    const auto& closure = system.closure;
    // what slopes times directions are: a constant, and by each unknown of the border
    std::array<std::array<double, 5>, 3> dot;
    for (std::size_t i = 0; i < 3; ++i) {
      dot[i] = {0, slopes[links_ - 1][i], 0, 0, 0};
      for (std::size_t k = 0; k + 1 < links_; ++k) {
        const double s = slopes[k][i];
        dot[i][0] += s * row_[k][right];
        dot[i][1] -= s * row_[k][of_last];
        for (std::size_t c = 0; c < 3; ++c) dot[i][c + 2] -= s * row_[k][of_line + c];
      }
    }
    const auto& end = row_[links_ - 1];
    double A[4][4] = {{end[diagonal], end[of_line], end[of_force], end[of_tension]}};
    double to[4][sides] = {{end[right]}};
    const auto put = [&](std::size_t row, std::size_t slope, double share, double constant) {
      for (std::size_t c = 0; c < 4; ++c) A[row][c] = share * dot[slope][c + 1];
      to[row][0] = constant - share * dot[slope][0];
    };
    put(line, 0, system.force * closure.sway, 0);
    A[line][line] -= 1;
    put(force, 1, 1, -closure.c);
    const bool holds_length = system.holds_length && free_ == Free::platform;
    if (holds_length) put(tension, 2, 1, -system.length_error);
    for (std::size_t k = 0; k + 1 < sides && free_ == Free::platform; ++k) {
      to[line][k + 1] = -system.force * closure.turn[static_cast<Eigen::Index>(k)];
      to[force][k + 1] = -closure.c_x[static_cast<Eigen::Index>(k)];
    }
    if (free_ == Free::tensions)
      for (std::size_t row = 0; row < 3; ++row) to[row][1] = -A[row][tension];
    const bool is_negative = sinew::eliminate(A[0], holds_length ? 4 : 3, 4, to[0], static_cast<int>(sides));
    if (!holds_length) to[tension][1] = free_ == Free::tensions ? 1 : 0;
    for (std::size_t s = 0; s < sides; ++s) {
      border_[across][s] = s == 0 ? dot[0][0] : 0;
      for (std::size_t c = 0; c < 4; ++c) {
        border_[c][s] = to[c][s];
        border_[across][s] += dot[0][c + 1] * to[c][s];
      }
    }
    return is_negative;
  }

  double link(std::size_t j, const std::array<double, 4>& by) const {
    const auto& row = row_[j];
    if (j + 1 == links_) return by[last];
    return row[right] - row[of_line] * by[line] - row[of_force] * by[force] - row[of_tension] * by[tension] -
           row[of_last] * by[last];
  }

  const PseudoRigid& chain_;
  bool is_even_, is_odd_ = false;
  Free free_;
  std::size_t links_;
  Rows::value_type *border_, *row_;
};

}  // namespace sinew::inline v0
