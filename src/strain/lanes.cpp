// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "strain/lanes.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "base/at.hpp"
#include "strain/element-inl.hpp"
#include "strain/lanes.hpp"
#include "strain/twist-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::strain {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using LaneTag = hn::CappedTag<double, lane_count>;
constexpr LaneTag lane_tag;
/// Lanes that a register has; all eight are one register after the other.
constexpr int width = static_cast<int>(hn::MaxLanes(lane_tag));

/// A number of several cases.
struct Num {
  hn::Vec<LaneTag> v;
  Num() = default;
  HWY_INLINE Num(hn::Vec<LaneTag> x) : v(x) {}
  HWY_INLINE Num(double x) : v(hn::Set(lane_tag, x)) {}
  HWY_INLINE Num(int x) : Num(static_cast<double>(x)) {}

  friend HWY_INLINE Num operator+(Num a, Num b) { return hn::Add(a.v, b.v); }
  friend HWY_INLINE Num operator-(Num a, Num b) { return hn::Sub(a.v, b.v); }
  friend HWY_INLINE Num operator*(Num a, Num b) { return hn::Mul(a.v, b.v); }
  friend HWY_INLINE Num operator/(Num a, Num b) { return hn::Div(a.v, b.v); }
  friend HWY_INLINE Num operator-(Num a) { return hn::Neg(a.v); }
  HWY_INLINE Num& operator+=(Num b) { return *this = *this + b; }
  HWY_INLINE Num& operator-=(Num b) { return *this = *this - b; }
  HWY_INLINE Num& operator/=(Num b) { return *this = *this / b; }
};
HWY_INLINE Num plus(Num c, Num a, Num b) { return hn::MulAdd(a.v, b.v, c.v); }      // c + ab
HWY_INLINE Num minus(Num c, Num a, Num b) { return hn::NegMulAdd(a.v, b.v, c.v); }  // c − ab
HWY_INLINE Num root(Num x) { return hn::Sqrt(x.v); }
HWY_INLINE Num larger(Num a, Num b) { return hn::Max(a.v, b.v); }
HWY_INLINE Num smaller(Num a, Num b) { return hn::Min(a.v, b.v); }
/// Right up to `series_end`; what is beyond is told.
HWY_INLINE EntireOf<Num> entire(Num s) { return entire_series(s); }

HWY_INLINE Num take(const LaneValues& values, int first) { return hn::Load(lane_tag, values.of + first); }
HWY_INLINE void put(Num x, LaneValues& values, int first) { hn::Store(x.v, lane_tag, values.of + first); }
/// The memory of one register's lanes, out of what all eight have.
template <class T>
HWY_INLINE T* part(std::vector<LaneValues>& memory, int first) {
  return reinterpret_cast<T*>(reinterpret_cast<double*>(memory.data()) + memory.size() * at(first));
}

struct LaneFrame {
  Num p[3], R[9];
};
struct LaneStep {
  Num R[9], p[3], omega[6], xi[2][6];
};
struct LaneSquare {
  Num a[6][6];
};
/// The right Jacobian of an element: [rotation coupling; 0 rotation].
struct LaneJacobian {
  Num rotation[9], coupling[9];
  /// Jᵀ u.
  HWY_INLINE void back(const Num* u, Num* out) const {
    Num top[3], bottom[3], more[3];
    turn_back3(rotation, u, top);
    turn_back3(coupling, u, bottom);
    turn_back3(rotation, u + 3, more);
    for (int i = 0; i < 3; ++i) {
      out[i] = top[i];
      out[i + 3] = bottom[i] + more[i];
    }
  }
};

/// Sᵀ → fᵀ S f for a linear f, of which `back` is the transpose, and a symmetric S.
template <class Back>
HWY_INLINE void sandwich(LaneSquare& s, Back back) {
  Num column[6];
  LaneSquare half;
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 6; ++i) column[i] = s.a[i][j];
    back(column, half.a[j]);  // row j of (fᵀ S)ᵀ
  }
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 6; ++i) column[i] = half.a[i][j];
    back(column, s.a[j]);
  }
}

