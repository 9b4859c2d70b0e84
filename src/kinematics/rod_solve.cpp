#include "kinematics/rod_solve.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::inline v0 {
namespace {

constexpr double tolerance = 1e-12;
/// Estimated error of a shape at its tip, over the length, beyond which an answer is refused.
constexpr double worst_truncation = 1e-10;
/// ... from which one that is to be quick takes the fine nodes (poses were then within 2e-13 m of exact
/// ones),
constexpr double quick_truncation = 1e-10;
/// ... and from which an answer that is not resumed takes them: stiff robots turn it into forces.
constexpr double best_truncation = 1e-17;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Report failed(Status status) {
  Report report;
  report.status = status;
  return report;
}

Report check_inputs(const RodSystem& system, Numbers inputs) {
  Report report = failed(Status::left_domain);
  if (inputs.size() != at(system.inputs())) {
    report.message.append("the robot has ");
    append_number(report.message, system.inputs());
    report.message.append(" inputs, ");
    append_number(report.message, static_cast<int>(inputs.size()));
    report.message.append(" were given");
    return report;
  }
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (inputs[k] > 0 && std::isfinite(inputs[k])) continue;
    report.message.append("inputs[");
    append_number(report.message, static_cast<int>(k));
    report.message.append("] is not a length a rod can have; it must be positive");
    return report;
  }
  return {};
}

/// Two guides farther apart than their rods and the platform between them reach: no pose exists.
Report check_reach(const RodSystem& system, Numbers inputs) {
  Report report;
  for (int j = 1; j < system.rods(); ++j)
    for (int k = 0; k < j; ++k) {
      const double apart = (system.base(j) - system.base(k)).norm();
      const double between = (system.platform_point(j) - system.platform_point(k)).norm();
      const double reach = inputs[at(system.input_of(j))] + inputs[at(system.input_of(k))] + between;
      if (apart <= reach) continue;
      report.status = Status::unreachable;
      report.message.append("legs[");
      append_number(report.message, k);
      report.message.append("] and legs[");
      append_number(report.message, j);
      report.message.append("] are too short: their guides are ");
      append_mm(report.message, apart);
      report.message.append(" apart, rods and platform reach ");
      append_mm(report.message, reach);
      return report;
    }
  return report;
}

/// Of the rods the one nearest to straight: by how much less than its length it spans.
struct Straightest {
  int rod = 0;
  double slack = 1, tension = 0;  ///< 1 − chord/length; axial force in EI/L²
};
Straightest straightest(const RodSystem& system) {
  Straightest found;
  for (int k = 0; k < system.rods(); ++k) {
    const RodReading rod = system.rod(k);
    const double slack = 1 - rod.chord / rod.length;
    if (slack >= found.slack) continue;
    found = {k, slack, rod.axial_force * rod.length * rod.length / system.aim(k).stiffness};
  }
  return found;
}

/// Why a path ended early; the system is at its last equilibrium.
Report explain(const RodSystem& system, const RodPathEnd& end, bool is_load) {
  Report report = failed(Status::singular);
  report.iterations = end.iterations;
  report.residual = end.residual;
  const auto percent = [&] {
    append_number(report.message, static_cast<int>(100 * end.progress));
    report.message.append(" % of the way");
  };
  if (system.truncation() > worst_truncation) {
    report.status = Status::left_domain;
    report.message.append("the rods bend too sharply to be resolved at ");
    percent();
    return report;
  }
  const Straightest tight = straightest(system);
  if (tight.tension > 60) {
    report.status = Status::unreachable;
    report.message.append("legs[");
    append_number(report.message, tight.rod);
    report.message.append("] is pulled straight at ");
    percent();
    report.message.append(is_load ? " to this load; give it less"
                                  : " to these inputs: it is too short for the others");
    return report;
  }
  const int unstable = unstable_directions(system);
  if (unstable == 0 && system.factors().smallest_pivot() > 1e-3) {
    report.status = Status::stalled;
    report.message.append("the path ends at ");
    percent();
    report.message.append("; start nearer, or allow more iterations");
    return report;
  }
  if (is_load) {
    report.message.append("the robot buckles at ");
    percent();
    report.message.append(" to this load: a fold, no equilibrium is nearby beyond it");
  } else {
    report.message.append("the inputs pass a fold at ");
    percent();
    report.message.append(" from the start: no equilibrium is nearby beyond it");
  }
  return report;
}

