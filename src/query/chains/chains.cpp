/// `forward`, `inverse` and `statics` of pseudo-rigid chains.
#include "query/chains/chains.hpp"

#include <fmt/format.h>

#include "io/document/reader.hpp"
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

/// Forward, inverse and statics: an equilibrium.
template <class Space>
struct ChainQuestion : ChainContext<Space> {
  using ChainContext<Space>::ChainContext;
  using ChainContext<Space>::chains;
  using Question::query, Question::answer, Question::ask;

  std::optional<Until<Space>> until = {};
  bool wants_all = false;

  void read();
  void solve();
  void tell();
  void tell_all();

 private:
  void read_statics();
  void solve_held();
  void bear();

  /// @name What was read
  /// @{
  std::vector<double> inputs_ = {};  ///< of `forward`
  std::optional<AnyPose> start_ = {};
  Branch branch_ = {};
  AnyPose at_ = home(this->robot);  ///< where tendons are set, or the platform is held, or the search begins
  std::vector<TendonConstraint> hold_ = {};  ///< of `statics`: tensions or lengths
  bool is_inverse_ = false;                  ///< the platform is held at `at_`
  bool holds_lengths_ = false;               ///< there tendons keep their lengths, not their tensions
  Load<Space> load_ = {};
  /// @}

  /// @name What was found
  /// @{
  HeldInputs held_ = {};
  ChainState<Space> state_ = {};
  std::optional<ChainState<Space>> unloaded_ = {};  ///< where simpler models begin
  std::optional<ChainLoadPath> growth_ = {};
  Report found_ = {};
  /// @}
};

template <class Space>
void ChainQuestion<Space>::read_statics() {
  branch_ = read_branch(*this);
  const auto tensions = query.optional("tensions"), lengths = query.optional("lengths"),
             inverse = query.optional("inverse"), hold_word = query.optional("hold");
  auto set_at = query.optional("set_at"), pose = query.optional("pose"), start = query.optional("start");
  is_inverse_ = inverse && inverse->boolean();
  const int ways = (tensions ? 1 : 0) + (lengths ? 1 : 0) + (set_at ? 1 : 0) + (is_inverse_ ? 1 : 0);
  if (ways == 0)
    query.fail(
        "missing_key",
        "give tensions, lengths or set_at: a pose at which the tendons are set without load; or inverse: "
        "true with a pose");
  if (ways > 1)
    query.fail("ambiguous", "tensions, lengths, set_at and inverse each say what holds the robot; keep one");
  if (is_inverse_ && !pose) query.required("pose", "that the loaded platform is to have");
  if (pose && !is_inverse_) pose->fail("no_effect", "is asked of inverse statics only; add inverse: true");
  if (hold_word && !set_at && !is_inverse_)
    hold_word->fail("no_effect", "says what set_at or inverse leaves held; remove it");
  if (start && !tensions && !lengths)
    start->fail("no_effect", "is where tensions or lengths begin from; remove it");
  holds_lengths_ = hold_word && hold_word->choice({"tension", "length"}) == "length";
  if (tensions) hold_ = read_tensions(*tensions, chains.legs.size());
  if (lengths) hold_ = read_lengths(*lengths, chains.legs.size());
  for (auto* given : {&set_at, &pose, &start})
    if (*given) at_ = read_pose(*this, std::move(**given));
}

template <class Space>
void ChainQuestion<Space>::read() {
  if (ask == Ask::forward) {
    inputs_ = read_inputs(*this, query.required("inputs", "in leg order"));
    start_ = read_start(*this);
  } else if (ask == Ask::inverse) {
    at_ = read_pose(*this, query.required("pose", "pose of the platform"));
    branch_ = read_branch(*this);
    is_inverse_ = holds_lengths_ = true;
  } else {
    read_statics();
  }
  load_ = read_load<Space>(*this);
  until = read_until<Space>(*this);
  if (ask != Ask::statics) wants_all = read_all(*this, until.has_value());
  if (!is_inverse_) return;
  if (until) query.fail("ambiguous", "until follows a load, inverse holds a pose; leave until out");
  if (load_.threshold)
    query.fail("no_effect", "posture_threshold judges a load that moves the platform; remove it");
}

/// To the load from where there is none, and on until it grows no more.
template <class Space>
void ChainQuestion<Space>::bear() {
  ChainWork& memory = work_of(*this);
  unloaded_ = state_;
  const std::vector<TendonConstraint> hold = state_.hold;
  found_ = equilibrium(chains, hold, load_.wrench, state_, memory, load_.options);
  if (!found_.ok() || !until) return;
  growth_ = follow_load(chains, until->direction, until->limit, state_, memory, load_.options);
  found_ = growth_->report;
}

template <class Space>
void ChainQuestion<Space>::solve_held() {
  found_ = unloaded(chains, held_, state_, work_of(*this), load_.options);
  if (is_solved(found_)) bear();
}

template <class Space>
void ChainQuestion<Space>::solve() {
  if (ask == Ask::forward) {
    held_ = hold_inputs(*this, chains, inputs_, start_ ? start_ : this->path_start());
    this->remember({});  // until the chains are found
    if (held_.arcs.report.ok()) solve_held();
  } else if (!hold_.empty()) {
    held_ = {at_, arcs_at(twin_of(*this), at_, branch_.options()), hold_};
    solve_held();
  } else {
    found_ = rest_at(*this, chains, at_, branch_, holds_lengths_, state_);
    if (!found_.ok()) return;
    if (is_inverse_)
      found_ = inverse_statics(chains, load_.wrench, state_, work_of(*this), load_.options);
    else
      bear();
  }
}

template <class Space>
void ChainQuestion<Space>::tell() {
  if (ask == Ask::forward && !held_.arcs.report.ok()) return this->report(held_.arcs.report);
  if (growth_) put_growth(answer, *growth_);
  put_equilibrium<Space>(*this, chains, state_, found_, unloaded_ ? &*unloaded_ : nullptr, load_,
                         work_of(*this));
  if (ask == Ask::inverse && is_solved(found_))
    answer["inputs"] = Value(inputs_of(twin_of(*this), chains, state_));
}

template <class Space>
void ChainQuestion<Space>::tell_all() {
  if (ask == Ask::inverse)
    put_all_inverses(*this, chains, at_, branch_, load_);
  else if (held_.arcs.report.ok())
    put_all_equilibria(*this, chains, held_, inputs_, load_);
}

void answer_statics(Context& context) {
  if (context.query.has("measured_tensions"))
    answer_chains_sensing(context);
  else
    answer_chains<ChainQuestion>(context);
}

}  // namespace

constexpr Handlers chain_handlers{.robots = "pseudo-rigid chains",
                                  .wants = equilibrium_wants,
                                  .answers = {.forward = answer_chains<ChainQuestion>,
                                              .inverse = answer_chains<ChainQuestion>,
                                              .velocity = answer_chains_velocity,
                                              .shape = answer_chains_shape,
                                              .statics = answer_statics,
                                              .track = answer_chains_track,
                                              .describe = describe_platform}};

}  // namespace sinew::inline v1
