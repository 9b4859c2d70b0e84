/// Handlers of queries to platforms on arms: forward, inverse, velocity, shape, statics, track, describe.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "io/quantity.hpp"
#include "io/read_pose.hpp"
#include "io/reader.hpp"
#include "leg/space.hpp"
#include "math/plane_axes.hpp"
#include "query/arms/arms.hpp"
#include "query/batch/sampler.hpp"
#include "robot/pose.hpp"
#include "sinew/base/export.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {
namespace {

/// Tendons that end at each section, sections of leg 0 first.
std::vector<std::size_t> tendon_counts_of(const ArmLegs& robot) {
  std::vector<std::size_t> counts;
  for (const ArmLeg& leg : robot.legs) {
    const auto own = tendons_by_section(leg.arm);
    counts.insert(counts.end(), own.begin(), own.end());
  }
  return counts;
}

constexpr Lack lacking[] = {
    {"balance", "is not available of legs of sections in this version; leave it out"}};

/// Numbers of a robot in space, or of one in the plane those that it has.
/// @{
AnyPose pose_of(const ArmLegs& robot, const SE3<double>& pose) {
  if (!robot.is_planar) return spatial_pose(pose);
  return PlanarPose{pose.p[0], pose.p[1], 2 * std::atan2(pose.R.v[2], pose.R.w)};
}
std::span<const std::size_t> freedoms_of(const ArmLegs& robot) {
  static constexpr std::array<std::size_t, 6> all{0, 1, 2, 3, 4, 5};
  return robot.is_planar ? std::span<const std::size_t>(plane_axes) : std::span<const std::size_t>(all);
}
Value wrench_value(const ArmLegs& robot, const std::array<double, 6>& wrench) {
  std::vector<double> numbers;
  for (const std::size_t k : freedoms_of(robot)) numbers.push_back(wrench[k]);
  return numbers;
}
Value point_value(const ArmLegs& robot, const Vec3<double>& point) {
  return robot.is_planar ? Value(Vec2<double>(point.head<2>())) : Value(point);
}
/// @param by_rows, by_columns whether rows, or columns, are six of the platform's freedoms or wrench
Value matrix_value(const ArmLegs& robot, const double* numbers, std::size_t rows, std::size_t columns,
                   bool by_rows, bool by_columns) {
  std::vector<std::size_t> of_rows(rows), of_columns(columns);
  std::iota(of_rows.begin(), of_rows.end(), std::size_t{0});
  std::iota(of_columns.begin(), of_columns.end(), std::size_t{0});
  const auto freedoms = freedoms_of(robot);
  if (by_rows) of_rows.assign(freedoms.begin(), freedoms.end());
  if (by_columns) of_columns.assign(freedoms.begin(), freedoms.end());
  std::vector<double> kept;
  for (const std::size_t i : of_rows)
    for (const std::size_t j : of_columns) kept.push_back(numbers[i * columns + j]);
  return Value(MatrixView(kept.data(), static_cast<Eigen::Index>(of_rows.size()),
                          static_cast<Eigen::Index>(of_columns.size())));
}
/// @}

std::array<double, 6> read_wrench_of(const ArmLegs& robot, const Reader& list) {
  std::array<double, 6> wrench{};
  const auto take = [&](const auto& numbers) {
    for (int i = 0; const std::size_t k : freedoms_of(robot)) wrench[k] = numbers[i++];
  };
  if (robot.is_planar)
    take(read_wrench<Planar>(list));
  else
    take(read_wrench<Spatial>(list));
  return wrench;
}
SE3<double> read_pose_of(const ArmLegs& robot, Reader pose) {
  return SE3<double>::from(robot.is_planar ? in_space(read_planar_pose(std::move(pose)))
                                           : read_spatial_pose(std::move(pose)));
}
std::array<double, 3> read_position_of(const ArmLegs& robot, const Reader& position) {
  if (!robot.is_planar) return position.array<3>(Dimension::length, Range::place());
  const auto [x, y] = position.array<2>(Dimension::length, Range::place());
  return {x, y, 0};
}

void put_legs_shape(Context& context, const ArmLegs& robot, const SE3<double>& platform, int samples) {
  ArmPicture picture;
  picture.is_planar = robot.is_planar;
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    double around = 0;  // where a disc's size is not known: its tendons run within it
    for (const ArmTendon& tendon : robot.legs[k].arm.tendons)
      for (const TendonRoute& route : tendon.routes)
        around = std::max({around, 1.15 * route.start_radius, 1.15 * route.end_radius});
    picture.add(robot.legs[k].arm, arm_legs_shape(*context.work.arm_legs, k), samples, around);
  }
  const int dimension = robot.is_planar ? 2 : 3;
  std::vector<double> base, plate;
  for (const ArmLeg& leg : robot.legs) {
    const Vec3<double> corner = platform.p + platform.rotate(leg.platform_point);
    base.insert(base.end(), leg.base.p.begin(), leg.base.p.begin() + dimension);
    plate.insert(plate.end(), corner.begin(), corner.begin() + dimension);
  }
  Value& answer = context.answer;
  answer["base"] = Value(base, static_cast<std::size_t>(dimension));
  answer["platform"] = Value(plate, static_cast<std::size_t>(dimension));
  answer["backbones"] = std::move(picture.backbones);
  answer["curvatures"] = std::move(picture.curvatures);
  answer["tendons"] = std::move(picture.tendons);
  if (!robot.is_planar) answer["discs"] = std::move(picture.discs);
  answer["frames"] = Value::list({pose_value(pose_of(robot, platform))});
}

