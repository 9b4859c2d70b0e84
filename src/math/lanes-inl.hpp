/// @file lanes-inl.hpp
/// Mathematics of one number of several independent problems at once, one problem a lane of a vector
/// register. What becomes of a lane does not depend on its neighbours. Included once for each instruction
/// set, after highway.h. Theory: docs/theory/velocity.md
#if defined(SINEW_MATH_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SINEW_MATH_LANES_INL
#undef SINEW_MATH_LANES_INL
#else
#define SINEW_MATH_LANES_INL
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>

#include "math/inverse_sinc.hpp"
#include "sinew/math/entire.hpp"

HWY_BEFORE_NAMESPACE();
namespace sinew::inline v1::lanes {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<double>;
using Pack = hn::Vec<Tag>;
constexpr Tag tag;

HWY_INLINE Pack all(double x) { return hn::Set(tag, x); }
HWY_INLINE Pack plus(Pack c, Pack a, Pack b) { return hn::MulAdd(a, b, c); }      // c + ab
HWY_INLINE Pack minus(Pack c, Pack a, Pack b) { return hn::NegMulAdd(a, b, c); }  // c − ab

/// Σ cₖ qᵏ by Horner.
template <std::size_t N>
HWY_INLINE Pack horner(const std::array<double, N>& c, Pack q) {
  Pack sum = all(c[N - 1]);
  for (std::size_t k = N - 1; k-- > 0;) sum = plus(all(c[k]), sum, q);
  return sum;
}

/// sinc3 and sinc_slope of x from q = x², for x in [0, π]: what 15 terms leave out is below eps/100 at π.
HWY_INLINE Pack sinc3_of_square(Pack q) {
  static constexpr auto terms = detail::Series<15>::reciprocal_factorials(3);
  return horner(terms.c, q);
}
HWY_INLINE Pack sinc_slope_of_square(Pack q) {
  static constexpr auto terms = detail::slope_series<15>();
  return horner(terms.c, q);
}

/// The x in (0, π) with sinc x = 1 − w, for w in (0, 1]: `inverse_sinc` of inverse_sinc.hpp without branches.
/// One series serves the whole range: where it cancels, towards π, sinc′ is far from 0.
HWY_INLINE Pack inverse_sinc_of_loss(Pack w) {
  using Start = InverseSincStart;
  const Pack x = hn::Sqrt(w * all(6)) * horner(Start::above, w) / horner(Start::below, w);
  const Pack q = x * x, loss = q * sinc3_of_square(q), slope = sinc_slope_of_square(q);
  const Pack excess = w - loss, rate = hn::Neg(x * slope);    // sinc x − (1 − w), sinc′ x
  const Pack curvature = plus(loss - all(1), all(2), slope);  // sinc″ x
  const Pack twice = rate + rate;
  return minus(x, excess, twice / minus(twice * rate, excess, curvature));
}

template <std::size_t N>
HWY_INLINE Pack dot(const Pack* a, const Pack* b) {
  Pack sum = a[0] * b[0];
  for (std::size_t k = 1; k < N; ++k) sum = plus(sum, a[k], b[k]);
  return sum;
}

/// Rotates two rows of N numbers such that their first D are orthogonal; lanes where they are stay as they
/// are, so that it makes no difference how long the neighbours still need. Whether any lane moved.
template <std::size_t D, std::size_t N>
HWY_INLINE bool part(Pack* a, Pack* b) {
  constexpr double tolerance = 0x1p-48;  // of the cosine: it is off by its square after the next turn
  const Pack square_a = dot<D>(a, a), square_b = dot<D>(b, b), product = dot<D>(a, b);
  const auto turns = hn::Gt(product * product, all(tolerance * tolerance) * (square_a * square_b));
  if (hn::AllFalse(tag, turns)) return false;
  // tan 2θ = 2ab/(b² − a²), the smaller of its two angles
  const Pack gap = square_b - square_a, cross = product + product;
  const Pack size = hn::Sqrt(plus(gap * gap, cross, cross)), near = hn::Abs(gap) + size;
  const Pack scale = all(1) / hn::Sqrt(all(2) * (size * near));
  const Pack signed_cross = hn::Xor(cross, hn::And(gap, hn::SignBit(tag)));
  const Pack c = hn::IfThenElse(turns, near * scale, all(1));
  const Pack s = hn::IfThenElseZero(turns, signed_cross * scale);
  for (std::size_t k = 0; k < N; ++k) {
    const Pack x = a[k], y = b[k];
    a[k] = minus(c * x, s, y);
    b[k] = plus(c * y, s, x);
  }
  return true;
}

/// A sweep over all pairs of R rows of several matrices. Neighbours in this order (rounds of a tournament)
/// share no row, so that the processor works on several at a time: each waits for two square roots in a row.
template <std::size_t R, std::size_t D, class... Rows>
HWY_INLINE bool sweep_pairs(Rows&... rows) {
  constexpr std::size_t players = R + R % 2, others = players - 1;
  bool moved = false;
  for (std::size_t round = 0; round < others; ++round)
    for (std::size_t k = 0; k < players / 2; ++k) {
      const std::size_t one = (round + k) % others, other = k == 0 ? others : (round + others - k) % others;
      const std::size_t i = std::min(one, other), j = std::max(one, other);
      if (j < R) ((moved |= part<D, std::extent_v<Rows, 1>>(rows[i], rows[j])), ...);
    }
  return moved;
}

/// One-sided Jacobi (Hestenes): rotates R rows of each matrix until the first D numbers of them are
/// orthogonal. The lengths of the rows are then the singular values of those, small ones as exact as the rows
/// determine them.
template <std::size_t R, std::size_t D, class... Rows>
HWY_INLINE void orthogonalise(Rows&... rows) {
  constexpr int max_sweeps = 16;  // six are rarely needed
  for (int sweep = 0; sweep < max_sweeps; ++sweep)
    if (!sweep_pairs<R, D>(rows...)) return;
}

/// Squares of the shortest and the longest row, of their first D numbers.
struct Extremes {
  Pack least, most;
};
template <std::size_t R, std::size_t D, std::size_t N>
HWY_INLINE Extremes squares(const Pack (&rows)[R][N]) {
  const Pack first = dot<D>(rows[0], rows[0]);
  Extremes range{first, first};
  for (std::size_t i = 1; i < R; ++i) {
    const Pack square = dot<D>(rows[i], rows[i]);
    range = {hn::Min(range.least, square), hn::Max(range.most, square)};
  }
  return range;
}

/// Determinant of 3 columns of 3 rows.
template <std::size_t N>
HWY_INLINE Pack minor_of(const Pack (*rows)[N], std::size_t i, std::size_t j, std::size_t k) {
  const Pack x = minus(rows[1][j] * rows[2][k], rows[1][k], rows[2][j]);
  const Pack y = minus(rows[1][k] * rows[2][i], rows[1][i], rows[2][k]);
  const Pack z = minus(rows[1][i] * rows[2][j], rows[1][j], rows[2][i]);
  return plus(plus(rows[0][i] * x, rows[0][j], y), rows[0][k], z);
}

HWY_INLINE Pack determinant(const Pack (&rows)[3][3]) { return minor_of<3>(rows, 0, 1, 2); }

/// By Laplace's expansion along the upper three rows: no pivots, and exact to rounding of its largest terms.
HWY_INLINE Pack determinant(const Pack (&rows)[6][6]) {
  Pack sum = hn::Zero(tag);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 5; ++j)
      for (std::size_t k = j + 1; k < 6; ++k) {
        std::size_t rest[3], count = 0;
        for (std::size_t c = 0; c < 6; ++c)
          if (c != i && c != j && c != k) rest[count++] = c;
        const Pack term = minor_of<6>(rows, i, j, k) * minor_of<6>(rows + 3, rest[0], rest[1], rest[2]);
        sum = (i + j + k) % 2 == 1 ? sum + term : sum - term;
      }
  return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace sinew::inline v1::lanes
HWY_AFTER_NAMESPACE();
#endif
