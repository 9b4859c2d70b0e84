#include "analysis/identify/row_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/identify/driven.hpp"

namespace sinew::inline v1::identification {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MarkerErrors errors_of(std::vector<double> distances) {
  MarkerErrors result;
  const std::size_t all = distances.size();
  std::erase_if(distances, [](double d) { return std::isnan(d); });
  result.rows = static_cast<int>(distances.size());
  result.failed = static_cast<int>(all) - result.rows;
  if (distances.empty()) return result;
  double sum = 0;
  for (const double d : distances) {
    sum += d * d;
    result.max = std::max(result.max, d);
  }
  result.rms = std::sqrt(sum / static_cast<double>(distances.size()));
  std::nth_element(distances.begin(), distances.begin() + static_cast<long>(distances.size() / 2),
                   distances.end());
  result.median = distances[distances.size() / 2];
  return result;
}

Expected<void> check(const MeasuredArm& arm, const MeasuredRows& rows) {
  const std::size_t n = rows.size(), tendons = arm.arm.tendons.size();
  if (n == 0) return failure("too_few", "rows", "there are no rows to compare with.");
  if (rows.pulls.size() != n * tendons)
    return failure("wrong_size", "pulls",
                   fmt::format("{} numbers for {} rows of {} tendons; give {}.", rows.pulls.size(), n,
                               tendons, n * tendons));
  if (!rows.time.empty() && rows.time.size() != n)
    return failure("wrong_size", "time", fmt::format("{} times for {} rows.", rows.time.size(), n));
  if (!rows.blocks.empty() && rows.blocks.size() != n)
    return failure("wrong_size", "blocks", fmt::format("{} blocks for {} rows.", rows.blocks.size(), n));
  const auto is_finite = [](double x) { return std::isfinite(x); };
  for (const auto& [name, values] :
       {std::pair<std::string_view, const std::vector<double>&>{"pulls", rows.pulls},
        {"markers", rows.markers},
        {"time", rows.time}})
    if (const auto bad = std::ranges::find_if_not(values, is_finite); bad != values.end())
      return failure(
          "not_a_number", name,
          fmt::format("number {} is not finite; leave out rows that lack one.", bad - values.begin()));
  for (const auto& [name, values] :
       {std::pair<std::string_view, const std::vector<double>&>{"drive.gain", arm.drive.gain},
        {"drive.offset", arm.drive.offset},
        {"drive.toe", arm.drive.toe}})
    if (!values.empty() && values.size() != tendons)
      return failure(
          "wrong_size", name,
          fmt::format("{} numbers for {} tendons; give one for each, or none.", values.size(), tendons));
  for (std::size_t i = 0; i < tendons; ++i)
    if (!(arm.arm.tendons[i].compliance > 0))
      return failure(
          "out_of_range", fmt::format("tendons[{}].compliance", i),
          "tendons that do not stretch are not identified in this version; give them a compliance, "
          "or a stretch, to start from.");
  return {};
}

MarkerErrors Fit::errors(std::span<const int> chosen, std::vector<double>* all) const {
  std::vector<double> distances;
  for (int k : chosen) {
    distances.push_back(distance(k));
    if (all) (*all)[at(k)] = distances.back();
  }
  return errors_of(std::move(distances));
}

double Fit::noise(std::span<const int> chosen) const {
  if (options_.noise > 0) return options_.noise;
  return std::max(1e-9, errors(chosen).median / 1.538);
}

Fit::Sums Fit::sums(const VectorXd& x, std::span<const int> chosen) {
  run(changed(start_, parameters_, x), chosen, true);
  Sums s = sums_;
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    const double prior = parameters_[p].prior, c = x[static_cast<Index>(p)];
    if (prior > 0) s.cost += 0.5 * c * c / (prior * prior);
  }
  return s;
}

MatrixXd Fit::scores(const VectorXd& x, std::span<const int> chosen, int& blocks) {
  collect_scores_ = true;
  scores_.clear();
  run(changed(start_, parameters_, x), chosen, true);
  collect_scores_ = false;
  const auto size = static_cast<Index>(parameters_.size());
  MatrixXd sum = MatrixXd::Zero(size, size);
  for (const auto& [block, score] : scores_) sum += score * score.transpose();
  blocks = static_cast<int>(scores_.size());
  return sum;
}

double Fit::distance(int row) const {
  if (failed_[at(row)]) return not_known;
  double sum = 0;
  for (std::size_t i = at(3 * row); i < at(3 * row + 3); ++i)
    sum += (predicted_[i] - rows_.markers[i]) * (predicted_[i] - rows_.markers[i]);
  return std::sqrt(sum);
}

