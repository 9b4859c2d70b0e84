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

/// From the node at hand to the end of the piece, an element earlier.
HWY_INLINE void carry_along(const Block& A, Block& along) {
  Block next;
  multiply(along, A, next);
  along = next;
}

/// Tendons from a span's first disc to its last.
template <bool hessian>
HWY_INLINE void add_holes(const RodModel& model, const RodWork& work, const Span& span, bool by_lengths,
                          Rest& inner, Eight* eights) {
  const int last = span.first_element + span.elements;
  for (int i = 0; i < span.holes; ++i) {
    const auto at = static_cast<std::size_t>(span.first_hole + i);
    const double tension = work.hole_tension[at];
    double one[6];
    hole_terms(work.frames[static_cast<std::size_t>(span.first_element)],
               work.frames[static_cast<std::size_t>(last)], model.holes[at], tension, one,
               hessian ? &inner.P : nullptr);
    for (int j = 0; j < 6; ++j) inner.lambda[j] += tension * one[j];
    if (by_lengths)
      for (int j = 0; j < 6; ++j) eights[i / row].by_twist.a[j][i % row] = one[j];
  }
}

/// Of Ω by the strains at two Gauss points.
HWY_INLINE void omega_by_strains(const Element& element, const std::array<Six, 2>& xi, Block* D) {
  for (int g = 0; g < 2; ++g) {
    clear(D[g]);
    for (int i = 0; i < 6; ++i) D[g].a[i][i] = 0.5 * element.length;
    add_ad(D[g], xi[static_cast<std::size_t>(1 - g)].data(),
           g == 0 ? -element.commutator : element.commutator);
  }
}

/// The Hessian by an element's strains of what lies after it.
/// @param sum by the twist of its end
HWY_INLINE void curvature_by_strains(const Element& element, const Block& sum, const Block& J, const Block* D,
                                     const double* omega, const double* lambda, const double* by_omega,
                                     const Entire& fn, Block (&E)[2][2]) {
  Block Q, PJ;
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

/// An element's own elasticity and its guided tendons at a Gauss point.
template <bool hessian>
HWY_INLINE void add_strains(const RodModel& model, const Piece& piece, const Element& element, const Six& xi,
                            int g, bool by_lengths, RodWork& work, double* by_strain, Block& E) {
  const auto point = static_cast<std::size_t>(g);
  for (std::size_t c = 0; c < 6; ++c) {
    const double stiff = element.weight * element.stiffness[point][c];
    by_strain[c] += stiff * (xi[c] - element.rest[point][c]);
    if constexpr (hessian) E.a[c][c] += stiff;
  }
  for (int i = element.first_guide; i < element.first_guide + element.guides; ++i) {
    const auto which = static_cast<std::size_t>(i);
    const Guide& guide = model.guides[which];
    const double tension = element.weight * work.guide_tension[which];
    double one[6];
    guide_terms(xi.data(), guide, g, one, tension, hessian ? &E : nullptr);
    for (int j = 0; j < 6; ++j) {
      by_strain[j] += tension * one[j];
      one[j] *= element.weight;
    }
    if (!by_lengths) continue;
    collect(
        piece, element, g, one,
        work.length_gradient.data() + static_cast<std::size_t>(guide.tendon) * work.y.size() + piece.first);
  }
}

/// Of tendons between discs the lengths' gradients by an element's strains.
HWY_INLINE void collect_lengths(const Piece& piece, const Element& element, const Block& J, const Block* D,
                                Eight& eight) {
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
}

/// Γ = Σ J D basis, H += basisᵀ E basis.
HWY_INLINE void add_element(const Piece& piece, const Element& element, const double* basis, const Block& J,
                            const Block* D, const Block (&E)[2][2], double* G, double* more, double* H) {
  const int padded = piece.padded;
  Block JD;
  for (int g = 0; g < element.points; ++g) {
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
        double* line = H + (piece.offset[c] + a) * padded;
        const double* from = more + static_cast<int>(c) * padded;
        for (int j = 0; j < padded; j += row) lanes(line + j) += x * lanes(from + j);
      }
  }
}

/// Γᵀ R, and Γᵀ L where it is not the same.
HWY_INLINE void add_mixed(const Piece& piece, bool symmetric, const Rest& outer, const Rest& inner,
                          const double* G, double* more, double* H, double* Y) {
  const int n = piece.size, padded = piece.padded;
  for (int i = 0; i < 6 * padded; i += row) lanes(more + i) = lanes(outer.R + i) + lanes(inner.R + i);
  add_product(G, more, n, padded, symmetric ? Y : H);
  if (!symmetric) {
    for (int i = 0; i < 6 * padded; i += row) lanes(more + i) = lanes(outer.L + i) + lanes(inner.L + i);
    add_product(G, more, n, padded, Y);
  }
}

