/// @file curve_problem.hpp
/// What the solvers of curves ask of rods between a base and a platform (solve/tracer.hpp). Unknowns are the
/// platform's motion or, where that is led, six lengths. Theory: docs/theory/rod_robot.md
#pragma once
#include <algorithm>

#include "base/at.hpp"
#include "kinematics/load_problem.hpp"
#include "kinematics/rods/trace.hpp"
#include "kinematics/rods/verdict.hpp"
#include "robot/pose.hpp"
#include "solve/curve_writer.hpp"

namespace sinew::inline v1 {

class RodProblem : public LoadProblem<Spatial> {
 public:
  using Curve = EquilibriumCurve;

  RodProblem(RodGroup& system, const RodWay& way)
      : LoadProblem(system, way.target.wrench - way.begin.wrench),
        system_(system),
        way_(way) {}

  /// @name A curve's
  /// @{
  /// A pose that is held is known to rounding, which stiff rods turn into forces.
  double tolerance() const { return way_.holds_pose ? rod_quick_tolerance : rod_tolerance; }
  double rounding() const { return tolerance(); }
  double longest_scale() const {
    double fed = 0;
    for (int k = 0; k < system_.feeds(); ++k) fed = std::max(fed, std::abs(rate(k)));
    return std::max(size_, fed + comparable(load_).norm() / unit_);
  }
  Rows equations(double scale) const {
    Rows rows = LoadProblem::equations(scale);
    Wrench by_parameter = system_.project_wrench(-load_);
    if (way_.holds_pose) {
      for (int k = 0; k < 6; ++k) put_column(rows, k, system_.input_wrench_jacobian(k), 1);
      by_parameter += system_.stiffness() * twist_between(way_.from, way_.to);
    } else {
      for (int input = 0; input < system_.inputs(); ++input)
        for (int rod = 0; rod < system_.feeds(); ++rod)
          if (system_.input_of(rod) == input) {
            by_parameter += rate(rod) * system_.input_wrench_jacobian(input);
            break;
          }
    }
    put_column(rows, 6, by_parameter, scale);
    return rows;
  }

  void move(const Twist& step, double lambda, double change) {
    std::array<double, max_rods> fed{};
    Twist twist = comparable(step);
    if (way_.holds_pose) {
      for (int k = 0; k < 6; ++k) fed[at(k)] = step[k];
      twist = twist_between(system_.platform(), way_.pose(lambda + change));
    } else {
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
      for (int k = 0; k < system_.feeds(); ++k) system_.set_feed(k, now.lengths[at(k)]);
  }
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
    point.potential = system_.potential(system_.energy());
    return point;
  }
  bool is_same(const CurvePoint& one, const CurvePoint& other) const {
    double apart = (one.pose.position - other.pose.position).norm();
    for (std::size_t k = 0; k < one.inputs.size(); ++k)
      apart = std::max(apart, std::abs(one.inputs[k] - other.inputs[k]));
    return apart < 1e-8 * size_;
  }
  bool is_far(double longest_rod = 10) const {
    for (int k = 0; k < system_.limbs(); ++k)
      if (system_.length(k) > longest_rod * size_) return true;
    return false;
  }
  CurveEnd end_of(CurveStop stop) const {
    constexpr CurveEnd ends[] = {CurveEnd::left_range,  CurveEnd::closed,  CurveEnd::max_points,
                                 CurveEnd::far,         CurveEnd::stopped, CurveEnd::stalled,
                                 CurveEnd::not_followed};
    return stop == CurveStop::stuck ? why_stuck<CurveEnd>(system_) : ends[static_cast<int>(stop)];
  }
  /// @}

 private:
  /// dL/dλ of a rod.
  double rate(int rod) const { return way_.target.lengths[at(rod)] - way_.begin.lengths[at(rod)]; }

  RodGroup& system_;
  const RodWay& way_;
};

}  // namespace sinew::inline v1
