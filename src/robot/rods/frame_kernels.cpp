// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "robot/rods/frame_kernels.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "robot/rods/frame_kernels.hpp"
#include "robot/rods/packs-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::frame_kernels {
namespace HWY_NAMESPACE {
using namespace packs::HWY_NAMESPACE;

constexpr int degree = FrameState::degree, nodes = FrameRods::nodes, rows = FrameRods::rows;
constexpr int eliminated = FrameRods::eliminated, force_at = FrameRods::force_at,
              length_at = FrameRods::length_at;
constexpr int pack_size = static_cast<int>(hn::MaxLanes(tag));

/// Calls `use(group, lane)` with every pack of rods.
template <class Groups, class Use>
HWY_INLINE void each_pack(Groups groups, Use&& use) {
  for (auto& rods : groups)
    for (int i = 0; i < rod_lanes; i += pack_size) use(rods, i);
}

HWY_INLINE Pack3 sum3(const Pack3& a, const Pack3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Pack3 times(const Pack3& a, const Pack3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
HWY_INLINE Pack3 none() { return {all(0), all(0), all(0)}; }

struct Quaternion {
  Pack w;
  Pack3 v;
};
HWY_INLINE Quaternion load_frame(const RodLane* p, int i) { return {load(p[0] + i), load3(p + 1, i)}; }

/// R x = x + 2w (v × x) + 2 v × (v × x), and Rᵀ x.  @implements 3PFS (22)
HWY_INLINE Pack3 turned(const Quaternion& q, const Pack3& x) {
  const Pack3 side = cross(q.v, x), more = plus(cross(q.v, side), side, q.w);
  return plus(x, more, all(2));
}
HWY_INLINE Pack3 turned_back(const Quaternion& q, const Pack3& x) {
  const Pack3 side = cross(q.v, x), more = plus(cross(q.v, side), side, hn::Neg(q.w));
  return plus(x, more, all(2));
}

/// What rods are, without dimension.
struct Law {
  Pack3 stiffness, compliance, precurvature, force, weight;
};
HWY_INLINE Law law_of(const FrameRods& rods, int i) {
  const Pack length = load(rods.length + i), unit = load(rods.unit + i), square = length * length / unit;
  Law law;
  law.stiffness = load3(rods.stiffness, i);
  law.compliance = scaled(load3(rods.compliance, i), all(1) / square);
  law.precurvature = scaled(load3(rods.precurvature, i), length);
  law.force = scaled(load3(rods.force, i), square);
  law.weight = scaled(load3(rods.weight, i), square * length);
  return law;
}

/// The strains of an element. Of two nodes j < k the turn from one to the other is (c, b); A of the
/// derivative of the strain at j by turns of k is α 1 + [β]. u = 2 vec(q̄ q′): @implements 3PFS (23), torsion
/// included
struct Strains {
  Quaternion frame[nodes];
  Pack c[nodes][nodes];
  Pack3 b[nodes][nodes];
  Pack3 u[nodes];
};
HWY_INLINE void find_strains(const FrameRods& rods, int i, int element, int elements, Strains& at) {
  const auto& basis = LobattoBasis<element_degree>::get();
  for (int j = 0; j < nodes; ++j) {
    at.frame[j] = load_frame(rods.frame[element * degree + j], i);
    at.u[j] = none();
  }
  for (int j = 0; j < nodes; ++j) {
    const Quaternion& p = at.frame[j];
    for (int k = j + 1; k < nodes; ++k) {
      const Quaternion& q = at.frame[k];
      const Pack c = plus(dot(p.v, q.v), p.w, q.w);
      const Pack3 side = cross(q.v, p.v);  // vec(p̄ q) = p.w q.v − q.w p.v − p.v × q.v
      const Pack3 b = plus(plus(side, q.v, p.w), p.v, hn::Neg(q.w));
      at.c[j][k] = at.c[k][j] = c;
      at.b[j][k] = b;
      at.b[k][j] = scaled(b, all(-1));
      at.u[j] = plus(at.u[j], b, all(2 * elements * basis.slope[j][k]));
      at.u[k] = plus(at.u[k], b, all(-2 * elements * basis.slope[k][j]));
    }
  }
}

/// What the force does at a node: a = Rᵀn in the section's axes, and the stretch v = e₃ + C a.
struct Load {
  Pack3 a, v;
};
HWY_INLINE Load load_at(const Law& law, const Quaternion& frame, double left) {
  Load at;
  at.a = turned_back(frame, plus(law.force, law.weight, all(left)));
  at.v = times(law.compliance, at.a);
  at.v.z = at.v.z + all(1);
  return at;
}

/// Of the length from here to the tip.
HWY_INLINE double left_of(int element, int node, int elements) {
  return 1 - (element + LobattoBasis<element_degree>::get().node[node]) / elements;
}

/// Where the tip lies, and the balance of moments of every node.  @implements 3PFS (20)-(21), with the
/// section's whole law
HWY_INLINE void measure(FrameRods& rods, int i, int elements) {
  const auto& basis = LobattoBasis<element_degree>::get();
  for (int node = 0; node <= elements * degree; ++node) {  // steps round their length
    RodLane* frame = rods.frame[node];
    Pack square = all(0);
    for (int c = 0; c < 4; ++c) square = plus(square, load(frame[c] + i), load(frame[c] + i));
    const Pack scale = minus(all(1.5), all(0.5), square);
    for (int c = 0; c < 4; ++c) store(load(frame[c] + i) * scale, frame[c] + i);
  }
  const Law law = law_of(rods, i);
  Pack3 reached = none(), carry = none();
  Pack largest = all(0), nothing = all(0);
  for (int e = 0; e < elements; ++e) {
    Strains at;
    find_strains(rods, i, e, elements, at);
    Pack3 gap[nodes];
    gap[0] = carry;
    for (int k = 1; k < nodes; ++k) gap[k] = none();
    for (int j = 0; j < nodes; ++j) {
      const double weight = basis.weight[j] / elements;
      const Pack3 moment =
          scaled(times(law.stiffness, plus(at.u[j], law.precurvature, all(-1))), all(weight));
      Pack own = all(0);
      for (int k = 0; k < nodes; ++k) {
        if (k == j) continue;
        const Pack slope = all(elements * basis.slope[j][k]), alpha = slope * at.c[j][k];
        own = own - alpha;
        gap[k] = plus(plus(gap[k], moment, alpha), cross(moment, at.b[j][k]), slope);
      }
      gap[j] = plus(plus(gap[j], moment, own), cross(moment, at.u[j]), all(0.5));
      const Load load_here = load_at(law, at.frame[j], left_of(e, j, elements));
      gap[j] = plus(gap[j], cross(load_here.v, load_here.a), all(-weight));
      reached = plus(reached, turned(at.frame[j], load_here.v), all(weight));
    }
    carry = gap[degree];
    for (int k = 0; k <= degree; ++k) {
      const int node = e * degree + k;
      store3(gap[k], rods.gap[node], i);
      if (k == degree) break;
      Pack3 size = {hn::Abs(gap[k].x), hn::Abs(gap[k].y), hn::Abs(gap[k].z)};
      if (node == 0) size = {all(0), all(0), size.z * load(rods.turns_at_base + i)};
      largest = hn::Max(largest, hn::Max(hn::Max(size.x, size.y), size.z));
      nothing = nothing + (gap[k].x + gap[k].y + gap[k].z) * all(0);  // a maximum may hide a NaN
    }
  }
  store3(reached, rods.reached, i);
  store(largest + nothing, rods.error + i);
}

void Evaluate(std::span<FrameRods> groups, int elements) {
  each_pack(groups, [&](FrameRods& rods, int i) { measure(rods, i, elements); });
}

/// A 3×3 matrix, rows first.
struct Square {
  Pack a[9];
};
/// α 1 + [β].
HWY_INLINE Square turn_matrix(Pack alpha, const Pack3& beta) {
  return {{alpha, hn::Neg(beta.z), beta.y, beta.z, alpha, hn::Neg(beta.x), hn::Neg(beta.y), beta.x, alpha}};
}
/// to + aᵀ b.
HWY_INLINE void add_product(const Square& a, const Square& b, Square& to) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      to.a[3 * r + c] =
          plus(plus(plus(to.a[3 * r + c], a.a[r], b.a[c]), a.a[3 + r], b.a[3 + c]), a.a[6 + r], b.a[6 + c]);
}
HWY_INLINE Pack3 row_of(const Square& a, int r) { return {a.a[3 * r], a.a[3 * r + 1], a.a[3 * r + 2]}; }

/// What a node's load adds to its own turns, and its rows by force and ln L, into an element's matrix.
HWY_INLINE void add_load(const Law& law, const Quaternion& frame, int node, double left, double share,
                         RodLane* matrix, int i) {
  const Load at = load_at(law, frame, left);
  const Pack3 &a = at.a, &v = at.v, &C = law.compliance;
  const Pack weight = all(-share), va = dot(v, a);
  const auto add = [&](int row, int column, Pack x) {
    double* to = matrix[triangle_place(row, column)] + i;
    store(load(to) + x, to);
  };
  // −w (½ (v aᵀ + a vᵀ) − v·a 1 + [a]ᵀ C [a])
  const int at_node = 3 * node;
  const Pack half = all(0.5);
  const Pack xx = plus(plus(v.x * a.x - va, C.y * a.z, a.z), C.z * a.y, a.y),
             yy = plus(plus(v.y * a.y - va, C.x * a.z, a.z), C.z * a.x, a.x),
             zz = plus(plus(v.z * a.z - va, C.x * a.y, a.y), C.y * a.x, a.x),
             yx = minus(half * plus(v.y * a.x, v.x, a.y), C.z * a.x, a.y),
             zx = minus(half * plus(v.z * a.x, v.x, a.z), C.y * a.x, a.z),
             zy = minus(half * plus(v.z * a.y, v.y, a.z), C.x * a.y, a.z);
  add(at_node, at_node, weight * xx);
  add(at_node + 1, at_node, weight * yx);
  add(at_node + 1, at_node + 1, weight * yy);
  add(at_node + 2, at_node, weight * zx);
  add(at_node + 2, at_node + 1, weight * zy);
  add(at_node + 2, at_node + 2, weight * zz);
  // columns of R
  const Pack3 axes[3] = {turned(frame, {all(1), all(0), all(0)}), turned(frame, {all(0), all(1), all(0)}),
                         turned(frame, {all(0), all(0), all(1)})};
  // Q = [v] − [a] C, by the force Q Rᵀ
  const Square q = {{all(0), plus(hn::Neg(v.z), a.z, C.y), minus(v.y, a.y, C.z),  //
                     minus(v.z, a.z, C.x), all(0), plus(hn::Neg(v.x), a.x, C.z),  //
                     plus(hn::Neg(v.y), a.y, C.x), minus(v.x, a.x, C.y), all(0)}};
  const Pack3 grown = turned_back(frame, scaled(law.weight, all(3 * left)));  // Rᵀ ∂n/∂ln L
  const Pack3 soft = times(C, a), twice = cross(soft, a);
  const Pack by_length[3] = {twice.x, twice.y, twice.z};
  for (int r = 0; r < 3; ++r) {
    const Pack3 line = row_of(q, r);
    const Pack3 by_force = plus(plus(scaled(axes[0], line.x), axes[1], line.y), axes[2], line.z);
    add(force_at, at_node + r, weight * by_force.x);
    add(force_at + 1, at_node + r, weight * by_force.y);
    add(force_at + 2, at_node + r, weight * by_force.z);
    add(length_at, at_node + r, weight * minus(dot(line, grown), all(2), by_length[r]));
  }
  // the place of the tip by force and ln L
  const Pack3 stretched = {C.x * (grown.x - a.x - a.x), C.y * (grown.y - a.y - a.y),
                           C.z * (grown.z - a.z - a.z)};
  const Pack3 ahead = turned(frame, stretched);
  add(length_at, force_at, weight * ahead.x);
  add(length_at, force_at + 1, weight * ahead.y);
  add(length_at, force_at + 2, weight * ahead.z);
  const Pack3 cx = scaled(axes[0], C.x), cy = scaled(axes[1], C.y), cz = scaled(axes[2], C.z);
  add(force_at, force_at, weight * plus(plus(cx.x * axes[0].x, cy.x, axes[1].x), cz.x, axes[2].x));
  add(force_at + 1, force_at, weight * plus(plus(cx.y * axes[0].x, cy.y, axes[1].x), cz.y, axes[2].x));
  add(force_at + 1, force_at + 1, weight * plus(plus(cx.y * axes[0].y, cy.y, axes[1].y), cz.y, axes[2].y));
  add(force_at + 2, force_at, weight * plus(plus(cx.z * axes[0].x, cy.z, axes[1].x), cz.z, axes[2].x));
  add(force_at + 2, force_at + 1, weight * plus(plus(cx.z * axes[0].y, cy.z, axes[1].y), cz.z, axes[2].y));
  add(force_at + 2, force_at + 2, weight * plus(plus(cx.z * axes[0].z, cy.z, axes[1].z), cz.z, axes[2].z));
}

/// The Hessian of the energy of an element, its nodes' turns by pairs; and the row of ln L.
HWY_INLINE void add_strains(const Law& law, const Strains& at, int elements, RodLane* matrix, int i) {
  const auto& basis = LobattoBasis<element_degree>::get();
  Square A[nodes][nodes];  // of the strain at the first by turns of the second
  Pack3 moment[nodes];
  Pack own[nodes];
  for (Pack& x : own) x = all(0);
  for (int j = 0; j < nodes; ++j) {
    const double weight = basis.weight[j] / elements;
    moment[j] = scaled(times(law.stiffness, plus(at.u[j], law.precurvature, all(-1))), all(weight));
    Pack alpha_own = all(0);
    for (int k = 0; k < nodes; ++k) {
      if (k == j) continue;
      const Pack slope = all(elements * basis.slope[j][k]), alpha = slope * at.c[j][k];
      alpha_own = alpha_own - alpha;
      A[j][k] = turn_matrix(alpha, scaled(at.b[j][k], slope));
      own[k] = minus(own[k], all(0.5) * slope, dot(moment[j], at.b[j][k]));
    }
    A[j][j] = turn_matrix(alpha_own, scaled(at.u[j], all(0.5)));
    own[j] = minus(own[j], all(0.25), dot(moment[j], at.u[j]));
  }
  const Pack3 bent = times(law.stiffness, law.precurvature);
  for (int l = 0; l < nodes; ++l) {
    Square KA[nodes];
    Pack3 by_length = none();
    for (int j = 0; j < nodes; ++j) {
      const Pack weight = all(basis.weight[j] / elements);
      const Pack k[3] = {weight * law.stiffness.x, weight * law.stiffness.y, weight * law.stiffness.z};
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) KA[j].a[3 * r + c] = k[r] * A[j][l].a[3 * r + c];
      for (int r = 0; r < 3; ++r) {
        const Pack b = weight * (r == 0 ? bent.x : r == 1 ? bent.y : bent.z);
        by_length = plus(by_length, row_of(A[j][l], r), hn::Neg(b));
      }
    }
    store3(by_length, matrix + triangle_place(length_at, 3 * l), i);
    for (int k = l; k < nodes; ++k) {
      Square sum;
      if (k == l) {
        for (int n = 0; n < 9; ++n) sum.a[n] = n % 4 == 0 ? own[k] : all(0);
      } else {  // c [x] + b xᵀ + x bᵀ − (x·b) 1
        const Pack half = all(0.5 * elements);
        const Pack3 x = plus(scaled(moment[k], half * all(basis.slope[k][l])), moment[l],
                             hn::Neg(half * all(basis.slope[l][k])));
        const Pack3& b = at.b[k][l];
        sum = turn_matrix(hn::Neg(dot(x, b)), scaled(x, at.c[k][l]));
        const Pack bs[3] = {b.x, b.y, b.z}, xs[3] = {x.x, x.y, x.z};
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c)
            sum.a[3 * r + c] = plus(plus(sum.a[3 * r + c], bs[r], xs[c]), xs[r], bs[c]);
      }
      for (int j = 0; j < nodes; ++j) add_product(A[j][k], KA[j], sum);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < (k == l ? r + 1 : 3); ++c)
          store(sum.a[3 * r + c], matrix[triangle_place(3 * k + r, 3 * l + c)] + i);
    }
  }
}

