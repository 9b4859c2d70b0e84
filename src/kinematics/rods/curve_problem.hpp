/// @file curve_problem.hpp
/// What the solvers of curves ask of rods between a base and a platform (solve/tracer.hpp). Unknowns are the
/// platform's motion or, where that is led, six lengths. Theory: docs/theory/rod_robot.md
#pragma once
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/rods/trace.hpp"
#include "kinematics/rods/verdict.hpp"
#include "robot/pose.hpp"
#include "solve/curve_writer.hpp"

namespace sinew::inline v0 {

class RodProblem {
 public:
  static constexpr int unknowns = 6;
  using Place = RodPlace;
  using State = RodPlace::State;
  using Curve = EquilibriumCurve;
  using Twist = Vec<double, 6>;

  RodProblem(RodGroup& system, const RodWay& way) : system_(system), way_(way) {
    for (int k = 0; k < system_.limbs(); ++k) {
      const double length = system_.length(k);
      size_ = std::max(size_, length);
      unit_ += system_.stiffness(k) / (length * length * length);
    }
  }

  /// @name A curve's
  /// @{
  Place place() const { return {{system_.state(), system_.platform()}}; }
  void save(State& to) const {
    system_.save(to.limbs);
    to.platform = system_.platform();
  }
  void restore(const State& from) { system_.restore(from.limbs); }
  double evaluate() { return system_.evaluate(); }
  bool linearise() { return system_.linearise(); }
  bool refine() {
    if (system_.is_finest() || !(system_.truncation() > coarse_truncation)) return false;
    system_.refine();
    return true;
  }
  double size() const { return size_; }  ///< of the longest rod
  double unit() const { return unit_; }  ///< Σ EI/L³
  /// A pose that is held is known to rounding, which stiff rods turn into forces.
  double tolerance() const { return way_.holds_pose ? rod_quick_tolerance : rod_tolerance; }
  /// No step where the error is small enough: near to where the equations are singular it would be one in the
  /// dark.
  double rounding() const { return tolerance(); }
  double longest_scale() const {
    double fed = 0;
    for (int k = 0; k < system_.feeds(); ++k) fed = std::max(fed, std::abs(rate(k)));
    const Twist load = way_.target.wrench - way_.begin.wrench;
    const double pressed =
        size_ * std::hypot(load.head<3>().norm(), load.tail<3>().norm() / system_.radius());
    return std::max(size_, fed + pressed / (unit_ * size_));
  }

  /// What the unknowns, and λ, each in metres, do to the balance of forces and, over the platform's radius,
  /// of moments. After `linearise`.
  std::array<double, 42> equations(double scale) const {
    const double radius = system_.radius();
    std::array<double, 42> rows;
    const auto put_column = [&](int column, const Twist& wrench, double per) {
      for (int r = 0; r < 6; ++r) rows[at(7 * r + column)] = wrench[r] / (r < 3 ? per : per * radius);
    };
    const auto stiffness = system_.stiffness();
    Twist by_parameter = system_.project_wrench(way_.begin.wrench - way_.target.wrench);
    if (way_.holds_pose) {
      for (int k = 0; k < 6; ++k) put_column(k, system_.input_wrench_jacobian(k), 1);
      by_parameter += stiffness * between(way_.from, way_.to);
    } else {
      for (int k = 0; k < 6; ++k) put_column(k, stiffness.col(k), k < 3 ? 1 : radius);
      for (int input = 0; input < system_.inputs(); ++input)
        for (int rod = 0; rod < system_.feeds(); ++rod)
          if (system_.input_of(rod) == input) {
            by_parameter += rate(rod) * system_.input_wrench_jacobian(input);
            break;
          }
    }
    put_column(6, by_parameter, scale);
    return rows;
  }
  Twist missing() const {
    Twist missing = system_.wrench_residual();
    for (int r = 3; r < 6; ++r) missing[r] /= system_.radius();
    return missing;
  }

