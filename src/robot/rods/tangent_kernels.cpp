// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "robot/rods/tangent_kernels.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "robot/rods/packs-inl.hpp"
#include "robot/rods/tangent_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::tangent_kernels {
namespace HWY_NAMESPACE {
using namespace packs::HWY_NAMESPACE;
using packs::HWY_NAMESPACE::sum;

constexpr int degree = TangentState::degree;
constexpr int pack_size = static_cast<int>(hn::MaxLanes(tag));

/// Calls `use(group, lane)` with every pack of rods.
template <class Groups, class Use>
HWY_INLINE void each_pack(Groups groups, Use&& use) {
  for (auto& rods : groups)
    for (int i = 0; i < rod_lanes; i += pack_size) use(rods, i);
}

HWY_INLINE Pack3 difference(const Pack3& a, const Pack3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Pack3 sum(const Pack3& a, const Pack3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Pack3 chosen(hn::Mask<Tag> which, const Pack3& a, const Pack3& b) {
  return {hn::IfThenElse(which, a.x, b.x), hn::IfThenElse(which, a.y, b.y), hn::IfThenElse(which, a.z, b.z)};
}
HWY_INLINE Pack3 turned(const RodPlatform& at, const Pack3& v) {
  const auto row = [&](int k) {
    return plus(plus(all(at.rotation[k]) * v.x, all(at.rotation[k + 1]), v.y), all(at.rotation[k + 2]), v.z);
  };
  return {row(0), row(3), row(6)};
}

/// A node's tangent to `to`, and its frame by the least rotation that does it: defined but for a half turn.
HWY_INLINE void turn_node(TangentRods& rods, int node, int i, const Pack3& to) {
  const Pack3 from = load3(rods.tangent[node], i), both = sum(from, to);
  const Pack scale = all(1) / (all(1) + dot(from, to));
  for (auto& axis : rods.across[node]) {
    const Pack3 e = load3(axis, i);
    store3(plus(e, both, hn::Neg(dot(e, to) * scale)), axis, i);
  }
  store3(to, rods.tangent[node], i);
}

/// A node's tangent pushed aside by d across it, to ((1 − q) t + d)/(1 + q) with q = |d|²/4: of length 1 and,
/// to second order, t + d. Its frame by the same rotation. One division serves all.
HWY_INLINE void push_node(TangentRods& rods, int node, int i, const Pack3& d) {
  const Pack3 t = load3(rods.tangent[node], i), middle = plus(t, d, all(0.5));
  const Pack q = all(0.25) * dot(d, d), inverse = all(1) / (all(1) + q);
  for (auto& axis : rods.across[node]) {
    const Pack3 e = load3(axis, i);
    store3(plus(e, middle, hn::Neg(dot(e, d) * inverse)), axis, i);
  }
  store3(plus(scaled(t, (all(1) - q) * inverse), d, inverse), rods.tangent[node], i);
}

/// A frame from t alone (Duff et al. 2017), so that what factors say does not depend on the way there.
HWY_INLINE void frame_node(TangentRods& rods, int node, int i) {
  Pack3 t = load3(rods.tangent[node], i);
  t = scaled(t, minus(all(1.5), all(0.5), dot(t, t)));  // steps round its length
  store3(t, rods.tangent[node], i);
  const Pack sign = hn::CopySign(all(1), t.z), a = all(-1) / (sign + t.z), b = t.x * t.y * a;
  store3({plus(all(1), sign * t.x * t.x, a), sign * b, hn::Neg(sign * t.x)}, rods.across[node][0], i);
  store3({b, plus(sign, t.y * t.y, a), hn::Neg(t.y)}, rods.across[node][1], i);
}

/// What the force does at a node: n there, α = 1 + β n·t, and the weights of its quadrature.
struct Load {
  Pack3 n;
  Pack along, alpha;  // n·t, α
  Pack3 h;            // α n: −∂/∂t of the load's energy
};
HWY_INLINE Load load_at(const TangentRods& rods, int i, const Pack3& t, const Pack3& tip_force,
                        const Pack3& weight, double left) {
  Load at;
  at.n = plus(tip_force, weight, load(rods.length + i) * all(left));
  at.along = dot(at.n, t);
  at.alpha = plus(all(1), load(rods.stretch + i), at.along);
  at.h = scaled(at.n, at.alpha);
  return at;
}

/// Where along the rod a node lies, and its share in an integral over [0, 1].
struct Place {
  double left, weight;  // of the length, to the tip; weight
};
HWY_INLINE Place place_of(int node, int elements) {
  const auto& basis = LobattoBasis<element_degree>::get();
  const int element = node == 0 ? 0 : (node - 1) / degree, own = node - element * degree;
  const double h = 1.0 / elements;
  double weight = basis.weight[own] * h;
  if (own == degree && element + 1 < elements) weight += basis.weight[0] * h;
  return {1 - (element + basis.node[own]) * h, weight};
}

/// Bt of all elements, into `pull`.
HWY_INLINE void bend(TangentRods& rods, int i, int elements) {
  const auto& basis = LobattoBasis<element_degree>::get();
  const Pack scale = all(elements);
  for (int c = 0; c < 3; ++c) {
    Pack carry = all(0);
    for (int e = 0; e < elements; ++e) {
      Pack t[degree + 1];
#pragma GCC unroll 9
      for (int j = 0; j <= degree; ++j) t[j] = load(rods.tangent[e * degree + j][c] + i) * scale;
#pragma GCC unroll 9
      for (int k = 0; k <= degree; ++k) {
        Pack two[2] = {k == 0 ? carry : all(0), all(0)};
#pragma GCC unroll 9
        for (int j = 0; j <= degree; ++j) two[j % 2] = plus(two[j % 2], all(basis.bending[k][j]), t[j]);
        const Pack value = two[0] + two[1];
        if (k == degree)
          carry = value;
        else
          store(value, rods.pull[e * degree + k][c] + i);
      }
    }
    store(carry, rods.pull[elements * degree][c] + i);
  }
}

/// What the frames see of the gradient.
HWY_INLINE void project(TangentRods& rods, int node, int i) {
  const Pack3 g = load3(rods.pull[node], i);
  for (int a = 0; a < 2; ++a) store(dot(load3(rods.across[node][a], i), g), rods.gap[node][a] + i);
}

/// Where the platform holds the tip, and at a clamp its tangent.
HWY_INLINE Pack3 place_tip(TangentRods& rods, int i, int tip, const RodPlatform& at) {
  const Pack3 arm = turned(at, load3(rods.platform_point, i));
  store3(arm, rods.arm, i);
  const auto clamped = load(rods.clamped + i) > all(0.5);
  turn_node(rods, tip, i,
            chosen(clamped, turned(at, load3(rods.platform_tangent, i)), load3(rods.tangent[tip], i)));
  return difference(sum({all(at.position[0]), all(at.position[1]), all(at.position[2])}, arm),
                    load3(rods.base, i));
}

/// The moment at a clamp: m = Q μ with μ = (EI/L) of the gradient across the tangent.
HWY_INLINE Pack3 moment_of(const TangentRods& rods, int i, int tip, Pack first, Pack second) {
  const Pack3 a = load3(rods.across[tip][0], i), b = load3(rods.across[tip][1], i);
  return plus(scaled(b, first), a, hn::Neg(second));
}

HWY_INLINE Pack measure(TangentRods& rods, int i, int elements, const RodPlatform& at, bool from_scratch) {
  const int tip = elements * degree;
  if (from_scratch)
    for (int node = 1; node <= tip; ++node) frame_node(rods, node, i);
  const Pack3 wanted = place_tip(rods, i, tip, at);
  bend(rods, i, elements);
  const Pack length = load(rods.length + i), factor = length * length * load(rods.flexibility + i);
  const Pack3 force = load3(rods.force, i), weight = load3(rods.weight, i);
  Pack3 reached{all(0), all(0), all(0)}, stretched = reached;
  Pack largest = all(0);
  for (int node = 0; node <= tip; ++node) {
    const Place place = place_of(node, elements);
    const Pack3 t = load3(rods.tangent[node], i);
    const Load at_node = load_at(rods, i, t, force, weight, place.left);
    const Pack share = all(place.weight);
    reached = plus(reached, t, share * at_node.alpha);
    stretched = plus(stretched, at_node.n, share);
    store3(plus(load3(rods.pull[node], i), at_node.h, hn::Neg(factor * share)), rods.pull[node], i);
    if (node == 0) continue;
    project(rods, node, i);
    if (node < tip)
      largest = hn::Max(largest,
                        hn::Max(hn::Abs(load(rods.gap[node][0] + i)), hn::Abs(load(rods.gap[node][1] + i))));
  }
  const Pack3 at_tip = scaled(plus(reached, stretched, load(rods.shear + i)), length);
  store3(at_tip, rods.tip, i);
  const Pack3 gap = difference(at_tip, wanted);
  store3(gap, rods.tip_gap, i);
  const Pack stiff = load(rods.clamped + i) / (load(rods.flexibility + i) * length);
  const Pack first = load(rods.gap[tip][0] + i), second = load(rods.gap[tip][1] + i);
  store3(moment_of(rods, i, tip, first * stiff, second * stiff), rods.moment, i);
  const Pack free = all(1) - load(rods.clamped + i);
  largest = hn::Max(largest, free * hn::Max(hn::Abs(first), hn::Abs(second)));
  const Pack off = hn::Max(hn::Max(hn::Abs(gap.x), hn::Abs(gap.y)), hn::Abs(gap.z)) / length;
  // a maximum may hide a NaN, a sum does not
  const Pack nothing = (gap.x + gap.y + gap.z + first + second + dot(force, force)) * all(0);
  return hn::Max(largest, off) + nothing;
}

/// Sums of the tips' forces and moments about the platform's point.
HWY_INLINE void add_tip(Wrench& wrench, const Pack3& arm, const Pack3& n, const Pack3& m, Pack active) {
  wrench.add(arm, n, active);
  wrench.moment = plus(wrench.moment, m, active);
}

void Evaluate(std::span<TangentRods> groups, int elements, const RodPlatform& platform, bool from_scratch,
              RodSums& sums) {
  Wrench wrench;
  Pack worst = all(0), nothing = all(0), per_force = all(1e300), per_moment = all(1e300);
  each_pack(groups, [&](TangentRods& rods, int i) {
    const Pack error = measure(rods, i, elements, platform, from_scratch);
    worst = hn::Max(worst, error);
    nothing = nothing + error * all(0);
    const Pack length = load(rods.length + i), soft = length * load(rods.flexibility + i);
    per_force = hn::Min(per_force, soft * length);
    per_moment = hn::Min(per_moment, soft);
    add_tip(wrench, load3(rods.arm, i), load3(rods.force, i), load3(rods.moment, i), load(rods.active + i));
  });
  wrench.total(sums.wrench, nothing);
  sums.rod_error = hn::GetLane(hn::MaxOfLanes(tag, worst)) + sums.wrench[6];
  const double unit[2] = {hn::GetLane(hn::MinOfLanes(tag, per_force)),
                          hn::GetLane(hn::MinOfLanes(tag, per_moment))};
  sums.error = sums.rod_error;
  for (int k = 0; k < 6; ++k) {
    const double missing = (platform.wrench[k] - sums.wrench[k]) * unit[k / 3];
    const double size = missing < 0 ? -missing : missing;
    sums.error = (size > sums.error ? size : sums.error) + missing * 0;
  }
}

/// Two rows of the elimination: what is left of the columns of a node's own blocks.
struct Block {
  Pack aa, ab, ba, bb;
};
HWY_INLINE Block load_block(const RodLane* p, int i) {
  return {load(p[0] + i), load(p[1] + i), load(p[2] + i), load(p[3] + i)};
}

/// Right sides of a node: by the tip's force and by the length.
HWY_INLINE void drive_node(const TangentRods& rods, int node, int i, const Place& place, Pack factor,
                           const Pack3& force, const Pack3& weight, Pack (&out)[2][4]) {
  const Pack3 t = load3(rods.tangent[node], i);
  const Load at = load_at(rods, i, t, force, weight, place.left);
  const Pack share = all(place.weight), stretch = load(rods.stretch + i), length = load(rods.length + i);
  const Pack twice = all(2) * factor / length;
  // ∂h/∂L beside the 2/L: Aᵀf, with A = α 1 + β t nᵀ
  const Pack3 own =
      scaled(plus(scaled(weight, at.alpha), at.n, stretch * dot(t, weight)), factor * all(place.left));
  const Pack3 by_length = plus(own, at.h, twice);
#pragma GCC unroll 2
  for (int a = 0; a < 2; ++a) {
    const Pack3 e = load3(rods.across[node][a], i);
    const Pack3 column = scaled(plus(scaled(e, at.alpha), t, stretch * dot(at.n, e)), share);
    out[a][0] = column.x;
    out[a][1] = column.y;
    out[a][2] = column.z;
    out[a][3] = hn::Neg(share * dot(e, by_length));
  }
}

/// The diagonal block of H at a node: (B − g·t) 1 − w b (e·f)(e·f), with b f fᵀ = (β L²/EI) n nᵀ.
HWY_INLINE void diagonal(const TangentRods& rods, int node, int i, double bending, const Place& place,
                         Pack factor, const Pack3& force, const Pack3& weight, Pack& d11, Pack& d12,
                         Pack& d22) {
  const Pack3 t = load3(rods.tangent[node], i);
  const Pack3 n = plus(force, weight, load(rods.length + i) * all(place.left));
  const Pack a = dot(load3(rods.across[node][0], i), n), b = dot(load3(rods.across[node][1], i), n);
  const Pack soft = load(rods.stretch + i) * factor * all(place.weight);
  const Pack whole = all(bending) - dot(load3(rods.pull[node], i), t);
  d11 = minus(whole, soft * a, a);
  d12 = hn::Neg(soft * a * b);
  d22 = minus(whole, soft * b, b);
}

/// A row of the elimination: of U = LD the blocks left of the diagonal, that itself, and the right sides.
struct Row {
  Block raw[degree];
  Pack d11, d12, d22, column[2][4];
};

/// The j-th block of a node's row, `other` being its node, less what the nodes before `other` explain.
/// @param u the block of H
HWY_INLINE Block eliminate_block(const TangentRods& rods, int i, int first, int j, Block u, const Row& row) {
  const int other = first + j;
  // the other's row begins before this one's where it ends an element, and after it never
  const int at = TangentRods::row_of(other) + first - TangentRods::first_of(other);
  for (int k = 0; k < j; ++k) {
    const Block& raw = row.raw[k];
    const Block l = load_block(rods.lower[at + k], i);
    u.aa = minus(minus(u.aa, raw.aa, l.aa), raw.ab, l.ab);
    u.ab = minus(minus(u.ab, raw.aa, l.ba), raw.ab, l.bb);
    u.ba = minus(minus(u.ba, raw.ba, l.aa), raw.bb, l.ab);
    u.bb = minus(minus(u.bb, raw.ba, l.ba), raw.bb, l.bb);
  }
  const Pack inner = load(rods.inner[other] + i);
  u.ab = minus(u.ab, u.aa, inner);
  u.bb = minus(u.bb, u.ba, inner);
  return u;
}

/// Takes a block of the row from the node's own block and from its right sides; leaves the block of L.
HWY_INLINE void take_block(TangentRods& rods, int i, int other, const Block& u, RodLane* to, Row& row) {
  const Pack p = load(rods.pivot[other][0] + i), q = load(rods.pivot[other][1] + i);
  const Block l = {u.aa * p, u.ab * q, u.ba * p, u.bb * q};
  store(l.aa, to[0] + i);
  store(l.ab, to[1] + i);
  store(l.ba, to[2] + i);
  store(l.bb, to[3] + i);
  row.d11 = minus(minus(row.d11, u.aa, l.aa), u.ab, l.ab);
  row.d12 = minus(minus(row.d12, u.ba, l.aa), u.bb, l.ab);
  row.d22 = minus(minus(row.d22, u.ba, l.ba), u.bb, l.bb);
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c) {
    const Pack a = load(rods.eliminated[other][2 * c] + i), b = load(rods.eliminated[other][2 * c + 1] + i);
    row.column[0][c] = minus(minus(row.column[0][c], l.aa, a), l.ab, b);
    row.column[1][c] = minus(minus(row.column[1][c], l.ba, a), l.bb, b);
  }
}

/// The node's own block, factored but at the tip, and its right sides.
HWY_INLINE void finish_row(TangentRods& rods, int i, int node, int tip, Row& row) {
  if (node == tip) {
    store(row.d11, rods.tip_pivot[0] + i);
    store(row.d12, rods.tip_pivot[1] + i);
    store(row.d22, rods.tip_pivot[2] + i);
  } else {
    // 1/d₁₁ and d₁₁/det by one division
    const Pack det = minus(row.d11 * row.d22, row.d12, row.d12), both = all(1) / (row.d11 * det);
    const Pack inverse = det * both, inner = row.d12 * inverse;
    store(inverse, rods.pivot[node][0] + i);
    store(inner, rods.inner[node] + i);
    store(row.d11 * row.d11 * both, rods.pivot[node][1] + i);
    for (int c = 0; c < 4; ++c) row.column[1][c] = minus(row.column[1][c], inner, row.column[0][c]);
  }
  for (int c = 0; c < 4; ++c) {
    store(row.column[0][c], rods.eliminated[node][2 * c] + i);
    store(row.column[1][c], rods.eliminated[node][2 * c + 1] + i);
  }
}

/// H = LDLᵀ by nodes from the base to the tip, whose own block is left as `tip_pivot`; the columns too.
HWY_INLINE void factor(TangentRods& rods, int i, int elements) {
  const auto& basis = LobattoBasis<element_degree>::get();
  const int tip = elements * degree;
  const Pack length = load(rods.length + i), loading = length * length * load(rods.flexibility + i);
  const Pack3 force = load3(rods.force, i), weight = load3(rods.weight, i);
  for (int node = 1; node <= tip; ++node) frame_node(rods, node, i);
  for (int node = 1; node <= tip; ++node) {
    const int element = (node - 1) / degree, start = element * degree, own = node - start;
    const int first = TangentRods::first_of(node), count = node - first;
    const Place place = place_of(node, elements);
    const Pack3 e1 = load3(rods.across[node][0], i), e2 = load3(rods.across[node][1], i);
    double bending = basis.bending[own][own] * elements;
    if (own == degree && node < tip) bending += basis.bending[0][0] * elements;
    Row row;
    diagonal(rods, node, i, bending, place, loading, force, weight, row.d11, row.d12, row.d22);
    drive_node(rods, node, i, place, loading, force, weight, row.column);
    for (int j = 0; j < count; ++j) {
      const int other = first + j;
      const Pack scale = all(basis.bending[own][other - start] * elements);
      const Pack3 o1 = load3(rods.across[other][0], i), o2 = load3(rods.across[other][1], i);
      const Block h = {dot(e1, o1) * scale, dot(e1, o2) * scale, dot(e2, o1) * scale, dot(e2, o2) * scale};
      row.raw[j] = eliminate_block(rods, i, first, j, h, row);
      take_block(rods, i, other, row.raw[j], rods.lower[TangentRods::row_of(node) + j], row);
    }
    finish_row(rods, i, node, tip, row);
  }
}

/// A symmetric 3×3: 11, 12, 13, 22, 23, 33.
struct Symmetric {
  Pack at[6];
};
HWY_INLINE Pack3 times(const Symmetric& s, const Pack3& v) {
  const Pack* p = s.at;
  return {plus(plus(p[0] * v.x, p[1], v.y), p[2], v.z), plus(plus(p[1] * v.x, p[3], v.y), p[4], v.z),
          plus(plus(p[2] * v.x, p[4], v.y), p[5], v.z)};
}

/// By cofactors.
HWY_INLINE Symmetric inverse_of(const Symmetric& m) {
  const Pack* c = m.at;
  const Pack k11 = minus(c[3] * c[5], c[4], c[4]), k12 = minus(c[2] * c[4], c[1], c[5]),
             k13 = minus(c[1] * c[4], c[2], c[3]);
  const Pack inverse = all(1) / plus(plus(c[0] * k11, c[1], k12), c[2], k13);
  return {{k11 * inverse, k12 * inverse, k13 * inverse, minus(c[0] * c[5], c[2], c[2]) * inverse,
           minus(c[1] * c[2], c[0], c[4]) * inverse, minus(c[0] * c[3], c[1], c[1]) * inverse}};
}

/// Through the nodes before the tip: GᵀH⁻¹G of the columns by force, GᵀH⁻¹ρ with that by length.
HWY_INLINE void answer_of_nodes(const TangentRods& rods, int i, int tip, Symmetric& by_force,
                                Pack (&by_length)[3]) {
  Pack* gg = by_force.at;
  for (int k = 0; k < 6; ++k) gg[k] = all(0);
  for (Pack& p : by_length) p = all(0);
  for (int node = 1; node < tip; ++node)
    for (int a = 0; a < 2; ++a) {
      const Pack p = load(rods.pivot[node][a] + i);
      Pack v[4], s[3];
      for (int c = 0; c < 4; ++c) v[c] = load(rods.eliminated[node][2 * c + a] + i);
      for (int c = 0; c < 3; ++c) s[c] = v[c] * p;
      gg[0] = plus(gg[0], s[0], v[0]);
      gg[1] = plus(gg[1], s[0], v[1]);
      gg[2] = plus(gg[2], s[0], v[2]);
      gg[3] = plus(gg[3], s[1], v[1]);
      gg[4] = plus(gg[4], s[1], v[2]);
      gg[5] = plus(gg[5], s[2], v[2]);
      for (int c = 0; c < 3; ++c) by_length[c] = plus(by_length[c], s[c], v[3]);
    }
}

/// The tip's columns X, that by length last, and X D⁻¹: its own block is inverted where the tip is free.
HWY_INLINE void answer_of_tip(TangentRods& rods, int i, int tip, Pack clamped, Pack (&x)[2][4],
                              Pack (&y)[2][3]) {
  const Pack d11 = load(rods.tip_pivot[0] + i), d12 = load(rods.tip_pivot[1] + i),
             d22 = load(rods.tip_pivot[2] + i);
  const Pack by = (all(1) - clamped) / minus(d11 * d22, d12, d12);
  const Pack s11 = d22 * by, s12 = hn::Neg(d12 * by), s22 = d11 * by;
  store(s11, rods.tip_soft[0] + i);
  store(s12, rods.tip_soft[1] + i);
  store(s22, rods.tip_soft[2] + i);
  for (int a = 0; a < 2; ++a)
    for (int c = 0; c < 4; ++c) x[a][c] = load(rods.eliminated[tip][2 * c + a] + i);
  for (int c = 0; c < 3; ++c) {
    y[0][c] = plus(x[0][c] * s11, x[1][c], s12);
    y[1][c] = plus(x[0][c] * s12, x[1][c], s22);
  }
}

/// Stretching: E = Σ w (β t tᵀ + 1/GA). @returns what a longer rod of its own weight does
HWY_INLINE Pack3 answer_of_stretch(const TangentRods& rods, int i, int elements, Symmetric& by_force) {
  const Pack stretch = load(rods.stretch + i), shear = load(rods.shear + i);
  const Pack3 weight = load3(rods.weight, i);
  Pack* ee = by_force.at;
  for (int k = 0; k < 6; ++k) ee[k] = all(0);
  Pack3 grown{all(0), all(0), all(0)};
  for (int node = 0; node <= elements * degree; ++node) {
    const Place place = place_of(node, elements);
    const Pack3 t = load3(rods.tangent[node], i), w = scaled(t, all(place.weight) * stretch);
    ee[0] = plus(ee[0], w.x, t.x);
    ee[1] = plus(ee[1], w.x, t.y);
    ee[2] = plus(ee[2], w.x, t.z);
    ee[3] = plus(ee[3], w.y, t.y);
    ee[4] = plus(ee[4], w.y, t.z);
    ee[5] = plus(ee[5], w.z, t.z);
    grown = plus(grown, plus(scaled(weight, shear * all(place.weight)), w, dot(t, weight)), all(place.left));
  }
  ee[0] = ee[0] + shear;
  ee[3] = ee[3] + shear;
  ee[5] = ee[5] + shear;
  return grown;
}

/// What the columns say of the tip: its stiffness, and what feeding does.
HWY_INLINE void stiffen(TangentRods& rods, int i, int elements) {
  const int tip = elements * degree;
  const Pack length = load(rods.length + i), soft = load(rods.flexibility + i),
             clamped = load(rods.clamped + i);
  Symmetric bends, stretches, compliance;
  Pack gl[3], x[2][4], y[2][3];
  answer_of_nodes(rods, i, tip, bends, gl);
  answer_of_tip(rods, i, tip, clamped, x, y);
  const Pack3 grown = answer_of_stretch(rods, i, elements, stretches);
  const Pack cube = length * length * length * soft;
  constexpr int pairs[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
  for (int k = 0; k < 6; ++k) {
    const int r = pairs[k][0], c = pairs[k][1];
    compliance.at[k] =
        plus(length * stretches.at[k], cube, plus(plus(bends.at[k], y[0][r], x[0][c]), y[1][r], x[1][c]));
  }
  const Symmetric stiffness = inverse_of(compliance);
  for (int k = 0; k < 6; ++k) store(stiffness.at[k], rods.stiffness[k] + i);
  // a clamp: Z = −S L X, W = (EI/L) D + L² Xᵀ S X, Q = [e₂, −e₁]
  const Pack3 x1 = {x[0][0], x[0][1], x[0][2]}, x2 = {x[1][0], x[1][1], x[1][2]};
  const Pack held = clamped * length, bent = clamped / (soft * length);
  const Pack3 z1 = times(stiffness, scaled(x1, hn::Neg(held))),
              z2 = times(stiffness, scaled(x2, hn::Neg(held)));
  store3(z1, rods.coupling[0], i);
  store3(z2, rods.coupling[1], i);
  store(minus(bent * load(rods.tip_pivot[0] + i), held, dot(x1, z1)), rods.bending[0] + i);
  store(minus(bent * load(rods.tip_pivot[1] + i), held, dot(x1, z2)), rods.bending[1] + i);
  store(minus(bent * load(rods.tip_pivot[2] + i), held, dot(x2, z2)), rods.bending[2] + i);
  store3(scaled(load3(rods.across[tip][1], i), clamped), rods.turned[0], i);
  store3(scaled(load3(rods.across[tip][0], i), hn::Neg(clamped)), rods.turned[1], i);
  // feeding: ℓ = ∂p/∂L − L GL − L X D⁻¹ ρ_L
  const Pack3 ahead = plus(scaled(load3(rods.tip, i), all(1) / length), grown, length);
  const auto fed = [&](Pack own, int c) {
    return minus(own, length, plus(plus(gl[c], y[0][c], x[0][3]), y[1][c], x[1][3]));
  };
  const Pack3 longer = {fed(ahead.x, 0), fed(ahead.y, 1), fed(ahead.z, 2)};
  const Pack3 feed = scaled(times(stiffness, longer), all(-1));
  Pack by_length[2];
  for (int a = 0; a < 2; ++a) {
    const Pack own = bent * (x[a][3] - load(rods.gap[tip][a] + i) / length);
    by_length[a] = minus(own, held, dot(a == 0 ? x1 : x2, feed));
    store(by_length[a], rods.feed_moment[a] + i);
  }
  store3(feed, rods.feed, i);
  const Pack3 m = sum(cross(load3(rods.arm, i), feed), moment_of(rods, i, tip, by_length[0], by_length[1]));
  store3(m, rods.feed + 3, i);
}

/// L⁻¹ of the gaps, and the forces that close them while the platform rests; their sum with the present ones.
HWY_INLINE void close_gaps(TangentRods& rods, int i, int elements, Wrench& wrench) {
  const int tip = elements * degree;
  const Pack length = load(rods.length + i);
  Pack3 soft{all(0), all(0), all(0)};  // G H⁻¹ r
  for (int node = 1; node <= tip; ++node) {
    const int first = TangentRods::first_of(node), row = TangentRods::row_of(node);
    Pack a = load(rods.gap[node][0] + i), b = load(rods.gap[node][1] + i);
    for (int k = 0; k < node - first; ++k) {
      const Block l = load_block(rods.lower[row + k], i);
      const Pack x = load(rods.left[first + k][0] + i), y = load(rods.left[first + k][1] + i);
      a = minus(minus(a, l.aa, x), l.ab, y);
      b = minus(minus(b, l.ba, x), l.bb, y);
    }
    if (node < tip) {
      b = minus(b, load(rods.inner[node] + i), a);
      const Pack p = load(rods.pivot[node][0] + i) * a, q = load(rods.pivot[node][1] + i) * b;
      const auto& column = rods.eliminated[node];
      soft.x = plus(plus(soft.x, load(column[0] + i), p), load(column[1] + i), q);
      soft.y = plus(plus(soft.y, load(column[2] + i), p), load(column[3] + i), q);
      soft.z = plus(plus(soft.z, load(column[4] + i), p), load(column[5] + i), q);
    }
    store(a, rods.left[node][0] + i);
    store(b, rods.left[node][1] + i);
  }
  const auto& column = rods.eliminated[tip];
  const Pack3 x1 = {load(column[0] + i), load(column[2] + i), load(column[4] + i)},
              x2 = {load(column[1] + i), load(column[3] + i), load(column[5] + i)};
  const Pack r1 = load(rods.left[tip][0] + i), r2 = load(rods.left[tip][1] + i);
  const Pack s11 = load(rods.tip_soft[0] + i), s12 = load(rods.tip_soft[1] + i),
             s22 = load(rods.tip_soft[2] + i);
  const Pack turn1 = hn::Neg(plus(s11 * r1, s12, r2)), turn2 = hn::Neg(plus(s12 * r1, s22, r2));
  soft = plus(plus(soft, x1, hn::Neg(turn1)), x2, hn::Neg(turn2));
  const Pack3 off = difference(scaled(soft, length), load3(rods.tip_gap, i));
  const RodLane* s = rods.stiffness;
  const Pack3 fix = {plus(plus(load(s[0] + i) * off.x, load(s[1] + i), off.y), load(s[2] + i), off.z),
                     plus(plus(load(s[1] + i) * off.x, load(s[3] + i), off.y), load(s[4] + i), off.z),
                     plus(plus(load(s[2] + i) * off.x, load(s[4] + i), off.y), load(s[5] + i), off.z)};
  store3(fix, rods.fix, i);
  const Pack clamped = load(rods.clamped + i), held = clamped * length;
  const Pack bent = clamped / (load(rods.flexibility + i) * length);
  const Pack m1 = minus(bent * r1, held, dot(x1, fix)), m2 = minus(bent * r2, held, dot(x2, fix));
  add_tip(wrench, load3(rods.arm, i), sum(load3(rods.force, i), fix), moment_of(rods, i, tip, m1, m2),
          load(rods.active + i));
}

/// ∂(F, M)/∂(δp, δφ): of a rod [S, Y − S[b]; …] with Y = Z Qᵀ, and the turning of force and moment.
struct TipSums {
  Pack force[6], couple[9], moment[9];
  HWY_INLINE TipSums() {
    for (Pack& p : force) p = all(0);
    for (Pack& p : couple) p = all(0);
    for (Pack& p : moment) p = all(0);
  }
  HWY_INLINE void add(const TangentRods& rods, int i, int tip) {
    const Pack active = load(rods.active + i);
    Pack s[6];
    for (int k = 0; k < 6; ++k) s[k] = load(rods.stiffness[k] + i) * active;
    const Pack3 b = load3(rods.arm, i), n = scaled(load3(rods.force, i), active);
    const Pack3 z1 = scaled(load3(rods.coupling[0], i), active),
                z2 = scaled(load3(rods.coupling[1], i), active);
    const Pack3 q1 = load3(rods.turned[0], i), q2 = load3(rods.turned[1], i);
    const Pack3 row[3] = {{s[0], s[1], s[2]}, {s[1], s[3], s[4]}, {s[2], s[4], s[5]}};
    const Pack zs[2][3] = {{z1.x, z1.y, z1.z}, {z2.x, z2.y, z2.z}};
    for (int k = 0; k < 6; ++k) force[k] = force[k] + s[k];
    Pack3 by_turn[3];  // rows of ∂n/∂φ
    for (int r = 0; r < 3; ++r) {
      by_turn[r] = plus(plus(cross(b, row[r]), q1, zs[0][r]), q2, zs[1][r]);
      couple[3 * r] = couple[3 * r] + by_turn[r].x;
      couple[3 * r + 1] = couple[3 * r + 1] + by_turn[r].y;
      couple[3 * r + 2] = couple[3 * r + 2] + by_turn[r].z;
    }
    // moments by turns: b × ∂n/∂φ + Q (Zᵀ(−[b]) + W Qᵀ), then force and moment that turn
    const Pack3 u1 = cross(b, z1), u2 = cross(b, z2);  // rows of −Zᵀ[b]
    const Pack w11 = load(rods.bending[0] + i) * active, w12 = load(rods.bending[1] + i) * active,
               w22 = load(rods.bending[2] + i) * active;
    const Pack3 v1 = plus(plus(u1, q1, w11), q2, w12), v2 = plus(plus(u2, q1, w12), q2, w22);
    const Pack3 t = load3(rods.tangent[tip], i), m = scaled(load3(rods.moment, i), active), tm = cross(t, m);
    const Pack along = dot(b, n);
    const Pack arms[3] = {b.x, b.y, b.z}, first[3] = {q1.x, q1.y, q1.z}, second[3] = {q2.x, q2.y, q2.z},
               ahead[3] = {t.x, t.y, t.z};
    for (int r = 0; r < 3; ++r) {
      const int o = (r + 1) % 3, p = (r + 2) % 3;
      Pack3 sum = plus(scaled(by_turn[p], arms[o]), by_turn[o], hn::Neg(arms[p]));
      sum = plus(plus(sum, v1, first[r]), v2, second[r]);
      sum = plus(plus(sum, n, arms[r]), tm, hn::Neg(ahead[r]));
      moment[3 * r] = moment[3 * r] + (r == 0 ? sum.x - along : sum.x);
      moment[3 * r + 1] = moment[3 * r + 1] + (r == 1 ? sum.y - along : sum.y);
      moment[3 * r + 2] = moment[3 * r + 2] + (r == 2 ? sum.z - along : sum.z);
    }
  }
  HWY_INLINE void total(double* out) const {
    constexpr int symmetric[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    Pack all_of[24];
    for (int k = 0; k < 6; ++k) all_of[k] = force[k];
    for (int k = 0; k < 9; ++k) all_of[6 + k] = couple[k];
    for (int k = 0; k < 9; ++k) all_of[15 + k] = moment[k];
    double sums[24];
    for (int k = 0; k < 24; k += 8) totals(all_of + k, sums + k);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        out[6 * r + c] = sums[symmetric[3 * r + c]];
        out[6 * r + 3 + c] = out[6 * (3 + c) + r] = sums[6 + 3 * r + c];
        out[6 * (3 + r) + 3 + c] = sums[15 + 3 * r + c];
      }
  }
};

void Linearise(std::span<TangentRods> groups, int elements, RodSums& sums) {
  TipSums stiffness;
  Wrench wrench;
  const int tip = elements * degree;
  each_pack(groups, [&](TangentRods& rods, int i) {
    factor(rods, i, elements);
    for (int node = 1; node <= tip; ++node) project(rods, node, i);
    stiffen(rods, i, elements);
    stiffness.add(rods, i, tip);
    close_gaps(rods, i, elements, wrench);
  });
  stiffness.total(sums.stiffness);
  wrench.total(sums.wrench);
}

void Close(std::span<TangentRods> groups, int elements, RodSums& sums) {
  Wrench wrench;
  each_pack(groups, [&](TangentRods& rods, int i) { close_gaps(rods, i, elements, wrench); });
  wrench.total(sums.wrench);
}

/// The state of the rods after the platform's step, with lengths fed or not.
HWY_INLINE void carry_on(TangentRods& rods, int i, int elements, const Pack3& shift, const Pack3& turn,
                         const double* fed) {
  const int tip = elements * degree;
  const Pack length = load(rods.length + i), loading = length * length * load(rods.flexibility + i);
  const Pack more = fed == nullptr ? all(0) : load(fed + i);
  const Pack3 moved = sum(cross(turn, load3(rods.arm, i)), shift);
  const Pack by1 = dot(load3(rods.turned[0], i), turn), by2 = dot(load3(rods.turned[1], i), turn);
  const RodLane* s = rods.stiffness;
  Pack3 change = {plus(plus(load(s[0] + i) * moved.x, load(s[1] + i), moved.y), load(s[2] + i), moved.z),
                  plus(plus(load(s[1] + i) * moved.x, load(s[3] + i), moved.y), load(s[4] + i), moved.z),
                  plus(plus(load(s[2] + i) * moved.x, load(s[4] + i), moved.y), load(s[5] + i), moved.z)};
  change = plus(plus(change, load3(rods.coupling[0], i), by1), load3(rods.coupling[1], i), by2);
  change = plus(sum(change, load3(rods.fix, i)), load3(rods.feed, i), more);
  store3(sum(load3(rods.force, i), change), rods.force, i);
  store(length + more, rods.length + i);
  // what drives each node, L⁻¹ of it
  Pack x[TangentState::max_nodes + 1][2];
  const Pack3 drive = scaled(change, loading);
  for (int node = 1; node <= tip; ++node) {
    const auto& column = rods.eliminated[node];
    for (int a = 0; a < 2; ++a) {
      Pack v = plus(plus(load(column[a] + i) * drive.x, load(column[2 + a] + i), drive.y),
                    load(column[4 + a] + i), drive.z);
      v = minus(v, load(column[6 + a] + i), more) - load(rods.left[node][a] + i);
      x[node][a] = node < tip ? v * load(rods.pivot[node][a] + i) : v;
    }
  }
  // a tip that is free goes by its own block, `left` in it
  const Pack s11 = load(rods.tip_soft[0] + i), s12 = load(rods.tip_soft[1] + i),
             s22 = load(rods.tip_soft[2] + i);
  const Pack free1 = plus(s11 * x[tip][0], s12, x[tip][1]), free2 = plus(s12 * x[tip][0], s22, x[tip][1]);
  x[tip][0] = by1 + free1;  // the one or the other is 0
  x[tip][1] = by2 + free2;
  for (int node = tip; node >= 1; --node) {
    if (node < tip) x[node][0] = minus(x[node][0], load(rods.inner[node] + i), x[node][1]);
    const int first = TangentRods::first_of(node), row = TangentRods::row_of(node);
    for (int k = 0; k < node - first; ++k) {
      const Block l = load_block(rods.lower[row + k], i);
      Pack(&to)[2] = x[first + k];
      to[0] = minus(minus(to[0], l.aa, x[node][0]), l.ba, x[node][1]);
      to[1] = minus(minus(to[1], l.ab, x[node][0]), l.bb, x[node][1]);
    }
  }
  for (int node = 1; node <= tip; ++node) {
    const auto& across = rods.across[node];
    push_node(rods, node, i, plus(scaled(load3(across[0], i), x[node][0]), load3(across[1], i), x[node][1]));
  }
}

void Apply(std::span<TangentRods> groups, int elements, const double* step, const RodFeed* fed) {
  const Pack3 shift = {all(step[0]), all(step[1]), all(step[2])},
              turn = {all(step[3]), all(step[4]), all(step[5])};
  each_pack(groups, [&](TangentRods& rods, int i) {
    carry_on(rods, i, elements, shift, turn, fed == nullptr ? nullptr : fed[&rods - groups.data()].length);
  });
}

/// Of all elements the largest sum of squares of the two highest Legendre coefficients of t′.
void Truncation(std::span<const TangentRods> groups, int elements, double* largest) {
  const auto& basis = LobattoBasis<element_degree>::get();
  for (int i = 0; i < rod_lanes; i += pack_size) {
    Pack worst = all(0);
    for (const TangentRods& rods : groups)
      for (int e = 0; e < elements; ++e) {
        Pack size = all(0);
        for (int c = 0; c < 3; ++c) {
          Pack last = all(0), before = all(0);
          for (int j = 0; j <= degree; ++j) {
            const Pack t = load(rods.tangent[e * degree + j][c] + i);
            last = plus(last, all(basis.last[j]), t);
            before = plus(before, all(basis.before_last[j]), t);
          }
          size = plus(plus(size, last, last), before, before);
        }
        worst = hn::Max(worst, size);
      }
    store(worst, largest + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::tangent_kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1::tangent_kernels {

HWY_EXPORT(Evaluate);
HWY_EXPORT(Linearise);
HWY_EXPORT(Close);
HWY_EXPORT(Apply);
HWY_EXPORT(Truncation);

void evaluate(std::span<TangentRods> groups, int elements, const RodPlatform& platform, bool from_scratch,
              RodSums& sums) {
  HWY_DYNAMIC_DISPATCH(Evaluate)(groups, elements, platform, from_scratch, sums);
}
void linearise(std::span<TangentRods> groups, int elements, RodSums& sums) {
  HWY_DYNAMIC_DISPATCH(Linearise)(groups, elements, sums);
}
void close(std::span<TangentRods> groups, int elements, RodSums& sums) {
  HWY_DYNAMIC_DISPATCH(Close)(groups, elements, sums);
}
void apply(std::span<TangentRods> groups, int elements, const double* step, const RodFeed* fed) {
  HWY_DYNAMIC_DISPATCH(Apply)(groups, elements, step, fed);
}
void truncation(std::span<const TangentRods> groups, int elements, double* largest) {
  HWY_DYNAMIC_DISPATCH(Truncation)(groups, elements, largest);
}

}  // namespace sinew::inline v1::tangent_kernels
#endif
