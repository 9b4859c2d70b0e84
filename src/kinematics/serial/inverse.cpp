/// Task-space inverse of serial robots: damped least squares within limits, from several starts.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/limits.hpp"
#include "kinematics/serial/tip_problem.hpp"
#include "solve/message.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

/// Where a descent is, or has ended.
struct Iterate {
  Shape shape;
  TipMiss miss;
  double merit;
};

/// One start after the other; the best end so far is kept.
class TipSearch {
 public:
  TipSearch(const TipProblem& problem, const SerialInverseOptions& options, StopToken stop)
      : problem_(problem),
        options_(options),
        stop_(stop),
        enough_(options.tolerance * problem.length()) {}

  const Iterate& best() const { return best_; }
  Status status() const { return status_; }
  int iterations() const { return iterations_; }
  int start() const { return start_; }

  /// Descends from there, not for long where that gets on slowly; true where it arrived.
  bool descend(const Shape& from, int start) {
    Iterate at = evaluated(from);
    const Status end = descend(at, false);
    if (start == 0 || end == Status::converged || at.merit < best_.merit || !std::isfinite(best_.merit)) {
      best_ = at;
      status_ = end;
      start_ = start;
    }
    return end == Status::converged;
  }

  /// From the best so far to the end, however slowly: to the nearest there is about.
  bool finish() {
    best_ = evaluated(best_.shape);
    status_ = descend(best_, true);
    return status_ == Status::converged;
  }

 private:
  static constexpr double longest_step =
      0.8;  // of what a section turns by [rad]: its linearisation holds so far. In extensions all is linear

  Iterate evaluated(const Shape& shape) const {
    const TipMiss miss = problem_.measure(shape);
    return {shape, miss, miss.merit(problem_.length())};
  }

  /// Levenberg-Marquardt with damping in proportion to what is missed, so that it vanishes as fast as that
  /// does.
  Status descend(Iterate& at, bool patient) {
    BoundedStep system;
    double damping = 0.1, mark = at.merit;
    for (int i = 0; i < options_.max_iterations && !stop_.stop_requested(); ++i) {
      if (at.miss.residual(problem_.length()) <= enough_) return Status::converged;
      if (i % 12 == 11) {
        if (!patient && at.merit > 0.5 * mark) return Status::stalled;
        mark = at.merit;
      }
      ++iterations_;
      problem_.linearise(at.shape, at.miss, longest_step, system);
      if (!step(at, system, damping)) return Status::stalled;
    }
    return at.miss.residual(problem_.length()) <= enough_ ? Status::converged : Status::iteration_limit;
  }

  /// Some step that lowers the merit; false where there is none worth taking. The least damping is for
  /// columns that depend on one another; where a target is only just in reach it has to stay below their
  /// squares, that vanish as what is missed does.
  bool step(Iterate& at, BoundedStep& system, double& damping) const {
    const double size = system.trace(), least = std::clamp(1e-3 * std::sqrt(at.merit), 1e-15, 1e-11);
    for (int tries = 0; tries < 8; ++tries, damping *= 8) {
      if (!system.solve(size * (least + damping * std::min(at.merit, 1.0)))) return false;
      const double predicted = at.merit - system.missed();
      if (!(predicted > 1e-5 * at.merit)) return false;  // a minimum within the limits, and not zero
      const Iterate ahead = evaluated(problem_.moved(at.shape, system));
      const double gained = at.merit - ahead.merit;
      if (!(gained > 1e-3 * predicted)) continue;
      at = ahead;
      if (gained > 0.7 * predicted) damping = std::max(damping / 6, 1e-6);
      return true;
    }
    return false;
  }

  const TipProblem& problem_;
  const SerialInverseOptions& options_;
  StopToken stop_;
  double enough_;
  Iterate best_;
  Status status_ = Status::stalled;
  int iterations_ = 0, start_ = 0;
};

/// The k-th of a fixed set of starts, k from 1: the straight robot, then others spread evenly over the limits
/// by the fractional parts of multiples of roots of primes; of sections without limits over half a turn.
Shape spread_start(const SerialRobot& robot, int k) {
  static constexpr std::array<int, 3 * max_sections> primes = {
      2,  3,  5,  7,  11, 13, 17, 19,  23,  29,  31,  37,  41,  43,  47,  53,  59,  61,
      67, 71, 73, 79, 83, 89, 97, 101, 103, 107, 109, 113, 127, 131, 137, 139, 149, 151};
  const auto part = [k](std::size_t i) {
    const double multiple = (k - 1) * std::sqrt(static_cast<double>(primes[i]));
    return multiple - std::floor(multiple);
  };
  Shape shape;
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    const Section& section = robot.sections[m];
    shape.bends[m] = Bend(0, 0);
    if (k == 1) continue;
    const double a = part(2 * m), b = part(2 * m + 1),
                 reach = std::min(section.limit, std::numbers::pi / turns(section));
    const double along = 2 * std::numbers::pi * b;
    shape.bends[m] = section.is_twin()
                         ? Bend(Bend(2 * a - 1, 2 * b - 1) * reach)
                         : Bend(Bend(std::cos(along), std::sin(along)) * (reach * std::sqrt(a)));
    if (section.is_extensible())
      shape.extensions[m] =
          std::lerp(section.min_extension, section.max_extension, part(2 * max_sections + m));
  }
  return shape;
}

