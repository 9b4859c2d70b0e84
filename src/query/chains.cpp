/// Handlers of statics, forward and inverse on pseudo-rigid chains.
#include "query/chains.hpp"

#include <fmt/format.h>

#include <cmath>

#include "query/rods.hpp"
#include "sinew/kinematics/forward.hpp"

namespace sinew::inline v0 {
namespace chains {

ChainModel read_law(Context& context) {
  const auto law = context.query.optional("law");
  if (!law) return ChainModel::weighted;
  return law->choice_of<ChainModel>(
      {{"M0w", ChainModel::weighted}, {"M0", ChainModel::even}, {"M1", ChainModel::discs}});
}

std::optional<AnyChainRobot> read_robot(Context& context, ChainModel law) {
  auto robot = chain_robot(context.robot, law);
  if (robot) return std::move(*robot);
  context.errors.insert(context.errors.end(), robot.error().begin(), robot.error().end());
  return {};
}

Arcs arcs_at(Context& context, const AnyPose& pose, const Branch& branch) {
  Arcs arcs;
  const Inverse solved = inverse(context.robot, pose, branch.options(), context.work);
  arcs.report = solved.report;
  if (!solved.ok()) return arcs;
  const std::vector<double> coordinates(solved.coordinates.begin(), solved.coordinates.end());
  for (const LegState& leg : leg_states(context.robot, pose, coordinates, context.work)) {
    arcs.curvature.push_back(leg.curvature);
    arcs.base_tangent.push_back(std::atan2(leg.base_tangent.y(), leg.base_tangent.x()));
  }
  return arcs;
}

void aim_bases(ChainRobot<Planar>& robot, const Arcs& arcs) {
  if (!robot.has_base_motors) return;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    ChainLeg<Planar>& leg = robot.legs[i];
    const double first_link = arcs.base_tangent[i] - 0.5 * arcs.curvature[i] * leg.chain.link_length();
    leg.base = SE2<double>::from(leg.base.p.x(), leg.base.p.y(), first_link - std::numbers::pi / 2);
  }
}

void refuse_open_legs(Context& context, double closure_error) {
  if (closure_error <= 1e-9) return;
  context.query.fail("not_closed",
                     fmt::format("pose and angles contradict each other: a leg misses by {:.3g} "
                                 "m; leave the angles out to have them solved",
                                 closure_error));
}

}  // namespace chains

namespace {

using namespace chains;

template <class Space>
struct Until {
  Wrench<Space> direction;
  double limit;
};

/// What every question about loaded chains may say.
template <class Space>
struct Load {
  Wrench<Space> wrench = Wrench<Space>::Zero();
  std::optional<Until<Space>> until;
  std::optional<double> threshold;  ///< of joints, beyond which the linear model is not to be trusted [rad]
  ChainOptions options;
};

template <class Space>
Load<Space> read_load(Context& context) {
  Load<Space> load;
  if (const auto wrench = context.query.optional("wrench")) load.wrench = read_wrench<Space>(*wrench);
  if (auto asked = context.query.optional("until")) {
    const Reader wrench = asked->required("wrench", "the load that is added");
    Until<Space> until{read_wrench<Space>(wrench), 0};
    if (context.errors.empty() && until.direction == Wrench<Space>::Zero())
      wrench.fail("out_of_range", "is the load that is added; not all of its numbers may be zero");
    until.limit =
        asked->required("limit", "how many times the wrench is added at most").number(Range::positive());
    asked->close();
    load.until = until;
  }
  if (const auto threshold = context.query.optional("posture_threshold"))
    load.threshold = threshold->quantity(Dimension::angle, Range::positive());
  if (context.max_iterations) load.options.max_iterations = *context.max_iterations;
  return load;
}

/// Tensions [[T₁, T₂], ...].
std::vector<ChainHold> read_tensions(const Reader& list, std::size_t legs) {
  std::vector<ChainHold> hold(legs);
  const auto items = list.items(legs);
  for (std::size_t i = 0; i < std::min(items.size(), legs); ++i)
    hold[i].tension = items[i].array<2>(Dimension::force, Range::not_negative());
  return hold;
}

/// Lengths [[l₁ or null, l₂ or null], ...]; a tendon without a length is loose.
std::vector<ChainHold> read_lengths(const Reader& list, std::size_t legs) {
  std::vector<ChainHold> hold(legs);
  const auto items = list.items(legs);
  for (std::size_t i = 0; i < std::min(items.size(), legs); ++i) {
    const auto pair = items[i].items(2);
    for (std::size_t k = 0; k < std::min<std::size_t>(pair.size(), 2); ++k) {
      if (pair[k].is(Node::Kind::null)) continue;
      if (hold[i].length_of >= 0)
        items[i].fail(
            "not_available",
            "gives the lengths of both tendons, which contradict one another, or say the same; null "
            "leaves the outer one loose");
      hold[i].length_of = static_cast<int>(k);
      hold[i].length = pair[k].quantity(Dimension::length, Range::positive());
    }
  }
  return hold;
}

template <class Space>
Json chain_legs_json(const ChainRobot<Space>& robot, const ChainState<Space>& state) {
  const auto platform = Space::frame(state.pose);
  Json legs = Json::array(), angles = angles_json<Space>(robot, state.legs);
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const ChainLegState& leg = state.legs[i];
    legs.push_back({{"angles", std::move(angles[i])},
                    {"chord_force", leg.force},
                    {"tendon_lengths", leg.tendon_length},
                    {"tensions", leg.tension},
                    {"tip_wrench",
                     to_json<Space::dof>(tip_wrench(robot.legs[i], leg.of(robot.legs[i].chain), platform))}});
  }
  return legs;
}

