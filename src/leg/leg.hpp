/// @file leg.hpp
/// A leg: base frame + link + drive + closure + platform point. It hands over residual rows with their
/// Jacobian blocks, all a robot or a solver ever learns of it. One call returns values and Jacobians
/// together: no cache, no call order. Theory: docs/theory/leg.md
#pragma once
#include <array>
#include <concepts>
#include <span>

#include "leg/blocks.hpp"
#include "leg/closure.hpp"
#include "leg/platform_constraint.hpp"
#include "leg/space.hpp"
#include "link/backbone.hpp"
#include "sinew/link/state.hpp"
#include "solve/message.hpp"
#include "solve/roots.hpp"

namespace sinew::inline v1 {

/// A closure that gives the coordinates of this link in closed form; others are searched.
template <class Closure, class Link, class Point>
concept SolvesInClosedForm = requires(const Closure& closure, const Link& link, const Point& r,
                                      const SolutionPreference& wish,
                                      std::span<Vec<double, Link::coordinates>> roots) {
  { closure.coordinates_at(link, r, wish, 1.0, roots) } -> std::same_as<int>;
};

template <class SpaceT, class LinkT, class DriveT, class ClosureT>
struct Leg {
  using Space = SpaceT;
  using Link = LinkT;
  using Drive = DriveT;
  using Closure = ClosureT;
  static constexpr int dimension = Space::dimension;
  static constexpr int rows = held_rows<Closure::holds, dimension>;
  static constexpr int coordinates = Link::coordinates;
  static constexpr int inputs = Drive::inputs;
  /// The base tangent has a direction of its own, which a file must give.
  static constexpr bool is_clamped = !Closure::base_turns && !Link::has_base_joint;
  /// At a pose the leg can still move: it has a continuum of solutions.
  static constexpr bool is_redundant = coordinates > rows;
  /// The strut may lead to either side: solutions come in pairs that a wish tells apart by their elbow.
  static constexpr bool has_elbow = is_redundant || HasSlide<Link>;
  static constexpr bool has_plane =
      Closure::holds == Holds::distance_in_plane;                 ///< the last row is that of a plane
  static constexpr int driven_rows = rows - (has_plane ? 1 : 0);  ///< rows that the link's coordinates close

  template <class S>
  using LinkTip = Tip<S, Link::dimension, coordinates>;
  template <class S>
  using Blocks = LegBlocks<S, rows, Space::dof, coordinates>;
  using Frame = typename Space::template Frame<double>;
  using Point = Vec<double, dimension>;
  using Coordinates = Vec<double, coordinates>;

  Frame
      base;  ///< base point; axes: +y along the base tangent where that is clamped, see Space where it is not
  Link link;
  Drive drive;
  Closure closure;
  Point platform_point = Point::Zero();  ///< in the platform's frame [m]
  Backbone backbone;

  /// A length to compare errors with [m].
  double size() const {
    double size = base.p.norm() + platform_point.norm() + link.size();
    if constexpr (HasStrut<Closure> && !HasArc<Link>) size += closure.length;
    return size;
  }

  template <Scalar S>
  LinkTip<S> tip(const Vec<S, coordinates>& q) const {
    return link.tip(q);
  }

  /// Base point to platform point, in the axes the link's tip is given in [m].  @implements TDPCR (57)
  template <Scalar S>
  Vec<S, dimension> offset(const typename Space::template Frame<S>& platform) const {
    return in_base<S>(platform.point(platform_point.template cast<S>()) - base.p.template cast<S>());
  }

  /// @name Axes
  /// Only the tip of a clamped link has axes of its own; a free base leaves distances alone, and a link with
  /// a joint of its own has the base's.
  /// @{
  template <Scalar S>
  Vec<S, dimension> in_base(const Vec<S, dimension>& world) const {
    if constexpr (is_clamped)
      return Space::template cast<S>(base).rotate_back(world);
    else
      return world;
  }
  template <Scalar S>
  Vec<S, dimension> to_world(const Vec<S, dimension>& local) const {
    if constexpr (is_clamped)
      return Space::template cast<S>(base).rotate(local);
    else
      return local;
  }
  /// Of the plane that holds the platform point; 0 without one.
  template <Scalar S>
  static Vec<S, dimension> plane_normal() {
    if constexpr (has_plane)
      return Closure::template plane_normal<S>();
    else
      return Vec<S, dimension>::Zero();
  }
  /// @}

