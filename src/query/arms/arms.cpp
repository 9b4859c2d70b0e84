/// Handlers of queries to arms that bear loads: forward, inverse, velocity, shape, statics.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/quantity.hpp"
#include "io/read_pose.hpp"
#include "io/reader.hpp"
#include "query/arms/arms.hpp"
#include "query/batch/sampler.hpp"
#include "query/tip.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

std::vector<std::size_t> tendons_by_section(const Arm& arm) {
  std::vector<std::size_t> counts(arm.sections.size());
  for (const ArmTendon& tendon : arm.tendons) ++counts[static_cast<std::size_t>(tendon.section())];
  return counts;
}

namespace {

constexpr std::size_t most_parts = 1000;  // of a shape to begin at

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
       read_of_tendons(tendons_by_section(arm), list, Dimension::number, {.low = -1e9, .high = 1e9}))
    rates.push_back(value.value_or(0));
  return rates;
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
  point.place = read_place_along(load, length);
  point.wrench = read_arm_wrench(load.required("wrench", "force and moment there"));
  if (const auto following = load.optional("following")) point.following = following->boolean();
  if (const auto leg = load.optional("leg"))
    leg->fail("no_effect", "is of platforms on legs of sections; an arm has one backbone: leave it out");
  load.close();
  return point;
}

}  // namespace

std::array<double, 3> read_along(const Reader& along) {
  return along.array<3>(Dimension::number, Range{.low = -1e9, .high = 1e9});
}

double read_place_along(Reader& load, double length) {
  return load.required("place", "of the load, from the base along the backbone")
      .quantity(Dimension::length, {.low = 0, .high = length * (1 + 1e-12), .low_excluded = true});
}

