#include <algorithm>

#include "base/at.hpp"
#include "kinematics/arms/arm_work.hpp"

namespace sinew::inline v1 {

std::vector<double> tip_rows(const strain::RodModel& model, const strain::RodWork& work) {
  const int n = model.size;
  std::vector<double> body(at(6 * n)), rows(at(6 * n), 0.0);
  tip_twists(model, work, body.data());
  const double* R = work.frames.back().R;
  for (int half = 0; half < 6; half += 3)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < n; ++j)
          rows[at((half + i) * n + j)] += R[3 * i + k] * body[at((half + k) * n + j)];
  return rows;
}

namespace {

double product(const double* a, const double* b, int n, int stride) {
  double sum = 0;
  for (int k = 0; k < n; ++k) sum += a[k] * b[k * stride];
  return sum;
}

}  // namespace

ArmRates arm_rates(const Arm& arm, ArmWorkspace& work, bool margin) {
  ArmWorkspace::Impl& impl = work.impl();
  ArmRates rates;
  const int m = static_cast<int>(arm.tendons.size());
  rates.tendons = m;
  rates.J.assign(at(6 * m), 0.0);
  rates.compliance.assign(36, 0.0);
  rates.answers.assign(at(m * m), 0.0);
  rates.answers_by_wrench.assign(at(6 * m), 0.0);
  if (impl.level < 0 || impl.balance != ArmBalance::energy || impl.rubs) return rates;
  strain::LoadedRod& rod = impl.rod();
  const int n = rod.model().size;
  rod.linearise(true);
  rates.regular = rod.factor_all(0) >= 0;
  if (!rates.regular) return rates;
  const std::vector<double> tip = tip_rows(rod.model(), rod.work());
  const double* gradients = rod.work().length_gradient.data();
  const std::vector<int> active(rod.active().begin(), rod.active().end());
  const auto place_of = [&](int tendon) {
    const auto found = std::ranges::find(active, tendon);
    return found == active.end() ? -1 : static_cast<int>(found - active.begin());
  };
  // What a step of the coordinates and the tensions of taut tendons means for tip and tendons.
  const auto put = [&](const double* step, int stride, const double* pulls, int pull_stride, int input,
                       double* twist, int twist_stride, double* answers, int answer_stride) {
    for (int i = 0; i < 6; ++i) twist[i * twist_stride] = product(tip.data() + i * n, step, n, stride);
    for (int i = 0; i < m; ++i) {
      const auto which = at(i);
      if (impl.commands[which].held == TendonHeld::change) {
        const int k = place_of(i);
        answers[i * answer_stride] = k < 0 ? 0 : pulls[k * pull_stride];
      } else {
        answers[i * answer_stride] = product(gradients + which * at(n), step, n, stride) -
                                     (i == input ? arm.tendons[which].compliance : 0);
      }
    }
  };
  constexpr int stride = strain::row;
  std::vector<double> sides(at(n * stride)), pulls(at(std::max(m, 1) * stride), 0.0);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < 6; ++i) sides[at(k * stride + i)] = tip[at(i * n + k)];
  rod.solve_all(sides, 6, stride, pulls.data());
  for (int i = 0; i < 6; ++i)
    put(sides.data() + i, stride, pulls.data() + i, stride, -1, rates.compliance.data() + i, 6,
        rates.answers_by_wrench.data() + i, 6);
  std::vector<double> step(at(n)), pull(at(std::max(m, 1)), 0.0);
  for (int i = 0; i < m; ++i) {
    if (impl.commands[at(i)].held == TendonHeld::change) {
      const int k = place_of(i);
      if (k < 0) continue;  // a slack tendon does nothing
      rod.answer_to_feed(k, step, pull);
      put(step.data(), 1, pull.data(), 1, i, rates.J.data() + i, m, rates.answers.data() + i, m);
    } else {
      std::ranges::fill(sides, 0.0);
      for (int k = 0; k < n; ++k) sides[at(k * stride)] = -gradients[at(i * n + k)];
      rod.solve_all(sides, 1, stride, pulls.data());
      put(sides.data(), stride, pulls.data(), stride, i, rates.J.data() + i, m, rates.answers.data() + i, m);
    }
  }
  if (!margin) return rates;
  if (!rod.has_potential()) make_symmetric(rod.model(), rod.work());
  std::vector<double> direction(at(n));
  rates.margin = rod.lowest(direction);
  rates.margin_is_bound = rod.is_bound();
  rod.work().symmetric = rod.has_potential();
  return rates;
}

}  // namespace sinew::inline v1