/// Numbers of an equilibrium, of the answer or of a row of it.
void put_legs_numbers(Value& answer, const ArmLegs& robot, const ArmLegsState& state) {
  const auto counts = tendon_counts_of(robot);
  answer["pose"] = pose_value(pose_of(robot, state.platform));
  answer["tensions"] = by_end_section(counts, state.tensions);
  answer["changes"] = by_end_section(counts, state.changes);
  answer["slack"] = by_end_section(counts, state.slack);
  put_number(answer, "potential", state.energy);
}

/// @param report of the question; its message comes first
void put_legs_state(Context& context, const ArmLegs& robot, const ArmLegsState& state, const Report& report) {
  context.report(report);
  if (std::ranges::any_of(robot.legs, [](const ArmLeg& leg) { return has_friction(leg.arm); }))
    context.add_message("tendons are taken as if they did not rub");
  if (state.report.status == Status::bad_input || state.report.status == Status::unsupported) return;
  if (state.tensions.empty()) return;  // refused before
  Value& answer = context.answer;
  put_legs_numbers(answer, robot, state);
  Value legs = Value::list();
  for (const auto& load : state.tip_loads)
    if (robot.is_planar)
      legs.push_back({{"force", {load[0], load[1]}}, {"moment", {0.0, 0.0, load[5]}}});
    else
      legs.push_back({{"force", {load[0], load[1], load[2]}}, {"moment", {load[3], load[4], load[5]}}});
  answer["legs"] = std::move(legs);
  answer["stable"] = state.stable;
  answer["reached"] = state.reached;
  put_number(answer, "residual", report.residual);
  answer["iterations"] = report.iterations;
  if (state.resolution > 0) answer["resolution"] = state.resolution;
}

ArmOptions read_legs_options(Context& context) {
  ArmOptions options = read_arm_options(context);
  if (!context.max_iterations) options.max_iterations = 2000;  // of all steps in which inputs and loads grow
  return options;
}

/// @param z of a force of a robot in the plane
void check_plane(const ArmLegs& robot, const Reader& list, double z) {
  if (robot.is_planar && z != 0)
    list.fail("no_effect",
              "its third number has no effect: it acts out of the plane in which alone the robot moves; "
              "write 0");
}

/// In the plane an axis along a backbone is y to its reader, as in the papers, and z to the rod: of the rod's
/// third axis, square to the plane, whether it is that of the base or points the other way.
double side_of_plane(const ArmLeg& leg) { return leg.base.rotate(Vec3<double>(0, 1, 0)).z() > 0 ? 1 : -1; }

ArmLegsPointLoad read_legs_point(const ArmLegs& robot, Reader& load) {
  ArmLegsPointLoad point;
  const int last = static_cast<int>(robot.legs.size()) - 1,
            leg = load.required("leg", "on which the load acts, from 0").integer(Range::between(0, last));
  point.leg = static_cast<std::size_t>(std::clamp(leg, 0, last));
  point.place = read_place_along(load, robot.legs[point.leg].arm.length());
  point.wrench = read_wrench_of(robot, load.required("wrench", "force and moment there"));
  if (const auto following = load.optional("following")) point.following = following->boolean();
  if (robot.is_planar && point.following) {
    const auto [x, y, z, mx, my, m] = point.wrench;
    point.wrench = {x, 0, y, 0, m * side_of_plane(robot.legs[point.leg]), 0};
  }
  load.close();
  return point;
}