/// Newton's method from the state before: first with the factors kept from there, then with new ones, and
/// kept again once a step with them gains as much as a new one would. False, with the state lost, where it
/// does not contract at once.
bool solve_warm(RodSystem& system, Report& report) {
  constexpr double worth_renewing = 3e-9;
  double error = system.evaluate();
  if (!(error <= tolerance)) {
    system.move(system.step(false));
    error = system.evaluate(false);
    ++report.iterations;
  }
  for (int renewals = 0; !(error <= tolerance);) {
    const bool renews = renewals == 0 || (error > worth_renewing && renewals < 3);
    if (renews && !system.linearise()) return false;
    renewals += renews;
    system.move(system.step(renews));
    const double next = system.evaluate(false);
    ++report.iterations;
    if (!(next < 0.3 * error) && !(next <= tolerance)) return false;
    if (report.iterations > 10) return false;
    error = next;
  }
  report.residual = error;
  return true;
}

/// Back to the coarse nodes where they resolve the shapes. `before` holds the state.
void lighten(RodWork& work, double truncation) {
  RodSystem& system = work.system;
  system.coarsen();
  system.evaluate();
  if (system.truncation() > truncation) {
    system.restore(work.before);
    system.evaluate();
  }
  system.linearise();
}

/// The shapes of a solved state to this estimate of their error, by the fine nodes where it takes them. False
/// where those do not do it.
bool resolve(RodSystem& system, Report& report, double truncation) {
  if (!system.is_fine() && system.truncation() > truncation) {
    system.refine();
    if (!correct(system, tolerance, false, report.iterations, report.residual)) {
      report.status = Status::stalled;
      report.message.append("the rods bend too sharply to be resolved");
      return false;
    }
  }
  if (!(system.truncation() <= worst_truncation)) {
    report.status = Status::left_domain;
    report.message.append("the rods bend more sharply than their 24 nodes resolve");
    return false;
  }
  return true;
}

/// What holds of a solved state: shapes resolved, platform's stiffness known there, stability.
Report settle(RodSystem& system, Report report, double truncation) {
  if (!resolve(system, report, truncation)) return report;
  system.linearise();
  const int unstable = unstable_directions(system);
  if (unstable == 0) return report;
  report.status = Status::unstable;
  append_number(report.message, unstable);
  report.message.append(unstable == 1 ? " direction in which the robot does not hold by itself"
                                      : " directions in which the robot does not hold by itself");
  return report;
}

RodTarget target_of(const RodSystem& system, Numbers inputs, const RodSystem::Wrench& wrench) {
  RodTarget target;
  for (int k = 0; k < system.rods(); ++k) target.lengths[at(k)] = inputs[at(system.input_of(k))];
  target.wrench = wrench;
  return target;
}

/// To the home state, in equilibrium under some wrench.
Report go_home(RodWork& work, const SE3<double>& home) {
  if (!work.knows_home) {
    if (!rest_at(work.system, home)) {
      Report report = failed(Status::singular);
      report.message.append(
          "at home a rod's tip lies on the line of its guide, or behind it: the direction in which it bends "
          "is "
          "not determined; give a start, or another home");
      return report;
    }
    work.system.save(work.home);
    work.knows_home = true;
    return {};
  }
  work.system.restore(work.home);
  work.system.evaluate();
  work.system.linearise();
  return {};
}

Report begin(RodWork& work, const SE3<double>& home, Numbers inputs, const RodQuestion& question) {
  if (question.resume && work.is_solved) return {};
  if (!question.start) return go_home(work, home);
  if (lay_rods(work, *question.start, inputs) || work.is_solved) return {};
  Report report = failed(Status::left_domain);
  report.message.append(
      "the rods cannot be laid to this start: a tip lies on the line of its guide, or behind it; start with "
      "every tip ahead of its guide, or leave start out");
  return report;
}

