/// What questions to arms and to platforms on arms say of tendons, loads, models and where a search begins.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/document/quantity.hpp"
#include "io/robots/read_pose.hpp"
#include "leg/space.hpp"
#include "query/arms/arms.hpp"
#include "query/tip.hpp"
#include "robot/arms/arm_model.hpp"
#include "robot/arms/arm_weight.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {

AnyPose pose_of(bool is_planar, const SE3<double>& pose) {
  if (!is_planar) return spatial_pose(pose);
  return PlanarPose{pose.p[0], pose.p[1], 2 * std::atan2(pose.R.v[2], pose.R.w)};
}
SE3<double> read_pose_of(bool is_planar, Reader pose) {
  return SE3<double>::from(is_planar ? in_space(read_planar_pose(std::move(pose)))
                                     : read_spatial_pose(std::move(pose)));
}
std::array<double, 3> read_position_of(bool is_planar, const Reader& position) {
  if (!is_planar) return position.array<3>(Dimension::length, Range::place());
  const auto [x, y] = position.array<2>(Dimension::length, Range::place());
  return {x, y, 0};
}
std::array<double, 6> read_wrench_of(bool is_planar, const Reader& list) {
  std::array<double, 6> wrench{};
  const auto take = [&](const auto& numbers) {
    for (int i = 0; const std::size_t k : freedoms_of(is_planar)) wrench[k] = numbers[i++];
  };
  if (is_planar)
    take(read_wrench<Planar>(list));
  else
    take(read_wrench<Spatial>(list));
  return wrench;
}

std::vector<std::size_t> tendon_counts(const ArmLegs& robot) {
  std::vector<std::size_t> counts;
  for (const ArmLeg& leg : robot.legs) {
    const auto own = tendon_counts(leg.arm);
    counts.insert(counts.end(), own.begin(), own.end());
  }
  return counts;
}

namespace {

/// Per section what is given of its tendons; null where nothing is.
std::vector<std::optional<double>> read_of_tendons(const std::vector<std::size_t>& counts, const Reader& list,
                                                   Dimension dimension, const Range& range) {
  std::vector<std::optional<double>> values;
  const auto items = list.items();
  if (items.size() > counts.size())
    list.fail("wrong_length",
              fmt::format("the robot has {} sections, found {} entries", counts.size(), items.size()));
  for (std::size_t m = 0; m < counts.size(); ++m) {
    if (m >= items.size() || items[m].is(Node::Kind::null)) {
      values.resize(values.size() + counts[m]);
      continue;
    }
    const auto tendons = items[m].items(counts[m]);
    for (std::size_t i = 0; i < counts[m]; ++i)
      values.push_back(i < tendons.size() && !tendons[i].is(Node::Kind::null)
                           ? std::optional(tendons[i].quantity(dimension, range))
                           : std::nullopt);
  }
  return values;
}

}  // namespace

std::vector<TendonCommand> read_arm_commands(const std::vector<std::size_t>& counts, Reader& place) {
  const auto tensions = place.optional("tensions"), changes = place.optional("changes");
  std::vector<TendonCommand> commands(std::accumulate(counts.begin(), counts.end(), std::size_t{0}),
                                      {changes && !tensions ? TendonHeld::change : TendonHeld::tension, 0});
  if (tensions) {
    const auto values = read_of_tendons(counts, *tensions, Dimension::force, range_of(TendonHeld::tension));
    for (std::size_t i = 0; i < commands.size(); ++i)
      if (values[i]) commands[i] = {TendonHeld::tension, *values[i]};
    if (changes) {
      const auto others = read_of_tendons(counts, *changes, Dimension::length, range_of(TendonHeld::change));
      for (std::size_t i = 0; i < commands.size(); ++i) {
        if (!others[i]) continue;
        if (values[i])
          changes->fail("ambiguous",
                        fmt::format("tendon {} has a tension and a change; put null in place of one", i));
        commands[i] = {TendonHeld::change, *others[i]};
      }
    }
  } else if (changes) {
    const auto values = read_of_tendons(counts, *changes, Dimension::length, range_of(TendonHeld::change));
    for (std::size_t i = 0; i < commands.size(); ++i) commands[i].value = values[i].value_or(0);
  }
  return commands;
}

