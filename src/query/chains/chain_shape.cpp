/// `shape` of pseudo-rigid chains.
#include "analysis/chain_shape.hpp"
#include "io/document/reader.hpp"
#include "query/chains/chains.hpp"

namespace sinew::inline v1 {
namespace {

using namespace chains;

/// Chains that are to be drawn.
template <class Space>
struct ChainDrawing : ChainContext<Space> {
  using ChainContext<Space>::ChainContext;
  using ChainContext<Space>::chains;
  using Question::query, Question::answer;

  void read();
  void solve();
  void tell();

 private:
  Report rest_under();

  Configuration at_ = {};
  Joints<Space> joints_ = {};
  std::optional<Wrench<Space>> wrench_ = {};
  ChainOptions options_ = {};

  ChainState<Space> state_ = {};
  Report found_ = {};
  bool is_found_ = false;  ///< also where it does not hold by itself
};

template <class Space>
void ChainDrawing<Space>::read() {
  at_ = read_configuration(*this);
  joints_ = read_joints(*this, chains, at_.branch);
  if (const auto wrench = query.optional("wrench")) {
    wrench_ = read_wrench<Space>(*wrench);
    if (joints_.are_given())
      wrench->fail("no_effect", "has no effect: the angles say how the chains are bent; remove it");
  }
  if (this->max_iterations) options_.max_iterations = *this->max_iterations;
  if (const auto samples = query.optional("samples"))
    samples->fail("no_effect", "has no effect: a chain is drawn by its joints; remove it");
  if (joints_.are_given()) query.required("pose", "that the chains of these angles lead to");
  if (at_.at.pose && at_.inputs)
    query.fail("ambiguous", "pose and inputs both say where the platform is; keep one");
}

/// Rests under the wrench as `forward` has it from inputs, as `inverse` from a pose.
template <class Space>
Report ChainDrawing<Space>::rest_under() {
  ChainWork& memory = work_of(*this);
  const Wrench<Space> wrench = wrench_.value_or(Wrench<Space>::Zero());
  if (!at_.inputs) {
    const Report rest = rest_at(*this, chains, *at_.at.pose, at_.branch, true, state_);
    return rest.ok() ? inverse_statics(chains, wrench, state_, memory, options_) : rest;
  }
  const HeldInputs held = hold_inputs(*this, chains, *at_.inputs, at_.start ? at_.start : this->path_start());
  const Report rest = unloaded(chains, held, state_, memory, options_);
  return is_solved(rest) ? equilibrium(chains, held.hold, wrench, state_, memory, options_) : rest;
}

template <class Space>
void ChainDrawing<Space>::solve() {
  if (joints_.are_given()) {
    state_.pose = std::get<typename Space::Pose>(*at_.at.pose);
    found_ = joints_.at(*this, chains, *at_.at.pose, state_.legs);
    refuse_open_legs(*this, chain_rates(chains, state_.pose, state_.legs).closure_error);
  } else {
    found_ = rest_under();
  }
  is_found_ = is_solved(found_);
  if (is_found_ && !joints_.are_given()) note_stability(chains, state_, work_of(*this), found_);
  this->remember(is_found_ ? std::optional<AnyPose>(Space::tidy(state_.pose)) : std::nullopt);
}

template <class Space>
void ChainDrawing<Space>::tell() {
  this->report(found_);
  if (!is_found_) return;
  const AnyPose pose = Space::tidy(state_.pose);
  answer["pose"] = pose_value(pose);
  put_shape(answer, chain_shape(chains, state_.pose, state_.legs));
  answer["frames"] = Value::list({pose_value(pose)});
}

}  // namespace

void answer_chains_shape(Context& context) { answer_chains<ChainDrawing>(context); }

}  // namespace sinew::inline v1
