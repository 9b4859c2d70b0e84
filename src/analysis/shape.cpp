#include "sinew/analysis/shape.hpp"

#include "robot/pose.hpp"

namespace sinew::inline v0 {
namespace {

/// A point of the bending plane in a frame of the robot's space.
Vec2<double> placed(const SE2<double>& frame, const Vec2<double>& point) { return frame.point(point); }
Vec3<double> placed(const SE3<double>& frame, const Vec2<double>& point) {
  return frame.point(Vec3<double>(point.x(), point.y(), 0));
}

template <int D, class LegT, class Frame>
void add_leg(ShapeOf<D>& shape, const LegT& leg, const Frame& platform, const typename LegT::Coordinates& q,
             int samples) {
  const auto frame = leg.link_frame(platform, q);
  const double curvature = leg.link.curvature(q), length = leg.link.arc().length;
  const double offset = leg.drive.tendon_offset();
  PolylineOf<D> backbone;
  std::array<PolylineOf<D>, 2> tendons;
  for (int k = 0; k < samples; ++k) {
    const double s = length * k / (samples - 1);
    const Vec2<double> point = leg.link.arc().point(curvature, s),
                       side = offset * leg.link.arc().side(curvature, s);
    backbone.push_back(placed(frame, point));
    tendons[0].push_back(placed(frame, Vec2<double>(point + side)));
    tendons[1].push_back(placed(frame, Vec2<double>(point - side)));
  }
  const Vec<double, D> head = platform.point(leg.platform_point);
  shape.backbones.push_back(std::move(backbone));
  shape.tendons.push_back(std::move(tendons));
  shape.lines.push_back({leg.reach(q).anchor, head});
  shape.platform.push_back(head);
  shape.base.push_back(leg.base.p);
}

}  // namespace

AnyShape any_shape(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates, int samples) {
  SINEW_EXPECTS(samples >= 2);
  return std::visit(
      [&]<class LegT>(const ParallelRobot<LegT>& r) -> AnyShape {
        using Space = typename LegT::Space;
        ShapeOf<Space::dimension> shape;
        const auto platform = Space::frame(in_space<Space>(pose));
        r.for_each_leg([&](const auto& leg, const LegPlace& place, int) {
          add_leg(shape, leg, platform, own_coordinates(leg, place, coordinates), samples);
        });
        return shape;
      },
      robot.model);
}

}  // namespace sinew::inline v0