/// First the lengths, then the load; where the unloaded lengths fail, both together.
Report travel(RodWork& work, Numbers inputs, const RodQuestion& question) {
  RodSystem& system = work.system;
  system.save(work.before);
  const RodPathOptions options{.tolerance = tolerance, .max_iterations = question.max_iterations};
  const auto arrived = [&](const RodPathEnd& end) {
    Report report;
    report.iterations = end.iterations;
    report.residual = end.residual;
    return report;
  };
  const bool is_loaded = question.wrench != RodSystem::Wrench::Zero();
  // from a pose that was asked for, and on a way that is resumed, lengths and load go together
  const bool at_once = question.start || question.resume || !is_loaded;
  RodTarget target = target_of(system, inputs, question.wrench);
  if (at_once) {
    const RodPathEnd end = follow(system, target, options, work.spare);
    return end.arrived ? arrived(end) : explain(system, end, false);
  }
  target.wrench.setZero();
  const RodPathEnd first = follow(system, target, options, work.spare);
  target.wrench = question.wrench;
  if (first.arrived) {
    RodPathEnd second = follow(system, target, options, work.spare);
    second.iterations += first.iterations;
    return second.arrived ? arrived(second) : explain(system, second, true);
  }
  system.restore(work.before);
  system.evaluate();
  system.linearise();
  RodPathEnd both = follow(system, target, options, work.spare);
  both.iterations += first.iterations;
  return both.arrived ? arrived(both) : explain(system, both, false);
}

/// Newton's method from a start at once: whoever gives a pose wants what is near it. False, with the state as
/// it was, where it does not contract or leads away.
bool jump(RodWork& work, Numbers inputs, const RodQuestion& question, Report& report) {
  RodSystem& system = work.system;
  system.save(work.before);
  const SE3<double> start = system.platform();
  for (int k = 0; k < system.rods(); ++k) system.set_length(k, inputs[at(system.input_of(k))]);
  system.set_wrench(question.wrench);
  double error = system.evaluate();
  for (int k = 0; k < 15 && !(error <= 1e-6); ++k) {
    if (!system.linearise()) break;
    const RodSystem::Twist twist = system.step(true);
    if (!(twist.head<3>().norm() + system.radius() * twist.tail<3>().norm() < 0.2 * system.length(0))) break;
    system.move(twist);
    ++report.iterations;
    error = system.evaluate();
  }
  report.status = Status::converged;
  if (error <= 1e-6 && correct(system, tolerance, false, report.iterations, report.residual) &&
      (system.platform().p - start.p).norm() < 0.2 * system.length(0))
    return true;
  system.restore(work.before);
  system.evaluate();
  system.linearise();
  return false;
}

}  // namespace

bool lay_rods(RodWork& work, const SE3<double>& pose, Numbers inputs) {
  RodSystem& system = work.system;
  work.is_solved = false;
  if (!pose.p.allFinite() || !rest_at(system, pose)) return false;
  work.is_solved = true;
  system.save(work.before);
  // from the lengths at which they rest to those that are given, the platform held
  RodTarget from = present(system), to = target_of(system, inputs, from.wrench);
  double part = 0, stride = 0.25;
  int iterations = 0;
  while (part < 1 && stride > 1e-3) {
    const double next = std::min(1.0, part + stride);
    system.save(work.spare);
    for (int k = 0; k < system.rods(); ++k)
      system.set_length(k, std::lerp(from.lengths[at(k)], to.lengths[at(k)], next));
    double residual;
    if (correct(system, 1e-10, true, iterations, residual)) {
      part = next;
      stride *= 1.5;
    } else {
      system.restore(work.spare);
      stride /= 3;
    }
  }
  if (part < 1) system.restore(work.before);
  system.set_wrench(RodSystem::Wrench::Zero());
  system.evaluate();
  system.set_wrench(-system.missing());
  system.evaluate();
  work.is_solved = system.linearise();
  return part >= 1 && work.is_solved;
}