/// The base is held, or turns about its tangent only.
HWY_INLINE void hold_base(const FrameRods& rods, RodLane* matrix, int i) {
  const Pack free = load(rods.turns_at_base + i);
  for (int c = 0; c < 3; ++c) {
    const Pack keep = c < 2 ? all(0) : free;
    for (int r = c + 1; r < rows; ++r) {
      double* to = matrix[triangle_place(r, c)] + i;
      store(r < 3 ? all(0) : load(to) * keep, to);
    }
    double* to = matrix[triangle_place(c, c)] + i;
    store(plus(all(1) - keep, load(to), keep), to);
  }
}

/// LDLᵀ of all but the last node, three columns at a time; what is left stands in the last rows.
HWY_INLINE void eliminate(RodLane* matrix, int i) {
  for (int first = 0; first < eliminated; first += 3) {
    Pack raw[rows][3], lower[rows][3], inverse[3];
    for (int k = 0; k < 3; ++k)
      for (int r = first + k; r < rows; ++r) {
        Pack x = load(matrix[triangle_place(r, first + k)] + i);
        for (int m = 0; m < k; ++m) x = minus(x, lower[r][m], raw[first + k][m]);
        raw[r][k] = x;
        if (r == first + k) {
          inverse[k] = all(1) / x;
          store(inverse[k], matrix[triangle_place(r, r)] + i);
        } else {
          lower[r][k] = x * inverse[k];
          store(lower[r][k], matrix[triangle_place(r, first + k)] + i);
        }
      }
    for (int r = first + 3; r < rows; ++r) {
      double* line = matrix[triangle_place(r, 0)] + i;
      for (int c = first + 3; c <= r; ++c) {
        double* to = line + c * rod_lanes;
        store(minus(minus(minus(load(to), lower[r][0], raw[c][0]), lower[r][1], raw[c][1]), lower[r][2],
                    raw[c][2]),
              to);
      }
    }
  }
}

