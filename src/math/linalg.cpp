#include "math/linalg.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.hpp"
#include "base/limits.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int most = max_rows;
// Maxima known at compile time: Eigen then keeps the elements, and every workspace, inside the object.
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, most, most>;
using Small3 = Eigen::Matrix<double, 3, 3>;
using Target = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// Sizes are checked in release builds too: they may come from a robot file, and Eigen would write past its
/// array.
bool fits(const MatrixView& a) {
  const bool fitting = a.rows() > 0 && a.rows() <= most && a.cols() > 0 && a.cols() <= most;
  SINEW_EXPECTS(fitting);
  return fitting;
}

/// A number as an unevaluated sum: twice the digits of double.
struct Pair {
  double high, low;
};

Pair operator+(Pair a, Pair b) {
  const double sum = a.high + b.high, back = sum - a.high;
  const double low = ((a.high - (sum - back)) + (b.high - back)) + (a.low + b.low);
  const double high = sum + low;
  return {high, low - (high - sum)};
}

Pair operator-(Pair a) { return {-a.high, -a.low}; }

/// a·b exactly (Dekker 1971); std::fma is a slow library call on a baseline x86-64.
Pair product(double a, double b) {
  const auto split = [](double x) {
    const double far = x * 134217729.0, high = far - (far - x);
    return Pair{high, x - high};
  };
  const Pair x = split(a), y = split(b);
  const double high = a * b;
  return {high, ((x.high * y.high - high) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

Pair operator*(double a, Pair b) {
  const Pair high = product(a, b.high);
  return {high.high, high.low + a * b.low};
}

/// Any SVD errs by eps·σ₁, which leaves nothing of a σ₃ near eps·σ₁ and makes σ₃ meaningless near a
/// singularity. But σ₁, σ₁σ₂ and σ₁σ₂σ₃ are norms of A, of its cofactors and its determinant, all of which
/// can be had to full precision.
void singular_values_3x3(const MatrixView& a_, std::span<double> out) {
  std::fill_n(out.begin(), 3, 0.0);
  const double largest = a_.cwiseAbs().maxCoeff();
  if (largest == 0) return;
  const double scale = std::exp2(std::ilogb(largest));  // a power of two: division is exact
  const Small3 a = a_ / scale;
  const Eigen::JacobiSVD<Small3> direct(a);
  const auto& sigma = direct.singularValues();
  if (sigma[2] > 0.03 * sigma[0]) return void(Eigen::Map<Eigen::Vector3d>(out.data()) = sigma * scale);
  Small3 cofactor;
  Pair det{0, 0};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int r = (i + 1) % 3, s = (i + 2) % 3, k = (j + 1) % 3, l = (j + 2) % 3;
      const Pair minor = product(a(r, k), a(s, l)) + -product(a(r, l), a(s, k));
      cofactor(i, j) = minor.high;
      if (i == 0) det = det + a(0, j) * minor;
    }
  const double one = sigma[0], two = Eigen::JacobiSVD<Small3>(cofactor).singularValues()[0];
  out[0] = one * scale;
  out[1] = two / one * scale;
  out[2] = two > 0 ? std::min(std::abs(det.high) / two * scale, out[1]) : 0.0;
}

/// L of A = L Q, Q of orthonormal rows: it has A's singular values in as many columns as rows.
Small left_factor(const MatrixView& a) {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = a;
  Small left = Small::Zero(a.rows(), a.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    for (Eigen::Index k = 0; k < i; ++k) {
      left(i, k) = rows.row(i).dot(rows.row(k));
      rows.row(i) -= left(i, k) * rows.row(k);
    }
    left(i, i) = rows.row(i).norm();
    if (left(i, i) > 0) rows.row(i) /= left(i, i);
  }
  return left;
}

}  // namespace

void singular_values(const MatrixView& a, std::span<double> out) {
  SINEW_EXPECTS(static_cast<Eigen::Index>(out.size()) >= std::min(a.rows(), a.cols()));
  const Eigen::Index count = std::min(a.rows(), a.cols());
  if (a.rows() > 0 && a.rows() <= most && a.cols() > most && a.allFinite()) {
    const Small left = left_factor(a);
    return singular_values(MatrixView(left.data(), left.rows(), left.cols()), out);
  }
  if (!fits(a) || !a.allFinite()) return void(std::fill_n(out.begin(), count, not_a_number));
  if (a.rows() == 3 && a.cols() == 3) return singular_values_3x3(a, out);
  const Eigen::JacobiSVD<Small> svd(a);
  std::copy_n(svd.singularValues().data(), count, out.begin());
}

Svd svd(const MatrixView& a) {
  Svd result;
  if (!fits(a)) return result;
  result.rows = static_cast<int>(a.rows());
  result.columns = static_cast<int>(a.cols());
  if (!a.allFinite()) {
    result.sigma_data.fill(not_a_number);
    result.u_data.fill(not_a_number);
    result.v_data.fill(not_a_number);
    return result;
  }
  const Eigen::JacobiSVD<Small> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  std::copy_n(svd.singularValues().data(), result.count(), result.sigma_data.begin());
  Target(result.u_data.data(), a.rows(), a.rows()) = svd.matrixU();
  Target(result.v_data.data(), a.cols(), a.cols()) = svd.matrixV();
  return result;
}

int rank(std::span<const double> sigma, double tolerance) {
  if (sigma.empty()) return 0;
  const double least = tolerance * sigma.front();
  return static_cast<int>(std::count_if(sigma.begin(), sigma.end(), [&](double s) { return s > least; }));
}

bool solve(const MatrixView& j, const MatrixView& b, std::span<double> out) {
  SINEW_EXPECTS(j.rows() == j.cols() && b.rows() == j.rows());
  SINEW_EXPECTS(static_cast<Eigen::Index>(out.size()) >= b.size());
  if (!fits(j) || !fits(b) || !j.allFinite()) return false;
  const Eigen::PartialPivLU<Small> lu(j);
  const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
  const bool clear =
      pivots.minCoeff() > 1e-6 * pivots.maxCoeff();  // the estimate below costs more than the rest
  if (!clear && !(lu.rcond() > eps * static_cast<double>(j.rows()))) return false;
  const Small x = lu.solve(b);
  Target(out.data(), b.rows(), b.cols()) = x;
  return x.allFinite();
}

int least_norm(const MatrixView& a, std::span<const double> b, std::span<double> out, double tolerance) {
  SINEW_EXPECTS(static_cast<Eigen::Index>(b.size()) == a.rows() &&
                static_cast<Eigen::Index>(out.size()) >= a.cols());
  const Svd parts = svd(a);
  if (parts.count() == 0 || !std::isfinite(parts.sigma().front()))
    return std::fill_n(out.begin(), a.cols(), not_a_number), 0;
  const int r = rank(parts.sigma(), tolerance);
  const auto u = parts.u(), v = parts.v();
  std::fill_n(out.begin(), a.cols(), 0.0);
  for (int k = 0; k < r; ++k) {
    double along = 0;
    for (std::size_t i = 0; i < b.size(); ++i) along += u(static_cast<Eigen::Index>(i), k) * b[i];
    along /= parts.sigma()[static_cast<std::size_t>(k)];
    for (int i = 0; i < parts.columns; ++i) out[static_cast<std::size_t>(i)] += along * v(i, k);
  }
  return r;
}

void symmetric_eigenvalues(const MatrixView& a, std::span<double> values, std::span<double> vectors) {
  const bool square = fits(a) && a.rows() == a.cols() && values.size() == static_cast<std::size_t>(a.rows());
  SINEW_EXPECTS(square);
  std::fill(values.begin(), values.end(), not_a_number);
  std::fill(vectors.begin(), vectors.end(), not_a_number);
  if (!square || !a.allFinite()) return;
  const Small symmetric = 0.5 * (a + a.transpose());
  const Eigen::SelfAdjointEigenSolver<Small> found(
      symmetric, vectors.empty() ? Eigen::EigenvaluesOnly : Eigen::ComputeEigenvectors);
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    values[static_cast<std::size_t>(i)] = found.eigenvalues()[i];
    for (Eigen::Index j = 0; !vectors.empty() && j < a.cols(); ++j)
      vectors[static_cast<std::size_t>(i * a.cols() + j)] = found.eigenvectors()(j, i);
  }
}

