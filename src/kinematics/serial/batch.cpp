// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kinematics/serial/batch.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "sinew/kinematics/serial.hpp"

// A namespace of its own: others have a `load` and a `store` for each instruction set, too.
HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::serial_lanes {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The kernel once more for each instruction set: what was compiled for another is not inlined.
#undef SINEW_KERNEL_ARC_H
#undef SINEW_KERNEL_SECTION_H
#include "sinew/kernel/section.h"
namespace wide_kernel = sinew::kernel;

using Tag = hn::ScalableTag<double>;
constexpr Tag tag;

/// One number of several poses, as the kernel's scalar: two packs, which share what is loaded of the robot
/// and hide each other's latency.
struct Number {
  hn::Vec<Tag> a, b;
  Number() = default;
  HWY_INLINE explicit Number(double x) : a(hn::Set(tag, x)), b(a) {}
  HWY_INLINE Number(hn::Vec<Tag> one, hn::Vec<Tag> other) : a(one), b(other) {}
};
HWY_INLINE Number operator+(Number x, Number y) { return {hn::Add(x.a, y.a), hn::Add(x.b, y.b)}; }
HWY_INLINE Number operator-(Number x, Number y) { return {hn::Sub(x.a, y.a), hn::Sub(x.b, y.b)}; }
HWY_INLINE Number operator*(Number x, Number y) { return {hn::Mul(x.a, y.a), hn::Mul(x.b, y.b)}; }

HWY_INLINE Number load(const double* from) {
  return {hn::LoadU(tag, from), hn::LoadU(tag, from + hn::Lanes(tag))};
}
HWY_INLINE void store(Number x, double* to) {
  hn::StoreU(x.a, tag, to);
  hn::StoreU(x.b, tag, to + hn::Lanes(tag));
}

/// Whether all are below a bound; NaN is not.
HWY_INLINE bool all_below(Number x, double bound) {
  const auto most = hn::Set(tag, bound);
  return hn::AllTrue(tag, hn::And(hn::Le(x.a, most), hn::Le(x.b, most)));
}

/// The kernel's series, each step one fused operation where the machine has it.
template <int From, int To>
HWY_INLINE Number chord_series(Number w) {
  constexpr double c = wide_kernel::detail::coefficient(2, From);
  const Number constant(c);
  if constexpr (From == To) {
    return constant;
  } else {
    const Number rest = chord_series<From + 1, To>(w);
    return {hn::MulAdd(w.a, rest.a, constant.a), hn::MulAdd(w.b, rest.b, constant.b)};
  }
}

/// The kernel's, without a branch of its own for each lane.
HWY_INLINE Number chord_loss(Number w) {
  if (all_below(w, kernel::few_below)) return w * chord_series<1, kernel::Terms<double>::few>(w);
  if (all_below(w, kernel::max_below)) return w * chord_series<1, kernel::Terms<double>::most>(w);
  HWY_ALIGN double lanes[2 * hn::MaxLanes(tag)];
  store(w, lanes);
  for (std::size_t i = 0; i < 2 * hn::Lanes(tag); ++i) lanes[i] = kernel::chord_loss(lanes[i]);
  return load(lanes);
}
HWY_INLINE void chord_losses(Number w_x, Number w_y, Number& x, Number& y) {
  x = chord_loss(w_x);
  y = chord_loss(w_y);
}

/// The robot's maps in all lanes.
using WideSection = wide_kernel::Section<Number>;

HWY_INLINE WideSection wide(const kernel::Section<double>& map) {
  return {static_cast<wide_kernel::Backbone>(map.backbone), Number(map.length), Number(map.gain),
          Number(map.per_gain), Number(map.half)};
}

/// Flat: packs that are passed on through memory take twice the time.
template <wide_kernel::Model model>
HWY_FLATTEN void changes_of(const SerialWorkspace& maps, const double* bends, double* changes,
                            std::size_t poses, std::size_t at) {
  wide_kernel::Pull<Number> sum{Number(0.0), Number(0.0), Number(0.0)};
  std::size_t tendon = 0;
  for (std::size_t m = 0; m < maps.maps.size(); ++m) {
    const wide_kernel::Bend<Number> bend{load(bends + 2 * m * poses + at),
                                         load(bends + (2 * m + 1) * poses + at)};
    sum = sum + wide_kernel::pull<model>(wide(maps.maps[m]), bend, Number(maps.extensions[m]));
    for (int i = 0; i < maps.tendons[m]; ++i, ++tendon) {
      const auto& d = maps.directions[tendon];
      const wide_kernel::Direction<Number> direction{Number(d.cosine), Number(d.sine)};
      store(wide_kernel::tendon_change(sum, direction), changes + tendon * poses + at);
    }
  }
}

/// Whole packs first; the last one overlaps them where the poses do not fill it. Fewer poses than lanes are
/// padded.
template <wide_kernel::Model model>
void sweep(const SerialWorkspace& maps, std::span<const double> bends, std::span<double> changes,
           std::size_t poses) {
  const std::size_t lanes = 2 * hn::Lanes(tag);
  if (poses < lanes) {
    std::vector<double> padded(bends.size() / poses * lanes), out(changes.size() / poses * lanes);
    for (std::size_t k = 0; k < bends.size(); ++k) padded[k / poses * lanes + k % poses] = bends[k];
    changes_of<model>(maps, padded.data(), out.data(), lanes, 0);
    for (std::size_t k = 0; k < changes.size(); ++k) changes[k] = out[k / poses * lanes + k % poses];
    return;
  }
  for (std::size_t at = 0; at + lanes <= poses; at += lanes)
    changes_of<model>(maps, bends.data(), changes.data(), poses, at);
  if (poses % lanes != 0) changes_of<model>(maps, bends.data(), changes.data(), poses, poses - lanes);
}

void TendonChanges(const SerialWorkspace& maps, kernel::Model model, std::span<const double> bends,
                   std::span<double> changes, std::size_t poses) {
  if (model == kernel::Model::exact)
    sweep<wide_kernel::Model::exact>(maps, bends, changes, poses);
  else
    sweep<wide_kernel::Model::linear>(maps, bends, changes, poses);
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::serial_lanes
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1 {
namespace serial_lanes {

HWY_EXPORT(TendonChanges);

void tendon_changes(std::span<const double> bends, kernel::Model model, std::span<double> changes,
                    const SerialWorkspace& work, std::size_t poses) {
  HWY_DYNAMIC_DISPATCH(TendonChanges)(work, model, bends, changes, poses);
}

}  // namespace serial_lanes

void tendon_changes_batch(std::span<const double> bends, kernel::Model model, std::span<double> changes,
                          const SerialWorkspace& work) {
  const std::size_t poses = work.bends.empty() ? 0 : bends.size() / (2 * work.bends.size());
  if (bends.size() != poses * 2 * work.bends.size() || changes.size() != poses * work.changes.size())
    return void(std::ranges::fill(changes, std::numeric_limits<double>::quiet_NaN()));
  if (poses > 0) serial_lanes::tendon_changes(bends, model, changes, work, poses);
}

}  // namespace sinew::inline v1
#endif