HWY_INLINE void factor(FrameRods& rods, int i, int elements, double shift) {
  const auto& basis = LobattoBasis<element_degree>::get();
  const Law law = law_of(rods, i);
  for (int e = 0; e < elements; ++e) {
    RodLane* matrix = rods.factors[e];
    Strains at;
    find_strains(rods, i, e, elements, at);
    for (int r = force_at; r < length_at; ++r)
      for (int c = 0; c <= r; ++c) store(all(0), matrix[triangle_place(r, c)] + i);
    for (int c = force_at; c <= length_at; ++c) store(all(0), matrix[triangle_place(length_at, c)] + i);
    add_strains(law, at, elements, matrix, i);
    for (int j = 0; j < nodes; ++j)
      add_load(law, at.frame[j], j, left_of(e, j, elements), basis.weight[j] / elements, matrix, i);
    for (int k = 0; k < FrameRods::turns && shift > 0; ++k) {
      double* to = matrix[triangle_place(k, k)] + i;
      store(load(to) + all(shift * basis.weight[k / 3] / elements), to);
    }
    if (e == 0) {
      hold_base(rods, matrix, i);
    } else {  // what is left of the elements before, whose last node is the first one here
      const RodLane* before = rods.factors[e - 1];
      for (int r = 0; r < FrameRods::left; ++r)
        for (int c = 0; c <= r; ++c) {
          const int row = r < 3 ? r : eliminated + r, column = c < 3 ? c : eliminated + c;
          double* to = matrix[triangle_place(row, column)] + i;
          store(load(to) + load(before[triangle_place(eliminated + r, eliminated + c)] + i), to);
        }
    }
    eliminate(matrix, i);
  }
  for (int r = 0; r < FrameRods::left; ++r)
    for (int c = 0; c <= r; ++c)
      store(load(rods.factors[elements - 1][triangle_place(eliminated + r, eliminated + c)] + i),
            rods.condensed[triangle_place(r, c)] + i);
}

