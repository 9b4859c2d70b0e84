/// @file twist-inl.hpp
/// Twists, wrenches and rigid motions as plain numbers, compiled for each instruction set. Theory:
/// docs/theory/strain_rod.md
#if defined(SINEW_STRAIN_TWIST_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_STRAIN_TWIST_INL_HPP_
#undef SINEW_STRAIN_TWIST_INL_HPP_
#else
#define SINEW_STRAIN_TWIST_INL_HPP_
#endif
#include <hwy/highway.h>

#include <cmath>

#include "strain/rod_model.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::strain {
namespace HWY_NAMESPACE {

/// Eight numbers of a row, anywhere in memory: the compiler splits them as the instruction set has it.
using Lanes [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;
HWY_INLINE Lanes& lanes(double* x) { return *reinterpret_cast<Lanes*>(x); }
HWY_INLINE const Lanes& lanes(const double* x) { return *reinterpret_cast<const Lanes*>(x); }

inline double root(double x) { return std::sqrt(x); }

// What follows is of numbers of any kind: of one rod, or of a lane a rod. The constants of a model, which all
// lanes share, are always of one.

template <class A, class B>
HWY_INLINE auto dot3(const A* a, const B* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class A, class B, class C>
HWY_INLINE void cross3(const A* a, const B* b, C* c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}
/// R u and Rᵀ u.
template <class A, class B, class C>
HWY_INLINE void turn3(const A* R, const B* u, C* v) {
  for (int i = 0; i < 3; ++i) v[i] = R[3 * i] * u[0] + R[3 * i + 1] * u[1] + R[3 * i + 2] * u[2];
}
template <class A, class B, class C>
HWY_INLINE void turn_back3(const A* R, const B* u, C* v) {
  for (int i = 0; i < 3; ++i) v[i] = R[i] * u[0] + R[3 + i] * u[1] + R[6 + i] * u[2];
}
template <class T>
HWY_INLINE void multiply3(const T* a, const T* b, T* c) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}
/// block + scale [u], at (i, j) of a 6×6.
template <class Square, class T, class Scale>
HWY_INLINE void add_skew(Square& b, int i, int j, const T* u, Scale scale) {
  b.a[i][j + 1] -= scale * u[2];
  b.a[i][j + 2] += scale * u[1];
  b.a[i + 1][j] += scale * u[2];
  b.a[i + 1][j + 2] -= scale * u[0];
  b.a[i + 2][j] -= scale * u[1];
  b.a[i + 2][j + 1] += scale * u[0];
}

template <class Square>
HWY_INLINE void clear(Square& b) {
  for (auto& line : b.a)
    for (auto& x : line) x = 0;
}
/// c = a b.
HWY_INLINE void multiply(const Block& a, const Block& b, Block& c) {
  for (int i = 0; i < 6; ++i) {
    Lanes sum = a.a[i][0] * lanes(b.a[0]);
    for (int k = 1; k < 6; ++k) sum += a.a[i][k] * lanes(b.a[k]);
    lanes(c.a[i]) = sum;
  }
}
/// c = aᵀ b.
HWY_INLINE void multiply_back(const Block& a, const Block& b, Block& c) {
  Lanes in[6];  // c may be b
  for (int k = 0; k < 6; ++k) in[k] = lanes(b.a[k]);
  for (int i = 0; i < 6; ++i) {
    Lanes sum = a.a[0][i] * in[0];
    for (int k = 1; k < 6; ++k) sum += a.a[k][i] * in[k];
    lanes(c.a[i]) = sum;
  }
}
HWY_INLINE void add(Block& a, const Block& b, double scale) {
  for (int i = 0; i < 6; ++i) lanes(a.a[i]) += scale * lanes(b.a[i]);
}
/// rows (+)= b times more rows, 6 × padded.
template <bool add>
HWY_INLINE void multiply_rows(const Block& b, const double* from, int padded, double* to) {
  for (int j = 0; j < padded; j += row) {
    Lanes in[6];
    for (int k = 0; k < 6; ++k) in[k] = lanes(from + k * padded + j);
    for (int i = 0; i < 6; ++i) {
      Lanes sum = b.a[i][0] * in[0];
      for (int k = 1; k < 6; ++k) sum += b.a[i][k] * in[k];
      if constexpr (add)
        lanes(to + i * padded + j) += sum;
      else
        lanes(to + i * padded + j) = sum;
    }
  }
}
/// rows (+)= bᵀ times more rows.
template <bool add>
HWY_INLINE void multiply_rows_back(const Block& b, const double* from, int padded, double* to) {
  for (int j = 0; j < padded; j += row) {
    Lanes in[6];
    for (int k = 0; k < 6; ++k) in[k] = lanes(from + k * padded + j);
    for (int i = 0; i < 6; ++i) {
      Lanes sum = b.a[0][i] * in[0];
      for (int k = 1; k < 6; ++k) sum += b.a[k][i] * in[k];
      if constexpr (add)
        lanes(to + i * padded + j) += sum;
      else
        lanes(to + i * padded + j) = sum;
    }
  }
}
/// square += leftᵀ right, of 6 × padded rows each; n rows of it.
HWY_INLINE void add_product(const double* left, const double* right, int n, int padded, double* square) {
  for (int j = 0; j < padded; j += row) {
    Lanes in[6];
    for (int k = 0; k < 6; ++k) in[k] = lanes(right + k * padded + j);
    for (int i = 0; i < n; ++i) {
      Lanes sum = left[i] * in[0];
      for (int k = 1; k < 6; ++k) sum += left[k * padded + i] * in[k];
      lanes(square + i * padded + j) += sum;
    }
  }
}

/// v = a u, v = aᵀ u of six numbers.
HWY_INLINE void apply(const Block& a, const double* u, double* v) {
  for (int i = 0; i < 6; ++i) {
    double sum = 0;
    for (int k = 0; k < 6; ++k) sum += a.a[i][k] * u[k];
    v[i] = sum;
  }
}
HWY_INLINE void apply_back(const Block& a, const double* u, double* v) {
  double sum[6] = {};
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < 6; ++i) sum[i] += a.a[k][i] * u[k];
  for (int i = 0; i < 6; ++i) v[i] = sum[i];
}

/// b + scale Φ(λ), the form with aᵀ Φ b = λ·[a, b].
template <class Square, class T>
HWY_INLINE void add_bracket(Square& b, const T* lambda, double scale) {
  add_skew(b, 0, 3, lambda, -scale);
  add_skew(b, 3, 0, lambda, -scale);
  add_skew(b, 3, 3, lambda + 3, -scale);
}
/// ad: [ω 0-3, v; 0, ω] of a strain or twist.
template <class Square, class T>
HWY_INLINE void add_ad(Square& b, const T* xi, double scale) {
  add_skew(b, 0, 0, xi + 3, scale);
  add_skew(b, 0, 3, xi, scale);
  add_skew(b, 3, 3, xi + 3, scale);
}

/// (1 − cos θ)/θ² and (θ − sin θ)/θ³ as functions of s = θ², with two derivatives by s, and sinc.
template <class T>
struct EntireOf {
  T sinc, a, b, da, db, dda, ddb;
};
using Entire = EntireOf<double>;

/// Up to here the series below is exact to rounding.
inline constexpr double series_end = 2;

/// By their series, Σ (−s)ᵏ/(2k+2)! and Σ (−s)ᵏ/(2k+3)!
template <class T>
HWY_INLINE EntireOf<T> entire_series(T s) {
  constexpr int terms = 11;
  constexpr auto coefficients = [](int first) {
    std::array<double, terms> c{};
    double factorial = 1;
    for (int i = 2; i <= first; ++i) factorial *= i;
    for (int k = 0; k < terms; ++k) {
      c[static_cast<std::size_t>(k)] = (k % 2 == 0 ? 1 : -1) / factorial;
      factorial *= (first + 2 * k + 1) * (first + 2.0 * k + 2);
    }
    return c;
  };
  constexpr auto ca = coefficients(2), cb = coefficients(3);
  T a = 0, b = 0, da = 0, db = 0, dda = 0, ddb = 0;  // Horner with its derivatives
  for (int k = terms - 1; k >= 0; --k) {
    dda = dda * s + 2 * da;
    ddb = ddb * s + 2 * db;
    da = da * s + a;
    db = db * s + b;
    a = a * s + ca[static_cast<std::size_t>(k)];
    b = b * s + cb[static_cast<std::size_t>(k)];
  }
  return {1 - s * b, a, b, da, db, dda, ddb};
}
HWY_INLINE Entire entire(double s) {
  if (s < series_end) return entire_series(s);
  Entire e;
  const double t = std::sqrt(s), sine = std::sin(t), cosine = std::cos(t), half = 0.5 / s;
  e.sinc = sine / t;
  e.a = (1 - cosine) / s;
  e.b = (1 - e.sinc) / s;
  const double dsinc = (cosine - e.sinc) * half;
  e.da = (e.sinc - 2 * e.a) * half;
  e.db = (e.a - 3 * e.b) * half;
  e.dda = (dsinc - 2 * e.da) * half - e.da / s;
  e.ddb = (e.da - 3 * e.db) * half - e.db / s;
  return e;
}

/// exp Ω: rotation and translation.
template <class T>
HWY_INLINE void exponential(const T* omega, T* R, T* p) {
  const T *v = omega, *w = omega + 3;
  const auto e = entire(dot3(w, w));
  const T s = dot3(w, w), wv = dot3(w, v);
  T c[3];
  cross3(w, v, c);
  for (int i = 0; i < 3; ++i) p[i] = v[i] + e.a * c[i] + e.b * (w[i] * wv - s * v[i]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R[3 * i + j] = e.a * w[i] * w[j];
  const T diagonal = 1 - e.a * s;
  for (int i = 0; i < 3; ++i) R[4 * i] += diagonal;
  R[1] -= e.sinc * w[2];
  R[2] += e.sinc * w[1];
  R[3] += e.sinc * w[2];
  R[5] -= e.sinc * w[0];
  R[6] -= e.sinc * w[1];
  R[7] += e.sinc * w[0];
}

/// A = Ad of the motion back: what a twist at the start is at the end.
template <class T, class Square>
HWY_INLINE void back_adjoint(const T* R, const T* p, Square& A) {
  clear(A);
  for (int i = 0; i < 3; ++i) {
    const T column[3] = {R[i], R[3 + i], R[6 + i]};
    T c[3];
    cross3(column, p, c);  // row i of Rᵀ [p]
    for (int j = 0; j < 3; ++j) {
      A.a[i][j] = A.a[i + 3][j + 3] = column[j];
      A.a[i][j + 3] = -c[j];
    }
  }
}
/// Aᵀ λ.
template <class T>
HWY_INLINE void carry_back(const T* R, const T* p, const T* lambda, T* out) {
  T f[3], m[3], c[3];
  turn3(R, lambda, f);
  turn3(R, lambda + 3, m);
  cross3(p, f, c);
  for (int i = 0; i < 3; ++i) {
    out[i] = f[i];
    out[i + 3] = m[i] + c[i];
  }
}

/// m + scale · rows of a 3×3: a bᵀ.
template <class T, class Scale>
HWY_INLINE void add_outer(T* m, const T* a, const T* b, Scale scale) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m[3 * i + j] += scale * a[i] * b[j];
}
template <class T, class Scale>
HWY_INLINE void add_skew3(T* m, const T* u, Scale scale) {
  m[1] -= scale * u[2];
  m[2] += scale * u[1];
  m[3] += scale * u[2];
  m[5] -= scale * u[0];
  m[6] -= scale * u[1];
  m[7] += scale * u[0];
}
template <class T>
HWY_INLINE void add_diagonal3(T* m, T x) {
  m[0] += x;
  m[4] += x;
  m[8] += x;
}

/// The right Jacobian of exp, [rotation coupling; 0 rotation]: J δΩ is the twist of the end.
template <class T>
HWY_INLINE void right_jacobian(const T* omega, const EntireOf<T>& e, T* rotation, T* coupling) {
  const T *v = omega, *w = omega + 3;
  const T s = dot3(w, w), wv = dot3(w, v);
  for (int i = 0; i < 9; ++i) rotation[i] = coupling[i] = 0;
  add_skew3(rotation, w, -e.a);
  add_outer(rotation, w, w, e.b);
  add_diagonal3(rotation, T(1 - e.b * s));
  // D of that along v
  add_skew3(coupling, v, -e.a);
  add_skew3(coupling, w, -2 * e.da * wv);
  add_outer(coupling, v, w, e.b);
  add_outer(coupling, w, v, e.b);
  add_outer(coupling, w, w, 2 * e.db * wv);
  add_diagonal3(coupling, T(-2 * e.b * wv - 2 * e.db * wv * s));
}
HWY_INLINE void right_jacobian(const double* omega, const Entire& e, Block& J) {
  double rotation[9], coupling[9];
  right_jacobian(omega, e, rotation, coupling);
  clear(J);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      J.a[i][j] = J.a[i + 3][j + 3] = rotation[3 * i + j];
      J.a[i][j + 3] = coupling[3 * i + j];
    }
}

