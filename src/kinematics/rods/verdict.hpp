/// @file verdict.hpp
/// What is said of an equilibrium that was found, or of a path that ended before it.
#pragma once
#include "kinematics/rods/trace.hpp"

namespace sinew::inline v1 {

/// Estimated error of a shape at its tip, over the length, beyond which an answer is refused.
inline constexpr double worst_truncation = 1e-10;

/// A report of nothing but its status.
Report failed(Status status);

/// Appends to the message, after what stands there already.
void say(Report& report, std::string_view text);

/// Whether a rod is about to be pulled straight.
bool is_pulled_straight(const RodGroup& system);

/// Why no step along a curve succeeds. @tparam End CurveEnd or LoadEnd
template <class End>
End why_stuck(const RodGroup& system) {
  if (system.is_finest() && system.truncation() > coarse_truncation) return End::sharp;
  return is_pulled_straight(system) ? End::straight : End::stalled;
}

/// Why a path ended early; the system is at its last equilibrium. Says "fold" only of one that was found.
Report explain(const RodGroup& system, const RodPathEnd& end, const RodFold& fold, bool is_load);

/// Names an input that its leg cannot have.
Report beyond_domain(const RodGroup& system, int feed);

/// Of a solved state: false, and named, where an input of a closing leg is beyond what the leg can do.
bool is_in_domain(const RodGroup& system, Report& report);

/// The shapes of a solved state to this estimate of their error, by the fine nodes where it takes them. False
/// where those do not do it.
bool resolve(RodGroup& system, Report& report, double truncation);

/// Signs of a state that was linearised; each rod is asked once while the work knows that the state stays.
LimbSigns count_unstable_rods(RodWork& work);

/// What holds of a solved state: shapes resolved, platform's stiffness known there, stability, which the work
/// then knows.
Report settle(RodWork& work, Report report, double truncation);

}  // namespace sinew::inline v1