HWY_INLINE void sweep_out(const RodModel& model, LaneWork& work, int first) {
  LaneFrame* frame = part<LaneFrame>(work.frames, first);
  LaneStep* step = part<LaneStep>(work.steps, first);
  for (int i = 0; i < 3; ++i) frame->p[i] = 0;
  for (int i = 0; i < 9; ++i) frame->R[i] = i % 4 == 0 ? 1 : 0;
  for (LaneValues& length : work.lengths) put(0, length, first);
  const auto lengthen = [&](int tendon, Num by) {
    LaneValues& length = work.lengths[at(tendon)];
    put(take(length, first) + by, length, first);
  };
  Num energy = 0, largest = 0;
  for (const Piece& piece : model.pieces) {
    for (int s = piece.first_span; s < piece.first_span + piece.spans; ++s) {
      const Span& span = model.spans[at(s)];
      const LaneFrame* start = frame;
      for (int k = span.first_element; k < span.first_element + span.elements; ++k, ++step, ++frame) {
        const Element& element = model.elements[at(k)];
        for (int g = 0; g < 2; ++g) {
          const auto point = at(g);
          for (std::size_t c = 0; c < 6; ++c) {
            Num sum = 0;
            const LaneValues* own = work.y.data() + piece.first + piece.offset[c];
            for (int a = 0; a < piece.modes[c]; ++a)
              sum = plus(sum, element.modes[point][at(a)], take(own[a], first));
            const Num bent = sum * piece.scale[c];
            step->xi[g][c] = element.rest[point][c] + bent;
            energy = plus(energy, 0.5 * element.weight * element.stiffness[point][c] * bent, bent);
          }
          for (int i = element.first_guide; i < element.first_guide + element.guides; ++i) {
            const Guide& guide = model.guides[at(i)];
            Num x[3];
            guided(step->xi[g], guide.place[point], guide.slope[point], x);
            lengthen(guide.tendon, element.weight * root(dot3(x, x)));
          }
        }
        magnus(element, step->xi[0], step->xi[1], step->omega);
        largest = larger(largest, dot3(step->omega + 3, step->omega + 3));
        exponential(step->omega, step->R, step->p);
        LaneFrame& next = frame[1];
        turn3(frame->R, step->p, next.p);
        for (int i = 0; i < 3; ++i) next.p[i] += frame->p[i];
        multiply3(frame->R, step->R, next.R);
        const NodeLoad& load = work.loads[at(k + 1)];
        energy -= dot3(load.force, next.p);
        for (int i = 0; i < 9; ++i) energy -= load.couple[i] * next.R[i];
      }
      for (int i = span.first_hole; i < span.first_hole + span.holes; ++i) {
        const Hole& hole = model.holes[at(i)];
        Num x[3];
        way_between(*start, *frame, hole, x);
        lengthen(hole.tendon, root(dot3(x, x)));
      }
    }
  }
  for (int i = 0; i < 3; ++i) energy -= take(work.tip_force[at(i)], first) * frame->p[i];
  for (int i = 0; i < 3; ++i) put(frame->p[i], work.tip[at(i)], first);
  for (int i = 0; i < 9; ++i) put(frame->R[i], work.tip[at(i + 3)], first);
  put(energy, work.energy, first);
  put(largest, work.largest_turn, first);
}

/// The load of a node, and at the tip its own force.
template <class Square>
HWY_INLINE void add_loads(const LaneWork& work, int node, bool is_tip, const LaneFrame& frame, int first,
                          Num* lambda, Square* P) {
  const NodeLoad& load = work.loads[at(node)];
  Num force[3];
  for (int i = 0; i < 3; ++i) {
    force[i] = load.force[i];
    if (is_tip) force[i] += take(work.tip_force[at(i)], first);
  }
  add_load(load, force, frame.R, lambda, P);
}

HWY_INLINE void collect(const Piece& piece, const Element& element, int point, const Num* by_strain,
                        LaneValues* out, int first) {
  for (std::size_t c = 0; c < 6; ++c) {
    const Num x = by_strain[c] * piece.scale[c];
    LaneValues* own = out + piece.offset[c];
    for (int a = 0; a < piece.modes[c]; ++a)
      put(plus(take(own[a], first), x, element.modes[at(point)][at(a)]), own[a], first);
  }
}