  /// @implements TDPCR (18)
  template <Scalar S>
  [[gnu::always_inline]] Blocks<S> blocks(const typename Space::template Frame<S>& platform,
                                          const LinkTip<S>& tip) const {
    const Vec<S, dimension> b = platform.rotate(platform_point.template cast<S>());
    const Vec<S, dimension> r = in_base<S>(platform.p + b - base.p.template cast<S>());
    const auto anchor = anchor_of<dimension>(closure, tip);
    const Vec<S, dimension> n = r - anchor.position;
    const auto held = closure_rows<Closure::holds>(n, anchor.half_square, plane_normal<S>());
    using std::sqrt;
    Blocks<S> blocks;
    blocks.g = held.g;
    for (int k = 0; k < rows; ++k) {  // those of K are 0 in a plane: it holds the carriage's path
      const Vec<S, dimension> direction = held.direction.col(k);
      blocks.g_x.row(k) = Space::line(to_world<S>(direction), b);
      blocks.g_q.row(k) = closure_slope<Closure::holds>(held, k, anchor);
    }
    blocks.error = sqrt(squared_norm(n)) - sqrt(S(2) * anchor.half_square);
    return blocks;
  }

  /// How far the leg is from closed [m].
  static double closure_error(const Blocks<double>& blocks) {
    return closure_error_of(blocks.error, 0, has_plane ? blocks.g[rows - 1] : 0);
  }

  /// The same, without the derivatives.
  double closure_error(const Frame& platform, const Coordinates& q) const {
    return closure_error_at(offset<double>(platform), q);
  }

  /// What is left of the leg once its link is shaped.
  PlatformConstraint<dimension> reach(const Coordinates& q) const {
    const auto anchor = anchor_of<dimension>(closure, link.tip(q));
    const double distance = std::sqrt(2 * anchor.half_square);
    if constexpr (HasSlide<Link> && has_plane)
      return {base.p + link.slide(q) * Space::second_axis(base), distance, platform_point,
              Space::first_axis(base)};
    else
      return {base.p + to_world<double>(anchor.position), distance, platform_point};
  }

  /// @name Inputs a (what motors command) and link coordinates q
  /// @{
  Coordinates coordinates_of(std::span<const double> input) const { return drive.coordinates(link, input); }
  Vec<double, inputs> inputs_of(const Coordinates& q) const { return drive.commands(link, q); }
  Mat<double, coordinates, inputs> input_rate() const { return drive.rate(link); }  ///< ∂q/∂a
  /// The branch coordinate lies in (−domain, domain): a curvature short of a full turn, and no tendon at its
  /// centre of curvature; a slide not beyond any place.
  double domain() const { return std::min(link.domain(), drive.domain()); }
  bool in_domain(const Coordinates& q) const { return std::abs(link.branch(q)) < domain() && q.allFinite(); }
  /// A change of the branch coordinate that compares with a radian: of a curvature the bend angle κℓ is.
  double branch_unit() const {
    if constexpr (HasArc<Link>)
      return 1 / link.size();
    else
      return size();
  }
  /// @}

  /// Link coordinates in ascending order of their branch coordinate that close the leg at this platform pose:
  /// all of them, or of a leg that can still move there those the wish singles out. Returns their number, -1
  /// where they cannot be told apart.
  int solutions_at(const Frame& platform, const SolutionPreference& wish,
                   std::span<Coordinates> roots) const {
    return solutions_of(offset<double>(platform), wish, roots);
  }

  /// The same for a platform point at r, in the axes the link's tip is given in.
  int solutions_of(const Point& r, const SolutionPreference& wish, std::span<Coordinates> roots) const {
    int count = 0;
    if constexpr (SolvesInClosedForm<Closure, Link, Point>) {
      count = closure.coordinates_at(link, r, wish, domain(), roots);
    } else {
      static_assert(coordinates == 1);
      std::array<double, 8> found;
      count = all_roots(closing_at(r), search_for(0), found);
      for (int k = 0; k < count; ++k) roots[at(k)][0] = found[at(k)];
    }
    const auto end = std::remove_if(roots.begin(), roots.begin() + std::max(count, 0),
                                    [this](const Coordinates& q) { return !in_domain(q); });
    return count < 0 ? count : static_cast<int>(end - roots.begin());
  }

  /// A solution, or how the search for it ended: `count` as `solutions_at`.
  struct Nearest {
    int count;
    Coordinates q;
    double closure_error = 0;  ///< how far the leg is from closed there [m]
  };

  /// The one of them that is wished for.
  Nearest nearest_solution(const Frame& platform, const SolutionPreference& wish) const {
    const Point r = offset<double>(platform);
    Nearest nearest = nearest_of(r, wish);
    if (nearest.count > 0) nearest.closure_error = closure_error_at(r, nearest.q);
    return nearest;
  }