/// What a sweep carries from node to node, each by itself where the compiler keeps it in registers.
struct Carried {
  Rest& outer;       ///< all that lies after the node but for
  Rest& inner;       ///< the tendons that end at the next disc
  Eight* eights;     ///< those tendons' lengths
  Block& along;      ///< from the node to the end of the piece
  double *G, *more;  ///< twists of an element's end by the coordinates; scratch
  bool by_lengths, symmetric;
  double* Y;  ///< Γᵀ L, whose transpose belongs to H
};

HWY_INLINE void clear_terms(const Piece& piece, const Carried& carried, PieceTerms& terms) {
  for (double& x : terms.H) x = 0;
  for (int i = 0; i < piece.size * piece.padded; ++i) carried.Y[i] = 0;
  for (double& x : terms.G) x = 0;
  for (int i = 0; i < 6 * piece.padded; ++i) carried.outer.R[i] = carried.outer.L[i] = 0;
  clear(carried.outer.P);
  clear(carried.along);
  for (int i = 0; i < 6; ++i) carried.along.a[i][i] = 1;
}

HWY_INLINE void finish_terms(const Piece& piece, bool symmetric, const Carried& carried, PieceTerms& terms) {
  const int n = piece.size, padded = piece.padded;
  for (int i = 0; i < n; ++i) {
    double* line = terms.H.data() + i * padded;
    for (int j = 0; j < n; ++j) line[j] += carried.Y[j * padded + i];
    if (symmetric)
      for (int j = 0; j < n; ++j) line[j] += carried.Y[i * padded + j];
  }
  terms.P = carried.outer.P;
  terms.A = carried.along;
  for (int i = 0; i < 6 * padded; ++i) {
    terms.R[static_cast<std::size_t>(i)] = carried.outer.R[i];
    terms.L[static_cast<std::size_t>(i)] = symmetric ? carried.outer.R[i] : carried.outer.L[i];
  }
}

/// Nothing is known yet of tendons that end at a span's last disc.
template <bool hessian>
HWY_INLINE void clear_inner(const Piece& piece, int packs, const Carried& carried) {
  for (int i = 0; i < packs; ++i) {
    clear(carried.eights[i].by_twist);
    for (int j = 0; j < piece.size * row; ++j) carried.eights[i].by_coordinates[j] = 0;
  }
  for (double& x : carried.inner.lambda) x = 0;
  if constexpr (hessian) {
    clear(carried.inner.P);
    for (int i = 0; i < 6 * piece.padded; ++i) carried.inner.R[i] = carried.inner.L[i] = 0;
  }
}

/// Over a rigid link, which carries what lies after it, and no more.
/// @param e the link; before the span's first one there is nothing of the tendons that end in it
template <bool hessian>
HWY_INLINE void pass_rigid(const Piece& piece, const Span& span, int e, int packs, const RodWork& work,
                           const Carried& carried) {
  const auto at = static_cast<std::size_t>(e);
  Rest &outer = carried.outer, &inner = carried.inner;
  const double *R = work.steps[at].data(), *p = R + 9;
  Block A;
  if (hessian || packs > 0) back_adjoint(R, p, A);
  if constexpr (hessian) {
    carry_along(A, carried.along);
    carry_rigid(A, piece.padded, carried.symmetric, outer);
    if (span.holes > 0 && e > span.first_element) carry_rigid(A, piece.padded, carried.symmetric, inner);
  }
  carry_back(R, p, outer.lambda, outer.lambda);
  if (e > span.first_element) {
    carry_back(R, p, inner.lambda, inner.lambda);
    for (int i = 0; i < packs; ++i) multiply_back(A, carried.eights[i].by_twist, carried.eights[i].by_twist);
  }
}

/// The gradient by an element's strains of what lies after it.
/// @param lambda that by the twist of its end
HWY_INLINE void find_slopes(const Element& element, const std::array<Six, 2>& xi, const Block& J,
                            const double* lambda, double* by_omega, double (&by_strain)[2][6]) {
  apply_back(J, lambda, by_omega);
  if (element.points == 1)
    std::copy(by_omega, by_omega + 6, by_strain[0]);
  else
    by_strains(element, xi[0].data(), xi[1].data(), by_omega, by_strain[0], by_strain[1]);
}

