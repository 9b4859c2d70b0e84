#include "kinematics/rods/lengths_for_pose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "base/at.hpp"
#include "kinematics/rods/start.hpp"
#include "kinematics/rods/trace.hpp"
#include "kinematics/rods/verdict.hpp"
#include "solve/message.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

using Twist = Vec<double, 6>;

/// Newton's method on the lengths while the platform is put where it is wanted.
class Holder {
 public:
  explicit Holder(RodWork& work) : work_(work), system_(*work.system) {}

  /// Factors at the point last evaluated.
  bool renew() {
    system_.linearise();  // the platform's own stiffness may be singular here
    double matrix[36];
    for (int input = 0; input < 6; ++input) {
      const Twist feed = system_.input_wrench_jacobian(input);
      for (int r = 0; r < 6; ++r) matrix[6 * r + input] = feed[r];
    }
    return work_.knows_feeding = work_.feeding.factor(matrix, system_.radius());
  }

  /// To `pose` with the last factors, `fresh` right after `renew`. False where a rod would be no rod.
  bool step(const SE3<double>& pose, bool fresh) {
    const Twist given = twist_between(system_.platform(), pose);
    if (!fresh) system_.step(false);
    const Twist wanted = system_.wrench_residual() - system_.stiffness() * given;
    double fed[6];
    work_.feeding.solve(wanted.data(), fed);
    for (int k = 0; k < system_.limbs(); ++k)
      if (!(system_.length(k) + fed[system_.input_of(k)] > 0)) return false;
    system_.move(given, fed);
    system_.set_platform(pose);
    return true;
  }

  /// Newton's method with the platform there. Down to `tolerance`, or a little further.
  bool correct(const SE3<double>& pose, int& iterations, double& residual, double tolerance) {
    return contract([&] { return system_.evaluate(); }, [&] { return renew() && step(pose, true); },
                    tolerance, rod_rounding, iterations, residual);
  }

  /// From the state before, near by.
  bool follow(const SE3<double>& pose, Report& report, double tolerance) {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    return contract_with_kept_factors([&] { return system_.evaluate(false); }, [&] { return renew(); },
                                      [&](bool fresh) { return step(pose, fresh); }, tolerance, unknown,
                                      report.iterations, report.residual);
  }

 private:
  RodWork& work_;
  RodGroup& system_;
};

/// Corrections must stay small beside the prediction: else it may have found another branch.
bool is_near(const RodGroup& system, const RodTarget& before, const RodTarget& predicted) {
  double change = 0, correction = 0;
  for (int k = 0; k < system.feeds(); ++k) {
    const double length = predicted.lengths[at(k)];
    change = std::max(change, std::abs(length - before.lengths[at(k)]));
    correction = std::max(correction, std::abs(system.held(k) - length));
  }
  return correction < 0.5 * change + 0.01 * system.length(0);
}

/// Follows the path as far as it goes. The system is then there, solved to `loose`.
RodPathEnd follow_poses(RodWork& work, const RodWay& way, int max_iterations) {
  constexpr double loose = 1e-5, loose_truncation = 1e-9, shortest = 1e-6;
  RodGroup& system = *work.system;
  Holder holder(work);
  RodPathEnd end;
  follow_parameter(end, {{0.25, shortest, work.stop}, 0, max_iterations}, [&](double next, double taken) {
    system.save(work.spare);
    system.evaluate();
    const bool renews = !work.knows_feeding;
    const RodTarget here = present(system);
    system.set_wrench(way.at(next, 0).wrench);
    bool is_reached = (!renews || holder.renew()) && holder.step(way.pose(next), renews);
    const RodTarget predicted = present(system);
    const int before = ++end.iterations;
    const auto correct = [&] { return holder.correct(way.pose(next), end.iterations, end.residual, loose); };
    is_reached = is_reached && correct() && is_near(system, here, predicted);
    while (is_reached && !system.is_finest() && system.truncation() > loose_truncation) {
      system.refine();
      is_reached = correct();
    }
    if (is_reached)
      return ParameterStep{ParameterStep::reached, (end.iterations - before <= 1 ? 2 : 1) * taken};
    system.restore(work.spare);
    work.knows_feeding = false;
    return ParameterStep{ParameterStep::failed, taken / 3};
  });
  system.evaluate();
  return end;
}

