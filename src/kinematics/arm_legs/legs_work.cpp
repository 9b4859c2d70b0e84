#include "kinematics/arm_legs/legs_work.hpp"

#include <algorithm>

#include "base/at.hpp"

namespace sinew::inline v1 {

ArmLegsWorkspace::ArmLegsWorkspace(const ArmLegs& robot) : impl_(std::make_unique<Impl>()) {
  impl_->robot = robot.identity;
}
ArmLegsWorkspace::~ArmLegsWorkspace() = default;
ArmLegsWorkspace::ArmLegsWorkspace(ArmLegsWorkspace&&) noexcept = default;
ArmLegsWorkspace& ArmLegsWorkspace::operator=(ArmLegsWorkspace&&) noexcept = default;

const ArmWorkspace& arm_legs_shape(const ArmLegsWorkspace& work, std::size_t leg) {
  const ArmLegsWorkspace::Impl& impl = work.impl();
  return impl.levels[at(impl.level)]->shape(static_cast<int>(leg));
}

LegsProblem::LegsProblem(const ArmLegs& robot, std::span<const TendonCommand> tendons,
                         const ArmLegsLoad& load)
    : commands(tendons.begin(), tendons.end()),
      loads{.gravity = load.gravity.value_or(robot.gravity),
            .along = load.along,
            .following_along = load.following_along,
            .following = load.following,
            .points = load.points} {
  std::copy(load.wrench.begin(), load.wrench.end(), wrench.begin());
}

void write_legs_state(const ArmLegs& robot, const ArmGroup& group, ArmLegsState& state) {
  state.platform = group.platform();
  const int count = group.feeds();
  for (auto* values : {&state.tensions, &state.changes, &state.slack}) values->resize(at(count));
  for (int i = 0; i < count; ++i) {
    state.tensions[at(i)] = group.tension(i);
    state.changes[at(i)] = group.change(i);
    state.slack[at(i)] = group.slack(i);
  }
  state.tip_loads.resize(robot.legs.size());
  for (int k = 0; k < group.limbs(); ++k) {
    const auto wrench = group.tip_wrench(k);
    std::copy(wrench.begin(), wrench.end(), state.tip_loads[at(k)].begin());
  }
  state.energy = group.potential();
}

double legs_size(const ArmLegs& robot) {
  double size = 0;
  for (const ArmLeg& leg : robot.legs) size = std::max(size, leg.arm.length());
  return size;
}

}  // namespace sinew::inline v1
