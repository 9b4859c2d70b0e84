#include "sinew/analysis/identify.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <numbers>

#include "analysis/arm_rows.hpp"

namespace sinew::inline v1 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
/// Between rows further apart nobody saw what the motors did: no lag is left of it.
constexpr double longest_step = 2;

// ---------------------------------------------------------------- quantities

/// What a quantity belongs to.
enum class Owner { section, passage, tendon, arm };

struct QuantityWords {
  ArmQuantity quantity;
  std::string_view name, unit;
  Owner owner;
  bool is_factor;
  double lower, upper, prior;  ///< of the coordinate
};

constexpr double ln(double x) {  // of the few numbers below, by its series
  double y = 0, t = (x - 1) / (x + 1), power = t;
  for (int k = 1; k < 200; k += 2, power *= t * t) y += 2 * power / k;
  return y;
}
constexpr double degrees = std::numbers::pi / 180;

constexpr QuantityWords quantities[] = {
    {ArmQuantity::bending, "bending", "N m^2", Owner::section, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::bending_x, "bending.x", "N m^2", Owner::section, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::bending_y, "bending.y", "N m^2", Owner::section, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::torsion, "torsion", "N m^2", Owner::section, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::curvature_x, "curvature.x", "1/m", Owner::section, false, -3, 3, 0.5},
    {ArmQuantity::curvature_y, "curvature.y", "1/m", Owner::section, false, -3, 3, 0.5},
    {ArmQuantity::angle, "angle", "rad", Owner::passage, false, -25 * degrees, 25 * degrees, 5 * degrees},
    {ArmQuantity::radius, "radius", "m", Owner::passage, true, ln(0.75), ln(1.33), ln(1.05)},
    {ArmQuantity::compliance, "compliance", "m/N", Owner::tendon, true, ln(0.01), ln(100), ln(3)},
    {ArmQuantity::pretension, "pretension", "N", Owner::tendon, false, 0, 50, 2},
    {ArmQuantity::toe, "toe", "m", Owner::tendon, false, 0, 6e-3, 2e-3},
    {ArmQuantity::offset, "offset", "m", Owner::tendon, false, -8e-3, 8e-3, 4e-3},
    {ArmQuantity::gain, "gain", "", Owner::tendon, true, ln(0.8), ln(1.25), ln(1.02)},
    {ArmQuantity::lag, "lag", "s", Owner::arm, false, 0, 1, 0.1},
    {ArmQuantity::play, "play", "m", Owner::arm, false, 0, 2e-3, 2e-4},
    {ArmQuantity::gravity_x, "gravity.x", "m/s^2", Owner::arm, false, -9.81, 9.81, 5},
    {ArmQuantity::gravity_y, "gravity.y", "m/s^2", Owner::arm, false, -9.81, 9.81, 5},
    {ArmQuantity::gravity_z, "gravity.z", "m/s^2", Owner::arm, false, -9.81, 9.81, 5},
    {ArmQuantity::mass, "mass", "", Owner::arm, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::tip_mass, "tip_mass", "kg", Owner::arm, false, 0, 0.05, 0.005},
    {ArmQuantity::marker_x, "marker.x", "m", Owner::arm, false, -0.03, 0.03, 0.005},
    {ArmQuantity::marker_y, "marker.y", "m", Owner::arm, false, -0.03, 0.03, 0.005},
    {ArmQuantity::marker_z, "marker.z", "m", Owner::arm, false, -0.03, 0.03, 0.005},
    {ArmQuantity::base_x, "base.x", "m", Owner::arm, false, -0.05, 0.05, 0.01},
    {ArmQuantity::base_y, "base.y", "m", Owner::arm, false, -0.05, 0.05, 0.01},
    {ArmQuantity::base_z, "base.z", "m", Owner::arm, false, -0.05, 0.05, 0.01},
    {ArmQuantity::tilt_x, "tilt.x", "rad", Owner::arm, false, -20 * degrees, 20 * degrees, 5 * degrees},
    {ArmQuantity::tilt_y, "tilt.y", "rad", Owner::arm, false, -20 * degrees, 20 * degrees, 5 * degrees},
    {ArmQuantity::tilt_z, "tilt.z", "rad", Owner::arm, false, -20 * degrees, 20 * degrees, 5 * degrees},
};
const QuantityWords& words_of(ArmQuantity quantity) { return quantities[static_cast<int>(quantity)]; }

