/// @file element-inl.hpp
/// What an element of a rod, a load and a tendon give to energy, gradient and Hessian, of numbers of any
/// kind: of one rod, or of a lane a rod. Theory: docs/theory/strain_rod.md
#if defined(SINEW_STRAIN_ELEMENT_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_STRAIN_ELEMENT_INL_HPP_
#undef SINEW_STRAIN_ELEMENT_INL_HPP_
#else
#define SINEW_STRAIN_ELEMENT_INL_HPP_
#endif
#include "strain/twist-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::strain {
namespace HWY_NAMESPACE {

/// Ω of an element of two Gauss points, from the strains there.
template <class T>
HWY_INLINE void magnus(const Element& element, const T* a, const T* b, T* omega) {
  const double half = 0.5 * element.length;
  T first[3], second[3], turn[3];
  cross3(a + 3, b, first);
  cross3(a, b + 3, second);
  cross3(a + 3, b + 3, turn);
  for (std::size_t i = 0; i < 3; ++i) {
    omega[i] = half * (a[i] + b[i]) + element.commutator * (first[i] + second[i]);
    omega[i + 3] = half * (a[i + 3] + b[i + 3]) + element.commutator * turn[i];
  }
}

/// v + u × r + dr/ds: how a tendon in a channel runs, by the rod's length.
template <class T>
HWY_INLINE void guided(const T* xi, const Three& place, const Three& slope, T* x) {
  cross3(xi + 3, place.data(), x);
  for (std::size_t i = 0; i < 3; ++i) x[i] += xi[i] + slope[i];
}

/// Of a node's load the gradient of its potential, or what stands for it, and where P is given its
/// derivative.
/// @param dead the load's dead force [N]
template <class T, class Force, class Square>
HWY_INLINE void add_load(const NodeLoad& load, const Force* dead, const T* R, T* lambda, Square* P) {
  T f[3], m[3], D[9];
  turn_back3(R, dead, f);
  turn_back3(R, load.moment, m);
  for (int i = 0; i < 3; ++i)  // Rᵀ Σ f dᵀ: rows are f
    for (int j = 0; j < 3; ++j)
      D[3 * i + j] = R[i] * load.couple[j] + R[3 + i] * load.couple[3 + j] + R[6 + i] * load.couple[6 + j];
  const T around[3] = {D[7] - D[5], D[2] - D[6], D[3] - D[1]};  // Σ d × f
  double follow[6];
  for (int i = 0; i < 6; ++i) follow[i] = -load.following[i];
  for (int i = 0; i < 3; ++i) {
    lambda[i] += follow[i] - f[i];
    lambda[i + 3] += follow[i + 3] - m[i] - around[i];
  }
  if (P == nullptr) return;
  add_skew(*P, 3, 0, f, 0.5);
  add_skew(*P, 0, 3, f, -0.5);
  const T trace = D[0] + D[4] + D[8];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) P->a[i + 3][j + 3] -= 0.5 * (D[3 * i + j] + D[3 * j + i]);
    P->a[i + 3][i + 3] += trace;
  }
  add_skew(*P, 3, 3, m, -0.5);
  add_bracket(*P, follow, 0.5);
}

/// b − scale g gᵀ.
HWY_INLINE void take_square(Block& b, const double* g, double scale) {
  alignas(64) double line[row] = {g[0], g[1], g[2], g[3], g[4], g[5], 0, 0};
  for (int i = 0; i < 6; ++i) lanes(b.a[i]) -= (scale * g[i]) * lanes(line);
}
template <class Square, class T>
HWY_INLINE void take_square(Square& b, const T* g, T scale) {
  for (int i = 0; i < 6; ++i) {
    const T x = scale * g[i];
    for (int j = 0; j < 6; ++j) b.a[i][j] -= x * g[j];
  }
}