/// @param load what holds where they are not given
ArmLegsLoad read_legs_load(const ArmLegs& robot, Reader& place, ArmLegsLoad load = {}) {
  if (const auto wrench = place.optional("wrench")) load.wrench = read_wrench_of(robot, *wrench);
  if (const auto gravity = place.optional("gravity"))
    load.gravity = read_gravity_of(*gravity, robot.is_planar);
  if (const auto along = place.optional("distributed")) {
    load.along = read_along(*along);
    check_plane(robot, *along, load.along[2]);
  }
  if (const auto following = place.optional("following")) load.following = read_wrench_of(robot, *following);
  if (const auto along = place.optional("distributed_following")) {
    load.following_along = read_along(*along);
    check_plane(robot, *along, load.following_along[2]);
    if (robot.is_planar) load.following_along = {load.following_along[0], 0, load.following_along[1]};
  }
  if (const auto points = place.optional("loads")) {
    load.points.clear();
    for (Reader& point : points->items()) load.points.push_back(read_legs_point(robot, point));
  }
  return load;
}

struct LegsWanted {
  Wants words;
  int samples = 0;
};
LegsWanted read_legs_wants(Context& context) {
  LegsWanted wanted{read_wants(context)};
  wanted.samples = read_samples(context, wanted.words, 60, 2000);
  return wanted;
}

/// The workspace, once the question is read.
ArmLegsWorkspace& legs_work(Context& context) {
  ArmLegsWorkspace& work = *context.work.arm_legs;
  work.stop = context.work.stop;
  return work;
}

/// Of the equilibrium in the workspace.
void put_legs_wants(Context& context, const ArmLegs& robot, const ArmLegsState& state,
                    const LegsWanted& wanted) {
  if (!state.report.is_solved()) return;
  if (wanted.words.has(Want::shape)) put_legs_shape(context, robot, state.platform, wanted.samples);
  const bool velocity = wanted.words.has(Want::velocity), stiffness = wanted.words.has(Want::stiffness);
  if (!velocity && !stiffness) return;
  const ArmLegsRates rates = arm_legs_rates(robot, *context.work.arm_legs);
  if (!rates.regular) {
    context.add_message("the equilibrium is a fold: it has no rates");
    return;
  }
  const std::size_t count = robot.tendons();
  Value& answer = context.answer;
  if (velocity) {
    answer["U"] = matrix_value(robot, rates.J.data(), 6, count, true, false);
    answer["answer_rates"] = matrix_value(robot, rates.answers.data(), count, count, false, false);
  }
  if (!stiffness) return;
  if (rates.has_stiffness)
    answer["stiffness"] = matrix_value(robot, rates.stiffness.data(), 6, 6, true, true);
  else
    context.add_message("the stiffness is not finite: a leg that does not stretch is straight");
  answer["compliance"] = matrix_value(robot, rates.compliance.data(), 6, 6, true, true);
  answer["answers_by_wrench"] = matrix_value(robot, rates.answers_by_wrench.data(), count, 6, false, true);
}

/// A load that grows, as `until` asks.
struct LegsUntil {
  std::array<double, 6> direction{};
  double limit = 0;
};
std::optional<LegsUntil> read_legs_until(Context& context, const ArmLegs& robot) {
  const auto take = [&](const auto& until) -> std::optional<LegsUntil> {
    if (!until) return {};
    LegsUntil asked{.limit = until->limit};
    for (int i = 0; const std::size_t k : freedoms_of(robot)) asked.direction[k] = until->direction[i++];
    return asked;
  };
  return robot.is_planar ? take(read_until<Planar>(context)) : take(read_until<Spatial>(context));
}

struct LegsForward {
  ArmOptions options;
  std::vector<TendonCommand> commands;
  ArmLegsLoad load;
  std::optional<LegsUntil> until;
  std::optional<ArmLegsStart> start;  ///< a shape
  bool wants_all = false;
  LegsWanted wanted;
};

