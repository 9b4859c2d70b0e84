// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "robot/rods/rod_kernels.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "robot/rods/packs-inl.hpp"
#include "robot/rods/rod_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::rod_kernels {
namespace HWY_NAMESPACE {
using namespace packs::HWY_NAMESPACE;
/// Horner's rule for several arguments at once, so that a coefficient is loaded once for all.
template <std::size_t M, std::size_t Terms>
HWY_INLINE void polynomial(const double (&coefficient)[Terms], const Pack* z, Pack* value) {
#pragma GCC unroll 8
  for (std::size_t j = 0; j < M; ++j) value[j] = all(coefficient[Terms - 1]);
#pragma GCC unroll 16
  for (int k = static_cast<int>(Terms) - 2; k >= 0; --k) {
    const Pack c = all(coefficient[k]);
#pragma GCC unroll 8
    for (std::size_t j = 0; j < M; ++j) value[j] = plus(c, z[j], value[j]);
  }
}

/// Chebyshev interpolation of sin √z/√z and cos √z on |√z| ≤ 2.5, to 5e-16.
constexpr double sine_terms[] = {1.0,
                                 -0.16666666666666657,
                                 0.0083333333333327937,
                                 -0.00019841269841159288,
                                 2.7557319212477353e-06,
                                 -2.5052107697020063e-08,
                                 1.6059018749487949e-10,
                                 -7.6465972171246894e-13,
                                 2.8037077885288197e-15,
                                 -7.6302175637427495e-18};
constexpr double cosine_terms[] = {1.0,
                                   -0.5,
                                   0.041666666666666609,
                                   -0.0013888888888887486,
                                   2.4801587301407663e-05,
                                   -2.7557319210559188e-07,
                                   2.0876756361990319e-09,
                                   -1.1470726849150241e-11,
                                   4.7791161304792601e-14,
                                   -1.5575894813577533e-16,
                                   3.8150718196340372e-19};

template <std::size_t M>
HWY_INLINE void sine_cosine_near(const Pack* x, Pack* sine, Pack* cosine) {
  Pack z[M];
#pragma GCC unroll 8
  for (std::size_t j = 0; j < M; ++j) z[j] = x[j] * x[j];
  polynomial<M>(sine_terms, z, sine);
#pragma GCC unroll 8
  for (std::size_t j = 0; j < M; ++j) sine[j] = sine[j] * x[j];
  polynomial<M>(cosine_terms, z, cosine);
}

/// sin and cos of any x up to 1e5: turned back by multiples of π/2.
HWY_INLINE void sine_cosine(Pack x, Pack& sine, Pack& cosine) {
  const hn::RebindToUnsigned<Tag> bits_tag;
  const Pack magic = all(6755399441055744.0);  // 1.5·2⁵²: the quadrant lands in the lowest bits
  const Pack turned = plus(magic, x, all(0.63661977236758134308));
  const auto quadrant = hn::BitCast(bits_tag, turned);
  const Pack n = turned - magic;
  const Pack rest = minus(minus(x, n, all(1.57079632673412561417e+00)), n, all(6.07710050650619224932e-11));
  Pack s, c;
  sine_cosine_near<1>(&rest, &s, &c);
  const auto one = hn::Set(bits_tag, 1);
  const Pack swap = hn::BitCast(tag, hn::Zero(bits_tag) - hn::And(quadrant, one));
  const Pack sine_sign = hn::BitCast(tag, hn::ShiftLeft<63>(hn::ShiftRight<1>(quadrant)));
  const Pack cosine_sign = hn::BitCast(tag, hn::ShiftLeft<63>(hn::ShiftRight<1>(quadrant + one)));
  sine = hn::Xor(hn::Or(hn::And(swap, c), hn::AndNot(swap, s)), sine_sign);
  cosine = hn::Xor(hn::Or(hn::And(swap, s), hn::AndNot(swap, c)), cosine_sign);
}

/// The platform's frame, the same in all lanes ...
struct SameFrame {
  const RodPlatform& frame;
  HWY_INLINE Pack rotation(int k) const { return all(frame.rotation[k]); }
  HWY_INLINE Pack position(int k) const { return all(frame.position[k]); }
};

/// ... or one a lane.
struct LaneFrame {
  Pack turn[9], place[3];
  HWY_INLINE Pack rotation(int k) const { return turn[k]; }
  HWY_INLINE Pack position(int k) const { return place[k]; }
};

/// Where the platform holds the tips: arm, lateral direction (its sign kept), lateral and axial distance.
template <class Rods, class Frame>
HWY_INLINE void place(Rods& rods, int i, const Frame& at) {
  const Pack3 b = load3(rods.platform_point, i), t = load3(rods.tangent, i), a = load3(rods.base, i);
  const Pack3 arm = {plus(plus(at.rotation(0) * b.x, at.rotation(1), b.y), at.rotation(2), b.z),
                     plus(plus(at.rotation(3) * b.x, at.rotation(4), b.y), at.rotation(5), b.z),
                     plus(plus(at.rotation(6) * b.x, at.rotation(7), b.y), at.rotation(8), b.z)};
  const Pack3 tip = {at.position(0) + arm.x - a.x, at.position(1) + arm.y - a.y,
                     at.position(2) + arm.z - a.z};
  const Pack w = dot(t, tip);
  const Pack3 aside = plus(tip, t, hn::Neg(w));
  const Pack d = hn::CopySignToAbs(hn::Sqrt(dot(aside, aside)), dot(aside, load3(rods.lateral, i)));
  store3(arm, rods.arm, i);
  store3(scaled(aside, all(1) / d), rods.lateral, i);
  store(d, rods.tip_d + i);
  store(w, rods.tip_w + i);
}

/// Weighted sines and cosines at the nodes.
template <class Rods>
HWY_INLINE void bend(Rods& rods, int i) {
  constexpr int N = Rods::nodes;
  const auto& basis = GalerkinBasis<Rods::size>::get();
  Pack theta[Rods::size], largest = all(0);
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) {
    theta[j] = load(rods.theta[j] + i);
    largest = hn::Max(largest, hn::Abs(theta[j]));
  }
  const bool is_near = hn::AllTrue(tag, largest < all(2.5));
  constexpr std::size_t block = N % 5 == 0 ? 5 : 6;
  static_assert(N % block == 0);
#pragma GCC unroll 4
  for (std::size_t j = 0; j < Rods::size; j += block) {
    Pack s[block], c[block];
    if (is_near)
      sine_cosine_near<block>(theta + j, s, c);
    else
      for (std::size_t k = 0; k < block; ++k) sine_cosine(theta[j + k], s[k], c[k]);
#pragma GCC unroll 8
    for (std::size_t k = 0; k < block; ++k) {
      const Pack weight = all(basis.weight[j + k]);
      store(s[k] * weight, rods.sine[j + k] + i);
      store(c[k] * weight, rods.cosine[j + k] + i);
    }
  }
}

