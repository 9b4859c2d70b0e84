/// @file leg.hpp
/// A leg: base frame + link + drive + closure + platform point. It hands over residual rows with their
/// Jacobian blocks, all a robot or a solver ever learns of it. One call returns values and Jacobians
/// together: no cache, no call order. Theory: docs/theory/leg.md
#pragma once
#include <array>
#include <concepts>
#include <optional>
#include <span>

#include "sinew/base/fixed_text.hpp"
#include "sinew/base/units.hpp"
#include "sinew/leg/closure.hpp"
#include "sinew/leg/space.hpp"
#include "sinew/solve/roots.hpp"

namespace sinew::inline v0 {

/// What a leg hands over at platform pose x and link coordinates q.
template <Scalar S, int Dof, int Q>
struct LegBlocks {
  S g;                 ///< residual [m²]
  Mat<S, 1, Dof> g_x;  ///< ∂g/∂x by the platform's twist: a Plücker line times the distance; a row of J
  Mat<S, 1, Q> g_q;    ///< ∂g/∂q by the link coordinates
  S error;             ///< the residual as a distance [m]
};

/// What is known of a backbone beside its length. Constant-curvature answers do not depend on it.
struct Backbone {
  std::optional<double> youngs_modulus;  ///< E [Pa]; in a file under `material`
  std::optional<double> diameter;        ///< of a round solid section [m]
  std::optional<int> joints;             ///< n of a pseudo-rigid model

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("diameter", self.diameter, Dimension::length, Range::positive(), "diameter of the round backbone");
    visit("joints", self.joints, Dimension::count, Range::between(1, 32), "joints of the pseudo-rigid model");
  }
};

/// What a person wants to know of a leg in an answer.
struct LegState {
  double curvature;                      ///< κ [1/m], signed
  double chord;                          ///< ρ [m]
  std::array<double, 2> tendon_lengths;  ///< tendon 1, tendon 2 [m]
  double base_tangent;                   ///< absolute angle of the backbone at its base [rad], in (−π, π]
};

/// A closure that gives the coordinates of this link in closed form; others are searched.
template <class Closure, class Link, class Point>
concept SolvesInClosedForm = requires(const Closure& closure, const Link& link, const Point& r,
                                      std::span<double> roots) {
  { closure.coordinates_at(link, r, roots) } -> std::same_as<int>;
};

template <class SpaceT, class LinkT, class DriveT, class ClosureT>
struct Leg {
  using Space = SpaceT;
  using Link = LinkT;
  using Drive = DriveT;
  using Closure = ClosureT;
  template <class S>
  using LinkTip = Tip<S, Link::dimension, Link::coordinates>;
  template <class S>
  using Blocks = LegBlocks<S, Space::dof, Link::coordinates>;
  using Point = Vec<double, Space::dimension>;
  static constexpr int coordinates = Link::coordinates;

  typename Space::template Frame<double> base;  ///< base point; +y along the base tangent where that is fixed
  Link link;
  Drive drive;
  Closure closure;
  Point platform_point = Point::Zero();  ///< in the platform's frame [m]
  Backbone backbone;

  template <Scalar S>
  LinkTip<S> tip(const S& q) const {
    return link.tip(q);
  }

  /// Base point to platform point, in the base frame [m].
  template <Scalar S>
  Vec<S, Space::dimension> reach(const typename Space::template Frame<S>& platform) const {
    const Vec<S, Space::dimension> world =
        platform.point(platform_point.template cast<S>()) - base.p.template cast<S>();
    return in_base<S>(world);
  }

  /// @implements TDPCR (18)
  template <Scalar S>
  Blocks<S> blocks(const typename Space::template Frame<S>& platform, const LinkTip<S>& tip) const {
    const Vec<S, Space::dimension> b = platform.rotate(platform_point.template cast<S>());
    const Vec<S, Space::dimension> r = in_base<S>(platform.p + b - base.p.template cast<S>());
    const Anchor<S, Link::dimension, Link::coordinates> anchor = closure.anchor(tip);
    const DistanceRow<S, Link::dimension, Link::coordinates> row = distance_row(r, anchor);
    using std::sqrt;
    const S error = sqrt(squared_norm(row.normal)) - sqrt(S(2) * anchor.half_square);
    return {row.g, Space::line(to_world<S>(row.normal), b), row.g_q, error};
  }

  /// @name Inputs a (what a motor commands) and link coordinates q
  /// @{
  double coordinate(double input) const { return drive.coordinate(link, input); }
  double input(double q) const { return drive.input(link, q); }
  double input_rate() const { return drive.rate(link); }  ///< ∂q/∂a
  /// The coordinate lies in (−domain, domain): short of a full turn, and no tendon at its centre of
  /// curvature.
  double domain() const { return std::min(link.bounds().domain, drive.domain()); }
  bool in_domain(double q) const { return std::abs(q) < domain(); }  // false for NaN
  /// @}