/// An element's part of its piece's Hessian, and derivatives by twists carried to its start.
/// @param E the Hessian by its strains
HWY_INLINE void pass_hessian(const RodModel& model, const Piece& piece, const Span& span, int e,
                             int piece_end, const Block& A, const Block& J, const Block* D,
                             const Block (&E)[2][2], const Carried& carried, PieceTerms& terms) {
  const Element& element = model.elements[static_cast<std::size_t>(e)];
  const int padded = piece.padded;
  double* G = carried.G;
  add_element(piece, element, model.rows.data() + element.first_row, J, D, E, G, carried.more,
              terms.H.data());
  if (e + 1 < piece_end)  // else no coordinate of the piece lies after it
    add_mixed(piece, carried.symmetric, carried.outer, carried.inner, G, carried.more, terms.H.data(),
              carried.Y);
  multiply_rows<true>(carried.along, G, padded, terms.G.data());  // the piece's end moves by along·Γ
  carry_along(A, carried.along);
  const bool symmetric = carried.symmetric;
  const auto carry = [&](Rest& rest) {  // compiled once: inlined twice it takes 4 % more instructions
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
  carry(carried.outer);
  if (span.holes > 0 && e > span.first_element) carry(carried.inner);
}

/// @param piece_end after the last element of its piece
template <bool hessian>
HWY_INLINE void pass_span(const RodModel& model, const Piece& piece, const Span& span,
                          [[maybe_unused]] int piece_end, RodWork& work, const Carried& carried,
                          [[maybe_unused]] PieceTerms& terms) {
  Rest &outer = carried.outer, &inner = carried.inner;
  const int packs = carried.by_lengths ? (span.holes + row - 1) / row : 0;
  clear_inner<hessian>(piece, packs, carried);
  add_holes<hessian>(model, work, span, packs > 0, inner, carried.eights);
  for (int e = span.first_element + span.elements; e-- > span.first_element;) {
    const auto at = static_cast<std::size_t>(e);
    add_load(work.loads[at + 1], work.loads[at + 1].force, work.frames[at + 1].R, outer.lambda,
             hessian ? &outer.P : nullptr);
    const Element& element = model.elements[at];
    if (element.points == 0) {
      pass_rigid<hessian>(piece, span, e, packs, work, carried);
      continue;
    }
    const auto& xi = work.strains[at];
    const double *R = work.steps[at].data(), *p = R + 9, *omega = work.omega[at].data();
    const Entire fn = entire(dot3(omega + 3, omega + 3));
    double lambda[6], by_omega[6], by_strain[2][6];
    for (int i = 0; i < 6; ++i) lambda[i] = outer.lambda[i] + inner.lambda[i];
    Block J, D[2], A;
    [[maybe_unused]] Block E[2][2];
    right_jacobian(omega, fn, J);
    find_slopes(element, xi, J, lambda, by_omega, by_strain);
    if (hessian || packs > 0) {
      back_adjoint(R, p, A);
      if (element.points == 2) omega_by_strains(element, xi, D);
    }
    if constexpr (hessian) {
      Block sum = outer.P;
      add(sum, inner.P, 1);
      curvature_by_strains(element, sum, J, D, omega, lambda, by_omega, fn, E);
    }
    for (int g = 0; g < element.points; ++g) {
      add_strains<hessian>(model, piece, element, xi[static_cast<std::size_t>(g)], g, carried.by_lengths,
                           work, by_strain[g], E[g][g]);
      collect(piece, element, g, by_strain[g], work.gradient.data() + piece.first);
    }
    for (int i = 0; i < packs; ++i) {
      collect_lengths(piece, element, J, D, carried.eights[i]);
      if (e > span.first_element) multiply_back(A, carried.eights[i].by_twist, carried.eights[i].by_twist);
    }
    if constexpr (hessian) pass_hessian(model, piece, span, e, piece_end, A, J, D, E, carried, terms);
    carry_back(R, p, outer.lambda, outer.lambda);
    if (e > span.first_element) carry_back(R, p, inner.lambda, inner.lambda);
  }
  if (packs > 0) add_columns(model, piece, span, carried.eights, work);
}

template <bool hessian>
HWY_INLINE void sweep(const RodModel& model, RodWork& work) {
  for (double& x : work.gradient) x = 0;
  if (work.finds_length_gradients)
    for (double& x : work.length_gradient) x = 0;
  alignas(64) double rows[6][6 * max_piece];
  Eight eights[most_holes / row];
  Rest outer, inner;
  for (double& x : outer.lambda) x = 0;
  outer.R = rows[0], outer.L = rows[1], inner.R = rows[2], inner.L = rows[3];
  Block along;
  const Carried carried{outer,
                        inner,
                        eights,
                        along,
                        rows[4],
                        rows[5],
                        work.finds_length_gradients,
                        work.symmetric,
                        work.scratch.data()};
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    PieceTerms& terms = work.pieces[k];
    const Span& last = model.spans[static_cast<std::size_t>(piece.first_span + piece.spans - 1)];
    if constexpr (hessian) clear_terms(piece, carried, terms);
    for (int s = piece.first_span + piece.spans; s-- > piece.first_span;)
      pass_span<hessian>(model, piece, model.spans[static_cast<std::size_t>(s)],
                         last.first_element + last.elements, work, carried, terms);
    if constexpr (hessian) finish_terms(piece, work.symmetric, carried, terms);
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
