/// @file load_problem.hpp
/// The equilibrium of limbs and platform under a load that grows, as a curve (solve/tracer.hpp), whatever the
/// limbs are. Theory: docs/theory/limb_group.md
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/linalg.hpp"
#include "robot/limbs/limb_signs.hpp"
#include "robot/pose.hpp"
#include "solve/growing_load.hpp"

namespace sinew::inline v1 {

/// Unknowns are the platform's motion; the parameter λ is how much of a load is added. Turns count by the
/// group's radius, moments over it.
template <class SpaceT>
class LoadProblem {
 public:
  using Space = SpaceT;
  static constexpr int unknowns = Space::dof, forces = Space::dimension;
  using Group = LimbGroup<Space>;
  using Place = LimbPlace<Space>;
  using State = typename Place::State;
  using Twist = typename Group::Twist;
  using Wrench = typename Group::Wrench;

  LoadProblem(Group& group, const Wrench& load) : group_(group), first_(group.wrench()), load_(load) {
    for (int k = 0; k < group.limbs(); ++k) {
      size_ = std::max(size_, group.length(k));
      unit_ += group.stiffness(k) / std::pow(group.length(k), 3);
    }
  }

  /// @name A curve's
  /// @{
  void save(State& to) const {
    group_.save(to.limbs);
    to.platform = group_.platform();
  }
  void restore(const State& from) { group_.restore(from.limbs); }
  double evaluate() { return group_.evaluate(); }
  bool linearise() { return group_.linearise(); }
  bool refine() {
    if (group_.is_finest() || !(group_.truncation() > coarse_truncation)) return false;
    group_.refine();
    return true;
  }
  double size() const { return size_; }  ///< of the longest limb
  double unit() const { return unit_; }  ///< Σ EI/L³
  double tolerance() const { return group_.traits().tolerance; }
  double rounding() const { return group_.traits().rounding; }
  double longest_scale() const { return std::max(size_, comparable(load_).norm() / unit_); }

  using Rows = std::array<double, static_cast<std::size_t>(unknowns*(unknowns + 1))>;
  /// What the unknowns, and λ, each in metres, do to the balance of forces and, over the radius, of moments.
  /// After `linearise`.
  Rows equations(double scale) const {
    Rows rows;
    for (int k = 0; k < unknowns; ++k)
      put_column(rows, k, group_.stiffness().col(k), k < forces ? 1 : group_.radius());
    put_column(rows, unknowns, group_.project_wrench(-load_), scale);
    return rows;
  }
  Wrench residual() const { return comparable(group_.wrench_residual()); }
  void move(const Twist& step, double lambda, double change) {
    group_.move(comparable(step));
    put(lambda + change);
  }
  void put(double lambda) { group_.set_wrench(first_ + lambda * load_); }
  CurveSigns signs() const {
    const LimbSigns signs = signs_of(group_);
    return {.unstable = signs.unstable, .own = signs.own};
  }
  /// @}

  /// @name A written curve's
  /// @{
  Place place() const { return {{group_.state(), group_.platform()}}; }
  Twist way_from(const State& state) const {
    Twist way = twist_between(state.platform, group_.platform());
    way.template tail<unknowns - forces>() *= group_.radius();
    return way.normalized();
  }
  /// @}

  /// @name A growing load's
  /// @{
  /// Directions in which the whole gives way by itself: those of its limbs, and of the platform's stiffness
  /// over its radius the eigenvalues left of zero. Under a moment that is no symmetric matrix, and what its
  /// symmetric part says is more.
  int giving_way(const CurveSigns& signs) const {
    if (signs.unstable == 0) return 0;  // whose symmetric part is definite
    Eigen::Matrix<double, unknowns, unknowns, Eigen::RowMajor> scaled = group_.stiffness();
    scaled.template bottomRows<unknowns - forces>() /= group_.radius();
    scaled.template rightCols<unknowns - forces>() /= group_.radius();
    return signs.own + count_left_of_zero(MatrixView(scaled.data(), unknowns, unknowns));
  }
  bool is_symmetric() const { return group_.has_potential(); }
  double margin() const { return group_.margin(); }
  /// @}

 protected:
  /// Moments as forces; turns as lengths back to turns.
  Wrench comparable(Wrench of) const {
    of.template tail<unknowns - forces>() /= group_.radius();
    return of;
  }
  void put_column(Rows& rows, int column, const Wrench& wrench, double per) const {
    for (int r = 0; r < unknowns; ++r)
      rows[static_cast<std::size_t>((unknowns + 1) * r + column)] =
          wrench[r] / (r < forces ? per : per * group_.radius());
  }

  Group& group_;
  double size_ = 0, unit_ = 0;
  Wrench first_, load_;
};

/// How far a load grew.
struct GrownLoad {
  GrowthEnd end = GrowthEnd::limit;
  double load = 0;             ///< times the direction
  double definite_until = -1;  ///< see Growth
  int iterations = 0;
};

/// Most steps of a growing load, and most of Newton's iterations in all.
struct GrowthBudget {
  int steps = std::numeric_limits<int>::max(), iterations = std::numeric_limits<int>::max();
};

/// Adds a growing multiple of `direction` to the wrench of the state the group is in, to `limit`, or to where
/// the equilibrium gives way; by arc length, so that the load is exact to rounding there. The group is then
/// at the last equilibrium before.
template <class Space>
GrownLoad grow_load(LimbGroup<Space>& group, LimbPlaces<Space>& places,
                    const Vec<double, Space::dof>& direction, double limit, StopToken stop,
                    const GrowthBudget& budget);

}  // namespace sinew::inline v1