  /// All link coordinates in ascending order that close the leg at this platform pose; returns their number,
  /// -1 where they cannot be told apart.
  int coordinates_at(const typename Space::template Frame<double>& platform, std::span<double> roots) const {
    const Point r = reach<double>(platform);
    int count = 0;
    if constexpr (SolvesInClosedForm<Closure, Link, Point>) {
      count = closure.coordinates_at(link, r, roots);
    } else {
      count = all_roots(closing_at(r), search_for(0), roots);
    }
    const auto end = std::remove_if(roots.begin(), roots.begin() + std::max(count, 0),
                                    [this](double q) { return !in_domain(q); });  // its ends are not in it
    return count < 0 ? count : static_cast<int>(end - roots.begin());
  }

  /// The one of them that is nearest to a target; `sign` ±1 asks for coordinates of that sign (0 has both).
  NearestRoot coordinate_near(const typename Space::template Frame<double>& platform, double target,
                              int sign) const {
    if constexpr (SolvesInClosedForm<Closure, Link, Point>) {
      std::array<double, 8> roots;
      const int count = coordinates_at(platform, roots);
      NearestRoot nearest{std::min(count, 0), 0};
      for (int i = 0; i < count; ++i) {
        const double q = roots[static_cast<std::size_t>(i)];
        if (q * sign < 0 || (nearest.count > 0 && std::abs(q - target) > std::abs(nearest.root - target)))
          continue;
        nearest = {1, q};
      }
      return nearest;
    } else {
      const NearestRoot nearest = nearest_root(closing_at(reach<double>(platform)), search_for(sign), target);
      return nearest.count > 0 && !in_domain(nearest.root) ? NearestRoot{0, 0} : nearest;
    }
  }

  /// Why `coordinates_at` found none.
  void explain_unreachable(const typename Space::template Frame<double>& platform,
                           FixedText<240>& text) const {
    closure.explain_unreachable(reach<double>(platform).norm(), link.bounds().reach, text);
  }

  /// The link's base frame: as given, or, where the base turns, such that the tip lies towards the platform
  /// point.
  typename Space::template Frame<double> base_frame(const typename Space::template Frame<double>& platform,
                                                    const LinkTip<double>& tip) const {
    if constexpr (!Closure::base_turns) {
      return base;
    } else {
      const Point r = reach<double>(platform);
      const double turn = std::atan2(r.y(), r.x()) - std::atan2(tip.position.y(), tip.position.x());
      return Space::template Frame<double>::from(base.p.x(), base.p.y(), turn);
    }
  }

  LegState state(const typename Space::template Frame<double>& platform, double q) const {
    const LinkTip<double> at = tip(q);
    constexpr double quarter_turn = std::numbers::pi / 2;  // +y from +x
    return {q, at.position.norm(), drive.lengths(link, q),
            wrap_angle(base_frame(platform, at).angle() + quarter_turn)};
  }

 private:
  /// The residual as a function of the one link coordinate, the platform point held.
  auto closing_at(const Point& r) const {
    const TipBounds bounds = link.bounds();
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * (r.norm() + bounds.reach);
    return [this, r, bounds, rounding](double q) {
      const auto row = distance_row(r, closure.anchor(link.tip(q)));
      const double pull = row.normal.norm();  // g = ½(pull² − D²), and pull is known to `rounding`
      const double largest_pull = pull + bounds.rate * stride();
      return RootSample{row.g, row.g_q[0], closure.rate_rate_bound(largest_pull, bounds),
                        rounding * std::max(pull, rounding)};
    };
  }
  double stride() const { return domain() / 8; }
  RootsOptions search_for(int sign) const {
    return {.low = sign > 0 ? 0 : -domain(), .high = sign < 0 ? 0 : domain(), .stride = stride()};
  }

  template <class S>
  using Vector = Vec<S, Space::dimension>;

  // Distances do not care how a free base is turned: its frame stays that of the robot.
  template <Scalar S>
  Vector<S> in_base(const Vector<S>& world) const {
    if constexpr (Closure::base_turns)
      return world;
    else
      return Space::template cast<S>(base).rotate_back(world);
  }
  template <Scalar S>
  Vector<S> to_world(const Vector<S>& local) const {
    if constexpr (Closure::base_turns)
      return local;
    else
      return Space::template cast<S>(base).rotate(local);
  }
};

}  // namespace sinew::inline v0