/// The same after the angles changed: turned by the addition theorems where all of them changed by less than
/// 0.07, to 2e-16.
template <class Rods>
HWY_INLINE void bend_on(Rods& rods, int i, const Pack* change) {
  constexpr int N = Rods::nodes;
  Pack largest[2] = {all(0), all(0)};
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) largest[j % 2] = hn::Max(largest[j % 2], hn::Abs(change[j]));
  if (!hn::AllTrue(tag, hn::Max(largest[0], largest[1]) < all(0.07))) return bend(rods, i);
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) {
    const Pack x = change[j], z = x * x, s = load(rods.sine[j] + i), c = load(rods.cosine[j] + i);
    const Pack sine = x * plus(all(1), z, plus(all(-1.0 / 6), z, plus(all(1.0 / 120), z, all(-1.0 / 5040))));
    const Pack less =
        z * plus(all(-0.5), z, plus(all(1.0 / 24), z, plus(all(-1.0 / 720), z, all(1.0 / 40320))));
    store(plus(plus(s, s, less), c, sine), rods.sine[j] + i);
    store(minus(plus(c, c, less), s, sine), rods.cosine[j] + i);
  }
}

/// Bθ.
template <class Rods>
HWY_INLINE void bent_anew(Rods& rods, int i) {
  constexpr int N = Rods::nodes;
  const auto& basis = GalerkinBasis<Rods::size>::get();
  Pack sum[Rods::size];
  for (int j = 0; j < N; ++j) sum[j] = all(0);
  for (int k = 0; k < N; ++k) {
    const Pack theta = load(rods.theta[k] + i);
#pragma GCC unroll 10
    for (int j = 0; j < N; ++j) sum[j] = plus(sum[j], all(basis.bending[k][j]), theta);
  }
  for (int j = 0; j < N; ++j) store(sum[j], rods.bent[j] + i);
}

/// Gaps of the rods' own equations and of their tips; the largest of each lane, with any NaN kept.
template <class Rods>
HWY_INLINE Pack measure(Rods& rods, int i, bool from_scratch) {
  constexpr int N = Rods::nodes;
  if (from_scratch) {
    bend(rods, i);
    bent_anew(rods, i);
  }
  const Pack length = load(rods.length + i), factor = length * length * load(rods.flexibility + i);
  store(factor, rods.load + i);
  const Pack fd = factor * load(rods.force_d + i), fw = factor * load(rods.force_w + i);
  // sums in two parts, which do not wait for each other
  Pack d[2] = {all(0), all(0)}, w[2] = {all(0), all(0)}, largest[2] = {all(0), all(0)};
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) {
    const Pack sine = load(rods.sine[j] + i), cosine = load(rods.cosine[j] + i);
    const Pack gap = plus(minus(load(rods.bent[j] + i), fd, cosine), fw, sine);
    store(gap, rods.gap[j] + i);
    largest[j % 2] = hn::Max(largest[j % 2], hn::Abs(gap));
    d[j % 2] = d[j % 2] + sine;
    w[j % 2] = w[j % 2] + cosine;
  }
  const Pack gap_d = plus(hn::Neg(load(rods.tip_d + i)), length, d[0] + d[1]);
  const Pack gap_w = plus(hn::Neg(load(rods.tip_w + i)), length, w[0] + w[1]);
  store(gap_d, rods.gap_d + i);
  store(gap_w, rods.gap_w + i);
  // a maximum may hide a NaN, a sum does not: that of an angle is in the tip's gaps
  const Pack nothing = (fd + fw + gap_d + gap_w) * all(0);
  return hn::Max(hn::Max(largest[0], largest[1]), hn::Max(hn::Abs(gap_d), hn::Abs(gap_w)) / length) + nothing;
}

template <class Rods>
HWY_INLINE Pack3 force(const Rods& rods, int i) {
  return plus(scaled(load3(rods.lateral, i), load(rods.force_d + i)), load3(rods.tangent, i),
              load(rods.force_w + i));
}

/// Errors of rods, and the unit in which the balance of their platform counts beside them: that of the
/// stiffest, as the rounding of its force alone may exceed 1e-12 of a slack one's. A maximum may hide a NaN,
/// a sum does not.
struct Errors {
  Pack worst, sum, per_force, per_moment;
  HWY_INLINE Errors() : worst(all(0)), sum(all(0)), per_force(all(1e300)), per_moment(all(1e300)) {}
  HWY_INLINE void add(Pack error) {
    worst = hn::Max(worst, error);
    sum = sum + error;
  }
  template <class Rods>
  HWY_INLINE void add(Rods& rods, int i, bool from_scratch) {
    add(measure(rods, i, from_scratch));
    per_force = hn::Min(per_force, load(rods.load + i));
    per_moment = hn::Min(per_moment, load(rods.length + i) * load(rods.flexibility + i));
  }
};

