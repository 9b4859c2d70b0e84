#include "sinew/analysis/shape.hpp"

#include "robot/pose.hpp"

namespace sinew::inline v0 {
namespace {

template <class LegT>
void add_leg(PlanarShape& shape, const LegT& leg, const SE2<double>& platform, double q, int samples) {
  const auto tip = leg.tip(q);
  const auto frame = leg.base_frame(platform, tip);
  Polyline backbone;
  std::array<Polyline, 2> tendons;
  for (int k = 0; k < samples; ++k) {
    const double s = leg.link.length * k / (samples - 1);
    const Vec2<double> point = leg.link.point(q, s), side = leg.drive.offset * leg.link.side(q, s);
    backbone.push_back(frame.point(point));
    tendons[0].push_back(frame.point(Vec2<double>(point + side)));
    tendons[1].push_back(frame.point(Vec2<double>(point - side)));
  }
  const Vec2<double> head = platform.point(leg.platform_point);
  const auto anchor = leg.closure.anchor(tip);
  shape.backbones.push_back(std::move(backbone));
  shape.tendons.push_back(std::move(tendons));
  shape.lines.push_back({frame.point(anchor.position), head});
  shape.platform.push_back(head);
  shape.base.push_back(leg.base.p);
}

template <class LegT>
PlanarShape shape_of(const ParallelRobot<LegT>& robot, const AnyPose& pose, Numbers coordinates,
                     int samples) {
  PlanarShape shape;
  const auto platform = Planar::frame(in_space<Planar>(pose));
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    with_leg(robot.legs[i], [&](const auto& leg) { add_leg(shape, leg, platform, coordinates[i], samples); });
  return shape;
}

}  // namespace

PlanarShape shape(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates, int samples) {
  SINEW_EXPECTS(samples >= 2);
  return std::visit([&](const auto& r) { return shape_of(r, pose, coordinates, samples); }, robot.model);
}

}  // namespace sinew::inline v0