/// b + scale (Nᵀ N − g gᵀ) with N = [1, −[r]] and g = Nᵀ t: how a length changes across its direction t.
template <class Square, class T>
HWY_INLINE void add_stretching(Square& b, const double* r, const T* g, T scale) {
  take_square(b, g, scale);
  const T square = scale * dot3(r, r);
  for (int i = 0; i < 3; ++i) {
    b.a[i][i] += scale;
    b.a[i + 3][i + 3] += square;
    for (int j = 0; j < 3; ++j) b.a[i + 3][j + 3] -= scale * r[i] * r[j];
  }
  add_skew(b, 0, 3, r, T(-scale));
  add_skew(b, 3, 0, r, scale);
}

/// From one hole of a tendon to its next, in base axes [m].
template <class Frame, class T>
HWY_INLINE void way_between(const Frame& start, const Frame& end, const Hole& hole, T* x) {
  T a[3];
  turn3(start.R, hole.start.data(), a);
  turn3(end.R, hole.end.data(), x);
  for (int j = 0; j < 3; ++j) x[j] += end.p[j] - a[j] - start.p[j];
}

/// The gradient of a tendon's length between two discs by the twist of the second one against the first, and
/// where P is given its second derivative times the tension.
template <class Frame, class T, class Square>
HWY_INLINE void hole_terms(const Frame& start, const Frame& end, const Hole& hole, T tension, T* gradient,
                           Square* P) {
  T x[3], t[3], around[3];
  way_between(start, end, hole, x);
  const T length = root(dot3(x, x));
  turn_back3(end.R, x, t);
  for (T& component : t) component /= length;
  const double* r = hole.end.data();
  cross3(r, t, around);
  for (int j = 0; j < 3; ++j) {
    gradient[j] = t[j];
    gradient[j + 3] = around[j];
  }
  if (P == nullptr) return;
  add_skew(*P, 3, 0, t, T(-0.5 * tension));
  add_skew(*P, 0, 3, t, T(0.5 * tension));
  const T tr = dot3(t, r), stiff = tension / length;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) P->a[i + 3][j + 3] += 0.5 * tension * (t[i] * r[j] + r[i] * t[j]);
    P->a[i + 3][i + 3] -= tension * tr;
  }
  add_stretching(*P, r, gradient, stiff);
}

/// Of a guided tendon at a Gauss point: the gradient of its length by the strain, and the second derivative.
template <class T, class Square>
HWY_INLINE void guide_terms(const T* xi, const Guide& guide, int point, T* gradient, T tension, Square* E) {
  const auto g = static_cast<std::size_t>(point);
  T x[3];
  guided(xi, guide.place[g], guide.slope[g], x);
  const T length = root(dot3(x, x));
  const double* r = guide.place[g].data();
  for (int i = 0; i < 3; ++i) gradient[i] = x[i] / length;
  cross3(r, gradient, gradient + 3);
  if (E == nullptr) return;
  add_stretching(*E, r, gradient, T(tension / length));
}

/// adᵀ λ = −(ω × f, ω × m + v × f)
template <class T>
HWY_INLINE void dual_bracket(const T* xi, const T* lambda, T* out) {
  T a[3], b[3], c[3];
  cross3(xi + 3, lambda, a);
  cross3(xi + 3, lambda + 3, b);
  cross3(xi, lambda, c);
  for (int i = 0; i < 3; ++i) {
    out[i] = -a[i];
    out[i + 3] = -b[i] - c[i];
  }
}

/// From a gradient by Ω to those by the two strains: D₁ᵀ = h/2 − k ad(ξ₂)ᵀ, D₂ᵀ = h/2 + k ad(ξ₁)ᵀ.
template <class T>
HWY_INLINE void by_strains(const Element& element, const T* xi_first, const T* xi_second, const T* by_omega,
                           T* first, T* second) {
  T one[6], two[6];
  dual_bracket(xi_second, by_omega, one);
  dual_bracket(xi_first, by_omega, two);
  for (int i = 0; i < 6; ++i) {
    first[i] = 0.5 * element.length * by_omega[i] - element.commutator * one[i];
    second[i] = 0.5 * element.length * by_omega[i] + element.commutator * two[i];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::strain
HWY_AFTER_NAMESPACE();
#endif