/// Why the lengths do not follow the platform further: the system is where they still do.
Report explain_hold(const RodGroup& system, const RodPathEnd& end, const RodFold& fold,
                    std::string_view from) {
  if (end.ran_out || end.stopped) return explain(system, end, fold, false);
  Report report = failed(fold.is_found ? Status::singular : Status::stalled);
  if (!fold.is_found && system.truncation() > worst_truncation) report.status = Status::left_domain;
  report.iterations = end.iterations;
  report.residual = end.residual;
  report.message.append(fold.is_found ? "the lengths pass a fold at "
                        : report.status == Status::left_domain
                            ? "the rods bend too sharply to be resolved at "
                            : "the lengths stop following at ");
  append_number(report.message, static_cast<int>(100 * (fold.is_found ? fold.parameter : end.progress)));
  report.message.append(" % of the straight way from ");
  report.message.append(from);
  report.message.append(", at ");
  const SE3<double>& there = fold.is_found ? fold.platform : system.platform();
  for (int k = 0; k < 3; ++k) {
    append_mm(report.message, there.p[k]);
    report.message.append(k < 2 ? ", " : "");
  }
  report.message.append(", turned ");
  append_degrees(report.message, there.R.log().norm());
  return report;
}

Report check(const RodGroup& system, const SE3<double>& wanted, const RodQuestion& question) {
  Report report;
  if (system.inputs() != 6 || system.feeds() != 6) {
    report = failed(Status::unsupported);
    report.message.append("a pose is held by six inputs, each feeding one leg; this robot has ");
    append_number(report.message, system.feeds());
    report.message.append(" legs fed and ");
    append_number(report.message, system.inputs());
    report.message.append(" inputs");
  } else if (!wanted.p.allFinite() || !wanted.R.v.allFinite() || !std::isfinite(wanted.R.w) ||
             !question.wrench.allFinite()) {
    report = failed(Status::left_domain);
    report.message.append("the pose or the wrench is not a number");
  }
  if (report.ok() && system.undriven() > 0) {
    report = failed(Status::unsupported);
    report.message.append(
        "legs beside the rods hold motions that no input drives: not all of a pose can be "
        "chosen; ask forward with inputs");
  }
  return report;
}

/// From where the system is along these poses, one after the other.
RodPathEnd approach(RodWork& work, std::span<const SE3<double>> poses, const RodQuestion& question) {
  RodGroup& system = *work.system;
  work.knows_feeding = false;
  RodPathEnd end;
  int iterations = 0;
  for (const SE3<double>& pose : poses) {
    RodWay way{present(system), present(system), true, system.platform(), pose};
    way.target.wrench = question.wrench;
    end = follow_poses(work, way, question.max_iterations - iterations);
    iterations = end.iterations += iterations;
    if (!end.arrived) break;
  }
  return end;
}

/// Where the straight way from home ends, others may lead to another branch that holds the pose. If so, and
/// the system is there, true; the message of `report`, which says where it ends, then says by which way.
bool detour(RodWork& work, const SE3<double>& home, const SE3<double>& wanted, const RodQuestion& question,
            Report& report) {
  constexpr double lower = 7.0 / 8;  // short rods are the stiffer ones
  const SE3<double> level{wanted.p, home.R}, turned{home.p, wanted.R};
  SE3<double> low = level, low_turned = wanted;
  low.p[2] = low_turned.p[2] = lower * home.p[2];
  struct Way {
    const char* name;
    std::array<SE3<double>, 3> poses;
  };
  const Way ways[] = {{"held on another branch: move first, then turn", {level, wanted, wanted}},
                      {"held on another branch: turn first, then move", {turned, wanted, wanted}},
                      {"held on another branch: turn at a lower height", {low, low_turned, wanted}}};
  for (const Way& way : ways) {
    if (!go_home(work, home).ok()) return false;
    const RodPathEnd end = approach(work, way.poses, question);
    if (!end.arrived) continue;
    report.status = Status::converged;
    report.iterations += end.iterations;
    say(report, way.name);
    return true;
  }
  return false;
}

