/// All solutions of chains that are found.
#include "query/chains/chain_solutions.hpp"

#include <fmt/format.h>

#include "kinematics/chains/solutions.hpp"

namespace sinew::inline v1::chains {
namespace {

template <class Space>
Value solution_value(Value begun, const ChainLegs<Space>& robot, const FoundChains<Space>& one) {
  begun["residual"] = one.report.residual;
  begun["stable"] = one.stability.is_stable();
  begun["unstable_directions"] = one.stability.unstable_directions;
  put_number(begun, "potential", one.potential);
  if (!one.report.ok()) begun["slack"] = true;
  begun["legs"] = chain_legs_value(robot, one.state);
  return begun;
}

}  // namespace

template <class Space>
void put_all_equilibria(Context& context, const ChainLegs<Space>& robot, const HeldInputs& held,
                        std::span<const double> inputs, const Load<Space>& load) {
  Value solutions = Value::list();
  for (const auto& one : equilibria_of_inputs(twin_of(context), robot, held, inputs, load.wrench,
                                              work_of(context), load.options))
    solutions.push_back(
        solution_value({{"pose", pose_value(AnyPose(Space::tidy(one.state.pose)))}}, robot, one));
  put_solutions(context, context.work.stop, std::move(solutions));
}

template <class Space>
void put_all_inverses(Context& context, const ChainLegs<Space>& robot, const AnyPose& pose,
                      const Branch& branch, const Load<Space>& load) {
  const AllChainsAtPose<Space> all = equilibria_at_pose(twin_of(context), robot, pose, branch.options(),
                                                        load.wrench, work_of(context), load.options);
  if (all.branches > max_branches)
    context.answer["message"] =
        fmt::format("{:.0f} branches exist; the first {:.0f} were tried", all.branches, max_branches);
  Value solutions = Value::list();
  for (const ChainsAtPose<Space>& one : all.found)
    solutions.push_back(solution_value<Space>({{"inputs", Value(one.inputs)}}, one.robot, one));
  put_solutions(context, context.work.stop, std::move(solutions));
}

#define SINEW_OF(Space)                                                                            \
  template void put_all_equilibria(Context&, const ChainLegs<Space>&, const HeldInputs&,           \
                                   std::span<const double>, const Load<Space>&);                   \
  template void put_all_inverses(Context&, const ChainLegs<Space>&, const AnyPose&, const Branch&, \
                                 const Load<Space>&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1::chains