template <class Rods>
void evaluate(std::span<Rods> groups, const RodPlatform& platform, bool from_scratch, RodSums& sums) {
  Wrench wrench;
  Errors errors;
  for (Rods& rods : groups)
    for (int i = 0; i < rod_lanes; i += static_cast<int>(hn::Lanes(tag))) {
      place(rods, i, SameFrame{platform});
      errors.add(rods, i, from_scratch);
      wrench.add(load3(rods.arm, i), force(rods, i), load(rods.active + i));
    }
  wrench.total(sums.wrench, errors.sum * all(0));
  sums.rod_error = hn::GetLane(hn::MaxOfLanes(tag, errors.worst)) + sums.wrench[6];
  const Pack per_force = hn::MinOfLanes(tag, errors.per_force),
             per_moment = hn::MinOfLanes(tag, errors.per_moment);
  for (int i = 0; i < 8; i += static_cast<int>(hn::Lanes(tag))) {
    const Pack missing = hn::Abs(load(platform.wrench + i) - load(sums.wrench + i));
    errors.add(missing * hn::IfThenElse(hn::Iota(tag, i) < all(3), per_force, per_moment));
  }
  sums.error = hn::GetLane(hn::MaxOfLanes(tag, errors.worst)) + sum(errors.sum * all(0));
}

/// What was stored is loaded again: the compiler would else keep all of a factorisation in registers that no
/// machine has, and spill every one of them beside storing it.
HWY_INLINE void forget() { asm volatile("" ::: "memory"); }

/// H = B + diag(L²/EI (Fd s + Fw c)) = LDLᵀ without pivoting, and its solutions for c and −s. Column by
/// column; what is left of a row is times its pivot until the row's own turn.
template <class Rods>
HWY_INLINE void factor(Rods& rods, int i) {
  constexpr int N = Rods::nodes;
  const auto& basis = GalerkinBasis<Rods::size>::get();
  const auto lower = [&](int row, int column) { return rods.lower[row * (row - 1) / 2 + column] + i; };
  const Pack fd = load(rods.load + i) * load(rods.force_d + i),
             fw = load(rods.load + i) * load(rods.force_w + i);
  Pack last = all(0);  // reciprocal of the pivot before, for which everything waits
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) {
    Pack by_d = load(rods.cosine[j] + i), by_w = hn::Neg(load(rods.sine[j] + i));
    store(by_d, rods.cosine_kept[j] + i);
    store(hn::Neg(by_w), rods.sine_kept[j] + i);
    const Pack load_stiffness = minus(fw * by_d, fd, by_w);
    store(load_stiffness, rods.stiffening[j] + i);
    Pack pivot = all(basis.bending[j][j]) + load_stiffness, row[Rods::size];
#pragma GCC unroll 10
    for (int k = 0; k < j; ++k) {
      const Pack raw = load(lower(j, k));
      row[k] = raw * (k == j - 1 ? last : load(rods.pivot[k] + i));
      pivot = minus(pivot, raw, row[k]);
      by_d = minus(by_d, row[k], load(rods.by_d[k] + i));
      by_w = minus(by_w, row[k], load(rods.by_w[k] + i));
      store(row[k], lower(j, k));
    }
    last = all(1) / pivot;
    store(last, rods.pivot[j] + i);
    store(by_d, rods.by_d[j] + i);
    store(by_w, rods.by_w[j] + i);
#pragma GCC unroll 10
    for (int m = j + 1; m < N; ++m) {
      Pack raw = all(basis.bending[m][j]);
#pragma GCC unroll 10
      for (int k = 0; k < j; ++k) raw = minus(raw, load(lower(m, k)), row[k]);
      store(raw, lower(m, j));
    }
    forget();
  }
  Pack by_d[Rods::size], by_w[Rods::size], dd[2] = {all(0), all(0)}, dw[2] = {all(0), all(0)},
                                           ww[2] = {all(0), all(0)};
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) {
    const Pack inverse = load(rods.pivot[j] + i), d = load(rods.by_d[j] + i), w = load(rods.by_w[j] + i);
    by_d[j] = d * inverse;
    by_w[j] = w * inverse;
    dd[j % 2] = plus(dd[j % 2], d, by_d[j]);
    dw[j % 2] = plus(dw[j % 2], d, by_w[j]);
    ww[j % 2] = plus(ww[j % 2], w, by_w[j]);
  }
#pragma GCC unroll 10
  for (int j = N - 1; j >= 0; --j) {
#pragma GCC unroll 10
    for (int k = N - 1; k > j; --k) {  // the newest last: the others are known by then
      by_d[j] = minus(by_d[j], load(lower(k, j)), by_d[k]);
      by_w[j] = minus(by_w[j], load(lower(k, j)), by_w[k]);
    }
    store(by_d[j], rods.by_d[j] + i);
    store(by_w[j], rods.by_w[j] + i);
  }
  store(dd[0] + dd[1], rods.soft_dd + i);
  store(dw[0] + dw[1], rods.soft_dw + i);
  store(ww[0] + ww[1], rods.soft_ww + i);
}

