/// @file hinged_strut.hpp
/// Hinged strut closure: a rigid link of constant length on a revolute joint at the link's tip, with a
/// spherical joint at the platform. The point keeps its distance from the tip and stays in the plane of the
/// hinge.  |r − u(q)| = L,  e·(r − u(q)) = 0.  Theory: docs/theory/tripod_rigid.md
#pragma once
#include <span>
#include <string_view>

#include "leg/closure.hpp"
#include "sinew/units.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {

struct HingedStrut {
  static constexpr std::string_view name = "hinged_strut";
  static constexpr bool base_turns = false;
  static constexpr bool anchor_is_tip = true;
  static constexpr Holds holds = Holds::distance_in_plane;
  /// How far beside its plane a platform point may be, over the strut's length.
  static constexpr double plane_tolerance = 1e-9;

  double length = 0;  ///< L [m], > 0

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("length", self.length, Dimension::length, Range::size(), "length of the rigid strut");
  }

  /// Axis of the hinge in the axes of the link's tip: +x, at right angles to a rail.  @implements 3PFS (2)
  template <Scalar S>
  static Vec3<S> plane_normal() {
    return {S(1), S(0), S(0)};
  }

  bool is_in_plane(const Vec3<double>& r) const { return std::abs(r.x()) <= plane_tolerance * length; }

  /// Two slides at the same distance from the foot of the platform point on the rail: elbow +1, then −1; once
  /// where the strut is square to the rail.
  template <HasSlide Link>
  int coordinates_at(const Link&, const Vec3<double>& r, const SolutionPreference& wish, double,
                     std::span<Vec<double, 1>> roots) const {
    const double off = std::sqrt(r.x() * r.x() + r.z() * r.z()), along = (length - off) * (length + off);
    if (!is_in_plane(r) || !(along >= 0)) return 0;
    const double half = std::sqrt(along);
    const int count = half > 0 && wish.elbow == 0 ? 2 : 1;
    roots[0][0] = wish.elbow < 0 ? r.y() + half : r.y() - half;
    if (count == 2) roots[1][0] = r.y() + half;
    return count;
  }

  void explain_unreachable(const Vec3<double>& r, double, FixedText<240>& text) const {
    if (!is_in_plane(r)) {
      text.append("has its platform point ");
      append_mm(text, std::abs(r.x()));
      text.append(
          " beside the plane its hinge holds it in: not all of a pose can be chosen here; give the "
          "independent "
          "coordinates z, e1, e2 instead");
      return;
    }
    text.append("has its platform point ");
    append_mm(text, std::abs(r.z()));
    text.append(" from its rail, its strut is ");
    append_mm(text, length);
    text.append(" long");
  }
};

}  // namespace sinew::inline v1
