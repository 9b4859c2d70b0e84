/// @file tilt.hpp
/// Rotations as tilt, azimuth and torsion: the z axis leans by the tilt towards the azimuth (from +x towards
/// +y), and the body turns about it by the torsion, which a bend without twist leaves 0. Bonev, Zlatanov,
/// Gosselin, Advantages of the modified Euler angles in the design and control of PKMs (2002).
///
///   R = Rz(azimuth) Ry(tilt) Rz(torsion − azimuth)
///
/// Of the quaternion (w, x, y, z) two complex numbers have them by halves, so none is lost near tilt 0 or π:
///   w + i z = cos(tilt/2) exp(i torsion/2)      y − i x = sin(tilt/2) exp(i (azimuth − torsion/2))
#pragma once
#include <cmath>
#include <numbers>

#include "sinew/math/se3.hpp"

namespace sinew::inline v1 {

struct TiltTorsion {
  double tilt = 0;     ///< [rad]; of a rotation in [0, π]
  double azimuth = 0;  ///< [rad]; of a rotation in (−π, π]
  double torsion = 0;  ///< [rad]; of a rotation in (−π, π]
};

/// Any angles are good.
inline SO3<double> rotation_of(const TiltTorsion& angles) {
  const double half = 0.5 * angles.tilt, twist = 0.5 * angles.torsion, lean = angles.azimuth - twist;
  const double c = std::cos(half), s = std::sin(half);
  return {c * std::cos(twist), Vec3<double>(-s * std::sin(lean), s * std::cos(lean), c * std::sin(twist))};
}

/// Of a quaternion of any length but 0. By convention the azimuth is 0 where nothing leans. Upside down,
/// where only 2·azimuth − torsion is seen, the torsion is 0 and the azimuth in (−π/2, π/2].
inline TiltTorsion tilt_torsion(const SO3<double>& R) {
  constexpr double pi = std::numbers::pi;
  const auto plain = [](double angle) { return wrap_angle(angle) + 0.0; };  // no −0
  const double sine = std::hypot(R.v.x(), R.v.y()), cosine = std::hypot(R.w, R.v.z());
  const double tilt = 2 * std::atan2(sine, cosine);
  const double twist = std::atan2(R.v.z(), R.w), lean = std::atan2(-R.v.x(), R.v.y());
  if (sine == 0) return {0, 0, plain(2 * twist)};
  if (tilt < pi) return {tilt, plain(twist + lean), plain(2 * twist)};
  return {tilt, plain(lean > pi / 2 ? lean - pi : lean > -pi / 2 ? lean : lean + pi), 0};
}

}  // namespace sinew::inline v1