/// The starts in batches, each batch in order of how near its tips are.
class SpreadStarts {
 public:
  SpreadStarts(const SerialRobot& robot, const TipProblem& problem, int count)
      : robot_(robot),
        problem_(problem),
        count_(count) {}

  struct Start {
    int index;
    double merit;
  };

  bool done() const { return done_ >= count_; }

  std::span<const Start> batch() {
    const int first = done_, size = std::min(batch_size, count_ - done_);
    for (int i = 0; i < size; ++i) {
      const int index = first + i + 1;
      starts_[static_cast<std::size_t>(i)] = {
          index, problem_.screen(spread_start(robot_, index)).merit(problem_.length())};
    }
    done_ += size;
    std::sort(starts_.begin(), starts_.begin() + size, [](const Start& a, const Start& b) {
      return a.merit < b.merit || (a.merit == b.merit && a.index < b.index);
    });
    return {starts_.data(), static_cast<std::size_t>(size)};
  }

 private:
  static constexpr int batch_size = 32;
  const SerialRobot& robot_;
  const TipProblem& problem_;
  int count_, done_ = 0;
  std::array<Start, batch_size> starts_;
};

Shape first_start(const SerialRobot& robot, const SerialInverseOptions& options) {
  const std::size_t count = robot.sections.size();
  Shape shape;
  for (std::size_t m = 0; m < count; ++m) {
    shape.bends[m] = options.start.empty() ? Bend(0, 0) : options.start[m];
    shape.extensions[m] = options.start_extensions.empty() ? 0 : options.start_extensions[m];
  }
  return shape;
}

void explain_too_far(double beyond, double length, Report& report) {
  report.status = Status::unreachable;
  report.message.append("the target lies ");
  append_mm(report.message, beyond);
  report.message.append(" beyond what a robot of ");
  append_mm(report.message, length);
  report.message.append(" can reach; bring it nearer to the base");
}

void explain_miss(const Iterate& best, Report& report) {
  report.message.append("no start led to the target: the nearest is ");
  append_mm(report.message, best.miss.position);
  if (best.miss.angle > 0) {
    report.message.append(" and ");
    append_degrees(report.message, best.miss.angle);
  }
  report.message.append(" off; move the target, widen the limits, or give a start near the shape you expect");
}

Report check(const SerialRobot& robot, const TipTarget& target, const SerialInverseOptions& options,
             const SerialWorkspace& work) {
  const std::size_t count = robot.sections.size();
  const auto fits = [count](std::size_t size) { return size == 0 || size == count; };
  Report report;
  const auto refuse = [&](std::string_view why) {
    report.status = Status::bad_input;
    report.message.append(why);
    return report;
  };
  if (count == 0 || count > static_cast<std::size_t>(max_sections))
    return refuse("a serial robot has 1 to 12 sections");
  if (!work.fits(robot)) return refuse("the workspace was made for another robot: make one of this robot");
  if (!fits(options.start.size()) || !fits(options.start_extensions.size()))
    return refuse("start and start_extensions need one value a section");
  if (target.direction && target.rotation) return refuse("a target has a direction or a rotation, not both");
  if (!target.position.allFinite() || (target.direction && !(squared_norm(*target.direction) > 0)))
    return refuse("the target is not finite, or its direction is zero");
  return report;
}

}  // namespace

SerialInverse inverse(const SerialRobot& robot, const TipTarget& target, const SerialInverseOptions& options,
                      SerialWorkspace& work) {
  if (const Report fits = check(robot, target, options, work); !fits.ok()) {
    SerialInverse refused;
    refused.report = fits;
    return refused;
  }
  const TipProblem problem(robot, target, work);
  TipSearch search(problem, options, work.stop);
  Shape first = first_start(robot, options);
  problem.bring_within(first);
  const double beyond = problem.farthest();
  bool found = search.descend(first, 0);
  SpreadStarts spread(robot, problem, beyond > 0 ? 0 : options.starts);
  while (!found && !spread.done() && !work.stop.stop_requested())
    for (const SpreadStarts::Start& start : spread.batch())
      if (!found) found = search.descend(spread_start(robot, start.index), start.index);
  if (!found) found = search.finish();

  const Iterate& best = search.best();
  SerialInverse answer;
  answer.report.status = search.status();
  answer.report.iterations = search.iterations();
  answer.report.residual = best.miss.residual(problem.length());
  answer.position_error = best.miss.position;
  answer.angle_error = best.miss.angle;
  answer.start = search.start();
  if (beyond > 0)
    explain_too_far(beyond, robot.longest(), answer.report);
  else if (!found && !note_stop(work.stop, answer.report))
    explain_miss(best, answer.report);
  std::copy_n(best.shape.bends.begin(), robot.sections.size(), work.bends.begin());
  answer.bends = work.bends;
  answer.extensions = work.extensions;
  if (!found) problem.measure(best.shape);  // otherwise it was the last to be measured
  return answer;
}

}  // namespace sinew::inline v1
