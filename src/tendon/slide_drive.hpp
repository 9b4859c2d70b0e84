/// @file slide_drive.hpp
/// Drive of a rail: the input is the slide itself. Theory: docs/theory/tripod_rigid.md
#pragma once
#include "tendon/input_kind.hpp"
#include "tendon/pair.hpp"

namespace sinew::inline v1 {

/// Input ρ [m], the distance of the carriage from the base point along the rail.
struct SlideDrive {
  static constexpr int inputs = 1;
  static constexpr std::array input_kinds{InputKind{"slide", Dimension::length}};

  template <class Self, class Visit>
  static void fields(Self&, Visit&&) {}

  template <class Link>
  Vec<double, 1> coordinates(const Link&, std::span<const double> slide) const {
    return Vec<double, 1>(slide[0]);
  }
  template <class Link>
  Vec<double, 1> commands(const Link&, const Vec<double, 1>& slide) const {
    return slide;
  }
  template <class Link>
  Mat<double, 1, 1> rate(const Link&) const {
    return Mat<double, 1, 1>(1.0);
  }
  double domain() const { return std::numeric_limits<double>::infinity(); }
};

}  // namespace sinew::inline v1
