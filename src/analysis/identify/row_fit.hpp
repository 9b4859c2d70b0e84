/// @file row_fit.hpp
/// Measured rows against those of an arm: errors, and the cost of a fit with its derivatives.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "analysis/identify/quantities.hpp"
#include "sinew/base/error.hpp"

namespace sinew::inline v1::identification {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// @param distances NaN where a row failed
MarkerErrors errors_of(std::vector<double> distances);

/// What rows and arm must have to be compared.
Expected<void> check(const MeasuredArm& arm, const MeasuredRows& rows);

/// A column of a row's sensitivities and what it counts: in a parameter's derivative.
struct Term {
  enum class Kind { plain, by_lag, by_play, by_gain } kind = Kind::plain;
  int column = 0;
  double weight = 1;  ///< for a tendon's pull: −gain, where that is a factor
  int tendon = 0;
};

/// The rows of a fit: where an arm puts the marker at each, and what that costs.
class Fit {
 public:
  Fit(MeasuredArm start, const std::vector<FitParameter>& parameters, const MeasuredRows& rows,
      const IdentifyOptions& options)
      : start_(completed(std::move(start))),
        parameters_(parameters),
        rows_(rows),
        options_(options),
        solver_(start_, ArmBasis{.model = options.model}),
        y_(rows.size() * at(solver_.size()), 0.0),
        failed_(rows.size(), false),
        predicted_(rows.size() * 3, not_known) {}

  const MeasuredArm& start() const { return start_; }
  const std::vector<double>& predicted() const { return predicted_; }

  /// Where the rows are, of this arm; of those chosen. Not of all where a stop was requested.
  void predict(const MeasuredArm& arm, std::span<const int> chosen) { run(arm, chosen, false); }

  MarkerErrors errors(std::span<const int> chosen, std::vector<double>* all = nullptr) const;

  /// Of a coordinate, from the distances' median: that of three normal coordinates is 1.538 of theirs.
  double noise(std::span<const int> chosen) const;

  struct Sums {
    double cost = 0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd normal;
  };
  /// Cost of the rows chosen at these coordinates, with its derivatives; `noise_` scales it. Not all of it
  /// where a stop was requested.
  Sums sums(const Eigen::VectorXd& x, std::span<const int> chosen);

  void set_noise(double noise) { noise_ = noise; }
  double noise_now() const { return noise_; }

  /// Σ of the scores of blocks. Not all of it where a stop was requested.
  Eigen::MatrixXd scores(const Eigen::VectorXd& x, std::span<const int> chosen, int& blocks);

 private:
  double distance(int row) const;

  std::vector<std::vector<Term>> terms(const MeasuredArm& arm) const;

  void run(const MeasuredArm& arm, std::span<const int> chosen, bool derivatives);

  MeasuredArm start_;
  const std::vector<FitParameter>& parameters_;
  const MeasuredRows& rows_;
  IdentifyOptions options_;
  ArmRows solver_;
  std::vector<double> y_;
  std::vector<bool> failed_;
  std::vector<double> predicted_;
  double noise_ = 1e-3;
  Sums sums_;
  bool collect_scores_ = false;
  std::map<int, Eigen::VectorXd> scores_;
};

}  // namespace sinew::inline v1::identification
