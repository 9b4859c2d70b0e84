#include "sinew/analysis/velocity_batch.hpp"

#include <algorithm>

#include "analysis/chord_lanes.hpp"
#include "robot/pose.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v0 {
namespace {

using chord_lanes::ChordLeg, chord_lanes::ChordRobot;

constexpr double absent = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t poses_at_a_time = 512;

template <class LegT>
concept IsChordLeg = requires {
  requires std::same_as<typename LegT::Link, Arc> && std::same_as<typename LegT::Drive, TendonPair> &&
      std::same_as<typename LegT::Closure, Chord>;
};

template <class LegT>
ChordLeg chord_leg(const LegT& leg, int bending) {
  ChordLeg found{.length = leg.link.length,
                 .offset = leg.drive.offset,
                 .bending = bending < 0 ? -1.0 : 1.0,
                 .domain = leg.domain(),
                 .base = {},
                 .point = {}};
  std::copy(leg.base.p.begin(), leg.base.p.end(), found.base.begin());
  std::copy(leg.platform_point.begin(), leg.platform_point.end(), found.point.begin());
  return found;
}

/// Without legs (dof 0) where the lanes do not serve it.
ChordRobot chord_robot(const AnyRobot& robot, std::span<const int> bending) {
  return std::visit(
      [&]<class LegT>(const ParallelRobot<LegT>& r) {
        ChordRobot found;
        if constexpr (IsChordLeg<LegT>) {
          if (r.leg_count() != LegT::Space::dof || r.has_ties()) return found;
          found.dof = LegT::Space::dof;
          found.radius = r.platform_radius;
          for (std::size_t i = 0; i < r.legs.size(); ++i)
            found.legs[i] = chord_leg(r.legs[i], bending.empty() ? 0 : bending[i]);
        }
        return found;
      },
      robot.model);
}

/// One pose by the functions that the lanes stand in for.
class OneByOne {
 public:
  OneByOne(const AnyRobot& robot, Numbers poses, std::size_t total, std::span<const int> bending,
           const VelocityBatch& out, Workspace& work)
      : robot_(robot),
        poses_(poses),
        total_(total),
        bending_(bending),
        out_(out),
        work_(work) {}

  void put(std::size_t k) {
    const AnyPose pose = pose_at(k);
    const Inverse solved = inverse(robot_, pose, {.bending = bending_}, work_);
    if (!solved.ok()) return put_nothing(k, solved.report.status);
    put_legs(k, solved.inputs, solved.coordinates);
    const Velocity at = velocity(robot_, pose, solved.coordinates, work_);
    put(out_.status, k, at.report.status);
    put(out_.determinant, k, at.determinant);
    put(out_.condition, k, at.indices.condition);
    put(out_.condition_homogenised, k, at.indices.condition_homogenised);
    put(out_.position, k, at.indices.position);
    put(out_.rotation, k, at.indices.rotation);
    put(out_.type_1, k, static_cast<std::uint8_t>(at.type_1.size()));
    put(out_.is_type_2, k, std::uint8_t{at.type_2.singular});
  }

  void put_nothing(std::size_t k, Status why) {
    put(out_.status, k, why);
    put(out_.type_1, k, std::uint8_t{0});
    put(out_.is_type_2, k, std::uint8_t{0});
    for (const std::span<double> numbers : {out_.inputs, out_.curvatures, out_.determinant, out_.condition,
                                            out_.condition_homogenised, out_.position, out_.rotation})
      for (std::size_t at = k; at < numbers.size(); at += total_) numbers[at] = absent;
  }

 private:
  double coordinate(std::size_t axis, std::size_t k) const { return poses_[axis * total_ + k]; }

  AnyPose pose_at(std::size_t k) const {
    const auto c = [&](std::size_t axis) { return coordinate(axis, k); };
    if (dof(robot_) == Planar::dof) return PlanarPose{c(0), c(1), c(2)};
    return SpatialPose{{c(0), c(1), c(2)}, {c(3), c(4), c(5), c(6)}};
  }

  template <class T>
  static void put(std::span<T> to, std::size_t k, T value) {
    if (!to.empty()) to[k] = value;
  }

  void put_legs(std::size_t k, std::span<const double> inputs, std::span<const double> curvatures) {
    for (std::size_t i = 0; i < inputs.size(); ++i) put(out_.inputs, i * total_ + k, inputs[i]);
    for (std::size_t i = 0; i < curvatures.size(); ++i) put(out_.curvatures, i * total_ + k, curvatures[i]);
  }

  const AnyRobot& robot_;
  Numbers poses_;
  std::size_t total_;
  std::span<const int> bending_;
  const VelocityBatch& out_;
  Workspace& work_;
};

/// Whether each span is empty or of its size.
[[maybe_unused]] bool fits(const VelocityBatch& out, std::size_t poses, std::size_t legs) {
  const auto fit = [](const auto& span, std::size_t size) { return span.empty() || span.size() == size; };
  return fit(out.status, poses) && fit(out.type_1, poses) && fit(out.is_type_2, poses) &&
         fit(out.inputs, legs * poses) && fit(out.curvatures, legs * poses) && fit(out.determinant, poses) &&
         fit(out.condition, poses) && fit(out.condition_homogenised, poses) && fit(out.position, poses) &&
         fit(out.rotation, poses);
}

}  // namespace

bool has_velocity_batch(const AnyRobot& robot) { return chord_robot(robot, {}).dof > 0; }

std::size_t velocity_batch(const AnyRobot& robot, Numbers poses, std::span<const int> bending,
                           const VelocityBatch& out, Workspace& work) {
  const auto legs = static_cast<std::size_t>(leg_count(robot));
  const bool is_served = has_velocity_batch(robot) && (bending.empty() || bending.size() == legs);
  const std::size_t axes = dof(robot) == Planar::dof ? 3 : 7, total = poses.size() / axes;
  SINEW_EXPECTS(is_served && poses.size() == axes * total && fits(out, total, legs));
  OneByOne one_by_one(robot, poses, total, bending, out, work);
  if (!is_served) {
    for (std::size_t k = 0; k < total; ++k) one_by_one.put_nothing(k, Status::left_domain);
    return 0;
  }
  const ChordRobot lanes = chord_robot(robot, bending);
  std::size_t left = 0;
  std::array<std::uint8_t, poses_at_a_time> doubtful;
  for (std::size_t first = 0; first < total; first += poses_at_a_time) {
    const std::size_t count = std::min(poses_at_a_time, total - first);
    chord_lanes::evaluate(lanes, {poses.data(), total, first, count}, out, doubtful.data());
    for (std::size_t k = 0; k < count; ++k)
      if (doubtful[k] != 0) one_by_one.put(first + k), ++left;
  }
  return left;
}

}  // namespace sinew::inline v0
