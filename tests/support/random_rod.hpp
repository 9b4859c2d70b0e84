/// @file random_rod.hpp
/// Random elastic rods of half a metre and a few millimetres, for properties.
#pragma once
#include <rapidcheck.h>

#include "link/spatial_rod.hpp"

namespace sinew::test {

inline double uniform(double low, double high) {
  return low + (high - low) * 1e-6 * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1000001));
}

inline Vec3<double> any_vector(double largest) {
  return {uniform(-largest, largest), uniform(-largest, largest), uniform(-largest, largest)};
}

enum class RodKind {
  plain,     ///< round, Kirchhoff, straight, unloaded
  cosserat,  ///< the same with shear and stretch
  general    ///< anything
};

inline SpatialRod any_rod(RodKind kind) {
  const bool plain = kind == RodKind::plain || (kind == RodKind::general && *rc::gen::arbitrary<bool>());
  SpatialRod rod =
      SpatialRod::round(200e9, 80e9, uniform(0.0015, 0.003), plain ? RodLaw::kirchhoff : RodLaw::cosserat);
  if (kind != RodKind::general) return rod;
  if (*rc::gen::arbitrary<bool>()) {
    rod.bending_stiffness[1] *= uniform(0.5, 2);
    rod.precurvature = any_vector(2);
  }
  if (*rc::gen::arbitrary<bool>()) rod.load = any_vector(0.5);
  if (!plain && *rc::gen::arbitrary<bool>()) {  // as soft as a coil spring
    rod.shear_compliance = {uniform(0, 1e-3), uniform(0, 1e-3)};
    rod.extension_compliance = uniform(0, 1e-3);
  }
  return rod;
}

}  // namespace sinew::test
