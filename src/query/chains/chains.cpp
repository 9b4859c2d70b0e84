/// Handlers of statics, forward and inverse on pseudo-rigid chains.
#include "query/chains/chains.hpp"

#include <fmt/format.h>

#include "io/reader.hpp"
#include "query/chains/chain_solutions.hpp"

namespace sinew::inline v1 {
namespace chains {

void refuse_open_legs(Context& context, double closure_error) {
  if (closure_error <= 1e-9) return;
  context.query.fail("not_closed",
                     fmt::format("pose and angles contradict each other: a leg misses by {:.3g} "
                                 "m; leave the angles out to have them solved",
                                 closure_error));
}

std::vector<TendonConstraint> read_lengths(const Reader& list, std::size_t legs) {
  std::vector<TendonConstraint> hold(legs);
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

std::vector<TendonConstraint> read_tensions(const Reader& list, std::size_t legs) {
  std::vector<TendonConstraint> hold(legs);
  const auto items = list.items(legs);
  for (std::size_t i = 0; i < std::min(items.size(), legs); ++i)
    hold[i].tension = items[i].array<2>(Dimension::force, Range::not_negative());
  return hold;
}

}  // namespace chains

namespace {

using namespace chains;

/// To the load, and on until it grows no more.
template <class Space>
void load_and_answer(Context& context, const ChainLegs<Space>& robot, ChainState<Space>& state,
                     const ChainState<Space>& unloaded, const Load<Space>& load) {
  ChainWork& work = work_of(context);
  const std::vector<TendonConstraint> hold = state.hold;
  Report report = equilibrium(robot, hold, load.wrench, state, work, load.options);
  if (report.ok() && load.until) {
    const ChainLoadPath path =
        follow_load(robot, load.until->direction, load.until->limit, state, work, load.options);
    put_growth(context.answer, path);
    report = path.report;
  }
  put_equilibrium(context, robot, state, report, &unloaded, load, work);
}

/// Where the search for an equilibrium with given tensions or lengths begins.
template <class Space>
void answer_held(Context& context, ChainLegs<Space>& robot, const HeldInputs& held, const Load<Space>& load) {
  ChainState<Space> state;
  ChainWork& work = work_of(context);
  const Report report = unloaded(robot, held, state, work, load.options);
  if (!is_solved(report)) return put_equilibrium<Space>(context, robot, state, report, nullptr, load, work);
  const ChainState<Space> before = state;
  load_and_answer(context, robot, state, before, load);
}

/// Of a pose that is held there is no unloaded one to compare with.
void refuse_threshold(Context& context) {
  context.query.fail("no_effect", "posture_threshold judges a load that moves the platform; remove it");
}

template <class Space>
struct ChainStatics {
  Branch branch;
  Load<Space> load;
  std::vector<TendonConstraint> hold;  ///< tensions or lengths; none where tendons are set at a pose
  AnyPose at;                          ///< where tendons are set, or held, or the search begins
  bool is_inverse = false, holds_lengths = false;

  static ChainStatics read(ChainContext<Space>& context) {
    Reader& query = context.query;
    const std::size_t legs = context.chains.legs.size();
    ChainStatics asked{read_branch(context), read_load<Space>(context), {}, home(context.robot)};
    const Load<Space>& load = asked.load;
    const auto tensions = query.optional("tensions"), lengths = query.optional("lengths"),
               is_inverse = query.optional("inverse"), hold_word = query.optional("hold");
    auto set_at = query.optional("set_at"), pose = query.optional("pose"), start = query.optional("start");
    asked.is_inverse = is_inverse && is_inverse->boolean();
    const int ways = (tensions ? 1 : 0) + (lengths ? 1 : 0) + (set_at ? 1 : 0) + (asked.is_inverse ? 1 : 0);
    if (ways == 0)
      query.fail(
          "missing_key",
          "give tensions, lengths or set_at: a pose at which the tendons are set without load; or inverse: "
          "true with a pose");
    if (ways > 1)
      query.fail("ambiguous",
                 "tensions, lengths, set_at and inverse each say what holds the robot; keep one");
    if (asked.is_inverse && !pose) query.required("pose", "that the loaded platform is to have");
    if (pose && !asked.is_inverse)
      pose->fail("no_effect", "is asked of inverse statics only; add inverse: true");
    if (hold_word && !set_at && !asked.is_inverse)
      hold_word->fail("no_effect", "says what set_at or inverse leaves held; remove it");
    if (start && !tensions && !lengths)
      start->fail("no_effect", "is where tensions or lengths begin from; remove it");
    if (load.until && asked.is_inverse)
      query.fail("ambiguous", "until follows a load, inverse holds a pose; keep one");
    if (load.threshold && asked.is_inverse) refuse_threshold(context);
    asked.holds_lengths = hold_word && hold_word->choice({"tension", "length"}) == "length";
    if (tensions) asked.hold = read_tensions(*tensions, legs);
    if (lengths) asked.hold = read_lengths(*lengths, legs);
    for (auto* given : {&set_at, &pose, &start})
      if (*given) asked.at = read_pose(context, std::move(**given));
    return asked;
  }