ArmLoad read_arm_load(const Arm& arm, Reader& place, ArmLoad load) {
  if (const auto wrench = place.optional("wrench")) load.wrench = read_arm_wrench(*wrench);
  if (const auto following = place.optional("following")) load.following = read_arm_wrench(*following);
  if (const auto along = place.optional("distributed")) load.along = read_along(*along);
  if (const auto along = place.optional("distributed_following")) load.following_along = read_along(*along);
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

void read_arm_start(Question& context, ArmOptions& options, std::vector<std::array<double, 3>>* shape) {
  options.from_last = context.continues == Continues::always && context.last != nullptr;
  const auto start = context.query.optional("start");
  if (!start) return;
  if (start->is(Node::Kind::list)) {
    if (!shape)
      return start->fail("wrong_type",
                         "a shape to begin at is of forward, velocity and shape; here it is last");
    const auto parts = start->items();
    if (parts.empty() || parts.size() > most_parts)
      start->fail("wrong_length",
                  fmt::format("a shape has the mean curvatures of 1 to {} equal parts of the arm, found {}",
                              most_parts, parts.size()));
    shape->clear();
    for (const Reader& part : parts)
      shape->push_back(part.array<3>(Dimension::curvature, {.low = -1e6, .high = 1e6}));
    options.from_curvatures = *shape;
    options.from_last = false;
    return;
  }
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

ArmWanted read_arm_wants(ArmContext& context) {
  ArmWanted wanted{read_wants(context)};
  wanted.samples = read_samples(context, wanted.words, 60, 2000);
  return wanted;
}

}  // namespace

namespace {

std::vector<double> numbers_of(std::span<const Vec3<double>> points, int count) {
  std::vector<double> numbers;
  for (const Vec3<double>& point : points)
    numbers.insert(numbers.end(), point.begin(), point.begin() + count);
  return numbers;
}

std::vector<double> places_along(const Arm& arm, int samples) {
  std::vector<double> places;
  for (int k = 0; k < samples; ++k) places.push_back(arm.length() * k / (samples - 1));
  return places;
}

}  // namespace

void ArmPicture::add(const Arm& arm, const ArmWorkspace& work, int samples, double unknown_radius) {
  const std::vector<double> places = places_along(arm, samples);
  const int dimension = is_planar ? 2 : 3;
  std::vector<Vec3<double>> points;
  std::vector<double> curvature;
  for (const SE3<double>& frame : arm_frames(arm, places, work)) points.push_back(frame.p);
  for (const auto& strain : arm_strains(arm, places, work))
    if (is_planar)
      curvature.push_back(strain[4]);
    else
      curvature.insert(curvature.end(), strain.begin() + 3, strain.end());
  backbones.push_back(Value(numbers_of(points, dimension), static_cast<std::size_t>(dimension)));
  curvatures.push_back(is_planar ? Value(curvature) : Value(curvature, 3));
  const auto lines = arm_tendon_lines(arm, work);
  std::size_t next = 0;
  for (const std::size_t count : tendons_by_section(arm)) {
    Value of_section = Value::list();
    for (std::size_t i = 0; i < count; ++i, ++next)
      of_section.push_back(Value(numbers_of(lines[next], dimension), static_cast<std::size_t>(dimension)));
    tendons.push_back(std::move(of_section));
  }
  if (is_planar) return;
  double from = 0;
  for (const ArmSection& section : arm.sections) {
    std::vector<double> at_discs;
    for (int k = 1; k <= section.discs.count; ++k)
      at_discs.push_back(from + section.length * k / section.discs.count);
    for (const SE3<double>& frame : arm_frames(arm, at_discs, work))
      discs.push_back({{"pose", pose_value(AnyPose(spatial_pose(frame)))},
                       {"height", 0.0},
                       {"radius", section.discs.radius > 0 ? section.discs.radius : unknown_radius}});
    from += section.length;
  }
}

void put_arm_shape(ArmContext& context, int samples) {
  const Arm& arm = context.robot;
  ArmPicture picture;
  picture.add(arm, context.work, samples, 0);
  std::vector<double> ends;
  double end = 0;
  for (const ArmSection& section : arm.sections) ends.push_back(end += section.length);
  Value frames = Value::list();
  for (const SE3<double>& frame : arm_frames(arm, ends, context.work))
    frames.push_back(pose_value(AnyPose(spatial_pose(frame))));
  Value& answer = context.answer;
  answer["places"] = places_along(arm, samples);
  answer["backbones"] = std::move(picture.backbones);
  answer["curvatures"] = std::move(picture.curvatures.back());
  answer["tendons"] = std::move(picture.tendons);
  answer["discs"] = std::move(picture.discs);
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
  if (rates.margin_is_bound)
    context.add_message(
        "more than six tendons are exactly at rest and counted as slack: the margin to buckling is at least "
        "this");
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
  put_growth(context.answer, path);
  if (path.end == LoadEnd::stopped) state.report.status = Status::stopped;
  return state;
}

void answer_forward(ArmContext& context, const ArmForward& asked) {
  const auto& [options, commands, load, until, wants_all, wanted] = asked;
  const ArmState state = until ? follow(context, *until, commands, load, options)
                               : arm_forward(context.robot, commands, load, options, context.work);
  put_arm_state(context, state, state.report);
  if (state.report.status == Status::stalled && context.ask == Ask::forward && !wants_all && !until)
    context.add_message("all: true looks from other shapes, too");
  put_arm_wants(context, state, wanted);
  if (!wants_all || state.report.status == Status::bad_input) return;
  Value solutions = Value::list();
  bool is_continuum = false;
  for (const auto& [other, curvatures, continuum] :
       arm_equilibria(context.robot, commands, load, options, 40, context.work)) {
    Value one{{"tip", pose_value(AnyPose(spatial_pose(other.tip)))},
              {"tensions", by_end_section(context.robot, other.tensions)},
              {"potential", other.energy},
              {"residual", other.report.residual}};
    std::vector<double> numbers;
    for (const auto& of_part : curvatures) numbers.insert(numbers.end(), of_part.begin(), of_part.end());
    if (!numbers.empty()) one["curvatures"] = Value(numbers, 3);
    if (continuum) one["continuum"] = true;
    is_continuum = is_continuum || continuum;
    solutions.push_back(std::move(one));
  }
  if (is_continuum)
    context.add_message(
        "a solution with continuum is one of infinitely many, to any of which it may move freely");
  put_solutions(context, context.work.stop, std::move(solutions));
}

}  // namespace

ArmTarget read_arm_target(Question& context) {
  const AskedTip tip = read_tip(context, true);
  ArmTarget target{.position = tip.position, .direction = tip.direction};
  if (!tip.pose) return target;
  target.position = {tip.pose->position[0], tip.pose->position[1], tip.pose->position[2]};
  target.quaternion = tip.pose->quaternion;
  return target;
}

