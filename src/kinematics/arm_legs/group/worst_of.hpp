/// @file worst_of.hpp
/// The worst of errors.
#pragma once

namespace sinew::inline v1 {

/// The larger, or NaN where one is.
inline double worst_of(double a, double b) { return !(b <= a) ? b : a; }

}  // namespace sinew::inline v1
