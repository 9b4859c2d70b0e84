/// @file rail.hpp
/// A carriage on a straight rail. Base at the origin, the rail along +y; the tip is the point of the carriage
/// on the rail, and its one coordinate the slide ρ. Theory: docs/theory/tripod_rigid.md
#pragma once
#include <string_view>

#include "link/tip.hpp"
#include "sinew/units.hpp"

namespace sinew::inline v1 {

struct Rail {
  static constexpr std::string_view name = "rail";
  static constexpr int dimension = 3;
  static constexpr int coordinates = 1;  ///< the slide ρ [m]
  static constexpr bool has_base_joint = false;

  template <class Self, class Visit>
  static void fields(Self&, Visit&&) {}

  /// c − a = ρ k, with k along +y.  @implements 3PFS (13)
  template <Scalar S>
  Tip<S, 3, 1> tip(const Vec<S, 1>& q) const {
    return {Vec3<S>(S(0), q[0], S(0)), Vec3<S>(S(0), S(1), S(0))};
  }

  double slide(const Vec<double, 1>& q) const { return q[0]; }

  /// @name As any link has them
  /// @{
  double branch(const Vec<double, 1>& q) const { return q[0]; }  ///< the slide [m]
  double size() const { return 0; }                              ///< a rail has no length of its own
  double domain() const { return Range::place().high; }
  static constexpr std::string_view beyond_domain = "puts the carriage further away than 1e9 m";
  /// @}
};

}  // namespace sinew::inline v1