std::vector<double> read_arm_motions(const Arm& arm, const Reader& list) {
  std::vector<double> rates;
  for (const auto& value :
       read_of_tendons(tendon_counts(arm), list, Dimension::number, {.low = -1e9, .high = 1e9}))
    rates.push_back(value.value_or(0));
  return rates;
}

namespace {

std::array<double, 3> read_along(const Reader& along) {
  return along.array<3>(Dimension::number, Range{.low = -1e9, .high = 1e9});
}

/// Where a load acts on a backbone of this length [m].
double read_place_along(Reader& load, double length) {
  return load.required("place", "of the load, from the base along the backbone")
      .quantity(Dimension::length, {.low = 0, .high = length * (1 + 1e-12), .low_excluded = true});
}

/// @param z of a force of a robot in the plane
void check_plane(const Reader& list, double z) {
  if (z != 0)
    list.fail("no_effect",
              "its third number has no effect: it acts out of the plane in which alone the robot moves; "
              "write 0");
}

/// In the plane an axis along a backbone is y to its reader, as in the papers, and z to the rod: of the rod's
/// third axis, square to the plane, whether it is that of the base or points the other way.
double side_of_plane(const ArmLeg& leg) { return leg.base.rotate(Vec3<double>(0, 1, 0)).z() > 0 ? 1 : -1; }

PointLoad read_point_load(const Arm& arm, Reader& load) {
  PointLoad point;
  point.place = read_place_along(load, arm.length());
  point.wrench = read_wrench_of(false, load.required("wrench", "force and moment there"));
  if (const auto following = load.optional("following")) point.following = following->boolean();
  if (const auto leg = load.optional("leg"))
    leg->fail("no_effect", "is of platforms on legs of sections; an arm has one backbone: leave it out");
  load.close();
  return point;
}

ArmLegsPointLoad read_point_load(const ArmLegs& robot, Reader& load) {
  ArmLegsPointLoad point;
  const int last = static_cast<int>(robot.legs.size()) - 1,
            leg = load.required("leg", "on which the load acts, from 0").integer(Range::between(0, last));
  point.leg = static_cast<std::size_t>(std::clamp(leg, 0, last));
  point.place = read_place_along(load, robot.legs[point.leg].arm.length());
  point.wrench = read_wrench_of(robot.is_planar, load.required("wrench", "force and moment there"));
  if (const auto following = load.optional("following")) point.following = following->boolean();
  if (robot.is_planar && point.following) {
    const auto [x, y, z, mx, my, m] = point.wrench;
    point.wrench = {x, 0, y, 0, m * side_of_plane(robot.legs[point.leg]), 0};
  }
  load.close();
  return point;
}

constexpr std::string_view no_weight(const Arm&) {
  return "has no effect: nothing of this robot has a mass; give its backbones a density, its discs or its "
         "tip a mass";
}
constexpr std::string_view no_weight(const ArmLegs&) {
  return "has no effect: nothing of this robot has a mass; give its backbones a density, its discs or its "
         "platform a mass";
}

}  // namespace

template <class Arms>
typename ArmTypes<Arms>::Load read_arm_load(const Arms& robot, Reader& place,
                                            typename ArmTypes<Arms>::Load load) {
  const bool planar = is_planar(robot);
  if (const auto wrench = place.optional("wrench")) load.wrench = read_wrench_of(planar, *wrench);
  if (const auto following = place.optional("following")) load.following = read_wrench_of(planar, *following);
  if (const auto along = place.optional("distributed")) {
    load.along = read_along(*along);
    if (planar) check_plane(*along, load.along[2]);
  }
  if (const auto along = place.optional("distributed_following")) {
    load.following_along = read_along(*along);
    if (planar) check_plane(*along, load.following_along[2]);
    if (planar) load.following_along = {load.following_along[0], 0, load.following_along[1]};
  }
  if (const auto points = place.optional("loads")) {
    load.points.clear();
    for (Reader& point : points->items()) load.points.push_back(read_point_load(robot, point));
  }
  if (const auto gravity = place.optional("gravity")) {
    if (!has_weight(robot)) gravity->fail("no_effect", no_weight(robot));
    load.gravity = read_gravity_of(*gravity, planar);
  }
  return load;
}
template ArmLoad read_arm_load(const Arm&, Reader&, ArmLoad);
template ArmLegsLoad read_arm_load(const ArmLegs&, Reader&, ArmLegsLoad);

