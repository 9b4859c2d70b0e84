/// @file fit.hpp
/// Least squares over more samples than fit into memory: rows are folded into a triangle as they come.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "sinew/study/sweep.hpp"

namespace sinew::inline v0 {

/// Coefficients of one fit. Householder's QR of the rows so far, R with the right-hand side as last column;
/// new rows are stacked under it and folded in, so that nothing is squared (as normal equations would).
class StreamedFit {
 public:
  explicit StreamedFit(const StudyFit& fit);

  /// @param columns axes and outputs of one sample; one with a missing value is left out
  void add(std::span<const double> columns);
  /// No rows come any more. Coefficients that the samples do not determine are NaN.
  FittedTerms solve();
  /// After `solve`, in a second pass: the largest residual.
  void add_residual(std::span<const double> columns);
  FittedTerms result() const { return result_; }

 private:
  bool row(std::span<const double> columns);
  void fold();

  const StudyFit* fit_;
  Eigen::MatrixXd stacked_;  ///< triangle on top, rows below
  Eigen::VectorXd row_;
  Eigen::Index filled_ = 0;
  FittedTerms result_;
};

}  // namespace sinew::inline v0
