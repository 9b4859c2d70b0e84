#include "kinematics/arms/sense_search.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "math/linalg.hpp"

namespace sinew::inline v1 {
namespace {

/// Dampings that are tried [1]: from the least, which doubles, they pass what any radius needs, and a matrix
/// that no damping makes regular ends here.
constexpr int most_dampings = 200;
/// The least damping over the largest square of the rates [1]: some tens of times what rounding leaves of it.
constexpr double least_damping = 1e-14;

/// Steps of a search, those that are taken back with them [1]: each costs an equilibrium, and a search that
/// takes this many goes to and fro.
constexpr int most_wrench_steps = 200;
/// A share of the squares by which rounding may raise them [1].
constexpr double rounding_of_squares = 1e-9;
/// A radius that is less than this share of the wrench [1] changes the squares by no more than rounding ...
constexpr double least_radius = 1e-7;
/// ... and a step that is less than this share of it is as good as none [1].
constexpr double least_step = 1e-9;
/// In place of the size of a wrench that is 0, which has no shares [N].
constexpr double least_wrench = 1e-6;
/// Of a step that was taken back the radius of the next [1], and by what a radius grows after one that used
/// more than half of it [1]: shorter at once, for a step costs an equilibrium, and longer as quickly, for the
/// first is a guess.
constexpr double shorter_radius = 0.25, longer_radius = 3;
/// What rates promise of the squares is more than rounding where it is more than this [1] and more than this
/// share of them [1].
constexpr double least_promise = 1e-3, promised_share = 1e-2;
/// Below this ratio of eigenvalues [1] rounding hides the wrench's worst known direction: a slender arm
/// yields a million times more across than along, so that its squares have 1e-12.
constexpr double smallest_ratio = 1e-15;

/// Gauss's and Newton's method, damped to a radius.
class WrenchSteps {
 public:
  WrenchSteps(const WrenchSearch& search, LoadedBody& body)
      : search_(search),
        body_(body),
        wrench_(search.first),
        radius_(search.usual) {
    sensed_.wrench = search.first;
  }
  FoundWrench run() {
    bool from_last = search_.from_last;
    int spent = 0;
    for (int round = 0; round < most_wrench_steps && spent < search_.most_work; ++round) {
      load(from_last, round, spent);
      if (sensed_.report.status == Status::bad_input || sensed_.report.status == Status::unsupported ||
          sensed_.report.status == Status::stopped)
        return sensed_;
      from_last = sensed_.report.is_solved();
      double misfit = 1e300;
      Comparison with;
      if (sensed_.report.is_solved() && body_.compare(with)) {
        misfit = squares_of(with.off);
      } else if (round == 0) {  // nothing to begin from
        if (sensed_.report.is_solved())
          sensed_.report = {Status::singular, 0, sensed_.report.residual,
                            FixedText<240>("the equilibrium is a fold: it has no rates")};
        return sensed_;
      }
      if (!(misfit < before_ * (1 + rounding_of_squares)) && round > 0) {  // a shorter one from where it was
        take(-1);
        radius_ = shorter_radius * step_size();
        if (radius_ < least_radius * std::max(wrench_size(), least_wrench)) {  // as near as rounding lets it
          load(from_last, round, spent);
          if (sensed_.report.is_solved() && is_hindered()) return hindered();
          return sensed_.report.is_solved() ? with_covariance() : sensed_;
        }
        step_ = step_within_radius();
        take(1);
        continue;
      }
      if (round > 0 && step_size() > 0.5 * radius_) radius_ *= longer_radius;
      before_ = misfit;
      set_normal_equations(with);
      sensed_.misfit = std::sqrt(misfit / static_cast<double>(with.off.size()));
      sensed_.measured = with.off.size();
      sensed_.wrench = wrench_;
      step_ = step_within_radius();
      if (step_size() < least_step * std::max(wrench_size(), least_wrench)) return with_covariance();
      take(1);
    }
    return unsettled();
  }