ArmOptions read_arm_options(Question& context, int usual_iterations) {
  ArmOptions options;
  Reader& query = context.query;
  if (const auto model = query.optional("model"))
    options.model = model->choice_of<ArmModel>({{"rod", ArmModel::rod},
                                                {"subsegment_rod", ArmModel::subsegment_rod},
                                                {"subsegment_cc", ArmModel::subsegment_cc},
                                                {"cc", ArmModel::cc},
                                                {"prb", ArmModel::prb}});
  if (const auto balance = query.optional("balance"))
    options.balance = balance->choice_of<ArmBalance>({{"energy", ArmBalance::energy},
                                                      {"projected", ArmBalance::projected},
                                                      {"collocated", ArmBalance::collocated},
                                                      {"closed_form", ArmBalance::closed_form}});
  const auto order = query.optional("order");
  if (order) options.order = order->integer(Range::between(0, 9));
  if (const auto elements = query.optional("elements")) {
    const bool joints = options.model == ArmModel::prb;
    options.elements = elements->integer(Range::between(1, joints ? 10 : 200));
    const std::string words = basis_misfit(options.model, options.order, options.elements);
    if (!words.empty()) order->fail("out_of_range", words);
  }
  if (const auto accuracy = query.optional("accuracy"))
    options.accuracy = accuracy->number({.low = 0, .high = 1, .low_excluded = true});
  options.max_iterations = context.max_iterations.value_or(usual_iterations);
  return options;
}

void read_arm_start(Question& context, ArmOptions& options) {
  options.from_last = context.continues == Continues::always && context.last != nullptr;
  const auto start = context.query.optional("start");
  if (!start) return;
  if (start->is(Node::Kind::list))
    return start->fail("wrong_type",
                       "a shape to begin at is of forward, velocity and shape; here it is last");
  start->choice({"last"});
  options.from_last = true;
}

std::vector<std::array<double, 3>> read_curvatures(const Reader& list, std::string_view whose) {
  constexpr std::size_t most_parts = 1000;
  const auto parts = list.items();
  if (parts.empty() || parts.size() > most_parts)
    list.fail("wrong_length",
              fmt::format("a shape has the mean curvatures of 1 to {} equal parts of the {}, found {}",
                          most_parts, whose, parts.size()));
  std::vector<std::array<double, 3>> curvatures;
  for (std::size_t k = 0; k < std::min(parts.size(), most_parts); ++k)
    curvatures.push_back(parts[k].array<3>(Dimension::curvature, {.low = -1e6, .high = 1e6}));
  return curvatures;
}

namespace {

/// In the plane: a pose, or a position.
ArmTarget read_planar_target(Question& context) {
  Reader& query = context.query;
  ArmTarget target;
  if (const auto direction = query.optional("direction"))
    direction->fail("not_available", "is of robots in space; in the plane give pose: {x, y, phi}");
  const auto position = query.optional("position");
  auto pose = query.optional("pose");
  if (position && pose) position->fail("ambiguous", "the query gives a pose and a position; keep one");
  if (position) {
    target.position = read_position_of(true, *position);
  } else if (pose) {
    const SE3<double> at = read_pose_of(true, std::move(*pose));
    target.position = {at.p[0], at.p[1], 0};
    target.quaternion = {at.R.w, 0, 0, at.R.v[2]};
  } else {
    query.required("pose", "{x, y, phi}; or position: [x, y]");
  }
  return target;
}

}  // namespace

ArmTarget read_arm_target(Question& context, bool is_planar) {
  if (is_planar) return read_planar_target(context);
  const AskedTip tip = read_tip(context, true);
  ArmTarget target{.position = tip.position, .direction = tip.direction};
  if (!tip.pose) return target;
  target.position = {tip.pose->position[0], tip.pose->position[1], tip.pose->position[2]};
  target.quaternion = tip.pose->quaternion;
  return target;
}

}  // namespace sinew::inline v1
