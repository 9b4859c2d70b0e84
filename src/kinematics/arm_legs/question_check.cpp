#include "kinematics/arm_legs/question_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinematics/arm_legs/legs_work.hpp"
#include "math/plane_axes.hpp"

namespace sinew::inline v1 {
namespace {

Report bad(const std::string& words) { return {Status::bad_input, 0, 0, FixedText<240>(words)}; }

/// In base axes, and in those of a leg in the plane, whose y axis is square to it.
bool leaves_plane(const std::array<double, 6>& wrench) {
  return std::ranges::any_of(axes_out_of_plane, [&](std::size_t k) { return wrench[k] != 0; });
}
bool leaves_own_plane(const std::array<double, 6>& wrench) {
  return wrench[1] != 0 || wrench[3] != 0 || wrench[5] != 0;
}

/// Of loads on legs.
Report loads_misfit(const ArmLegs& robot, const ArmLegsLoad& load) {
  for (std::size_t i = 0; i < load.points.size(); ++i) {
    const ArmLegsPointLoad& point = load.points[i];
    if (point.leg >= robot.legs.size())
      return bad(fmt::format("load {} is on leg {}, the robot has {} legs, counted from 0", i, point.leg,
                             robot.legs.size()));
    const double length = robot.legs[point.leg].arm.length();
    if (!(point.place > 0 && point.place <= length * (1 + 1e-12)))
      return bad(
          fmt::format("load {} is at {} m of leg {}, which is {} m long", i, point.place, point.leg, length));
    if (!std::ranges::all_of(point.wrench, [](double x) { return std::isfinite(x); }))
      return bad(fmt::format("load {} is not finite", i));
  }
  return {Status::converged, 0, 0, {}};
}

}  // namespace

Report legs_misfit(const ArmLegs& robot, std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                   const ArmOptions& options, const ArmLegsWorkspace& work) {
  if (work.impl().robot != robot.identity) return bad("the workspace is for another robot");
  if (commands.size() != robot.tendons())
    return bad(fmt::format("the legs have {} tendons, found {} commands", robot.tendons(), commands.size()));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!std::isfinite(commands[i].value)) return bad(fmt::format("what holds tendon {} is not finite", i));
    if (commands[i].held == TendonHeld::tension && commands[i].value < 0)
      return bad(fmt::format("tendon {} would have to push with {} N: tensions are at least 0", i,
                             -commands[i].value));
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::ranges::all_of(load.wrench, finite) || !std::ranges::all_of(load.along, finite) ||
      !std::ranges::all_of(load.following, finite) || !std::ranges::all_of(load.following_along, finite) ||
      (load.gravity && !std::ranges::all_of(*load.gravity, finite)))
    return bad("a load is not finite");
  if (const Report misfit = loads_misfit(robot, load); !misfit.ok()) return misfit;
  if (robot.is_planar) {
    const auto& gravity = load.gravity.value_or(robot.gravity);
    if (leaves_plane(load.wrench) || leaves_plane(load.following) || gravity[2] != 0 || load.along[2] != 0 ||
        load.following_along[1] != 0 || std::ranges::any_of(load.points, [](const auto& point) {
          return point.following ? leaves_own_plane(point.wrench) : leaves_plane(point.wrench);
        }))
      return bad("a load acts out of the plane, in which alone the robot moves: leave that part of it out");
  }
  if (const auto words = basis_misfit(options.model, options.order, options.elements); !words.empty())
    return bad(words);
  if (options.balance != ArmBalance::energy)
    return {Status::unsupported, 0, 0,
            FixedText<240>("legs balance by energy alone in this version: leave balance out")};
  return {Status::converged, 0, 0, {}};
}

const ArmLegsState& refuse_question(const Report& misfit, ArmLegsWorkspace& work) {
  ArmLegsState& state = work.impl().state;
  state = {};
  state.report = misfit;
  return state;
}

bool leaves_plane(const ArmLegs& robot, const SE3<double>& pose) {
  constexpr double rounding = 1e-12;
  return robot.is_planar && (std::abs(pose.p[2]) > rounding * legs_size(robot) ||
                             std::abs(pose.R.v[0]) > rounding || std::abs(pose.R.v[1]) > rounding);
}

std::string pose_misfit(const ArmLegs& robot, const SE3<double>& pose, std::string_view name) {
  if (!(pose.p.allFinite() && pose.R.matrix().allFinite())) return fmt::format("{} is not finite", name);
  if (leaves_plane(robot, pose)) return fmt::format("{} is out of the plane", name);
  return {};
}

}  // namespace sinew::inline v1
