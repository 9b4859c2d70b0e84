/// Robots of a file with chains for links.
#include <fmt/format.h>

#include <numbers>

#include "sinew/kinematics/chain.hpp"
#include "sinew/robot/catalog.hpp"

namespace sinew::inline v0 {
namespace {

template <class LegT>
concept CanBeChain = HasArc<typename LegT::Link> &&
    (std::same_as<typename LegT::Closure, Chord> || std::same_as<typename LegT::Closure, Strut>);

template <class LegT>
Errors lacks(const LegT& leg, std::size_t index) {
  Errors errors;
  const auto need = [&](bool has, std::string_view key, std::string_view meaning) {
    if (!has)
      errors.push_back(
          {"missing_key", fmt::format("legs[{}].link.{}", index, key),
           fmt::format("is {}: chains need it; write it under the leg's link, or under defaults", meaning)});
  };
  need(leg.backbone.joints.has_value(), "joints", "the number n of joints of the pseudo-rigid model");
  need(leg.backbone.youngs_modulus.has_value(), "material", "what the backbone is made of, {E: 60 GPa}");
  need(leg.backbone.diameter.has_value(), "diameter", "the diameter of the round backbone");
  return errors;
}

template <class Space, class LegT>
ChainLeg<Space> chain_leg(const LegT& leg, ChainModel model) {
  ChainLeg<Space> chain;
  const double d = *leg.backbone.diameter;
  chain.base = leg.base;
  chain.chain = {.length = leg.link.size(),
                 .links = *leg.backbone.joints - (Space::dimension == 3 ? 1 : 0),
                 .base = LegT::is_clamped ? ChainBase::clamped : ChainBase::pinned,
                 .model = model};
  chain.bending_stiffness = *leg.backbone.youngs_modulus * std::numbers::pi * d * d * d * d / 64;
  chain.tendon_offset = leg.drive.tendon_offset();
  if constexpr (requires { leg.closure.length; }) chain.strut = leg.closure.length;
  chain.platform_point = leg.platform_point;
  return chain;
}

template <class LegT>
Expected<AnyChainRobot> chain_robot_of(const ParallelRobot<LegT>& robot, ChainModel model) {
  using Space = typename LegT::Space;
  ChainRobot<Space> chains;
  chains.platform_radius = robot.platform_radius;
  Errors errors;
  std::size_t motors = 0;
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    with_leg(robot.legs[i], [&]<class One>(const One& leg) {
      if constexpr (CanBeChain<One>) {
        const Errors missing = lacks(leg, i);
        errors.insert(errors.end(), missing.begin(), missing.end());
        if (!missing.empty()) return;
        const int least = One::is_clamped ? 1 : Space::dimension == 3 ? 3 : 2;
        if (*leg.backbone.joints < least) {
          errors.push_back({"out_of_range", fmt::format("legs[{}].link.joints", i),
                            fmt::format("is {}: a chain of this leg bends at {} joints or more",
                                        *leg.backbone.joints, least)});
          return;
        }
        chains.legs.push_back(chain_leg<Space>(leg, model));
        if (One::Link::has_own_turn) ++motors;
      } else {
        errors.push_back(
            {"not_available", fmt::format("legs[{}]", i),
             "has no chain model: chains stand for tendon-driven links with a chord or a strut"});
      }
    });
  if (errors.empty() && chains.legs.size() != static_cast<std::size_t>(Space::dof))
    errors.push_back({"not_available", "legs",
                      fmt::format("are {}: chain models need as many legs as the platform has freedoms, {}",
                                  chains.legs.size(), Space::dof)});
  if (errors.empty() && motors != 0 && motors != chains.legs.size())
    errors.push_back(
        {"not_available", "legs", "either all have a motor at the base, or none, in chain models"});
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  chains.has_base_motors = motors > 0;
  return AnyChainRobot(std::move(chains));
}

}  // namespace

Expected<AnyChainRobot> chain_robot(const AnyRobot& robot, ChainModel model) {
  return visit_closing(
      robot, [&](const auto& r) { return chain_robot_of(r, model); },
      []() -> Expected<AnyChainRobot> {
        return failure("not_available", "legs", "are rods, which have a model of their own: leave model out");
      });
}

}  // namespace sinew::inline v0