 private:
  /// Moments count by the length.
  double scale(std::size_t k) const { return search_.components[k] < 3 ? 1.0 : search_.length; }
  void load(bool from_last, int round, int& spent) {
    sensed_.report = body_.load(wrench_, from_last);
    spent += 1 + sensed_.report.iterations;
    sensed_.report.iterations = round;
  }
  static double squares_of(const std::vector<double>& off) {
    double sum = 0;
    for (const double x : off) sum += x * x;
    return sum;
  }
  void take(double sign) {
    for (std::size_t k = 0; k < search_.unknowns; ++k) wrench_[search_.components[k]] += sign * step_[k];
  }
  double step_size() const {
    double size = 0;
    for (std::size_t k = 0; k < search_.unknowns; ++k) size = std::max(size, std::abs(step_[k]) / scale(k));
    return size;
  }
  double wrench_size() const {
    double size = 0;
    for (std::size_t k = 0; k < search_.unknowns; ++k)
      size = std::max(size, std::abs(wrench_[search_.components[k]]) / scale(k));
    return size;
  }
  void set_normal_equations(const Comparison& with) {
    const auto& [off, rows] = with;
    const auto& which = search_.components;
    const std::size_t unknowns = search_.unknowns;
    normal_.assign(unknowns * unknowns, 0.0);
    side_.assign(unknowns, 0.0);
    for (std::size_t i = 0; i < unknowns; ++i)
      for (std::size_t r = 0; r < off.size(); ++r) {
        side_[i] += rows[r * 6 + which[i]] * scale(i) * off[r];
        for (std::size_t j = 0; j < unknowns; ++j)
          normal_[i * unknowns + j] += rows[r * 6 + which[i]] * scale(i) * rows[r * 6 + which[j]] * scale(j);
      }
  }
  /// What lessens the squares most within a radius: damped until it is short enough. A slender arm hardly
  /// stretches, so that along it the undamped step asks for forces that bend it anywhere.
  std::array<double, 6> step_within_radius() const {
    const std::size_t count = side_.size();
    const auto n = static_cast<Eigen::Index>(count);
    double largest = 0, damping = 0;
    for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, normal_[i * count + i]);
    std::vector<double> damped, found(count);
    std::array<double, 6> step{};
    for (int tries = 0; tries < most_dampings; ++tries) {
      damped = normal_;
      for (std::size_t i = 0; i < count; ++i) damped[i * count + i] += damping;
      double longest = 1e300;
      if (solve({damped.data(), n, n}, {side_.data(), n, 1}, found)) {
        longest = 0;
        for (const double x : found) longest = std::max(longest, std::abs(x));
      }
      if (longest <= radius_) break;
      damping = damping > 0 ? 2 * damping : least_damping * largest;
    }
    for (std::size_t i = 0; i < count; ++i) step[i] = found[i] * scale(i);
    return step;
  }
  FoundWrench with_covariance() {
    const std::size_t unknowns = search_.unknowns;
    const auto& which = search_.components;
    std::vector<double> identity(unknowns * unknowns, 0.0), inverse(unknowns * unknowns), values(unknowns);
    for (std::size_t i = 0; i < unknowns; ++i) identity[i * unknowns + i] = 1;
    const auto n = static_cast<Eigen::Index>(unknowns);
    symmetric_eigenvalues({normal_.data(), n, n}, values);
    if (!(values.front() > smallest_ratio * values.back()) ||
        !solve({normal_.data(), n, n}, {identity.data(), n, n}, inverse)) {
      sensed_.report = {
          Status::singular, sensed_.report.iterations, sensed_.report.residual,
          FixedText<240>("what is measured does not tell the wrench: measure more, or ask the force alone")};
      return sensed_;
    }
    sensed_.condition = std::sqrt(values.back() / values.front());
    for (std::size_t i = 0; i < unknowns; ++i)
      for (std::size_t j = 0; j < unknowns; ++j)
        sensed_.covariance[which[i] * 6 + which[j]] = inverse[i * unknowns + j] * scale(i) * scale(j);
    return sensed_;
  }
  /// Whether rates promise a smaller misfit where no step leads to one.
  bool is_hindered() const {
    const auto n = static_cast<Eigen::Index>(side_.size());
    std::vector<double> normal = normal_, step(side_.size());
    if (!solve({normal.data(), n, n}, {side_.data(), n, 1}, step)) return false;
    double promised = 0;
    for (std::size_t i = 0; i < step.size(); ++i) promised += side_[i] * step[i];
    return promised > std::max(least_promise, promised_share * before_);
  }
  FoundWrench hindered() {
    sensed_.report.status = Status::stalled;
    sensed_.report.message = FixedText<240>(
        "the search for a wrench ends where rates promise a smaller misfit and no step leads to one: "
        "wrenches "
        "on the way may hold in another equilibrium or in none; give a start nearer to what was measured");
    return sensed_;
  }
  FoundWrench unsettled() {
    sensed_.report = {
        Status::iteration_limit, sensed_.report.iterations, sensed_.report.residual,
        FixedText<240>("no wrench explains what was measured better, nor does the search settle: "
                       "what is measured may contradict itself")};
    return sensed_;
  }

