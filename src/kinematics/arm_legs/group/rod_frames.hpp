/// @file rod_frames.hpp
/// Frames along a rod as points and rotations, and the error of a rotation.
#pragma once
#include "sinew/math/vec.hpp"
#include "strain/rod_model.hpp"

namespace sinew::inline v1 {

using Three3 = Mat<double, 3, 3>;

/// Twice the skew part of a matrix, as a vector: of ½ [v] it is v.
inline Vec3<double> axial(const Three3& m) {
  return {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)};
}
inline Three3 turn_of(const strain::RodFrame& frame) {
  Three3 turn;
  turn << frame.R[0], frame.R[1], frame.R[2], frame.R[3], frame.R[4], frame.R[5], frame.R[6], frame.R[7],
      frame.R[8];
  return turn;
}
inline Vec3<double> place_of(const strain::RodFrame& frame) { return {frame.p[0], frame.p[1], frame.p[2]}; }

}  // namespace sinew::inline v1