/// The tip's stiffness in the plane, and the force per length fed.
template <class Rods>
HWY_INLINE void stiffen(Rods& rods, int i) {
  const Pack dd = load(rods.soft_dd + i), dw = load(rods.soft_dw + i), ww = load(rods.soft_ww + i);
  const Pack length = load(rods.length + i), loading = load(rods.load + i);
  const Pack scale = all(1) / (minus(dd * ww, dw, dw) * loading * length);
  const Pack k_dd = ww * scale, k_dw = hn::Neg(dw * scale), k_ww = dd * scale;
  store(k_dd, rods.stiff_dd + i);
  store(k_dw, rods.stiff_dw + i);
  store(k_ww, rods.stiff_ww + i);
  // a longer rod: its tip moves by its own scale, and as if its forces grew by 2/L of themselves
  const Pack fd = all(2) * loading * load(rods.force_d + i), fw = all(2) * loading * load(rods.force_w + i);
  const Pack ahead_d = plus(plus(load(rods.tip_d + i) / length, fd, dd), fw, dw);
  const Pack ahead_w = plus(plus(load(rods.tip_w + i) / length, fd, dw), fw, ww);
  store(hn::Neg(plus(k_dd * ahead_d, k_dw, ahead_w)), rods.feed_d + i);
  store(hn::Neg(plus(k_dw * ahead_d, k_ww, ahead_w)), rods.feed_w + i);
}

/// Forces that close the gaps while the platform rests; their sum with the present ones.
template <class Rods>
HWY_INLINE void close_gaps(Rods& rods, int i, Wrench& wrench) {
  constexpr int N = Rods::nodes;
  Pack by_d[2] = {all(0), all(0)}, by_w[2] = {all(0), all(0)};
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) {
    const Pack gap = load(rods.gap[j] + i);
    by_d[j % 2] = plus(by_d[j % 2], gap, load(rods.by_d[j] + i));
    by_w[j % 2] = plus(by_w[j % 2], gap, load(rods.by_w[j] + i));
  }
  const Pack length = load(rods.length + i);
  const Pack d = plus(hn::Neg(load(rods.gap_d + i)), length, by_d[0] + by_d[1]);
  const Pack w = plus(hn::Neg(load(rods.gap_w + i)), length, by_w[0] + by_w[1]);
  const Pack k_dw = load(rods.stiff_dw + i);
  const Pack fix_d = plus(load(rods.stiff_dd + i) * d, k_dw, w);
  const Pack fix_w = plus(k_dw * d, load(rods.stiff_ww + i), w);
  store(fix_d, rods.fix_d + i);
  store(fix_w, rods.fix_w + i);
  const Pack3 n = plus(scaled(load3(rods.lateral, i), load(rods.force_d + i) + fix_d), load3(rods.tangent, i),
                       load(rods.force_w + i) + fix_w);
  wrench.add(load3(rods.arm, i), n, load(rods.active + i));
}

/// 3×3 stiffness of the tips in base axes, symmetric: xx, xy, xz, yy, yz, zz.
struct TipStiffness {
  Pack xx, xy, xz, yy, yz, zz;
};
template <class Rods>
HWY_INLINE TipStiffness tip_stiffness(const Rods& rods, int i) {
  const Pack3 h = load3(rods.lateral, i), t = load3(rods.tangent, i), out = cross(t, h);
  const Pack active = load(rods.active + i);
  const Pack dd = load(rods.stiff_dd + i) * active, dw = load(rods.stiff_dw + i) * active,
             ww = load(rods.stiff_ww + i) * active;
  const Pack turn = load(rods.force_d + i) * active / load(rods.tip_d + i);
  const Pack3 by_h = plus(scaled(h, dd), t, dw), by_t = plus(scaled(h, dw), t, ww),
              by_out = scaled(out, turn);
  return {plus(plus(by_h.x * h.x, by_t.x, t.x), by_out.x, out.x),
          plus(plus(by_h.x * h.y, by_t.x, t.y), by_out.x, out.y),
          plus(plus(by_h.x * h.z, by_t.x, t.z), by_out.x, out.z),
          plus(plus(by_h.y * h.y, by_t.y, t.y), by_out.y, out.y),
          plus(plus(by_h.y * h.z, by_t.y, t.z), by_out.y, out.z),
          plus(plus(by_h.z * h.z, by_t.z, t.z), by_out.z, out.z)};
}

/// Sums of the platform's stiffness: δ(Σ n) and δ(Σ b × n) by (δp, δφ), where δr = δp + δφ × b.
struct Stiffness {
  Pack force[6];   // ∂n/∂p, symmetric
  Pack couple[9];  // ∂n/∂φ, rows first; its transpose is ∂(b × n)/∂p
  Pack moment[9];  // ∂(b × n)/∂φ
  HWY_INLINE Stiffness() {
    for (Pack& p : force) p = all(0);
    for (Pack& p : couple) p = all(0);
    for (Pack& p : moment) p = all(0);
  }
  HWY_INLINE void add(const TipStiffness& s, const Pack3& b, const Pack3& n) {
    const Pack k[6] = {s.xx, s.xy, s.xz, s.yy, s.yz, s.zz};
    for (int j = 0; j < 6; ++j) force[j] = force[j] + k[j];
    // rows of S times −[b]
    const Pack3 row[3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
    Pack3 turned[3];
    for (int j = 0; j < 3; ++j) {
      turned[j] = cross(b, row[j]);
      couple[3 * j] = couple[3 * j] + turned[j].x;
      couple[3 * j + 1] = couple[3 * j + 1] + turned[j].y;
      couple[3 * j + 2] = couple[3 * j + 2] + turned[j].z;
    }
    // b × (S (δφ × b)) + (δφ × b) × n, the last being b (δφ·n) − δφ (b·n)
    const Pack across = dot(b, n);
    const Pack3 column[3] = {{turned[0].x, turned[1].x, turned[2].x},
                             {turned[0].y, turned[1].y, turned[2].y},
                             {turned[0].z, turned[1].z, turned[2].z}};
    const Pack own[3] = {n.x, n.y, n.z};
    for (int j = 0; j < 3; ++j) {
      const Pack3 m = plus(cross(b, column[j]), b, own[j]);
      moment[j] = moment[j] + (j == 0 ? m.x - across : m.x);
      moment[3 + j] = moment[3 + j] + (j == 1 ? m.y - across : m.y);
      moment[6 + j] = moment[6 + j] + (j == 2 ? m.z - across : m.z);
    }
  }
  static constexpr int symmetric[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  HWY_INLINE void matrix(Pack* out) const {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        out[6 * r + c] = force[symmetric[3 * r + c]];
        out[6 * r + 3 + c] = out[6 * (3 + c) + r] = couple[3 * r + c];
        out[6 * (3 + r) + 3 + c] = moment[3 * r + c];
      }
  }
  HWY_INLINE void total(double* out) const {
    Pack packs[24];
    for (int k = 0; k < 6; ++k) packs[k] = force[k];
    for (int k = 0; k < 9; ++k) packs[6 + k] = couple[k];
    for (int k = 0; k < 9; ++k) packs[15 + k] = moment[k];
    double sums[24];
    for (int k = 0; k < 24; k += 8) totals(packs + k, sums + k);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        out[6 * r + c] = sums[symmetric[3 * r + c]];
        out[6 * r + 3 + c] = out[6 * (3 + c) + r] = sums[6 + 3 * r + c];
        out[6 * (3 + r) + 3 + c] = sums[15 + 3 * r + c];
      }
  }
};

