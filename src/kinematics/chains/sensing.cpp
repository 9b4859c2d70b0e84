/// The wrench from tensions.
#include "kinematics/chains/chain_sensing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinematics/chains/path.hpp"

namespace sinew::inline v1 {
namespace {

template <class Space>
Report check_measured(const ChainLegs<Space>& robot, std::span<const MeasuredTension> measured,
                      const ChainState<Space>& state) {
  Report report;
  const auto refuse = [&](std::string_view why) {
    report.status = Status::bad_input;
    report.message.append(why);
    return report;
  };
  if (!fits(robot, state)) return refuse("the state is of another robot");
  if (measured.size() != static_cast<std::size_t>(Space::dof))
    return refuse("a wrench is told by as many tensions as the platform has freedoms");
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const auto [leg, tension] = measured[k];
    if (leg < 0 || leg >= static_cast<int>(robot.legs.size()) ||
        state.hold[static_cast<std::size_t>(leg)].length_of < 0 || !std::isfinite(tension))
      return refuse("a tension that is measured is a number, and of a tendon whose length is held");
    for (std::size_t j = 0; j < k; ++j)
      if (measured[j].leg == leg) return refuse("a leg's tension is measured once");
  }
  return check_hold(robot, std::span<const TendonConstraint>(state.hold));
}

/// Errors of tensions count by Σ EI/ℓ².
template <class Space>
auto efforts_of(const ChainGroup<Space>& group, std::span<const MeasuredTension> measured) {
  typename EffortSensor<Space>::Measured efforts;
  double unit = 0;
  for (int k = 0; k < group.limbs(); ++k) unit += group.stiffness(k) / (group.length(k) * group.length(k));
  for (std::size_t k = 0; k < efforts.size(); ++k) efforts[k] = {measured[k].leg, measured[k].tension, unit};
  return efforts;
}

}  // namespace

template <class Space>
SensedLoad<Space> sense_wrench(const ChainLegs<Space>& robot, std::span<const MeasuredTension> measured,
                               ChainState<Space>& state, ChainWork& work, const ChainOptions& options) {
  SensedLoad<Space> sensed{check_measured(robot, measured, state),
                           Mat<double, Space::dof, Space::dof>::Zero()};
  Report& report = sensed.report;
  if (!report.ok()) return sensed;
  state.wrench.setZero();
  auto& memory = memory_of(work, robot, state, options);
  auto& group = memory.group;
  EffortSensor<Space> sensor(group, efforts_of(group, measured));
  const ChainSteps steps{[&] { return sensor.error(); },
                         [&] {
                           const auto twist = sensor.step();
                           return twist ? group.plan(*twist) : std::numeric_limits<double>::infinity();
                         }};
  report = sensor.find(memory.spare, {{1, 1e-9, work.stop}, 0, options.max_iterations}, 0, Status::stalled,
                       [&](int& iterations, double&) { return correct(group, iterations, steps); });
  report.residual = sensor.error() * group.radius();
  group.measure();
  state = group.state();
  state.wrench = -group.wrench_residual();
  if (!report.ok()) return sensed;
  const auto rows = sensor.rows();
  if (!(regularity<Space>(MatrixView(rows.data(), Space::dof, Space::dof), 1, 1) > 1e-10)) {
    EffortSensor<Space>::say_undetermined(report);
    return sensed;
  }
  name_slack(state, report);
  sensed.sensitivity.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (const auto found = sensor.sensitivity()) sensed.sensitivity = *found;
  return sensed;
}

#define SINEW_OF(Space)                                                                              \
  template SensedLoad<Space> sense_wrench(const ChainLegs<Space>&, std::span<const MeasuredTension>, \
                                          ChainState<Space>&, ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
