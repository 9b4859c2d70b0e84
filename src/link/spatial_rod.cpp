#include "link/spatial_rod.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::inline v1 {
namespace {

/// J of a rectangle [m⁴], by the series for its stress function (Timoshenko and Goodier, Theory of
/// Elasticity, article 109): a b³/3 (1 − (192/π⁵)(b/a) Σ tanh(n π a/2b)/n⁵), n odd, a ≥ b.
double torsion_constant(double width, double height) {
  const double a = std::max(width, height), b = std::min(width, height), pi = std::numbers::pi;
  double sum = 0;
  for (int n = 801; n > 0; n -= 2) sum += std::tanh(n * pi * a / (2 * b)) / std::pow(n, 5);
  return a * b * b * b / 3 * (1 - 192 / std::pow(pi, 5) * (b / a) * sum);
}

}  // namespace

SpatialRod SpatialRod::round(double youngs_modulus, double shear_modulus, double diameter, RodLaw law) {
  const double area = std::numbers::pi * diameter * diameter / 4, inertia = area * diameter * diameter / 16;
  SpatialRod rod;
  rod.bending_stiffness = Vec2<double>::Constant(youngs_modulus * inertia);
  rod.torsion_stiffness = shear_modulus * 2 * inertia;
  if (law == RodLaw::cosserat) {
    rod.shear_compliance = Vec2<double>::Constant(1 / (shear_modulus * area));
    rod.extension_compliance = 1 / (youngs_modulus * area);
  }
  return rod;
}

SpatialRod SpatialRod::strip(double youngs_modulus, double shear_modulus, double width, double height,
                             RodLaw law) {
  const double area = width * height;
  SpatialRod rod;
  rod.bending_stiffness = Vec2<double>(height * height, width * width) * (youngs_modulus * area / 12);
  rod.torsion_stiffness = shear_modulus * torsion_constant(width, height);
  if (law == RodLaw::cosserat) {
    rod.shear_compliance = Vec2<double>::Constant(1 / (shear_modulus * area));
    rod.extension_compliance = 1 / (youngs_modulus * area);
  }
  return rod;
}

bool SpatialRod::is_valid() const {
  return bending_stiffness.allFinite() && std::isfinite(torsion_stiffness) && shear_compliance.allFinite() &&
         std::isfinite(extension_compliance) && precurvature.allFinite() && load.allFinite() &&
         bending_stiffness.minCoeff() > 0 && torsion_stiffness > 0 && shear_compliance.minCoeff() >= 0 &&
         extension_compliance >= 0;
}

bool SpatialRod::is_isotropic() const {
  return bending_stiffness[0] == bending_stiffness[1] && shear_compliance[0] == shear_compliance[1] &&
         precurvature[0] == 0 && precurvature[1] == 0;
}

}  // namespace sinew::inline v1
