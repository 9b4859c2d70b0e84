/// forward, inverse, velocity, shape and statics of arms and of platforms on arms.
#include "query/arms/arm_question.hpp"

#include <algorithm>
#include <cmath>

#include "io/document/reader.hpp"
#include "kinematics/arms/ladder.hpp"
#include "query/batch/sampler.hpp"
#include "query/questions.hpp"

namespace sinew::inline v1 {
namespace {

/// @name What tells the two apart
/// @{

constexpr std::string_view other_beginnings(const Arm&) { return "all: true looks from other shapes, too"; }
constexpr std::string_view other_beginnings(const ArmLegs&) {
  return "all: true looks from other poses, too";
}

Value curvatures_value(const std::vector<std::array<double, 3>>& parts) {
  std::vector<double> numbers;
  for (const auto& part : parts) numbers.insert(numbers.end(), part.begin(), part.end());
  return {numbers, 3};
}

/// Others, whether one of them is one of a continuum; none where there is no equilibrium.
Value solutions_of(ArmContext& context, std::span<const TendonCommand> commands, const ArmLoad& load,
                   const ArmOptions& options) {
  constexpr int starts = 40;
  Value solutions = Value::list();
  bool is_continuum = false;
  for (const ArmEquilibrium& found :
       arm_equilibria(context.robot, commands, load, options, starts, context.work)) {
    Value one{{"tip", pose_value(AnyPose(spatial_pose(found.state.tip)))},
              {"tensions", by_end_section(context.robot, found.state.tensions)},
              {"potential", found.state.energy},
              {"residual", found.state.report.residual}};
    if (!found.curvatures.empty()) one["curvatures"] = curvatures_value(found.curvatures);
    if (found.continuum) one["continuum"] = true;
    is_continuum = is_continuum || found.continuum;
    solutions.push_back(std::move(one));
  }
  if (is_continuum)
    context.add_message(
        "a solution with continuum is one of infinitely many, to any of which it may move freely");
  return solutions;
}
Value solutions_of(ArmLegsContext& context, std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                   const ArmOptions& options) {
  constexpr int starts = 30;
  Value solutions = Value::list();
  for (const ArmLegsEquilibrium& found :
       arm_legs_equilibria(context.robot, commands, load, options, starts, context.work)) {
    if (found.start.curvatures.empty()) continue;  // there is none
    Value one = Value::map(), legs = Value::list();
    put_arm_numbers(one, context.robot, found.state);
    one["stable"] = found.state.stable;
    one["residual"] = found.state.report.residual;
    for (const auto& leg : found.start.curvatures) legs.push_back(curvatures_value(leg));
    one["curvatures"] = std::move(legs);
    solutions.push_back(std::move(one));
  }
  return solutions;
}

/// @}

/// A load that grows, of six numbers also in the plane.
std::optional<Until<Spatial>> read_until_of(Question& question, bool is_planar) {
  if (!is_planar) return read_until<Spatial>(question);
  const auto in_plane = read_until<Planar>(question);
  if (!in_plane) return {};
  Until<Spatial> in_space{.direction = Vec<double, 6>::Zero(), .limit = in_plane->limit};
  for (int i = 0; const std::size_t k : plane_axes)
    in_space.direction[static_cast<Eigen::Index>(k)] = in_plane->direction[i++];
  return in_space;
}
std::array<double, 6> direction_of(const Until<Spatial>& until) {
  std::array<double, 6> direction{};
  std::ranges::copy(until.direction, direction.begin());
  return direction;
}

/// Whether nothing was solved of it.
template <class State>
bool is_refused(const State& state) {
  return state.report.status == Status::bad_input || state.report.status == Status::unsupported ||
         state.tensions.empty();
}

}  // namespace

/// A shape of an arm, where the search begins.
template <>
void ArmQuestion<Arm>::read_shape() {
  start = read_curvatures(query.required("start"), "arm");
}
/// A solution's pose and curvatures.
template <>
void ArmQuestion<ArmLegs>::read_shape() {
  Reader shape = query.required("start");
  start = ArmLegsStart{read_pose_of(robot.is_planar, shape.required("pose", "where the platform is")), {}};
  const Reader curvatures =
      shape.required("curvatures", "of each leg the mean curvatures of equal parts, as `all` tells them");
  for (const Reader& leg : curvatures.items(robot.legs.size()))
    start->curvatures.push_back(read_curvatures(leg, "leg"));
  shape.close();
}

/// `start`: `last`, or a shape, which of statics and inverse it may not be.
template <class Arms>
void ArmQuestion<Arms>::read_start() {
  constexpr Node::Kind of_shapes = std::is_same_v<Arms, Arm> ? Node::Kind::list : Node::Kind::map;
  const Node* given = query.node()->find("start");
  if (given && given->kind == of_shapes && ask != Ask::inverse && ask != Ask::statics)
    read_shape();
  else
    read_arm_start(*this, options.arm);
}

/// Where the tip was seen: nothing else is known of it.
template <>
void ArmQuestion<Arm>::read_seen(bool has_tensions) {
  const auto position = query.optional("position");
  if (const auto pose = query.optional("pose"))
    pose->fail("not_available", "is for platforms; of an arm give position, where the tip was seen");
  if (!has_tensions && !position)
    query.required("measured_tensions", "of every tendon; or position, where the tip was seen");
  if (position) measured.tip = read_position_of(false, *position);
}
/// Where the platform was seen, or is held.
template <>
void ArmQuestion<ArmLegs>::read_seen(bool has_tensions) {
  const auto position = query.optional("position");
  auto pose = query.optional("pose");
  if (!has_tensions && !position && !pose)
    query.required("measured_tensions",
                   "of every tendon; or position, where the platform was seen; or pose, where it is held");
  if (position) measured.position = read_position_of(robot.is_planar, *position);
  if (!pose) return;
  if (position) pose->fail("ambiguous", "the query gives a pose and a position; keep one");
  const SE3<double> seen = read_pose_of(robot.is_planar, std::move(*pose));
  measured.position = std::array<double, 3>{seen.p[0], seen.p[1], seen.p[2]};
  measured.quaternion = std::array<double, 4>{seen.R.w, seen.R.v[0], seen.R.v[1], seen.R.v[2]};
  if (!has_tensions) held_at = seen;
}

template <class Arms>
void ArmQuestion<Arms>::read_measured() {
  const auto tensions = query.optional("measured_tensions");
  read_seen(tensions.has_value());
  const auto deviation = query.optional("deviation"), force = query.optional("force_alone");
  if (held_at)
    for (const auto* given : {&deviation, &force})
      if (*given)
        (*given)->fail("no_effect",
                       "has no effect: the platform is held at pose, and nothing is measured; remove it");
  measured.held = commands;
  if (tensions) measured.answers = read_forces(*tensions, commands.size(), {.low = 0, .high = 1e9}, false);
  for (std::size_t i = 0; i < std::min(commands.size(), measured.answers.size()); ++i)
    if (commands[i].held == TendonHeld::tension) measured.answers[i] = std::nan("");  // it tells nothing
  if (deviation) measured.tension_deviation = deviation->quantity(Dimension::force, Range::positive());
  force_alone = !force || force->boolean();
}

template <class Arms>
void ArmQuestion<Arms>::read() {
  options.arm = read_arm_options(*this, ArmTypes<Arms>::usual_iterations);
  if (ask == Ask::inverse)
    target = read_arm_target(*this, is_planar(robot));
  else
    commands = read_arm_commands(tendon_counts(robot), query);
  load = read_arm_load(robot, query);
  read_start();
  if (ask == Ask::forward) {
    until = read_until_of(*this, is_planar(robot));
    wants_all = read_all(*this, until.has_value());
  }
  if (ask == Ask::statics) read_measured();
  if (ask == Ask::inverse)
    if (const auto limit = query.optional("tension_limit"))
      options.most_tension = limit->quantity(Dimension::force, Range::positive());
  words = read_wants(*this);
  samples = read_samples(*this, words, 60, 2000);
}

template <>
void ArmQuestion<Arm>::solve_forward() {
  options.arm.from_curvatures = start;
  if (!until) {
    state_ = arm_forward(robot, commands, load, options.arm, work);
    found_ = state_.report;
    return;
  }
  growth_ = arm_follow_load(robot, commands, load, direction_of(*until), until->limit, options.arm, work);
  state_ = growth_->state;
  found_ = state_.report;
  if (!found_.ok()) growth_.reset();  // there is nothing to begin with
}
template <>
void ArmQuestion<ArmLegs>::solve_forward() {
  state_ = start ? arm_legs_forward_from(robot, *start, commands, load, options.arm, work)
                 : arm_legs_forward(robot, commands, load, options.arm, work);
  if (until && state_.report.ok()) {
    growth_ = arm_legs_follow_load(robot, direction_of(*until), until->limit, work);
    state_ = growth_->state;
  }
  found_ = state_.report;
}

template <>
void ArmQuestion<Arm>::solve_statics() {
  sensed_ = arm_sense(robot, measured, load, force_alone, options.arm, work);
}
template <>
void ArmQuestion<ArmLegs>::solve_statics() {
  if (!held_at) {
    sensed_ = arm_legs_sense(robot, measured, load, force_alone, options.arm, work);
    return;
  }
  const ArmLegsHeld held = arm_legs_hold(robot, *held_at, commands, load, options.arm, work);
  state_ = held.state;
  found_ = state_.report;
  if (found_.ok()) holding_ = held.wrench;
}

template <class Arms>
void ArmQuestion<Arms>::solve() {
  switch (ask) {
    case Ask::inverse: {
      const auto found = Types::inverse(robot, target, load, options, work);
      found_ = found.report;
      state_ = found.state;
      return;
    }
    case Ask::statics:
      solve_statics();
      if (!sensed_) return;
      state_ = sensed_->state;
      found_ = sensed_->report;
      return;
    default:
      solve_forward();
      if (growth_ && growth_->end == LoadEnd::stopped) found_.status = state_.report.status = Status::stopped;
  }
}

template <class Arms>
void ArmQuestion<Arms>::tell() {
  const bool planar = is_planar(robot);
  this->report(found_);
  if (has_friction(robot)) this->add_message(without_friction(robot));
  if (state_.report.status == Status::stalled && !is_coarse(state_.report) && ask == Ask::forward &&
      !wants_all && !until)
    this->add_message(other_beginnings(robot));
  if (found_.status == Status::bad_input || is_refused(state_)) return;
  put_arm_state(*this, state_, found_);
  if (growth_) put_growth(answer, *growth_);
  if (held_at && !holding_) return;
  if (holding_) answer["wrench"] = wrench_value(planar, *holding_);
  if (sensed_ && std::isfinite(sensed_->misfit)) {
    answer["wrench"] = wrench_value(planar, sensed_->wrench);
    if (found_.ok()) {
      answer["covariance"] = matrix_value(planar, sensed_->covariance.data(), 6, 6, true, true);
      put_number(answer, "condition", sensed_->condition);
    }
    put_number(answer, "misfit", sensed_->misfit);
  }
  put_arm_wants(*this, state_, words, samples);
}

template <class Arms>
void ArmQuestion<Arms>::tell_all() {
  if (found_.status == Status::bad_input || found_.status == Status::unsupported) return;
  put_solutions(*this, work.stop, solutions_of(*this, commands, load, options.arm));
}

template struct ArmQuestion<Arm>;
template struct ArmQuestion<ArmLegs>;

namespace {

constexpr Lack lacking[] = {
    {"balance", "is not available of legs of sections in this version; leave it out"}};

}  // namespace

constexpr Handlers arm_handlers{
    .robots = "arms",
    .wants = {Want::pose, Want::velocity, Want::shape, Want::stiffness, Want::stability, Want::margins},
    .answers = {.forward = answer_question<ArmQuestion<Arm>>,
                .inverse = answer_question<ArmQuestion<Arm>>,
                .velocity = answer_question<ArmQuestion<Arm>>,
                .shape = answer_question<ArmQuestion<Arm>>,
                .statics = answer_question<ArmQuestion<Arm>>,
                .track = answer_arms_track<Arm>,
                .identify = answer_arms_identify,
                .describe = answer_arms_describe<Arm>},
    .plan = plan_arms};

constexpr Handlers arm_legs_handlers{.robots = "legs of sections",
                                     .wants = {Want::pose, Want::legs, Want::velocity, Want::shape,
                                               Want::stiffness, Want::stability},  // that is told always
                                     .answers = {.forward = answer_question<ArmQuestion<ArmLegs>>,
                                                 .inverse = answer_question<ArmQuestion<ArmLegs>>,
                                                 .velocity = answer_question<ArmQuestion<ArmLegs>>,
                                                 .shape = answer_question<ArmQuestion<ArmLegs>>,
                                                 .statics = answer_question<ArmQuestion<ArmLegs>>,
                                                 .track = answer_arms_track<ArmLegs>,
                                                 .describe = answer_arms_describe<ArmLegs>},
                                     .lacks = lacking};

}  // namespace sinew::inline v1
