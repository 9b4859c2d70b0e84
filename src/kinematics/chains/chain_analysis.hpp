/// @file chain_analysis.hpp
/// What is known of an equilibrium of chains beside where it is: stability, margins, and what inputs do to
/// it. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include "kinematics/chains/chain.hpp"

namespace sinew::inline v1 {

/// By the second variation of the energy along what closures and held lengths leave free.
template <class Space>
struct ChainStability {
  double smallest_eigenvalue;   ///< infinite where nothing is free; of a state that does not fit NaN
  int unstable_directions = 0;  ///< eigenvalues below 0
  std::vector<Vec<double, Space::dof>> unstable;  ///< twists along which the platform's stiffness is negative
  std::vector<int> unstable_legs;                 ///< that do not hold by themselves with the platform held

  bool is_stable() const { return smallest_eigenvalue > 0; }
};
/// Twists have length 1, turns times the longest chain. Allocates.
template <class Space>
ChainStability<Space> check_stability(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                      ChainWork& work);

/// The same of a solved equilibrium; its report becomes `unstable` where it does not hold by itself.
template <class Space>
ChainStability<Space> note_stability(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                     ChainWork& work, Report& report) {
  ChainStability<Space> found = check_stability(robot, state, work);
  if (report.ok() && !found.is_stable()) {
    report.status = Status::unstable;
    report.message.append("the equilibrium does not hold by itself: smallest_eigenvalue is not above 0");
  }
  return found;
}

struct ChainMargins {
  double fold;    ///< smallest singular value of the platform's stiffness over the largest: 0 at a fold
  double strain;  ///< largest of bending, of any backbone: κ d/2; NaN where no diameter is known
};
template <class Space>
ChainMargins margins(const ChainLegs<Space>& robot, const ChainState<Space>& state, ChainWork& work);

/// A column for each of what the state holds, leg by leg: the angle of the base motor where there is one,
/// then the length of a tendon, or the tensions of both.
template <class Space>
using ByInputs = Eigen::Matrix<double, Space::dof, Eigen::Dynamic>;
/// ∂(wrench needed)/∂(inputs), the platform resting. Allocates.
template <class Space>
ByInputs<Space> input_wrench_jacobian(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                      ChainWork& work);
/// ∂(pose)/∂(inputs) at fixed wrench, twist order. Allocates.
template <class Space>
ByInputs<Space> input_sensitivity(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                  ChainWork& work);

}  // namespace sinew::inline v1
