/// `inverse` of serial robots: bends that bring the tip where it is wanted.
#include <fmt/format.h>

#include <numbers>

#include "kinematics/serial/three_arcs.hpp"
#include "query/questions.hpp"
#include "query/serial/serial.hpp"
#include "query/tip.hpp"
#include "sinew/kinematics/serial.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {
namespace {

/// `position`, `position` and `direction`, or `pose`.
TipTarget read_target(SerialContext& context) {
  const AskedTip tip = read_tip(context, false);
  TipTarget target{Vec3<double>::Zero()};
  if (tip.pose) {
    const SE3<double> frame = SE3<double>::from(*tip.pose);
    target.position = frame.p;
    target.rotation = frame.R;
  }
  if (tip.position) target.position = Vec3<double>(tip.position->data());
  if (tip.direction) target.direction = Vec3<double>(tip.direction->data()).normalized();
  return target;
}

/// The robot as three arcs, if that is what it is.
std::optional<ThreeArcs> three_arcs(const SerialRobot& robot) {
  ThreeArcs arcs;
  if (robot.sections.size() != 3) return {};
  double limit = 0;
  for (std::size_t m = 0; m < 3; ++m) {
    const Section& section = robot.sections[m];
    if (section.is_twin() || section.segments != 1 || section.disc_height > 0 || section.is_extensible())
      return {};
    arcs.lengths[m] = section.joint;
    limit = std::max(limit, section.limit);
  }
  arcs.limit = std::min(limit, 2 * std::numbers::pi);
  return arcs;
}

struct SerialInverseQuestion : SerialContext {
  using SerialContext::SerialContext;

  void read();
  void solve();
  void tell();

 private:
  void solve_all();
  void tell_solutions();

  kernel::Model model_ = kernel::Model::exact;
  TipTarget target_ = {Vec3<double>::Zero()};
  SerialConfiguration start_ = {};
  std::optional<ThreeArcs> arcs_ = {};  ///< of which every solution is wanted
  SerialWants wanted_ = {};

  Report found_ = {};
  std::vector<Bend> bends_ = {};          ///< that stand for the answer; empty: there are none
  ThreeArcSolutions solutions_ = {};      ///< of the arcs
  std::vector<std::size_t> within_ = {};  ///< which of them are within the limits
};

void SerialInverseQuestion::read() {
  model_ = read_tendon_model(*this, kernel::Model::exact);
  target_ = read_target(*this);
  if (const auto given = query.optional("start")) start_ = read_configuration(*this, *given);
  const auto all = query.optional("all");
  const bool want_all = all && all->boolean();
  if (want_all) arcs_ = three_arcs(robot);
  if (want_all && !arcs_)
    all->fail("not_available",
              "every solution is found of three arcs only: three neutral sections of one segment, "
              "without discs, of fixed lengths");
  if (want_all && !target_.rotation && errors.empty())
    all->fail("not_available", "a target that leaves turns open has a continuum of solutions; give a pose");
  for (const char* key : {"start", "max_iterations"})
    if (const auto given = query.optional(key); given && want_all)
      given->refuse("no_effect", "has no effect where all solutions are asked for; remove it");
  wanted_ = read_serial_wants(*this);
}

void SerialInverseQuestion::solve() {
  if (arcs_) return solve_all();
  SerialInverseOptions options{.start = start_.bends, .start_extensions = start_.extensions};
  if (max_iterations) options.max_iterations = *max_iterations;
  const SerialInverse one = inverse(robot, target_, options, work);
  found_ = one.report;
  bends_.assign(one.bends.begin(), one.bends.end());
}

/// Every solution within the limits; the one that bends least stands for the answer.
void SerialInverseQuestion::solve_all() {
  const SE3<double> tip{target_.position, *target_.rotation};
  solutions_ = all_bends(*arcs_, spatial_pose(tip), work.stop);
  for (std::size_t k = 0; k < solutions_.solutions.size(); ++k)
    if (check_limits(robot, solutions_.solutions[k]).ok()) within_.push_back(k);
  found_ = solutions_.report;
  if (!within_.empty()) {
    const auto& least = solutions_.solutions[within_.front()];
    bends_.assign(least.begin(), least.end());
    found_.residual = solutions_.residual[within_.front()];
  } else if (!solutions_.solutions.empty() && found_.status != Status::stopped) {
    found_.status = solutions_.is_complete() ? Status::unreachable : Status::stalled;
    found_.message = {};
    append_number(found_.message, static_cast<int>(solutions_.solutions.size()));
    found_.message.append(solutions_.is_complete()
                              ? " solutions, none within the limits of all sections"
                              : " examples of a continuum, none within the limits of all sections");
  }
}

void SerialInverseQuestion::tell() {
  report(found_);
  if (!bends_.empty()) {
    put_configuration(*this, bends_, model_);
    answer["residual"] = found_.residual;
    if (!arcs_) answer["iterations"] = found_.iterations;
    put_serial_wants(*this, bends_, model_, wanted_);
  }
  if (arcs_ && found_.status != Status::left_domain) tell_solutions();
}

void SerialInverseQuestion::tell_solutions() {
  Value solutions = Value::list();
  for (const std::size_t k : within_) {
    const std::span<const Bend> bends = solutions_.solutions[k];
    solutions.push_back({{"configuration", configuration_value(*this, bends)},
                         {"changes", changes_value(*this, bends, model_)},
                         {"residual", solutions_.residual[k]}});
  }
  answer["count"] = solutions.size();
  answer["complete"] = solutions_.is_complete();
  answer["solutions"] = std::move(solutions);
}

}  // namespace

void answer_serial_inverse(Context& context) { answer_question<SerialInverseQuestion>(context); }

}  // namespace sinew::inline v1
