#include "analysis/chain_shape.hpp"

#include <cmath>

namespace sinew::inline v1 {
namespace {

/// From a link that points along a unit vector, towards its tendon 1.
Vec2<double> beside(const SE2<double>&, const Vec2<double>& along) { return {along.y(), -along.x()}; }
Vec3<double> beside(const SE3<double>& chain_frame, const Vec3<double>& along) {
  return cross(along, chain_frame.rotate(Vec3<double>(0, 0, 1)));
}

template <class Space>
std::array<PolylineOf<Space::dimension>, 2> tendons_of(
    const ChainLeg<Space>& leg, std::span<const double> angles,
    const typename Space::template Frame<double>& chain_frame, const PolylineOf<Space::dimension>& backbone) {
  using Point = Vec<double, Space::dimension>;
  std::array<PolylineOf<Space::dimension>, 2> tendons;
  const auto add_disc = [&](const Point& centre, const Point& along, double turn) {
    const Point side =
        leg.tendon_offset * (std::cos(turn) * beside(chain_frame, along) + std::sin(turn) * along);
    tendons[0].push_back(centre + side);
    tendons[1].push_back(centre - side);
  };
  const auto [turn_before, turn_after] = leg.chain.end_turns(angles);
  for (std::size_t i = 0; i + 1 < backbone.size(); ++i) {
    const Point along = (backbone[i + 1] - backbone[i]) / leg.chain.link_length();
    if (i == 0) add_disc(backbone.front(), along, -turn_before);
    add_disc(0.5 * (backbone[i] + backbone[i + 1]), along, 0);
    if (i + 2 == backbone.size()) add_disc(backbone.back(), along, turn_after);
  }
  return tendons;
}

}  // namespace

template <class Space>
ShapeOf<Space::dimension> chain_shape(const ChainLegs<Space>& robot, const typename Space::Pose& pose,
                                      std::span<const ChainLegState> legs) {
  ShapeOf<Space::dimension> shape;
  if (legs.size() != robot.legs.size()) return shape;
  const auto platform = Space::frame(pose);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const ChainLeg<Space>& leg = robot.legs[i];
    const std::span<const double> angles = legs[i].of(leg.chain);
    PolylineOf<Space::dimension> backbone = chain_points(leg, angles, platform);
    const Vec<double, Space::dimension> head = platform.point(leg.platform_point);
    shape.tendons.push_back(tendons_of(leg, angles, chain_frame(leg, angles, platform), backbone));
    shape.lines.push_back({leg.has_strut() ? backbone.back() : leg.base.p, head});
    shape.platform.push_back(head);
    shape.base.push_back(leg.base.p);
    shape.backbones.push_back(std::move(backbone));
  }
  return shape;
}

template ShapeOf<2> chain_shape(const ChainLegs<Planar>&, const PlanarPose&, std::span<const ChainLegState>);
template ShapeOf<3> chain_shape(const ChainLegs<Spatial>&, const SpatialPose&,
                                std::span<const ChainLegState>);

}  // namespace sinew::inline v1
