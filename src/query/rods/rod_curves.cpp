/// `track` of robots on rods: curves of equilibria along inputs, loads or poses, through folds.
#include <fmt/format.h>

#include "io/document/reader.hpp"
#include "io/robots/read_pose.hpp"
#include "query/curves.hpp"
#include "query/questions.hpp"
#include "query/rods/rods.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

struct RodCurves : Context {
  explicit RodCurves(const Context& context) : Context(context) {}

  void read();
  void solve();
  void tell();

 private:
  void read_target();

  RodQuery begin_ = {};
  CurveOptions how_ = {};
  std::optional<SpatialWrench> wrench_ = {};  ///< at the target
  Equilibrium begun_ = {};
  std::vector<EquilibriumCurve> curves_ = {};
};

/// What changes: `to`.
void RodCurves::read_target() {
  Reader to = query.required("to", "{inputs, or pose, and wrench}: what changes along the curve");
  const auto inputs = to.optional("inputs"), wrench = to.optional("wrench");
  auto pose = to.optional("pose");
  if (inputs) how_.inputs = read_inputs(*this, *inputs);
  if (wrench) wrench_ = read_wrench<Spatial>(*wrench);
  if (pose && inputs) pose->fail("ambiguous", "inputs and pose both say where the curve leads; keep one");
  if (pose && (input_count(robot) != 6 || has_ties(robot)))
    pose->fail("not_available", "a pose is held by six inputs, each of one leg; give inputs");
  if (pose) how_.pose = read_spatial_pose(std::move(*pose));
  if (to.is(Node::Kind::map)) {
    if (!inputs && !wrench && !how_.pose)
      to.fail("missing_key", "give inputs, pose or wrench: what changes along the curve");
    to.close();
  }
}

void RodCurves::read() {
  begin_ = read_configuration_of_rods(*this);
  read_target();
  read_extent(*this, how_);
}

}  // namespace

std::string curve_in_words(CurveEnd end, const double* fold) {
  const std::string ends = fmt::format("the curve ends: {}", to_string(end));
  if (!fold) return ends;
  return fmt::format("the curve folds at {:.6g} of the way and does not come to its target; {}", *fold, ends);
}

std::string unfollowed_in_words(std::size_t bifurcations, std::size_t points) {
  return fmt::format(
      "curves that leave {} of the bifurcations were not all followed: the others have {} rows; ask for "
      "fewer "
      "samples or a narrower range",
      bifurcations, points);
}

void note_stopped_curve(Context& context) {
  if (Report stopped; note_stop(context.work.stop, stopped)) context.report(stopped);
}

namespace {

void RodCurves::solve() {
  begun_ = sinew::solve(*this, begin_);
  if (!begun_.is_solved()) return;
  if (wrench_) how_.added_wrench = *wrench_ - begin_.options.wrench;
  curves_ = equilibrium_curves(robot, how_, work);
  if (curves_.empty())
    query.fail("no_effect",
               "nothing changes between the beginning and `to`, or its inputs are beyond what the legs "
               "can do; give other values");
}

void RodCurves::tell() {
  report(begun_.report);
  if (curves_.empty()) return;
  put_curves(*this, curves_, [](const CurvePoint& point) {
    return Value{{"pose", pose_value(point.pose)}, {"inputs", Value(std::span<const double>(point.inputs))}};
  });
}

}  // namespace

void answer_rods_track(Context& context) {
  if (context.query.has("from") || context.query.has("poses")) return answer_rods_path(context);
  answer_question<RodCurves>(context);
}

}  // namespace sinew::inline v1
