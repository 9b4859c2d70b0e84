#include "kinematics/rods/hold.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/rods/start.hpp"
#include "kinematics/rods/verdict.hpp"

namespace sinew::inline v0 {
namespace {

using Twist = Vec<double, 6>;

/// From pose to pose as one twist.
Twist between(const SE3<double>& from, const SE3<double>& to) {
  Twist twist;
  twist << to.p - from.p, to.R.compose(from.R.inverse()).log();
  return twist;
}

/// Newton's method on the lengths while the platform is put where it is wanted.
template <class System>
class Holder {
 public:
  explicit Holder(RodWorkOf<System>& work) : work_(work), system_(work.system) {}

  /// Factors at the point last evaluated.
  bool renew() {
    system_.linearise();  // the platform's own stiffness may be singular here
    double matrix[36];
    for (int input = 0; input < 6; ++input) {
      const Twist feed = system_.feed_wrench(input);
      for (int r = 0; r < 6; ++r) matrix[6 * r + input] = feed[r];
    }
    return work_.knows_feeding = work_.feeding.factor(matrix, system_.radius());
  }

  /// To `pose` with the last factors, `fresh` right after `renew`. False where a rod would be no rod.
  bool step(const SE3<double>& pose, bool fresh) {
    const Twist given = between(system_.platform(), pose);
    if (!fresh) system_.step(false);
    const Twist wanted = system_.missing() - system_.stiffness() * given;
    double fed[6];
    work_.feeding.solve(wanted.data(), fed);
    for (int k = 0; k < system_.rods(); ++k)
      if (!(system_.length(k) + fed[system_.input_of(k)] > 0)) return false;
    system_.move(given, fed);
    system_.set_platform(pose);
    return true;
  }

  /// Newton's method with the platform there. Down to `tolerance`, or a little further.
  bool correct(const SE3<double>& pose, int& iterations, double& residual, double tolerance) {
    return contract([&] { return system_.evaluate(); }, [&] { return renew() && step(pose, true); },
                    tolerance, iterations, residual);
  }

  /// From the state before, near by: a step or two with the factors kept from there, then with new ones, and
  /// with those kept as long as they gain as much as newer ones would.
  bool follow(const SE3<double>& pose, Report& report, double tolerance) {
    constexpr double worth_starting = 1e-6, worth_renewing = 3e-9;
    double error = 0;
    int renewals = 0;
    for (int& k = report.iterations; k == 0 || !(error <= tolerance); ++k) {
      const bool renews = renewals == 0 ? k == 2 || (k == 1 && error < worth_starting)
                                        : renewals < 3 && error > worth_renewing;
      if (renews && !renew()) return false;
      renewals += renews;
      if (!step(pose, renews)) return false;
      const double next = system_.evaluate(false);
      if (renewals > 0 && !(next < 0.3 * error) && !(next <= tolerance)) return false;
      if (k > 10) return false;
      error = next;
    }
    report.residual = error;
    return true;
  }

 private:
  RodWorkOf<System>& work_;
  System& system_;
};

/// The way of a platform and of the load on it, from where the system is.
struct HoldPath {
  SE3<double> from, to;
  Twist turn;  ///< the rotation between, as a twist
  Twist load_from, load_to;

  SE3<double> pose(double part) const {
    if (part >= 1) return to;
    return {from.p + part * (to.p - from.p), SO3<double>::exp(part * turn.tail<3>()).compose(from.R)};
  }
  Twist load(double part) const { return load_from + part * (load_to - load_from); }
};

/// Corrections must stay small beside the prediction: else it may have found another branch.
class Watch {
 public:
  template <class System>
  explicit Watch(const System& system) : rods_(system.rods()) {
    read(system, before_);
  }
  template <class System>
  void predicted(const System& system) {
    read(system, predicted_);
  }
  template <class System>
  bool is_near(const System& system) const {
    double change = 0, correction = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(rods_); ++k) {
      change = std::max(change, std::abs(predicted_[k] - before_[k]));
      correction = std::max(correction, std::abs(system.length(static_cast<int>(k)) - predicted_[k]));
    }
    return correction < 0.5 * change + 0.01 * system.length(0);
  }

