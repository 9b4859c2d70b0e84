#include "plan/smoothing.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "plan/parallel.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double change_scale =
    0.02;  // of a bend from step to step [rad]: it weighs as contact missed by its scale

/// The cost of a way, and block by block its derivatives by the bends.
class WayCost {
 public:
  WayCost(std::size_t steps, std::vector<Search>& searches)
      : searches_(&searches),
        blocks_(steps, Quadratic(static_cast<Eigen::Index>(searches.front().body.unknowns()))) {}

  double evaluate(const std::vector<Posture>& way, bool derivatives) {
    in_parallel(way.size(), searches_->size(), [&](std::size_t k, std::size_t thread) {
      Search& search = (*searches_)[thread];
      Quadratic& at = blocks_[k];
      at.clear(derivatives);
      search.body.place(way[k], derivatives);
      search.add_contact(at);
      if (k + 1 == way.size()) search.add_target(at);
    });
    double cost = 0;
    for (const Quadratic& block : blocks_) cost += block.cost;
    for (std::size_t k = 0; k + 1 < way.size(); ++k)
      for (std::size_t i = 1; i < way[k].size(); ++i) {
        const double change = (way[k + 1][i] - way[k][i]) / change_scale;
        cost += 0.5 * change * change;
      }
    return cost;
  }

  /// Gauss-Newton step of all bends: block Cholesky, downwards and back.
  std::vector<Eigen::VectorXd> step(const std::vector<Posture>& way, const Search& limits,
                                    double damping) const {
    const std::size_t steps = way.size();
    const auto size = static_cast<Eigen::Index>(way.front().size()) - 1;
    const double w = 1 / (change_scale * change_scale);
    std::vector<Eigen::MatrixXd> diagonal(steps), coupling(steps);
    std::vector<Eigen::VectorXd> right(steps);
    std::vector<Eigen::Index> held, held_before;
    for (std::size_t k = 0; k < steps; ++k) {
      const Eigen::MatrixXd whole = blocks_[k].hessian.selfadjointView<Eigen::Lower>();
      Eigen::MatrixXd H = whole.bottomRightCorner(size, size);
      Eigen::VectorXd g = blocks_[k].gradient.tail(size);
      Eigen::MatrixXd C = Eigen::MatrixXd::Zero(size, size);  // to the step before
      if (k > 0) C.diagonal().setConstant(-w);
      std::swap(held, held_before);
      held.clear();
      const double neighbours = (k > 0 ? 1 : 0) + (k + 1 < steps ? 1 : 0);
      for (Eigen::Index i = 0; i < size; ++i) {
        const auto j = static_cast<std::size_t>(i) + 1;
        H(i, i) += neighbours * w;
        if (k > 0) g[i] += w * (way[k][j] - way[k - 1][j]);
        if (k + 1 < steps) g[i] += w * (way[k][j] - way[k + 1][j]);
        H(i, i) += damping * H(i, i);
      }
      for (Eigen::Index i = 0; i < size; ++i) {
        const auto j = static_cast<std::size_t>(i) + 1;
        const bool is_held =
            (way[k][j] <= limits.lower[j] && g[i] > 0) || (way[k][j] >= limits.upper[j] && g[i] < 0);
        if (!is_held) continue;
        H.row(i).setZero(), H.col(i).setZero(), C.row(i).setZero();
        H(i, i) = 1, g[i] = 0;
        held.push_back(i);
      }
      for (const Eigen::Index i : held_before) C.col(i).setZero();
      diagonal[k] = H, coupling[k] = C, right[k] = -g;
    }
    std::vector<Eigen::LDLT<Eigen::MatrixXd>> factors(steps);
    for (std::size_t k = 0; k < steps; ++k) {
      if (k > 0) {
        const Eigen::MatrixXd carried = factors[k - 1].solve(coupling[k].transpose());
        diagonal[k] -= coupling[k] * carried;
        right[k] -= coupling[k] * factors[k - 1].solve(right[k - 1]);
      }
      factors[k].compute(diagonal[k]);
    }
    std::vector<Eigen::VectorXd> move(steps);
    for (std::size_t k = steps; k-- > 0;) {
      if (k + 1 < steps) right[k] -= coupling[k + 1].transpose() * move[k + 1];
      move[k] = factors[k].solve(right[k]);
    }
    return move;
  }

 private:
  std::vector<Search>* searches_;
  std::vector<Quadratic> blocks_;
};

}  // namespace

void smooth(std::vector<Posture>& way, std::vector<Search>& searches, double goal, int max_rounds) {
  for (Search& search : searches) search.goal = goal;
  WayCost now(way.size(), searches), other(way.size(), searches);
  double cost = now.evaluate(way, true), damping = 1e-4;
  for (int round = 0; round < max_rounds && !searches.front().deadline.is_over(); ++round) {
    bool is_better = false;
    for (int attempt = 0; attempt < 8 && !is_better; ++attempt) {
      const auto move = now.step(way, searches.front(), damping);
      std::vector<Posture> trial = way;
      for (std::size_t k = 0; k < way.size(); ++k) {
        for (std::size_t i = 1; i < way[k].size(); ++i)
          trial[k][i] += move[k][static_cast<Eigen::Index>(i) - 1];
        searches.front().project(trial[k]);
      }
      const double trial_cost = other.evaluate(trial, false);
      is_better = trial_cost < cost;
      damping = is_better ? std::max(damping * 0.2, 1e-8) : damping * 5;
      if (!is_better) continue;
      const bool is_little = cost - trial_cost < 1e-3 * cost;
      way = std::move(trial);
      cost = now.evaluate(way, true);
      if (is_little) return;
    }
    if (!is_better) return;
  }
}

}  // namespace sinew::inline v1
