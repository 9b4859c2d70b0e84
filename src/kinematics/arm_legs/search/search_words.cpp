#include "kinematics/arm_legs/search/search_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sinew::inline v1 {
namespace {

/// By how much a leg that stretches, and one that does not, may be shorter than the way it has to span [1]: a
/// guess for backbones as stiff as they mostly are, for a leg that was not found at the pose; and rounding.
constexpr double largest_stretch = 1e-2, rounding_of_length = 1e-9;

/// A leg that the pose is too far from, by more than it may stretch, in words; or empty.
std::string out_of_reach(const ArmLegs& robot, const ArmGroup::Frame& pose) {
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    const ArmLeg& leg = robot.legs[k];
    const double way = (pose.point(leg.platform_point) - leg.base.p).norm(),
                 length = leg.arm.length() + leg.strut;
    const bool stretches = std::ranges::any_of(
        leg.arm.sections, [](const ArmSection& section) { return section.start.stretch > 0; });
    if (way > (1 + (stretches ? largest_stretch : rounding_of_length)) * length)
      return fmt::format(
          "leg {} is out of reach: from its base to the platform it is {:.4g} m, and it is {:.4g} m long", k,
          way, length);
  }
  return {};
}

/// Why a free platform has no equilibrium under all that acts.
std::string words_of_free(bool has_potential, double reached) {
  if (reached == 1)
    return "what coarse polynomials found is not found again by finer ones: a leg is bent too sharply for "
           "them";
  const double percent = 100 * reached;
  if (!has_potential)
    return fmt::format(
        "inputs and loads led to an equilibrium that is known to hold up to {:.2f} % of them, and "
        "beyond to none: some of the loads have no potential, and what is beyond may hold or not",
        percent);
  return fmt::format(
      "inputs and loads led to an equilibrium that holds up to {:.2f} % of them, and beyond to none",
      percent);
}

/// Which tendon is held too short, and by how much.
std::string words_of_short_tendon(const ArmLegs& robot, const LegsFound& found) {
  std::size_t leg = 0;
  int tendon = found.short_tendon;
  for (; tendon >= static_cast<int>(robot.legs[leg].arm.tendons.size()); ++leg)
    tendon -= static_cast<int>(robot.legs[leg].arm.tendons.size());
  return fmt::format(
      "tendon {} of leg {} does not stretch and is held too short, against others or beyond what the leg can "
      "bend: "
      "the nearest shape that was found has it longer by {:.3g} m",
      tendon, leg, found.short_by);
}

/// Why a platform is not kept at the prescribed pose, and the way out.
std::string words_of_pose(const ArmLegs& robot, const LegsProblem& problem, const LegsFound& found,
                          double reached) {
  const std::string far = out_of_reach(robot, *problem.prescribed_pose);
  if (!far.empty()) return far;
  if (reached == 1)
    return "coarse polynomials hold the platform at the pose, and finer ones do not: a leg is pulled or bent "
           "too sharply for them";
  const char* why =
      found.last_step == Status::unstable
          ? "a leg gives way by itself: bend it by tensions, or lead the platform there by track"
      : found.last_step == Status::singular
          ? "a leg that is straight and does not stretch has no finite stiffness: bend it by tensions"
          : "no equilibrium was found: lead the platform there by track, or give less load";
  return fmt::format("legs held the platform up to {:.2f} % of the way to the pose, and beyond {}",
                     100 * reached, why);
}

}  // namespace

std::string words_of_search(const ArmLegs& robot, const LegsProblem& problem, const LegsFound& found,
                            bool has_potential, double reached) {
  const bool has_pose = problem.prescribed_pose.has_value();
  const char* of_what = has_pose ? "of the way to the pose" : "of inputs and loads";
  switch (found.status) {
    case Status::stalled:
      return has_pose ? words_of_pose(robot, problem, found, reached) : words_of_free(has_potential, reached);
    case Status::unreachable:
      return words_of_short_tendon(robot, found);
    case Status::iteration_limit:
      return fmt::format("the bound on iterations was met at {:.2f} % {}", 100 * reached, of_what);
    case Status::stopped:
      return fmt::format("stopped at {:.2f} % {}", 100 * reached, of_what);
    case Status::left_domain:
      return "numbers are beyond what can be computed: a leg is bent too sharply, or loads are too large";
    default:
      return {};
  }
}

}  // namespace sinew::inline v1
