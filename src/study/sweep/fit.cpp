#include "study/sweep/fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "sinew/base/numbers.hpp"
#include "study/sweep/terms.hpp"

namespace sinew::inline v1 {
namespace {

constexpr Eigen::Index rows_at_once = 256;
/// A term that the others make up to this relative size is not determined: folding rounds a million times.
constexpr double collinear = 1e-11;

}  // namespace

StreamedFit::StreamedFit(const Study& study, const StudyFit& fit)
    : fit_(&fit),
      stacked_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(fit.coefficients.size()) + 1 + rows_at_once,
                                     static_cast<Eigen::Index>(fit.coefficients.size()) + 1)),
      rows_(stacked_.cols(), static_cast<Eigen::Index>(fit.equations.size())),
      sums_(fit.equations.size()) {
  result_.name = fit.name;
  result_.terms = fit.coefficients;
  result_.is_given = !fit.known.empty();
  for (const FitEquation& equation : fit.equations)
    result_.columns.push_back(
        {study.column_name(equation.column), study.column_unit(equation.column), equation.text});
  result_.unit = result_.columns.front().unit;
  for (const FittedColumn& column : result_.columns)
    if (column.unit != result_.unit) result_.unit.clear();
}

/// The rows of a sample; whether it has all it needs.
bool StreamedFit::is_whole(std::span<const double> columns) {
  const Eigen::Index n = rows_.rows() - 1;
  for (Eigen::Index e = 0; e < rows_.cols(); ++e) {
    const FitEquation& equation = fit_->equations[static_cast<std::size_t>(e)];
    for (Eigen::Index t = 0; t < n; ++t)
      rows_(t, e) = value_of(equation.terms[static_cast<std::size_t>(t)], columns);
    rows_(n, e) = columns[equation.column];
  }
  return rows_.allFinite();
}

void StreamedFit::add(std::span<const double> columns) {
  if (!is_whole(columns)) return;
  ++result_.samples;
  if (result_.is_given) return;
  for (Eigen::Index e = 0; e < rows_.cols(); ++e) {
    stacked_.row(stacked_.cols() + filled_) = rows_.col(e).transpose();
    if (++filled_ == rows_at_once) fold();
  }
}

void StreamedFit::fold() {
  const Eigen::Index n = stacked_.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(stacked_.topRows(n + filled_));
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  stacked_.setZero();
  stacked_.topRows(n) = triangle;
  filled_ = 0;
}

void StreamedFit::solve() {
  const std::size_t n = fit_->coefficients.size();
  result_.deviations.assign(n, not_a_number);
  result_.coefficients = fit_->known;
  if (result_.is_given) return;
  result_.coefficients.assign(n, not_a_number);
  fold();
  find_coefficients();
}

void StreamedFit::find_coefficients() {
  const Eigen::Index n = stacked_.cols() - 1;
  // terms may differ by many powers of ten: each column to unit length, so that the rank is that of
  // directions
  const Eigen::VectorXd size = stacked_.topLeftCorner(n, n).colwise().norm().transpose();
  const Eigen::VectorXd scale = (size.array() > 0).select(size.array().inverse(), 1.0);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(n, n);
  qr.setThreshold(collinear);
  qr.compute(stacked_.topLeftCorner(n, n) * scale.asDiagonal());
  const double freedom =
      static_cast<double>(result_.samples * fit_->equations.size()) - static_cast<double>(n);
  if (qr.rank() < n || freedom < 0) return;
  const Eigen::VectorXd solution = scale.asDiagonal() * qr.solve(stacked_.col(n).head(n));
  const Eigen::MatrixXd inverse = scale.asDiagonal() * qr.solve(Eigen::MatrixXd::Identity(n, n));
  const double residual = std::abs(stacked_(n, n));
  for (Eigen::Index t = 0; t < n; ++t) {
    result_.coefficients[static_cast<std::size_t>(t)] = solution[t];
    if (freedom > 0)
      result_.deviations[static_cast<std::size_t>(t)] = residual / std::sqrt(freedom) * inverse.row(t).norm();
  }
}

void StreamedFit::add_residual(std::span<const double> columns) {
  if (!is_whole(columns)) return;
  const Eigen::Index n = rows_.rows() - 1;
  for (Eigen::Index e = 0; e < rows_.cols(); ++e) {
    double left = rows_(n, e);
    for (Eigen::Index t = 0; t < n; ++t)
      left -= result_.coefficients[static_cast<std::size_t>(t)] * rows_(t, e);
    FittedColumn& column = result_.columns[static_cast<std::size_t>(e)];
    Sums& sums = sums_[static_cast<std::size_t>(e)];
    if (!(std::abs(left) <= column.largest)) column.largest = std::abs(left);  // NaN stays seen
    sums.residual += left * left;
    sums.column += rows_(n, e) * rows_(n, e);
  }
}

FittedTerms StreamedFit::result() const {
  FittedTerms done = result_;
  const auto samples = static_cast<double>(done.samples);
  double all = 0;
  for (std::size_t e = 0; e < sums_.size(); ++e) {
    FittedColumn& column = done.columns[e];
    column.rms = std::sqrt(sums_[e].residual / samples);
    column.relative = std::sqrt(sums_[e].residual / sums_[e].column);
    all += sums_[e].residual;
    if (!(column.largest <= done.largest)) done.largest = column.largest;
  }
  done.rms = std::sqrt(all / (samples * static_cast<double>(sums_.size())));
  const auto is_other = [&](const FittedColumn& column) { return column.unit != done.columns.front().unit; };
  if (std::ranges::any_of(done.columns, is_other))
    done.rms = done.largest = not_a_number;  // metres and radians
  return done;
}

}  // namespace sinew::inline v1
