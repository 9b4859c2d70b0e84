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
      for (int j = i / row * row; j < padded; j += row) lanes(line + j) -= l * lanes(pivot + j);
    }
    H[k * padded + k] = inverse;
  }
  return found;
}
/// The same with rows exchanged; below the diagonal stays L. `negative` changes with the determinant's sign.
HWY_INLINE bool factor_general(double* H, int n, int padded, int* pivots, int& negative) {
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(H[i * padded + k]) > std::abs(H[best * padded + k])) best = i;
    pivots[k] = best;
    if ((H[best * padded + k] < 0) != (best != k)) negative = 1 - negative;
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

/// In place: eight columns; rows are `stride` numbers apart.
HWY_INLINE void substitute(const PieceTerms& terms, int n, int padded, bool symmetric, double* x,
                           int stride) {
  const double* H = terms.factor.data();
  if (symmetric) {
    for (int k = 0; k < n; ++k) {
      const double *pivot = H + k * padded, inverse = pivot[k];
      const Lanes from = inverse * lanes(x + k * stride);
      for (int i = k + 1; i < n; ++i) lanes(x + i * stride) -= pivot[i] * from;
    }
  } else {
    for (int k = 0; k < n; ++k) {
      const int other = terms.pivots[static_cast<std::size_t>(k)];
      if (other == k) continue;
      const Lanes one = lanes(x + k * stride);
      lanes(x + k * stride) = lanes(x + other * stride);
      lanes(x + other * stride) = one;
    }
    for (int k = 0; k < n; ++k) {
      const Lanes from = lanes(x + k * stride);
      for (int i = k + 1; i < n; ++i) lanes(x + i * stride) -= H[i * padded + k] * from;
    }
  }
  for (int k = n; k-- > 0;) {
    const double* pivot = H + k * padded;
    Lanes sum = lanes(x + k * stride);
    for (int i = k + 1; i < n; ++i) sum -= pivot[i] * lanes(x + i * stride);
    lanes(x + k * stride) = pivot[k] * sum;
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
      multiply_rows<false>(rest, G, padded, T);  // P̃ Γ
      add_product(G, T, n, padded, H);
      multiply_rows_back<true>(terms.A, T, padded, R);
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
        multiply_rows_back<false>(rest, G, padded, T);
        multiply_rows_back<true>(terms.A, T, padded, U);
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
    } else if (!factor_general(H, n, padded, terms.pivots.data(), inertia.negative)) {
      inertia.ok = false;
      return;
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < 6; ++j) side[i * row + j] = L[j * padded + i];
      side[i * row + 6] = side[i * row + 7] = 0;
    }
    substitute(terms, n, padded, work.symmetric, side, row);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 6; ++j) F[j * padded + i] = side[i * row + j];
    for (int i = 0; i < 6; ++i)  // P̃ = P̂ − R̂ Ĥ⁻¹ L̂
      for (int l = 0; l < n; ++l) {
        const double x = R[i * padded + l];
        lanes(P.a[i]) -= x * lanes(side + l * row);
      }
    rest = P;
  }
}

/// Eight columns.
HWY_INLINE void solve_columns(const RodModel& model, RodWork& work, double* sides, int stride) {
  Lanes carried[6] = {}, twist[6] = {}, next[6];
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size, padded = piece.padded;
    const PieceTerms& terms = work.pieces[k];
    double* x = sides + piece.first * stride;
    const double *G = terms.G.data(), *R = terms.fed.data();
    if (k + 1 < model.pieces.size())
      for (int i = 0; i < n; ++i)
        for (int l = 0; l < 6; ++l) lanes(x + i * stride) -= G[l * padded + i] * carried[l];
    substitute(terms, n, padded, work.symmetric, x, stride);
    if (k == 0) break;
    for (int i = 0; i < 6; ++i) {
      Lanes sum = terms.A.a[0][i] * carried[0];
      for (int l = 1; l < 6; ++l) sum += terms.A.a[l][i] * carried[l];
      for (int l = 0; l < n; ++l) sum += R[i * padded + l] * lanes(x + l * stride);
      next[i] = sum;
    }
    for (int i = 0; i < 6; ++i) carried[i] = next[i];
  }
  for (std::size_t k = 0; k < model.pieces.size(); ++k) {
    const Piece& piece = model.pieces[k];
    const int n = piece.size, padded = piece.padded;
    const PieceTerms& terms = work.pieces[k];
    double* x = sides + piece.first * stride;
    const double *G = terms.G.data(), *F = terms.fed.data() + 6 * padded;
    if (k > 0)
      for (int i = 0; i < n; ++i) {
        Lanes sum = lanes(x + i * stride);
        for (int l = 0; l < 6; ++l) sum -= F[l * padded + i] * twist[l];
        lanes(x + i * stride) = sum;
      }
    if (k + 1 == model.pieces.size()) break;
    for (int i = 0; i < 6; ++i) {
      Lanes sum = terms.A.a[i][0] * twist[0];
      for (int l = 1; l < 6; ++l) sum += terms.A.a[i][l] * twist[l];
      for (int l = 0; l < n; ++l) sum += G[i * padded + l] * lanes(x + l * stride);
      next[i] = sum;
    }
    for (int i = 0; i < 6; ++i) twist[i] = next[i];
  }
}

