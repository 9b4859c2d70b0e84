#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "strain/norm.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1::strain {
namespace {

/// Tendons at rest for whose sake all ways to tauten them are tried.
constexpr std::size_t most_resting = 6;

}  // namespace

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

double LoadedRod::lowest_on_face(std::span<double> direction, double& square) {
  double shift = 0;
  for (int tries = 0; factor_all(shift) != 0 && tries < 60; ++tries) shift = shift == 0 ? 1e-3 : 2 * shift;
  const std::size_t n = at(model_->size);
  std::vector<double> x(n * row, 0.0), weighted(n);
  some_direction(direction);
  double value = 0;
  const int most = resting_.empty() ? 30 : 200;  // then signs of products with the direction matter
  for (int round = 0; round < most; ++round) {
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
  square = dot(direction, direction);  // per elastic energy
  if (shift > 0) value *= square;      // of the same direction, over its elastic energy
  const double length = norm(direction);
  for (double& v : direction) v /= length;
  return value;
}

bool LoadedRod::at_rest(std::size_t i) const {
  const TendonHold& hold = holds[i];
  if (hold.by_tension || hold.toe > 0 || yields_.empty()) return false;
  const double bend = std::sqrt(yields_[i]), scale = std::sqrt(model_->energy_scale),
               rounding = 10 * tolerance_;
  return tensions_[i] * bend <= rounding * scale && slack(i) <= rounding * scale * bend;
}

/// The energy's second variation with tendons at rest is ½(vᵀHv + Σ⟨∂ℓ·v⟩²/c): quadratic where the same of
/// them become taut. Its least ratio is an eigenvalue of the quadratic form at whose direction it lies, and
/// the least of that form: so it is among the least of all 2ⁿ forms. Each is told by what the variation truly
/// is at its direction, so that none is too low.
double LoadedRod::lowest(std::span<double> direction) {
  resting_.clear();
  for (std::size_t i = 0; i < holds.size(); ++i)
    if (at_rest(i)) resting_.push_back(i);
  is_bound_ = resting_.size() > most_resting;
  if (is_bound_) resting_.clear();
  is_one_sided_ = !resting_.empty();
  double square = 0;
  if (!is_one_sided_) return lowest_on_face(direction, square);
  const std::size_t n = at(model_->size);
  std::vector<double> here(n);
  double best = std::numeric_limits<double>::infinity(), best_key = best;
  for (unsigned face = 0; face < 1U << resting_.size(); ++face) {
    tautened_ = face;
    const double value = lowest_on_face(here, square);
    for (const double sign : {1.0, -1.0}) {
      double there = value;
      for (std::size_t k = 0; k < resting_.size(); ++k) {
        const double longer = sign * std::sqrt(square) * dot(length_gradient(resting_[k]), here),
                     c = give(resting_[k]);
        const bool counted = (face >> k & 1U) != 0, counts = longer > 0;
        if (counted == counts) continue;
        if (c > 0)
          there += (counts ? 1 : -1) * longer * longer / c;
        else if (counts)  // it does not stretch
          there = std::numeric_limits<double>::infinity();
      }
      // Below 0 the direction is the lowest by its size, not by its elastic energy.
      const double key = there < 0 ? there / square : there;
      if (!(key < best_key)) continue;
      best = there;
      best_key = key;
      for (std::size_t i = 0; i < n; ++i) direction[i] = sign * here[i];
    }
  }
  resting_.clear();
  factor_all(0);
  return best;
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