  void move(const Twist& step, double lambda, double change) {
    std::array<double, max_rods> fed{};
    Twist twist = Twist::Zero();
    if (way_.holds_pose) {
      for (int k = 0; k < 6; ++k) fed[at(k)] = step[k];
      twist = between(system_.platform(), way_.pose(lambda + change));
    } else {
      twist = step;
      twist.tail<3>() /= system_.radius();
      for (int k = 0; k < system_.feeds(); ++k) fed[at(system_.input_of(k))] = change * rate(k);
    }
    system_.move(twist, std::span<const double>(fed).first(at(system_.inputs())));
    put(lambda + change);
  }
  /// Lengths, wrench and held pose as λ has them: what a step moved by increments, exactly.
  void put(double lambda) {
    const RodTarget now = way_.at(lambda, system_.feeds());
    system_.set_wrench(now.wrench);
    if (way_.holds_pose)
      system_.set_platform(way_.pose(lambda));
    else
      for (int k = 0; k < system_.feeds(); ++k) system_.hold(k, now.lengths[at(k)]);
  }

  CurveSigns signs() const {
    const RodSigns signs = signs_of(system_);
    return {.unstable = signs.unstable, .own = signs.own};
  }
  /// @}

  /// @name A growing load's
  /// @{
  /// Directions in which the whole gives way by itself: those of its rods, and of the platform's stiffness
  /// over its radius the eigenvalues left of zero. Under a moment that is no symmetric matrix, and what its
  /// symmetric part says is more.
  int giving_way(const CurveSigns& signs) const {
    if (signs.unstable == 0) return 0;  // whose symmetric part is definite
    const auto stiffness = system_.stiffness();
    Eigen::Matrix<double, 6, 6> scaled;
    const double radius = system_.radius();
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c)
        scaled(r, c) = stiffness(r, c) / ((r < 3 ? 1 : radius) * (c < 3 ? 1 : radius));
    const Eigen::EigenSolver<Eigen::Matrix<double, 6, 6>> solved(scaled, false);
    int count = signs.own;
    for (int k = 0; k < 6; ++k) count += solved.eigenvalues()[k].real() < 0;
    return count;
  }
  bool is_symmetric() const { return system_.wrench().tail<3>() == Vec3<double>::Zero(); }
  double margin() const { return system_.margin(); }
  /// @}

  /// @name A written curve's
  /// @{
  CurvePoint point(double lambda, double residual, CurveMark mark, int unstable) const {
    CurvePoint point;
    point.parameter = lambda;
    static_assert(static_cast<int>(CurveEvent::fold) == static_cast<int>(CurveMark::fold) &&
                  static_cast<int>(CurveEvent::stability) == static_cast<int>(CurveMark::stability));
    point.event = static_cast<CurveEvent>(mark);
    point.pose = spatial_pose(system_.platform());
    point.inputs.resize(at(system_.inputs()));
    for (int k = 0; k < system_.feeds(); ++k) point.inputs[at(system_.input_of(k))] = system_.held(k);
    point.unstable_directions = unstable;
    point.residual = residual;
    point.potential = system_.potential();
    return point;
  }
  bool is_same(const CurvePoint& one, const CurvePoint& other) const {
    double apart = (one.pose.position - other.pose.position).norm();
    for (std::size_t k = 0; k < one.inputs.size(); ++k)
      apart = std::max(apart, std::abs(one.inputs[k] - other.inputs[k]));
    return apart < 1e-8 * size_;
  }
  Twist way_from(const State& state) const {
    const SE3<double>&from = state.platform, &here = system_.platform();
    Twist way;
    way << here.p - from.p, system_.radius() * here.R.compose(from.R.inverse()).log();
    return way.normalized();
  }
  bool is_far(double longest_rod = 10) const {
    for (int k = 0; k < system_.limbs(); ++k)
      if (system_.length(k) > longest_rod * size_) return true;
    return false;
  }
  CurveEnd end_of(CurveStop stop) const {
    constexpr CurveEnd ends[] = {CurveEnd::left_range, CurveEnd::closed,  CurveEnd::max_points,
                                 CurveEnd::far,        CurveEnd::stopped, CurveEnd::stalled};
    return stop == CurveStop::stuck ? why_stuck<CurveEnd>() : ends[static_cast<int>(stop)];
  }
  /// @tparam End CurveEnd or LoadEnd
  template <class End>
  End why_stuck() const {
    if (system_.is_finest() && system_.truncation() > coarse_truncation) return End::sharp;
    return is_pulled_straight(system_) ? End::straight : End::stalled;
  }
  /// @}

 private:
  /// dL/dλ of a rod.
  double rate(int rod) const { return way_.target.lengths[at(rod)] - way_.begin.lengths[at(rod)]; }

  RodGroup& system_;
  const RodWay& way_;
  double size_ = 0, unit_ = 0;
};

}  // namespace sinew::inline v0