HWY_INLINE double sum_of(Lanes x) {
  double s[row];
  lanes(s) = x;
  return ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]));
}

/// As substitute(), one column.
HWY_INLINE void substitute_one(const PieceTerms& terms, int n, int padded, bool symmetric, double* x) {
  const double* H = terms.factor.data();
  if (symmetric) {
    for (int k = 0; k < n; ++k) {
      const double *pivot = H + k * padded, from = pivot[k] * x[k];
      for (int i = k + 1; i < n; ++i) x[i] -= pivot[i] * from;
    }
  } else {
    for (int k = 0; k < n; ++k) std::swap(x[k], x[terms.pivots[static_cast<std::size_t>(k)]]);
    for (int k = 0; k < n; ++k)
      for (int i = k + 1; i < n; ++i) x[i] -= H[i * padded + k] * x[k];
  }
  for (int k = n; k-- > 0;) {
    const double* pivot = H + k * padded;
    double sums[4] = {x[k], 0, 0, 0};
    int i = k + 1;
    for (; i + 3 < n; i += 4)
      for (int j = 0; j < 4; ++j) sums[j] -= pivot[i + j] * x[i + j];
    for (; i < n; ++i) sums[1] -= pivot[i] * x[i];
    x[k] = pivot[k] * ((sums[0] + sums[2]) + (sums[1] + sums[3]));
  }
}

/// One column: eight coordinates at a time.
HWY_INLINE void solve_column(const RodModel& model, RodWork& work, double* side, int stride) {
  double carried[6] = {}, twist[6] = {}, next[6];
  alignas(64) double x[max_piece];
  const auto load = [&](const Piece& piece) {
    for (int i = 0; i < piece.size; ++i) x[i] = side[(piece.first + i) * stride];
    for (int i = piece.size; i < piece.padded; ++i) x[i] = 0;
  };
  const auto store = [&](const Piece& piece) {
    for (int i = 0; i < piece.size; ++i) side[(piece.first + i) * stride] = x[i];
  };
  const auto along = [&](const double* line, int padded) {
    Lanes sum = lanes(line) * lanes(x);
    for (int j = row; j < padded; j += row) sum += lanes(line + j) * lanes(x + j);
    return sum_of(sum);
  };
  const auto take = [&](const double* rows_of, int padded, const double* by) {
    for (int j = 0; j < padded; j += row) {
      Lanes sum = lanes(x + j);
      for (int l = 0; l < 6; ++l) sum -= by[l] * lanes(rows_of + l * padded + j);
      lanes(x + j) = sum;
    }
  };
  for (std::size_t k = model.pieces.size(); k-- > 0;) {
    const Piece& piece = model.pieces[k];
    const int padded = piece.padded;
    const PieceTerms& terms = work.pieces[k];
    load(piece);
    if (k + 1 < model.pieces.size()) take(terms.G.data(), padded, carried);
    substitute_one(terms, piece.size, padded, work.symmetric, x);
    store(piece);
    if (k == 0) break;
    for (int i = 0; i < 6; ++i) {
      double sum = along(terms.fed.data() + i * padded, padded);
      for (int l = 0; l < 6; ++l) sum += terms.A.a[l][i] * carried[l];
      next[i] = sum;
    }
    for (int i = 0; i < 6; ++i) carried[i] = next[i];
  }
  for (std::size_t k = 0; k < model.pieces.size(); ++k) {
    const Piece& piece = model.pieces[k];
    const int padded = piece.padded;
    const PieceTerms& terms = work.pieces[k];
    load(piece);
    if (k > 0) {
      take(terms.fed.data() + 6 * padded, padded, twist);
      store(piece);
    }
    if (k + 1 == model.pieces.size()) break;
    for (int i = 0; i < 6; ++i) {
      double sum = along(terms.G.data() + i * padded, padded);
      for (int l = 0; l < 6; ++l) sum += terms.A.a[i][l] * twist[l];
      next[i] = sum;
    }
    for (int i = 0; i < 6; ++i) twist[i] = next[i];
  }
}

void Solve(const RodModel& model, RodWork& work, double* sides, int columns, int stride) {
  if (columns == 1) {
    solve_column(model, work, sides, stride);
    return;
  }
  for (int j = 0; j < columns; j += row) solve_columns(model, work, sides + j, stride);
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
