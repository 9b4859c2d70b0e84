/// @file roots.hpp
/// Roots of a smooth function of one variable, with proof that none is skipped: from every point the search
/// steps as far as a bound on |f″| promises no root. The same step converges quadratically on a simple root.
/// Theory: docs/theory/roots.md
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// A function of one variable as the search sees it.
struct RootSample {
  double value, rate;
  double rate_rate;  ///< bound on |f″| within RootsOptions::stride of the point
  double noise;      ///< rounding error of `value`: where |f| stays below it, there is a root
};

struct RootsOptions {
  double low, high;  ///< the interval searched
  double stride;     ///< longest step
};

namespace detail {

/// How far |f| surely stays positive from `here` onwards: it does while |f| + slope·h − ½·rate_rate·h² > 0,
/// slope taken along |f| in the direction of the step. Written so that nothing cancels.
inline double free_distance(const RootSample& here, double direction) {
  const double slope = (here.value < 0 ? -direction : direction) * here.rate;
  const double root_term = std::sqrt(slope * slope + 2 * here.rate_rate * std::abs(here.value));
  return slope < 0 ? 2 * std::abs(here.value) / (root_term - slope) : (slope + root_term) / here.rate_rate;
}

/// Walks along f in one direction from root to root.
template <class F>
class RootWalk {
 public:
  /// @param direction +1 or −1
  RootWalk(const F& f, const RootsOptions& options, double start, double direction)
      : f_(f),
        options_(options),
        x_(start),
        direction_(direction) {}

  double position() const { return x_; }
  bool at_end() const { return direction_ > 0 ? x_ >= options_.high : x_ <= options_.low; }
  bool failed() const { return failed_; }

  /// One step; true where it came upon a root, which is then at `root()`. A root is told once: on entering
  /// the points where f is zero within rounding (a double or flatter root has many), or by its change of
  /// sign.
  bool step() {
    const RootSample here = f_(x_);
    if (!std::isfinite(here.value) || ++steps_ > 20000) return !(failed_ = true);
    const bool was_inside = inside_, crossed = here.value * before_ < 0;
    before_ = here.value;
    inside_ = std::abs(here.value) <= (was_inside ? 4 : 1) * here.noise;
    if (inside_ || (crossed && !was_inside)) {
      root_ = std::abs(polished(here) - x_) < smallest() ? polished(here) : x_;
      // Leave it by half of what surely holds no other root.
      x_ += direction_ * std::max(std::abs(here.rate) / here.rate_rate, smallest());
      return !was_inside;
    }
    x_ += direction_ *
          std::max(std::min(free_distance(here, direction_), options_.stride), 1e-16 * std::abs(x_));
    return false;
  }
  double root() const { return root_; }

 private:
  double smallest() const { return 1e-8 * (options_.high - options_.low); }
  /// The last digits of a simple root.
  double polished(const RootSample& here) const { return here.rate == 0 ? x_ : x_ - here.value / here.rate; }

  const F& f_;
  const RootsOptions& options_;
  double x_, direction_, root_ = 0, before_ = 0;
  int steps_ = 0;
  bool failed_ = false, inside_ = false;
};

}  // namespace detail

/// Writes the roots in ascending order and returns how many there are (at most roots.size(), the lowest
/// ones); -1 where f is not finite or the walk does not end within 20 000 steps (a few dozen are usual). A
/// double root, where two solutions merge, is written once.
template <class F>
int all_roots(const F& f, const RootsOptions& options, std::span<double> roots) {
  detail::RootWalk walk(f, options, options.low, 1);
  std::size_t count = 0;
  while (!walk.at_end() && count < roots.size()) {
    if (walk.step())
      roots[count++] = walk.root();
    else if (walk.failed())
      return -1;
  }
  return static_cast<int>(count);
}

/// The root nearest to a target.
struct NearestRoot {
  int count;    ///< 1; 0 where there is no root; -1 as for `all_roots`
  double root;  ///< of two equally near the larger one
};

namespace detail {

/// Plain Newton from `target`, then the proof that no other root is as near: f is monotone within
/// |f′|/rate_rate of either end of the path, and free of roots as far on the other side. Not a number where
/// the proof fails.
template <class F>
double proven_newton(const F& f, const RootsOptions& options, double target, const RootSample& at_target) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  double x = target;
  RootSample here = at_target;
  for (int i = 0; i < 8; ++i) {
    const double correction = here.value / here.rate, next = x - correction;
    if (!(next > options.low && next < options.high)) return nothing;
    x = next;
    // What the next correction can still be: |f(x)/f′| ≤ ½·rate_rate·correction²/|f′|.
    if (here.rate_rate * correction * correction > 1e-16 * std::abs(here.rate * x) &&
        std::abs(correction) > 1e-16 * std::abs(x)) {
      here = f(x);
      continue;
    }
    const double distance = std::abs(x - target), away = x > target ? -1 : 1;
    const bool monotone =
        at_target.rate * here.rate > 0 &&
        distance * at_target.rate_rate < 0.99 * (std::abs(at_target.rate) + std::abs(here.rate));
    return monotone && distance < options.stride && distance < 0.99 * free_distance(at_target, away)
               ? x
               : nothing;
  }
  return nothing;
}

}  // namespace detail

/// Newton's answer where it is proven nearest; else walks outwards from `target` both ways, always on the
/// side that is behind, so that what lies beyond the answer costs nothing.
template <class F>
NearestRoot nearest_root(const F& f, const RootsOptions& options, double target) {
  const double start = std::clamp(target, options.low, options.high);
  const double quick = detail::proven_newton(f, options, start, f(start));
  if (start == target && !std::isnan(quick)) return {1, quick};
  detail::RootWalk up(f, options, start, 1), down(f, options, start, -1);
  NearestRoot nearest{0, 0};
  const auto distance = [&](double x) { return std::abs(x - target); };
  for (;;) {
    const bool can_up = !up.at_end() && !(nearest.count && distance(up.position()) > distance(nearest.root));
    const bool can_down =
        !down.at_end() && !(nearest.count && distance(down.position()) > distance(nearest.root));
    if (!can_up && !can_down) return nearest;
    const bool go_up = can_up && (!can_down || distance(up.position()) <= distance(down.position()));
    detail::RootWalk<F>& walk = go_up ? up : down;
    if (walk.step()) {
      const double gain = nearest.count ? distance(nearest.root) - distance(walk.root()) : 1;
      if (gain > 0 || (gain == 0 && walk.root() > nearest.root)) nearest = {1, walk.root()};
    } else if (walk.failed()) {
      return {-1, 0};
    }
  }
}

}  // namespace sinew::inline v1
