#include "plan/descent.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace sinew::inline v1 {

double descend(std::vector<double>& x, std::span<const double> lower, std::span<const double> upper,
               const std::function<void(std::span<const double>, Quadratic&)>& cost,
               const std::function<void(std::vector<double>&)>& project, const DescentOptions& options) {
  const auto size = static_cast<Eigen::Index>(x.size());
  Quadratic at(size), trial_at(size);
  const auto evaluate = [&](std::span<const double> where, Quadratic& what, bool derivatives) {
    what.clear(derivatives);
    cost(where, what);
  };
  project(x);
  evaluate(x, at, true);
  double damping = options.damping;
  std::vector<double> trial(x.size());
  Eigen::LDLT<Eigen::MatrixXd> solver(size);
  for (int step = 0; step < options.max_steps && !options.deadline.is_over(); ++step) {
    bool is_better = false;
    for (int attempt = 0; attempt < 12 && !is_better; ++attempt) {
      Eigen::MatrixXd H = at.hessian.selfadjointView<Eigen::Lower>();
      Eigen::VectorXd g = at.gradient;
      for (Eigen::Index i = 0; i < size; ++i) H(i, i) += damping * H(i, i) + 1e-12;
      for (Eigen::Index i = 0; i < size; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!((x[k] <= lower[k] && g[i] > 0) || (x[k] >= upper[k] && g[i] < 0))) continue;
        H.row(i).setZero(), H.col(i).setZero();
        H(i, i) = 1, g[i] = 0;
      }
      const Eigen::VectorXd move = solver.compute(H).solve(-g);
      for (std::size_t k = 0; k < x.size(); ++k)
        trial[k] = std::clamp(x[k] + move[static_cast<Eigen::Index>(k)], lower[k], upper[k]);
      project(trial);
      evaluate(trial, trial_at, false);
      is_better = trial_at.cost < at.cost;  // never with NaN
      damping = is_better ? std::max(damping * 0.2, 1e-9) : damping * 4;
    }
    if (!is_better) break;
    const double before = at.cost;
    x = trial;
    evaluate(x, at, true);
    if (before - at.cost < options.min_gain * before) break;
  }
  return at.cost;
}

}  // namespace sinew::inline v1
