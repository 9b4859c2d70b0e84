// Compiled once for each instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "strain/condense.cpp"
#include "base/instruction_sets.hpp"  // must come before foreach_target.h

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "strain/condense.hpp"
#include "strain/twist-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::strain {
namespace HWY_NAMESPACE {

/// Gaussian elimination of a symmetric matrix; above the diagonal stays D Lᵀ, on it 1/D.
HWY_INLINE Inertia factor_symmetric(double* H, int n, int padded) {
  Inertia found{true, 0};
  for (int k = 0; k < n; ++k) {
    const double* pivot = H + k * padded;
    const double d = pivot[k];
    if (!(std::abs(d) > 1e-12)) return {false, found.negative};  // the rod's elastic energy has 1 here
    if (d < 0) ++found.negative;
    const double inverse = 1 / d;
    for (int i = k + 1; i < n; ++i) {
      const double l = pivot[i] * inverse;
      double* line = H + i * padded;
      for (int j = i / row * row; j < padded; ++j) line[j] -= l * pivot[j];
    }
    H[k * padded + k] = inverse;
  }
  return found;
}
/// The same with rows exchanged; below the diagonal stays L.
HWY_INLINE bool factor_general(double* H, int n, int padded, int* pivots) {
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(H[i * padded + k]) > std::abs(H[best * padded + k])) best = i;
    pivots[k] = best;
    if (!(std::abs(H[best * padded + k]) > 1e-12)) return false;
    if (best != k)
      for (int j = 0; j < padded; ++j) std::swap(H[best * padded + j], H[k * padded + j]);
    const double inverse = 1 / H[k * padded + k];
    H[k * padded + k] = inverse;
    for (int i = k + 1; i < n; ++i) {
      const double l = H[i * padded + k] * inverse;
      H[i * padded + k] = l;
      for (int j = k + 1; j < n; ++j) H[i * padded + j] -= l * H[k * padded + j];
    }
  }
  return true;
}

/// In place; rows of `stride` numbers, of which the first `width` count.
HWY_INLINE void substitute(const PieceTerms& terms, int n, int padded, bool symmetric, double* x, int width,
                           int stride) {
  const double* H = terms.factor.data();
  if (symmetric) {
    for (int k = 0; k < n; ++k) {
      const double *pivot = H + k * padded, inverse = pivot[k];
      const double* from = x + k * stride;
      for (int i = k + 1; i < n; ++i) {
        const double l = pivot[i] * inverse;
        double* to = x + i * stride;
        for (int j = 0; j < width; ++j) to[j] -= l * from[j];
      }
    }
  } else {
    for (int k = 0; k < n; ++k) {
      const int other = terms.pivots[static_cast<std::size_t>(k)];
      if (other != k)
        for (int j = 0; j < width; ++j) std::swap(x[k * stride + j], x[other * stride + j]);
    }
    for (int k = 0; k < n; ++k) {
      const double* from = x + k * stride;
      for (int i = k + 1; i < n; ++i) {
        const double l = H[i * padded + k];
        double* to = x + i * stride;
        for (int j = 0; j < width; ++j) to[j] -= l * from[j];
      }
    }
  }
  for (int k = n; k-- > 0;) {
    const double* pivot = H + k * padded;
    double* to = x + k * stride;
    for (int i = k + 1; i < n; ++i) {
      const double u = pivot[i];
      const double* from = x + i * stride;
      for (int j = 0; j < width; ++j) to[j] -= u * from[j];
    }
    for (int j = 0; j < width; ++j) to[j] *= pivot[k];
  }
}

/// sum += aᵀ b of rows: (6 × n)ᵀ… each 6 × padded, as 6 × 6.
HWY_INLINE void add_outer_products(const double* a, const double* b, int n, double scale, Block& sum) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double s = 0;
      for (int k = 0; k < n; ++k) s += a[i * n + k] * b[j * n + k];
      sum.a[i][j] += scale * s;
    }
}

