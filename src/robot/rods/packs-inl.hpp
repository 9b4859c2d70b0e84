/// @file packs-inl.hpp
/// Numbers of eight rods in vector registers: what the kernels of rods share. Included once for each
/// instruction set, after highway.h.
#if defined(SINEW_ROBOT_PACKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_ROBOT_PACKS_INL
#undef SINEW_ROBOT_PACKS_INL
#else
#define SINEW_ROBOT_PACKS_INL
#endif

#include <hwy/highway.h>

#include "robot/rods/rod_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::packs {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, rod_lanes>;
using Pack = hn::Vec<Tag>;
constexpr Tag tag;

HWY_INLINE Pack all(double x) { return hn::Set(tag, x); }
HWY_INLINE Pack load(const double* p) { return hn::Load(tag, p); }
HWY_INLINE void store(Pack v, double* p) { hn::Store(v, tag, p); }
HWY_INLINE Pack plus(Pack c, Pack a, Pack b) { return hn::MulAdd(a, b, c); }      // c + ab
HWY_INLINE Pack minus(Pack c, Pack a, Pack b) { return hn::NegMulAdd(a, b, c); }  // c − ab
HWY_INLINE double sum(Pack v) { return hn::GetLane(hn::SumOfLanes(tag, v)); }

/// Sums over the lanes of eight packs at once: halves are exchanged between packs, so that no lane adds what
/// is thrown away.
HWY_INLINE void totals(const Pack* v, double* out) {
#if HWY_TARGET == HWY_SCALAR
  for (int k = 0; k < 8; ++k) out[k] = hn::GetLane(v[k]);
#else
  constexpr int lanes = static_cast<int>(hn::MaxLanes(tag));
  Pack half[4];  // each two packs, alternating
  for (int k = 0; k < 4; ++k)
    half[k] =
        hn::InterleaveLower(tag, v[2 * k], v[2 * k + 1]) + hn::InterleaveUpper(tag, v[2 * k], v[2 * k + 1]);
  if constexpr (lanes == 2) {
    for (int k = 0; k < 4; ++k) hn::StoreU(half[k], tag, out + 2 * k);
  } else {
    Pack quarter[2];  // each four, a block one pair
    for (int k = 0; k < 2; ++k)
      quarter[k] = hn::OddEvenBlocks(half[2 * k + 1], half[2 * k]) +
                   hn::SwapAdjacentBlocks(hn::OddEvenBlocks(half[2 * k], half[2 * k + 1]));
    if constexpr (lanes == 4) {
      for (int k = 0; k < 2; ++k) hn::StoreU(quarter[k], tag, out + 4 * k);
    } else {
      const hn::Half<Tag> half_tag;
      for (int k = 0; k < 2; ++k)
        hn::StoreU(hn::LowerHalf(half_tag, quarter[k]) + hn::UpperHalf(half_tag, quarter[k]), half_tag,
                   out + 4 * k);
    }
  }
#endif
}

struct Pack3 {
  Pack x, y, z;
};
HWY_INLINE Pack3 load3(const RodLane* p, int i) { return {load(p[0] + i), load(p[1] + i), load(p[2] + i)}; }
HWY_INLINE void store3(const Pack3& v, RodLane* p, int i) {
  store(v.x, p[0] + i);
  store(v.y, p[1] + i);
  store(v.z, p[2] + i);
}
HWY_INLINE Pack dot(const Pack3& a, const Pack3& b) { return plus(plus(a.x * b.x, a.y, b.y), a.z, b.z); }
HWY_INLINE Pack3 cross(const Pack3& a, const Pack3& b) {
  return {minus(a.y * b.z, a.z, b.y), minus(a.z * b.x, a.x, b.z), minus(a.x * b.y, a.y, b.x)};
}
HWY_INLINE Pack3 scaled(const Pack3& a, Pack s) { return {a.x * s, a.y * s, a.z * s}; }
HWY_INLINE Pack3 plus(const Pack3& c, const Pack3& a, Pack s) {
  return {plus(c.x, a.x, s), plus(c.y, a.y, s), plus(c.z, a.z, s)};
}

/// Sums over lanes and groups.
struct Wrench {
  Pack3 force, moment;
  HWY_INLINE Wrench() : force{all(0), all(0), all(0)}, moment{all(0), all(0), all(0)} {}
  HWY_INLINE void add(const Pack3& arm, const Pack3& n, Pack active) {
    const Pack3 f = scaled(n, active), m = cross(arm, f);
    force = {force.x + f.x, force.y + f.y, force.z + f.z};
    moment = {moment.x + m.x, moment.y + m.y, moment.z + m.z};
  }
  /// Force, moment, one more sum, and 0.
  HWY_INLINE void total(double (&out)[8], Pack more = all(0)) const {
    const Pack packs[8] = {force.x, force.y, force.z, moment.x, moment.y, moment.z, more, all(0)};
    totals(packs, out);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::packs
HWY_AFTER_NAMESPACE();
#endif
