#include "kinematics/arms/sense_search.hpp"

#include <algorithm>
#include <cmath>

#include "math/linalg.hpp"

namespace sinew::inline v1 {
namespace {

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

FoundWrench search_wrench(const WrenchSearch& search, LoadedBody& body) {
  FoundWrench sensed;
  sensed.wrench = search.first;
  const std::size_t unknowns = search.unknowns;
  // Moments count by the length.
  const auto& which = search.components;
  const auto scale = [&](std::size_t k) { return which[k] < 3 ? 1.0 : search.length; };
  std::array<double, 6> wrench = search.first, step{};  // a step is of the unknowns
  double before = 1e300, radius = search.usual;
  std::vector<double> normal, side;
  const auto take = [&](double sign) {
    for (std::size_t k = 0; k < unknowns; ++k) wrench[which[k]] += sign * step[k];
  };
  const auto step_size = [&] {
    double size = 0;
    for (std::size_t k = 0; k < unknowns; ++k) size = std::max(size, std::abs(step[k]) / scale(k));
    return size;
  };
  const auto wrench_size = [&] {
    double size = 0;
    for (std::size_t k = 0; k < unknowns; ++k) size = std::max(size, std::abs(wrench[which[k]]) / scale(k));
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
          Status::singular, sensed.report.iterations, sensed.report.residual,
          FixedText<240>("what is measured does not tell the wrench: measure more, or ask the force alone")};
      return sensed;
    }
    sensed.condition = std::sqrt(values.back() / values.front());
    for (std::size_t i = 0; i < unknowns; ++i)
      for (std::size_t j = 0; j < unknowns; ++j)
        sensed.covariance[which[i] * 6 + which[j]] = inverse[i * unknowns + j] * scale(i) * scale(j);
    return sensed;
  };
  bool from_last = search.from_last;
  int spent = 0;
  for (int round = 0; round < 200 && spent < search.most_work; ++round) {
    sensed.report = body.load(wrench, from_last);
    spent += 1 + sensed.report.iterations;
    sensed.report.iterations = round;
    if (sensed.report.status == Status::bad_input || sensed.report.status == Status::unsupported ||
        sensed.report.status == Status::stopped)
      return sensed;
    from_last = sensed.report.is_solved();
    double misfit = 1e300;
    Comparison with;
    const auto& [off, rows] = with;
    if (sensed.report.is_solved()) {
      if (body.compare(with)) {
        misfit = 0;
        for (const double x : off) misfit += x * x;
      } else if (round == 0) {
        sensed.report = {Status::singular, 0, sensed.report.residual,
                         FixedText<240>("the equilibrium is a fold: it has no rates")};
        return sensed;
      }
    } else if (round == 0) {
      return sensed;  // nothing to begin from
    }
    if (!(misfit < before * (1 + 1e-9)) && round > 0) {  // a shorter one from where it was
      take(-1);
      radius = 0.25 * step_size();
      if (radius < 1e-7 * std::max(wrench_size(), 1e-6)) {  // as near as rounding lets it
        sensed.report = body.load(wrench, from_last);
        sensed.report.iterations = round;
        return with_covariance();
      }
      step = within(normal, side, radius, scale);
      take(1);
      continue;
    }
    if (round > 0 && step_size() > 0.5 * radius) radius *= 3;
    before = misfit;
    normal.assign(unknowns * unknowns, 0.0);
    side.assign(unknowns, 0.0);
    for (std::size_t i = 0; i < unknowns; ++i)
      for (std::size_t r = 0; r < off.size(); ++r) {
        side[i] += rows[r * 6 + which[i]] * scale(i) * off[r];
        for (std::size_t j = 0; j < unknowns; ++j)
          normal[i * unknowns + j] += rows[r * 6 + which[i]] * scale(i) * rows[r * 6 + which[j]] * scale(j);
      }
    sensed.misfit = std::sqrt(misfit / static_cast<double>(off.size()));
    sensed.wrench = wrench;
    step = within(normal, side, radius, scale);
    if (step_size() < 1e-9 * std::max(wrench_size(), 1e-6)) return with_covariance();
    take(1);
  }
  sensed.report = {Status::iteration_limit, sensed.report.iterations, sensed.report.residual,
                   FixedText<240>("no wrench explains what was measured better, nor does the search settle: "
                                  "what is measured may contradict itself")};
  return sensed;
}

}  // namespace sinew::inline v1