namespace {

struct ArmInverseQuestion {
  ArmInverseOptions options;
  ArmTarget target;
  ArmLoad load;
  ArmWanted wanted;
};

ArmInverseQuestion read_inverse(ArmContext& context) {
  ArmInverseQuestion asked;
  asked.options.arm = read_arm_options(context);
  asked.target = read_arm_target(context);
  asked.load = read_arm_load(context.robot, context.query);
  read_arm_start(context, asked.options.arm);
  if (const auto limit = context.query.optional("tension_limit"))
    asked.options.most_tension = limit->quantity(Dimension::force, Range::positive());
  asked.wanted = read_arm_wants(context);
  return asked;
}

void answer_inverse(ArmContext& context, const ArmInverseQuestion& asked) {
  const ArmInverse found = arm_inverse(context.robot, asked.target, asked.load, asked.options, context.work);
  put_arm_state(context, found.state, found.report);
  put_number(context.answer, "residual", found.report.residual);
  context.answer["iterations"] = found.report.iterations;
  put_arm_wants(context, found.state, asked.wanted);
}

struct ArmSensing {
  ArmOptions options;
  ArmMeasurement measured;
  ArmLoad load;
  bool force_alone = true;
  ArmWanted wanted;
};

ArmSensing read_statics(ArmContext& context) {
  ArmSensing asked;
  asked.options = read_arm_options(context);
  ArmMeasurement& measured = asked.measured;
  measured.held = read_arm_commands(context.robot, context.query);
  asked.load = read_arm_load(context.robot, context.query);
  read_arm_start(context, asked.options);
  if (const auto pose = context.query.optional("pose"))
    pose->fail("not_available", "is for platforms; of an arm give position, where the tip was seen");
  const auto tensions = context.query.optional("measured_tensions"), tip = context.query.optional("position"),
             deviation = context.query.optional("deviation"), force = context.query.optional("force_alone");
  if (!tensions && !tip)
    context.query.required("measured_tensions", "of every tendon; or position, where the tip was seen");
  if (tensions)
    measured.answers =
        read_forces(*tensions, context.robot.tendons.size(), Range{.low = 0, .high = 1e9}, false);
  if (tip) measured.tip = tip->array<3>(Dimension::length, Range::place());
  if (deviation) measured.tension_deviation = deviation->quantity(Dimension::force, Range::positive());
  asked.force_alone = !force || force->boolean();
  if (tensions)
    for (std::size_t i = 0; i < measured.held.size(); ++i)
      if (measured.held[i].held == TendonHeld::tension && context.errors.empty())
        measured.answers[i] = std::nan("");  // held: it tells nothing
  asked.wanted = read_arm_wants(context);
  return asked;
}

void answer_statics(ArmContext& context, const ArmSensing& asked) {
  const ArmSensed sensed =
      arm_sense(context.robot, asked.measured, asked.load, asked.force_alone, asked.options, context.work);
  put_arm_state(context, sensed.state, sensed.report);
  if (sensed.report.status == Status::bad_input) return;
  context.answer["wrench"] = sensed.wrench;
  context.answer["covariance"] = Value(MatrixView(sensed.covariance.data(), 6, 6));
  put_number(context.answer, "misfit", sensed.misfit);
  put_arm_wants(context, sensed.state, asked.wanted);
}

}  // namespace

ArmForward read_arm_forward(ArmContext& context) {
  ArmForward asked;
  asked.options = read_arm_options(context);
  asked.commands = read_arm_commands(context.robot, context.query);
  asked.load = read_arm_load(context.robot, context.query);
  read_arm_start(context, asked.options, &context.curvatures);
  if (context.ask == Ask::forward) {
    asked.until = read_until<Spatial>(context);
    if (const auto all = context.query.optional("all")) {
      asked.wants_all = all->boolean();
      if (asked.wants_all && asked.until)
        all->fail("ambiguous", "until follows one equilibrium, all finds many; keep one");
    }
  }
  asked.wanted = read_arm_wants(context);
  return asked;
}

constexpr Handlers arm_handlers{
    .robots = "arms",
    .wants = {Want::pose, Want::velocity, Want::shape, Want::stiffness, Want::stability, Want::margins},
    .answers = {.forward = handle<read_arm_forward, answer_forward>,
                .inverse = handle<read_inverse, answer_inverse>,
                .velocity = handle<read_arm_forward, answer_forward>,
                .shape = handle<read_arm_forward, answer_forward>,
                .statics = handle<read_statics, answer_statics>,
                .track = answer_arms_track,
                .identify = answer_arms_identify,
                .describe = answer_arm_describe},
    .plan = plan_arms};

}  // namespace sinew::inline v1