/// Inverse of a 6×6 matrix in place by Gauss and Jordan, its rows padded to eight. Without pivoting, as what
/// holds by itself needs none: false where a pivot says that four digits were lost. (A product with an
/// inverse may lose them twice, which solving with factors does not.)
HWY_INLINE bool invert(double (&a)[6][8]) {
  double diagonal[6];
  for (int k = 0; k < 6; ++k) diagonal[k] = a[k][k];
  bool is_safe = true;
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    const double pivot = a[k][k], kept = pivot / diagonal[k];
    is_safe = is_safe && kept * kept > 1e-8 && kept * kept < 1e8;
    const Pack inverse = all(1 / pivot);
#pragma GCC unroll 4
    for (int i = 0; i < 6; i += static_cast<int>(hn::Lanes(tag))) {
      const auto own = hn::Iota(tag, i) == all(k);
      const Pack row = hn::IfThenElse(own, all(1), load(a[k] + i)) * inverse;
      store(row, a[k] + i);
    }
#pragma GCC unroll 6
    for (int r = 0; r < 6; ++r) {
      if (r == k) continue;
      const Pack factor = all(a[r][k]);
#pragma GCC unroll 4
      for (int i = 0; i < 6; i += static_cast<int>(hn::Lanes(tag))) {
        const auto own = hn::Iota(tag, i) == all(k);
        store(minus(hn::IfThenZeroElse(own, load(a[r] + i)), factor, load(a[k] + i)), a[r] + i);
      }
    }
  }
  return is_safe;
}

template <class Rods>
bool linearise(std::span<Rods> groups, RodPlatform& platform, RodSums& sums) {
  Stiffness stiffness;
  Wrench wrench;
  for (Rods& rods : groups)
    for (int i = 0; i < rod_lanes; i += static_cast<int>(hn::Lanes(tag))) {
      factor(rods, i);
      stiffen(rods, i);
      stiffness.add(tip_stiffness(rods, i), load3(rods.arm, i),
                    scaled(force(rods, i), load(rods.active + i)));
      close_gaps(rods, i, wrench);
    }
  stiffness.total(sums.stiffness);
  wrench.total(sums.wrench);
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 8; ++c) platform.inverse[r][c] = c < 6 ? sums.stiffness[6 * c + r] : 0;
  return invert(platform.inverse);  // the rows of the transposed are the columns
}

template <class Rods>
void step(std::span<Rods> groups, const RodPlatform& platform, bool fresh, RodSums& sums) {
  if (!fresh) {
    Wrench wrench;
    for (Rods& rods : groups)
      for (int i = 0; i < rod_lanes; i += static_cast<int>(hn::Lanes(tag))) close_gaps(rods, i, wrench);
    wrench.total(sums.wrench);
  }
  Pack missing[6];
  for (int k = 0; k < 6; ++k) missing[k] = all(platform.wrench[k] - sums.wrench[k]);
  for (int i = 0; i < 8; i += static_cast<int>(hn::Lanes(tag))) {
    const auto& columns = platform.inverse;
    const Pack shift = plus(plus(load(columns[0] + i) * missing[0], load(columns[1] + i), missing[1]),
                            load(columns[2] + i), missing[2]);
    const Pack turn = plus(plus(load(columns[3] + i) * missing[3], load(columns[4] + i), missing[4]),
                           load(columns[5] + i), missing[5]);
    store(shift + turn, sums.twist + i);
  }
}

/// H⁻¹x by the kept factors, in place.
template <class Rods>
HWY_INLINE void solve(const Rods& rods, int i, Pack* x) {
  constexpr int N = Rods::nodes;
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) {
#pragma GCC unroll 10
    for (int k = 0; k < j; ++k) x[j] = minus(x[j], load(rods.lower[j * (j - 1) / 2 + k] + i), x[k]);
  }
#pragma GCC unroll 10
  for (int j = N - 1; j >= 0; --j) {
    x[j] = x[j] * load(rods.pivot[j] + i);
#pragma GCC unroll 10
    for (int k = N - 1; k > j; --k)  // the newest last
      x[j] = minus(x[j], load(rods.lower[k * (k - 1) / 2 + j] + i), x[k]);
  }
}

