/// @file pair.hpp
/// Drive of an arc by a pair of opposite tendons: the desktop face of kernel/tendon_pair.h.
/// Theory: docs/theory/tendon.md
#pragma once
#include <array>
#include <span>
#include <string_view>

#include "sinew/kernel/tendon_pair.h"
#include "sinew/math/vec.hpp"
#include "sinew/units.hpp"
#include "tendon/input_kind.hpp"

namespace sinew::inline v1 {

/// A drive turns inputs a (what motors command) into link coordinates q. Here a is the length of tendon 1,
/// q the signed curvature; tendon 2 follows so that the backbone keeps its length.
struct TendonPair {
  static constexpr int inputs = 1;
  static constexpr std::array input_kinds{InputKind{"tendon_1", Dimension::length}};

  double offset = 0;  ///< distance d of either tendon from the backbone [m]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("tendon_offset", self.offset, Dimension::length, Range::size(),
          "distance of a tendon from the backbone");
  }

  kernel::TendonPair<double> pair(double backbone_length) const { return {backbone_length, offset}; }

  /// Curvature [1/m] that tendon 1 of this length [m] commands.
  template <class Link>
  Vec<double, 1> coordinates(const Link& link, std::span<const double> tendon_1_length) const {
    return Vec<double, 1>(pair(link.arc().length).curvature(tendon_1_length[0]));
  }

  /// Length of tendon 1 [m] that commands this curvature [1/m].
  template <class Link>
  Vec<double, 1> commands(const Link& link, const Vec<double, 1>& curvature) const {
    return Vec<double, 1>(pair(link.arc().length).tendon_1(curvature[0]));
  }

  /// ∂q/∂a = λ, constant.
  template <class Link>
  Mat<double, 1, 1> rate(const Link& link) const {
    return Mat<double, 1, 1>(pair(link.arc().length).curvature_rate());
  }

  double tendon_offset() const { return offset; }

  /// Curvatures lie in (−domain, domain) [1/m]: at 1/d the inner tendon would sit on the centre of curvature.
  double domain() const { return 1 / offset; }

  /// Lengths of tendon 1 and tendon 2 [m].
  std::array<double, 2> lengths(double backbone_length, double curvature) const {
    const auto tendons = pair(backbone_length);
    return {tendons.tendon_1(curvature), tendons.tendon_2(curvature)};
  }
};

}  // namespace sinew::inline v1
