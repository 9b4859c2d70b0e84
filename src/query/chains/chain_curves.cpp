/// `track` of robots on chains with `to`: curves of equilibria along loads and what tendons hold.
#include "io/document/reader.hpp"
#include "kinematics/chains/chain_curve.hpp"
#include "query/chains/chain_answer.hpp"
#include "query/curves.hpp"

namespace sinew::inline v1::chains {
namespace {

template <class Space>
struct ChainCurves : ChainContext<Space> {
  using ChainContext<Space>::ChainContext;
  using ChainContext<Space>::chains;
  using Question::query;

  void read();
  void solve();
  void tell();

 private:
  void read_target();
  Report begin();

  Branch branch_ = {};
  AnyPose at_ = home(this->robot);           ///< where tendons are set, or the search begins
  std::vector<TendonConstraint> hold_ = {};  ///< tensions or lengths; of set_at none
  bool holds_lengths_ = false;
  Wrench<Space> wrench_ = Wrench<Space>::Zero();
  ChainCurveOptions<Space> how_ = {};

  ChainState<Space> state_ = {};
  Report begun_ = {};
  std::vector<ChainCurve<Space>> curves_ = {};
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
void ChainCurves<Space>::read() {
  branch_ = read_branch(*this);
  for (const char* key : {"from", "poses", "angles", "objective", "rk4_steps"})
    if (const auto given = query.optional(key))
      given->fail("ambiguous", "a curve of equilibria (to) begins where tendons are set; remove this");
  hold_ = read_hold(query, chains.legs.size());
  auto set_at = query.optional("set_at"), start = query.optional("start");
  const auto hold_word = query.optional("hold");
  if (hold_.empty() == !set_at && this->errors.empty())
    query.fail(set_at ? "ambiguous" : "missing_key",
               "give one of tensions, lengths or set_at: a pose at which the tendons are set without load");
  if (hold_word && !set_at) hold_word->fail("no_effect", "says what set_at leaves held; remove it");
  if (start && set_at) start->fail("no_effect", "is where tensions or lengths begin from; remove it");
  holds_lengths_ = hold_word && hold_word->choice({"tension", "length"}) == "length";
  for (auto* given : {&set_at, &start})
    if (*given) at_ = read_pose(*this, std::move(**given));
  if (const auto wrench = query.optional("wrench")) wrench_ = read_wrench<Space>(*wrench);
  read_target();
  read_extent(*this, how_);
}

/// What changes along the curve: `to`.
template <class Space>
void ChainCurves<Space>::read_target() {
  Reader to = query.required("to", "{wrench, and tensions or lengths}: what changes along the curve");
  const auto wrench = to.optional("wrench");
  if (wrench) how_.added_wrench = read_wrench<Space>(*wrench) - wrench_;
  how_.hold = read_hold(to, chains.legs.size());
  for (const char* key : {"inputs", "pose", "x", "y", "phi", "position", "quaternion"})
    if (const auto given = to.optional(key))
      given->fail("not_available", "on chains a curve leads to a wrench, tensions or lengths; remove this");
  if (to.is(Node::Kind::map)) {
    if (!wrench && how_.hold.empty())
      to.fail("missing_key", "give wrench, tensions or lengths: what changes along the curve");
    to.close();
  }
}

/// To the equilibrium where the curve begins.
template <class Space>
Report ChainCurves<Space>::begin() {
  ChainWork& memory = work_of(*this);
  ChainOptions options;
  if (this->max_iterations) options.max_iterations = *this->max_iterations;
  const Report rest = hold_.empty()
                          ? rest_at(*this, chains, at_, branch_, holds_lengths_, state_)
                          : unloaded(chains, {at_, arcs_at(twin_of(*this), at_, branch_.options()), hold_},
                                     state_, memory, options);
  if (!is_solved(rest)) return rest;
  return equilibrium(chains, std::vector(state_.hold), wrench_, state_, memory, options);
}

template <class Space>
void ChainCurves<Space>::solve() {
  begun_ = begin();
  if (!is_solved(begun_)) return;
  curves_ = chain_curves(chains, state_, how_, work_of(*this));
  if (curves_.empty())
    query.fail("no_effect",
               "nothing changes between the beginning and `to`, or that holds other tendons, or "
               "lengths that no joints allow; give other values");
}

template <class Space>
void ChainCurves<Space>::tell() {
  this->report(begun_);
  if (curves_.empty()) return;
  put_curves(*this, curves_, [&](const ChainCurvePoint<Space>& point) {
    Value tensions = Value::list();
    for (const ChainLegState& leg : point.state.legs) tensions.push_back(leg.tension);
    return Value{{"pose", pose_value(AnyPose(Space::tidy(point.state.pose)))},
                 {"inputs", Value(inputs_of(twin_of(*this), chains, point.state))},
                 {"tensions", std::move(tensions)}};
  });
}

}  // namespace
}  // namespace sinew::inline v1::chains

namespace sinew::inline v1 {

void answer_chains_curves(Context& context) { chains::answer_chains<chains::ChainCurves>(context); }

}  // namespace sinew::inline v1