/// The state of the rods after the platform's step, with lengths fed or not.
template <class Rods>
HWY_INLINE void carry_on(Rods& rods, int i, const Pack3& shift, const Pack3& turn, const double* fed) {
  constexpr int N = Rods::nodes;
  const Pack3 moved = plus(cross(turn, load3(rods.arm, i)), shift, all(1));
  const Pack d = dot(load3(rods.lateral, i), moved), w = dot(load3(rods.tangent, i), moved);
  const Pack k_dw = load(rods.stiff_dw + i);
  Pack fd = plus(plus(load(rods.fix_d + i), load(rods.stiff_dd + i), d), k_dw, w);
  Pack fw = plus(plus(load(rods.fix_w + i), k_dw, d), load(rods.stiff_ww + i), w);
  const Pack loading = load(rods.load + i), old_d = load(rods.force_d + i), old_w = load(rods.force_w + i);
  Pack by_d = loading * fd, by_w = loading * fw;
  if (fed != nullptr) {
    const Pack more = load(fed + i), length = load(rods.length + i);
    const Pack own_d = more * load(rods.feed_d + i), own_w = more * load(rods.feed_w + i);
    const Pack growth = all(2) * more / length;
    fd = fd + own_d;
    fw = fw + own_w;
    by_d = plus(by_d, loading, plus(own_d, growth, old_d));
    by_w = plus(by_w, loading, plus(own_w, growth, old_w));
    store(length + more, rods.length + i);
  }
  store(old_d + fd, rods.force_d + i);
  store(old_w + fw, rods.force_w + i);
  Pack driven[Rods::size], change[Rods::size];
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j)
    driven[j] = change[j] = minus(load(rods.cosine_kept[j] + i) * by_d, load(rods.sine_kept[j] + i), by_w) -
                            load(rods.gap[j] + i);
  solve(rods, i, change);
#pragma GCC unroll 10
  for (int j = 0; j < N; ++j) {
    store(load(rods.theta[j] + i) + change[j], rods.theta[j] + i);
    // what drives is H δθ, and H is B and a diagonal
    store(load(rods.bent[j] + i) + minus(driven[j], load(rods.stiffening[j] + i), change[j]),
          rods.bent[j] + i);
  }
  bend_on(rods, i, change);
}

template <class Rods>
void apply(std::span<Rods> groups, const double* step, const RodFeed* fed) {
  const Pack3 shift = {all(step[0]), all(step[1]), all(step[2])},
              turn = {all(step[3]), all(step[4]), all(step[5])};
  for (Rods& rods : groups)
    for (int i = 0; i < rod_lanes; i += static_cast<int>(hn::Lanes(tag)))
      carry_on(rods, i, shift, turn, fed == nullptr ? nullptr : fed[&rods - groups.data()].length);
}

/// Squares of the two highest Legendre coefficients of θ′.
template <class Rods>
HWY_INLINE Pack truncation(const Rods& rods, int i) {
  const auto& basis = GalerkinBasis<Rods::size>::get();
  Pack last[2] = {all(0), all(0)}, before[2] = {all(0), all(0)};
#pragma GCC unroll 10
  for (std::size_t j = 0; j < Rods::size; ++j) {
    const Pack theta = load(rods.theta[j] + i);
    last[j % 2] = plus(last[j % 2], all(basis.last[j]), theta);
    before[j % 2] = plus(before[j % 2], all(basis.before_last[j]), theta);
  }
  const Pack a = last[0] + last[1], b = before[0] + before[1];
  return plus(a * a, b, b);
}

/// The largest of each lane.
template <class Rods>
void truncation(std::span<const Rods> groups, double* largest) {
  for (int i = 0; i < rod_lanes; i += static_cast<int>(hn::Lanes(tag))) {
    Pack worst = all(0);
    for (const Rods& rods : groups) worst = hn::Max(worst, truncation(rods, i));
    store(worst, largest + i);
  }
}

/// @name The same with a pose in each lane
/// @{

HWY_INLINE LaneFrame frame_of(const PoseLanes& poses, int i) {
  const Pack w = load(poses.quaternion[0] + i), x = load(poses.quaternion[1] + i),
             y = load(poses.quaternion[2] + i), z = load(poses.quaternion[3] + i), two = all(2), one = all(1);
  return {{minus(one, two, plus(y * y, z, z)), two * minus(x * y, w, z), two * plus(x * z, w, y),
           two * plus(x * y, w, z), minus(one, two, plus(x * x, z, z)), two * minus(y * z, w, x),
           two * minus(x * z, w, y), two * plus(y * z, w, x), minus(one, two, plus(x * x, y, y))},
          {load(poses.position[0] + i), load(poses.position[1] + i), load(poses.position[2] + i)}};
}

/// What the world's wrench is more than these forces.
HWY_INLINE Pack missing(const Wrench& wrench, const PoseLanes& poses, int i, int k) {
  const Pack sums[6] = {wrench.force.x,  wrench.force.y,  wrench.force.z,
                        wrench.moment.x, wrench.moment.y, wrench.moment.z};
  return load(poses.wrench[k] + i) - sums[k];
}

/// LU factors of the platforms' stiffness, without pivoting: it is nearly symmetric and, where it holds by
/// itself, positive.
HWY_INLINE void factor(const Stiffness& stiffness, PoseLanes& poses, int i) {
  Pack a[36];
  stiffness.matrix(a);
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    a[7 * k] = all(1) / a[7 * k];
#pragma GCC unroll 6
    for (int r = k + 1; r < 6; ++r) {
      a[6 * r + k] = a[6 * r + k] * a[7 * k];
#pragma GCC unroll 6
      for (int c = k + 1; c < 6; ++c) a[6 * r + c] = minus(a[6 * r + c], a[6 * r + k], a[6 * k + c]);
    }
  }
  for (int k = 0; k < 36; ++k) store(a[k], poses.factors[k] + i);
}

/// Newton's step of the platforms.
HWY_INLINE void move_platforms(PoseLanes& poses, int i) {
  Pack x[6];
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    x[k] = load(poses.missing[k] + i);
#pragma GCC unroll 6
    for (int c = 0; c < k; ++c) x[k] = minus(x[k], load(poses.factors[6 * k + c] + i), x[c]);
  }