/// What the rod after a node is to it: the gradient of its potential by the node's twist, its derivatives by
/// that and by the coordinates of the piece, six numbers each.
struct LaneRest {
  Num lambda[6];
  LaneSquare P;
  Num* R;
};

/// Factors of a piece: Dᵀ L above and 1/D on the diagonal, row after row, the end's twist by coordinates,
/// H⁻¹ R̂ᵀ, and from its start to its end.
struct PieceFactors {
  Num *H, *G, *F, *R, *p;
  int n;
  HWY_INLINE PieceFactors(LaneWork& work, std::size_t piece, int size, int first) : n(size) {
    H = part<Num>(work.factors, first) + work.first_factor[piece];
    G = H + n * (n + 1) / 2;
    F = G + 6 * n;
    R = F + 6 * n;
    p = R + 9;
  }
  HWY_INLINE Num* line(int i) const { return H + i * (2 * n - i - 1) / 2; }
};

HWY_INLINE void between(const LaneFrame& start, const LaneFrame& end, Num* R, Num* p) {
  Num way[3];
  for (int i = 0; i < 3; ++i) way[i] = end.p[i] - start.p[i];
  turn_back3(start.R, way, p);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      R[3 * i + j] = start.R[i] * end.R[j] + start.R[3 + i] * end.R[3 + j] + start.R[6 + i] * end.R[6 + j];
}
/// A twist at the start, at the end.
HWY_INLINE void carry_on(const Num* R, const Num* p, const Num* twist, Num* out) {
  Num v[3], c[3], turn[3];
  cross3(p, twist + 3, c);
  for (int i = 0; i < 3; ++i) v[i] = twist[i] - c[i];
  turn_back3(R, twist + 3, turn);
  turn_back3(R, v, out);
  for (int i = 0; i < 3; ++i) out[i + 3] = turn[i];
}

/// The piece's Hessian with all after it eliminated: factors, and what it is to the twist at its start.
HWY_INLINE void eliminate(const PieceFactors& f, LaneSquare& P, const Num* R, Num& smallest) {
  const int n = f.n;
  for (int k = 0; k < n; ++k) {
    Num* pivot = f.line(k);
    smallest = smaller(smallest, pivot[k]);
    const Num inverse = 1 / pivot[k];
    for (int i = k + 1; i < n; ++i) {
      const Num l = pivot[i] * inverse;
      Num* line = f.line(i);
      for (int j = i; j < n; ++j) line[j] = minus(line[j], l, pivot[j]);
    }
    pivot[k] = inverse;
  }
  Num* F = f.F;
  for (int i = 0; i < 6 * n; ++i) F[i] = R[i];
  for (int k = 0; k < n; ++k) {
    const Num* pivot = f.line(k);
    Num from[6];
    for (int c = 0; c < 6; ++c) from[c] = pivot[k] * F[6 * k + c];
    for (int i = k + 1; i < n; ++i)
      for (int c = 0; c < 6; ++c) F[6 * i + c] = minus(F[6 * i + c], pivot[i], from[c]);
  }
  for (int k = n; k-- > 0;) {
    const Num* pivot = f.line(k);
    Num sum[6];
    for (int c = 0; c < 6; ++c) sum[c] = F[6 * k + c];
    for (int i = k + 1; i < n; ++i)
      for (int c = 0; c < 6; ++c) sum[c] = minus(sum[c], pivot[i], F[6 * i + c]);
    for (int c = 0; c < 6; ++c) F[6 * k + c] = pivot[k] * sum[c];
  }
  for (int i = 0; i < 6; ++i) {
    Num sum[6];
    for (int j = i; j < 6; ++j) sum[j] = P.a[i][j];
    for (int l = 0; l < n; ++l)
      for (int j = i; j < 6; ++j) sum[j] = minus(sum[j], R[6 * l + i], F[6 * l + j]);
    for (int j = i; j < 6; ++j) P.a[i][j] = P.a[j][i] = sum[j];
  }
}

/// Dᵀ u of a strain: h/2 ± √3/12 h² ad of the other one.
HWY_INLINE void strain_back(const Element& element, const Num* other, double sign, const Num* u, Num* out) {
  Num dual[6];
  dual_bracket(other, u, dual);
  for (int i = 0; i < 6; ++i) out[i] = plus(0.5 * element.length * u[i], sign * element.commutator, dual[i]);
}

