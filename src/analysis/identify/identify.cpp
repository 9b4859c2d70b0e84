#include "sinew/analysis/identify.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/identify/row_fit.hpp"

namespace sinew::inline v1 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using identification::at;
using identification::changed;
using identification::check;
using identification::errors_of;
using identification::first_coordinate;
using identification::Fit;
using identification::is_of_masses;
using identification::not_known;
using identification::value_of;

}  // namespace

MeasuredArm measured(const Arm& arm) {
  const MeasuringSetup known = arm.measurement.value_or(MeasuringSetup{});
  return {arm, known.drive, known.marker};
}

Arm as_file(const MeasuredArm& arm) {
  Arm result = arm.arm;
  result.measurement = MeasuringSetup{arm.drive, arm.marker};
  return result;
}

Expected<std::vector<double>> predict_markers(const MeasuredArm& arm, const MeasuredRows& rows,
                                              ArmModel model, StopToken stop) {
  MeasuredRows filled = rows;
  if (filled.markers.empty() && !arm.arm.tendons.empty())
    filled.markers.assign(rows.pulls.size() / arm.arm.tendons.size() * 3, 0.0);
  if (auto fits = check(arm, filled); !fits) return tl::unexpected(fits.error());
  const std::vector<FitParameter> none;
  Fit fit(arm, none, filled, {.model = model, .stop = stop});
  std::vector<int> all(filled.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<int>(k);
  fit.predict(fit.start(), all);
  return fit.predicted();
}

std::vector<int> folds_of(const MeasuredRows& rows, int folds) {
  std::vector<int> result(rows.size());
  std::map<int, int> seen;
  for (std::size_t k = 0; k < result.size(); ++k) {
    const int block = rows.blocks.empty() ? static_cast<int>(k) : rows.blocks[k];
    const auto [found, is_new] = seen.emplace(block, static_cast<int>(seen.size()));
    result[k] = found->second % std::max(1, folds);
  }
  return result;
}

Expected<Identified> identify(const MeasuredArm& given, const std::vector<FitParameter>& parameters,
                              const MeasuredRows& rows, const IdentifyOptions& options) {
  if (auto fits = check(given, rows); !fits) return tl::unexpected(fits.error());
  if (parameters.empty())
    return failure("too_few", "parameters", "there is nothing to fit; name a quantity.");
  if (!options.held_out.empty() && options.held_out.size() != rows.size())
    return failure("wrong_size", "held_out",
                   fmt::format("{} entries for {} rows; give one for each, or none.", options.held_out.size(),
                               rows.size()));
  for (const FitParameter& parameter : parameters)
    for (const ArmField& field : parameter.fields)
      if (options.model == ArmModel::prb &&
          (field.quantity == ArmQuantity::curvature_x || field.quantity == ArmQuantity::curvature_y))
        return failure("not_available", parameter.name,
                       "links of the model prb are curved for good; fit curvatures by another model.");
  const bool has_channel = std::ranges::any_of(
      given.arm.sections, [](const ArmSection& section) { return section.discs.count == 0; });
  if (options.model == ArmModel::prb && has_channel)
    return failure("not_available", "model",
                   "joints (prb) are fitted to arms with discs alone; take rod or cc for channels.");
  Fit fit(given, parameters, rows, options);
  const auto size = static_cast<Index>(parameters.size());
  std::vector<int> train, held_out, all;
  for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
    const bool held = !options.held_out.empty() && options.held_out[at(k)];
    (held ? held_out : train).push_back(k);
    all.push_back(k);
  }
  if (train.empty())
    return failure("too_few", "held_out", "all rows are held out, and none is left to fit; hold out fewer.");
  Identified result;
  VectorXd x = VectorXd::Zero(size), lower(size), upper(size), precision(size);
  for (Index p = 0; p < size; ++p) {
    const FitParameter& parameter = parameters[static_cast<std::size_t>(p)];
    lower[p] = parameter.lower;
    upper[p] = parameter.upper;
    x[p] = first_coordinate(fit.start(), parameter);
    precision[p] = parameter.prior > 0 ? 1 / (parameter.prior * parameter.prior) : 0;
  }
  // a few hundred rows first, then all
  std::vector<std::vector<int>> stages;
  if (train.size() > 800) {
    std::vector<int> few;
    const std::size_t stride = train.size() / 300;
    for (std::size_t k = 0; k < train.size(); k += stride) few.push_back(train[k]);
    stages.push_back(std::move(few));
  }
  stages.push_back(train);
  {
    Fit first(given, parameters, rows, options);  // another one: its rows are no start for those of the fit
    first.predict(first.start(), train);
    result.before = first.errors(train);
  }
  fit.predict(changed(fit.start(), parameters, x), stages.front());
  MatrixXd normal = MatrixXd::Zero(size, size);
  result.errors.assign(rows.size(), not_known);
  const auto stop_requested = [&] {
    if (!options.stop.stop_requested()) return false;
    result.report.status = Status::stopped;
    return true;
  };
  bool done = false;
  for (const std::vector<int>& chosen : stages) {
    const auto keep = [&](const Fit::Sums& sums) {
      normal = sums.normal;
      result.train = fit.errors(chosen, &result.errors);
    };
    if (done) break;
    double damping = 1e-3, grow = 4;
    const bool is_last = &chosen == &stages.back();
    const int rounds = options.noise > 0 || (is_last && stages.size() > 1) ? 1 : 3;
    for (int round = 0; round < rounds && !done; ++round) {
      if (round > 0 || stages.size() == 1 || !is_last) {
        if (round == 0) fit.predict(changed(fit.start(), parameters, x), chosen);
        fit.set_noise(fit.noise(chosen));
      }
      result.report.status = Status::iteration_limit;
      Fit::Sums now = fit.sums(x, chosen);
      if (stop_requested()) {
        done = true;
        break;
      }
      keep(now);
      const double first_noise = fit.noise_now();
      const int most = round + 1 < rounds ? std::min(4, options.max_iterations) : options.max_iterations;
      for (int i = 0; i < most; ++i) {
        ++result.report.iterations;
        if (options.progress) options.progress(result.report.iterations, result.train.rms);
        VectorXd gradient = now.gradient + precision.cwiseProduct(x);
        MatrixXd H = now.normal;
        H.diagonal() += precision;
        std::vector<Index> free;
        for (Index p = 0; p < size; ++p)
          if (!((x[p] <= lower[p] && gradient[p] > 0) || (x[p] >= upper[p] && gradient[p] < 0)))
            free.push_back(p);
        VectorXd step = VectorXd::Zero(size);
        if (!free.empty()) {
          MatrixXd A = H(free, free);
          A.diagonal() += damping * H(free, free).diagonal();
          step(free) = -A.ldlt().solve(VectorXd(gradient(free)));
        }
        const VectorXd next = (x + step).cwiseMax(lower).cwiseMin(upper);
        step = next - x;
        const double predicted = -gradient.dot(step) - 0.5 * step.dot(H * step);
        if (!(predicted > options.tolerance * (now.cost + 1e-6) * (is_last ? 1 : 3))) {
          result.report.status = Status::converged;
          break;
        }
        const Fit::Sums there = fit.sums(next, chosen);
        if (stop_requested()) {
          done = true;
          break;
        }
        const double ratio = (now.cost - there.cost) / predicted;
        if (ratio > 1e-3) {
          x = next;
          now = there;
          keep(now);
          damping = std::max(1e-9, damping * std::max(1.0 / 3, 1 - std::pow(2 * ratio - 1, 3)));
          grow = 4;
        } else {
          damping *= grow;
          grow *= 2;
          if (damping > 1e9) {
            result.report.status = Status::stalled;
            break;
          }
        }
      }
      if (std::abs(fit.noise(chosen) / first_noise - 1) < 0.1) round = std::max(round, rounds - 2);
    }
  }
  result.arm = changed(fit.start(), parameters, x);
  MatrixXd middle = normal;
  if (!stop_requested()) {
    int blocks = 0;
    const MatrixXd scores = fit.scores(x, train, blocks);
    if (blocks > 2 * size && !stop_requested()) middle = scores;
  }
  if (!stop_requested()) {
    fit.predict(result.arm, all);
    if (!stop_requested()) {
      result.train = fit.errors(train, &result.errors);
      result.held_out = fit.errors(held_out, &result.errors);
      if (result.train.rows == 0) {
        result.report.status = Status::unreachable;
        result.report.message = std::string_view(
            "the arm has no equilibrium at any row; are counts positive where tendons are drawn in, and "
            "units "
            "right?");
      }
    }
  }
  result.noise = fit.noise_now();
  // what is known: scores of blocks are independent
  MatrixXd H = normal;
  H.diagonal() += precision;
  for (Index p = 0; p < size; ++p)
    if (!(H(p, p) > 0)) H(p, p) = 1e-12;
  const MatrixXd inverse = H.ldlt().solve(MatrixXd::Identity(size, size));
  middle.diagonal() += precision;
  result.covariance = inverse * middle * inverse;
  for (Index p = 0; p < size; ++p) {
    const FitParameter& parameter = parameters[static_cast<std::size_t>(p)];
    FittedParameter fitted;
    fitted.coordinate = x[p];
    fitted.coordinate_deviation = std::sqrt(result.covariance(p, p));
    fitted.start = value_of(fit.start(), parameter);
    fitted.value = is_of_masses(parameter) ? std::exp(x[p]) : value_of(result.arm, parameter);
    fitted.deviation = parameter.is_factor ? std::abs(fitted.value) * fitted.coordinate_deviation
                                           : fitted.coordinate_deviation;
    fitted.at_bound = x[p] <= lower[p] || x[p] >= upper[p];
    fitted.prior_share = std::min(1.0, precision[p] * inverse(p, p));
    result.parameters.push_back(fitted);
  }
  VectorXd scale(size);
  for (Index p = 0; p < size; ++p) scale[p] = precision[p] > 0 ? 1 / std::sqrt(precision[p]) : 1;
  const MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(scaled);
  for (Index p = 0; p < size; ++p) {
    if (eigen.eigenvalues()[p] > 1 || !(eigen.eigenvalues()[size - 1] > 0)) break;
    FlatDirection flat;
    flat.deviation = 1 / std::sqrt(std::max(eigen.eigenvalues()[p], 1e-14 * eigen.eigenvalues()[size - 1]));
    const VectorXd v = eigen.eigenvectors().col(p);
    flat.coefficients.assign(v.data(), v.data() + size);
    result.flat.push_back(std::move(flat));
  }
  // Of those that are as flat the order would be chance.
  std::ranges::stable_sort(result.flat, {}, [](const FlatDirection& one) {
    const auto& c = one.coefficients;
    const auto largest =
        std::ranges::max_element(c, {}, [](double part) { return std::abs(part); }) - c.begin();
    return std::pair(-std::round(1e6 * std::log(one.deviation)), largest);
  });
  return result;
}

Expected<HeldOut> hold_out(const MeasuredArm& start, const std::vector<FitParameter>& parameters,
                           const MeasuredRows& rows, const std::vector<int>& folds, IdentifyOptions options) {
  if (folds.size() != rows.size())
    return failure("wrong_size", "folds",
                   fmt::format("{} folds for {} rows; give one for each.", folds.size(), rows.size()));
  HeldOut result;
  result.by_row.assign(rows.size(), not_known);
  const int count = folds.empty() ? 0 : *std::ranges::max_element(folds) + 1;
  std::vector<double> seen;  // at rows of parts that are done
  for (int fold = 0; fold < count; ++fold) {
    options.held_out.assign(rows.size(), false);
    for (std::size_t k = 0; k < folds.size(); ++k) options.held_out[k] = folds[k] == fold;
    const auto part = identify(start, parameters, rows, options);
    if (!part) return tl::unexpected(part.error());
    if (part->report.status == Status::stopped) {
      result.is_complete = false;
      break;
    }
    for (std::size_t k = 0; k < folds.size(); ++k)
      if (folds[k] == fold) seen.push_back(result.by_row[k] = part->errors[k]);
  }
  result.errors = errors_of(std::move(seen));
  return result;
}

}  // namespace sinew::inline v1