HWY_INLINE void close_gaps(FrameRods& rods, int i, int elements) {
  Pack3 place = scaled(load3(rods.reached, i), all(-1)), carry = none();
  for (int e = 0; e < elements; ++e) {
    const RodLane* matrix = rods.factors[e];
    Pack right[rows];
    for (int k = 0; k < nodes; ++k) {
      // gaps of a node where two elements meet are summed: the first of them hands its part on
      const bool is_last = k == degree && e + 1 < elements;
      const Pack3 gap = is_last || (k == 0 && e > 0) ? none() : load3(rods.gap[e * degree + k], i);
      right[3 * k] = gap.x;
      right[3 * k + 1] = gap.y;
      right[3 * k + 2] = gap.z;
    }
    if (e == 0) {
      right[0] = right[1] = all(0);
      right[2] = right[2] * load(rods.turns_at_base + i);
    } else {
      const Pack3 own = load3(rods.gap[e * degree], i);
      right[0] = own.x + carry.x;
      right[1] = own.y + carry.y;
      right[2] = own.z + carry.z;
    }
    right[force_at] = place.x;
    right[force_at + 1] = place.y;
    right[force_at + 2] = place.z;
    for (int k = 0; k < eliminated; ++k) {
      const Pack x = right[k];
      store(x, rods.reduced[e][k] + i);
      for (int r = k + 1; r < length_at; ++r)
        right[r] = minus(right[r], load(matrix[triangle_place(r, k)] + i), x);
    }
    carry = {right[eliminated], right[eliminated + 1], right[eliminated + 2]};
    place = {right[force_at], right[force_at + 1], right[force_at + 2]};
  }
  store3(carry, rods.open, i);
  store3(place, rods.open + 3, i);
}