Report solve_rods(RodWork& work, const SE3<double>& home, Numbers inputs, const RodQuestion& asked) {
  RodQuestion question = asked;
  question.resume = asked.resume && work.is_solved;  // else it begins like any other
  if (const Report checked = check_inputs(work.system, inputs); !checked.ok()) return checked;
  if (!question.wrench.allFinite()) {
    Report report = failed(Status::left_domain);
    report.message.append("the wrench is not a number");
    return report;
  }
  RodSystem& system = work.system;
  if (question.resume) {
    system.save(work.before);
    const double truncation = question.judge ? coarse_truncation : quick_truncation;
    if (system.is_fine()) lighten(work, truncation);
    system.set_inputs(inputs);
    system.set_wrench(question.wrench);
    Report report;
    if (solve_warm(system, report)) {
      if (question.judge)
        report = settle(system, report, truncation);
      else
        resolve(system, report, truncation);
      work.is_solved = report.ok() || report.status == Status::unstable;
      return report;
    }
    system.restore(work.before);
    system.evaluate();
    system.linearise();
  }
  if (const Report checked = check_reach(system, inputs); !checked.ok()) return checked;
  if (const Report begun = begin(work, home, inputs, question); !begun.ok()) return begun;
  Report report = failed(Status::stalled);
  if (!question.start || !jump(work, inputs, question, report)) report = travel(work, inputs, question);
  work.is_solved = report.ok();
  if (!work.is_solved) return report;
  const Report settled = settle(system, report, best_truncation);
  work.is_solved = settled.ok() || settled.status == Status::unstable;
  return settled;
}

namespace {

RodCoordinates coordinates_of(const SE3<double>& pose) {
  const SO3<double> q = pose.R.canonical();
  return {pose.p[2], q.v[0], q.v[1]};
}

/// The pose of these coordinates that keeps x, y and e₃.
std::optional<SE3<double>> with(const SE3<double>& pose, const RodCoordinates& wanted) {
  const double e3 = pose.R.canonical().v[2];
  const double square = 1 - wanted.e1 * wanted.e1 - wanted.e2 * wanted.e2 - e3 * e3;
  if (!(square > 1e-12)) return {};
  SE3<double> moved = pose;
  moved.p[2] = wanted.z;
  moved.R = {std::sqrt(square), Vec3<double>(wanted.e1, wanted.e2, e3)};
  return moved;
}

/// The first rod that shares this rod's input.
int first_of_input(const RodSystem& system, int rod) {
  int first = 0;
  while (system.input_of(first) != system.input_of(rod)) ++first;
  return first;
}

/// Newton's method on x, y, e₃ and the three lengths while z, e₁, e₂ are held.
class Inverse {
 public:
  Inverse(RodSystem& system, int& iterations) : system_(system), iterations_(iterations) {}

  /// From a state near by. False where it does not contract.
  bool correct(const RodCoordinates& wanted, double& residual) {
    double error = system_.evaluate();
    for (int k = 0; k < 12 && !(error <= 2e-13); ++k) {
      if (!step(wanted, RodSystem::Twist::Zero())) return false;
      const double next = system_.evaluate();
      if (!(next <= tolerance) && !(next < 0.5 * error)) return false;
      const bool is_done = next <= tolerance && !(next < 0.1 * error);
      error = next;
      if (is_done) break;
    }
    residual = error;
    return error <= tolerance;
  }

