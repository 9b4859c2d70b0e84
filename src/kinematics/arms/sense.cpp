#include <algorithm>
#include <cmath>

#include "kinematics/arms/arm_work.hpp"

namespace sinew::inline v1 {

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
  double before = 1e300;
  std::array<double, 6> step{};
  for (int round = 0; round < 50; ++round) {
    sensed.state = arm_forward(arm, measured.held, with, each, work);
    sensed.report = sensed.state.report;
    sensed.report.iterations = round;
    if (sensed.report.status == Status::bad_input || sensed.report.status == Status::stopped) return sensed;
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
    }
    if (!(misfit < before * (1 + 1e-9)) && round > 0) {  // half a step back
      double longest = 0, size = 1e-6;
      for (std::size_t k = 0; k < unknowns; ++k) {
        step[k] *= 0.5;
        with.wrench[k] -= step[k];
        longest = std::max(longest, std::abs(step[k]) / (k < 3 ? 1 : length));
        size = std::max(size, std::abs(with.wrench[k]) / (k < 3 ? 1 : length));
      }
      if (longest < 1e-7 * size) return sensed;  // as near as rounding lets it
      continue;
    }
    before = misfit;
    // (scaled) normal equations: moments count by the arm's length
    std::vector<double> normal(unknowns * unknowns, 0.0), side(unknowns, 0.0);
    const auto scale = [&](std::size_t k) { return k < 3 ? 1.0 : length; };
    for (std::size_t i = 0; i < unknowns; ++i)
      for (std::size_t r = 0; r < off.size(); ++r) {
        side[i] += rows[r * unknowns + i] * scale(i) * off[r];
        for (std::size_t j = 0; j < unknowns; ++j)
          normal[i * unknowns + j] += rows[r * unknowns + i] * scale(i) * rows[r * unknowns + j] * scale(j);
      }
    std::vector<double> identity(unknowns * unknowns, 0.0), inverse(unknowns * unknowns), values(unknowns);
    for (std::size_t i = 0; i < unknowns; ++i) identity[i * unknowns + i] = 1;
    const auto n = static_cast<Eigen::Index>(unknowns);
    symmetric_eigenvalues({normal.data(), n, n}, values);
    if (!(values.front() > 1e-12 * values.back()) ||
        !solve({normal.data(), n, n}, {identity.data(), n, n}, inverse)) {
      sensed.report = {
          Status::singular, round, 0,
          FixedText<240>("what is measured does not tell the wrench: measure more, or ask the force alone")};
      return sensed;
    }
    double longest = 0, size = 1e-6;
    for (std::size_t i = 0; i < unknowns; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < unknowns; ++j) {
        sum += inverse[i * unknowns + j] * side[j];
        sensed.covariance[i * 6 + j] = inverse[i * unknowns + j] * scale(i) * scale(j);
      }
      step[i] = sum * scale(i);
      longest = std::max(longest, std::abs(sum));
      size = std::max(size, std::abs(with.wrench[i] / scale(i)));
    }
    sensed.misfit = std::sqrt(misfit / static_cast<double>(off.size()));
    for (std::size_t k = 0; k < 6; ++k) sensed.wrench[k] = with.wrench[k] - load.wrench[k];
    if (longest < 1e-9 * size) return sensed;
    for (std::size_t k = 0; k < unknowns; ++k) with.wrench[k] += step[k];
    each.from_last = true;
  }
  for (std::size_t k = 0; k < 6; ++k) sensed.wrench[k] = with.wrench[k] - load.wrench[k];
  if (sensed.report.ok()) sensed.report.status = Status::iteration_limit;
  return sensed;
}

}  // namespace sinew::inline v1