/// Second derivatives of an element: by its strains, E, and of its end's twist by them, J D.
struct Curvature {
  LaneSquare first, mixed, second;  ///< E₁₁, E₁₂, E₂₂
  LaneSquare slope[2];              ///< J D₁, J D₂
};
HWY_INLINE void find_curvature(const Element& element, const LaneStep& step, const EntireOf<Num>& fn,
                               const LaneJacobian& J, const LaneSquare& P, const Num* lambda,
                               const Num* by_omega, Curvature& out) {
  const auto back = [&](int g, const Num* u, Num* to) {
    strain_back(element, step.xi[1 - g], g == 0 ? -1 : 1, u, to);
  };
  LaneSquare Q = P;
  sandwich(Q, [&](const Num* u, Num* to) { J.back(u, to); });
  add_exponential_curvature(Q, step.omega, lambda, fn);
  LaneSquare W;
  Num column[6];
  const auto finish = [&](int g, LaneSquare& E) {  // D_gᵀ Wᵀ
    for (int i = 0; i < 6; ++i) {
      Num x[6];
      back(g, W.a[i], x);
      for (int j = 0; j < 6; ++j) E.a[j][i] = x[j];
    }
  };
  for (int h = 0; h < 2; ++h) {
    for (int j = 0; j < 6; ++j) {  // D_hᵀ Q
      for (int i = 0; i < 6; ++i) column[i] = Q.a[j][i];
      Num x[6];
      back(h, column, x);
      for (int i = 0; i < 6; ++i) W.a[i][j] = x[i];
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        // rows of J, each through Dᵀ
        column[j] = J.rotation[3 * i + j];
        column[j + 3] = J.coupling[3 * i + j];
        if (j < 2) continue;
        back(h, column, out.slope[h].a[i]);
        for (int k = 0; k < 3; ++k) {
          column[k + 3] = column[k];
          column[k] = 0;
        }
        back(h, column, out.slope[h].a[i + 3]);
      }
    if (h == 0) {
      finish(0, out.first);
    } else {
      finish(0, out.mixed);
      finish(1, out.second);
    }
  }
  add_bracket(out.mixed, by_omega, element.commutator);
}

/// Γ, six numbers a coordinate.
HWY_INLINE void find_gamma(const RodModel& model, const Piece& piece, const Element& element,
                           const Curvature& e, Num* G) {
  const double* basis = model.rows.data() + element.first_row;
  for (std::size_t c = 0; c < 6; ++c)
    for (int a = 0; a < piece.modes[c]; ++a) {
      const int j = piece.offset[c] + a;
      const double one = basis[static_cast<int>(c) * piece.padded + j],
                   two = basis[(6 + static_cast<int>(c)) * piece.padded + j];
      for (int i = 0; i < 6; ++i) G[6 * j + i] = plus(e.slope[0].a[i][c] * one, e.slope[1].a[i][c], two);
    }
}

/// H += basisᵀ E basis, and where the rod goes on in its piece Γᵀ R and its transpose.
template <bool goes_on>
HWY_INLINE void add_to_hessian(const RodModel& model, const Piece& piece, const Element& element,
                               const Curvature& e, const Num* G, const Num* R, const PieceFactors& f) {
  const double* basis = model.rows.data() + element.first_row;
  for (std::size_t c = 0; c < 6; ++c)
    for (int a = 0; a < piece.modes[c]; ++a) {
      const int j = piece.offset[c] + a;
      const double one = basis[static_cast<int>(c) * piece.padded + j],
                   two = basis[(6 + static_cast<int>(c)) * piece.padded + j];
      Num by_first[6], by_second[6], gamma[6], rest[6];
      for (std::size_t i = 0; i < 6; ++i) {
        by_first[i] = plus(e.first.a[i][c] * one, e.mixed.a[i][c], two);
        by_second[i] = plus(e.mixed.a[c][i] * one, e.second.a[i][c], two);
        if constexpr (goes_on) {
          gamma[i] = G[6 * at(j) + i];
          rest[i] = R[6 * at(j) + i];
        }
      }
      for (std::size_t d = 0; d <= c; ++d) {
        const double* own = basis + static_cast<int>(d) * piece.padded;
        const int first = piece.offset[d], last = std::min(first + piece.modes[d], j + 1);
        for (int i = first; i < last; ++i) {
          Num& h = f.line(i)[j];
          Num sum = plus(plus(h, by_first[d], own[i]), by_second[d], own[6 * piece.padded + i]);
          if constexpr (goes_on) {
            Num other = gamma[0] * R[6 * i];
            for (int k = 1; k < 6; ++k) other = plus(other, gamma[k], R[6 * i + k]);
            for (int k = 0; k < 6; ++k) sum = plus(sum, rest[k], G[6 * i + k]);
            sum += other;
          }
          h = sum;
        }
      }
    }
}