/// Another branch that holds the pose, by another way or through the fold. Says so.
bool reach_otherwise(RodWork& work, const SE3<double>& home, const SE3<double>& wanted,
                     const RodQuestion& question, const RodWay& way, const RodPathEnd& end, Report& report) {
  const LimbState stopped = work.system->state();
  if (detour(work, home, wanted, question, report)) return true;
  work.system->restore(stopped);
  const bool has_fold = report.status == Status::singular;
  if (has_fold && pass_fold(work, way, end.progress)) {
    report.status = Status::converged;
    say(report, "held on another branch: on through the fold");
    return true;
  }
  say(report, has_fold ? "through it, moving first, turning first or lower down do not lead to it either"
                       : "moving first, turning first or lower down do not lead to it either");
  return false;
}

/// The last digits, on elements that resolve the shapes.
Report finish(RodWork& work, const SE3<double>& wanted, Report report, double truncation) {
  RodGroup& system = *work.system;
  Holder holder(work);
  const auto correct = [&] {
    return holder.correct(wanted, report.iterations, report.residual, rod_tolerance);
  };
  bool is_solved = correct();
  while (is_solved && !system.is_finest() && system.truncation() > truncation) {
    system.refine();
    is_solved = correct();
  }
  if (!is_solved) {
    report.status = Status::stalled;
    say(report, "the pose is reached, but not to the last digits; the rods bend too sharply");
    return report;
  }
  return settle(work, report, truncation);
}

}  // namespace

Report lengths_for_pose(RodWork& work, const SE3<double>& home, const SE3<double>& wanted,
                        const RodQuestion& question) {
  RodGroup& system = *work.system;
  work.signs.reset();
  if (const Report checked = check(system, wanted, question); !checked.ok()) return checked;
  Report report;
  if (note_stop(work.stop, report)) return report;
  if (question.warm_start && work.is_solved) {
    system.save(work.before);
    system.set_wrench(question.wrench);
    Holder holder(work);
    bool is_near = true;
    const bool is_lighter = system.can_coarsen(system.traits().quick_truncation);
    if (is_lighter) system.coarsen();
    if (is_lighter || !work.knows_feeding) {
      system.evaluate();
      is_near = holder.renew();
    }
    if (is_near &&
        holder.follow(wanted, report, question.check_stability ? rod_tolerance : rod_quick_tolerance)) {
      if (question.check_stability ||
          (system.truncation() > system.traits().quick_truncation && !system.is_finest()))
        report = finish(work, wanted, report,
                        question.check_stability ? coarse_truncation : system.traits().quick_truncation);
      else
        is_in_domain(system, report);
      work.is_solved = report.is_solved();
      return report;
    }
    system.restore(work.before);
    report = {};
  } else if (const Report begun = go_home(work, home); !begun.ok()) {
    return begun;
  }
  const bool is_from_home = !(question.warm_start && work.is_solved);
  const RodTarget begin = present(system);
  RodWay way{begin, begin, true, system.platform(), wanted};
  way.target.wrench = question.wrench;
  RodPathEnd end = approach(work, std::span(&wanted, 1), question);
  report.iterations = end.iterations;
  if (!end.arrived) {
    const bool is_cut = end.ran_out || end.stopped;
    RodFold fold = is_cut ? RodFold{} : find_fold(work, way, end.progress);
    if (!is_cut && !fold.is_found && !fold.arrived && is_from_home && go_home(work, home).ok()) {
      end.progress = 0;  // what was followed had left the branch
      fold = find_fold(work, way, 0);
    }
    if (!fold.arrived) {
      report = explain_hold(system, end, fold, is_from_home ? "home" : "the last pose");
      if (!is_from_home || is_cut || !reach_otherwise(work, home, wanted, question, way, end, report)) {
        note_stop(work.stop, report);
        work.is_solved = false;
        return report;
      }
    }
  }
  report = finish(work, wanted, report, system.traits().best_truncation);
  work.is_solved = report.is_solved();
  return report;
}

}  // namespace sinew::inline v1
