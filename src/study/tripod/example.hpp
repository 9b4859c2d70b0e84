/// @file example.hpp
/// The 3PRS of [3PFS] section 3.1 in the plane of e₁ and e₂: what the paper prints of it, what is measured at
/// a place, the two loci and how they are drawn. Operation mode e₃ = 0, carriages below the platform. Theory:
/// docs/theory/tripod_figures.md
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "analysis/tripod_loci.hpp"
#include "io/figure/figure.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "study/tripod/contour.hpp"

namespace sinew::inline v1::tripod {

/// Below (19), [m].
inline constexpr TripodSize printed{.base_radius = 0.25, .platform_radius = 0.125, .strut_length = 0.35};

/// What figures have in common, as their files say it.
inline constexpr const char* of_unit_radius =
    "Altuzarra et al. 2023, section 3.1: 3PRS, platform radius r = 1, operation mode e3 = 0";
inline constexpr const char* as_printed =
    "Altuzarra et al. 2023, section 3.1: 3PRS, r_A = 0.25 m, L = 0.35 m, r = 0.125 m, e3 = 0";

/// What a robot of these three legs is like, by the first; NaN for any other robot.
TripodSize size_of(const Robot& robot);

/// The same robot with a platform of this radius [m].
Robot with_platform_radius(const Robot& robot, double radius);

/// Tilt of the platform, φ = 2 arcsin |(e₁, e₂)|, of 0 to 1 [deg].
double tilt(double radius);

// ---------------------------------------------------------------- places

/// Heights of the platform [m]: where everything is computed, and another to compare with.
inline constexpr double height = 0.5, other_height = 0.9;

/// Values of e₁, and of e₂, on the grid: −1, −0.98 … 1.
std::vector<double> places();

/// What (17) is at a place; NaN where a strut does not reach.
struct Sample {
  double e1, e2;
  std::array<double, 3> rises;  ///< (bᵢ − cᵢ)·k, the diagonal of (18) [m]
  double forward_norm;          ///< Frobenius norm of the left matrix of (17); mixes m, m² and 1
  double determinant;           ///< of that matrix [m⁶]
  double position, rotation;    ///< 2-norms of the blocks of U [m/m], [rad/m]; NaN where it is singular

  bool is_reached() const;
  double frobenius() const;  ///< of (18) [m]
  double largest() const;    ///< 2-norm of (18) [m]
  double smallest() const;   ///< 1/‖J_IK⁻¹‖₂ [m]; 0 on the loci
};

/// Through the whole robot: pose by (10), slides by inverse kinematics, J, K and U by the velocity analysis.
Sample sample(const Robot& robot, const IndependentPose& at, Workspace& work);

/// At every place of the grid, e₁ fastest.
std::vector<Sample> samples(const Robot& robot, Workspace& work);

/// Every seventh place of the grid compared with itself at another height: the largest `off(sample, other)`;
/// NaN where one of the two is reached and the other not.
double change_with_height(const Robot& robot, const std::vector<Sample>& all,
                          const std::function<double(const Sample&, const Sample&)>& off, Workspace& work);

// ---------------------------------------------------------------- loci

/// |(e₁, e₂)| of the locus of (19) in a direction [rad], by hand: of the three left sides
/// 1 − ρ² (4 cos² α − 1), α the angle from the nearest multiple of 60°, the least one is r_A − L over r.
double inverse_radius(const TripodSize& size, double direction);

/// How far to either side of 0°, 120° and 240° the inverse locus comes first [rad].
double gap(const TripodSize& size);

/// The part of the plane inside the inverse locus, and that which home is in before either locus comes.
struct Areas {
  double inverse, first;
};
Areas areas(const TripodSize& size);

// ---------------------------------------------------------------- drawing

Series circle(double radius, Mark mark, Colour colour, double width);   ///< about e₁ = e₂ = 0
Series inverse_curve(const TripodSize& size, Mark mark, double width);  ///< closed, black
/// Three arcs that end on the inverse locus.
Series forward_curve(const TripodSize& size, double width);
/// The forward arcs and the pieces of the inverse locus between them, closed.
Series first_curve(const TripodSize& size);

/// A map over the grid, its cells those of one value of the samples; NaN: empty.
HeatMap map_of(std::vector<double> values, std::string label);

/// Empty panel over −1 … 1, axes e₁ and e₂ of equal length.
Panel plane(std::string title);

/// The map cut off at the inverse locus, both loci over it.
Panel map_panel(const TripodSize& size, std::string title, HeatMap map,
                const std::vector<contour::Levels>& levels);

}  // namespace sinew::inline v1::tripod