  static void answer(ChainContext<Space>& context, const ChainStatics& asked) {
    ChainLegs<Space>& robot = context.chains;
    const Load<Space>& load = asked.load;
    if (!asked.hold.empty()) {
      const HeldInputs held{asked.at, arcs_at(twin_of(context), asked.at, asked.branch.options()),
                            asked.hold};
      return answer_held(context, robot, held, load);
    }
    ChainState<Space> state;
    const Report report = rest_at(context, robot, asked.at, asked.branch, asked.holds_lengths, state);
    ChainWork& work = work_of(context);
    if (!report.ok()) return put_equilibrium<Space>(context, robot, state, report, nullptr, load, work);
    const ChainState<Space> unloaded = state;
    if (!asked.is_inverse) return load_and_answer(context, robot, state, unloaded, load);
    const Report held = inverse_statics(robot, load.wrench, state, work, load.options);
    put_equilibrium<Space>(context, robot, state, held, nullptr, load, work);
  }
};

template <class Space>
struct ChainForward {
  std::vector<double> inputs;
  Load<Space> load;
  std::optional<AnyPose> start;
  bool wants_all = false;

  static ChainForward read(ChainContext<Space>& context) {
    ChainForward asked;
    asked.inputs = read_inputs(context, context.query.required("inputs", "in leg order"));
    asked.load = read_load<Space>(context);
    asked.start = read_start(context);
    asked.wants_all = read_all(context);
    if (asked.wants_all && asked.load.until)
      context.query.fail("ambiguous", "until follows one equilibrium, all finds many; keep one");
    return asked;
  }

  static void answer(ChainContext<Space>& context, const ChainForward& asked) {
    const HeldInputs held =
        hold_inputs(context, context.chains, asked.inputs, asked.start ? asked.start : context.path_start());
    context.remember({});  // until the chains are found
    if (!held.arcs.report.ok()) return context.report(held.arcs.report);
    answer_held(context, context.chains, held, asked.load);
    if (asked.wants_all) put_all_equilibria(context, context.chains, held, asked.inputs, asked.load);
  }
};

template <class Space>
struct ChainInverse {
  AnyPose at;
  Branch branch;
  Load<Space> load;
  bool wants_all = false;

  static ChainInverse read(ChainContext<Space>& context) {
    auto pose = context.query.required("pose", "pose of the platform");
    ChainInverse asked{read_pose(context, std::move(pose)), read_branch(context), read_load<Space>(context)};
    if (asked.load.until)
      context.query.fail("ambiguous", "until follows a load, inverse holds a pose; leave until out");
    if (asked.load.threshold) refuse_threshold(context);
    asked.wants_all = read_all(context);
    return asked;
  }

  static void answer(ChainContext<Space>& context, const ChainInverse& asked) {
    ChainLegs<Space>& robot = context.chains;
    const Load<Space>& load = asked.load;
    ChainState<Space> state;
    Report report = rest_at(context, robot, asked.at, asked.branch, true, state);
    ChainWork& work = work_of(context);
    if (report.ok()) report = inverse_statics(robot, load.wrench, state, work, load.options);
    put_equilibrium<Space>(context, robot, state, report, nullptr, load, work);
    if (is_solved(report)) context.answer["inputs"] = Value(inputs_of(twin_of(context), robot, state));
    if (asked.wants_all) put_all_inverses(context, robot, asked.at, asked.branch, load);
  }
};

void answer_statics(Context& context) {
  if (context.query.has("measured_tensions"))
    answer_chains_sensing(context);
  else
    handle_chains<ChainStatics>(context);
}

}  // namespace

constexpr Handlers chain_handlers{.robots = "pseudo-rigid chains",
                                  .wants = equilibrium_wants,
                                  .answers = {.forward = handle_chains<ChainForward>,
                                              .inverse = handle_chains<ChainInverse>,
                                              .velocity = answer_chains_velocity,
                                              .shape = answer_chains_shape,
                                              .statics = answer_statics,
                                              .track = answer_chains_track,
                                              .describe = tell<describe_platform>}};

}  // namespace sinew::inline v1
