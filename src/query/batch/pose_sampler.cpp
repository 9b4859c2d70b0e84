/// Inverse kinematics and velocity analysis of poses in lanes, for questions that vary the pose of a robot
/// whose legs close in closed form.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "io/robots/read_pose.hpp"
#include "query/batch/row_places.hpp"
#include "query/kinematic/kinematics.hpp"
#include "sinew/analysis/velocity.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

/// What of a batch becomes a column.
enum class Field {
  poses,
  inputs,
  curvatures,
  residual,
  determinant,
  condition,
  homogenised,
  position,
  rotation,
  type_1,
  type_2
};

struct Output {
  Field field;
  std::size_t row = 0;  ///< of several a pose: the leg, the coordinate
};

struct AskedPoses {
  Robot robot;
  bool is_inverse = false;
  std::optional<OperationMode> independent = {};
  std::vector<RowNumber> pose = {};  ///< x, y, φ; position and quaternion; z, e₁, e₂
  std::vector<int> bending = {}, elbow = {};
  std::vector<Output> outputs = {};
};

/// `legs[2].curvature` between `legs[` and `].curvature`.
std::optional<std::size_t> index_in(std::string_view path, std::string_view before, std::string_view after) {
  if (!path.starts_with(before) || !path.ends_with(after) || path.size() <= before.size() + after.size())
    return {};
  path = path.substr(before.size(), path.size() - before.size() - after.size());
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), index);
  return error == std::errc() && end == path.data() + path.size() ? std::optional(index) : std::nullopt;
}

std::optional<Output> output_of(std::string_view path, const AskedPoses& asked, std::size_t legs) {
  if (asked.independent) {
    const auto position = index_in(path, "pose.position[", "]"),
               quaternion = index_in(path, "pose.quaternion[", "]");
    if (position && *position < 3) return Output{Field::poses, *position};
    if (quaternion && *quaternion < 4) return Output{Field::poses, 3 + *quaternion};
  }
  if (const auto leg = index_in(path, "legs[", "].curvature"); leg && *leg < legs)
    return Output{Field::curvatures, *leg};
  if (path == "residual") return Output{Field::residual};
  if (asked.is_inverse) {
    const auto leg = index_in(path, "inputs[", "]");
    return leg && *leg < legs ? std::optional(Output{Field::inputs, *leg}) : std::nullopt;
  }
  static constexpr std::array<std::pair<std::string_view, Field>, 7> fields{
      {{"determinant", Field::determinant},
       {"indices.condition", Field::condition},
       {"indices.condition_homogenised", Field::homogenised},
       {"indices.position", Field::position},
       {"indices.rotation", Field::rotation},
       {"type_1.count", Field::type_1},
       {"type_2.singular", Field::type_2}}};
  for (const auto& [name, field] : fields)
    if (name == path) return Output{field};
  return {};
}

/// A quaternion is scaled when it is read: where columns go into it, its other numbers are as written.
bool put_spatial(const SpatialPose& pose, const RowPlaces& rows, AskedPoses& asked) {
  asked.pose = rows.numbers("pose.position", std::span(pose.position.data(), 3), PoseRange::coordinate);
  std::vector<RowNumber> quaternion = rows.numbers("pose.quaternion", pose.quaternion, PoseRange::coordinate);
  if (std::ranges::any_of(quaternion, [](const RowNumber& part) { return part.input >= 0; }))
    for (std::size_t k = 0; k < quaternion.size(); ++k) {
      const Node* written = at(rows.trial().root, joined("pose.quaternion", k));
      if (written->kind != Node::Kind::number) return false;
      quaternion[k].value = written->number;
    }
  asked.pose.insert(asked.pose.end(), quaternion.begin(), quaternion.end());
  return rows.are_within({"pose.position", "pose.quaternion"});
}

/// Whether the rows' numbers are those of the pose.
bool put_pose(const AskedPose& at, const RowPlaces& rows, AskedPoses& asked) {
  const auto put = [&](std::string_view place, double value, Range range) {
    asked.pose.push_back(rows.number(place, value, range));
  };
  if (at.independent) {
    const auto& [free, mode] = *at.independent;
    asked.independent = mode;
    put("independent.z", free.z, PoseRange::coordinate);
    put("independent.e1", free.e1, PoseRange::component);
    put("independent.e2", free.e2, PoseRange::component);
    return rows.are_within({"independent"});
  }
  if (!at.pose) return false;
  if (const auto* spatial = std::get_if<SpatialPose>(&*at.pose)) return put_spatial(*spatial, rows, asked);
  const auto& planar = std::get<PlanarPose>(*at.pose);
  put("pose.x", planar.x, PoseRange::coordinate);
  put("pose.y", planar.y, PoseRange::coordinate);
  put("pose.phi", planar.phi, PoseRange::angle);
  return rows.are_within({"pose"});
}

class PoseSampler {
 public:
  explicit PoseSampler(std::shared_ptr<const AskedPoses> asked) : shared_(std::move(asked)), work_(robot_) {}