/// `start`: `last`, or a solution's pose and curvatures.
std::optional<ArmLegsStart> read_legs_start(Context& context, ArmOptions& options) {
  constexpr std::size_t most_parts = 1000;
  const ArmLegs& robot = *context.robot.arm_legs();
  const Node* given = context.query.node()->find("start");
  if (!given || given->kind != Node::Kind::map) {
    read_arm_start(context, options);
    return {};
  }
  options.from_last = false;
  Reader start = context.query.required("start");
  ArmLegsStart shape{read_pose_of(robot, start.required("pose", "where the platform is")), {}};
  const Reader curvatures =
      start.required("curvatures", "of each leg the mean curvatures of equal parts, as `all` tells them");
  for (const Reader& leg : curvatures.items(robot.legs.size())) {
    const auto parts = leg.items();
    if (parts.empty() || parts.size() > most_parts)
      leg.fail("wrong_length",
               fmt::format("a shape has the mean curvatures of 1 to {} equal parts of the leg, found {}",
                           most_parts, parts.size()));
    auto& of_leg = shape.curvatures.emplace_back();
    for (std::size_t k = 0; k < std::min(parts.size(), most_parts); ++k)
      of_leg.push_back(parts[k].array<3>(Dimension::curvature, {.low = -1e6, .high = 1e6}));
  }
  start.close();
  return shape;
}

LegsForward read_legs(Context& context) {
  const ArmLegs& robot = *context.robot.arm_legs();
  LegsForward asked;
  asked.options = read_legs_options(context);
  asked.commands = read_arm_commands(tendon_counts_of(robot), context.query);
  asked.load = read_legs_load(robot, context.query);
  asked.start = read_legs_start(context, asked.options);
  if (context.ask == Ask::forward) {
    asked.until = read_legs_until(context, robot);
    if (const auto all = context.query.optional("all")) {
      asked.wants_all = all->boolean();
      if (asked.wants_all && asked.until)
        all->fail("ambiguous", "until follows one equilibrium, all finds many; keep one");
    }
  }
  asked.wanted = read_legs_wants(context);
  return asked;
}

void put_legs_solutions(Context& context, const ArmLegs& robot, const LegsForward& asked) {
  constexpr int starts = 30;
  Value solutions = Value::list();
  const std::vector<ArmLegsEquilibrium> found =
      arm_legs_equilibria(robot, asked.commands, asked.load, asked.options, starts, *context.work.arm_legs);
  for (const ArmLegsEquilibrium& one : found) {
    if (one.start.curvatures.empty()) continue;  // there is none
    Value solution = Value::map();
    put_legs_numbers(solution, robot, one.state);
    solution["stable"] = one.state.stable;
    solution["residual"] = one.state.report.residual;
    Value legs = Value::list();
    for (const auto& leg : one.start.curvatures) {
      std::vector<double> numbers;
      for (const auto& part : leg) numbers.insert(numbers.end(), part.begin(), part.end());
      legs.push_back(Value(numbers, 3));
    }
    solution["curvatures"] = std::move(legs);
    solutions.push_back(std::move(solution));
  }
  put_solutions(context, context.work.stop, std::move(solutions));
}

void answer_legs(Context& context, const LegsForward& asked) {
  const auto& [options, commands, load, until, start, wants_all, wanted] = asked;
  const ArmLegs& robot = *context.robot.arm_legs();
  ArmLegsWorkspace& work = legs_work(context);
  const ArmLegsState& state = start ? arm_legs_forward_from(robot, *start, commands, load, options, work)
                                    : arm_legs_forward(robot, commands, load, options, work);
  if (until && state.report.ok()) {
    const ArmLegsLoadPath path = arm_legs_follow_load(robot, until->direction, until->limit, work);
    put_legs_state(context, robot, path.state, path.state.report);
    put_growth(context.answer, path);
    if (path.end == LoadEnd::stopped) context.answer["status"] = to_string(Status::stopped);
  } else {
    put_legs_state(context, robot, state, state.report);
  }
  if (state.report.status == Status::stalled && context.ask == Ask::forward && !wants_all && !until)
    context.add_message("all: true looks from other poses, too");
  put_legs_wants(context, robot, state, wanted);
  if (wants_all && state.report.status != Status::bad_input && state.report.status != Status::unsupported)
    put_legs_solutions(context, robot, asked);
}