/// R ← Aᵀ (R + (P + ½Φ(λ)) Γ), P ← Aᵀ P A.
template <bool anew>
HWY_INLINE void carry_rest(const LaneStep& step, const Num* G, int n, LaneRest& rest) {
  LaneSquare form = rest.P;
  add_bracket(form, rest.lambda, 0.5);
  for (int j = 0; j < n; ++j) {
    Num x[6];
    for (int i = 0; i < 6; ++i) {
      Num sum = anew ? form.a[i][0] * G[6 * j] : plus(rest.R[6 * j + i], form.a[i][0], G[6 * j]);
      for (int k = 1; k < 6; ++k) sum = plus(sum, form.a[i][k], G[6 * j + k]);
      x[i] = sum;
    }
    carry_back(step.R, step.p, x, rest.R + 6 * j);
  }
  sandwich(rest.P, [&](const Num* u, Num* to) { carry_back(step.R, step.p, u, to); });
}

template <bool hessian>
HWY_INLINE void sweep_back(const RodModel& model, LaneWork& work,
                           const std::vector<std::vector<double>>* more, int first) {
  const LaneFrame* frames = part<LaneFrame>(work.frames, first);
  const LaneStep* steps = part<LaneStep>(work.steps, first);
  for (LaneValues& x : work.gradient) put(0, x, first);
  LaneRest outer, inner;
  Num* scratch = part<Num>(work.scratch, first);
  const int room = 6 * work.most_coordinates;
  outer.R = scratch, inner.R = scratch + room;
  Num *G = scratch + 2 * room, *both = scratch + 3 * room;
  for (Num& x : outer.lambda) x = 0;
  if constexpr (hessian) clear(outer.P);
  Num smallest = 1;
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size;
    const PieceFactors factors(work, k, n, first);
    LaneValues* gradient = work.gradient.data() + piece.first;
    const Span& last_span = model.spans[at(piece.first_span + piece.spans - 1)];
    const int piece_end = last_span.first_element + last_span.elements;
    if constexpr (hessian) {
      for (int i = 0; i < n; ++i)
        for (int j = i; j < n; ++j)
          factors.line(i)[j] = more->empty() ? 0.0 : (*more)[k][at(i * piece.padded + j)];
      for (int i = 0; i < 6 * n; ++i) factors.G[i] = 0;
    }
    for (int s = piece.first_span + piece.spans; s-- > piece.first_span;) {
      const Span& span = model.spans[at(s)];
      const int last = span.first_element + span.elements;
      const bool has_holes = span.holes > 0;
      for (Num& x : inner.lambda) x = 0;
      if constexpr (hessian) clear(inner.P);
      for (int i = span.first_hole; i < span.first_hole + span.holes; ++i) {
        const Hole& hole = model.holes[at(i)];
        const Num tension = take(work.tensions[at(hole.tendon)], first);
        Num one[6];
        hole_terms(frames[span.first_element], frames[last], hole, tension, one,
                   hessian ? &inner.P : nullptr);
        for (int j = 0; j < 6; ++j) inner.lambda[j] = plus(inner.lambda[j], tension, one[j]);
      }
      for (int e = last; e-- > span.first_element;) {
        const Element& element = model.elements[at(e)];
        const LaneStep& step = steps[e];
        add_loads(work, e + 1, at(e + 1) == model.elements.size(), frames[e + 1], first, outer.lambda,
                  hessian ? &outer.P : nullptr);
        Num lambda[6], by_omega[6], by_strain[2][6];
        for (int i = 0; i < 6; ++i) lambda[i] = outer.lambda[i] + inner.lambda[i];
        const EntireOf<Num> fn = entire(dot3(step.omega + 3, step.omega + 3));
        LaneJacobian J;
        right_jacobian(step.omega, fn, J.rotation, J.coupling);
        J.back(lambda, by_omega);
        by_strains(element, step.xi[0], step.xi[1], by_omega, by_strain[0], by_strain[1]);
        [[maybe_unused]] Curvature curvature;
        if constexpr (hessian) {
          LaneSquare sum;
          for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) sum.a[i][j] = outer.P.a[i][j] + inner.P.a[i][j];
          find_curvature(element, step, fn, J, sum, lambda, by_omega, curvature);
        }
        for (int g = 0; g < 2; ++g) {
          const auto point = at(g);
          LaneSquare* E = hessian ? &(g == 0 ? curvature.first : curvature.second) : nullptr;
          for (std::size_t c = 0; c < 6; ++c) {
            const double stiff = element.weight * element.stiffness[point][c];
            by_strain[g][c] = plus(by_strain[g][c], stiff, step.xi[g][c] - element.rest[point][c]);
            if constexpr (hessian) E->a[c][c] += stiff;
          }
          for (int i = element.first_guide; i < element.first_guide + element.guides; ++i) {
            const Guide& guide = model.guides[at(i)];
            const Num tension = element.weight * take(work.tensions[at(guide.tendon)], first);
            Num one[6];
            guide_terms(step.xi[g], guide, g, one, tension, E);
            for (int j = 0; j < 6; ++j) by_strain[g][j] = plus(by_strain[g][j], tension, one[j]);
          }
          collect(piece, element, g, by_strain[g], gradient, first);
        }
        if constexpr (hessian) {
          find_gamma(model, piece, element, curvature, G);
          if (e + 1 == piece_end) {
            add_to_hessian<false>(model, piece, element, curvature, G, both, factors);
            for (int i = 0; i < 6 * n; ++i) factors.G[i] = G[i];
            carry_rest<true>(step, G, n, outer);
            if (has_holes && e > span.first_element) carry_rest<true>(step, G, n, inner);
          } else {
            const bool is_last = e + 1 == last;  // of its span: holes give no R yet
            if (has_holes && !is_last) {
              for (int i = 0; i < 6 * n; ++i) both[i] = outer.R[i] + inner.R[i];
              add_to_hessian<true>(model, piece, element, curvature, G, both, factors);
            } else {
              add_to_hessian<true>(model, piece, element, curvature, G, outer.R, factors);
            }
            Num R[9], p[3];
            between(frames[e + 1], frames[piece_end], R, p);
            for (int j = 0; j < n; ++j) {
              Num moved[6];
              carry_on(R, p, G + 6 * j, moved);
              for (int i = 0; i < 6; ++i) factors.G[6 * j + i] += moved[i];
            }
            carry_rest<false>(step, G, n, outer);
            if (has_holes && e > span.first_element) {
              if (is_last)
                carry_rest<true>(step, G, n, inner);
              else
                carry_rest<false>(step, G, n, inner);
            }
          }
        }
        carry_back(step.R, step.p, outer.lambda, outer.lambda);
        if (e > span.first_element) carry_back(step.R, step.p, inner.lambda, inner.lambda);
      }
    }
    if constexpr (hessian) {
      between(frames[model.spans[at(piece.first_span)].first_element], frames[piece_end], factors.R,
              factors.p);
      eliminate(factors, outer.P, outer.R, smallest);
    }
  }
  if constexpr (hessian) put(smallest, work.smallest_pivot, first);
}

