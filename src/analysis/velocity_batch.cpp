#include "sinew/analysis/velocity.hpp"

#include <algorithm>

#include "analysis/velocity_lanes.hpp"
#include "robot/arguments.hpp"
#include "robot/parallel.hpp"
#include "robot/pose.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {
namespace {

using velocity_lanes::ChordLeg, velocity_lanes::ChordRobot, velocity_lanes::HingedLeg,
    velocity_lanes::HingedRobot, velocity_lanes::LaneRobot;

constexpr std::size_t poses_at_a_time = 512;

using PlanarChordLeg = Leg<Planar, Arc, TendonPair, Chord>;
using SpatialChordLeg = Leg<Spatial, Arc, TendonPair, Chord>;
using PrsLeg = Leg<Spatial, Rail, SlideDrive, HingedStrut>;

template <class Vector>
std::array<double, 3> numbers(const Vector& vector) {
  std::array<double, 3> found = {};
  std::copy(vector.begin(), vector.end(), found.begin());
  return found;
}

template <class LegT>
ChordLeg chord_leg(const LegT& leg, int bending) {
  return {.length = leg.link.length,
          .offset = leg.drive.offset,
          .bending = bending < 0 ? -1.0 : 1.0,
          .domain = leg.domain(),
          .base = numbers(leg.base.p),
          .point = numbers(leg.platform_point)};
}

HingedLeg hinged_leg(const PrsLeg& leg, int elbow) {
  const Vec3<double> hinge = Spatial::first_axis(leg.base), rail = Spatial::second_axis(leg.base);
  return {.strut = leg.closure.length,
          .elbow = elbow < 0 ? -1.0 : 1.0,
          .base = numbers(leg.base.p),
          .point = numbers(leg.platform_point),
          .hinge = numbers(hinge),
          .rail = numbers(rail),
          .across = numbers(cross(hinge, rail))};
}

int sign(std::span<const int> signs, std::size_t i) { return signs.empty() ? 0 : signs[i]; }

/// Calls `use(leg, i)` with each leg of this kind; whether these are all, so many, each with its own inputs.
template <class LegT, class Use>
bool with_alike(const Robot& robot, int count, const Use& use) {
  if (leg_count(robot) != count || has_ties(robot)) return false;
  with_legs(robot, [&](const auto& legs) {
    legs.for_each_leg([&]<class L>(const L& leg, const LegPlace&, int i) {
      if constexpr (std::is_same_v<L, LegT>) use(leg, static_cast<std::size_t>(i)), --count;
    });
  });
  return count == 0;
}

template <class LegT>
LaneRobot chord_robot(const Robot& robot, const PoseBatch& batch) {
  constexpr int dof = LegT::Space::dof;
  ChordRobot found{.dof = dof, .radius = platform_radius(robot)};
  const auto add = [&](const LegT& leg, std::size_t i) {
    found.legs[i] = chord_leg(leg, sign(batch.bending, i));
  };
  return with_alike<LegT>(robot, dof, add) ? LaneRobot(found) : LaneRobot();
}

LaneRobot hinged_robot(const Robot& robot, const PoseBatch& batch) {
  HingedRobot found{.radius = platform_radius(robot)};
  const auto add = [&](const PrsLeg& leg, std::size_t i) {
    found.legs[i] = hinged_leg(leg, sign(batch.elbow, i));
    found.size = std::max(found.size, leg.size());
  };
  return with_alike<PrsLeg>(robot, 3, add) ? LaneRobot(found) : LaneRobot();
}

LaneRobot lane_robot(const Robot& robot, const PoseBatch& batch) {
  if (robot.planar()) return chord_robot<PlanarChordLeg>(robot, batch);
  const LaneRobot chords = chord_robot<SpatialChordLeg>(robot, batch);
  return chords.index() != 0 ? chords : hinged_robot(robot, batch);
}

std::size_t axes_of(const Robot& robot, const PoseBatch& batch) {
  return batch.independent || dof(robot) == Planar::dof ? 3 : 7;
}

/// One pose by the functions that the lanes stand in for.
class OneByOne {
 public:
  OneByOne(const Robot& robot, const PoseBatch& batch, std::size_t total, const VelocityBatch& out,
           Workspace& work)
      : robot_(robot),
        batch_(batch),
        total_(total),
        out_(out),
        work_(work) {}

