/// Inverse kinematics and velocity analysis of poses in lanes, for questions that vary the pose of a robot
/// whose legs close in closed form.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "query/batch/query_entries.hpp"
#include "sinew/analysis/velocity.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/io/robot_file.hpp"

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
  bool is_inverse = false, is_spatial = false;
  std::vector<QueryEntry> pose;  ///< x, y, φ; position and quaternion; z, e₁, e₂
  std::optional<OperationMode> independent;
  std::vector<int> bending, elbow;
  std::vector<Output> outputs;
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

/// Numbers under these keys.
bool read_members(const Node& map, std::initializer_list<const char*> names, const BatchQuestion& question,
                  AskedPoses& asked) {
  for (const char* name : names) {
    const Node* value = map.find(name);
    const auto entry = value ? query_entry(*value, question) : std::nullopt;
    if (!entry) return false;
    asked.pose.push_back(*entry);
  }
  return true;
}

bool read_independent(const Node& place, const BatchQuestion& question, AskedPoses& asked) {
  if (place.kind != Node::Kind::map) return false;
  const Node* mode = place.find("mode");
  if (mode && mode->text != "tilt" && mode->text != "half_turn") return false;
  asked.independent = mode && mode->text == "half_turn" ? OperationMode::half_turn : OperationMode::tilt;
  return place.members.size() == (mode ? 4U : 3U) && read_members(place, {"z", "e1", "e2"}, question, asked);
}

/// ±1 of each leg.
bool read_signs(const Node& list, const BatchQuestion& question, std::vector<int>& signs) {
  const auto found = constant_entries(list, question);
  if (!found) return false;
  for (const double sign : *found) signs.push_back(sign < 0 ? -1 : 1);
  return true;
}

bool read_pose(const Node& pose, const BatchQuestion& question, AskedPoses& asked) {
  const auto add = [&](const std::optional<std::vector<QueryEntry>>& entries, std::size_t size) {
    if (!entries || entries->size() != size) return false;
    asked.pose.insert(asked.pose.end(), entries->begin(), entries->end());
    return true;
  };
  if (pose.kind != Node::Kind::map) return false;
  if (!asked.is_spatial)
    return pose.members.size() == 3 && read_members(pose, {"x", "y", "phi"}, question, asked);
  const Node *position = pose.find("position"), *quaternion = pose.find("quaternion");
  if (pose.members.size() != (quaternion ? 2U : 1U) || !position ||
      !add(query_entries(*position, question), 3))
    return false;
  return quaternion ? add(query_entries(*quaternion, question), 4)
                    : add(std::vector<QueryEntry>{{1}, {0}, {0}, {0}}, 4);
}

std::optional<AskedPoses> asked_of_poses(const BatchQuestion& question, const Robot& robot) {
  AskedPoses asked{.is_spatial = std::holds_alternative<SpatialPose>(home(robot)),
                   .pose = {},
                   .independent = {},
                   .bending = {},
                   .elbow = {},
                   .outputs = {}};
  const auto legs = static_cast<std::size_t>(leg_count(robot));
  for (const Member& field : question.query.root.members) {
    if (field.key == "query") {
      asked.is_inverse = field.value.text == "inverse";
      if (!asked.is_inverse && field.value.text != "velocity") return {};
    } else if (field.key == "pose") {
      if (!read_pose(field.value, question, asked)) return {};
    } else if (field.key == "independent") {
      const bool is_held_in_planes = plane_count(robot) == 3;  // of others the question itself says why not
      if (!is_held_in_planes || !read_independent(field.value, question, asked)) return {};
    } else if (field.key == "bending") {
      if (!read_signs(field.value, question, asked.bending)) return {};
    } else if (field.key == "elbow") {
      if (!read_signs(field.value, question, asked.elbow)) return {};
    } else {
      return {};
    }
  }
  if (asked.pose.empty()) return {};
  for (const std::string& output : question.outputs) {
    const auto found = output_of(output, asked, legs);
    if (!found) return {};
    asked.outputs.push_back(*found);
  }
  return asked;
}

class PoseSampler {
 public:
  PoseSampler(const Robot& robot, const AskedPoses& asked) : robot_(robot), asked_(asked), work_(robot) {}

  void operator()(const SampleBlock& block) {
    place(block);
    statuses_.resize(block.count);
    VelocityBatch out{.status = statuses_};
    for (const Output& output : asked_.outputs) choose(output, block.count, out);
    velocity_batch(robot_, {poses_, asked_.bending, asked_.elbow, asked_.independent}, out, work_);
    for (std::size_t k = 0; k < block.count; ++k)
      block.statuses[k] = is_refused(k, block.count) ? refused : status(statuses_[k]);
    for (std::size_t o = 0; o < asked_.outputs.size(); ++o) put(o, block);
    *block.done += block.count;
  }

 private:
  /// What a query would not take, whatever the robot; see read_pose.cpp and context.cpp.
  bool is_refused(std::size_t k, std::size_t n) const {
    const auto c = [&](std::size_t axis) { return poses_[axis * n + k]; };
    const Range place = Range::place(), component = Range::between(-1, 1);
    if (asked_.independent)
      return !place.contains(c(0)) || !component.contains(c(1)) || !component.contains(c(2));
    if (!asked_.is_spatial)
      return !place.contains(c(0)) || !place.contains(c(1)) || !Range::turn().contains(c(2));
    return !place.contains(c(0)) || !place.contains(c(1)) || !place.contains(c(2)) || !(squares_[k] >= 1e-12);
  }

  std::vector<double>& column(Field field) { return columns_[static_cast<std::size_t>(field)]; }

  void place(const SampleBlock& block) {
    const std::size_t n = block.count;
    poses_.resize(asked_.pose.size() * n);
    for (std::size_t c = 0; c < asked_.pose.size(); ++c)
      for (std::size_t k = 0; k < n; ++k) poses_[c * n + k] = asked_.pose[c].at(block, k);
    squares_.assign(n, 1);
    for (std::size_t k = 0; asked_.pose.size() == 7 && k < n; ++k) {
      double square = 0;
      for (std::size_t c = 3; c < 7; ++c) square += poses_[c * n + k] * poses_[c * n + k];
      squares_[k] = square;
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
      const bool is_there = found == Status::converged || found == Status::singular;
      block.output(o, k) = !is_there ? not_a_number
                           : is_flag ? (output.field == Field::type_1 ? type_1_ : type_2_)[k]
                                     : column(output.field)[output.row * n + k];
    }
  }

  const Robot& robot_;
  const AskedPoses& asked_;
  Workspace work_;
  std::vector<double> poses_, squares_;  ///< of the quaternions given
  std::vector<Status> statuses_;
  std::vector<std::uint8_t> type_1_, type_2_;
  std::array<std::vector<double>, 11> columns_;
};

}  // namespace

SamplerKind pose_sampler(const BatchQuestion& question) {
  auto robot = read_robot(question.robot);
  if (!robot || !has_velocity_batch(*robot)) return {};
  auto asked = asked_of_poses(question, *robot);
  if (!asked) return {};
  struct Shared {
    Robot robot;
    AskedPoses asked;
  };
  const auto shared = std::make_shared<const Shared>(Shared{std::move(*robot), std::move(*asked)});
  return {.name = "poses in lanes", .chunks = {2048, 16384}, .make = [shared]() -> Sampler {
            return [shared, sampler = std::make_shared<PoseSampler>(shared->robot, shared->asked)](
                       const SampleBlock& block) { (*sampler)(block); };
          }};
}

}  // namespace sinew::inline v1