void Linearise(std::span<FrameRods> groups, int elements, double shift) {
  each_pack(groups, [&](FrameRods& rods, int i) {
    factor(rods, i, elements, shift);
    close_gaps(rods, i, elements);
  });
}

void Close(std::span<FrameRods> groups, int elements) {
  each_pack(groups, [&](FrameRods& rods, int i) { close_gaps(rods, i, elements); });
}

/// A frame turned by θ in its own axes: to third order, and exactly a rotation.
HWY_INLINE void turn_node(FrameRods& rods, int node, int i, const Pack3& turn) {
  const Quaternion q = load_frame(rods.frame[node], i);
  const Pack x = dot(turn, turn) * all(1.0 / 16), inverse = all(1) / (all(1) + x);
  const Pack w = (all(1) - x) * inverse;
  const Pack3 v = scaled(turn, all(0.5) * inverse);
  store(minus(q.w * w, all(1), dot(q.v, v)), rods.frame[node][0] + i);
  store3(plus(plus(cross(q.v, v), v, q.w), q.v, w), rods.frame[node] + 1, i);
}

HWY_INLINE void carry_on(FrameRods& rods, int i, int elements) {
  const Law law = law_of(rods, i);
  Pack x[rows];
  for (int k = 0; k < FrameRods::left; ++k) x[eliminated + k] = load(rods.step[k] + i);
  turn_node(rods, elements * degree, i, {x[eliminated], x[eliminated + 1], x[eliminated + 2]});
  for (int e = elements - 1; e >= 0; --e) {
    const RodLane* matrix = rods.factors[e];
    for (int k = eliminated - 1; k >= 0; --k) {
      Pack sum = load(rods.reduced[e][k] + i) * load(matrix[triangle_place(k, k)] + i);
      for (int r = k + 1; r < rows; ++r) sum = plus(sum, load(matrix[triangle_place(r, k)] + i), x[r]);
      x[k] = hn::Neg(sum);
    }
    for (int k = 0; k < degree; ++k)
      turn_node(rods, e * degree + k, i, {x[3 * k], x[3 * k + 1], x[3 * k + 2]});
    for (int k = 0; k < 3; ++k) x[eliminated + k] = x[k];
  }
  const Pack length = load(rods.length + i), unit = load(rods.unit + i);
  const Pack longer = plus(length, length, x[length_at]), scale = unit / (longer * longer);
  const Pack3 force = sum3(law.force, {x[force_at], x[force_at + 1], x[force_at + 2]});
  store3(scaled(force, scale), rods.force, i);
  store(longer, rods.length + i);
}