/// ∂(Y(ω) f)/∂ω for Y = 1 + a [ω] + b [ω]², which is the right Jacobian's transpose.
template <class T>
HWY_INLINE void slope_of_transpose(const T* w, const T* f, const EntireOf<T>& e, T* D) {
  const T s = dot3(w, w), wf = dot3(w, f);
  T c[3], d[3];
  cross3(w, f, c);
  for (int i = 0; i < 3; ++i) d[i] = w[i] * wf - s * f[i];
  for (int i = 0; i < 9; ++i) D[i] = 0;
  add_skew3(D, f, -e.a);
  add_outer(D, c, w, 2 * e.da);
  add_diagonal3(D, T(e.b * wf));
  add_outer(D, w, f, e.b);
  add_outer(D, f, w, -2 * e.b);
  add_outer(D, d, w, 2 * e.db);
}
/// ∂/∂ω of the same times a fixed v.
template <class T>
HWY_INLINE void curvature_of_transpose(const T* w, const T* f, const T* v, const EntireOf<T>& e, T* D) {
  const T s = dot3(w, w), wf = dot3(w, f), wv = dot3(w, v), fv = dot3(f, v);
  T c[3], d[3], fxv[3], g[3];
  cross3(w, f, c);
  cross3(f, v, fxv);
  for (int i = 0; i < 3; ++i) {
    d[i] = w[i] * wf - s * f[i];
    g[i] = v[i] * wf + w[i] * fv - 2 * f[i] * wv;
  }
  for (int i = 0; i < 9; ++i) D[i] = 0;
  add_outer(D, fxv, w, -2 * e.da);
  add_outer(D, c, v, 2 * e.da);
  add_skew3(D, f, -2 * e.da * wv);
  add_outer(D, c, w, 4 * e.dda * wv);
  add_outer(D, g, w, 2 * e.db);
  add_outer(D, v, f, e.b);
  add_diagonal3(D, T(e.b * fv + 2 * e.db * wv * wf));
  add_outer(D, f, v, -2 * e.b);
  add_outer(D, d, v, 2 * e.db);
  add_outer(D, w, f, 2 * e.db * wv);
  add_outer(D, f, w, -4 * e.db * wv);
  add_outer(D, d, w, 4 * e.ddb * wv);
}
/// b + the symmetric part of ∂(Jᵀλ)/∂Ω: half the second derivative of the end's twist, contracted.
template <class T, class Square>
HWY_INLINE void add_exponential_curvature(Square& b, const T* omega, const T* lambda, const EntireOf<T>& e) {
  T slope[9], second[9], more[9];
  slope_of_transpose(omega + 3, lambda, e, slope);
  slope_of_transpose(omega + 3, lambda + 3, e, more);
  curvature_of_transpose(omega + 3, lambda, omega, e, second);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const T side = 0.5 * (slope[3 * i + j] + slope[3 * j + i]);
      b.a[i][j + 3] += side;
      b.a[i + 3][j] += side;
      b.a[i + 3][j + 3] += 0.5 * (second[3 * i + j] + second[3 * j + i] + more[3 * i + j] + more[3 * j + i]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::strain
HWY_AFTER_NAMESPACE();
#endif