int section_count(const MeasuredArm& arm) { return static_cast<int>(arm.arm.sections.size()); }
int tendon_count(const MeasuredArm& arm) { return static_cast<int>(arm.arm.tendons.size()); }
using identification::at;

/// Calls with each section, or tendon, or passage that a field means: visit(tendon, section).
template <class Visit>
void each(const MeasuredArm& arm, const ArmField& field, Visit visit) {
  const Owner owner = words_of(field.quantity).owner;
  if (owner == Owner::arm) return visit(-1, -1);
  if (owner == Owner::section) {
    for (int m = 0; m < section_count(arm); ++m)
      if (field.section < 0 || field.section == m) visit(-1, m);
    return;
  }
  for (int i = 0; i < tendon_count(arm); ++i) {
    if (field.tendon >= 0 && field.tendon != i) continue;
    if (owner == Owner::tendon) {
      visit(i, -1);
      continue;
    }
    for (int m = 0; m <= arm.arm.tendons[at(i)].section(); ++m)
      if (field.section < 0 || field.section == m) visit(i, m);
  }
}

/// Calls with each number of a quantity.
template <class Visit>
void numbers_of(MeasuredArm& arm, ArmQuantity quantity, int tendon, int section, Visit visit) {
  Arm& body = arm.arm;
  const auto ends = [&](double CrossSection::*member) {
    visit(body.sections[at(section)].start.*member);
    visit(body.sections[at(section)].end.*member);
  };
  const auto k = static_cast<int>(quantity);
  switch (quantity) {
    case ArmQuantity::bending:
      ends(&CrossSection::bending_x);
      [[fallthrough]];
    case ArmQuantity::bending_y:
      return ends(&CrossSection::bending_y);
    case ArmQuantity::bending_x:
      return ends(&CrossSection::bending_x);
    case ArmQuantity::torsion:
      return ends(&CrossSection::torsion);
    case ArmQuantity::curvature_x:
      return visit(body.sections[at(section)].curvature[0]);
    case ArmQuantity::curvature_y:
      return visit(body.sections[at(section)].curvature[1]);
    case ArmQuantity::angle: {
      TendonRoute& route = body.tendons[at(tendon)].routes[at(section)];
      visit(route.start_angle);
      return visit(route.end_angle);
    }
    case ArmQuantity::radius: {
      TendonRoute& route = body.tendons[at(tendon)].routes[at(section)];
      visit(route.start_radius);
      return visit(route.end_radius);
    }
    case ArmQuantity::compliance:
      return visit(body.tendons[at(tendon)].compliance);
    case ArmQuantity::pretension:
      return visit(body.tendons[at(tendon)].pretension);
    case ArmQuantity::toe:
      return visit(arm.drive.toe[at(tendon)]);
    case ArmQuantity::offset:
      return visit(arm.drive.offset[at(tendon)]);
    case ArmQuantity::gain:
      return visit(arm.drive.gain[at(tendon)]);
    case ArmQuantity::lag:
      return visit(arm.drive.lag);
    case ArmQuantity::play:
      return visit(arm.drive.play);
    case ArmQuantity::mass:
      for (ArmSection& part : body.sections) {
        visit(part.start.mass);
        visit(part.end.mass);
        visit(part.discs.mass);
      }
      return;
    case ArmQuantity::tip_mass:
      return visit(body.tip_mass);
    case ArmQuantity::gravity_x:
    case ArmQuantity::gravity_y:
    case ArmQuantity::gravity_z:
      return visit(body.gravity[at(k - static_cast<int>(ArmQuantity::gravity_x))]);
    case ArmQuantity::marker_x:
    case ArmQuantity::marker_y:
    case ArmQuantity::marker_z:
      return visit(arm.marker.place[at(k - static_cast<int>(ArmQuantity::marker_x))]);
    case ArmQuantity::base_x:
    case ArmQuantity::base_y:
    case ArmQuantity::base_z:
      return visit(arm.marker.base[at(k - static_cast<int>(ArmQuantity::base_x))]);
    case ArmQuantity::tilt_x:
    case ArmQuantity::tilt_y:
    case ArmQuantity::tilt_z:
      return visit(arm.marker.tilt[at(k - static_cast<int>(ArmQuantity::tilt_x))]);
  }
}

