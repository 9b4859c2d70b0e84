/// @file norm.hpp
/// Of coordinates: sizes and products.
#pragma once
#include <cmath>
#include <span>

namespace sinew::inline v1::strain {

inline double norm(std::span<const double> x) {
  double sum = 0;
  for (double v : x) sum += v * v;
  return std::sqrt(sum);
}
inline double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}
/// A direction across no symmetry of a robot, where nothing tells one.
inline void some_direction(std::span<double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1 + 0.37 * std::sin(1.0 + 2.3 * static_cast<double>(i));
}

}  // namespace sinew::inline v1::strain