/// The points of a path; what a point does not say is as at the point before, of loads as in the question.
std::vector<ArmLegsStep> read_legs_points(Context& context, const ArmLegs& robot) {
  Reader& query = context.query;
  const ArmLegsLoad load = read_legs_load(robot, query);
  std::vector<ArmLegsStep> path;
  const auto list = query.required("points", "the path: [{tensions, changes or pose, wrench, ...}, ...]");
  for (Reader& point : list.items()) {
    if (!point.is(Node::Kind::map)) {
      point.refuse("wrong_type", "give a map: {tensions: [[1, 0, 0]]}.");
      continue;
    }
    ArmLegsStep step = path.empty() ? ArmLegsStep{} : path.back();
    const bool has_inputs = point.has("tensions") || point.has("changes");
    if (has_inputs) {
      step.commands = read_arm_commands(tendon_counts_of(robot), point);
      step.pose.reset();
    }
    if (auto pose = point.optional("pose")) {
      if (has_inputs) pose->fail("ambiguous", "the point gives a pose and what holds tendons; keep one");
      step.pose = read_pose_of(robot, std::move(*pose));
    } else if (!has_inputs && path.empty()) {
      point.required("tensions", "of the first point; or changes, or a pose");
    }
    step.load = read_legs_load(robot, point, load);
    point.close();
    path.push_back(std::move(step));
  }
  const int steps = read_path_steps(query, list, path.size());
  for (ArmLegsStep& step : path) step.divisions = steps;
  return path;
}

struct LegsInverse {
  ArmInverseOptions options;
  ArmTarget target;
  ArmLegsLoad load;
  LegsWanted wanted;
};

/// In the plane: a pose, or a position.
ArmTarget read_planar_target(Context& context, const ArmLegs& robot) {
  Reader& query = context.query;
  ArmTarget target;
  if (const auto direction = query.optional("direction"))
    direction->fail("not_available", "is of robots in space; in the plane give pose: {x, y, phi}");
  const auto position = query.optional("position");
  auto pose = query.optional("pose");
  if (position && pose) position->fail("ambiguous", "the query gives a pose and a position; keep one");
  if (position) {
    target.position = read_position_of(robot, *position);
  } else if (pose) {
    const SE3<double> at = read_pose_of(robot, std::move(*pose));
    target.position = {at.p[0], at.p[1], 0};
    target.quaternion = {at.R.w, 0, 0, at.R.v[2]};
  } else {
    query.required("pose", "{x, y, phi}; or position: [x, y]");
  }
  return target;
}

LegsInverse read_legs_inverse(Context& context) {
  const ArmLegs& robot = *context.robot.arm_legs();
  LegsInverse asked;
  asked.options.arm = read_legs_options(context);
  asked.target = robot.is_planar ? read_planar_target(context, robot) : read_arm_target(context);
  asked.load = read_legs_load(robot, context.query);
  read_arm_start(context, asked.options.arm);
  if (const auto limit = context.query.optional("tension_limit"))
    asked.options.most_tension = limit->quantity(Dimension::force, Range::positive());
  asked.wanted = read_legs_wants(context);
  return asked;
}

void answer_legs_inverse(Context& context, const LegsInverse& asked) {
  const ArmLegs& robot = *context.robot.arm_legs();
  const ArmLegsInverse found =
      arm_legs_inverse(robot, asked.target, asked.load, asked.options, legs_work(context));
  put_legs_state(context, robot, found.state, found.report);
  put_legs_wants(context, robot, found.state, asked.wanted);
}

struct LegsStatics {
  ArmOptions options;
  ArmLegsMeasurement measured;
  std::optional<SE3<double>> held;  ///< where the platform is held; else what was measured counts
  ArmLegsLoad load;
  bool force_alone = true;
  LegsWanted wanted;
};