#pragma GCC unroll 6
  for (int k = 5; k >= 0; --k) {
#pragma GCC unroll 6
    for (int c = 5; c > k; --c) x[k] = minus(x[k], load(poses.factors[6 * k + c] + i), x[c]);
    x[k] = x[k] * load(poses.factors[7 * k] + i);
  }
  for (int k = 0; k < 6; ++k) store(x[k], poses.twist[k] + i);
  for (int k = 0; k < 3; ++k) store(load(poses.position[k] + i) + x[k], poses.position[k] + i);
  const Pack half = all(0.5), a = half * x[3], b = half * x[4], c = half * x[5];
  const Pack w = load(poses.quaternion[0] + i), p = load(poses.quaternion[1] + i),
             q = load(poses.quaternion[2] + i), r = load(poses.quaternion[3] + i);
  const Pack nw = minus(minus(minus(w, a, p), b, q), c, r), np = plus(minus(plus(p, a, w), c, q), b, r),
             nq = plus(minus(plus(q, b, w), a, r), c, p), nr = plus(minus(plus(r, c, w), b, p), a, q);
  const Pack scale = all(1) / hn::Sqrt(plus(plus(plus(nw * nw, np, np), nq, nq), nr, nr));
  store(nw * scale, poses.quaternion[0] + i);
  store(np * scale, poses.quaternion[1] + i);
  store(nq * scale, poses.quaternion[2] + i);
  store(nr * scale, poses.quaternion[3] + i);
}

HWY_INLINE Pack one_where(hn::Mask<Tag> mask) { return hn::IfThenElseZero(mask, all(1)); }
HWY_INLINE Pack one_if_negative(Pack x) { return one_where(x < all(0)); }

/// As ElasticaSystem::unstable_with_tip_held in the plane.
HWY_INLINE Pack unstable_in_plane(const CoarseRods& rods, int i) {
  Pack count = all(0);
  for (const RodLane& pivot : rods.pivot) count = count + one_if_negative(load(pivot + i));
  const Pack dd = load(rods.soft_dd + i), dw = load(rods.soft_dw + i),
             determinant = minus(dd * load(rods.soft_ww + i), dw, dw);
  return count - hn::IfThenElse(determinant < all(0), all(1), all(2) * one_if_negative(dd));
}

/// ... and out of it, see docs/theory/elastica.md: LDLᵀ of the form, and of its inverse on the constraint.
HWY_INLINE Pack unstable_aside(const CoarseRods& rods, int i) {
  constexpr int N = CoarseRods::nodes;
  const auto& basis = GalerkinBasis<coarse_nodes>::get();
  const Pack fd = load(rods.load + i) * load(rods.force_d + i),
             fw = load(rods.load + i) * load(rods.force_w + i);
  Pack a[N][N], x[N], negative = all(0), soft = all(0);
  for (int j = 0; j < N; ++j) {
    Pack slope = all(0);
    for (int k = 0; k < N; ++k) slope = plus(slope, all(basis.slope[j][k]), load(rods.theta[k] + i));
    Pack pivot =
        minus(plus(plus(all(basis.bending[j][j]), fd, load(rods.sine[j] + i)), fw, load(rods.cosine[j] + i)),
              all(basis.weight[j]) * slope, slope);
    x[j] = all(basis.weight[j]);
    for (int k = 0; k < j; ++k) {
      const Pack row = a[j][k] * a[k][k];  // the diagonal holds reciprocals
      pivot = minus(pivot, row, a[j][k]);
      x[j] = minus(x[j], row, x[k]);
      a[j][k] = row;
    }
    negative = negative + one_if_negative(pivot);
    a[j][j] = all(1) / pivot;
    soft = plus(soft, x[j] * x[j], a[j][j]);
    for (int m = j + 1; m < N; ++m) {
      a[m][j] = all(basis.bending[m][j]);
      for (int k = 0; k < j; ++k) a[m][j] = minus(a[m][j], a[m][k], a[j][k]);
    }
  }
  return negative - one_if_negative(soft);
}

/// Negative directions of the platform's stiffness, whose symmetric part is what a small motion works
/// against.
HWY_INLINE Pack negative_directions(const Stiffness& stiffness) {
  Pack a[36], count = all(0);
  stiffness.matrix(a);
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < r; ++c) a[6 * r + c] = all(0.5) * (a[6 * r + c] + a[6 * c + r]);
  for (int k = 0; k < 6; ++k) {
    count = count + one_if_negative(a[7 * k]);
    const Pack inverse = all(1) / a[7 * k];
    for (int r = k + 1; r < 6; ++r)
      for (int c = k + 1; c <= r; ++c)
        a[6 * r + c] = minus(a[6 * r + c], a[6 * r + k] * inverse, a[6 * c + k]);
  }
  return count;
}

/// What all rods of the poses in some lanes add up to.
struct PoseSums {
  Wrench wrench, closing;  // of the forces as they are, and of those that close the gaps
  Stiffness stiffness;
  Errors errors;
  Pack unstable = all(0);
  HWY_INLINE PoseSums() {}
};