/// With a gain and an offset of every tendon.
MeasuredArm completed(MeasuredArm arm) {
  arm.drive.gain.resize(arm.arm.tendons.size(), 1.0);
  arm.drive.toe.resize(arm.arm.tendons.size(), 0.0);
  arm.drive.offset.resize(arm.arm.tendons.size(), 0.0);
  return arm;
}

/// Masses change by a factor, and have no value in common.
bool is_of_masses(const FitParameter& parameter) {
  return parameter.fields.front().quantity == ArmQuantity::mass;
}

double value_of(const MeasuredArm& arm, const FitParameter& parameter) {
  if (is_of_masses(parameter)) return 1;
  MeasuredArm copy = arm;
  double value = 0;
  bool found = false;
  each(copy, parameter.fields.front(), [&](int tendon, int section) {
    numbers_of(copy, parameter.fields.front().quantity, tendon, section, [&](double& x) {
      if (!found) value = x;
      found = true;
    });
  });
  return value;
}

/// Where the fit begins. A toe of 0 has no derivative of its own: it begins at its prior, and 0 stays what
/// the prior draws it to.
double first_coordinate(const MeasuredArm& start, const FitParameter& parameter) {
  MeasuredArm copy = start;
  bool has_zero = false;
  for (const ArmField& field : parameter.fields)
    if (field.quantity == ArmQuantity::toe)
      each(start, field, [&](int tendon, int section) {
        numbers_of(copy, field.quantity, tendon, section,
                   [&](double& toe) { has_zero = has_zero || toe == 0; });
      });
  constexpr double usual_toe = 2e-3;  // [m]
  return has_zero ? std::min(usual_toe, parameter.upper) : 0;
}

MeasuredArm changed(const MeasuredArm& start, const std::vector<FitParameter>& parameters,
                    const VectorXd& x) {
  MeasuredArm arm = start;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double c = x[static_cast<Index>(p)], factor = std::exp(c);
    for (const ArmField& field : parameters[p].fields)
      each(start, field, [&](int tendon, int section) {
        numbers_of(arm, field.quantity, tendon, section,
                   [&](double& number) { number = parameters[p].is_factor ? number * factor : number + c; });
      });
  }
  return arm;
}

// ---------------------------------------------------------------- drives

/// What the motors' counts become: after play and lag, and by what these change it.
struct Driven {
  std::vector<double> pulled, by_lag, by_play;  ///< rows × tendons

  Driven(const MeasuredRows& rows, int tendons, const TendonDrive& drive) {
    const std::size_t n = rows.size(), width = at(tendons);
    pulled.resize(n * width);
    by_lag.assign(n * width, 0);
    by_play.assign(n * width, 0);
    for (std::size_t i = 0; i < width; ++i) {
      double left = 0, left_by_play = 0;  // where play left the tendon
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t here = k * width + i;
        const double counted = rows.pulls[here], half = 0.5 * drive.play;
        double now = k == 0 ? counted : left, now_by_play = k == 0 ? 0 : left_by_play;
        if (now <= counted - half) {
          now = counted - half;
          now_by_play = -0.5;
        } else if (now >= counted + half) {
          now = counted + half;
          now_by_play = 0.5;
        }
        const double step = k == 0 || rows.time.empty() ? 1e9 : rows.time[k] - rows.time[k - 1];
        pulled[here] = now;
        by_play[here] = now_by_play;
        if (step > 0 && step < longest_step) {
          // first order, the count linear between rows
          const std::size_t before = here - width;
          const double rate = (now - left) / step, rate_by_play = (now_by_play - left_by_play) / step,
                       decay = drive.lag > 0 ? std::exp(-step / drive.lag) : 0,
                       behind = pulled[before] - left + drive.lag * rate;
          pulled[here] = now - drive.lag * rate + behind * decay;
          by_play[here] = now_by_play - drive.lag * rate_by_play +
                          (by_play[before] - left_by_play + drive.lag * rate_by_play) * decay;
          by_lag[here] = -rate + (by_lag[before] + rate) * decay;
          if (drive.lag > 0) by_lag[here] += behind * decay * step / (drive.lag * drive.lag);
        }
        left = now;
        left_by_play = now_by_play;
      }
    }
  }
};

