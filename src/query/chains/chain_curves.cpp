/// `track` of robots on chains with `to`: curves of equilibria along loads and what tendons hold.
#include "io/reader.hpp"
#include "kinematics/chains/chain_curve.hpp"
#include "query/chains/chain_answer.hpp"
#include "query/curves.hpp"

namespace sinew::inline v1::chains {
namespace {

template <class Space>
struct ChainCurves {
  Branch branch;
  AnyPose at;                               ///< where tendons are set, or the search begins
  std::vector<TendonConstraint> hold = {};  ///< tensions or lengths; of set_at none
  bool holds_lengths = false;
  Wrench<Space> wrench = Wrench<Space>::Zero();
  ChainCurveOptions<Space> how = {};

  static ChainCurves read(ChainContext<Space>& context);
  static void answer(ChainContext<Space>& context, const ChainCurves& asked);
};

/// Tensions or lengths of the tendons, if given.
std::vector<TendonConstraint> read_hold(Reader& query, std::size_t legs) {
  const auto tensions = query.optional("tensions"), lengths = query.optional("lengths");
  if (tensions && lengths)
    query.fail("ambiguous", "tensions and lengths each say what holds the robot; keep one");
  if (tensions) return read_tensions(*tensions, legs);
  return lengths ? read_lengths(*lengths, legs) : std::vector<TendonConstraint>();
}

template <class Space>
ChainCurves<Space> ChainCurves<Space>::read(ChainContext<Space>& context) {
  Reader& query = context.query;
  const std::size_t legs = context.chains.legs.size();
  ChainCurves asked{read_branch(context), home(context.robot)};
  for (const char* key : {"from", "poses", "angles", "objective", "rk4_steps"})
    if (const auto given = query.optional(key))
      given->fail("ambiguous", "a curve of equilibria (to) begins where tendons are set; remove this");
  asked.hold = read_hold(query, legs);
  auto set_at = query.optional("set_at"), start = query.optional("start");
  const auto hold_word = query.optional("hold");
  if (asked.hold.empty() == !set_at && context.errors.empty())
    query.fail(set_at ? "ambiguous" : "missing_key",
               "give one of tensions, lengths or set_at: a pose at which the tendons are set without load");
  if (hold_word && !set_at) hold_word->fail("no_effect", "says what set_at leaves held; remove it");
  if (start && set_at) start->fail("no_effect", "is where tensions or lengths begin from; remove it");
  asked.holds_lengths = hold_word && hold_word->choice({"tension", "length"}) == "length";
  for (auto* given : {&set_at, &start})
    if (*given) asked.at = read_pose(context, std::move(**given));
  if (const auto wrench = query.optional("wrench")) asked.wrench = read_wrench<Space>(*wrench);
  Reader to = query.required("to", "{wrench, and tensions or lengths}: what changes along the curve");
  const auto wrench = to.optional("wrench");
  if (wrench) asked.how.added_wrench = read_wrench<Space>(*wrench) - asked.wrench;
  asked.how.hold = read_hold(to, legs);
  for (const char* key : {"inputs", "pose", "x", "y", "phi", "position", "quaternion"})
    if (const auto given = to.optional(key))
      given->fail("not_available", "on chains a curve leads to a wrench, tensions or lengths; remove this");
  if (to.is(Node::Kind::map)) {
    if (!wrench && asked.how.hold.empty())
      to.fail("missing_key", "give wrench, tensions or lengths: what changes along the curve");
    to.close();
  }
  read_extent(context, asked.how);
  return asked;
}

/// The equilibrium where the curve begins.
template <class Space>
Report begin(Context& context, ChainLegs<Space>& robot, const ChainCurves<Space>& asked,
             ChainState<Space>& state, ChainWork& work) {
  ChainOptions options;
  if (context.max_iterations) options.max_iterations = *context.max_iterations;
  const Report report =
      asked.hold.empty()
          ? rest_at(context, robot, asked.at, asked.branch, asked.holds_lengths, state)
          : unloaded(robot,
                     {asked.at, arcs_at(twin_of(context), asked.at, asked.branch.options()), asked.hold},
                     state, work, options);
  if (!is_solved(report)) return report;
  return equilibrium(robot, std::vector(state.hold), asked.wrench, state, work, options);
}

template <class Space>
void ChainCurves<Space>::answer(ChainContext<Space>& context, const ChainCurves& asked) {
  ChainLegs<Space>& robot = context.chains;
  ChainState<Space> state;
  ChainWork& work = work_of(context);
  const Report report = begin(context, robot, asked, state, work);
  context.report(report);
  if (!is_solved(report)) return;
  const auto curves = chain_curves(robot, state, asked.how, work);
  if (curves.empty())
    return context.query.fail(
        "no_effect",
        "nothing changes between the beginning and `to`, or that holds other tendons, or "
        "lengths that no joints allow; give other values");
  put_curves(context, curves, [&](const ChainCurvePoint<Space>& point) {
    Value tensions = Value::list();
    for (const ChainLegState& leg : point.state.legs) tensions.push_back(leg.tension);
    return Value{{"pose", pose_value(AnyPose(Space::tidy(point.state.pose)))},
                 {"inputs", Value(inputs_of(twin_of(context), robot, point.state))},
                 {"tensions", std::move(tensions)}};
  });
}

}  // namespace
}  // namespace sinew::inline v1::chains

namespace sinew::inline v1 {

void answer_chains_curves(Context& context) { chains::handle_chains<chains::ChainCurves>(context); }

}  // namespace sinew::inline v1