/// Left out where it is not finite.
template <class Space>
void put_matrix(Json& answer, const char* key, const Mat<double, Space::dof, Space::dof>& matrix) {
  const Eigen::Matrix<double, Space::dof, Space::dof, Eigen::RowMajor> rows = matrix;
  if (rows.allFinite()) answer[key] = to_json(MatrixView(rows.data(), Space::dof, Space::dof));
}

/// The paper's linear model and constant curvature, beside the answer.
template <class Space>
void put_simpler_models(Context& context, const ChainRobot<Space>& robot, const ChainState<Space>& unloaded,
                        const ChainState<Space>& loaded, const Load<Space>& load, ChainWork& work) {
  Json& answer = context.answer;
  const Vec<double, Space::dof> change = linear_compliance(robot, unloaded) * loaded.wrench,
                                actual = twist_between(unloaded.pose, loaded.pose);
  if (change.allFinite()) answer["linear"] = to_json<Space::dof>(change);
  double scale = 0, gap = 0;
  for (int k = 0; k < Space::dof; ++k) {
    const double unit = k < Space::dimension ? 1 : robot.platform_radius;
    scale += std::pow(unit * actual[k], 2);
    gap += std::pow(unit * (change[k] - actual[k]), 2);
  }
  if (scale > 0 && loaded.wrench != unloaded.wrench)
    put_number(answer, "linear_error", std::sqrt(gap / scale));
  double posture = 0;
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(robot.legs[i].chain.joints()); ++j)
      posture = std::max(posture, std::abs(loaded.legs[i].angles[j] - unloaded.legs[i].angles[j]));
  answer["posture_error"] = posture;
  if (load.threshold) answer["linear_valid"] = posture <= *load.threshold;

  std::size_t held = 0;
  for (const ChainHold& hold : loaded.hold) held += hold.length_of >= 0 ? 1 : 0;
  ChainState<Space> even = unloaded;
  if (held == 0) {
    ChainOptions options = load.options;
    options.evenly_bent = true;
    if (!equilibrium(robot, loaded.hold, loaded.wrench, even, work, options).ok()) return;
  } else if (held == loaded.hold.size()) {
    even.wrench = loaded.wrench;  // whose curvature a length holds does not yield
    even.hold = loaded.hold;
  } else {
    return;
  }
  put_number(answer, "cc_gap", potential(robot, even) - potential(robot, loaded));
  put_number(answer, "cc_gap_estimate", evenness_gap(robot, unloaded, loaded.wrench));
  answer["cc_pose"] = to_json(AnyPose(Space::tidy(even.pose)));
}

