/// @file shooting_rod.hpp
/// The general rod (link/spatial_rod.hpp) shot from its base: an integration of order 8 with its exact
/// derivative, which shares nothing with the fields of frames that the library solves. Tests judge these by
/// it.
#pragma once
#include <span>

#include "link/spatial_rod.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// A cross-section and what is beyond it.
template <Scalar S>
struct RodState {
  Vec3<S> p = Vec3<S>(S(0), S(0), S(0));  ///< [m]
  SO3<S> R;                               ///< section to base axes
  Vec3<S> n = Vec3<S>(S(0), S(0), S(0));  ///< internal force [N]
  Vec3<S> m = Vec3<S>(S(0), S(0), S(0));  ///< internal moment [N m]

  Vec3<S> tangent() const { return R.rotate(Vec3<S>(S(0), S(0), S(1))); }  ///< third axis of the section
};

/// How finely a rod is integrated.
struct RodSteps {
  int steps = 0;             ///< even steps of order 8; 0: as many as the tolerance asks for
  double tolerance = 1e-12;  ///< on the estimated error, of L and in rad; where steps are not given
};

inline constexpr int max_rod_steps = 1024;

/// The far end of a rod that starts with a given state.
struct RodTip {
  Status status =
      Status::left_domain;  ///< `iteration_limit`: the tolerance asks for more than `max_rod_steps`
  int steps = 0;            ///< taken
  double error = 0;         ///< estimated, of p over L and of R in rad; 0 where the steps were given
  RodState<double> state;
  /// Elastic energy plus the potential of the load, −∫f·(p − p(0)) ds [J].
  double energy = 0;
  double potential = 0;  ///< the second part alone [J]
};

/// Starts at `base`, whose n and m are those at s = 0. @param length L [m], > 0
RodTip integrate(const SpatialRod& rod, double length, const RodState<double>& base,
                 const RodSteps& how = {});

/// The far end with its derivatives. Rows: position, rotation vector (base axes), force, moment. Columns:
/// force and moment at the base (base axes), axial rotation of the base frame about its own z at these,
/// length. They are the derivatives of the numbers computed, steps held, to rounding.
struct RodTangent {
  static constexpr int force = 0, moment = 3, axial_rotation = 6, length = 7;      // columns
  static constexpr int position = 0, rotation = 3, tip_force = 6, tip_moment = 9;  // rows
  RodTip tip;
  Mat<double, 12, 8> rate;
};

RodTangent integrate_tangent(const SpatialRod& rod, double length, const RodState<double>& base,
                             const RodSteps& how = {});

/// The sections at even arc lengths, the first at the base and the last at the tip; at least two.
Status rod_sections(const SpatialRod& rod, double length, const RodState<double>& base,
                    std::span<RodState<double>> out, const RodSteps& how = {});

}  // namespace sinew::inline v1