HWY_INLINE void solve(const RodModel& model, LaneWork& work, int first) {
  Num* side = part<Num>(work.scratch, first);
  Num carried[6], twist[6], next[6];
  for (int i = 0; i < 6; ++i) carried[i] = twist[i] = 0;
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size;
    const PieceFactors f(work, k, n, first);
    LaneValues* x = work.side.data() + piece.first;
    carry_back(f.R, f.p, carried, next);
    for (int i = 0; i < n; ++i) {
      Num sum = take(x[i], first);
      for (int l = 0; l < 6; ++l) sum = minus(sum, f.G[6 * i + l], carried[l]);
      side[i] = sum;
      for (int l = 0; l < 6; ++l) next[l] = plus(next[l], f.F[6 * i + l], sum);
    }
    for (int l = 0; l < 6; ++l) carried[l] = next[l];
    for (int i = 0; i < n; ++i) {
      const Num* pivot = f.line(i);
      const Num from = pivot[i] * side[i];
      for (int j = i + 1; j < n; ++j) side[j] = minus(side[j], pivot[j], from);
    }
    for (int i = n; i-- > 0;) {
      const Num* pivot = f.line(i);
      Num sum = side[i], other = 0;
      int j = i + 1;
      for (; j + 1 < n; j += 2) {
        sum = minus(sum, pivot[j], side[j]);
        other = minus(other, pivot[j + 1], side[j + 1]);
      }
      if (j < n) sum = minus(sum, pivot[j], side[j]);
      side[i] = pivot[i] * (sum + other);
      put(side[i], x[i], first);
    }
  }
  for (std::size_t k = 0; k < model.pieces.size(); ++k) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size;
    const PieceFactors f(work, k, n, first);
    LaneValues* x = work.side.data() + piece.first;
    carry_on(f.R, f.p, twist, next);
    for (int i = 0; i < n; ++i) {
      Num sum = take(x[i], first);
      for (int l = 0; l < 6; ++l) sum = minus(sum, f.F[6 * i + l], twist[l]);
      put(sum, x[i], first);
      for (int l = 0; l < 6; ++l) next[l] = plus(next[l], f.G[6 * i + l], sum);
    }
    for (int l = 0; l < 6; ++l) twist[l] = next[l];
  }
}

