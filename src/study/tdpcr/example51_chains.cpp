#include "study/tdpcr/example51_chains.hpp"

#include "kinematics/chains/chain_motion.hpp"

namespace sinew::inline v1::example51 {
namespace {

tl::unexpected<Errors> failed(std::string_view where, const Report& report) {
  return failure("no_solution", where, to_string(report));
}

}  // namespace

Expected<ChainLegs<Planar>> chains(const Robot& robot) {
  auto on_chains = robot.as(Model::prb, PrbDiscretisation::even);
  if (!on_chains) return tl::unexpected(std::move(on_chains.error()));
  return chains_of<Planar>(*on_chains);
}

Expected<std::vector<ChainLegState>> evenly_bent(const ChainLegs<Planar>& robot, const PlanarPose& pose) {
  ChainState<Planar> state;
  const std::vector<double> towards_plus(robot.legs.size(), 1);
  const Report report = unloaded_equilibrium(robot, pose, towards_plus, false, state);
  if (!report.ok()) return failed("evenly bent chains", report);
  return std::move(state.legs);
}

Expected<std::vector<ChainSample>> trajectory(ChainLegs<Planar> robot, int rk4_steps) {
  constexpr int last = 59;
  std::vector<ChainSample> samples;
  auto legs = evenly_bent(robot, pose(0));
  if (!legs) return tl::unexpected(std::move(legs.error()));
  for (int k = 0; k <= last; ++k) {
    const double eta = static_cast<double>(k) / last;
    if (k > 0) {
      const Report report =
          follow_least_norm(robot, samples.back().pose, pose(eta), *legs, {.rk4_steps = rk4_steps});
      if (!report.ok()) return failed("least-norm motion", report);
    }
    samples.push_back({eta, pose(eta), *legs, chain_velocity(robot, pose(eta), *legs)});
  }
  return samples;
}

Expected<ChainSample> sample(ChainLegs<Planar> robot, double eta) {
  auto legs = evenly_bent(robot, pose(0));
  if (!legs) return tl::unexpected(std::move(legs.error()));
  const Report report = follow_least_norm(robot, pose(0), pose(eta), *legs);
  if (!report.ok()) return failed("least-norm motion", report);
  return ChainSample{eta, pose(eta), *legs, chain_velocity(robot, pose(eta), *legs)};
}

Rates rates(const Sample& last, const ChainSample& chains) {
  Sample driven = last;
  driven.input_rate.assign(chains.velocity.drive.begin(), chains.velocity.drive.end());
  return rates(driven);
}

}  // namespace sinew::inline v1::example51
