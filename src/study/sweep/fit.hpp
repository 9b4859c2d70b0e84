/// @file fit.hpp
/// Least squares over more samples than fit into memory: rows are folded into a triangle as they come.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "sinew/study/sweep.hpp"

namespace sinew::inline v1 {

/// One fit: a row a sample and column, all with the same coefficients. Householder's QR of the rows so far, R
/// with the right-hand side as last column; new rows are stacked under it and folded in, so that nothing is
/// squared (as normal equations would). Given coefficients need no first pass, but are counted in it.
class StreamedFit {
 public:
  StreamedFit(const Study& study, const StudyFit& fit);

  /// @param columns of one sample, as the study numbers them; one with a missing value is left out
  void add(std::span<const double> columns);
  /// No rows come any more. Coefficients that the samples do not determine are NaN.
  void solve();
  /// After `solve`, in a second pass: the residuals.
  void add_residual(std::span<const double> columns);
  FittedTerms result() const;

 private:
  /// Sums over one column.
  struct Sums {
    double residual = 0, column = 0;  ///< of squares
  };

  bool is_whole(std::span<const double> columns);
  void fold();
  void find_coefficients();

  const StudyFit* fit_;
  Eigen::MatrixXd stacked_;  ///< triangle on top, rows below
  Eigen::MatrixXd rows_;     ///< of one sample: an equation a column
  Eigen::Index filled_ = 0;
  std::vector<Sums> sums_;
  FittedTerms result_;
};

}  // namespace sinew::inline v1
