/// @file vec.hpp
/// Small fixed vectors and matrices, and what may stand in for a number. Includes <Eigen/Core> only.
///
/// Policy: a public type holds no over-aligned and no dynamic Eigen member. Eigen aligns fixed-size members
/// by the instruction set of whoever compiles, so a consumer built with -march=native or AVX-512 would see
/// other layouts than the library; `DontAlign` makes every layout that of a plain array of scalars.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <concepts>
#include <vector>

#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// The real number a scalar stands for, to choose a branch by. A derivative type brings its own, found by
/// ADL.
template <std::floating_point F>
constexpr double real_part(F x) {
  return static_cast<double>(x);
}
template <std::floating_point F>
constexpr double real_part(const std::complex<F>& x) {
  return static_cast<double>(x.real());
}

namespace detail {
using std::atan, std::cos, std::sin, std::sqrt;
template <class S>
concept Elementary = requires(const S x) {
  { sin(x) } -> std::convertible_to<S>;
  { cos(x) } -> std::convertible_to<S>;
  { atan(x) } -> std::convertible_to<S>;
  { sqrt(x) } -> std::convertible_to<S>;
  { real_part(x) } -> std::convertible_to<double>;
};
template <class S>
concept Field = requires(const S x, const S y) {
  { x + y } -> std::convertible_to<S>;
  { x - y } -> std::convertible_to<S>;
  { x* y } -> std::convertible_to<S>;
  { x / y } -> std::convertible_to<S>;
  { -x } -> std::convertible_to<S>;
};
}  // namespace detail

/// double, float, std::complex<double>, or a derivative type that behaves like one. Code on a `Scalar` must
/// stay analytic (no abs, no conjugate, no comparison but through `real_part`), so that a complex step passes
/// through.
template <class S>
concept Scalar =
    std::copyable<S> && std::constructible_from<S, double> && detail::Field<S> && detail::Elementary<S>;

/// An R×C matrix with the layout of S[R*C], columns first (a row: its elements).
template <class S, int R, int C = 1>
using Mat = Eigen::Matrix<S, R, C, Eigen::DontAlign | (R == 1 && C != 1 ? Eigen::RowMajor : Eigen::ColMajor)>;
/// A column of N numbers.
template <class S, int N>
using Vec = Mat<S, N>;
/// A vector of the plane.
template <class S>
using Vec2 = Mat<S, 2>;
/// A vector in space.
template <class S>
using Vec3 = Mat<S, 3>;

/// Somebody's row-major numbers as a matrix: `MatrixView(data, rows, columns)`.
using MatrixView = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

/// a·b without conjugation: analytic in both, unlike Eigen's dot on complex numbers.
template <class A, class B>
typename A::Scalar dot(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a.cwiseProduct(b).sum();
}

/// |a|² without conjugation.
template <class A>
typename A::Scalar squared_norm(const Eigen::MatrixBase<A>& a) {
  const Vec<typename A::Scalar, A::SizeAtCompileTime> v = a;
  return dot(v, v);
}

/// In the plane the z component of a × b, in space the vector. Always inlined, as rotations are: otherwise
/// one copy, compiled for the file that is linked first, serves all, and its vectors go through memory.
template <class A, class B>
[[gnu::always_inline]] inline auto cross(const Eigen::MatrixBase<A>& a_, const Eigen::MatrixBase<B>& b_) {
  static_assert(int{A::SizeAtCompileTime} == int{B::SizeAtCompileTime});
  static_assert(A::SizeAtCompileTime == 2 || A::SizeAtCompileTime == 3);
  using S = typename A::Scalar;
  const Vec<S, A::SizeAtCompileTime> a = a_;  // expressions are evaluated once
  const Vec<S, A::SizeAtCompileTime> b = b_;
  if constexpr (A::SizeAtCompileTime == 2) {
    return static_cast<S>(a[0] * b[1] - a[1] * b[0]);
  } else {
    return Vec3<S>(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  }
}

/// E v: v turned by +90°.
template <class A>
Vec2<typename A::Scalar> perp(const Eigen::MatrixBase<A>& v_) {
  static_assert(A::SizeAtCompileTime == 2);
  const Vec2<typename A::Scalar> v = v_;
  return {-v[1], v[0]};
}

/// A convex set by its vertices, counter-clockwise, none twice: none of them is the empty set, one a point,
/// two a segment.
using Polygon = std::vector<Vec2<double>>;

/// The points x with normal·x ≥ offset; the normal is a unit vector.
struct HalfPlane {
  Vec2<double> normal;  ///< unit vector, inwards
  double offset;        ///< distance of the line from the origin, < 0: the origin is inside

  /// How deep inside x lies, < 0: outside.
  double depth(const Vec2<double>& x) const { return dot(normal, x) - offset; }
};

}  // namespace sinew::inline v1
