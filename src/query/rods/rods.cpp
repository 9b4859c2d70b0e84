#include "query/rods/rod_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document/reader.hpp"
#include "io/robots/read_pose.hpp"
#include "query/batch/sampler.hpp"
#include "query/questions.hpp"
#include "robot/parallel.hpp"
#include "robot/rods/rod_work.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {

std::optional<Vec3<double>> read_gravity_of(Context& context) {
  const auto gravity = context.query.optional("gravity");
  if (!gravity) return {};
  if (!has_weight(context.robot))
    gravity->fail("no_effect",
                  "has no effect: nothing of this robot has a mass; give its rods a density, or its "
                  "platform a mass");
  return read_gravity(*gravity);
}

EquilibriumOptions read_equilibrium_options(Context& context) {
  EquilibriumOptions options;
  if (const auto wrench = context.query.optional("wrench")) options.wrench = read_wrench<Spatial>(*wrench);
  options.gravity = read_gravity_of(context);
  if (context.max_iterations) options.max_iterations = *context.max_iterations;
  return options;
}

IndependentPose read_independent(const Context& context, Reader& asked) {
  IndependentPose pose;
  pose.z = asked.required("z", "height of the platform").quantity(Dimension::length, PoseRange::coordinate);
  pose.e1 = asked.required("e1", "a component of its quaternion").number(PoseRange::component);
  pose.e2 = asked.required("e2", "a component of its quaternion").number(PoseRange::component);
  if (const auto mode = asked.optional("mode"))
    mode->refuse("no_effect", "rods have no such modes, hinges have; leave it out");
  if (asked.is(Node::Kind::map)) asked.close();
  if (input_count(context.robot) != 3)
    asked.fail("not_available",
               fmt::format("z, e1 and e2 are held by three rod lengths, this robot has {}; ask with {}inputs",
                           input_count(context.robot), input_count(context.robot) == 6 ? "pose, or " : ""));
  return pose;
}

