#include "math/shape_preserving.hpp"

#include <utility>

namespace sinew::inline v1 {
namespace {

/// Slope at a point between intervals of widths h0, h1 and mean slopes d0, d1: their harmonic mean, so that
/// neither is exceeded threefold; 0 at an extremum.
double slope(double h0, double h1, double d0, double d1) {
  if (!(d0 * d1 > 0)) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

}  // namespace

ShapePreservingCurve::ShapePreservingCurve(std::vector<double> parameters, std::vector<double> values)
    : parameters_(std::move(parameters)),
      coordinates_(parameters_.empty() ? 0 : values.size() / parameters_.size()) {
  const std::size_t points = parameters_.size();
  const auto at = [&](std::size_t k, std::size_t c) { return values[k * coordinates_ + c]; };
  const auto width = [&](std::size_t k) { return parameters_[k + 1] - parameters_[k]; };
  const auto mean = [&](std::size_t k, std::size_t c) { return (at(k + 1, c) - at(k, c)) / width(k); };
  const auto slope_at = [&](std::size_t k, std::size_t c) {
    return k == 0 || k + 1 == points ? 0.0 : slope(width(k - 1), width(k), mean(k - 1, c), mean(k, c));
  };
  for (std::size_t k = 0; k + 1 < points; ++k)
    for (std::size_t c = 0; c < coordinates_; ++c) {
      const double h = width(k), m = mean(k, c), m0 = slope_at(k, c), m1 = slope_at(k + 1, c);
      cubics_.push_back({at(k, c), m0, (3 * m - 2 * m0 - m1) / h, (m0 + m1 - 2 * m) / (h * h)});
    }
}

double ShapePreservingCurve::value(std::size_t piece, std::size_t coordinate, double parameter) const {
  const Cubic& p = cubic(piece, coordinate);
  const double t = parameter - parameters_[piece];
  return p.a + t * (p.b + t * (p.c + t * p.d));
}

double ShapePreservingCurve::first_derivative(std::size_t piece, std::size_t coordinate,
                                              double parameter) const {
  const Cubic& p = cubic(piece, coordinate);
  const double t = parameter - parameters_[piece];
  return p.b + t * (2 * p.c + t * 3 * p.d);
}

double ShapePreservingCurve::second_derivative(std::size_t piece, std::size_t coordinate,
                                               double parameter) const {
  const Cubic& p = cubic(piece, coordinate);
  return 2 * p.c + 6 * p.d * (parameter - parameters_[piece]);
}

}  // namespace sinew::inline v1
