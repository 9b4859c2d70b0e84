/// @file rod_frames.hpp
/// Frames along a rod as points and rotations.
#pragma once
#include "sinew/math/vec.hpp"
#include "strain/rod_model.hpp"

namespace sinew::inline v1::strain {

inline Mat<double, 3, 3> turn_of(const RodFrame& frame) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.R);
}
inline Vec3<double> place_of(const RodFrame& frame) { return {frame.p[0], frame.p[1], frame.p[2]}; }

}  // namespace sinew::inline v1::strain
