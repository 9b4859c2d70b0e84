#include "study/sweep/fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "study/sweep/terms.hpp"

namespace sinew::inline v0 {
namespace {

constexpr Eigen::Index rows_at_once = 256;
/// A term that the others make up to this relative size is not determined: folding rounds a million times.
constexpr double collinear = 1e-11;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

StreamedFit::StreamedFit(const StudyFit& fit)
    : fit_(&fit),
      stacked_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(fit.terms.size()) + 1 + rows_at_once,
                                     static_cast<Eigen::Index>(fit.terms.size()) + 1)),
      row_(stacked_.cols()) {
  result_.name = fit.name;
  result_.terms = fit.texts;
}

bool StreamedFit::row(std::span<const double> columns) {
  for (Eigen::Index t = 0; t + 1 < row_.size(); ++t)
    row_[t] = value_of(fit_->terms[static_cast<std::size_t>(t)], columns);
  row_[row_.size() - 1] = columns[fit_->column];
  return row_.allFinite();
}

void StreamedFit::add(std::span<const double> columns) {
  if (!row(columns)) return;
  stacked_.row(stacked_.cols() + filled_) = row_.transpose();
  ++result_.samples;
  if (++filled_ == rows_at_once) fold();
}

void StreamedFit::fold() {
  const Eigen::Index n = stacked_.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(stacked_.topRows(n + filled_));
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  stacked_.setZero();
  stacked_.topRows(n) = triangle;
  filled_ = 0;
}

FittedTerms StreamedFit::solve() {
  fold();
  const Eigen::Index n = stacked_.cols() - 1;
  // terms may differ by many powers of ten: each column to unit length, so that the rank is that of
  // directions
  const Eigen::VectorXd size = stacked_.topLeftCorner(n, n).colwise().norm().transpose();
  const Eigen::VectorXd scale = (size.array() > 0).select(size.array().inverse(), 1.0);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(n, n);
  qr.setThreshold(collinear);
  qr.compute(stacked_.topLeftCorner(n, n) * scale.asDiagonal());
  const double residual = std::abs(stacked_(n, n));
  const auto samples = static_cast<double>(result_.samples);
  result_.rms = samples > 0 ? residual / std::sqrt(samples) : missing;
  result_.coefficients.assign(static_cast<std::size_t>(n), missing);
  result_.deviations.assign(static_cast<std::size_t>(n), missing);
  if (qr.rank() < n || samples < static_cast<double>(n)) return result_;
  const Eigen::VectorXd solution = scale.asDiagonal() * qr.solve(stacked_.col(n).head(n));
  const Eigen::MatrixXd inverse = scale.asDiagonal() * qr.solve(Eigen::MatrixXd::Identity(n, n));
  const double freedom = samples - static_cast<double>(n);
  for (Eigen::Index t = 0; t < n; ++t) {
    result_.coefficients[static_cast<std::size_t>(t)] = solution[t];
    if (freedom > 0)
      result_.deviations[static_cast<std::size_t>(t)] = residual / std::sqrt(freedom) * inverse.row(t).norm();
  }
  return result_;
}

void StreamedFit::add_residual(std::span<const double> columns) {
  if (!row(columns)) return;
  double left = row_[row_.size() - 1];
  for (std::size_t t = 0; t < result_.coefficients.size(); ++t)
    left -= result_.coefficients[t] * row_[static_cast<Eigen::Index>(t)];
  if (!(std::abs(left) <= result_.largest)) result_.largest = std::abs(left);  // NaN stays seen
}

}  // namespace sinew::inline v0