LegsStatics read_legs_statics(Context& context) {
  const ArmLegs& robot = *context.robot.arm_legs();
  LegsStatics asked;
  asked.options = read_legs_options(context);
  Reader& query = context.query;
  ArmLegsMeasurement& measured = asked.measured;
  measured.held = read_arm_commands(tendon_counts_of(robot), query);
  asked.load = read_legs_load(robot, query);
  read_arm_start(context, asked.options);
  const auto tensions = query.optional("measured_tensions"), position = query.optional("position"),
             deviation = query.optional("deviation"), force = query.optional("force_alone");
  auto pose = query.optional("pose");
  if (!tensions && !position && !pose)
    query.required("measured_tensions",
                   "of every tendon; or position, where the platform was seen; or pose, where it is held");
  if (tensions) {
    measured.answers = read_forces(*tensions, robot.tendons(), Range{.low = 0, .high = 1e9}, false);
    for (std::size_t i = 0; i < measured.held.size() && context.errors.empty(); ++i)
      if (measured.held[i].held == TendonHeld::tension)
        measured.answers[i] = std::nan("");  // held: it tells nothing
  }
  if (position) measured.position = read_position_of(robot, *position);
  std::optional<SE3<double>> seen;
  if (pose) {
    if (position) pose->fail("ambiguous", "the query gives a pose and a position; keep one");
    seen = read_pose_of(robot, std::move(*pose));
    measured.position = std::array<double, 3>{seen->p[0], seen->p[1], seen->p[2]};
    measured.quaternion = std::array<double, 4>{seen->R.w, seen->R.v[0], seen->R.v[1], seen->R.v[2]};
  }
  if (seen && !tensions) {
    asked.held = seen;
    for (const auto* given : {&deviation, &force})
      if (*given)
        (*given)->fail("no_effect",
                       "has no effect: the platform is held at pose, and nothing is measured; remove it");
  }
  if (deviation) measured.tension_deviation = deviation->quantity(Dimension::force, Range::positive());
  asked.force_alone = !force || force->boolean();
  asked.wanted = read_legs_wants(context);
  return asked;
}

void answer_legs_statics(Context& context, const LegsStatics& asked) {
  const auto& [options, measured, held_at, load, force_alone, wanted] = asked;
  const ArmLegs& robot = *context.robot.arm_legs();
  ArmLegsWorkspace& work = legs_work(context);
  if (held_at) {
    const ArmLegsHeld held = arm_legs_hold(robot, *held_at, measured.held, load, options, work);
    put_legs_state(context, robot, held.state, held.state.report);
    if (!held.state.report.ok()) return;
    context.answer["wrench"] = wrench_value(robot, held.wrench);
    put_legs_wants(context, robot, held.state, wanted);
    return;
  }
  const ArmLegsSensed sensed = arm_legs_sense(robot, measured, load, force_alone, options, work);
  put_legs_state(context, robot, sensed.state, sensed.report);
  if (sensed.report.status == Status::bad_input || sensed.state.tensions.empty()) return;
  context.answer["wrench"] = wrench_value(robot, sensed.wrench);
  if (sensed.report.ok()) {
    context.answer["covariance"] = matrix_value(robot, sensed.covariance.data(), 6, 6, true, true);
    put_number(context.answer, "condition", sensed.condition);
  }
  put_number(context.answer, "misfit", sensed.misfit);
  put_legs_wants(context, robot, sensed.state, wanted);
}

struct LegsTrack {
  ArmInverseOptions options;
  std::vector<ArmLegsStep> path;
  LegsWanted wanted;
};

LegsTrack read_legs_track(Context& context) {
  for (const char* field : {"poses", "from", "to", "objective"})
    if (const auto given = context.query.optional(field))
      given->fail("not_available",
                  "legs of sections are followed along points: [{pose: ...}, ...], or tensions, changes and "
                  "loads");
  if (const auto given = context.query.optional("motions"))
    given->fail("not_available", "tendons of legs of sections do not rub; ask velocity for their rates");
  LegsTrack asked;
  asked.options.arm = read_legs_options(context);
  asked.path = read_legs_points(context, *context.robot.arm_legs());
  read_arm_start(context, asked.options.arm);
  asked.wanted = read_legs_wants(context);
  return asked;
}

void answer_legs_track(Context& context, const LegsTrack& asked) {
  const auto& [options, path, wanted] = asked;
  const ArmLegs& robot = *context.robot.arm_legs();
  const auto points = arm_legs_track(robot, path, options, legs_work(context));
  const ArmLegsState& last = points.back();
  const auto steps = static_cast<std::size_t>(path.front().divisions);
  const bool arrives = last.report.ok();
  const std::size_t reached = arrives ? points.size() : points.size() - 1;
  Value rows = Value::list();
  double worst = 0;
  int iterations = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    iterations += points[k].report.iterations;
    if (k >= reached) break;
    worst = std::max(worst, points[k].report.residual);
    Value row{{"point", k / steps},
              {"part", static_cast<double>(k % steps + 1) / static_cast<double>(steps)}};
    put_legs_numbers(row, robot, points[k]);
    rows.push_back(std::move(row));
  }
  Report report = last.report;
  report.residual = arrives ? worst : last.report.residual;
  report.iterations = iterations;
  if (!arrives && !last.tensions.empty())
    report.message =
        FixedText<240>(fmt::format("the path ends on its way to points[{}], in step {} of {}: {}",
                                   reached / steps, reached % steps + 1, steps, last.report.message.view()));
  put_legs_state(context, robot, last, report);
  if (last.tensions.empty()) return;  // refused: no step was tried
  if (!arrives) context.answer["reached"] = {{"rows", reached}, {"point", reached / steps}};
  if (arrives) put_legs_wants(context, robot, last, wanted);
  context.answer["rows"] = std::move(rows);
}