  const WrenchSearch& search_;
  LoadedBody& body_;
  FoundWrench sensed_;
  std::array<double, 6> wrench_, step_{};  ///< a step is of the unknowns
  double before_ = 1e300, radius_;         ///< squares at the step that was taken last [1]; [N]
  std::vector<double> normal_, side_;      ///< of its linear least squares
};

/// How far along the worst known direction another wrench is looked for, in standard deviations [1]: from
/// there the search leads to one that is up to twice as far, as where equilibria fold.
constexpr double deviations_away = 3;
/// Another wrench is farther from the first than this many standard deviations [1], and its misfit is no
/// larger by more than this [1]; where misfits differ by less than this [1] both explain as well.
constexpr double least_deviations = 0.5, acceptable_misfit = 1, same_misfit = 0.1;
/// Standard deviations of less than this share of a force that bends much [1] are of a wrench near which
/// nothing else is: within them the body is linear.
constexpr double linear_share = 0.03;
/// Equilibria and their Newton's steps of the search for another [1].
constexpr int most_work_of_another = 500;

/// Other wrenches that explain what was measured as well, along the direction in which it tells least.
class Alternatives {
 public:
  Alternatives(const WrenchSearch& search, LoadedBody& body) : search_(search), body_(body) {}
  FoundWrench least_of(const FoundWrench& found) {
    if (found.report.status != Status::converged || !(found.misfit < large_misfit)) return found;
    set_direction(found);
    if (!(size_ > linear_share * search_.usual)) return found;
    FoundWrench best = found, other;
    for (const double sign : {1.0, -1.0}) {
      const FoundWrench one = search_from(found, sign * deviations_away * size_);
      if (one.report.status == Status::stopped) return one;
      if (!explains(one, best)) continue;
      other = one;
      if (is_better(other, best)) std::swap(other, best);
      tell(other, best);
      break;
    }
    Report back = body_.load(best.wrench, true);
    if (!back.is_solved() && back.status != Status::stopped) back = body_.load(best.wrench, false);
    if (!back.is_solved()) best.report = back;
    return best;
  }

