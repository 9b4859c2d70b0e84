/// Many equilibria of chains, by many starts.
#include "kinematics/chains/chain_equilibria.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinematics/chains/leg_system.hpp"
#include "kinematics/load_problem.hpp"
#include "kinematics/spread.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int spread_starts = 40;
constexpr std::size_t max_bends = 5;  ///< legs of which all bends are tried; of more each by itself

/// The curvatures with signs turned over: all ways of a few legs, of many one at a time.
std::vector<std::vector<double>> bends_of(const std::vector<double>& curvature) {
  const std::size_t legs = curvature.size();
  const bool tries_all = legs <= max_bends;
  std::vector<std::vector<double>> bends;
  for (std::size_t way = 0; way < (tries_all ? std::size_t{1} << legs : legs + 1); ++way) {
    bends.push_back(curvature);
    for (std::size_t i = 0; i < legs; ++i)
      if (tries_all ? way >> i & 1 : way == i + 1) bends.back()[i] *= -1;
  }
  return bends;
}

template <class Space>
class Search {
 public:
  using Wrench = Vec<double, Space::dof>;

  Search(const ChainLegs<Space>& robot, std::span<const TendonConstraint> hold, const Wrench& wrench,
         ChainWork& work, const ChainOptions& options)
      : robot_(robot),
        hold_(hold),
        wrench_(wrench),
        work_(work),
        options_(options) {
    for (const auto& leg : robot.legs) size_ = std::max(size_, leg.chain.length);
  }

  /// Let go without load, then loaded; and loaded at once.
  void begin(const typename Space::Pose& pose, const std::vector<double>& curvature) {
    ChainState<Space> start;
    if (!unloaded_equilibrium(robot_, pose, curvature, false, start).ok()) return;
    ChainState<Space> state = start;
    if (is_solution(equilibrium(robot_, hold_, Wrench::Zero().eval(), state, work_, options_))) load(state);
    if (!wrench_.isZero(0)) load(start);
  }

  /// Moved and turned from a pose.
  typename Space::Pose scattered(const typename Space::Pose& around, int k) const {
    constexpr std::array bases{2, 3, 5, 7, 11, 13};
    Wrench step;
    for (int i = 0; i < Space::dof; ++i)
      step[i] =
          (i < Space::dimension ? 0.5 * size_ : 1.2) * spread_number(k, bases[static_cast<std::size_t>(i)]);
    return Space::moved(around, step);
  }

  std::vector<FoundChains<Space>> found() {
    std::ranges::stable_sort(found_, {}, [](const FoundChains<Space>& one) {
      return std::isfinite(one.potential) ? one.potential : 0;
    });
    return std::move(found_);
  }

 private:
  static bool is_solution(const Report& report) { return report.ok() || report.status == Status::slack; }

  void load(ChainState<Space> state) {
    const Report report = equilibrium(robot_, hold_, wrench_, state, work_, options_);
    state.pose = Space::tidy(state.pose);
    if (!is_solution(report) || is_known(state)) return;
    ChainStability<Space> stability = check_stability(robot_, state, work_);
    found_.push_back({state, report, potential(robot_, state), std::move(stability)});
  }

  bool is_known(const ChainState<Space>& state) const {
    return std::ranges::any_of(found_, [&](const FoundChains<Space>& other) {
      const Wrench apart = twist_between(Space::frame(other.state.pose), Space::frame(state.pose));
      double most = std::max(apart.template head<Space::dimension>().norm() / size_,
                             apart.template tail<Space::dof - Space::dimension>().norm());
      for (std::size_t i = 0; i < robot_.legs.size(); ++i)
        for (std::size_t j = 0; j < static_cast<std::size_t>(robot_.legs[i].chain.joints()); ++j)
          most = std::max(most, std::abs(state.legs[i].angles[j] - other.state.legs[i].angles[j]));
      return most < 1e-6;
    });
  }

  const ChainLegs<Space>& robot_;
  std::span<const TendonConstraint> hold_;
  Wrench wrench_;
  ChainWork& work_;
  ChainOptions options_;
  double size_ = 0;
  std::vector<FoundChains<Space>> found_;
};

}  // namespace

template <class Space>
std::vector<FoundChains<Space>> chain_equilibria(const ChainLegs<Space>& robot,
                                                 std::span<const ChainStart<Space>> starts,
                                                 std::span<const TendonConstraint> hold,
                                                 const Vec<double, Space::dof>& wrench, ChainWork& work,
                                                 const ChainOptions& options) {
  Search<Space> search(robot, hold, wrench, work, options);
  for (const ChainStart<Space>& start : starts)
    for (const auto& bend : bends_of(start.curvature))
      if (!work.stop.stop_requested()) search.begin(start.pose, bend);
  for (int k = 0; k < spread_starts && !starts.empty() && !work.stop.stop_requested(); ++k)
    search.begin(search.scattered(starts[0].pose, k), starts[0].curvature);
  return search.found();
}

#define SINEW_OF(Space)                                                                               \
  template std::vector<FoundChains<Space>> chain_equilibria(                                          \
      const ChainLegs<Space>&, std::span<const ChainStart<Space>>, std::span<const TendonConstraint>, \
      const Vec<double, Space::dof>&, ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
