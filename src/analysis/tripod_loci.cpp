#include "analysis/tripod_loci.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "math/linalg.hpp"
#include "sinew/math/se3.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int steps = 1000;  // along a direction, from 0 to 1

/// First zero of a function that is positive at `low` and no longer at `high`.
template <class F>
double first_zero(double low, double high, const F& f) {
  for (int i = 0; i < 60; ++i) {
    const double middle = low + 0.5 * (high - low);
    (f(middle) > 0 ? low : high) = middle;
  }
  return high;
}

/// The first zero along a direction of a function that is positive at 0; NaN ends the search.
template <class F>
std::optional<double> first_zero_along(double direction, const F& f) {
  const double c = std::cos(direction), s = std::sin(direction);
  const auto along = [&](double radius) { return f(radius * c, radius * s); };
  for (int k = 1; k <= steps; ++k) {
    const double before = static_cast<double>(k - 1) / steps, here = static_cast<double>(k) / steps;
    const double value = along(here);
    if (std::isnan(value)) return {};
    if (!(value > 0)) return first_zero(before, here, along);
  }
  return {};
}

}  // namespace

std::array<double, 3> radial_positions(double e1, double e2) {
  const double mixed = 2 * std::numbers::sqrt3 * e1 * e2;
  return {1 - 3 * e1 * e1 + e2 * e2, 1 + mixed - 2 * e2 * e2, 1 - mixed - 2 * e2 * e2};
}

std::array<double, 2> radial_limits(const TripodSize& size) {
  return {(size.base_radius - size.strut_length) / size.platform_radius,
          (size.base_radius + size.strut_length) / size.platform_radius};
}

double tripod_determinant(const TripodSize& size, double e1, double e2) {
  const double rest = 1 - e1 * e1 - e2 * e2;
  if (!(rest >= 0)) return std::numeric_limits<double>::quiet_NaN();
  const SO3<double> turn{std::sqrt(rest), Vec3<double>(e1, e2, 0)};
  const std::array<double, 3> radial = radial_positions(e1, e2);
  // of (8): the third is minus the second turned on by 120°
  const std::array<Vec3<double>, 3> axes{Vec3<double>(1, 0, 0),
                                         Vec3<double>(-0.5, 0.5 * std::numbers::sqrt3, 0),
                                         Vec3<double>(0.5, 0.5 * std::numbers::sqrt3, 0)};
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> J;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double azimuth = (90 + 120 * i) * std::numbers::pi / 180;
    const Vec3<double> outwards(std::cos(azimuth), std::sin(azimuth), 0);
    const double off = radial[k] * size.platform_radius - size.base_radius;
    const Vec3<double> arm = turn.rotate(size.platform_radius * outwards);
    const Vec3<double> strut =
        off * outwards + Vec3<double>(0, 0, std::sqrt((size.strut_length - off) * (size.strut_length + off)));
    J.row(i) << strut.transpose(), cross(arm, strut).transpose();
    J.row(3 + i) << axes[k].transpose(), cross(arm, axes[k]).transpose();
  }
  return determinant(MatrixView(J.data(), 6, 6));
}

std::optional<double> inverse_locus(const TripodSize& size, double direction) {
  const auto [low, high] = radial_limits(size);
  return first_zero_along(direction, [low = low, high = high](double e1, double e2) {
    double least = std::numeric_limits<double>::infinity();
    for (const double position : radial_positions(e1, e2))
      least = std::min({least, position - low, high - position});
    return least;
  });
}

std::optional<double> forward_locus(const TripodSize& size, double direction) {
  const double sign = tripod_determinant(size, 0, 0) < 0 ? -1 : 1;
  return first_zero_along(direction,
                          [&](double e1, double e2) { return sign * tripod_determinant(size, e1, e2); });
}

}  // namespace sinew::inline v1