/// As a file has it.
Value base_value(const ArmLegs& robot, const ArmLeg& leg) {
  const Vec3<double> ahead = leg.base.rotate(Vec3<double>(0, 0, 1));
  Value base{{"point", point_value(robot, leg.base.p)}};
  if (robot.is_planar) {
    if (!leg.turns_at_base) base["direction"] = std::atan2(ahead.y(), ahead.x());
    return base;
  }
  base["direction"] = Value(ahead);
  base["section_x"] = Value(leg.base.rotate(Vec3<double>(1, 0, 0)));
  return base;
}
Value closure_value(const ArmLegs& robot, const ArmLeg& leg) {
  if (leg.strut > 0) return {{"type", "strut"}, {"length", leg.strut}};
  const char* joint = !robot.is_planar ? "ball" : leg.turns_at_base ? "chord" : "pin";
  return {{"type", leg.is_clamped ? "clamp" : joint}};
}

void describe_arm_legs(Context& context) {
  const ArmLegs& robot = *context.robot.arm_legs();
  Value inputs = Value::list(), legs = Value::list();
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    const ArmLeg& leg = robot.legs[k];
    const std::string path = joined(joined("legs", k), "link");
    std::vector<std::size_t> counts(leg.arm.sections.size());
    for (const ArmTendon& tendon : leg.arm.tendons) {
      const auto section = static_cast<std::size_t>(tendon.section());
      inputs.push_back(
          {{"name", joined(joined(joined(joined(path, "sections"), section), "tendons"), counts[section]++)},
           {"unit", "m"}});
    }
    Value sections = Value::list(), tendons = Value::list();
    for (const ArmSection& section : leg.arm.sections) sections.push_back(section_value(section));
    for (const ArmTendon& tendon : leg.arm.tendons) tendons.push_back(tendon_value(tendon));
    legs.push_back(
        {{"base", base_value(robot, leg)},
         {"link",
          {{"type", "elastic"}, {"length", leg.arm.length()}, {"sections", sections}, {"tendons", tendons}}},
         {"closure", closure_value(robot, leg)},
         {"platform_point", point_value(robot, leg.platform_point)}});
  }
  Value& answer = context.answer;
  answer["status"] = "converged";
  answer["kind"] = "arm_legs";
  answer["space"] = robot.is_planar ? "planar" : "spatial";
  answer["inputs"] = std::move(inputs);
  answer["home"] = pose_value(pose_of(robot, SE3<double>::from(robot.home)));
  answer["platform"] = {{"mass", robot.platform_mass}};
  answer["gravity"] = robot.gravity;
  answer["legs"] = std::move(legs);
  answer["models"] = Value::list({"rod", "subsegment_rod", "subsegment_cc", "cc", "prb"});
  answer["model"] = "subsegment_rod";
  answer["geometry"] = robot.geometry_inferred ? "inferred" : "given";
  answer["versions"] = {{"sinew", version()}, {"protocol", 1}};
}

}  // namespace

constexpr Handlers arm_legs_handlers{.robots = "legs of sections",
                                     .wants = {Want::pose, Want::legs, Want::velocity, Want::shape,
                                               Want::stiffness, Want::stability},  // that is told always
                                     .answers = {.forward = handle<read_legs, answer_legs>,
                                                 .inverse = handle<read_legs_inverse, answer_legs_inverse>,
                                                 .velocity = handle<read_legs, answer_legs>,
                                                 .shape = handle<read_legs, answer_legs>,
                                                 .statics = handle<read_legs_statics, answer_legs_statics>,
                                                 .track = handle<read_legs_track, answer_legs_track>,
                                                 .describe = tell<describe_arm_legs>},
                                     .lacks = lacking};

}  // namespace sinew::inline v1