// ---------------------------------------------------------------- the fit

/// @param distances NaN where a row failed
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

/// A column of a row's sensitivities and what it counts: in a parameter's derivative.
struct Term {
  enum class Kind { plain, by_lag, by_play, by_gain } kind = Kind::plain;
  int column = 0;
  double weight = 1;  ///< for a tendon's pull: −gain, where that is a factor
  int tendon = 0;
};

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

  MarkerErrors errors(std::span<const int> chosen, std::vector<double>* all = nullptr) const {
    std::vector<double> distances;
    for (int k : chosen) {
      distances.push_back(distance(k));
      if (all) (*all)[at(k)] = distances.back();
    }
    return errors_of(std::move(distances));
  }

  /// Of a coordinate, from the distances' median: that of three normal coordinates is 1.538 of theirs.
  double noise(std::span<const int> chosen) const {
    if (options_.noise > 0) return options_.noise;
    return std::max(1e-9, errors(chosen).median / 1.538);
  }

  struct Sums {
    double cost = 0;
    VectorXd gradient;
    MatrixXd normal;
  };
  /// Cost of the rows chosen at these coordinates, with its derivatives; `noise_` scales it. Not all of it
  /// where a stop was requested.
  Sums sums(const VectorXd& x, std::span<const int> chosen) {
    run(changed(start_, parameters_, x), chosen, true);
    Sums s = sums_;
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      const double prior = parameters_[p].prior, c = x[static_cast<Index>(p)];
      if (prior > 0) s.cost += 0.5 * c * c / (prior * prior);
    }
    return s;
  }

  void set_noise(double noise) { noise_ = noise; }
  double noise_now() const { return noise_; }

  /// Σ of the scores of blocks. Not all of it where a stop was requested.
  MatrixXd scores(const VectorXd& x, std::span<const int> chosen, int& blocks) {
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

 private:
  double distance(int row) const {
    if (failed_[at(row)]) return not_known;
    double sum = 0;
    for (std::size_t i = at(3 * row); i < at(3 * row + 3); ++i)
      sum += (predicted_[i] - rows_.markers[i]) * (predicted_[i] - rows_.markers[i]);
    return std::sqrt(sum);
  }

  std::vector<std::vector<Term>> terms(const MeasuredArm& arm) const {
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

  void run(const MeasuredArm& arm, std::span<const int> chosen, bool derivatives) {
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
  std::map<int, VectorXd> scores_;
};

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

namespace {

/// Soft tendons and no weight: only directions count here, and numbers of a file that are far off buckle the
/// arm.
MeasuredArm softened(MeasuredArm arm) {
  arm.arm.gravity = {0, 0, 0};
  for (ArmTendon& tendon : arm.arm.tendons) {
    double bends = 0;
    for (std::size_t m = 0; m < tendon.routes.size(); ++m) {
      const double radius = tendon.routes[m].start_radius;
      bends += radius * radius * arm.arm.sections[m].length / arm.arm.sections[m].start.bending_x;
    }
    tendon.compliance = std::max(tendon.compliance, bends);
    tendon.pretension = 0;
  }
  return arm;
}

/// Some of the rows, evenly: a map is of few numbers, and rows may be many.
MeasuredRows thinned(const MeasuredRows& rows, std::size_t most) {
  const std::size_t count = rows.size(), stride = (count + most - 1) / std::max<std::size_t>(most, 1),
                    tendons = count > 0 ? rows.pulls.size() / count : 0;
  if (stride <= 1) return rows;
  MeasuredRows few;
  for (std::size_t k = 0; k < count; k += stride) {
    few.pulls.insert(few.pulls.end(), rows.pulls.begin() + static_cast<long>(k * tendons),
                     rows.pulls.begin() + static_cast<long>((k + 1) * tendons));
    few.markers.insert(few.markers.end(), rows.markers.begin() + static_cast<long>(3 * k),
                       rows.markers.begin() + static_cast<long>(3 * k + 3));
  }
  return few;
}

/// Correlation of markers across the arm as complex numbers: its argument is a turn, its size the agreement.
std::complex<double> correlation(const std::vector<double>& predicted, const std::vector<double>& measured,
                                 bool mirrored) {
  const auto across = [](const std::vector<double>& markers, std::size_t k) {
    return std::complex<double>(markers[3 * k], markers[3 * k + 1]);
  };
  std::vector<std::size_t> known;
  for (std::size_t k = 0; 3 * k < predicted.size(); ++k)
    if (!std::isnan(predicted[3 * k])) known.push_back(k);
  std::complex<double> mean_predicted, mean_measured, sum;
  for (const std::size_t k : known) {
    mean_predicted += across(predicted, k);
    mean_measured += across(measured, k);
  }
  const auto count = static_cast<double>(std::max<std::size_t>(known.size(), 1));
  double of_predicted = 0, of_measured = 0;
  for (const std::size_t k : known) {
    const std::complex<double> p = across(predicted, k) - mean_predicted / count,
                               m = across(measured, k) - mean_measured / count;
    sum += m * (mirrored ? p : std::conj(p));
    of_predicted += std::norm(p);
    of_measured += std::norm(m);
  }
  return sum / std::sqrt(std::max(1e-300, of_predicted * of_measured));
}

}  // namespace

Expected<TendonMap> map_tendons(const MeasuredArm& arm, const MeasuredRows& all, ArmModel model,
                                StopToken stop) {
  if (auto fits = check(arm, all); !fits) return tl::unexpected(fits.error());
  const MeasuredRows rows = thinned(all, 400);
  // As long as no tendon is slack, counts the other way are a half turn: then counts are what they should be.
  constexpr double least_gain = 0.02;
  TendonMap best;
  for (int sign : {1, -1}) {
    MeasuredRows turned = rows;
    for (double& pull : turned.pulls) pull *= sign;
    std::complex<double> straight, mirrored;
    // The arm as it is, where it is about right, tells a sign from a half turn by which tendons are slack.
    for (const MeasuredArm& one : {arm, softened(arm)}) {
      const auto predicted = predict_markers(one, turned, model, stop);
      if (!predicted) return tl::unexpected(predicted.error());
      const auto better = [](std::complex<double>& known, std::complex<double> found) {
        if (std::abs(found) > std::abs(known)) known = found;
      };
      const auto found = correlation(*predicted, rows.markers, false);
      if (sign > 0) best.as_given = std::max(best.as_given, found.real());
      better(straight, found);
      better(mirrored, correlation(*predicted, rows.markers, true));
    }
    for (const auto& [found, is_mirrored] : {std::pair{straight, false}, std::pair{mirrored, true}}) {
      const double agreement = std::abs(found);
      const bool is_first = sign > 0 && !is_mirrored;
      if (is_first || agreement > best.agreement + least_gain) {
        if (!is_first) best.next = std::max(best.next, best.agreement);
        best.sign = sign;
        best.mirrored = is_mirrored;
        best.turn = std::arg(found);
        best.agreement = agreement;
      } else {
        best.next = std::max(best.next, agreement);
      }
    }
  }
  return best;
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

MeasuredArm mapped(const MeasuredArm& arm, const TendonMap& map) {
  MeasuredArm result = arm;
  const double sense = map.mirrored ? -1 : 1;
  for (ArmTendon& tendon : result.arm.tendons)
    for (TendonRoute& route : tendon.routes) {
      route.start_angle = map.turn + sense * route.start_angle;
      route.end_angle = map.turn + sense * route.end_angle;
    }
  return result;
}

std::string usual_fit(const MeasuredArm& arm, const MeasuredRows& rows, ArmModel model) {
  std::string names = "sections.bending,sections.angle,sections.compliance";
  if (model != ArmModel::prb) names += ",sections.curvature";
  names += ",tendons.offset,tendons.toe";
  const bool has_mass =
      arm.arm.tip_mass > 0 || std::ranges::any_of(arm.arm.sections, [](const ArmSection& one) {
        return one.start.mass > 0 || one.end.mass > 0 || (one.discs.count > 0 && one.discs.mass > 0);
      });
  if (has_mass) names += ",gravity";
  names += ",marker,base,tilt.x,tilt.y";
  if (!rows.time.empty()) names += ",lag";
  return names;
}

Expected<std::vector<FitParameter>> fit_parameters(const MeasuredArm& given, std::string_view names) {
  const MeasuredArm arm = completed(given);
  std::vector<FitParameter> result;
  while (!names.empty()) {
    const std::size_t comma = names.find(',');
    std::string_view name = names.substr(0, comma);
    names = comma == std::string_view::npos ? std::string_view{} : names.substr(comma + 1);
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    std::string_view of;  // whom there is one for
    for (std::string_view owner : {"sections", "tendons", "passages"})
      if (name.starts_with(owner) && name.size() > owner.size() && name[owner.size()] == '.') {
        of = owner;
        name.remove_prefix(owner.size() + 1);
      }
    std::vector<const QuantityWords*> found;
    for (const QuantityWords& words : quantities)
      if (words.name == name) found.push_back(&words);
    if (found.empty())
      for (const QuantityWords& words : quantities)
        if (words.name.size() == name.size() + 2 && words.name.starts_with(name) &&
            words.name[name.size()] == '.')
          found.push_back(&words);
    if (found.empty() && name == "friction")
      return failure(
          "not_available", name,
          "rows are compared as if tendons slid freely: friction depends on the way that they came, "
          "which rows at rest do not tell. What motors lose when they turn back is play, and "
          "what comes late is lag; fit these.");
    if (found.empty()) {
      std::string known;
      for (const QuantityWords& words : quantities)
        known += (known.empty() ? "" : ", ") + std::string(words.name);
      return failure("unknown_name", name, fmt::format("no quantity of an arm; there are {}.", known));
    }
    bool is_double = false;
    for (const QuantityWords* words : found) {
      const auto one = [&](std::string label, int section, int tendon, std::vector<ArmField> fields) {
        if (fields.empty()) fields.push_back({words->quantity, section, tendon});
        FitParameter p{.name = std::move(label),
                       .unit = std::string(words->unit),
                       .fields = std::move(fields),
                       .is_factor = words->is_factor,
                       .lower = words->lower,
                       .upper = words->upper,
                       .prior = words->prior};
        const bool is_gravity = words->unit == "m/s^2";
        if (!p.is_factor && (p.lower == 0 || is_gravity)) {  // bounds of the number, not of its change
          const double value = value_of(arm, p);
          p.lower = std::min(p.lower - value, 0.0);
          p.upper = std::max(p.upper - value, 0.0);
        }
        const auto has_name = [&](const FitParameter& other) { return other.name == p.name; };
        is_double = is_double || std::ranges::any_of(result, has_name);
        result.push_back(std::move(p));
      };
      const std::string base(words->name);
      if (of.empty()) {
        one(base, -1, -1, {});
      } else if (of == "sections" && words->owner != Owner::arm) {
        for (int m = 0; m < section_count(arm); ++m) {
          std::vector<ArmField> fields;
          if (words->owner != Owner::section)  // the tendons that end there
            for (int i = 0; i < tendon_count(arm); ++i)
              if (arm.arm.tendons[at(i)].section() == m) fields.push_back({words->quantity, -1, i});
          if (words->owner != Owner::section && fields.empty()) continue;
          one(fmt::format("sections[{}].{}", m, base), m, -1, std::move(fields));
        }
      } else if (of == "tendons" && (words->owner == Owner::tendon || words->owner == Owner::passage)) {
        for (int i = 0; i < tendon_count(arm); ++i) one(fmt::format("tendons[{}].{}", i, base), -1, i, {});
      } else if (of == "passages" && words->owner == Owner::passage) {
        for (int i = 0; i < tendon_count(arm); ++i)
          for (int m = 0; m < arm.arm.tendons[at(i)].section(); ++m)
            one(fmt::format("tendons[{}].sections[{}].{}", i, m, base), m, i, {});
      } else {
        return failure("not_available", name, fmt::format("{} have no {} of their own.", of, base));
      }
    }
    if (is_double)
      return failure("duplicate_name", name, "is named twice; the rows could not tell which; keep one.");
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
