// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "strain/tangent.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "strain/tangent.hpp"
#include "strain/twist-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::strain {
namespace HWY_NAMESPACE {

void Tangents(const RodModel& model, const RodWork& work, const double* directions, Tangent& result) {
  clear(result.nodes[0]);
  for (const Piece& piece : model.pieces) {
    const double* z = directions + piece.first * row;
    const int first = model.spans[static_cast<std::size_t>(piece.first_span)].first_element;
    const Span& span = model.spans[static_cast<std::size_t>(piece.first_span + piece.spans - 1)];
    for (int e = first; e < span.first_element + span.elements; ++e) {
      const auto at = static_cast<std::size_t>(e);
      const Element& element = model.elements[at];
      for (int g = 0; g < element.points; ++g) {
        Block& strain = result.strains[at][static_cast<std::size_t>(g)];
        clear(strain);
        const double* modes = element.modes[static_cast<std::size_t>(g)].data();
        for (std::size_t c = 0; c < 6; ++c)
          for (int a = 0; a < piece.modes[c]; ++a) {
            const double x = piece.scale[c] * modes[a];
            const double* from = z + (piece.offset[c] + a) * row;
            for (int j = 0; j < row; ++j) strain.a[c][j] += x * from[j];
          }
      }
      Block omega, A, J;
      if (element.points == 1) {
        omega = result.strains[at][0];
      } else {  // D₁ = h/2 − k ad(ξ₂), D₂ = h/2 + k ad(ξ₁)
        const auto &a = result.strains[at][0], &b = result.strains[at][1];
        const double half = 0.5 * element.length;
        for (int i = 0; i < 6; ++i)
          for (int j = 0; j < row; ++j) omega.a[i][j] = half * (a.a[i][j] + b.a[i][j]);
        Block ad, part;
        clear(ad);
        add_ad(ad, work.strains[at][1].data(), -element.commutator);
        multiply(ad, a, part);
        add(omega, part, 1);
        clear(ad);
        add_ad(ad, work.strains[at][0].data(), element.commutator);
        multiply(ad, b, part);
        add(omega, part, 1);
      }
      const double* w = work.omega[at].data();
      right_jacobian(w, entire(dot3(w + 3, w + 3)), J);
      back_adjoint(work.steps[at].data(), work.steps[at].data() + 9, A);
      Block moved;
      multiply(A, result.nodes[at], result.nodes[at + 1]);
      multiply(J, omega, moved);
      add(result.nodes[at + 1], moved, 1);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::strain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1::strain {

HWY_EXPORT(Tangents);

Tangent::Tangent(const RodModel& model)
    : nodes(static_cast<std::size_t>(model.nodes())),
      strains(model.elements.size()) {}

void tangents(const RodModel& model, const RodWork& work, const double* directions, Tangent& result) {
  HWY_DYNAMIC_DISPATCH(Tangents)(model, work, directions, result);
}

}  // namespace sinew::inline v1::strain
#endif
