#include <algorithm>
#include <cmath>

#include "kinematics/arms/arm_work.hpp"
#include "math/linalg.hpp"

namespace sinew::inline v1 {
namespace {

/// A force at the tip that bends the arm by about two radians [N]: further no step goes at first.
double usual_force(const Arm& arm) {
  double bending = 1e300;
  for (const ArmSection& section : arm.sections)
    bending = std::min({bending, section.start.bending_x, section.start.bending_y});
  return 4 * bending / (arm.length() * arm.length());
}

/// What lessens the squares most within a radius: damped until it is short enough. A slender arm hardly
/// stretches, so that along it the undamped step asks for forces that bend it anywhere.
template <class Scale>
std::array<double, 6> within(const std::vector<double>& normal, const std::vector<double>& side,
                             double radius, const Scale& scale) {
  const std::size_t count = side.size();
  const auto n = static_cast<Eigen::Index>(count);
  double largest = 0, damping = 0;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, normal[i * count + i]);
  std::vector<double> damped, found(count);
  std::array<double, 6> step{};
  for (int tries = 0; tries < 200; ++tries) {
    damped = normal;
    for (std::size_t i = 0; i < count; ++i) damped[i * count + i] += damping;
    double longest = 1e300;
    if (solve({damped.data(), n, n}, {side.data(), n, 1}, found)) {
      longest = 0;
      for (const double x : found) longest = std::max(longest, std::abs(x));
    }
    if (longest <= radius) break;
    damping = damping > 0 ? 2 * damping : 1e-14 * largest;
  }
  for (std::size_t i = 0; i < count; ++i) step[i] = found[i] * scale(i);
  return step;
}

}  // namespace

ArmSensed arm_sense(const Arm& arm, const ArmMeasurement& measured, const ArmLoad& load, bool force_alone,
                    const ArmOptions& options, ArmWorkspace& work) {
  ArmSensed sensed;
  const std::size_t m = arm.tendons.size(), unknowns = force_alone ? 3 : 6;
  const auto refuse = [&](std::string_view why) {
    sensed.report = {Status::bad_input, 0, 0, FixedText<240>(why)};
    sensed.state = work.impl().state;
    return sensed;
  };
  if (measured.held.size() != m) return refuse("what is held is not given of every tendon");
  if (!measured.answers.empty() && measured.answers.size() != m)
    return refuse("what is measured is not given of every tendon; what is not known is not a number");
  std::size_t count = measured.tip ? 3 : 0;
  for (const double answer : measured.answers)
    if (!std::isnan(answer)) ++count;
  if (count < unknowns)
    return refuse("less is measured than a wrench has components: measure more, or ask the force alone");
  ArmLoad with = load;
  ArmOptions each = options;
  const double length = arm.length();
  // Moments count by the arm's length.
  const auto scale = [&](std::size_t k) { return k < 3 ? 1.0 : length; };
  double before = 1e300, radius = usual_force(arm);
  std::array<double, 6> step{};
  std::vector<double> normal, side;
  const auto take = [&](double sign) {
    for (std::size_t k = 0; k < unknowns; ++k) with.wrench[k] += sign * step[k];
  };
  const auto size_of = [&](const std::array<double, 6>& wrench) {
    double size = 0;
    for (std::size_t k = 0; k < unknowns; ++k) size = std::max(size, std::abs(wrench[k]) / scale(k));
    return size;
  };
  const auto with_covariance = [&] {
    std::vector<double> identity(unknowns * unknowns, 0.0), inverse(unknowns * unknowns), values(unknowns);
    for (std::size_t i = 0; i < unknowns; ++i) identity[i * unknowns + i] = 1;
    const auto n = static_cast<Eigen::Index>(unknowns);
    symmetric_eigenvalues({normal.data(), n, n}, values);
    // A slender arm yields a million times more across than along: its squares have 1e-12.
    if (!(values.front() > 1e-15 * values.back()) ||
        !solve({normal.data(), n, n}, {identity.data(), n, n}, inverse)) {
      sensed.report = {
          Status::singular, sensed.report.iterations, 0,
          FixedText<240>("what is measured does not tell the wrench: measure more, or ask the force alone")};
      return sensed;
    }
    for (std::size_t i = 0; i < unknowns; ++i)
      for (std::size_t j = 0; j < unknowns; ++j)
        sensed.covariance[i * 6 + j] = inverse[i * unknowns + j] * scale(i) * scale(j);
    return sensed;
  };
  for (int round = 0; round < 200; ++round) {
    sensed.state = arm_forward(arm, measured.held, with, each, work);
    sensed.report = sensed.state.report;
    sensed.report.iterations = round;
    if (sensed.report.status == Status::bad_input || sensed.report.status == Status::stopped) return sensed;
    each.from_last = sensed.report.is_solved();
    double misfit = 1e300;
    std::vector<double> off, rows;  // in standard deviations
    if (sensed.report.is_solved()) {
      const ArmRates rates = arm_rates(arm, work, false);
      const auto add = [&](double difference, const double* row, double deviation) {
        off.push_back(difference / deviation);
        for (std::size_t k = 0; k < unknowns; ++k) rows.push_back(row[k] / deviation);
      };
      for (std::size_t i = 0; i < measured.answers.size(); ++i) {
        if (std::isnan(measured.answers[i])) continue;
        const bool is_change = measured.held[i].held == TendonHeld::tension;
        add(measured.answers[i] - (is_change ? sensed.state.changes[i] : sensed.state.tensions[i]),
            rates.answers_by_wrench.data() + 6 * i,
            is_change ? measured.change_deviation : measured.tension_deviation);
      }
      if (measured.tip)
        for (std::size_t i = 0; i < 3; ++i)
          add((*measured.tip)[i] - sensed.state.tip.p[static_cast<int>(i)], rates.compliance.data() + 6 * i,
              measured.tip_deviation);
      misfit = 0;
      for (const double x : off) misfit += x * x;
    } else if (round == 0) {
      return sensed;  // nothing to begin from
    }
    if (!(misfit < before * (1 + 1e-9)) && round > 0) {  // a shorter one from where it was
      take(-1);
      radius = 0.25 * size_of(step);
      if (radius < 1e-7 * std::max(size_of(with.wrench), 1e-6)) {  // as near as rounding lets it
        sensed.state = arm_forward(arm, measured.held, with, each, work);
        sensed.report = sensed.state.report;
        sensed.report.iterations = round;
        return with_covariance();
      }
      step = within(normal, side, radius, scale);
      take(1);
      continue;
    }
    if (round > 0 && size_of(step) > 0.5 * radius) radius *= 3;
    before = misfit;
    normal.assign(unknowns * unknowns, 0.0);
    side.assign(unknowns, 0.0);
    for (std::size_t i = 0; i < unknowns; ++i)
      for (std::size_t r = 0; r < off.size(); ++r) {
        side[i] += rows[r * unknowns + i] * scale(i) * off[r];
        for (std::size_t j = 0; j < unknowns; ++j)
          normal[i * unknowns + j] += rows[r * unknowns + i] * scale(i) * rows[r * unknowns + j] * scale(j);
      }
    sensed.misfit = std::sqrt(misfit / static_cast<double>(off.size()));
    for (std::size_t k = 0; k < 6; ++k) sensed.wrench[k] = with.wrench[k] - load.wrench[k];
    step = within(normal, side, radius, scale);
    if (size_of(step) < 1e-9 * std::max(size_of(with.wrench), 1e-6)) return with_covariance();
    take(1);
  }
  if (sensed.report.ok()) sensed.report.status = Status::iteration_limit;
  return sensed;
}

}  // namespace sinew::inline v1
