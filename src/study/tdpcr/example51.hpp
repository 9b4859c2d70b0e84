/// @file example51.hpp
/// The example of TDPCR section 5.1: robot, trajectory, and what can be derived of both by hand.
/// Theory: docs/theory/example51.md
#pragma once
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "sinew/analysis/shape.hpp"
#include "sinew/analysis/velocity.hpp"
#include "sinew/base/error.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1::example51 {

/// The geometry that section 5.1 prints.
struct Printed {
  double base_radius = 0.19;      ///< R_b [m]
  double platform_radius = 0.05;  ///< R_p [m]
  double tendon_offset = 0.005;   ///< d [m]
  double backbone_length = 0.2;   ///< ℓ [m]
  double last_x = 0.03;           ///< [m]
  int configurations = 60;

  std::array<Vec2<double>, 3> base_points() const;      ///< a_i [m]
  std::array<Vec2<double>, 3> platform_points() const;  ///< b_i [m], in the platform's frame
};

/// What its figures have in common, as their files say it.
inline constexpr const char* all_bend_positive =
    "Wen & Burgner-Kahrs, section 5.1: planar 3-RFR, constant curvature, every leg bending positive";
inline constexpr const char* tendon_1_actuated =
    "Wen & Burgner-Kahrs, section 5.1: planar 3-RFR, constant curvature, tendon 1 of each leg actuated";
inline constexpr const char* six_links =
    "Wen & Burgner-Kahrs, section 5.1: planar 3-RFR, n = 6 pseudo-rigid links a leg, joints 2..6, least norm";

/// Largest distance between corresponding points [m].
template <class Points>
double farthest(const Points& a, const Polyline& b) {
  double most = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

/// x = 0.03 η, y = 0, φ = η π/3.  @implements TDPCR (68)-(70)
PlanarPose pose(double eta);

/// What the typed functions say of one configuration. All indices are NaN where J is singular.
struct Sample {
  double eta;
  PlanarPose pose;
  std::vector<double> tendons, curvatures;  ///< [m], [1/m]
  std::vector<double> input_rate;           ///< diagonal of K [m]
  Indices indices;
  double determinant;           ///< [m⁴]
  double closure_error;         ///< [m]
  std::array<double, 3> sigma;  ///< singular values of J
  TypeTwo type_2;
};

/// Bending positive in every leg.
Expected<Sample> sample(const Robot& robot, double eta, Workspace& work);

/// η = k/59 for k = 0 … 59.
Expected<std::vector<Sample>> trajectory(const Robot& robot);

/// det J = −(3√3/2) R_b R_p sin ψ (x² + y² − R_b² − R_p² + 2 R_b R_p cos ψ), ψ = φ − π/3 [m⁴].
double determinant(const PlanarPose& pose);

/// Where the lines meet in the last pose: p/(1 − R_p/R_b) [m].
Vec2<double> meeting_point();

/// Limits of index·(π/3 − φ) as the last pose is approached.
struct Rates {
  double condition, position, rotation;
};

/// @param last the singular sample
Rates rates(const Sample& last);

}  // namespace sinew::inline v1::example51
