// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "strain/sweep.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "strain/element-inl.hpp"
#include "strain/sweep.hpp"
#include "strain/twist-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::strain {
namespace HWY_NAMESPACE {

/// Strain at a Gauss point.
HWY_INLINE void strain_at(const Piece& piece, const Element& element, int point, const double* y, Six& xi) {
  const auto g = static_cast<std::size_t>(point);
  for (std::size_t c = 0; c < 6; ++c) {
    double sum = 0;
    const double* own = y + piece.offset[c];
    for (int a = 0; a < piece.modes[c]; ++a) sum += element.modes[g][static_cast<std::size_t>(a)] * own[a];
    xi[c] = element.rest[g][c] + piece.scale[c] * sum;
  }
}

HWY_INLINE void magnus(const Element& element, const std::array<Six, 2>& xi, Six& omega) {
  if (element.points < 2) {
    const double length = element.points == 1 ? 1 : element.length;
    const Six& strain = element.points == 1 ? xi[0] : element.rest[0];
    for (std::size_t c = 0; c < 6; ++c) omega[c] = length * strain[c];
    return;
  }
  magnus(element, xi[0].data(), xi[1].data(), omega.data());
}

void SweepOut(const RodModel& model, RodWork& work) {
  RodFrame* frame = work.frames.data();
  double energy = 0;
  for (double& length : work.lengths) length = 0;
  for (const Piece& piece : model.pieces) {
    const double* y = work.y.data() + piece.first;
    for (int s = piece.first_span; s < piece.first_span + piece.spans; ++s) {
      const Span& span = model.spans[static_cast<std::size_t>(s)];
      const RodFrame* start = frame;
      for (int k = span.first_element; k < span.first_element + span.elements; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const Element& element = model.elements[at];
        auto& xi = work.strains[at];
        for (int g = 0; g < element.points; ++g) {
          const auto point = static_cast<std::size_t>(g);
          strain_at(piece, element, g, y, xi[point]);
          for (std::size_t c = 0; c < 6; ++c) {
            const double bent = xi[point][c] - element.rest[point][c];
            energy += 0.5 * element.weight * element.stiffness[point][c] * bent * bent;
          }
          for (int i = element.first_guide; i < element.first_guide + element.guides; ++i) {
            const Guide& guide = model.guides[static_cast<std::size_t>(i)];
            double x[3];
            guided(xi[point].data(), guide.place[point], guide.slope[point], x);
            work.lengths[static_cast<std::size_t>(guide.tendon)] += element.weight * std::sqrt(dot3(x, x));
          }
        }
        magnus(element, xi, work.omega[at]);
        double *R = work.steps[at].data(), *p = R + 9;
        exponential(work.omega[at].data(), R, p);
        RodFrame& next = frame[1];
        turn3(frame->R, p, next.p);
        for (int i = 0; i < 3; ++i) next.p[i] += frame->p[i];
        multiply3(frame->R, R, next.R);
        ++frame;
      }
      for (int i = span.first_hole; i < span.first_hole + span.holes; ++i) {
        const Hole& hole = model.holes[static_cast<std::size_t>(i)];
        double x[3];
        way_between(*start, *frame, hole, x);
        work.lengths[static_cast<std::size_t>(hole.tendon)] += std::sqrt(dot3(x, x));
      }
    }
  }
  for (std::size_t k = 1; k < work.frames.size(); ++k) {
    const NodeLoad& load = work.loads[k];
    energy -= dot3(load.force, work.frames[k].p);
    for (int i = 0; i < 9; ++i) energy -= load.couple[i] * work.frames[k].R[i];
  }
  work.energy = energy;
}

/// A gradient by the strains of an element into that by the coordinates of its piece.
HWY_INLINE void collect(const Piece& piece, const Element& element, int point, const double* by_strain,
                        double* out) {
  const double* modes = element.modes[static_cast<std::size_t>(point)].data();
  for (std::size_t c = 0; c < 6; ++c) {
    const double x = by_strain[c] * piece.scale[c];
    double* own = out + piece.offset[c];
    for (int a = 0; a < piece.modes[c]; ++a) own[a] += x * modes[a];
  }
}

/// What lengths of tendons between discs are by, a column for each of eight tendons: by the twist of a node
/// against the first disc, and by the coordinates of the piece.
struct Eight {
  Block by_twist;
  alignas(64) double by_coordinates[max_piece * row];
};

/// Gradients by the strains of an element, in columns, to those by coordinates.
HWY_INLINE void collect_columns(const Piece& piece, const Element& element, int point, const Block& by_strain,
                                double* out) {
  const double* modes = element.modes[static_cast<std::size_t>(point)].data();
  for (std::size_t c = 0; c < 6; ++c) {
    const Lanes x = piece.scale[c] * lanes(by_strain.a[c]);
    double* own = out + piece.offset[c] * row;
    for (int a = 0; a < piece.modes[c]; ++a) lanes(own + a * row) += modes[a] * x;
  }
}

/// Of a span's tendons the gradients that were collected, to those of the whole rod.
HWY_INLINE void add_columns(const RodModel& model, const Piece& piece, const Span& span, const Eight* eights,
                            RodWork& work) {
  for (int i = 0; i < span.holes; ++i) {
    const auto tendon =
        static_cast<std::size_t>(model.holes[static_cast<std::size_t>(span.first_hole + i)].tendon);
    double* out = work.length_gradient.data() + tendon * work.y.size() + piece.first;
    const double* from = eights[i / row].by_coordinates + i % row;
    for (int j = 0; j < piece.size; ++j) out[j] += from[j * row];
  }
}

/// What the rod after a node is to it: the gradient of its potential by the node's twist, its derivatives by
/// that and by the coordinates of the piece.
struct Rest {
  double lambda[6];
  Block P;
  double *R, *L;
};

/// To the start of a rigid link.
HWY_INLINE void carry_rigid(const Block& A, int padded, bool symmetric, Rest& rest) {
  Block PA;
  multiply_rows_back<false>(A, rest.R, padded, rest.R);
  if (!symmetric) multiply_rows_back<false>(A, rest.L, padded, rest.L);
  multiply(rest.P, A, PA);
  multiply_back(A, PA, rest.P);
}

template <bool hessian>
HWY_INLINE void sweep(const RodModel& model, RodWork& work) {
  for (double& x : work.gradient) x = 0;
  const bool by_lengths = work.finds_length_gradients;
  if (by_lengths)
    for (double& x : work.length_gradient) x = 0;
  Eight eights[most_holes / row];
  alignas(64) double rows[6][6 * max_piece];
  Rest outer, inner;
  for (double& x : outer.lambda) x = 0;
  outer.R = rows[0], outer.L = rows[1], inner.R = rows[2], inner.L = rows[3];
  double *G = rows[4], *more = rows[5];
  const bool symmetric = work.symmetric;
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size, padded = piece.padded;
    PieceTerms& terms = work.pieces[k];
    double* gradient = work.gradient.data() + piece.first;
    const Span& last_span = model.spans[static_cast<std::size_t>(piece.first_span + piece.spans - 1)];
    [[maybe_unused]] const int piece_end = last_span.first_element + last_span.elements;
    double* Y = work.scratch.data();  // Γᵀ L, whose transpose belongs to H
    Block along;                      // from the node at hand to the end of the piece
    if constexpr (hessian) {
      for (double& x : terms.H) x = 0;
      for (int i = 0; i < n * padded; ++i) Y[i] = 0;
      for (double& x : terms.G) x = 0;
      for (int i = 0; i < 6 * padded; ++i) outer.R[i] = outer.L[i] = 0;
      clear(outer.P);
      clear(along);
      for (int i = 0; i < 6; ++i) along.a[i][i] = 1;
    }
    for (int s = piece.first_span + piece.spans; s-- > piece.first_span;) {
      const Span& span = model.spans[static_cast<std::size_t>(s)];
      const int last = span.first_element + span.elements;
      const bool has_holes = span.holes > 0;
      const int packs = by_lengths ? (span.holes + row - 1) / row : 0;
      for (int i = 0; i < packs; ++i) {
        clear(eights[i].by_twist);
        for (int j = 0; j < n * row; ++j) eights[i].by_coordinates[j] = 0;
      }
      for (double& x : inner.lambda) x = 0;
      if constexpr (hessian) {
        clear(inner.P);
        for (int i = 0; i < 6 * padded; ++i) inner.R[i] = inner.L[i] = 0;
      }
      for (int i = 0; i < span.holes; ++i) {
        const auto at = static_cast<std::size_t>(span.first_hole + i);
        const double tension = work.hole_tension[at];
        double one[6];
        hole_terms(work.frames[static_cast<std::size_t>(span.first_element)],
                   work.frames[static_cast<std::size_t>(last)], model.holes[at], tension, one,
                   hessian ? &inner.P : nullptr);
        for (int j = 0; j < 6; ++j) inner.lambda[j] += tension * one[j];
        if (packs > 0)
          for (int j = 0; j < 6; ++j) eights[i / row].by_twist.a[j][i % row] = one[j];
      }
      for (int e = last; e-- > span.first_element;) {
        const auto at = static_cast<std::size_t>(e);
        const Element& element = model.elements[at];
        const auto& xi = work.strains[at];
        const double *R = work.steps[at].data(), *p = R + 9, *omega = work.omega[at].data();
        const Entire fn = entire(dot3(omega + 3, omega + 3));
        add_load(work.loads[at + 1], work.loads[at + 1].force, work.frames[at + 1].R, outer.lambda,
                 hessian ? &outer.P : nullptr);
        if (element.points == 0) {  // a rigid link carries what lies after it, and no more
          Block A;
          if (hessian || packs > 0) back_adjoint(R, p, A);
          if constexpr (hessian) {
            Block next;
            multiply(along, A, next);
            along = next;
            carry_rigid(A, padded, symmetric, outer);
            if (has_holes && e > span.first_element) carry_rigid(A, padded, symmetric, inner);
          }
          carry_back(R, p, outer.lambda, outer.lambda);
          if (e > span.first_element) {
            carry_back(R, p, inner.lambda, inner.lambda);
            for (int i = 0; i < packs; ++i) multiply_back(A, eights[i].by_twist, eights[i].by_twist);
          }
          continue;
        }
        double lambda[6], by_omega[6], by_strain[2][6];
        for (int i = 0; i < 6; ++i) lambda[i] = outer.lambda[i] + inner.lambda[i];
        Block J;
        right_jacobian(omega, fn, J);
        apply_back(J, lambda, by_omega);
        if (element.points == 1)
          std::copy(by_omega, by_omega + 6, by_strain[0]);
        else
          by_strains(element, xi[0].data(), xi[1].data(), by_omega, by_strain[0], by_strain[1]);
        [[maybe_unused]] Block E[2][2];
        Block D[2], A;
        if (hessian || packs > 0) {
          back_adjoint(R, p, A);
          if (element.points == 2)
            for (int g = 0; g < 2; ++g) {
              clear(D[g]);
              for (int i = 0; i < 6; ++i) D[g].a[i][i] = 0.5 * element.length;
              add_ad(D[g], xi[static_cast<std::size_t>(1 - g)].data(),
                     g == 0 ? -element.commutator : element.commutator);
            }
        }
        if constexpr (hessian) {
          Block Q, PJ, sum = outer.P;
          add(sum, inner.P, 1);
          multiply(sum, J, PJ);
          multiply_back(J, PJ, Q);
          add_exponential_curvature(Q, omega, lambda, fn);
          if (element.points == 1) {
            E[0][0] = Q;
          } else {
            for (int h = 0; h < 2; ++h) {
              Block QD;
              multiply(Q, D[h], QD);
              for (int g = 0; g < 2; ++g) multiply_back(D[g], QD, E[g][h]);
            }
            add_bracket(E[0][1], by_omega, element.commutator);
            add_bracket(E[1][0], by_omega, -element.commutator);
          }
        }
        for (int g = 0; g < element.points; ++g) {
          const auto point = static_cast<std::size_t>(g);
          for (std::size_t c = 0; c < 6; ++c) {
            const double stiff = element.weight * element.stiffness[point][c];
            by_strain[g][c] += stiff * (xi[point][c] - element.rest[point][c]);
            if constexpr (hessian) E[g][g].a[c][c] += stiff;
          }
          for (int i = element.first_guide; i < element.first_guide + element.guides; ++i) {
            const auto which = static_cast<std::size_t>(i);
            const Guide& guide = model.guides[which];
            const double tension = element.weight * work.guide_tension[which];
            double one[6];
            guide_terms(xi[point].data(), guide, g, one, tension, hessian ? &E[g][g] : nullptr);
            for (int j = 0; j < 6; ++j) {
              by_strain[g][j] += tension * one[j];
              one[j] *= element.weight;
            }
            if (!by_lengths) continue;
            collect(piece, element, g, one,
                    work.length_gradient.data() + static_cast<std::size_t>(guide.tendon) * work.y.size() +
                        piece.first);
          }
          collect(piece, element, g, by_strain[g], gradient);
        }
        for (int i = 0; i < packs; ++i) {
          Eight& eight = eights[i];
          Block by_end, by;
          multiply_back(J, eight.by_twist, by_end);
          if (element.points == 1) {
            collect_columns(piece, element, 0, by_end, eight.by_coordinates);
          } else {
            for (int g = 0; g < 2; ++g) {
              multiply_back(D[g], by_end, by);
              collect_columns(piece, element, g, by, eight.by_coordinates);
            }
          }
          if (e > span.first_element) multiply_back(A, eight.by_twist, eight.by_twist);
        }
        if constexpr (hessian) {
          const double* basis = model.rows.data() + element.first_row;  // strains by coordinates
          Block JD;
          for (int g = 0; g < element.points; ++g) {  // Γ = Σ J D basis, H += basisᵀ E basis
            const double* own = basis + g * 6 * padded;
            if (element.points == 1)
              JD = J;
            else
              multiply(J, D[g], JD);
            if (g == 0)
              multiply_rows<false>(JD, own, padded, G);
            else
              multiply_rows<true>(JD, own, padded, G);
            multiply_rows<false>(E[g][0], basis, padded, more);
            if (element.points == 2) multiply_rows<true>(E[g][1], basis + 6 * padded, padded, more);
            const double* modes = element.modes[static_cast<std::size_t>(g)].data();
            for (std::size_t c = 0; c < 6; ++c)
              for (int a = 0; a < piece.modes[c]; ++a) {
                const double x = modes[a] * piece.scale[c];
                double* line = terms.H.data() + (piece.offset[c] + a) * padded;
                const double* from = more + static_cast<int>(c) * padded;
                for (int j = 0; j < padded; j += row) lanes(line + j) += x * lanes(from + j);
              }
          }
          // Γᵀ R and its partner; after the last element of a piece there is no R
          if (e + 1 < piece_end) {
            for (int i = 0; i < 6 * padded; i += row)
              lanes(more + i) = lanes(outer.R + i) + lanes(inner.R + i);
            add_product(G, more, n, padded, symmetric ? Y : terms.H.data());
            if (!symmetric) {
              for (int i = 0; i < 6 * padded; i += row)
                lanes(more + i) = lanes(outer.L + i) + lanes(inner.L + i);
              add_product(G, more, n, padded, Y);
            }
          }
          // the end of the piece moves by along·Γ
          multiply_rows<true>(along, G, padded, terms.G.data());
          Block next;
          multiply(along, A, next);
          along = next;
          const auto carry = [&](Rest& rest) {
            Block form = rest.P, PA;
            add_bracket(form, rest.lambda, 0.5);
            multiply_rows<true>(form, G, padded, rest.R);
            multiply_rows_back<false>(A, rest.R, padded, rest.R);
            if (!symmetric) {
              Block back;
              clear(back);
              for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j) back.a[i][j] = rest.P.a[j][i];
              add_bracket(back, rest.lambda, 0.5);
              multiply_rows<true>(back, G, padded, rest.L);
              multiply_rows_back<false>(A, rest.L, padded, rest.L);
            }
            multiply(rest.P, A, PA);
            multiply_back(A, PA, rest.P);
          };
          carry(outer);
          if (has_holes && e > span.first_element) carry(inner);
        }
        carry_back(R, p, outer.lambda, outer.lambda);
        if (e > span.first_element) carry_back(R, p, inner.lambda, inner.lambda);
      }
      if (packs > 0) add_columns(model, piece, span, eights, work);
    }
    if constexpr (hessian) {
      for (int i = 0; i < n; ++i) {
        double* line = terms.H.data() + i * padded;
        for (int j = 0; j < n; ++j) line[j] += Y[j * padded + i];
        if (symmetric)
          for (int j = 0; j < n; ++j) line[j] += Y[i * padded + j];
      }
      terms.P = outer.P;
      terms.A = along;
      for (int i = 0; i < 6 * padded; ++i) {
        terms.R[static_cast<std::size_t>(i)] = outer.R[i];
        terms.L[static_cast<std::size_t>(i)] = symmetric ? outer.R[i] : outer.L[i];
      }
    }
  }
}

void SweepBack(const RodModel& model, RodWork& work) { sweep<false>(model, work); }
void SweepBackWithHessian(const RodModel& model, RodWork& work) { sweep<true>(model, work); }

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::strain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1::strain {

HWY_EXPORT(SweepOut);
HWY_EXPORT(SweepBack);
HWY_EXPORT(SweepBackWithHessian);

void sweep_out(const RodModel& model, RodWork& work) { HWY_DYNAMIC_DISPATCH(SweepOut)(model, work); }
void sweep_back(const RodModel& model, RodWork& work) { HWY_DYNAMIC_DISPATCH(SweepBack)(model, work); }
void sweep_back_with_hessian(const RodModel& model, RodWork& work) {
  HWY_DYNAMIC_DISPATCH(SweepBackWithHessian)(model, work);
}

}  // namespace sinew::inline v1::strain
#endif