  /// Why `solutions_at` found none.
  void explain_unreachable(const Frame& platform, FixedText<240>& text) const {
    const Point r = offset<double>(platform);
    if constexpr (HasSlide<Link>) {
      std::array<Coordinates, 8> roots;
      if (closure.coordinates_at(link, r, {}, domain(), roots) > 0) {  // the strut reaches
        text.append(Link::beyond_domain);
        text.append(" along its rail; choose a pose nearer to its base");
        return;
      }
    }
    if constexpr (!HasStrut<Closure>)
      if (const double needed = link.arc().curvature_from_chord(r.norm());
          needed >= drive.domain() && needed < link.arc().bounds().domain) {
        text.append("would have to bend to a radius of ");
        append_mm(text, 1 / needed);
        text.append(", and its inner tendon is ");
        append_mm(text, drive.tendon_offset());
        text.append(" from the backbone");
        return;
      }
    closure.explain_unreachable(r, link.size(), text);
  }

  /// The backbone's base frame (in space: x to the side of tendon 1, y ahead): as given, as its own joint
  /// turns it, or, where the base is free, such that the tip lies towards the platform point.
  Frame link_frame(const Frame& platform, const Coordinates& q) const {
    if constexpr (Closure::base_turns)
      return Space::aimed(base, offset<double>(platform), link.tip(q).position);
    else if constexpr (Link::has_base_joint)
      return Frame::from(base.p.x(), base.p.y(), link.base_tangent(q) - std::numbers::pi / 2);
    else
      return base;
  }

  LegState state(const Frame& platform, const Coordinates& q) const {
    LegState state;
    if constexpr (HasArc<Link>) {
      state.curvature = link.curvature(q);
      state.chord = link.arc().chord(state.curvature);
      state.tendon_lengths = drive.lengths(link.size(), state.curvature);
      state.base_tangent = Space::base_tangent(link_frame(platform, q));
    } else {
      const Point strut = offset<double>(platform) - link.tip(q).position;
      state.slide = link.slide(q);
      state.carriage = base.point(link.tip(q).position);
      state.hinge_angle = std::atan2(strut.z(), strut.y());
      state.elbow = strut.y() < 0 ? -1 : 1;
    }
    if constexpr (Closure::base_turns && dimension == 3)
      state.joint_angles = Space::joint_angles(base, offset<double>(platform), link.tip(q).position);
    if constexpr (is_redundant)
      state.elbow = cross(link.tip(q).position, offset<double>(platform)) < 0 ? -1 : 1;
    return state;
  }

 private:
  Nearest nearest_of(const Point& r, const SolutionPreference& wish) const {
    if constexpr (SolvesInClosedForm<Closure, Link, Point>) {
      std::array<Coordinates, 8> roots;
      const int count = solutions_of(r, wish, roots);
      Nearest nearest{std::min(count, 0), Coordinates::Zero()};
      for (int k = 0; k < count; ++k) {
        const Coordinates& q = roots[at(k)];
        if (HasArc<Link> && link.branch(q) * wish.bending < 0) continue;
        if (nearest.count > 0 && distance(q, wish) > distance(nearest.q, wish)) continue;
        nearest = {1, q};
      }
      return nearest;
    } else {
      const NearestRoot found = nearest_root(closing_at(r), search_for(wish.bending), wish.near);
      const Coordinates q(found.root);
      return found.count > 0 && !in_domain(q) ? Nearest{0, q} : Nearest{found.count, q};
    }
  }

  double closure_error_at(const Point& r, const Coordinates& q) const {
    const auto anchor = anchor_of<dimension>(closure, link.tip(q));
    const Point n = r - anchor.position;
    return closure_error_of(n.norm(), std::sqrt(2 * anchor.half_square), dot(plane_normal<double>(), n));
  }

  static std::size_t at(int k) { return static_cast<std::size_t>(k); }
  double distance(const Coordinates& q, const SolutionPreference& wish) const {
    return std::abs(link.branch(q) - wish.near);
  }

  /// The residual as a function of the one link coordinate, the platform point held.
  auto closing_at(const Point& r) const {
    const TipBounds bounds = link.bounds();
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * (r.norm() + bounds.reach);
    return [this, r, bounds, rounding](double q) {
      const auto anchor = anchor_of<dimension>(closure, link.tip(q));
      const Point n = r - anchor.position;
      const double pull = n.norm();  // g = ½(pull² − D²), and pull is known to `rounding`
      const double largest_pull = pull + bounds.rate * stride();
      const auto held = closure_rows<Closure::holds>(n, anchor.half_square, plane_normal<double>());
      return RootSample{held.g[0], closure_slope<Closure::holds>(held, 0, anchor)[0],
                        rate_rate_bound<Closure>(largest_pull, bounds), rounding * std::max(pull, rounding)};
    };
  }
  double stride() const { return domain() / 8; }
  RootsOptions search_for(int sign) const {
    return {.low = sign > 0 ? 0 : -domain(), .high = sign < 0 ? 0 : domain(), .stride = stride()};
  }
};

}  // namespace sinew::inline v1