void Factor(const RodModel& model, RodWork& work, double shift, Inertia& inertia) {
  inertia = {true, 0};
  Block rest;  // of all pieces after this one, eliminated
  clear(rest);
  alignas(64) double T[6 * max_piece], U[6 * max_piece], side[max_piece * row];
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size, padded = piece.padded, rows = 6 * padded;
    PieceTerms& terms = work.pieces[k];
    const bool is_last = k + 1 == model.pieces.size();
    double* H = terms.factor.data();
    for (int i = 0; i < n * padded; ++i) H[i] = terms.H[static_cast<std::size_t>(i)];
    double *R = terms.fed.data(), *F = R + rows;
    for (int i = 0; i < rows; ++i) R[i] = terms.R[static_cast<std::size_t>(i)];
    Block P = terms.P;
    if (!is_last) {
      const double* G = terms.G.data();
      for (int i = 0; i < rows; ++i) T[i] = 0;
      for (int i = 0; i < 6; ++i)  // P̃ Γ
        for (int l = 0; l < 6; ++l) {
          const double x = rest.a[i][l];
          for (int j = 0; j < padded; ++j) T[i * padded + j] += x * G[l * padded + j];
        }
      for (int i = 0; i < n; ++i)
        for (int l = 0; l < 6; ++l) {
          const double x = G[l * padded + i];
          for (int j = 0; j < padded; ++j) H[i * padded + j] += x * T[l * padded + j];
        }
      for (int i = 0; i < 6; ++i)
        for (int l = 0; l < 6; ++l) {
          const double x = terms.A.a[l][i];
          for (int j = 0; j < padded; ++j) R[i * padded + j] += x * T[l * padded + j];
        }
      Block PA, APA;
      multiply(rest, terms.A, PA);
      multiply_back(terms.A, PA, APA);
      add(P, APA, 1);
    }
    const double* L = R;
    if (!work.symmetric) {
      for (int i = 0; i < rows; ++i) U[i] = terms.L[static_cast<std::size_t>(i)];
      if (!is_last) {
        const double* G = terms.G.data();
        for (int i = 0; i < rows; ++i) T[i] = 0;
        for (int i = 0; i < 6; ++i)
          for (int l = 0; l < 6; ++l) {
            const double x = rest.a[l][i];
            for (int j = 0; j < padded; ++j) T[i * padded + j] += x * G[l * padded + j];
          }
        for (int i = 0; i < 6; ++i)
          for (int l = 0; l < 6; ++l) {
            const double x = terms.A.a[l][i];
            for (int j = 0; j < padded; ++j) U[i * padded + j] += x * T[l * padded + j];
          }
      }
      L = U;
    }
    for (int i = 0; i < n; ++i) H[i * padded + i] += shift;
    if (work.symmetric) {
      const Inertia one = factor_symmetric(H, n, padded);
      inertia.negative += one.negative;
      if (!one.ok) {
        inertia.ok = false;
        return;
      }
    } else if (!factor_general(H, n, padded, terms.pivots.data())) {
      inertia.ok = false;
      return;
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < 6; ++j) side[i * row + j] = L[j * padded + i];
      side[i * row + 6] = side[i * row + 7] = 0;
    }
    substitute(terms, n, padded, work.symmetric, side, row, row);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 6; ++j) F[j * padded + i] = side[i * row + j];
    for (int i = 0; i < 6; ++i)  // P̃ = P̂ − R̂ Ĥ⁻¹ L̂
      for (int l = 0; l < n; ++l) {
        const double x = R[i * padded + l];
        for (int j = 0; j < row; ++j) P.a[i][j] -= x * side[l * row + j];
      }
    rest = P;
  }
}

void Solve(const RodModel& model, RodWork& work, double* sides, int columns, int stride) {
  const int width = std::min((columns + row - 1) / row * row, stride);
  alignas(64) double carried[6][64], next[6][64];
  for (auto& line : carried)
    for (double& x : line) x = 0;
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size, padded = piece.padded;
    const PieceTerms& terms = work.pieces[k];
    double* x = sides + piece.first * stride;
    const double *G = terms.G.data(), *R = terms.fed.data();
    for (int i = 0; i < n; ++i)
      for (int l = 0; l < 6; ++l) {
        const double g = G[l * padded + i];
        for (int j = 0; j < width; ++j) x[i * stride + j] -= g * carried[l][j];
      }
    substitute(terms, n, padded, work.symmetric, x, width, stride);
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < width; ++j) next[i][j] = 0;
      for (int l = 0; l < 6; ++l) {
        const double a = terms.A.a[l][i];
        for (int j = 0; j < width; ++j) next[i][j] += a * carried[l][j];
      }
      for (int l = 0; l < n; ++l) {
        const double r = R[i * padded + l];
        for (int j = 0; j < width; ++j) next[i][j] += r * x[l * stride + j];
      }
    }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < width; ++j) carried[i][j] = next[i][j];
  }
  double(*twist)[64] = carried;  // of the base: none
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < width; ++j) twist[i][j] = 0;
  for (std::size_t k = 0; k < model.pieces.size(); ++k) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size, padded = piece.padded;
    const PieceTerms& terms = work.pieces[k];
    double* x = sides + piece.first * stride;
    const double *G = terms.G.data(), *F = terms.fed.data() + 6 * padded;
    if (k > 0)
      for (int i = 0; i < n; ++i)
        for (int l = 0; l < 6; ++l) {
          const double f = F[l * padded + i];
          for (int j = 0; j < width; ++j) x[i * stride + j] -= f * twist[l][j];
        }
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < width; ++j) next[i][j] = 0;
      for (int l = 0; l < 6; ++l) {
        const double a = terms.A.a[i][l];
        for (int j = 0; j < width; ++j) next[i][j] += a * twist[l][j];
      }
      for (int l = 0; l < n; ++l) {
        const double g = G[i * padded + l];
        for (int j = 0; j < width; ++j) next[i][j] += g * x[l * stride + j];
      }
    }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < width; ++j) twist[i][j] = next[i][j];
  }
}

void TipTwists(const RodModel& model, const RodWork& work, double* rows) {
  Block along;
  clear(along);
  for (int i = 0; i < 6; ++i) along.a[i][i] = 1;
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    const PieceTerms& terms = work.pieces[k];
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < piece.size; ++j) {
        double sum = 0;
        for (int l = 0; l < 6; ++l)
          sum += along.a[i][l] * terms.G[static_cast<std::size_t>(l * piece.padded + j)];
        rows[i * model.size + piece.first + j] = sum;
      }
    Block next;
    multiply(along, terms.A, next);
    along = next;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::strain
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew::inline v1::strain {

HWY_EXPORT(Factor);
HWY_EXPORT(Solve);
HWY_EXPORT(TipTwists);

Inertia factor(const RodModel& model, RodWork& work, double shift) {
  Inertia inertia;
  HWY_DYNAMIC_DISPATCH(Factor)(model, work, shift, inertia);
  return inertia;
}
void solve(const RodModel& model, RodWork& work, double* sides, int columns, int stride) {
  HWY_DYNAMIC_DISPATCH(Solve)(model, work, sides, columns, stride);
}
void tip_twists(const RodModel& model, const RodWork& work, double* rows) {
  HWY_DYNAMIC_DISPATCH(TipTwists)(model, work, rows);
}

}  // namespace sinew::inline v1::strain
#endif
