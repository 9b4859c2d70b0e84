/// @file pose_lanes-inl.hpp
/// Poses of a platform and what they do to its points, one pose a lane. Included once for each instruction
/// set, as lanes-inl.hpp.
#if defined(SINEW_ANALYSIS_POSE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_ANALYSIS_POSE_LANES_INL
#undef SINEW_ANALYSIS_POSE_LANES_INL
#else
#define SINEW_ANALYSIS_POSE_LANES_INL
#endif

#include <limits>

#include "analysis/velocity_lanes.hpp"
#include "math/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::velocity_lanes {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace lanes::HWY_NAMESPACE;

using Mask = hn::Mask<Tag>;

/// The poses of one pack within a part; the last pack may be of fewer than its lanes.
struct Place {
  const Part* part;
  std::size_t at, count;

  HWY_INLINE bool is_full() const { return count == hn::Lanes(tag); }

  /// Coordinate `axis` of the poses. Lanes without one repeat nothing: they are 0.
  HWY_INLINE Pack load(std::size_t axis) const {
    const double* from = part->poses + axis * part->total + at;
    if (is_full()) return hn::LoadU(tag, from);
    HWY_ALIGN double padded[hn::MaxLanes(tag)] = {};
    std::copy_n(from, count, padded);
    return hn::Load(tag, padded);
  }

  HWY_INLINE void store(Pack values, std::span<double> to, std::size_t row = 0) const {
    double* into = to.data() + row * part->total + at;
    if (is_full()) return hn::StoreU(values, tag, into);
    HWY_ALIGN double lanes[hn::MaxLanes(tag)];
    hn::Store(values, tag, lanes);
    std::copy_n(lanes, count, into);
  }
  /// NaN where there is no solution.
  HWY_INLINE void store(Pack values, Mask unreachable, std::span<double> to, std::size_t row = 0) const {
    const Pack absent = all(std::numeric_limits<double>::quiet_NaN());
    store(hn::IfThenElse(unreachable, absent, values), to, row);
  }
};

/// Points of the plane and of space, in lanes.
template <std::size_t D>
struct Point {
  Pack at[D];
};

struct Turn2 {
  Pack x, y, c, s;
  Mask is_fit;

  HWY_INLINE explicit Turn2(const Place& place) : x(place.load(0)), y(place.load(1)), c(x), s(y), is_fit() {
    const Pack angle = place.load(2);
    is_fit = hn::Lt(hn::Abs(angle), all(1e4));  // beyond it Highway's own reduction loses digits
    c = hn::Cos(tag, angle);
    s = hn::Sin(tag, angle);
  }
  /// b of a leg in base axes, and from its base point there.
  template <class LegT>
  HWY_INLINE void reach(const LegT& leg, Point<2>& b, Point<2>& r) const {
    const Pack u = all(leg.point[0]), v = all(leg.point[1]);
    b.at[0] = minus(c * u, s, v);
    b.at[1] = plus(c * v, s, u);
    r.at[0] = x + b.at[0] - all(leg.base[0]);
    r.at[1] = y + b.at[1] - all(leg.base[1]);
  }
};

/// u turned by the unit quaternion (w, v).
HWY_INLINE void turn(Pack w, const Pack* v, const Pack* u, Pack* out) {
  Pack side[3];  // 2 v × u
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    side[i] = all(2) * minus(v[j] * u[k], v[k], u[j]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = plus(u[i], side[i], w) + minus(v[j] * side[k], v[k], side[j]);
  }
}

struct Turn3 {
  Pack p[3], w, v[3];
  Mask is_fit;

  Turn3() = default;
  HWY_INLINE explicit Turn3(const Place& place)
      : p{place.load(0), place.load(1), place.load(2)},
        w(place.load(3)),
        v{place.load(4), place.load(5), place.load(6)},
        is_fit() {
    const Pack square = plus(dot<3>(v, v), w, w);
    is_fit = hn::And(hn::Gt(square, all(1e-100)), hn::Lt(square, all(1e100)));
    const Pack scale = all(1) / hn::Sqrt(square);
    w = w * scale;
    for (Pack& number : v) number = number * scale;
  }
  template <class LegT>
  HWY_INLINE void reach(const LegT& leg, Point<3>& b, Point<3>& r) const {
    const Pack u[3] = {all(leg.point[0]), all(leg.point[1]), all(leg.point[2])};
    turn(w, v, u, b.at);
    for (std::size_t i = 0; i < 3; ++i) r.at[i] = p[i] + b.at[i] - all(leg.base[i]);
  }
};

HWY_INLINE void moment(const Point<2>& b, const Pack* f, Pack* out) {
  out[0] = minus(b.at[0] * f[1], b.at[1], f[0]);
}
HWY_INLINE void moment(const Point<3>& b, const Pack* f, Pack* out) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = minus(b.at[j] * f[k], b.at[k], f[j]);
  }
}

/// Where lanes are for certain.
struct Certain {
  Mask reached, unreachable;
};

/// What the legs make of a pose, N rows for the N freedoms of the platform.
template <std::size_t N>
struct Rows {
  Pack line[N][N];  ///< of the homogenised J
  Pack size[N];     ///< by which the papers' raw J is longer
  Pack drive[N];    ///< entry of the homogenised K: row i is moved by input i, if by any
};

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::velocity_lanes
HWY_AFTER_NAMESPACE();
#endif