namespace {

Value rods_value(std::span<const RodResult> rods) {
  Value legs = Value::list();
  for (const RodResult& rod : rods) {
    legs.push_back({{"length", rod.length},
                    {"chord", rod.chord},
                    {"force", Value(rod.force)},
                    {"force_0", Value(rod.force_0)},
                    {"moment", Value(rod.moment)},
                    {"moment_0", Value(rod.moment_0)},
                    {"curvature_0", {rod.curvature_0.x(), rod.curvature_0.y()}},
                    {"tip", Value(rod.tip)},
                    {"tip_angle", rod.tip_angle},
                    {"energy", rod.energy}});
  }
  return legs;
}

/// All legs in order: rods, and what closes beside them.
Value legs_of(Context& context, const Equilibrium& found, const RodAnalysis& analysis) {
  Value legs = rods_value(analysis.rods);
  if (analysis.closing_forces.empty()) return legs;
  Value all = legs_value(context.robot, found.pose, found.coordinates, context.work);
  std::vector<bool> is_rod(all.size(), false);
  for_each_rod(context.robot, [&, k = std::size_t{0}](const RodLeg&, const LegPlace&, int i) mutable {
    all[static_cast<std::size_t>(i)] = legs[k++];
    is_rod[static_cast<std::size_t>(i)] = true;
  });
  for (std::size_t i = 0, k = 0; i < all.size(); ++i)
    if (!is_rod[i]) all[i]["force"] = Value(analysis.closing_forces[k++]);
  return all;
}

Value rows_value(std::span<const double> numbers, std::size_t columns) {
  return Value(MatrixView(numbers.data(), static_cast<Eigen::Index>(numbers.size() / columns),
                          static_cast<Eigen::Index>(columns)));
}

/// Left out where the platform is not held, and they say nothing.
void put_rows(Value& answer, Value::Key key, std::span<const double> numbers, std::size_t columns) {
  const auto is_number = [](double x) { return std::isfinite(x); };
  if (std::ranges::all_of(numbers, is_number)) answer[key] = rows_value(numbers, columns);
}

void put_stability(Context& context, const RodAnalysis& analysis) {
  Value& answer = context.answer;
  answer["stable"] = analysis.unstable_directions == 0;
  answer["unstable_directions"] = analysis.unstable_directions;
  Value twists = Value::list();
  for (const auto& twist : analysis.unstable) twists.push_back(twist);
  answer["unstable"] = std::move(twists);
  Value legs = Value::list();
  for_each_rod(context.robot, [&, k = std::size_t{0}](const RodLeg&, const LegPlace&, int i) mutable {
    const auto [in_plane, aside] = analysis.unstable_rods[k++];
    if (in_plane + aside > 0) legs.push_back(i);
  });
  answer["unstable_legs"] = std::move(legs);
}

RodMotion read_motion(Context& context) {
  RodMotion asked;
  const auto inputs = static_cast<std::size_t>(input_count(context.robot));
  const auto twist = context.query.optional("twist"), rates = context.query.optional("rates");
  if (twist) {
    const bool is_short = inputs == 3 && twist->is(Node::Kind::list) && twist->node()->items.size() == 3;
    asked.twist = twist->quantities(Dimension::number, {}, is_short ? 3 : 6);
  }
  if (rates) asked.rates = rates->quantities(Dimension::number, {}, inputs);
  if (twist && rates) rates->fail("ambiguous", "twist and rates both say how the robot moves; keep one");
  return asked;
}

/// The one of the other; of a short twist also the whole of it.
void put_motion(Context& context, const RodMotion& asked, const Report& equilibrium,
                const RodAnalysis& analysis) {
  const auto is_known = [&](const Report& found) {
    if (equilibrium.ok())
      context.add_report(found);
    else
      context.add_message(found.message.view());  // the status is that of the equilibrium
    return found.ok();
  };
  std::vector<double> rates = asked.rates;
  if (!asked.twist.empty()) {
    rates.resize(static_cast<std::size_t>(input_count(context.robot)));
    if (!is_known(rod_rates(analysis, asked.twist, rates))) return;
    context.answer["rates"] = Value(rates);
  }
  if (rates.empty() || asked.twist.size() == 6) return;
  std::array<double, 6> twist;
  if (!is_known(rod_twist(analysis, rates, twist))) return;
  context.answer["twist"] = Value(std::span<const double>(twist));
}

void put_velocity(Context& context, const RodMotion& motion, const Report& equilibrium,
                  const RodAnalysis& analysis) {
  Value& answer = context.answer;
  const auto columns = static_cast<std::size_t>(input_count(context.robot));
  answer["J"] = rows_value(analysis.stiffness, 6);
  answer["K"] = rows_value(analysis.feed, columns);
  put_rows(answer, "U", analysis.sensitivity, columns);
  answer["indices"] = indices_value(analysis);
  answer["type_2"] = {{"singular", analysis.is_singular()}};
  put_motion(context, motion, equilibrium, analysis);
}

void put_shape_of(Context& context, const Equilibrium& found, int samples,
                  const std::optional<Vec3<double>>& gravity) {
  Weight weight = context.robot.weight();  // what shears and stretches is drawn under this weight
  weight.gravity = gravity.value_or(weight.gravity);
  put_shape(context.answer, any_shape(context.robot.under(weight), found.pose, found.coordinates, samples));
  context.answer["frames"] = Value::list({pose_value(found.pose)});
}

constexpr int pose_inputs = 6;  ///< so many lengths hold a pose

/// Questions of other robots that have no meaning here, each with its way out.
void refuse_what_rods_lack(Context& context) {
  const auto pose = context.query.optional("pose");
  if (pose && input_count(context.robot) == 3)
    pose->fail(
        "not_available",
        "on rods the rest of a pose follows from lengths and load; give independent: {z, e1, e2}, or inputs");
  else if (pose && input_count(context.robot) != pose_inputs)
    pose->fail("not_available",
               fmt::format("a pose is held by six rod lengths, this robot has {}; ask forward with inputs",
                           input_count(context.robot)));
  read_branch(context);  // refuses bending, curvature and elbow
}

/// A pose that six lengths hold.
std::optional<SpatialPose> read_held_pose(const Context& context) {
  auto pose = context.query.optional("pose");
  if (!pose || input_count(context.robot) != pose_inputs) return {};
  return read_spatial_pose(std::move(*pose));
}

}  // namespace

