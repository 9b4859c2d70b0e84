/// Resolved-rate motion of serial robots.
#include "sinew/kinematics/resolved_rate.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/serial/tip_rows.hpp"
#include "sinew/base/assert.hpp"

namespace sinew::inline v0 {
namespace {

constexpr int rows_of(TipTask task) { return task == TipTask::position ? 3 : task == TipTask::axis ? 5 : 6; }

/// At a limit as far as rounding can tell.
constexpr double at_limit = 1e-12;

void bound(const SerialRobot& robot, std::span<const Bend> bends, double fastest, BoundedStep& system) {
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    const Room free = room(robot.sections[m], bends[m]);
    for (std::size_t j = 0; j < 2; ++j) {
      // across its bend a neutral section keeps to its limit, however near it is
      const bool across = !robot.sections[m].is_twin() && j == 1;
      system.low[2 * m + j] = across || free.low[j] < -at_limit ? -fastest : 0;
      system.high[2 * m + j] = across || free.high[j] > at_limit ? fastest : 0;
    }
  }
}

/// Rates into `rates`; what they miss stays in the system's r. Twice: the second solve takes what damping
/// left of the first, and leaves its square. Returns how many components are held.
int solve_rates(double damping, BoundedStep& system, BoundedStep::Row& rates) {
  const double size = system.trace() * std::max(damping, 1e-12);
  std::fill_n(rates, system.columns, 0.0);
  int held = 0;
  for (int pass = 0; pass < 2 && system.solve(size); ++pass) {
    if (pass == 0) held = system.held;
    for (int j = 0; j < system.columns; ++j) {
      const double rate = system.step[j];
      rates[j] += rate;
      system.low[j] -= rate;
      system.high[j] -= rate;
      for (int i = 0; i < system.rows; ++i) system.r[i] -= system.A[i][j] * rate;
    }
  }
  return held;
}

/// Speed of a twist, of which rows 1 to 3 are linear, as a share of the length.
double speed(const double* rows, int count) {
  double linear = 0, angular = 0;
  for (int i = 0; i < 3; ++i) linear += rows[i] * rows[i];
  for (int i = 3; i < count; ++i) angular += rows[i] * rows[i];
  return std::sqrt(std::max(linear, angular));
}

void judge(double missed, double wanted, const ResolvedRateOptions& options, ResolvedRate& answer) {
  Report& report = answer.report;
  report.residual = missed;
  if (missed <= options.tolerance * wanted) return;
  if (answer.held > 0) {
    report.status = Status::left_domain;
    append_number(report.message, answer.held);
    report.message.append(
        " components of bends are held at limits: the tip cannot follow; command another motion, or "
        "fewer of its components");
  } else {
    report.status = Status::singular;
    report.message.append(
        "the robot cannot move so in this shape (singular); command fewer components of the motion, "
        "or bend it first");
  }
}

}  // namespace

RateWorkspace::RateWorkspace(const SerialRobot& robot)
    : bends(2 * robot.sections.size()),
      tendons(static_cast<std::size_t>(robot.tendon_count())) {}

ResolvedRate resolved_rate(const SerialRobot& robot, std::span<const Bend> bends, const TipTwist& twist,
                           const ResolvedRateOptions& options, SerialWorkspace& work, RateWorkspace& rates) {
  SINEW_EXPECTS(bends.size() == robot.sections.size() && robot.section_count() <= max_sections);
  SINEW_EXPECTS(rates.bends.size() == 2 * bends.size() && rates.tendons.size() == work.changes.size());
  SINEW_EXPECTS(options.fastest > 0);
  tip_motion(robot, bends, work);
  const SO3<double> frame = options.frame == TipFrame::tip ? work.ends.back().R : SO3<double>::identity();
  const double length = robot.length();
  BoundedStep system;
  system.rows = rows_of(options.task);
  system.columns = static_cast<int>(rates.bends.size());
  tip_rows(robot, bends, work, length, frame.rotate(twist.linear), frame.rotate(twist.angular), system);
  bound(robot, bends, options.fastest, system);

  ResolvedRate answer;
  const double wanted = length * speed(system.r, system.rows);
  BoundedStep::Row unknowns;
  answer.held = solve_rates(options.damping, system, unknowns);
  judge(length * speed(system.r, system.rows), wanted, options, answer);
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const Bend rate = bend_change(robot.sections[m], bends[m], unknowns[2 * m], unknowns[2 * m + 1]);
    rates.bends[2 * m] = rate.x();
    rates.bends[2 * m + 1] = rate.y();
  }
  tendon_rates(bends, options.model, work);
  for (std::size_t i = 0; i < rates.tendons.size(); ++i) {
    rates.tendons[i] = 0;
    for (std::size_t j = 0; j < rates.bends.size(); ++j)
      rates.tendons[i] += work.K[i * rates.bends.size() + j] * rates.bends[j];
  }
  answer.bends = rates.bends;
  answer.tendons = rates.tendons;
  return answer;
}

}  // namespace sinew::inline v0
