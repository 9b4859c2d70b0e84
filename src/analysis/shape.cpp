#include "sinew/analysis/shape.hpp"
#include "robot/parallel.hpp"

#include "robot/arguments.hpp"
#include "robot/pose.hpp"
#include "robot/rods/rod_work.hpp"

namespace sinew::inline v1 {
namespace {

/// A point of the bending plane in a frame of the robot's space.
Vec2<double> placed(const SE2<double>& frame, const Vec2<double>& point) { return frame.point(point); }
Vec3<double> placed(const SE3<double>& frame, const Vec2<double>& point) {
  return frame.point(Vec3<double>(point.x(), point.y(), 0));
}

template <int D, class LegT, class Frame>
void add_arc(ShapeOf<D>& shape, const LegT& leg, const Frame& platform, const typename LegT::Coordinates& q,
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
  shape.backbones.push_back(std::move(backbone));
  shape.tendons.push_back(std::move(tendons));
}

/// Backbone and tendons of a leg with an arc, of another its rail from the base point to the carriage.
template <int D, class LegT, class Frame>
void add_link(ShapeOf<D>& shape, const LegT& leg, const Frame& platform, const typename LegT::Coordinates& q,
              int samples) {
  if constexpr (!HasArc<typename LegT::Link>) {
    PolylineOf<D> rail;
    for (int k = 0; k < samples; ++k)
      rail.push_back(leg.base.point(leg.link.tip(q).position * (static_cast<double>(k) / (samples - 1))));
    shape.backbones.push_back(std::move(rail));
    shape.tendons.emplace_back();
  } else {
    add_arc(shape, leg, platform, q, samples);
  }
}

template <int D, class LegT, class Frame>
void add_leg(ShapeOf<D>& shape, const LegT& leg, const Frame& platform, const typename LegT::Coordinates& q,
             int samples) {
  add_link(shape, leg, platform, q, samples);
  const Vec<double, D> head = platform.point(leg.platform_point);
  shape.lines.push_back({leg.reach(q).anchor, head});
  shape.platform.push_back(head);
  shape.base.push_back(leg.base.p);
}

/// Rods as their coordinates shape them, between the base and the platform, and closing legs among them.
AnyShape loaded_shape(const Robot& robot, RodGroup& system, const SpatialPose& pose, Numbers coordinates,
                      int samples) {
  SpatialShape shape;
  const SE3<double> platform = SE3<double>::from(pose);
  system.set_platform(platform);
  system.set_rods(coordinates);
  system.evaluate();
  int rod = 0;
  const auto add = [&]<class L>(const L& leg, const LegPlace& place, int) {
    if constexpr (BearsLoad<L>) {
      shape.backbones.push_back(system.centreline(rod, samples));
      shape.tendons.emplace_back();
      const Vec3<double> tip = system.rod(rod++).tip;
      shape.lines.push_back({tip, tip});
      shape.platform.push_back(tip);
      shape.base.push_back(leg.base.p);
    } else {
      add_leg(shape, leg, platform, own_coordinates(leg, place, coordinates), samples);
    }
  };
  robot.spatial()->for_each_leg(add);
  return shape;
}

}  // namespace

AnyShape any_shape(const Robot& robot, const AnyPose& pose, Numbers coordinates, int samples) {
  const bool fits = std::holds_alternative<PlanarPose>(pose) == is_planar(robot) &&
                    robot.is_within_limits() && robot.model() != Model::prb && samples >= 2 &&
                    coordinates.size() == static_cast<std::size_t>(coordinate_count(robot));
  if (!fits) return is_planar(robot) ? AnyShape(PlanarShape{}) : AnyShape(SpatialShape{});
  return with_closing_legs(
      robot,
      [&]<class LegT>(const ParallelRobot<LegT>& r) -> AnyShape {
        using Space = typename LegT::Space;
        ShapeOf<Space::dimension> shape;
        const auto platform = Space::frame(in_space<Space>(pose));
        r.for_each_closing_leg([&](const auto& leg, const LegPlace& place, int) {
          add_leg(shape, leg, platform, own_coordinates(leg, place, coordinates), samples);
        });
        return shape;
      },
      [&] {
        return loaded_shape(robot, *rod_group(robot), std::get<SpatialPose>(pose), coordinates, samples);
      });
}

}  // namespace sinew::inline v1