void LanesOut(const RodModel& model, LaneWork& work) {
  for (int first = 0; first < lane_count; first += width) sweep_out(model, work, first);
}
void LanesBack(const RodModel& model, LaneWork& work) {
  for (int first = 0; first < lane_count; first += width) sweep_back<false>(model, work, nullptr, first);
}
void LanesFactor(const RodModel& model, LaneWork& work, const std::vector<std::vector<double>>& more) {
  for (int first = 0; first < lane_count; first += width) sweep_back<true>(model, work, &more, first);
}
void LanesSolve(const RodModel& model, LaneWork& work) {
  for (int first = 0; first < lane_count; first += width) solve(model, work, first);
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::strain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1::strain {

HWY_EXPORT(LanesOut);
HWY_EXPORT(LanesBack);
HWY_EXPORT(LanesFactor);
HWY_EXPORT(LanesSolve);

LaneWork::LaneWork(const RodModel& model)
    : y(at(model.size)),
      tensions(at(model.tendons)),
      loads(at(model.nodes())),
      gradient(at(model.size)),
      lengths(at(model.tendons)),
      side(at(model.size)),
      frames(12 * at(model.nodes())),
      steps(30 * model.elements.size()) {
  int numbers = 0;
  for (const Piece& piece : model.pieces) {
    first_factor.push_back(numbers);
    numbers += piece.size * (piece.size + 1) / 2 + 12 * piece.size + 12;
    most_coordinates = std::max(most_coordinates, piece.size);
  }
  factors.resize(at(numbers));
  scratch.resize(at(24 * most_coordinates));
}

bool fits_lanes(const RodModel& model) {
  return std::ranges::all_of(model.elements, [](const Element& element) { return element.points == 2; });
}

void sweep_out(const RodModel& model, LaneWork& work) { HWY_DYNAMIC_DISPATCH(LanesOut)(model, work); }
void sweep_back(const RodModel& model, LaneWork& work) { HWY_DYNAMIC_DISPATCH(LanesBack)(model, work); }
void sweep_back_and_factor(const RodModel& model, LaneWork& work,
                           const std::vector<std::vector<double>>& more) {
  HWY_DYNAMIC_DISPATCH(LanesFactor)(model, work, more);
}
void solve(const RodModel& model, LaneWork& work) { HWY_DYNAMIC_DISPATCH(LanesSolve)(model, work); }

}  // namespace sinew::inline v1::strain
#endif