 private:
  double scale(std::size_t k) const { return search_.components[k] < 3 ? 1.0 : search_.length; }
  /// That of the covariance's largest eigenvalue, and its standard deviation.
  void set_direction(const FoundWrench& found) {
    const auto n = static_cast<Eigen::Index>(search_.unknowns);
    Eigen::MatrixXd covariance(n, n);
    const auto& which = search_.components;
    for (std::size_t i = 0; i < search_.unknowns; ++i)
      for (std::size_t j = 0; j < search_.unknowns; ++j)
        covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            found.covariance[which[i] * 6 + which[j]] / (scale(i) * scale(j));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(covariance);
    size_ = std::sqrt(std::max(0.0, parts.eigenvalues()[n - 1]));
    direction_.assign(search_.unknowns, 0.0);
    for (std::size_t i = 0; i < search_.unknowns; ++i)
      direction_[i] = parts.eigenvectors()(static_cast<Eigen::Index>(i), n - 1);
  }
  FoundWrench search_from(const FoundWrench& found, double way) {
    WrenchSearch again = search_;
    again.first = found.wrench;
    for (std::size_t k = 0; k < search_.unknowns; ++k)
      again.first[search_.components[k]] += way * direction_[k] * scale(k);
    again.from_last = true;
    again.usual = size_;
    again.most_work = std::min(search_.most_work, most_work_of_another);
    return WrenchSteps(again, body_).run();
  }
  double size_of(const std::array<double, 6>& wrench, const std::array<double, 6>& less) const {
    double squares = 0;
    for (std::size_t k = 0; k < search_.unknowns; ++k) {
      const double part = (wrench[search_.components[k]] - less[search_.components[k]]) / scale(k);
      squares += part * part;
    }
    return std::sqrt(squares);
  }
  bool explains(const FoundWrench& one, const FoundWrench& found) const {
    return one.report.status == Status::converged && one.misfit < found.misfit + acceptable_misfit &&
           size_of(one.wrench, found.wrench) > least_deviations * size_;
  }
  bool is_better(const FoundWrench& one, const FoundWrench& other) const {
    if (std::abs(one.misfit - other.misfit) > same_misfit) return one.misfit < other.misfit;
    return size_of(one.wrench, search_.known) < size_of(other.wrench, search_.known);
  }
  void tell(const FoundWrench& other, FoundWrench& best) const {
    std::string wrench;
    for (std::size_t k = 0; k < search_.unknowns; ++k)
      wrench += fmt::format("{}{:.3g}", k > 0 ? ", " : "",
                            other.wrench[search_.components[k]] - search_.known[search_.components[k]]);
    best.report.message = FixedText<240>(
        fmt::format("another wrench, [{}] with a misfit of {:.2g}, explains it, too: that of less misfit, or "
                    "the smaller one, is answered; measure a place, too, or ask the force alone",
                    wrench, other.misfit));
  }

  const WrenchSearch& search_;
  LoadedBody& body_;
  double size_ = 0;                ///< standard deviation along the direction [N]
  std::vector<double> direction_;  ///< moments over the length [1]
};

}  // namespace

double usual_force(const Arm& arm) {
  double bending = 1e300;
  for (const ArmSection& section : arm.sections)
    bending = std::min({bending, section.start.bending_x, section.start.bending_y});
  return 4 * bending / (arm.length() * arm.length());
}

std::string_view measurement_misfit(std::size_t tendons, const std::vector<TendonCommand>& held,
                                    const std::vector<double>& answers, std::size_t others,
                                    std::size_t unknowns, std::initializer_list<double> deviations) {
  if (held.size() != tendons) return "what is held is not given of every tendon";
  if (!answers.empty() && answers.size() != tendons)
    return "what is measured is not given of every tendon; what is not known is not a number";
  std::size_t count = others;
  for (const double answer : answers) {
    if (std::isinf(answer)) return "what is measured of a tendon is not finite";
    if (!std::isnan(answer)) ++count;
  }
  for (const double deviation : deviations)
    if (!(deviation > 0 && std::isfinite(deviation))) return "a standard deviation is not above 0";
  if (count < unknowns)
    return "less is measured than a wrench has components: measure more, or ask the force alone";
  return {};
}

void report_misfit(double misfit, Report& report) {
  if (!report.message.empty()) return;
  if (report.status == Status::converged && misfit > large_misfit)
    report.message = FixedText<240>(
        fmt::format("no wrench that was found explains what was measured: the nearest leaves {:.3g} standard "
                    "deviations of it. Something else acts or was measured, or the search ended too early",
                    misfit));
  else if (report.status == Status::iteration_limit || report.status == Status::stalled)
    report.message = FixedText<240>("the search for a wrench lost the equilibrium on its way");
}

FoundWrench search_wrench(const WrenchSearch& search, LoadedBody& body) {
  const FoundWrench found = WrenchSteps(search, body).run();
  return Alternatives(search, body).least_of(found);
}

}  // namespace sinew::inline v1