/// @param unloaded what simpler models start from, if it is known
template <class Space>
void put_equilibrium(Context& context, const ChainRobot<Space>& robot, const ChainState<Space>& state,
                     Report report, const ChainState<Space>* unloaded, const Load<Space>& load,
                     ChainWork& work) {
  Json& answer = context.answer;
  const bool is_found = is_solved(report);
  const double least = is_found ? judge(robot, state, report) : 0;
  context.report(report);
  answer["iterations"] = report.iterations;
  put_number(answer, "residual", report.residual);
  if (!is_found) return;
  const AnyPose pose = Space::tidy(state.pose);
  context.remember(pose);
  answer["pose"] = to_json(pose);
  answer["legs"] = chain_legs_json(robot, state);
  answer["wrench"] = to_json<Space::dof>(state.wrench);
  put_matrix<Space>(answer, "stiffness", stiffness(robot, state, work));
  put_matrix<Space>(answer, "compliance", compliance(robot, state, work));
  answer["stable"] = least > 0;
  put_number(answer, "smallest_eigenvalue", least);
  put_number(answer, "potential", potential(robot, state));
  if (unloaded) put_simpler_models(context, robot, *unloaded, state, load, work);
}

/// To the load, and on until it grows no more.
template <class Space>
void load_and_answer(Context& context, const ChainRobot<Space>& robot, ChainState<Space>& state,
                     const ChainState<Space>& unloaded, const Load<Space>& load) {
  ChainWork work{.stop = context.work.stop};
  const std::vector<ChainHold> hold = state.hold;
  Report report = equilibrium(robot, hold, load.wrench, state, work, load.options);
  if (report.ok() && load.until) {
    const ChainLoadPath path =
        follow_load(robot, load.until->direction, load.until->limit, state, work, load.options);
    context.answer["load"] = path.load;
    context.answer["why"] = to_string(path.end);
    report = path.report;
  }
  put_equilibrium(context, robot, state, report, &unloaded, load, work);
}

/// Where the search for an equilibrium with given tensions or lengths begins.
template <class Space>
void answer_held(Context& context, ChainRobot<Space>& robot, const AnyPose& start, const Branch& branch,
                 const std::vector<ChainHold>& hold, const Load<Space>& load) {
  ChainState<Space> state;
  ChainWork work{.stop = context.work.stop};
  const Report report = unloaded(context, robot, start, branch, hold, state, work, load.options);
  if (!is_solved(report)) return put_equilibrium<Space>(context, robot, state, report, nullptr, load, work);
  const ChainState<Space> before = state;
  load_and_answer(context, robot, state, before, load);
}

/// Of a pose that is held there is no unloaded one to compare with.
void refuse_threshold(Context& context) {
  context.query.fail("no_effect", "posture_threshold judges a load that moves the platform; remove it");
}

template <class Space>
void answer_statics_of(Context& context, ChainRobot<Space>& robot) {
  Reader& query = context.query;
  const std::size_t legs = robot.legs.size();
  const Branch branch = read_branch(context);
  const Load<Space> load = read_load<Space>(context);
  const auto tensions = query.optional("tensions"), lengths = query.optional("lengths"),
             is_inverse = query.optional("inverse"), hold_word = query.optional("hold");
  auto set_at = query.optional("set_at"), pose = query.optional("pose"), start = query.optional("start");
  const bool inverse_asked = is_inverse && is_inverse->boolean();
  const int ways = (tensions ? 1 : 0) + (lengths ? 1 : 0) + (set_at ? 1 : 0) + (inverse_asked ? 1 : 0);
  if (ways == 0)
    query.fail(
        "missing_key",
        "give tensions, lengths or set_at: a pose at which the tendons are set without load; or inverse: "
        "true with a pose");
  if (ways > 1)
    query.fail("ambiguous", "tensions, lengths, set_at and inverse each say what holds the robot; keep one");
  if (inverse_asked && !pose) query.required("pose", "that the loaded platform is to have");
  if (pose && !inverse_asked) pose->fail("no_effect", "is asked of inverse statics only; add inverse: true");
  if (hold_word && !set_at && !inverse_asked)
    hold_word->fail("no_effect", "says what set_at or inverse leaves held; remove it");
  if (start && !tensions && !lengths)
    start->fail("no_effect", "is where tensions or lengths begin from; remove it");
  if (load.until && inverse_asked)
    query.fail("ambiguous", "until follows a load, inverse holds a pose; keep one");
  if (load.threshold && inverse_asked) refuse_threshold(context);
  const bool holds_lengths = hold_word && hold_word->choice({"tension", "length"}) == "length";
  std::vector<ChainHold> hold;
  if (tensions) hold = read_tensions(*tensions, legs);
  if (lengths) hold = read_lengths(*lengths, legs);
  AnyPose at = home(context.robot);
  for (auto* given : {&set_at, &pose, &start})
    if (*given) at = read_pose(context, std::move(**given));
  if (!context.ready()) return;
  if (!hold.empty()) return answer_held(context, robot, at, branch, hold, load);

  ChainState<Space> state;
  const Report report = rest_at(context, robot, at, branch, holds_lengths, state);
  ChainWork work{.stop = context.work.stop};
  if (!report.ok()) return put_equilibrium<Space>(context, robot, state, report, nullptr, load, work);
  const ChainState<Space> unloaded = state;
  if (!inverse_asked) return load_and_answer(context, robot, state, unloaded, load);
  const Report held = hold_pose(robot, load.wrench, state, work, load.options);
  put_equilibrium<Space>(context, robot, state, held, nullptr, load, work);
}

