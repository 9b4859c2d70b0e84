#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "strain/norm.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1::strain {

/// The elastic energy's second variation at rest times a vector: near the identity, but for taper and for
/// what the quadrature makes of polynomials.
void LoadedRod::elastic(std::span<const double> x, std::span<double> y) const {
  std::ranges::fill(y, 0.0);
  for (const Piece& piece : model_->pieces) {
    const Span& last = model_->spans[at(piece.first_span + piece.spans - 1)];
    for (int e = model_->spans[at(piece.first_span)].first_element; e < last.first_element + last.elements;
         ++e) {
      const Element& element = model_->elements[at(e)];
      for (std::size_t g = 0; g < at(element.points); ++g)
        for (std::size_t c = 0; c < 6; ++c) {
          const std::size_t first = at(piece.first + piece.offset[c]);
          double strain = 0;
          for (std::size_t a = 0; a < at(piece.modes[c]); ++a) strain += element.modes[g][a] * x[first + a];
          strain *= element.weight * element.stiffness[g][c] * piece.scale[c] * piece.scale[c];
          for (std::size_t a = 0; a < at(piece.modes[c]); ++a) y[first + a] += element.modes[g][a] * strain;
        }
    }
  }
}

double LoadedRod::lowest(std::span<double> direction) {
  double shift = 0;
  for (int tries = 0; factor_all(shift) != 0 && tries < 60; ++tries) shift = shift == 0 ? 1e-3 : 2 * shift;
  const std::size_t n = at(model_->size);
  std::vector<double> x(n * row, 0.0), weighted(n);
  some_direction(direction);
  double value = 0;
  for (int round = 0; round < 30; ++round) {
    elastic(direction, weighted);
    const double size = dot(direction, weighted);  // in elastic energy; 1 from the second round on
    // With a shift it is the Hessian's lowest direction, else that of its ratio to the elastic energy.
    const std::span<const double> side = shift > 0 ? direction : std::span<double>(weighted);
    for (std::size_t i = 0; i < n; ++i) x[i * row] = side[i];
    solve_all(x, 1, row);
    double along = 0;
    for (std::size_t i = 0; i < n; ++i) along += x[i * row] * side[i];
    const double before = shift > 0 ? dot(direction, direction) : size, next = before / along - shift;
    for (std::size_t i = 0; i < n; ++i) direction[i] = x[i * row];
    elastic(direction, weighted);
    const double length = std::sqrt(dot(direction, weighted));
    for (double& v : direction) v /= length;
    const bool ends = round > 2 && std::abs(next - value) < 1e-9 * (std::abs(next) + shift + 1e-3);
    value = next;
    if (ends) break;
  }
  if (shift > 0) value *= dot(direction, direction);  // of the same direction, over its elastic energy
  const double length = norm(direction);
  for (double& v : direction) v /= length;
  return value;
}

void make_symmetric(const RodModel& model, RodWork& work) {
  for (std::size_t k = 0; k < model.pieces.size(); ++k) {
    const Piece& piece = model.pieces[k];
    PieceTerms& terms = work.pieces[k];
    for (int i = 0; i < piece.size; ++i)
      for (int j = 0; j < i; ++j) {
        double &a = terms.H[at(i * piece.padded + j)], &b = terms.H[at(j * piece.padded + i)];
        a = b = 0.5 * (a + b);
      }
    for (std::size_t i = 0; i < terms.R.size(); ++i)
      terms.R[i] = terms.L[i] = 0.5 * (terms.R[i] + terms.L[i]);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j)
        terms.P.a[i][j] = terms.P.a[j][i] = 0.5 * (terms.P.a[i][j] + terms.P.a[j][i]);
  }
  work.symmetric = true;
}

}  // namespace sinew::inline v1::strain