/// One sweep over the rods does all there is to do, as they do not fit the nearest cache.
void AdvancePoses(std::span<CoarseRods> rods, const PoseStep& step, PoseLanes& poses) {
  constexpr int lanes = static_cast<int>(hn::MaxLanes(tag)), packs = rod_lanes / lanes;
  PoseSums sums[packs];
  LaneFrame frames[packs];
  for (int p = 0; p < packs; ++p) {
    if (step.moves) move_platforms(poses, p * lanes);
    frames[p] = frame_of(poses, p * lanes);
  }
  for (CoarseRods& rod : rods)
    for (int p = 0; p < packs; ++p) {
      const int i = p * lanes;
      PoseSums& sum = sums[p];
      if (step.moves) {
        const auto& twist = poses.twist;
        carry_on(rod, i, {load(twist[0] + i), load(twist[1] + i), load(twist[2] + i)},
                 {load(twist[3] + i), load(twist[4] + i), load(twist[5] + i)}, nullptr);
      }
      place(rod, i, frames[p]);
      sum.errors.add(rod, i, step.from_scratch);
      sum.wrench.add(load3(rod.arm, i), force(rod, i), all(1));
      if (step.renews) {
        factor(rod, i);
        stiffen(rod, i);
        sum.stiffness.add(tip_stiffness(rod, i), load3(rod.arm, i), force(rod, i));
      }
      if (step.counts_unstable)
        sum.unstable = sum.unstable + unstable_in_plane(rod, i) + unstable_aside(rod, i);
      close_gaps(rod, i, sum.closing);
    }
  for (int p = 0; p < packs; ++p) {
    const int i = p * lanes;
    PoseSums& sum = sums[p];
    Errors& errors = sum.errors;
    for (int k = 0; k < 6; ++k) {
      errors.add(hn::Abs(missing(sum.wrench, poses, i, k)) * (k < 3 ? errors.per_force : errors.per_moment));
      store(missing(sum.closing, poses, i, k), poses.missing[k] + i);
    }
    store(errors.worst + errors.sum * all(0), poses.error + i);
    if (step.renews) factor(sum.stiffness, poses, i);
    if (step.counts_unstable) store(sum.unstable + negative_directions(sum.stiffness), poses.unstable + i);
  }
}
/// @}

void EvaluateCoarse(std::span<CoarseRods> groups, const RodPlatform& platform, bool from_scratch,
                    RodSums& sums) {
  evaluate(groups, platform, from_scratch, sums);
}
void EvaluateFine(std::span<FineRods> groups, const RodPlatform& platform, bool from_scratch, RodSums& sums) {
  evaluate(groups, platform, from_scratch, sums);
}
bool LineariseCoarse(std::span<CoarseRods> groups, RodPlatform& platform, RodSums& sums) {
  return linearise(groups, platform, sums);
}
bool LineariseFine(std::span<FineRods> groups, RodPlatform& platform, RodSums& sums) {
  return linearise(groups, platform, sums);
}
void StepCoarse(std::span<CoarseRods> groups, const RodPlatform& platform, bool fresh, RodSums& sums) {
  step(groups, platform, fresh, sums);
}
void StepFine(std::span<FineRods> groups, const RodPlatform& platform, bool fresh, RodSums& sums) {
  step(groups, platform, fresh, sums);
}
void ApplyCoarse(std::span<CoarseRods> groups, const double* step, const RodFeed* fed) {
  apply(groups, step, fed);
}
void ApplyFine(std::span<FineRods> groups, const double* step, const RodFeed* fed) {
  apply(groups, step, fed);
}
void TruncationCoarse(std::span<const CoarseRods> groups, double* largest) { truncation(groups, largest); }
void TruncationFine(std::span<const FineRods> groups, double* largest) { truncation(groups, largest); }
const char* InstructionSet() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::rod_kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1::rod_kernels {

HWY_EXPORT(EvaluateCoarse);
HWY_EXPORT(EvaluateFine);
HWY_EXPORT(LineariseCoarse);
HWY_EXPORT(LineariseFine);
HWY_EXPORT(StepCoarse);
HWY_EXPORT(StepFine);
HWY_EXPORT(ApplyCoarse);
HWY_EXPORT(ApplyFine);
HWY_EXPORT(TruncationCoarse);
HWY_EXPORT(TruncationFine);
HWY_EXPORT(AdvancePoses);
HWY_EXPORT(InstructionSet);

void evaluate(std::span<CoarseRods> groups, const RodPlatform& platform, bool from_scratch, RodSums& sums) {
  HWY_DYNAMIC_DISPATCH(EvaluateCoarse)(groups, platform, from_scratch, sums);
}
void evaluate(std::span<FineRods> groups, const RodPlatform& platform, bool from_scratch, RodSums& sums) {
  HWY_DYNAMIC_DISPATCH(EvaluateFine)(groups, platform, from_scratch, sums);
}
bool linearise(std::span<CoarseRods> groups, RodPlatform& platform, RodSums& sums) {
  return HWY_DYNAMIC_DISPATCH(LineariseCoarse)(groups, platform, sums);
}
bool linearise(std::span<FineRods> groups, RodPlatform& platform, RodSums& sums) {
  return HWY_DYNAMIC_DISPATCH(LineariseFine)(groups, platform, sums);
}
void step(std::span<CoarseRods> groups, const RodPlatform& platform, bool fresh, RodSums& sums) {
  HWY_DYNAMIC_DISPATCH(StepCoarse)(groups, platform, fresh, sums);
}
void step(std::span<FineRods> groups, const RodPlatform& platform, bool fresh, RodSums& sums) {
  HWY_DYNAMIC_DISPATCH(StepFine)(groups, platform, fresh, sums);
}
void apply(std::span<CoarseRods> groups, const double* step, const RodFeed* fed) {
  HWY_DYNAMIC_DISPATCH(ApplyCoarse)(groups, step, fed);
}
void apply(std::span<FineRods> groups, const double* step, const RodFeed* fed) {
  HWY_DYNAMIC_DISPATCH(ApplyFine)(groups, step, fed);
}
void truncation(std::span<const CoarseRods> groups, double* largest) {
  HWY_DYNAMIC_DISPATCH(TruncationCoarse)(groups, largest);
}
void truncation(std::span<const FineRods> groups, double* largest) {
  HWY_DYNAMIC_DISPATCH(TruncationFine)(groups, largest);
}
void advance(std::span<CoarseRods> rods, const PoseStep& step, PoseLanes& poses) {
  HWY_DYNAMIC_DISPATCH(AdvancePoses)(rods, step, poses);
}
const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }

}  // namespace sinew::inline v1::rod_kernels
#endif