  void put(std::size_t k) {
    const auto [pose, found] = pose_at(k);
    put_pose(k, pose);
    if (found != Status::converged) return put_nothing(k, found);
    const Inverse solved = inverse(robot_, pose, {.bending = batch_.bending, .elbow = batch_.elbow}, work_);
    if (!solved.ok()) return put_nothing(k, solved.report.status);
    put_legs(k, out_.inputs, solved.inputs);
    if (has_arc(robot_)) put_legs(k, out_.curvatures, solved.coordinates);
    const Velocity at = velocity(robot_, pose, solved.coordinates, work_);
    put(out_.status, k, at.report.status);
    put(out_.residual, k, solved.report.residual);
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
    for (const std::span<double> numbers :
         {out_.inputs, out_.curvatures, out_.residual, out_.determinant, out_.condition,
          out_.condition_homogenised, out_.position, out_.rotation})
      for (std::size_t at = k; at < numbers.size(); at += total_) numbers[at] = not_a_number;
  }

 private:
  std::pair<AnyPose, Status> pose_at(std::size_t k) const {
    const auto c = [&](std::size_t axis) { return batch_.coordinates[axis * total_ + k]; };
    if (batch_.independent) {
      const ConstrainedPose found = constrained_pose(robot_, {c(0), c(1), c(2)}, *batch_.independent);
      return {found.pose, found.report.status};
    }
    if (dof(robot_) == Planar::dof) return {PlanarPose{c(0), c(1), c(2)}, Status::converged};
    return {SpatialPose{{c(0), c(1), c(2)}, {c(3), c(4), c(5), c(6)}}, Status::converged};
  }

  void put_pose(std::size_t k, const AnyPose& any) const {
    if (!batch_.independent || out_.poses.empty()) return;
    const SpatialPose& pose = std::get<SpatialPose>(any);
    for (std::size_t c = 0; c < 3; ++c) out_.poses[c * total_ + k] = pose.position[static_cast<int>(c)];
    for (std::size_t c = 0; c < 4; ++c) out_.poses[(3 + c) * total_ + k] = pose.quaternion[c];
  }

  template <class T>
  static void put(std::span<T> to, std::size_t k, T value) {
    if (!to.empty()) to[k] = value;
  }

  void put_legs(std::size_t k, std::span<double> to, std::span<const double> numbers) const {
    for (std::size_t i = 0; i < numbers.size(); ++i) put(to, i * total_ + k, numbers[i]);
  }

  const Robot& robot_;
  const PoseBatch& batch_;
  std::size_t total_;
  const VelocityBatch& out_;
  Workspace& work_;
};

/// Whether each span is empty or of its size.
bool fits(const VelocityBatch& out, std::size_t poses, std::size_t legs) {
  const auto fit = [](const auto& span, std::size_t size) { return span.empty() || span.size() == size; };
  return fit(out.poses, 7 * poses) && fit(out.status, poses) && fit(out.type_1, poses) &&
         fit(out.is_type_2, poses) && fit(out.inputs, legs * poses) && fit(out.curvatures, legs * poses) &&
         fit(out.residual, poses) && fit(out.determinant, poses) && fit(out.condition, poses) &&
         fit(out.condition_homogenised, poses) && fit(out.position, poses) && fit(out.rotation, poses);
}

}  // namespace

bool has_velocity_batch(const Robot& robot) {
  return !bears_load(robot) &&
         !std::holds_alternative<std::monostate>(lane_robot(robot, {.coordinates = {}}));
}

std::size_t velocity_batch(const Robot& robot, const PoseBatch& batch, const VelocityBatch& out,
                           Workspace& work) {
  const auto legs = static_cast<std::size_t>(leg_count(robot));
  const auto is_for_legs = [&](std::span<const int> signs) { return signs.empty() || signs.size() == legs; };
  const bool is_served = has_velocity_batch(robot) && check_workspace(robot, work).ok() &&
                         is_for_legs(batch.bending) && is_for_legs(batch.elbow) &&
                         (!batch.independent || plane_count(robot) == 3);
  const std::size_t axes = axes_of(robot, batch), total = batch.coordinates.size() / axes;
  const bool has_places = batch.coordinates.size() == axes * total && fits(out, total, legs);
  if (!has_places) {  // there may be no room for a number a pose
    std::ranges::fill(out.status, Status::bad_input);
    return 0;
  }
  OneByOne one_by_one(robot, batch, total, out, work);
  if (!is_served) {
    for (std::size_t k = 0; k < total; ++k) one_by_one.put_nothing(k, Status::left_domain);
    return 0;
  }
  if (!has_arc(robot)) std::ranges::fill(out.curvatures, not_a_number);
  const LaneRobot lanes = lane_robot(robot, batch);
  std::size_t left = 0;
  std::array<std::uint8_t, poses_at_a_time> doubtful;
  for (std::size_t first = 0; first < total; first += poses_at_a_time) {
    const std::size_t count = std::min(poses_at_a_time, total - first);
    velocity_lanes::evaluate(lanes, {batch.coordinates.data(), total, first, count, batch.independent}, out,
                             doubtful.data());
    for (std::size_t k = 0; k < count; ++k)
      if (doubtful[k] != 0) one_by_one.put(first + k), ++left;
  }
  return left;
}

}  // namespace sinew::inline v1