  void operator()(const SampleBlock& block) {
    place(block);
    statuses_.resize(block.count);
    VelocityBatch out{.status = statuses_};
    for (const Output& output : asked_.outputs) choose(output, block.count, out);
    velocity_batch(robot_, {poses_, asked_.bending, asked_.elbow, asked_.independent}, out, work_);
    for (std::size_t k = 0; k < block.count; ++k)
      block.statuses[k] = is_taken_[k] ? status(statuses_[k]) : refused;
    for (std::size_t o = 0; o < asked_.outputs.size(); ++o) put(o, block);
    *block.done += block.count;
  }

 private:
  std::vector<double>& column(Field field) { return columns_[static_cast<std::size_t>(field)]; }

  void place(const SampleBlock& block) {
    const std::size_t n = block.count;
    poses_.resize(asked_.pose.size() * n);
    is_taken_.assign(n, 1);
    for (std::size_t c = 0; c < asked_.pose.size(); ++c)
      for (std::size_t k = 0; k < n; ++k) {
        poses_[c * n + k] = asked_.pose[c].at(block, k);
        is_taken_[k] &= static_cast<std::uint8_t>(asked_.pose[c].is_taken(poses_[c * n + k]));
      }
    for (std::size_t k = 0; asked_.pose.size() == 7 && k < n; ++k) {
      double square = 0;
      for (std::size_t c = 3; c < 7; ++c) square += poses_[c * n + k] * poses_[c * n + k];
      is_taken_[k] &= static_cast<std::uint8_t>(square >= PoseRange::least_square);
      const double scale = 1 / std::sqrt(square);  // of zero: no finite pose, which the batch says
      for (std::size_t c = 3; c < 7; ++c) poses_[c * n + k] *= scale;
    }
  }

  /// Where the batch puts what an output needs.
  void choose(const Output& output, std::size_t n, VelocityBatch& out) {
    const std::size_t legs = static_cast<std::size_t>(leg_count(robot_));
    const auto room = [&](std::size_t size) -> std::span<double> {
      column(output.field).resize(size);
      return column(output.field);
    };
    const auto flags = [&](std::vector<std::uint8_t>& values) -> std::span<std::uint8_t> {
      values.resize(n);
      return values;
    };
    switch (output.field) {
      case Field::poses:
        out.poses = room(7 * n);
        return;
      case Field::inputs:
        out.inputs = room(legs * n);
        return;
      case Field::curvatures:
        out.curvatures = room(legs * n);
        return;
      case Field::residual:
        out.residual = room(n);
        return;
      case Field::determinant:
        out.determinant = room(n);
        return;
      case Field::condition:
        out.condition = room(n);
        return;
      case Field::homogenised:
        out.condition_homogenised = room(n);
        return;
      case Field::position:
        out.position = room(n);
        return;
      case Field::rotation:
        out.rotation = room(n);
        return;
      case Field::type_1:
        out.type_1 = flags(type_1_);
        return;
      case Field::type_2:
        out.is_type_2 = flags(type_2_);
        return;
    }
  }

  SampleStatus status(Status found) const {
    return sample_status(asked_.is_inverse && found == Status::singular ? Status::converged : found);
  }

  void put(std::size_t o, const SampleBlock& block) {
    const Output& output = asked_.outputs[o];
    const bool is_flag = output.field == Field::type_1 || output.field == Field::type_2;
    const std::size_t n = block.count;
    for (std::size_t k = 0; k < n; ++k) {
      const Status found = statuses_[k];
      const bool is_there = is_taken_[k] && (found == Status::converged || found == Status::singular);
      block.output(o, k) = !is_there ? not_a_number
                           : is_flag ? (output.field == Field::type_1 ? type_1_ : type_2_)[k]
                                     : column(output.field)[output.row * n + k];
    }
  }

  std::shared_ptr<const AskedPoses> shared_;
  const AskedPoses& asked_ = *shared_;
  const Robot& robot_ = asked_.robot;
  Workspace work_;
  std::vector<double> poses_;
  std::vector<std::uint8_t> is_taken_;  ///< by a query
  std::vector<Status> statuses_;
  std::vector<std::uint8_t> type_1_, type_2_;
  std::array<std::vector<double>, 11> columns_;
};

}  // namespace

SamplerKind plan_poses(Context& context, const RowPlaces& rows) {
  if (!has_velocity_batch(context.robot)) return {};
  if (context.ask != Ask::inverse && context.ask != Ask::velocity) return {};
  KinematicQuestion question(context);
  question.read();
  Branch& branch = question.given.branch;
  const bool is_plain = question.is_read() && !question.max_iterations && question.near_inputs.empty() &&
                        !question.wants_all && !question.given.inputs && branch.curvature.empty() &&
                        question.wanted.twist.empty() && !question.wanted.along &&
                        question.wanted.words == usual_of(question.ask);
  AskedPoses asked{.robot = context.robot,
                   .is_inverse = context.ask == Ask::inverse,
                   .bending = std::move(branch.bending),
                   .elbow = std::move(branch.elbow)};
  if (!is_plain || !put_pose(question.given.at, rows, asked)) return {};
  for (const std::string& output : rows.outputs()) {
    const auto found = output_of(output, asked, static_cast<std::size_t>(leg_count(context.robot)));
    if (!found) return {};
    asked.outputs.push_back(*found);
  }
  return sampler_kind<PoseSampler>("poses in lanes", {2048, 16384}, std::move(asked));
}

}  // namespace sinew::inline v1