  /// One step, with a given motion of the platform beside; then exactly onto the wanted coordinates.
  bool step(const RodCoordinates& wanted, const RodSystem::Twist& given) {
    system_.linearise();  // the platform's own stiffness may be singular here
    const SO3<double> q = system_.platform().R.canonical();
    // de₃ at fixed e₁, e₂: q̇ = (−e₃/e₀, 0, 0, 1), ω = 2 q̇ q*
    const SO3<double> rate{-q.v[2] / q.w, Vec3<double>(0, 0, 1)};
    const Vec3<double> turn = 2 * rate.compose(q.inverse()).v;
    const auto stiffness = system_.stiffness();
    double matrix[36];
    for (int r = 0; r < 6; ++r) {
      matrix[6 * r] = stiffness(r, 0);
      matrix[6 * r + 1] = stiffness(r, 1);
      matrix[6 * r + 2] = stiffness(r, 3) * turn[0] + stiffness(r, 4) * turn[1] + stiffness(r, 5) * turn[2];
    }
    for (int input = 0; input < 3; ++input) {
      const RodSystem::Wrench feed = system_.feed_wrench(input);
      for (int r = 0; r < 6; ++r) matrix[6 * r + 3 + input] = feed[r];
    }
    Lu6 factors;
    if (!factors.factor(matrix, system_.radius())) return false;
    RodSystem::Wrench wanted_wrench = system_.missing();
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) wanted_wrench[r] -= stiffness(r, c) * given[c];
    double x[6];
    factors.solve(wanted_wrench.data(), x);
    RodSystem::Twist twist = given;
    twist[0] += x[0];
    twist[1] += x[1];
    twist.tail<3>() += x[2] * turn;
    if (!twist.allFinite()) return false;
    system_.move(twist, std::span<const double>(x + 3, 3));
    ++iterations_;
    for (int k = 0; k < system_.rods(); ++k)
      if (!(system_.length(k) > 0)) return false;
    const auto held = with(system_.platform(), wanted);
    if (!held) return false;
    system_.set_platform(*held);
    return true;
  }

 private:
  RodSystem& system_;
  int& iterations_;
};

}  // namespace

Report solve_rods_at(RodWork& work, const SE3<double>& home, const RodCoordinates& wanted,
                     const RodQuestion& question) {
  RodSystem& system = work.system;
  Report report;
  if (system.inputs() != 3) {
    report = failed(Status::left_domain);
    report.message.append("independent coordinates are for robots of three inputs");
    return report;
  }
  if (!std::isfinite(wanted.z) || !(wanted.e1 * wanted.e1 + wanted.e2 * wanted.e2 < 1) ||
      !question.wrench.allFinite()) {
    report = failed(Status::left_domain);
    report.message.append("e1 and e2 are parts of a unit quaternion: the sum of their squares is below 1");
    return report;
  }
  if (!(question.resume && work.is_solved))
    if (const Report begun = go_home(work, home); !begun.ok()) return begun;
  // home with its own lengths: the tied ones are made equal on the way
  const RodTarget from = present(system);
  const RodCoordinates begin = coordinates_of(system.platform());
  Inverse inverse(system, report.iterations);
  double part = 0, stride = 0.5;
  while (part < 1 && stride > 1e-7 && report.iterations < question.max_iterations) {
    const double next = std::min(1.0, part + stride);
    system.save(work.spare);
    const RodCoordinates now{begin.z + next * (wanted.z - begin.z), begin.e1 + next * (wanted.e1 - begin.e1),
                             begin.e2 + next * (wanted.e2 - begin.e2)};
    system.set_wrench(from.wrench + next * (question.wrench - from.wrench));
    for (int k = 0; k < system.rods(); ++k) {
      const int first = first_of_input(system, k);
      system.set_length(k,
                        system.length(first) + (1 - next) * (from.lengths[at(k)] - from.lengths[at(first)]));
    }
    const auto ahead = with(system.platform(), now);
    bool is_reached = false;
    if (ahead && (ahead->p - system.platform().p).norm() < 0.1 * system.length(0)) {
      RodSystem::Twist given;
      given << ahead->p - system.platform().p, ahead->R.compose(system.platform().R.inverse()).log();
      system.evaluate();
      is_reached =
          given.tail<3>().norm() < 0.3 && inverse.step(now, given) && inverse.correct(now, report.residual);
    }
    if (is_reached) {
      part = next;
      stride = 2 * (stride < 0.5 ? stride : 0.25);
    } else {
      system.restore(work.spare);
      stride = (next - part) / 4;
    }
  }
  system.evaluate();
  system.linearise();
  work.is_solved = part >= 1;
  if (work.is_solved) {
    if (system.truncation() > best_truncation && !system.is_fine()) {
      system.refine();
      work.is_solved = inverse.correct(wanted, report.residual);
    }
    if (work.is_solved) return settle(system, report, best_truncation);
  }
  RodPathEnd end;
  end.progress = part;
  end.iterations = report.iterations;
  end.residual = report.residual;
  return explain(system, end, false);
}

}  // namespace sinew::inline v0
