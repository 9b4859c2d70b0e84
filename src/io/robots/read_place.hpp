/// @file read_place.hpp
/// Points and directions as robot files write them.
#pragma once
#include <algorithm>
#include <cmath>

#include "io/document/reader.hpp"
#include "leg/space.hpp"

namespace sinew::inline v1 {

/// `[x, y]` or `{radius, angle}`; in space `[x, y, z]` or `{radius, angle, height}`.
template <class Space>
Vec<double, Space::dimension> read_point(Reader point) {
  Vec<double, Space::dimension> result;
  if (point.is(Node::Kind::map)) {
    const double radius =
        point.required("radius").quantity(Dimension::length, {.low = 0, .high = Range::place().high});
    const double angle = point.required("angle").quantity(Dimension::angle);
    result.template head<2>() = Vec2<double>(radius * std::cos(angle), radius * std::sin(angle));
    if constexpr (Space::dimension == 3) {
      const auto height = point.optional("height");
      result[2] = height ? height->quantity(Dimension::length, Range::place()) : 0;
    }
    point.close();
  } else {
    const auto values = point.array<Space::dimension>(Dimension::length, Range::place());
    std::copy(values.begin(), values.end(), result.begin());
  }
  return result;
}

/// Unit vector along a list of three numbers, or at an angle in the plane of the base's x and y.
inline Vec3<double> read_direction(const Reader& direction) {
  if (!direction.is(Node::Kind::list) && direction.node()) {
    const double angle = direction.quantity(Dimension::angle);
    return {std::cos(angle), std::sin(angle), 0};
  }
  const auto [x, y, z] = direction.array<3>(Dimension::number, Range::place());
  const Vec3<double> vector(x, y, z);
  if (vector.norm() >= 1e-9) return vector.normalized();
  direction.fail("no_direction", "a direction needs a component that is not 0");
  return {0, 0, 1};
}

}  // namespace sinew::inline v1
