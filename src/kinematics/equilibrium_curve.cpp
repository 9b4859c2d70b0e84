#include "sinew/kinematics/equilibrium_curve.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/chains/questions.hpp"
#include "kinematics/rods/question.hpp"
#include "kinematics/rods/start.hpp"
#include "kinematics/rods/trace.hpp"
#include "robot/arguments.hpp"

namespace sinew::inline v1 {
namespace {

bool is_answerable(const Robot& robot, const CurveOptions& how) {
  const auto inputs = static_cast<std::size_t>(input_count(robot));
  if (!how.inputs.empty() && how.inputs.size() != inputs) return false;
  if (how.pose && (inputs != 6 || has_ties(robot) || !how.inputs.empty())) return false;
  if (how.pose && !SE3<double>::from(*how.pose).p.allFinite()) return false;
  return how.added_wrench.allFinite() && how.lowest <= 0 && how.highest >= 0 && how.max_points > 0 &&
         how.max_total_points > 0;
}

}  // namespace

std::string_view to_string(CurveEvent event) noexcept {
  switch (event) {
    case CurveEvent::none:
      return "none";
    case CurveEvent::begin:
      return "begin";
    case CurveEvent::target:
      return "target";
    case CurveEvent::fold:
      return "fold";
    case CurveEvent::bifurcation:
      return "bifurcation";
    case CurveEvent::rod_bifurcation:
      return "rod_bifurcation";
    case CurveEvent::stability:
      return "stability";
  }
  return "";
}

std::string_view to_string(CurveEnd end) noexcept {
  switch (end) {
    case CurveEnd::left_range:
      return "left_range";
    case CurveEnd::closed:
      return "closed";
    case CurveEnd::max_points:
      return "max_points";
    case CurveEnd::straight:
      return "straight";
    case CurveEnd::sharp:
      return "sharp";
    case CurveEnd::far:
      return "far";
    case CurveEnd::stalled:
      return "stalled";
    case CurveEnd::stopped:
      return "stopped";
    case CurveEnd::not_followed:
      return "not_followed";
  }
  return "";
}

std::vector<EquilibriumCurve> equilibrium_curves(const Robot& robot, const CurveOptions& how,
                                                 Workspace& work) {
  if (has_chains(robot)) return equilibrium_curves_of_chains(robot, how, work);
  if (!has_rods(robot) || !check_workspace(robot, work).ok() || !is_answerable(robot, how)) return {};
  RodWork& rods = rods_of(work);
  if (!rods.is_solved) return {};
  RodGroup& system = *rods.system;
  if (!how.inputs.empty())
    for (int k = 0; k < system.feeds(); ++k)
      if (!system.in_domain(k, how.inputs[static_cast<std::size_t>(system.input_of(k))])) return {};
  RodWay way{present(system), present(system), how.pose.has_value(), system.platform(), system.platform()};
  if (!how.inputs.empty()) way.target = target_of(system, how.inputs, system.wrench());
  way.target.wrench += how.added_wrench;
  if (how.pose) way.to = SE3<double>::from(*how.pose);
  const bool moves = !twist_between(way.from, way.to).isZero(0);
  if (!moves && way.target.lengths == way.begin.lengths && how.added_wrench.isZero(0)) return {};
  rods.is_solved = rods.knows_feeding = false;
  return trace_rods(rods, way, how);
}

}  // namespace sinew::inline v1
