/// What inputs do to an equilibrium of chains.
#include <cmath>
#include <limits>

#include "kinematics/chains/path.hpp"
#include "sinew/kinematics/chain_analysis.hpp"

namespace sinew::inline v0 {
namespace {

/// A unit change of one input of a leg as its imbalance, to first order; what it does to the platform by
/// itself is answered.
template <class Space>
class InputChange {
 public:
  static constexpr int dof = Space::dof;
  using Motion = Vec<double, dof>;

  InputChange(const ChainLeg<Space>& leg, const ChainLegState& state, LegSystem<Space>& system)
      : leg_(leg),
        state_(state),
        system_(system) {}

  Motion of_length() {
    clear();
    system_.length_error = -1;
    return Motion::Zero();
  }
  Motion of_tension(int tendon) {
    clear();
    for (int j = 0; j < system_.joints; ++j) {
      const auto joint = static_cast<std::size_t>(j);
      system_.balance[joint] =
          leg_.chain.tendon_bend(j, state_.angles[joint], leg_.tendon_offset, tendon == 0 ? 1 : -1).rate;
    }
    return Motion::Zero();
  }
  /// The base turns as if the platform turned back about it, axes and all.
  Motion of_motor(const typename Space::template Frame<double>& platform) {
    if constexpr (Space::dimension == 2) {
      clear();
      const auto& closure = system_.closure;
      const Vec2<double> from = platform.p - leg_.base.p;
      const Motion turn(-from.y(), from.x(), 1);
      system_.closure.c = -dot(closure.c_x, turn);
      for (std::size_t j = 0; j < static_cast<std::size_t>(system_.joints); ++j)
        system_.balance[j] = -system_.force * closure.across[j] * dot(closure.turn, turn);
      return -system_.force * (closure.c_xx * turn + Motion(closure.c_x[1], -closure.c_x[0], 0));
    }
    return Motion::Zero();
  }

 private:
  void clear() {
    system_.balance.fill(0);
    system_.closure.c = system_.length_error = 0;
  }

  const ChainLeg<Space>& leg_;
  const ChainLegState& state_;
  LegSystem<Space>& system_;
};

}  // namespace

template <class Space>
Eigen::Matrix<double, Space::dof, Eigen::Dynamic> input_sensitivity(const ChainRobot<Space>& robot,
                                                                    const ChainState<Space>& state,
                                                                    ChainWork& work) {
  constexpr int dof = Space::dof;
  using Motion = Vec<double, dof>;
  if (!fits(robot, state)) return {};
  const SmallLu<dof>& factors = linearised(work, robot, state).factors();
  const auto platform = Space::frame(state.pose);
  std::vector<Motion> columns;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    LegSystem<Space> system;
    LegFactors<Space> moves;
    form(robot.legs[i], platform, state.legs[i], state.hold[i], system);
    InputChange<Space> change(robot.legs[i], state.legs[i], system);
    const auto add = [&](const Motion& direct) {
      moves.factor(robot.legs[i].chain, system, false);
      const Motion wanted = -(direct + moves.push(system, moves.own));
      factors.solve(wanted.data(), columns.emplace_back().data());
    };
    if (robot.has_base_motors) add(change.of_motor(platform));
    if (system.holds_length) add(change.of_length());
    for (int k = 0; k < 2 && !system.holds_length; ++k) add(change.of_tension(k));
  }
  Eigen::Matrix<double, dof, Eigen::Dynamic> all(dof, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = columns[k];
  return all;
}

template SINEW_API Eigen::Matrix<double, 3, Eigen::Dynamic> input_sensitivity(const ChainRobot<Planar>&,
                                                                              const ChainState<Planar>&,
                                                                              ChainWork&);
template SINEW_API Eigen::Matrix<double, 6, Eigen::Dynamic> input_sensitivity(const ChainRobot<Spatial>&,
                                                                              const ChainState<Spatial>&,
                                                                              ChainWork&);

}  // namespace sinew::inline v0
