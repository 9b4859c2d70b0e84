/// @file pair.hpp
/// Drive of an arc by a pair of opposite tendons: the desktop face of kernel/tendon_pair.h.
/// Theory: docs/theory/tendon.md
#pragma once
#include <array>
#include <string_view>

#include "sinew/base/units.hpp"
#include "sinew/kernel/tendon_pair.h"
#include "sinew/math/vec.hpp"

namespace sinew::inline v0 {

/// A drive turns inputs a (what motors command) into link coordinates q. Here a is the length of tendon 1,
/// q the signed curvature; tendon 2 follows so that the backbone keeps its length.
struct TendonPair {
  static constexpr std::string_view input_name = "tendon_1";
  static constexpr Dimension input_dimension = Dimension::length;
  static constexpr int inputs = 1;

  double offset = 0;  ///< distance d of either tendon from the backbone [m]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("tendon_offset", self.offset, Dimension::length, Range::size(),
          "distance of a tendon from the backbone");
  }

  kernel::TendonPair<double> pair(double backbone_length) const { return {backbone_length, offset}; }

  /// Curvature [1/m] that tendon 1 of this length [m] commands.
  template <class Link>
  double coordinate(const Link& link, double tendon_1_length) const {
    return pair(link.length).curvature(tendon_1_length);
  }

  /// Length of tendon 1 [m] that commands this curvature [1/m].
  template <class Link>
  double input(const Link& link, double curvature) const {
    return pair(link.length).tendon_1(curvature);
  }

  /// ∂q/∂a = λ, constant.
  template <class Link>
  double rate(const Link& link) const {
    return pair(link.length).curvature_rate();
  }

  /// Curvatures lie in (−domain, domain) [1/m]: at 1/d the inner tendon would sit on the centre of curvature.
  double domain() const { return 1 / offset; }

  /// Lengths of tendon 1 and tendon 2 [m].
  template <class Link>
  std::array<double, 2> lengths(const Link& link, double curvature) const {
    const auto tendons = pair(link.length);
    return {tendons.tendon_1(curvature), tendons.tendon_2(curvature)};
  }
};

}  // namespace sinew::inline v0
