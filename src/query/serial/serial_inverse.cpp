/// Handler of `inverse` of serial robots: bends that bring the tip where it is wanted.
#include <fmt/format.h>

#include <numbers>

#include "kinematics/serial/three_arcs.hpp"
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

/// Every solution within the limits; the one that bends least stands for the answer.
void answer_all(SerialContext& context, const ThreeArcs& arcs, const TipTarget& target, kernel::Model model,
                const SerialWants& wanted) {
  const SE3<double> tip{target.position, *target.rotation};
  const ThreeArcSolutions found = all_bends(arcs, spatial_pose(tip), context.work.stop);
  Value solutions = Value::list();
  std::optional<std::size_t> first;
  for (std::size_t k = 0; k < found.solutions.size(); ++k) {
    const std::span<const Bend> bends = found.solutions[k];
    if (!check_limits(context.robot, bends).ok()) continue;
    if (!first) first = k;
    solutions.push_back({{"configuration", configuration_value(context, bends)},
                         {"changes", changes_value(context, bends, model)},
                         {"residual", found.residual[k]}});
  }
  Report report = found.report;
  if (!first && !found.solutions.empty() && report.status != Status::stopped) {
    report.status = found.is_complete() ? Status::unreachable : Status::stalled;
    report.message = {};
    append_number(report.message, static_cast<int>(found.solutions.size()));
    report.message.append(found.is_complete()
                              ? " solutions, none within the limits of all sections"
                              : " examples of a continuum, none within the limits of all sections");
  }
  context.report(report);
  if (report.status == Status::left_domain) return;
  if (first) {
    put_configuration(context, found.solutions[*first], model);
    put_serial_wants(context, found.solutions[*first], model, wanted);
    context.answer["residual"] = found.residual[*first];
  }
  context.answer["count"] = solutions.size();
  context.answer["complete"] = found.is_complete();
  context.answer["solutions"] = std::move(solutions);
}

struct SerialInverseQuestion {
  kernel::Model model;
  TipTarget target;
  SerialConfiguration start;
  std::optional<ThreeArcs> all;  ///< of which every solution is wanted
  SerialWants wanted;
};

SerialInverseQuestion read_inverse(SerialContext& context) {
  SerialInverseQuestion asked{.model = read_tendon_model(context, kernel::Model::exact),
                              .target = read_target(context),
                              .start = {},
                              .all = {},
                              .wanted = {}};
  if (const auto given = context.query.optional("start")) asked.start = read_configuration(context, *given);
  const auto all = context.query.optional("all");
  const bool want_all = all && all->boolean();
  if (want_all) asked.all = three_arcs(context.robot);
  if (want_all && !asked.all)
    all->fail("not_available",
              "every solution is found of three arcs only: three neutral sections of one segment, "
              "without discs, of fixed lengths");
  if (want_all && !asked.target.rotation && context.errors.empty())
    all->fail("not_available", "a target that leaves turns open has a continuum of solutions; give a pose");
  for (const char* key : {"start", "max_iterations"})
    if (const auto given = context.query.optional(key); given && want_all)
      given->refuse("no_effect", "has no effect where all solutions are asked for; remove it");
  asked.wanted = read_serial_wants(context);
  return asked;
}

void answer_inverse(SerialContext& context, const SerialInverseQuestion& asked) {
  if (asked.all) return answer_all(context, *asked.all, asked.target, asked.model, asked.wanted);
  SerialInverseOptions options{.start = asked.start.bends, .start_extensions = asked.start.extensions};
  if (context.max_iterations) options.max_iterations = *context.max_iterations;
  const SerialInverse found = inverse(context.robot, asked.target, options, context.work);
  context.report(found.report);
  const std::vector<Bend> bends(found.bends.begin(), found.bends.end());
  put_configuration(context, bends, asked.model);
  context.answer["residual"] = found.report.residual;
  context.answer["iterations"] = found.report.iterations;
  put_serial_wants(context, bends, asked.model, asked.wanted);
}

}  // namespace

void answer_serial_inverse(Context& context) { handle<read_inverse, answer_inverse>(context); }

}  // namespace sinew::inline v1