 private:
  using Lengths = std::array<double, max_rods>;
  template <class System>
  void read(const System& system, Lengths& to) const {
    for (int k = 0; k < rods_; ++k) to[static_cast<std::size_t>(k)] = system.length(k);
  }
  int rods_;
  Lengths before_, predicted_;
};

/// Follows the path as far as it goes. The system is then there, solved to `loose`.
template <class System>
RodPathEnd follow_poses(RodWorkOf<System>& work, const HoldPath& path, int max_iterations) {
  constexpr double loose = 1e-5, loose_truncation = 1e-9, shortest = 1e-6;
  System& system = work.system;
  Holder<System> holder(work);
  RodPathEnd end;
  double stride = 0.25;
  while (end.progress < 1 && stride > shortest && end.iterations < max_iterations) {
    const double next = std::min(1.0, end.progress + stride);
    system.save(work.spare);
    system.evaluate();
    const bool renews = !work.knows_feeding;
    Watch watch(system);
    system.set_wrench(path.load(next));
    bool is_reached = (!renews || holder.renew()) && holder.step(path.pose(next), renews);
    watch.predicted(system);
    const int before = ++end.iterations;
    const auto correct = [&] { return holder.correct(path.pose(next), end.iterations, end.residual, loose); };
    is_reached = is_reached && correct() && watch.is_near(system);
    while (is_reached && !system.is_finest() && system.truncation() > loose_truncation) {
      system.refine();
      is_reached = correct();
    }
    if (is_reached) {
      stride = (end.iterations - before <= 1 ? 2 : 1) * (next - end.progress);
      end.progress = next;
    } else {
      system.restore(work.spare);
      work.knows_feeding = false;
      stride = (next - end.progress) / 3;
    }
  }
  end.arrived = end.progress >= 1;
  end.ran_out = !end.arrived && end.iterations >= max_iterations;
  system.evaluate();
  return end;
}

/// Why the lengths do not follow the platform further: the system is where they still do.
template <class System>
Report explain_hold(RodWorkOf<System>& work, const RodPathEnd& end) {
  System& system = work.system;
  system.linearise();
  Holder<System> holder(work);
  holder.renew();
  constexpr double singular = 0.02;  // with the square root of what is left of the path
  if (end.ran_out || work.feeding.smallest_pivot() > singular) return explain(system, end, false);
  Report report = failed(Status::singular);
  report.iterations = end.iterations;
  report.residual = end.residual;
  report.message.append("the lengths pass a fold at ");
  append_number(report.message, static_cast<int>(100 * end.progress));
  report.message.append(" % of the way from home, where the platform is at ");
  for (int k = 0; k < 3; ++k) {
    append_mm(report.message, system.platform().p[k]);
    report.message.append(k < 2 ? ", " : "");
  }
  report.message.append(", turned by ");
  append_degrees(report.message, system.platform().R.log().norm());
  report.message.append(": no lengths nearby hold it beyond");
  return report;
}

template <class System>
Report check(const System& system, const SE3<double>& wanted, const RodQuestion& question) {
  Report report;
  if (system.inputs() != 6) {
    report = failed(Status::left_domain);
    report.message.append("a pose is held by six rod lengths, this robot has ");
    append_number(report.message, system.inputs());
  } else if (!wanted.p.allFinite() || !wanted.R.v.allFinite() || !std::isfinite(wanted.R.w) ||
             !question.wrench.allFinite()) {
    report = failed(Status::left_domain);
    report.message.append("the pose or the wrench is not a number");
  }
  return report;
}

/// The last digits, on elements that resolve the shapes.
template <class System>
Report finish(RodWorkOf<System>& work, const SE3<double>& wanted, Report report, double truncation) {
  System& system = work.system;
  Holder<System> holder(work);
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
    report.message.append("the pose is reached, but not to the last digits; the rods bend too sharply");
    return report;
  }
  return settle(system, report, truncation);
}

}  // namespace

template <class System>
Report hold_rods(RodWorkOf<System>& work, const SE3<double>& home, const SE3<double>& wanted,
                 const RodQuestion& question) {
  System& system = work.system;
  if (const Report checked = check(system, wanted, question); !checked.ok()) return checked;
  Report report;
  if (question.resume && work.is_solved) {
    system.save(work.before);
    system.set_wrench(question.wrench);
    Holder<System> holder(work);
    bool is_near = true;
    const bool is_lighter = system.can_coarsen(System::quick_truncation);
    if (is_lighter) system.coarsen();
    if (is_lighter || !work.knows_feeding) {
      system.evaluate();
      is_near = holder.renew();
    }
    if (is_near && holder.follow(wanted, report, question.judge ? rod_tolerance : rod_quick_tolerance)) {
      if (question.judge || (system.truncation() > System::quick_truncation && !system.is_finest()))
        report = finish(work, wanted, report, question.judge ? coarse_truncation : System::quick_truncation);
      work.is_solved = report.ok() || report.status == Status::unstable;
      return report;
    }
    system.restore(work.before);
    report = {};
  } else if (const Report begun = go_home(work, home); !begun.ok()) {
    return begun;
  }
  work.knows_feeding = false;
  const HoldPath path{system.platform(), wanted, between(system.platform(), wanted), system.wrench(),
                      question.wrench};
  const RodPathEnd end = follow_poses(work, path, question.max_iterations);
  report.iterations = end.iterations;
  work.is_solved = end.arrived;
  if (!end.arrived) {
    work.is_solved = false;
    return explain_hold(work, end);
  }
  report = finish(work, wanted, report, System::best_truncation);
  work.is_solved = report.ok() || report.status == Status::unstable;
  return report;
}

template Report hold_rods(RodWorkOf<RodSystem>&, const SE3<double>&, const SE3<double>&, const RodQuestion&);
template Report hold_rods(RodWorkOf<TangentSystem>&, const SE3<double>&, const SE3<double>&,
                          const RodQuestion&);

}  // namespace sinew::inline v0