RodWants read_rod_wants(Context& context) {
  RodWants wanted{read_wants(context, usual_of_rods(context.ask), equilibrium_wants), {}, 0};
  refuse_other_sensitivity(context);
  if (wanted.words.has(Want::velocity)) {
    wanted.motion = read_motion(context);
    for (const char* key : {"along", "limit"})
      if (const auto given = context.query.optional(key))
        given->fail("not_available", "robots of rods have no search for type II; leave it out");
  }
  refuse_without(context, wanted.words, Want::velocity, {"twist", "rates"});
  wanted.samples = read_samples(context, wanted.words, 33, 2000);
  return wanted;
}

void put_rod_wants(Context& context, const Equilibrium& found, const RodWants& wanted,
                   const std::optional<Vec3<double>>& gravity) {
  const Wants words = wanted.words;
  Value& answer = context.answer;
  if (words.has(Want::pose)) answer["pose"] = pose_value(found.pose);
  answer["inputs"] = found.inputs;
  if (const Wants more = words - Wants{Want::pose, Want::shape}; !more.is_empty()) {
    const RodAnalysis analysis = more == Wants{Want::legs} ? read_rods(context.robot, context.work)
                                                           : analyse_equilibrium(context.robot, context.work);
    if (words.has(Want::legs)) {
      answer["legs"] = legs_of(context, found, analysis);
      answer["energy"] = analysis.energy;
      put_number(answer, "potential", analysis.potential);
    }
    if (words.has(Want::velocity)) put_velocity(context, wanted.motion, found.report, analysis);
    if (words.has(Want::stiffness)) answer["stiffness"] = rows_value(analysis.stiffness, 6);
    if (words.has(Want::stability)) put_stability(context, analysis);
    if (words.has(Want::margins))
      answer["margins"] = {{"fold", analysis.smallest_pivot}, {"strain", analysis.largest_strain}};
    if (words.has(Want::sensitivity))
      put_rows(answer, "sensitivity", analysis.sensitivity, context.work.inputs.size());
  }
  if (words.has(Want::shape)) put_shape_of(context, found, wanted.samples, gravity);
}

Value indices_value(const RodAnalysis& analysis) {
  Value indices = Value::map();
  put_number(indices, "position", analysis.position_index());
  put_number(indices, "rotation", analysis.rotation_index());
  return indices;
}

std::optional<SpatialPose> read_spatial_start(Context& context) {
  const std::optional<AnyPose> start = read_start(context);
  if (!start) return {};
  return std::get<SpatialPose>(*start);
}

bool holds_last(const Context& context) {
  const RodWork& rods = *context.work.rods;
  if (!context.starts_at_last || !rods.is_solved || !rods.holds_last) return false;
  const SpatialPose here = spatial_pose(rods.system->platform()),
                    &last = std::get<SpatialPose>(**context.last);
  return here.position == last.position && here.quaternion == last.quaternion;
}

void remember_held(Context& context, const std::optional<SpatialPose>& found) {
  context.work.rods->holds_last = context.remember(found ? std::optional<AnyPose>(*found) : std::nullopt);
}

RodQuery read_configuration_of_rods(Context& context) {
  RodQuery asked;
  refuse_what_rods_lack(context);
  asked.options = read_equilibrium_options(context);
  asked.options.start = read_spatial_start(context);
  const auto inputs = context.query.optional("inputs");
  auto independent = context.query.optional("independent");
  if (inputs) asked.inputs = read_inputs(context, *inputs);
  if (independent) asked.independent = read_independent(context, *independent);
  asked.pose = read_held_pose(context);
  const bool has_pose = context.query.has("pose");
  if (!inputs && !independent && !has_pose)
    context.query.fail("missing_key",
                       input_count(context.robot) == pose_inputs
                           ? "give inputs (rod lengths, in leg order), or pose"
                           : "give inputs (rod lengths, in leg order), or independent: {z, e1, e2}");
  if (inputs && (independent || asked.pose))
    context.query.fail("ambiguous", fmt::format("inputs and {} both say where the platform is; keep one",
                                                asked.pose ? "pose" : "independent"));
  if ((independent || asked.pose) && context.names_start)
    context.query.fail(
        "ambiguous",
        fmt::format("start is where a search with given inputs begins; that of {} begins at home",
                    asked.pose ? "pose" : "independent"));
  return asked;
}

