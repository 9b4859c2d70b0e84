/// What inputs do to an equilibrium of chains.
#include "kinematics/chains/chain_analysis.hpp"
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
ByInputs<Space> input_wrench_jacobian(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                      ChainWork& work) {
  if (!fits(robot, state)) return {};
  const ChainGroup<Space>& group = linearised(work, robot, state);
  std::vector<Vec<double, Space::dof>> columns;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    if constexpr (Space::dimension == 2)
      if (robot.has_base_motors)
        columns.push_back(motor_wrench_jacobian(robot.legs[i], group.platform(), group.system(i)));
    if (state.hold[i].length_of >= 0)
      columns.push_back(group.hold_wrench_jacobian(i, {.length = 1}));
    else
      for (const std::array<double, 2>& tension : {std::array{1.0, 0.0}, std::array{0.0, 1.0}})
        columns.push_back(group.hold_wrench_jacobian(i, {.tension = tension}));
  }
  ByInputs<Space> all(Space::dof, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = columns[k];
  return all;
}

template <class Space>
ByInputs<Space> input_sensitivity(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                  ChainWork& work) {
  if (!fits(robot, state)) return {};
  const ByInputs<Space> needed = -input_wrench_jacobian(robot, state, work);
  const ChainGroup<Space>& group = memory_in<Space>(work).group;  // linearised there
  ByInputs<Space> all(Space::dof, needed.cols());
  for (Eigen::Index k = 0; k < needed.cols(); ++k)
    group.factors().solve(needed.col(k).data(), all.col(k).data());
  return all;
}

#define SINEW_OF(Space)                                                                             \
  template ByInputs<Space> input_wrench_jacobian(const ChainLegs<Space>&, const ChainState<Space>&, \
                                                 ChainWork&);                                       \
  template ByInputs<Space> input_sensitivity(const ChainLegs<Space>&, const ChainState<Space>&, ChainWork&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
