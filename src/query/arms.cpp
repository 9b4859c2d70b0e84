/// Handlers of queries to arms that bear loads: forward, inverse, velocity, shape, statics.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/quantity.hpp"
#include "io/read_pose.hpp"
#include "io/reader.hpp"
#include "query/arms.hpp"
#include "query/handlers.hpp"
#include "query/loads.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

std::vector<std::size_t> tendons_by_section(const Arm& arm) {
  std::vector<std::size_t> counts(arm.sections.size());
  for (const ArmTendon& tendon : arm.tendons) ++counts[static_cast<std::size_t>(tendon.section())];
  return counts;
}

namespace {

constexpr Wants arm_wants{Want::pose,      Want::velocity,  Want::shape,
                          Want::stiffness, Want::stability, Want::margins};

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

std::vector<TendonCommand> read_arm_commands(const Arm& arm, Reader& place) {
  return read_arm_commands(tendons_by_section(arm), place);
}
std::vector<TendonCommand> read_arm_commands(const std::vector<std::size_t>& counts, Reader& place) {
  const auto tensions = place.optional("tensions"), changes = place.optional("changes");
  std::vector<TendonCommand> commands(std::accumulate(counts.begin(), counts.end(), std::size_t{0}),
                                      {changes && !tensions ? TendonHeld::change : TendonHeld::tension, 0});
  if (tensions) {
    const auto values = read_of_tendons(counts, *tensions, Dimension::force, {.low = 0, .high = 1e9});
    for (std::size_t i = 0; i < commands.size(); ++i)
      if (values[i]) commands[i] = {TendonHeld::tension, *values[i]};
    if (changes) {
      const auto others = read_of_tendons(counts, *changes, Dimension::length, Range::place());
      for (std::size_t i = 0; i < commands.size(); ++i) {
        if (!others[i]) continue;
        if (values[i])
          changes->fail("ambiguous",
                        fmt::format("tendon {} has a tension and a change; put null in place of one", i));
        commands[i] = {TendonHeld::change, *others[i]};
      }
    }
  } else if (changes) {
    const auto values = read_of_tendons(counts, *changes, Dimension::length, Range::place());
    for (std::size_t i = 0; i < commands.size(); ++i) commands[i].value = values[i].value_or(0);
  }
  return commands;
}

namespace {

std::array<double, 6> read_arm_wrench(const Reader& list) {
  std::array<double, 6> numbers{};
  const auto wrench = read_wrench<Spatial>(list);
  for (int i = 0; i < 6; ++i) numbers[static_cast<std::size_t>(i)] = wrench[i];
  return numbers;
}

PointLoad read_point_load(Reader& load, double length) {
  PointLoad point;
  point.place =
      load.required("place", "of the load, from the base along the backbone")
          .quantity(Dimension::length, {.low = 0, .high = length * (1 + 1e-12), .low_excluded = true});
  point.wrench = read_arm_wrench(load.required("wrench", "force and moment there"));
  if (const auto following = load.optional("following")) point.following = following->boolean();
  load.close();
  return point;
}

}  // namespace

ArmLoad read_arm_load(const Arm& arm, Reader& place, ArmLoad load) {
  if (const auto wrench = place.optional("wrench")) load.wrench = read_arm_wrench(*wrench);
  if (const auto following = place.optional("following")) load.following = read_arm_wrench(*following);
  const Range any{.low = -1e9, .high = 1e9};
  if (const auto along = place.optional("distributed")) load.along = along->array<3>(Dimension::number, any);
  if (const auto along = place.optional("distributed_following"))
    load.following_along = along->array<3>(Dimension::number, any);
  if (const auto points = place.optional("loads")) {
    load.points.clear();
    for (Reader& point : points->items()) load.points.push_back(read_point_load(point, arm.length()));
  }
  if (const auto gravity = place.optional("gravity")) {
    const Vec3<double> g = read_gravity(*gravity);
    load.gravity = {g[0], g[1], g[2]};
  }
  return load;
}

ArmOptions read_arm_options(Question& context) {
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
  if (const auto order = query.optional("order")) options.order = order->integer(Range::between(0, 9));
  if (const auto elements = query.optional("elements")) {
    const bool joints = options.model == ArmModel::prb;
    options.elements = elements->integer(Range::between(1, joints ? 10 : 200));
  }
  if (const auto accuracy = query.optional("accuracy"))
    options.accuracy = accuracy->number({.low = 0, .high = 1});
  if (context.max_iterations) options.max_iterations = *context.max_iterations;
  return options;
}

void read_arm_start(ArmContext& context, ArmOptions& options) {
  options.from_last = context.continues == Continues::always && context.last != nullptr;
  const auto start = context.query.optional("start");
  if (!start) return;
  start->choice({"last"});
  options.from_last = true;
}

Value by_end_section(const Arm& arm, std::span<const double> values) {
  return by_end_section(tendons_by_section(arm), values);
}
Value by_end_section(const std::vector<std::size_t>& counts, std::span<const double> values) {
  Value list = Value::list();
  std::size_t first = 0;
  for (const std::size_t count : counts) {
    list.push_back(Value(values.subspan(first, count)));
    first += count;
  }
  return list;
}

bool has_friction(const Arm& arm) {
  return std::ranges::any_of(arm.tendons, [](const ArmTendon& tendon) { return tendon.friction > 0; });
}

namespace {

/// @param report of the question; its message comes first
void put_arm_state(ArmContext& context, const ArmState& state, const Report& report) {
  context.report(report);
  if (has_friction(context.robot))
    context.add_message(
        "its tendons are taken as if they did not rub; track follows a path with their friction");
  Value& answer = context.answer;
  if (state.report.status == Status::bad_input || state.report.status == Status::unsupported) return;
  answer["tip"] = pose_value(AnyPose(spatial_pose(state.tip)));
  answer["tensions"] = by_end_section(context.robot, state.tensions);
  answer["changes"] = by_end_section(context.robot, state.changes);
  answer["slack"] = by_end_section(context.robot, state.slack);
  if (state.stability_told) answer["stable"] = state.stable;
  put_number(answer, "potential", state.energy);
  put_number(answer, "residual", state.report.residual);
  answer["iterations"] = state.report.iterations;
  if (state.resolution > 0) answer["resolution"] = state.resolution;
  if (context.robot.motor) {
    std::vector<double> counts = state.changes;
    for (double& count : counts) count *= context.robot.motor->counts_per_length();
    answer["motors"] = by_end_section(context.robot, counts);
  }
}

struct ArmWanted {
  Wants words;
  int samples = 0;
};
ArmWanted read_arm_wants(ArmContext& context, Wants usual) {
  ArmWanted wanted{read_wants(context, usual, arm_wants)};
  wanted.samples = read_samples(context, wanted.words, 60, 2000);
  return wanted;
}

}  // namespace

void put_arm_shape(ArmContext& context, int samples) {
  const Arm& arm = context.robot;
  std::vector<double> places, ends;
  for (int k = 0; k < samples; ++k) places.push_back(arm.length() * k / (samples - 1));
  double end = 0;
  for (const ArmSection& section : arm.sections) ends.push_back(end += section.length);
  std::vector<double> backbone, curvature;
  for (const SE3<double>& frame : arm_frames(arm, places, context.work))
    backbone.insert(backbone.end(), frame.p.begin(), frame.p.end());
  for (const auto& strain : arm_strains(arm, places, context.work))
    curvature.insert(curvature.end(), strain.begin() + 3, strain.end());
  Value tendons = Value::list(), frames = Value::list(), discs = Value::list(), backbones = Value::list();
  const auto lines = arm_tendon_lines(arm, context.work);
  std::size_t next = 0;
  for (const std::size_t count : tendons_by_section(arm)) {
    Value of_section = Value::list();
    for (std::size_t i = 0; i < count; ++i, ++next) {
      std::vector<double> numbers;
      for (const Vec3<double>& point : lines[next]) numbers.insert(numbers.end(), point.begin(), point.end());
      of_section.push_back(Value(numbers, 3));
    }
    tendons.push_back(std::move(of_section));
  }
  for (const SE3<double>& frame : arm_frames(arm, ends, context.work))
    frames.push_back(pose_value(AnyPose(spatial_pose(frame))));
  double from = 0;
  for (const ArmSection& section : arm.sections) {
    std::vector<double> at_discs;
    for (int k = 1; k <= section.discs.count; ++k)
      at_discs.push_back(from + section.length * k / section.discs.count);
    for (const SE3<double>& frame : arm_frames(arm, at_discs, context.work))
      discs.push_back({{"pose", pose_value(AnyPose(spatial_pose(frame)))},
                       {"height", 0.0},
                       {"radius", section.discs.radius}});
    from += section.length;
  }
  backbones.push_back(Value(backbone, 3));
  Value& answer = context.answer;
  answer["places"] = places;
  answer["backbones"] = std::move(backbones);
  answer["curvatures"] = Value(curvature, 3);
  answer["tendons"] = std::move(tendons);
  answer["discs"] = std::move(discs);
  answer["frames"] = std::move(frames);
}

namespace {

/// Of the equilibrium in the workspace.
void put_arm_wants(ArmContext& context, const ArmState& state, const ArmWanted& wanted) {
  if (!state.report.is_solved()) return;
  if (wanted.words.has(Want::shape)) put_arm_shape(context, wanted.samples);
  const bool margins = wanted.words.has(Want::stability) || wanted.words.has(Want::margins);
  if (!margins && !wanted.words.has(Want::stiffness) && !wanted.words.has(Want::velocity)) return;
  Value& answer = context.answer;
  const ArmRates rates = arm_rates(context.robot, context.work, margins);
  if (!rates.regular) {
    context.add_message(state.stability_told ? "the equilibrium is a fold: it has no rates"
                                             : "rates and margins are told of balances by energy alone");
    return;
  }
  const auto m = static_cast<Eigen::Index>(rates.tendons);
  if (wanted.words.has(Want::velocity)) {
    answer["U"] = Value(MatrixView(rates.J.data(), 6, m));
    answer["answer_rates"] = Value(MatrixView(rates.answers.data(), m, m));
  }
  if (wanted.words.has(Want::stiffness)) {
    const MatrixView compliance(rates.compliance.data(), 6, 6);
    std::array<double, 36> identity{}, stiffness{};
    for (std::size_t i = 0; i < 6; ++i) identity[7 * i] = 1;
    answer["compliance"] = Value(compliance);
    if (solve(compliance, {identity.data(), 6, 6}, stiffness))
      answer["stiffness"] = Value(MatrixView(stiffness.data(), 6, 6));
    answer["answers_by_wrench"] = Value(MatrixView(rates.answers_by_wrench.data(), m, 6));
  }
  if (margins) answer["buckling_margin"] = rates.margin;
  if (wanted.words.has(Want::margins) && !state.tensions.empty())
    answer["least_tension"] = std::ranges::min(state.tensions);
}

/// The last equilibrium of a load that grows.
ArmState follow(ArmContext& context, const Until<Spatial>& until, std::span<const TendonCommand> commands,
                const ArmLoad& load, const ArmOptions& options) {
  std::array<double, 6> direction{};
  for (int i = 0; i < 6; ++i) direction[static_cast<std::size_t>(i)] = until.direction[i];
  const ArmLoadPath path =
      arm_follow_load(context.robot, commands, load, direction, until.limit, options, context.work);
  ArmState state = path.state;
  if (!state.report.ok()) return state;
  context.answer["load"] = path.load;
  context.answer["why"] = to_string(path.end);
  if (path.definite_until >= 0) context.answer["definite_until"] = path.definite_until;
  if (path.end == LoadEnd::stopped) state.report.status = Status::stopped;
  return state;
}

void answer_arm_state(Context& asked, Want usual) {
  ArmContext context(asked);
  ArmOptions options = read_arm_options(context);
  const auto commands = read_arm_commands(context.robot, context.query);
  const ArmLoad load = read_arm_load(context.robot, context.query);
  read_arm_start(context, options);
  bool want_all = false;
  std::optional<Until<Spatial>> until;
  if (usual == Want::pose) {
    until = read_until<Spatial>(asked);
    if (const auto all = context.query.optional("all")) {
      want_all = all->boolean();
      if (want_all && until)
        all->fail("ambiguous", "until follows one equilibrium, all finds many; keep one");
    }
  }
  const ArmWanted wanted = read_arm_wants(context, {usual});
  if (!context.ready()) return;
  const ArmState state = until ? follow(context, *until, commands, load, options)
                               : arm_forward(context.robot, commands, load, options, context.work);
  put_arm_state(context, state, state.report);
  put_arm_wants(context, state, wanted);
  if (!want_all || state.report.status == Status::bad_input) return;
  Value solutions = Value::list();
  for (const ArmState& other : arm_equilibria(context.robot, commands, load, options, 40, context.work))
    solutions.push_back({{"tip", pose_value(AnyPose(spatial_pose(other.tip)))},
                         {"tensions", by_end_section(context.robot, other.tensions)},
                         {"potential", other.energy},
                         {"residual", other.report.residual}});
  put_solutions(asked, std::move(solutions));
}

ArmTarget read_arm_target(ArmContext& context) {
  ArmTarget target;
  Reader& query = context.query;
  const auto position = query.optional("position"), direction = query.optional("direction");
  if (auto pose = query.optional("pose")) {
    for (const auto& [key, other] : {std::pair{"position", &position}, {"direction", &direction}})
      if (*other) (*other)->fail("ambiguous", fmt::format("the query gives a pose and a {}; keep one", key));
    const SpatialPose given = read_spatial_pose(std::move(*pose));
    target.position = {given.position[0], given.position[1], given.position[2]};
    target.quaternion = given.quaternion;
    return target;
  }
  if (!position && !direction) query.required("position", "of the tip; or a direction, or a pose");
  if (position) target.position = position->array<3>(Dimension::length, Range::place());
  if (direction) {
    const auto axis = direction->array<3>(Dimension::number, Range::place());
    if (std::hypot(axis[0], axis[1], axis[2]) < 1e-9)
      direction->fail("no_direction", "a direction needs a length of at least 1e-9");
    target.direction = axis;
  }
  return target;
}

}  // namespace

void answer_arms_forward(Context& context) { answer_arm_state(context, Want::pose); }
void answer_arms_velocity(Context& context) { answer_arm_state(context, Want::velocity); }
void answer_arms_shape(Context& context) { answer_arm_state(context, Want::shape); }

void answer_arms_inverse(Context& asked) {
  ArmContext context(asked);
  ArmInverseOptions options;
  options.arm = read_arm_options(context);
  const ArmTarget target = read_arm_target(context);
  const ArmLoad load = read_arm_load(context.robot, context.query);
  read_arm_start(context, options.arm);
  if (const auto limit = context.query.optional("tension_limit"))
    options.most_tension = limit->quantity(Dimension::force, Range::positive());
  const ArmWanted wanted = read_arm_wants(context, {Want::pose});
  if (!context.ready()) return;
  const ArmInverse found = arm_inverse(context.robot, target, load, options, context.work);
  put_arm_state(context, found.state, found.report);
  put_number(context.answer, "residual", found.report.residual);
  context.answer["iterations"] = found.report.iterations;
  put_arm_wants(context, found.state, wanted);
}

void answer_arms_statics(Context& asked) {
  ArmContext context(asked);
  ArmOptions options = read_arm_options(context);
  ArmMeasurement measured;
  measured.held = read_arm_commands(context.robot, context.query);
  const ArmLoad load = read_arm_load(context.robot, context.query);
  read_arm_start(context, options);
  const auto tensions = context.query.optional("measured_tensions"), tip = context.query.optional("position"),
             deviation = context.query.optional("deviation"), force = context.query.optional("force_alone");
  if (!tensions && !tip)
    context.query.required("measured_tensions", "of every tendon; or position, where the tip was seen");
  if (tensions)
    measured.answers =
        read_forces(*tensions, context.robot.tendons.size(), Range{.low = 0, .high = 1e9}, false);
  if (tip) measured.tip = tip->array<3>(Dimension::length, Range::place());
  if (deviation) measured.tension_deviation = deviation->quantity(Dimension::force, Range::positive());
  const bool force_alone = !force || force->boolean();
  if (tensions)
    for (std::size_t i = 0; i < measured.held.size(); ++i)
      if (measured.held[i].held == TendonHeld::tension && context.errors.empty())
        measured.answers[i] = std::nan("");  // held: it tells nothing
  const ArmWanted wanted = read_arm_wants(context, {Want::pose});
  if (!context.ready()) return;
  const ArmSensed sensed = arm_sense(context.robot, measured, load, force_alone, options, context.work);
  put_arm_state(context, sensed.state, sensed.report);
  if (sensed.report.status == Status::bad_input) return;
  context.answer["wrench"] = sensed.wrench;
  context.answer["covariance"] = Value(MatrixView(sensed.covariance.data(), 6, 6));
  put_number(context.answer, "misfit", sensed.misfit);
  put_arm_wants(context, sensed.state, wanted);
}

}  // namespace sinew::inline v1