Equilibrium solve(Context& context, const RodQuery& asked) {
  EquilibriumOptions options = asked.options;
  const auto put = [&] {
    return asked.pose          ? inverse_equilibrium(context.robot, *asked.pose, options, context.work)
           : asked.independent ? inverse_equilibrium(context.robot, *asked.independent, options, context.work)
                               : equilibrium(context.robot, asked.inputs, options, context.work);
  };
  const bool goes_on = holds_last(context);
  options.warm_start = options.warm_start || goes_on || (context.path_start() && !options.start);
  Equilibrium found = put();
  if (goes_on && options.start && !found.is_solved() && found.report.status != Status::stopped) {
    options.warm_start = false;  // laid to that pose the rods may be on another curve
    found = put();
  }
  remember_held(context, found.is_solved() ? std::optional(found.pose) : std::nullopt);
  return found;
}

namespace {

/// What `equilibria` and `inverse_equilibria` tell of one of them beside where it is.
void put_found(Value& solution, const FoundEquilibrium& one, const Robot& robot) {
  solution["residual"] = one.residual;
  solution["stable"] = one.unstable_directions == 0;
  solution["unstable_directions"] = one.unstable_directions;
  put_number(solution, "potential", one.potential);
  if (robot.rod_count() == leg_count(robot)) solution["legs"] = rods_value(one.rods);
}

void put_all(Context& context, std::span<const double> inputs, const EquilibriumOptions& options) {
  Value solutions = Value::list();
  for (const FoundEquilibrium& one : equilibria(context.robot, inputs, options, context.work)) {
    solutions.push_back({{"pose", pose_value(one.pose)}});
    put_found(solutions.back(), one, context.robot);
  }
  put_solutions(context, context.work.stop, std::move(solutions));
}

/// @param is_held whether the one nearest to the start was found
void put_all_lengths(Context& context, const SpatialPose& pose, bool is_held,
                     const EquilibriumOptions& options) {
  Value solutions = Value::list();
  for (const FoundEquilibrium& one : inverse_equilibria(context.robot, pose, options, context.work)) {
    solutions.push_back({{"inputs", Value(one.inputs)}});
    put_found(solutions.back(), one, context.robot);
  }
  if (solutions.size() > 0 && !is_held) context.add_message("by other ways it is held: see solutions");
  put_solutions(context, context.work.stop, std::move(solutions));
}

/// Of rods that hold, as they do under a load that grows.
LoadPath follow(Context& context, const Until<Spatial>& until, Equilibrium& found) {
  const LoadPath path = follow_load(context.robot, until.direction, until.limit, context.work);
  const Report report = found.report;
  found = held_equilibrium(context.robot, context.work);
  found.report = report;
  remember_held(context, path.pose);
  found.report.residual = path.residual;
  if (path.end == LoadEnd::stopped) note_stop(context.work.stop, found.report);
  if (path.end == LoadEnd::limit && path.unstable_directions > 0) {
    found.report.status = Status::unstable;
    found.report.message = std::string_view("at this load the robot does not hold by itself");
  }
  return path;
}

}  // namespace

RodStart read_start_of_inverse(Context& context) {
  RodStart start;
  auto given = context.query.optional("start");
  if (!given) return start;
  const bool is_pose = input_count(context.robot) == pose_inputs;
  if (given->is(Node::Kind::list)) {
    context.names_start = true;
    start.inputs = read_inputs(context, *given);
  } else if (given->is(Node::Kind::map) && !is_pose) {
    context.names_start = true;
    start.independent = read_independent(context, *given);
  } else if (given->is(Node::Kind::map) || given->is(Node::Kind::string)) {
    start.pose = read_spatial_start(context);
  } else {
    given->refuse("wrong_type",
                  is_pose ? "give six lengths, a pose, or last" : "give the lengths, {z, e1, e2}, or last");
  }
  if (start.pose && !is_pose) {
    const SpatialPose pose = *start.pose;
    start.pose.reset();
    start.independent = {pose.position[2], pose.quaternion[1], pose.quaternion[2]};
  }
  return start;
}

