/// Chains in place of a robot's arcs.
#include "robot/chains.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "robot/catalog.hpp"
#include "robot/make_chains.hpp"
#include "robot/parallel.hpp"

namespace sinew::inline v1 {
namespace {

template <class LegT>
concept CanBeChain = HasArc<typename LegT::Link> &&
    (std::same_as<typename LegT::Closure, Chord> || std::same_as<typename LegT::Closure, Strut>);

/// What keeps a leg from being a chain.
template <class LegT>
Errors lacks(const LegT& leg, std::size_t index) {
  Errors errors;
  const auto need = [&](bool has, std::string_view key, std::string_view meaning) {
    const std::string where = fmt::format("legs[{}].link", index);
    if (!has)
      errors.push_back(
          {"missing_key", where,
           fmt::format("missing key \"{}\" in {} ({}): pseudo-rigid chains need it.", key, where, meaning)});
  };
  need(leg.backbone.joints.has_value(), "joints", "how many joints the model has");
  need(leg.backbone.youngs_modulus.has_value(), "material", "of the backbone, {E: 60 GPa}");
  need(leg.backbone.diameter.has_value(), "diameter", "of the round backbone");
  const int least = LegT::is_clamped ? 1 : LegT::dimension == 3 ? 3 : 2;
  if (errors.empty() && *leg.backbone.joints < least) {
    const std::string where = fmt::format("legs[{}].link.joints", index);
    errors.push_back(
        {"out_of_range", where,
         fmt::format("{} = {}; a chain of this leg needs {} or more, or it has none with a spring.", where,
                     *leg.backbone.joints, least)});
  }
  return errors;
}

template <class Space, class LegT>
ChainLeg<Space> chain_leg(const LegT& leg, PrbDiscretisation model) {
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
  chain.diameter = d;
  return chain;
}

template <class LegT>
Expected<AnyChains> make_chains_of(const ParallelRobot<LegT>& robot, PrbDiscretisation model) {
  using Space = typename LegT::Space;
  ChainLegs<Space> chains;
  chains.platform_radius = robot.platform_radius;
  Errors errors;
  std::size_t motors = 0;
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    with_leg(robot.legs[i], [&]<class One>(const One& leg) {
      if (!errors.empty()) return;  // of the first leg; the others mostly lack the same
      if constexpr (CanBeChain<One>) {
        errors = lacks(leg, i);
        if (!errors.empty()) return;
        chains.legs.push_back(chain_leg<Space>(leg, model));
        if (One::Link::has_base_joint) ++motors;
      } else {
        errors.push_back(
            {"not_available", fmt::format("legs[{}]", i),
             fmt::format("legs[{}] has no model prb: chains stand for tendon-driven links with a "
                         "chord or a strut.",
                         i)});
      }
    });
  if (errors.empty() && robot.has_ties())
    errors.push_back({"not_available", "legs",
                      "some legs share their inputs (tied); model prb needs each leg to have its own."});
  if (errors.empty() && chains.legs.empty())
    errors.push_back({"not_available", "legs", "the robot has no legs; give it one or more."});
  if (errors.empty() && motors != 0 && motors != chains.legs.size())
    errors.push_back({"not_available", "legs",
                      "some legs have a motor at the base and some have none; model prb needs all or none."});
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  chains.has_base_motors = motors > 0;
  return AnyChains(std::move(chains));
}

}  // namespace

Expected<AnyChains> make_chains(const AnyLegs& legs, PrbDiscretisation discretisation) {
  return std::visit([&](const auto& own) { return make_chains_of(own, discretisation); }, legs);
}

template <class Space>
std::vector<Vec<double, Space::dimension>> chain_points(
    const ChainLeg<Space>& leg, std::span<const double> angles,
    const typename Space::template Frame<double>& platform) {
  constexpr int dimension = Space::dimension;
  const auto frame = chain_frame(leg, angles, platform);
  std::vector<Vec<double, dimension>> points;
  Vec2<double> at(0, 0);
  double turn = 0;
  const auto add = [&] {
    Vec<double, dimension> local = Vec<double, dimension>::Zero();
    local[0] = at[0], local[1] = at[1];
    points.push_back(frame.point(local));
  };
  add();
  std::size_t joint = 0;
  for (int link = 0; link < leg.chain.links; ++link) {
    if (link > 0 || leg.chain.base == ChainBase::clamped) turn += angles[joint++];
    at += leg.chain.link_length() * Vec2<double>(-std::sin(turn), std::cos(turn));
    add();
  }
  return points;
}

template std::vector<Vec2<double>> chain_points(const ChainLeg<Planar>&, std::span<const double>,
                                                const SE2<double>&);
template std::vector<Vec3<double>> chain_points(const ChainLeg<Spatial>&, std::span<const double>,
                                                const SE3<double>&);

}  // namespace sinew::inline v1