/// Base motors turn first links, inputs of arcs their tangents or chords: no chain has these.
bool refuse_motors(Context& context, bool has_base_motors) {
  if (has_base_motors)
    context.query.fail(
        "not_available",
        "model prb has no inputs for legs with a motor at the base; ask velocity with angles, or "
        "statics with set_at");
  return has_base_motors;
}

template <class Space>
void answer_forward_of(Context& context, ChainRobot<Space>& robot) {
  const auto inputs = read_inputs(context, context.query.required("inputs", "in leg order"));
  const Load<Space> load = read_load<Space>(context);
  const std::optional<AnyPose> start = read_start(context);
  if (refuse_motors(context, robot.has_base_motors) || !context.ready()) return;
  const HeldInputs held = hold_inputs(context, robot, inputs, start);
  context.remember({});  // until the chains are found
  if (!held.report.ok()) return context.report(held.report);
  answer_held(context, robot, held.pose, held.branch, held.hold, load);
}

template <class Space>
void answer_inverse_of(Context& context, ChainRobot<Space>& robot) {
  auto pose = context.query.required("pose", "pose of the platform");
  const AnyPose at = read_pose(context, std::move(pose));
  const Branch branch = read_branch(context);
  const Load<Space> load = read_load<Space>(context);
  if (load.until)
    context.query.fail("ambiguous", "until follows a load, inverse holds a pose; leave until out");
  if (load.threshold) refuse_threshold(context);
  if (refuse_motors(context, robot.has_base_motors) || !context.ready()) return;
  ChainState<Space> state;
  Report report = rest_at(context, robot, at, branch, true, state);
  ChainWork work{.stop = context.work.stop};
  if (report.ok()) report = hold_pose(robot, load.wrench, state, work, load.options);
  put_equilibrium<Space>(context, robot, state, report, nullptr, load, work);
  if (!is_solved(report)) return;
  Json inputs = Json::array();
  for (const ChainLegState& leg : state.legs) inputs.push_back(leg.tendon_length[0]);
  context.answer["inputs"] = std::move(inputs);
}

template <class Handler>
void on_chains(Context& context, ChainModel law, Handler&& handler) {
  auto robot = read_robot(context, law);
  if (robot) std::visit(handler, *robot);
}

}  // namespace

void answer_statics(Context& context) {
  if (bears_load(context.robot)) return answer_rods_statics(context);
  on_chains(context, read_law(context), [&](auto& robot) { answer_statics_of(context, robot); });
}

void answer_chains_forward(Context& context) {
  on_chains(context, ChainModel::weighted, [&](auto& robot) { answer_forward_of(context, robot); });
}

void answer_chains_inverse(Context& context) {
  on_chains(context, ChainModel::weighted, [&](auto& robot) { answer_inverse_of(context, robot); });
}

}  // namespace sinew::inline v0
