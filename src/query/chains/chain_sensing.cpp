/// `statics` of pseudo-rigid chains with tensions that are measured.
#include "kinematics/chains/chain_sensing.hpp"

#include <fmt/format.h>

#include "io/document/reader.hpp"
#include "kinematics/chains/chain_sensing.hpp"
#include "kinematics/effort_sensor.hpp"
#include "query/chains/chain_answer.hpp"

namespace sinew::inline v1::chains {
namespace {

struct SensingQuery {
  Branch branch;
  std::optional<AnyPose> start;
  std::vector<double> inputs;          ///< or else
  std::vector<TendonConstraint> hold;  ///< lengths
  std::vector<MeasuredTension> measured;
  std::vector<double> deviations;  ///< of these, or none
};

/// [T or null per leg], of the tendons whose lengths are held.
std::vector<MeasuredTension> read_measured(const Reader& list, const SensingQuery& asked, std::size_t legs,
                                           std::size_t freedoms) {
  std::vector<MeasuredTension> measured;
  const auto items = list.items(legs);
  for (std::size_t i = 0; i < std::min(items.size(), legs); ++i) {
    if (items[i].is(Node::Kind::null)) continue;
    if (i < asked.hold.size() && asked.hold[i].length_of < 0)
      items[i].fail("no_effect", "is measured of a leg without a length; give lengths of it, or null");
    measured.push_back({static_cast<int>(i), items[i].quantity(Dimension::force, Range::between(-1e9, 1e9))});
  }
  if (items.size() == legs && measured.size() != freedoms)
    list.fail("out_of_range",
              fmt::format("has {} tensions; a wrench of this platform is told by {}, null leaves a leg out",
                          measured.size(), freedoms));
  return measured;
}

SensingQuery read_sensing(Context& context, std::size_t legs, std::size_t freedoms) {
  Reader& query = context.query;
  SensingQuery asked{read_branch(context), {}, {}, {}, {}, {}};
  for (const char* key :
       {"wrench", "until", "tensions", "set_at", "inverse", "pose", "hold", "posture_threshold"})
    if (const auto given = query.optional(key))
      given->fail("ambiguous", "measured_tensions with lengths say what the load is; remove this");
  const auto inputs = query.optional("inputs");
  if (inputs && query.has("lengths"))
    query.fail("ambiguous", "inputs and lengths both say what is held; keep one");
  if (inputs && !asked.branch.is_default())
    query.fail("ambiguous", "a branch chooses among shapes of one pose; inputs have theirs, leave it out");
  if (inputs)
    asked.inputs = read_inputs(context, *inputs);
  else
    asked.hold = read_lengths(query.required("lengths", "at which the tendons are held; or inputs"), legs);
  asked.measured =
      read_measured(query.required("measured_tensions", "a tension a leg"), asked, legs, freedoms);
  if (const auto deviation = query.optional("deviation"))
    asked.deviations = read_forces(*deviation, freedoms, Range::not_negative(), true);
  if (auto start = query.optional("start")) asked.start = read_pose(context, std::move(*start));
  return asked;
}

/// What is held, and where the search for it begins.
template <class Space>
HeldInputs held_of(Context& context, const ChainLegs<Space>& robot, const SensingQuery& asked) {
  if (!asked.inputs.empty()) return hold_inputs(context, robot, asked.inputs, asked.start);
  const AnyPose start = asked.start.value_or(home(context.robot));
  return {start, arcs_at(twin_of(context), start, asked.branch.options()), asked.hold};
}

template <class Space>
struct ChainSensing : ChainContext<Space> {
  using ChainContext<Space>::ChainContext;
  using ChainContext<Space>::chains;

  void read() {
    at_ = read_sensing(*this, chains.legs.size(), static_cast<std::size_t>(Space::dof));
    load_.wanted = read_wants_of_loads(*this);
    load_.twist = read_twist<Space>(*this, load_.wanted);
    if (this->max_iterations) load_.options.max_iterations = *this->max_iterations;
  }

  void solve() {
    ChainWork& memory = work_of(*this);
    sensed_.report = unloaded(chains, held_of(*this, chains, at_), state_, memory, load_.options);
    if (is_solved(sensed_.report))
      sensed_ = sense_wrench(chains, at_.measured, state_, memory, load_.options);
  }

  void tell() {
    put_equilibrium<Space>(*this, chains, state_, sensed_.report, nullptr, load_, work_of(*this));
    if (!is_solved(sensed_.report)) return;
    put_matrix<Space>(this->answer, "wrench_sensitivity", sensed_.sensitivity);
    if (at_.deviations.empty()) return;
    put_matrix<Space>(this->answer, "covariance",
                      covariance_of<Space::dof>(sensed_.sensitivity, at_.deviations));
  }

 private:
  SensingQuery at_ = {};
  Load<Space> load_ = {};  ///< of which only what is wanted is given
  ChainState<Space> state_ = {};
  SensedLoad<Space> sensed_ = {};
};

}  // namespace

}  // namespace sinew::inline v1::chains

namespace sinew::inline v1 {

void answer_chains_sensing(Context& context) { chains::answer_chains<chains::ChainSensing>(context); }

}  // namespace sinew::inline v1