std::vector<std::vector<Term>> Fit::terms(const MeasuredArm& arm) const {
  const ArmFields& f = solver_.fields();
  std::vector<std::vector<Term>> all(parameters_.size());
  for (std::size_t p = 0; p < parameters_.size(); ++p)
    for (const ArmField& field : parameters_[p].fields)
      each(arm, field, [&](int i, int m) {
        std::vector<Term>& out = all[p];
        using enum ArmQuantity;
        const auto plain = [&](int column, double weight = 1) {
          out.push_back({Term::Kind::plain, column, weight, 0});
        };
        const int k = static_cast<int>(field.quantity);
        switch (field.quantity) {
          case bending:
            plain(f.bending_x(m)), plain(f.bending_y(m));
            break;
          case bending_x:
            plain(f.bending_x(m));
            break;
          case bending_y:
            plain(f.bending_y(m));
            break;
          case torsion:
            plain(f.torsion(m));
            break;
          case curvature_x:
            plain(f.curvature(m, 0));
            break;
          case curvature_y:
            plain(f.curvature(m, 1));
            break;
          case angle:
            plain(f.angle(i, m));
            break;
          case radius:
            plain(f.radius(i, m));
            break;
          case compliance:
            plain(f.compliance(i));
            break;
          case pretension:
            plain(f.free_length(i), -arm.arm.tendons[at(i)].compliance);
            break;
          case toe:
            plain(f.toe(i));
            break;
          case offset:
            plain(f.free_length(i), -1);
            break;
          case gain:
            out.push_back({Term::Kind::by_gain, f.free_length(i), -arm.drive.gain[at(i)], i});
            break;
          case lag:
          case play:
            for (int t = 0; t < tendon_count(arm); ++t)
              out.push_back({field.quantity == lag ? Term::Kind::by_lag : Term::Kind::by_play,
                             f.free_length(t), -arm.drive.gain[at(t)], t});
            break;
          case mass:
            plain(f.mass());
            break;
          case tip_mass:
            plain(f.tip_mass());
            break;
          case gravity_x:
          case gravity_y:
          case gravity_z:
            plain(f.gravity(k - static_cast<int>(gravity_x)));
            break;
          case marker_x:
          case marker_y:
          case marker_z:
            plain(f.marker(k - static_cast<int>(marker_x)));
            break;
          case base_x:
          case base_y:
          case base_z:
            plain(f.base(k - static_cast<int>(base_x)));
            break;
          case tilt_x:
          case tilt_y:
          case tilt_z:
            plain(f.tilt(k - static_cast<int>(tilt_x)));
            break;
        }
      });
  return all;
}

void Fit::run(const MeasuredArm& arm, std::span<const int> chosen, bool derivatives) {
  solver_.set(arm);
  const Driven driven(rows_, tendon_count(arm), arm.drive);
  const std::size_t width = at(tendon_count(arm)), unknowns = at(solver_.size());
  const auto size = static_cast<Index>(parameters_.size());
  const auto all_terms = derivatives ? terms(arm) : std::vector<std::vector<Term>>{};
  std::vector<double> free_lengths(width);
  Eigen::Matrix3Xd by_field;
  constexpr Index batch = 64;
  MatrixXd J = MatrixXd::Zero(3 * batch, size);
  VectorXd r = VectorXd::Zero(3 * batch);
  Index filled = 0;
  sums_ = {};
  if (derivatives) {
    sums_.gradient.setZero(size);
    sums_.normal.setZero(size, size);
  }
  const double limit = options_.robust * noise_ * std::sqrt(3.0),
               scale = 1 / (noise_ * noise_ * std::max(1.0, options_.correlated));
  const auto add = [&] {
    sums_.normal.selfadjointView<Eigen::Lower>().rankUpdate(J.topRows(filled).transpose());
    sums_.gradient.noalias() += J.topRows(filled).transpose() * r.head(filled);
    filled = 0;
  };
  for (int k : chosen) {
    if (options_.stop.stop_requested()) return;
    for (std::size_t i = 0; i < width; ++i) {
      const ArmTendon& tendon = arm.arm.tendons[i];
      free_lengths[i] = solver_.straight_length(static_cast<int>(i)) -
                        arm.drive.gain[i] * driven.pulled[at(k) * width + i] - arm.drive.offset[i] -
                        tendon.compliance * tendon.pretension;
    }
    std::span<double> y(y_.data() + at(k) * unknowns, unknowns);
    failed_[at(k)] = solver_.solve(free_lengths, y) != Status::converged;
    if (failed_[at(k)]) {
      sums_.cost += scale * (10 * limit * limit);
      continue;
    }
    const Eigen::Vector3d place = solver_.marker();
    Eigen::Vector3d error;
    for (int i = 0; i < 3; ++i) {
      predicted_[at(3 * k + i)] = place[i];
      error[i] = place[i] - rows_.markers[at(3 * k + i)];
    }
    if (!derivatives) continue;
    const double d = error.norm(), weight = d <= limit ? 1 : limit / d;
    sums_.cost += scale * (d <= limit ? 0.5 * d * d : limit * (d - 0.5 * limit));
    solver_.sensitivities(by_field, collect_scores_);
    const double root = std::sqrt(scale * weight);
    for (Index p = 0; p < size; ++p) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Term& term : all_terms[static_cast<std::size_t>(p)]) {
        double w = term.weight;
        const std::size_t here = at(k) * width + at(term.tendon);
        if (term.kind == Term::Kind::by_gain) w *= driven.pulled[here];
        if (term.kind == Term::Kind::by_lag) w *= driven.by_lag[here];
        if (term.kind == Term::Kind::by_play) w *= driven.by_play[here];
        sum += w * by_field.col(term.column);
      }
      J.col(p).segment<3>(filled) = root * sum;
    }
    r.segment<3>(filled) = root * error;
    if (collect_scores_) {
      VectorXd& score = scores_[rows_.blocks.empty() ? k : rows_.blocks[at(k)]];
      const VectorXd one = J.middleRows(filled, 3).transpose() * r.segment<3>(filled);
      if (score.size() == 0)
        score = one;
      else
        score += one;
    }
    filled += 3;
    if (filled == 3 * batch) add();
  }
  if (derivatives) {
    add();
    sums_.normal.triangularView<Eigen::StrictlyUpper>() = sums_.normal.transpose();
  }
}

}  // namespace sinew::inline v1::identification