bool begin_at(Context& context, const RodStart& start, const EquilibriumOptions& options, Report& report) {
  if (holds_last(context)) return true;
  Equilibrium begun;
  if (!start.inputs.empty())
    begun = equilibrium(context.robot, start.inputs, options, context.work);
  else if (start.pose)
    begun = inverse_equilibrium(context.robot, *start.pose, options, context.work);
  else if (start.independent)
    begun = inverse_equilibrium(context.robot, *start.independent, options, context.work);
  else
    return false;
  report = begun.report;
  return begun.is_solved();
}

void RodQuestion::read() {
  switch (ask) {
    case Ask::forward:
      read_forward();
      break;
    case Ask::inverse:
      read_inverse();
      break;
    default:
      at = read_configuration_of_rods(*this);
  }
  wanted = read_rod_wants(*this);
}

void RodQuestion::read_forward() {
  at.inputs = read_inputs(*this, query.required("inputs", "rod lengths, in leg order"));
  if (const auto trace = query.optional("trace"))
    trace->fail("not_available", "the iterates of rods are not recorded; leave it out");
  at.options = read_equilibrium_options(*this);
  at.options.start = read_spatial_start(*this);
  until = read_until<Spatial>(*this);
  wants_all = read_all(*this, until.has_value());
}

void RodQuestion::read_inverse() {
  refuse_what_rods_lack(*this);
  at.pose = read_held_pose(*this);
  if (input_count(robot) == pose_inputs && !query.has("independent"))
    query.required("pose", "{position, quaternion}: what six rod lengths hold");
  else if (!query.has("pose") || query.has("independent")) {
    auto independent = query.required("independent", "{z, e1, e2}: what three rod lengths hold");
    at.independent = read_independent(*this, independent);
  }
  at.options = read_equilibrium_options(*this);
  start_ = read_start_of_inverse(*this);
  const auto all = query.optional("all");
  wants_all = all && all->boolean();
  if (wants_all && input_count(robot) != pose_inputs)
    all->fail("not_available", "of several solutions only the one nearest home is found; leave it out");
}

void RodQuestion::solve() {
  if (ask == Ask::inverse) {
    at.options.warm_start = begin_at(*this, start_, at.options, begun_);
    if (!begun_.is_solved()) return remember_held(*this, {});
  }
  found_ = sinew::solve(*this, at);
  if (until && found_.is_solved() && !note_stop(work.stop, found_.report))
    growth_ = follow(*this, *until, found_);
}

void RodQuestion::tell() {
  if (!begun_.is_solved()) {
    report(begun_);
    answer["message"] = "from start: " + std::string(begun_.message.view());
    return;
  }
  if (growth_) put_growth(answer, *growth_);
  report(found_.report);
  if (found_.report.iterations > 0 || found_.is_solved()) {
    answer["iterations"] = found_.report.iterations;
    put_number(answer, "residual", found_.report.residual);
  }
  if (!found_.is_solved()) return;
  put_rod_wants(*this, found_, wanted, at.options.gravity);
  if (ask == Ask::inverse && at.pose && !wants_all)
    answer["complete"] = false;  // other lengths may hold it too
}

void RodQuestion::tell_all() {
  if (ask == Ask::forward)
    put_all(*this, at.inputs, at.options);
  else if (begun_.is_solved())
    put_all_lengths(*this, *at.pose, found_.is_solved(), at.options);
}

constexpr Handlers rod_handlers{.robots = "elastic rods",
                                .wants = equilibrium_wants,
                                .answers = {.forward = answer_question<RodQuestion>,
                                            .inverse = answer_question<RodQuestion>,
                                            .velocity = answer_question<RodQuestion>,
                                            .shape = answer_question<RodQuestion>,
                                            .statics = answer_rods_statics,
                                            .track = answer_rods_track,
                                            .describe = describe_platform},
                                .plan = plan_rods};

}  // namespace sinew::inline v1