namespace {

/// Whether Cholesky's elimination of a symmetric matrix leaves every pivot well above rounding: then all its
/// eigenvalues are positive, however its rows are scaled.
bool is_clearly_definite(Small a) {
  constexpr double clear = 1e-10;
  const auto diagonal = a.diagonal().eval();
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const double pivot = a(k, k);
    if (!(pivot > clear * diagonal[k])) return false;
    for (Eigen::Index j = k + 1; j < a.rows(); ++j) {
      const double share = a(j, k) / pivot;
      for (Eigen::Index i = j; i < a.rows(); ++i) a(i, j) -= share * a(i, k);
    }
  }
  return true;
}

}  // namespace

int count_negative_eigenvalues(const MatrixView& a) {
  const bool square = fits(a) && a.rows() == a.cols();
  SINEW_EXPECTS(square);
  if (!square || !a.allFinite()) return 0;
  const Small symmetric = 0.5 * (a + a.transpose());
  if (is_clearly_definite(symmetric)) return 0;
  const Eigen::SelfAdjointEigenSolver<Small> found(symmetric, Eigen::EigenvaluesOnly);
  return static_cast<int>((found.eigenvalues().array() < 0).count());
}

int count_left_of_zero(const MatrixView& a) {
  const bool square = fits(a) && a.rows() == a.cols();
  SINEW_EXPECTS(square);
  if (!square || !a.allFinite()) return 0;
  const Eigen::EigenSolver<Small> found(Small(a), false);
  return static_cast<int>((found.eigenvalues().real().array() < 0).count());
}

double determinant(const MatrixView& a) {
  SINEW_EXPECTS(a.rows() == a.cols());
  if (!fits(a)) return not_a_number;
  return Eigen::PartialPivLU<Small>(a).determinant();
}

}  // namespace sinew::inline v1