void Apply(std::span<FrameRods> groups, int elements) {
  each_pack(groups, [&](FrameRods& rods, int i) { carry_on(rods, i, elements); });
}

void Truncation(std::span<const FrameRods> groups, int elements, double* largest) {
  const auto& basis = LobattoBasis<element_degree>::get();
  for (int i = 0; i < rod_lanes; i += pack_size) {
    Pack worst = all(0);
    for (const FrameRods& rods : groups)
      for (int e = 0; e < elements; ++e) {
        Pack size = all(0);
        for (int c = 0; c < 4; ++c) {
          Pack last = all(0), before = all(0);
          for (int j = 0; j <= degree; ++j) {
            const Pack q = load(rods.frame[e * degree + j][c] + i);
            last = plus(last, all(basis.last[j]), q);
            before = plus(before, all(basis.before_last[j]), q);
          }
          size = plus(plus(size, last, last), before, before);
        }
        worst = hn::Max(worst, size);
      }
    store(worst, largest + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::frame_kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1::frame_kernels {

HWY_EXPORT(Evaluate);
HWY_EXPORT(Linearise);
HWY_EXPORT(Close);
HWY_EXPORT(Apply);
HWY_EXPORT(Truncation);

void evaluate(std::span<FrameRods> groups, int elements) { HWY_DYNAMIC_DISPATCH(Evaluate)(groups, elements); }
void linearise(std::span<FrameRods> groups, int elements, double shift) {
  HWY_DYNAMIC_DISPATCH(Linearise)(groups, elements, shift);
}
void close(std::span<FrameRods> groups, int elements) { HWY_DYNAMIC_DISPATCH(Close)(groups, elements); }
void apply(std::span<FrameRods> groups, int elements) { HWY_DYNAMIC_DISPATCH(Apply)(groups, elements); }
void truncation(std::span<const FrameRods> groups, int elements, double* largest) {
  HWY_DYNAMIC_DISPATCH(Truncation)(groups, elements, largest);
}

}  // namespace sinew::inline v1::frame_kernels
#endif
