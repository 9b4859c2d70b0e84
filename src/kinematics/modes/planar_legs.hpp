/// @file planar_legs.hpp
/// The legs of a planar robot as the search for its assembly modes sees them.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>

#include "leg/platform_constraint.hpp"
#include "sinew/math/se2.hpp"

namespace sinew::inline v1 {

/// The legs in units of their size and about the shortest: there the pose is (s, R) with s = A₁→B₁, and leg i
/// closes where |s + R bᵢ − aᵢ| is its distance.
class ScaledLegs {
 public:
  explicit ScaledLegs(std::span<const PlatformConstraint<2>> legs) : legs_(legs) {
    for (std::size_t i = 1; i < legs.size(); ++i)
      if (legs[i].distance < legs[first_].distance) first_ = i;
    for (const PlatformConstraint<2>& leg : legs) size_ = std::max({size_, leg.distance, extent(leg)});
    for (std::size_t i = 0; i < legs.size(); ++i) constraints_ += is_pinned(i) ? 2U : 1U;
  }

  std::size_t count() const { return legs_.size(); }
  std::size_t first() const { return first_; }
  std::size_t constraints() const { return constraints_; }
  double size() const { return size_; }
  bool is_pinned(std::size_t i) const { return legs_[i].distance <= 1e-14 * size_; }

  PlatformConstraint<2> operator[](std::size_t i) const {
    return {(legs_[i].anchor - legs_[first_].anchor) / size_, legs_[i].distance / size_,
            (legs_[i].platform_point - legs_[first_].platform_point) / size_};
  }

  /// Largest closure error, in units of the size.
  double error(const SE2<double>& pose) const {
    double worst = 0;
    for (std::size_t i = 0; i < count(); ++i) {
      const PlatformConstraint<2> leg = (*this)[i];
      worst = std::max(worst, leg.closure_error(pose.point(leg.platform_point) - leg.anchor));
    }
    return worst;
  }

  PlanarPose in_metres(const SE2<double>& pose) const {
    const PlatformConstraint<2>& first = legs_[first_];
    return planar_pose({first.anchor + size_ * pose.p - pose.rotate(first.platform_point), pose.c, pose.s});
  }

 private:
  double extent(const PlatformConstraint<2>& leg) const {
    return std::max((leg.anchor - legs_[first_].anchor).cwiseAbs().maxCoeff(),
                    (leg.platform_point - legs_[first_].platform_point).cwiseAbs().maxCoeff());
  }

  std::span<const PlatformConstraint<2>> legs_;
  std::size_t first_ = 0, constraints_ = 0;
  double size_ = 0;
};

/// Normal equations of all closures at a pose; the motion is (δx, δy, δφ) about B₁.
struct NormalEquations {
  Mat<double, 3, 3> matrix = Mat<double, 3, 3>::Zero();
  Vec3<double> right = Vec3<double>::Zero();

  void add(const Vec3<double>& row, double error) {
    matrix += row * row.transpose();
    right -= error * row;
  }
};

inline NormalEquations normal_equations(const ScaledLegs& legs, const SE2<double>& pose) {
  NormalEquations normal;
  for (std::size_t i = 0; i < legs.count(); ++i) {
    const PlatformConstraint<2> leg = legs[i];
    const Vec2<double> arm = pose.rotate(leg.platform_point), gap = pose.p + arm - leg.anchor;
    if (legs.is_pinned(i)) {
      normal.add({1, 0, -arm.y()}, gap.x());
      normal.add({0, 1, arm.x()}, gap.y());
    } else if (const double distance = gap.norm(); distance > 0) {
      const Vec2<double> n = gap / distance;
      normal.add({n.x(), n.y(), cross(arm, n)}, distance - leg.distance);
    }
  }
  return normal;
}

}  // namespace sinew::inline v1
