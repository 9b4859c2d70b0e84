/// @file swivel.hpp
/// A planar link on an actuated revolute joint at its base: one more coordinate, the absolute angle θ of the
/// base tangent, in front of the link's own.  u = R(θ − 90°) u_link(q).  Theory: docs/theory/tendon.md
#pragma once
#include <string_view>

#include "link/arc.hpp"
#include "sinew/math/se2.hpp"

namespace sinew::inline v1 {

template <class LinkT>
struct Swivel {
  static constexpr std::string_view name = "swivel";
  static constexpr int dimension = 2;
  static constexpr int coordinates = 1 + LinkT::coordinates;  ///< θ [rad], then those of the link
  static constexpr bool has_base_joint =
      true;  ///< the base tangent is a coordinate: a base direction means nothing

  LinkT link;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    LinkT::fields(self.link, visit);
  }

  /// Tip in axes of the base. The paper has the angle of the chord in the place of θ: that is the drive's
  /// business (tendon/swivel_drive.hpp).  @implements TDPCR (63)-(64)
  template <Scalar S>
  Tip<S, 2, coordinates> tip(const Vec<S, coordinates>& q) const {
    using std::cos, std::sin;
    const SE2<S> turned{Vec2<S>(S(0), S(0)), sin(q[0]), -cos(q[0])};  // by θ − 90°
    const Vec<S, LinkT::coordinates> own = q.template tail<LinkT::coordinates>();
    const Tip<S, 2, LinkT::coordinates> bent = link.tip(own);
    Tip<S, 2, coordinates> tip;
    tip.position = turned.rotate(bent.position);
    tip.rate.col(0) = perp(tip.position);
    for (int j = 0; j < LinkT::coordinates; ++j)
      tip.rate.col(j + 1) = turned.rotate(Vec2<S>(bent.rate.col(j)));
    return tip;
  }

  /// @name Of the backbone
  /// @{
  const Arc& arc() const { return link.arc(); }
  double curvature(const Vec<double, coordinates>& q) const {
    return link.curvature(q.template tail<LinkT::coordinates>());
  }
  double branch(const Vec<double, coordinates>& q) const { return curvature(q); }
  double size() const { return link.size(); }
  double domain() const { return link.domain(); }
  static constexpr std::string_view beyond_domain = LinkT::beyond_domain;
  /// Absolute angle of the base tangent [rad].
  double base_tangent(const Vec<double, coordinates>& q) const { return q[0]; }
  /// @}
};

}  // namespace sinew::inline v1
