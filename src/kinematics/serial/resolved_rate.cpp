/// Resolved-rate motion of serial robots.
#include "sinew/kinematics/serial.hpp"

#include <algorithm>
#include <cmath>

#include "base/limits.hpp"
#include "kinematics/serial/tip_rows.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int rows_of(TipTask task) { return task == TipTask::position ? 3 : task == TipTask::axis ? 5 : 6; }

/// At a limit as far as rounding can tell.
constexpr double at_limit = 1e-12;

void bound_bends(const SerialRobot& robot, std::span<const Bend> bends, double fastest, BoundedStep& system) {
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

/// As fast as it takes; none of a length that is fixed.
void bound_extensions(const SerialRobot& robot, std::span<const double> extensions, BoundedStep& system) {
  const std::size_t first = 2 * robot.sections.size();
  for (auto j = first; j < static_cast<std::size_t>(system.columns); ++j) system.low[j] = system.high[j] = 0;
  constexpr double free = std::numeric_limits<double>::infinity();
  const double slop = at_limit * robot.length();
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    const Section& section = robot.sections[m];
    if (section.is_extensible() && extensions[m] > section.min_extension + slop)
      system.low[first + m] = -free;
    if (section.is_extensible() && extensions[m] < section.max_extension - slop)
      system.high[first + m] = free;
  }
}

/// Unknowns that no limit has to hold: lengths that do not vary, and what fills a pair.
int fixed_unknowns(const SerialRobot& robot) {
  int free = 0;
  for (const Section& section : robot.sections) free += section.is_extensible() ? 3 : 2;
  return unknowns(robot) - free;
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

void report_shortfall(double missed, double wanted, const ResolvedRateOptions& options,
                      ResolvedRate& answer) {
  Report& report = answer.report;
  report.residual = missed;
  if (missed <= options.tolerance * wanted) return;
  if (answer.held > 0) {
    report.status = Status::left_domain;
    append_number(report.message, answer.held);
    report.message.append(
        " components of the shape are held at limits: the tip cannot follow; command another motion, or "
        "fewer of its components");
  } else {
    report.status = Status::singular;
    report.message.append(
        "the robot cannot move so in this shape (singular); command fewer components of the motion, "
        "or bend it first");
  }
}

}  // namespace

ResolvedRate resolved_rate(const SerialRobot& robot, std::span<const Bend> bends, const TipTwist& twist,
                           const ResolvedRateOptions& options, SerialWorkspace& work) {
  if (!work.fits(robot) || !work.fits(bends) || bends.empty() || robot.section_count() > max_sections ||
      !(options.fastest > 0)) {
    ResolvedRate refused;
    refused.report.status = Status::bad_input;
    refused.report.message.append(
        "robot, bends and workspace are not of one robot, or fastest is not above 0");
    return refused;
  }
  tip_motion(bends, work);
  extension_motion(bends, options.model, work);
  const SO3<double> frame = options.frame == TipFrame::tip ? work.ends.back().R : SO3<double>::identity();
  const double length = robot.length();
  const bool is_extensible = robot.is_extensible();
  BoundedStep system;
  system.rows = rows_of(options.task);
  system.columns = unknowns(robot);
  tip_rows(robot, bends, work, length, frame.rotate(twist.linear), frame.rotate(twist.angular), system);
  bound_bends(robot, bends, options.fastest, system);
  bound_extensions(robot, work.extensions, system);

  ResolvedRate answer;
  const double wanted = length * speed(system.r, system.rows);
  BoundedStep::Row unknown;
  answer.held = solve_rates(options.damping, system, unknown) - fixed_unknowns(robot);
  report_shortfall(length * speed(system.r, system.rows), wanted, options, answer);
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const Bend rate = bend_change(robot.sections[m], bends[m], unknown[2 * m], unknown[2 * m + 1]);
    work.bend_rates[2 * m] = rate.x();
    work.bend_rates[2 * m + 1] = rate.y();
    work.extension_rates[m] = is_extensible ? length * unknown[2 * bends.size() + m] : 0;
  }
  tendon_rates(bends, options.model, work);
  double paid_out = 0;  // of the tendons that pass a section, by the extensions so far
  std::size_t i = 0;
  for (std::size_t m = 0; m < bends.size(); ++m) {
    paid_out += work.extension_jacobians[m].tendons * work.extension_rates[m];
    for (int k = 0; k < work.tendons[m]; ++k, ++i) {
      work.tendon_rates[i] = paid_out;
      for (std::size_t j = 0; j < work.bend_rates.size(); ++j)
        work.tendon_rates[i] += work.K[i * work.bend_rates.size() + j] * work.bend_rates[j];
    }
  }
  answer.bends = work.bend_rates;
  answer.extensions = work.extension_rates;
  answer.tendons = work.tendon_rates;
  return answer;
}

}  // namespace sinew::inline v1
