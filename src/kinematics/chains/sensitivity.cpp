/// What inputs do to an equilibrium of chains.
#include "kinematics/chain_analysis.hpp"
#include "kinematics/chains/path.hpp"

namespace sinew::inline v1 {
namespace {

/// What a motor at a base does to the wrench that is needed: the base turns as if the platform turned back
/// about it, axes and all.
Vec<double, 3> motor_wrench_jacobian(const ChainLeg<Planar>& leg, const SE2<double>& platform,
                                     LegSystem<Planar> system) {
  const auto& closure = system.closure;
  const Vec2<double> from = platform.p - leg.base.p;
  const Vec<double, 3> turn(-from.y(), from.x(), 1);
  const Vec<double, 3> direct =
      -system.force * (closure.c_xx * turn + Vec<double, 3>(closure.c_x[1], -closure.c_x[0], 0));
  for (std::size_t j = 0; j < static_cast<std::size_t>(system.joints); ++j)
    system.balance[j] = -system.force * closure.across[j] * dot(closure.turn, turn);
  system.length_error = 0;
  system.closure.c = -dot(closure.c_x, turn);
  LegFactors<Planar> factors;
  factors.factor(leg.chain, system, false);
  return direct + factors.push(system, factors.own);
}

}  // namespace

template <class Space>
Eigen::Matrix<double, Space::dof, Eigen::Dynamic> input_sensitivity(const ChainLegs<Space>& robot,
                                                                    const ChainState<Space>& state,
                                                                    ChainWork& work) {
  using Motion = Vec<double, Space::dof>;
  if (!fits(robot, state)) return {};
  const ChainGroup<Space>& group = linearised(work, robot, state);
  std::vector<Motion> columns;
  const auto add = [&](const Motion& needed) {
    const Motion wanted = -needed;
    group.factors().solve(wanted.data(), columns.emplace_back().data());
  };
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    if constexpr (Space::dimension == 2)
      if (robot.has_base_motors) add(motor_wrench_jacobian(robot.legs[i], group.platform(), group.system(i)));
    if (state.hold[i].length_of >= 0)
      add(group.hold_wrench_jacobian(i, {.length = 1}));
    else
      for (const std::array<double, 2>& tension : {std::array{1.0, 0.0}, std::array{0.0, 1.0}})
        add(group.hold_wrench_jacobian(i, {.tension = tension}));
  }
  Eigen::Matrix<double, Space::dof, Eigen::Dynamic> all(Space::dof,
                                                        static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = columns[k];
  return all;
}

template SINEW_API Eigen::Matrix<double, 3, Eigen::Dynamic> input_sensitivity(const ChainLegs<Planar>&,
                                                                              const ChainState<Planar>&,
                                                                              ChainWork&);
template SINEW_API Eigen::Matrix<double, 6, Eigen::Dynamic> input_sensitivity(const ChainLegs<Spatial>&,
                                                                              const ChainState<Spatial>&,
                                                                              ChainWork&);

}  // namespace sinew::inline v1
