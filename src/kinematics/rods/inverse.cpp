#include "kinematics/rods/inverse.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/rods/start.hpp"
#include "kinematics/rods/verdict.hpp"
#include "robot/pose.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

IndependentPose coordinates_of(const SE3<double>& pose) {
  const SO3<double> q = pose.R.canonical();
  return {pose.p[2], q.v[0], q.v[1]};
}

/// The pose of these coordinates that keeps x, y and e₃.
std::optional<SE3<double>> with(const SE3<double>& pose, const IndependentPose& wanted) {
  const double e3 = pose.R.canonical().v[2];
  const double square = 1 - wanted.e1 * wanted.e1 - wanted.e2 * wanted.e2 - e3 * e3;
  if (!(square > 1e-12)) return {};
  SE3<double> moved = pose;
  moved.p[2] = wanted.z;
  moved.R = {std::sqrt(square), Vec3<double>(wanted.e1, wanted.e2, e3)};
  return moved;
}

/// The first rod that shares this rod's input.
int first_of_input(const RodGroup& system, int rod) {
  int first = 0;
  while (system.input_of(first) != system.input_of(rod)) ++first;
  return first;
}

/// Newton's method on x, y, e₃ and the three lengths while z, e₁, e₂ are held.
class PoseNewton {
 public:
  PoseNewton(RodGroup& system, int& iterations) : system_(system), iterations_(iterations) {}

  /// From a state near by. False where it does not contract.
  bool correct(const IndependentPose& wanted, double& residual) {
    return contract([&] { return system_.evaluate(); }, [&] { return step(wanted, RodGroup::Twist::Zero()); },
                    rod_tolerance, rod_rounding, iterations_, residual);
  }

  /// One step, with a given motion of the platform beside; then exactly onto the wanted coordinates.
  bool step(const IndependentPose& wanted, const Vec<double, 6>& given) {
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
      const Vec<double, 6> feed = system_.input_wrench_jacobian(input);
      for (int r = 0; r < 6; ++r) matrix[6 * r + 3 + input] = feed[r];
    }
    SmallLu<6> factors;
    if (!factors.factor(matrix, system_.radius())) return false;
    Vec<double, 6> wanted_wrench = system_.wrench_residual();
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) wanted_wrench[r] -= stiffness(r, c) * given[c];
    double x[6];
    factors.solve(wanted_wrench.data(), x);
    Vec<double, 6> twist = given;
    twist[0] += x[0];
    twist[1] += x[1];
    twist.tail<3>() += x[2] * turn;
    if (!twist.allFinite()) return false;
    system_.move(twist, std::span<const double>(x + 3, 3));
    for (int k = 0; k < system_.limbs(); ++k)
      if (!(system_.length(k) > 0)) return false;
    const auto held = with(system_.platform(), wanted);
    if (!held) return false;
    system_.set_platform(*held);
    return true;
  }

 private:
  RodGroup& system_;
  int& iterations_;
};

}  // namespace

Report solve_rods_at(RodWork& work, const SE3<double>& home, const IndependentPose& wanted,
                     const RodQuestion& question) {
  RodGroup& system = *work.system;
  work.knows_feeding = false;
  work.signs.reset();
  Report report;
  if (system.inputs() != 3) {
    report = failed(Status::unsupported);
    report.message.append("independent coordinates are for robots of three inputs");
    return report;
  }
  if (!std::isfinite(wanted.z) || !(wanted.e1 * wanted.e1 + wanted.e2 * wanted.e2 < 1) ||
      !question.wrench.allFinite()) {
    report = failed(Status::left_domain);
    report.message.append("e1 and e2 are parts of a unit quaternion: the sum of their squares is below 1");
    return report;
  }
  if (note_stop(work.stop, report)) return report;
  if (!(question.warm_start && work.is_solved))
    if (const Report begun = go_home(work, home); !begun.ok()) return begun;
  // home with its own lengths: the tied ones are made equal on the way
  const RodTarget from = present(system);
  const IndependentPose begin = coordinates_of(system.platform());
  RodPathEnd end;
  end.residual = 0;
  PoseNewton newton(system, end.iterations);
  follow_parameter(end, {{0.5, 1e-7, work.stop}, 0, question.max_iterations}, [&](double next, double taken) {
    system.save(work.spare);
    const IndependentPose now{begin.z + next * (wanted.z - begin.z), begin.e1 + next * (wanted.e1 - begin.e1),
                              begin.e2 + next * (wanted.e2 - begin.e2)};
    system.set_wrench(from.wrench + next * (question.wrench - from.wrench));
    for (int k = 0; k < system.feeds(); ++k) {
      const int first = first_of_input(system, k);
      system.set_feed(k, system.held(first) + (1 - next) * (from.lengths[at(k)] - from.lengths[at(first)]));
    }
    const auto ahead = with(system.platform(), now);
    bool is_reached = false;
    if (ahead && (ahead->p - system.platform().p).norm() < 0.1 * system.length(0)) {
      const Vec<double, 6> given = twist_between(system.platform(), *ahead);
      system.evaluate();
      is_reached =
          given.tail<3>().norm() < 0.3 && newton.step(now, given) && newton.correct(now, end.residual);
      ++end.iterations;  // the step that led there
    }
    if (is_reached) return ParameterStep{ParameterStep::reached, std::min(2 * taken, 0.5)};
    system.restore(work.spare);
    return ParameterStep{ParameterStep::failed, taken / 4};
  });
  system.evaluate();
  system.linearise();
  work.is_solved = end.arrived;
  while (work.is_solved && system.truncation() > system.traits().best_truncation && !system.is_finest()) {
    system.refine();
    work.is_solved = newton.correct(wanted, end.residual);
  }
  if (!work.is_solved) return explain(system, end, {}, false);
  report.iterations = end.iterations;
  report.residual = end.residual;
  report = settle(work, report, system.traits().best_truncation);
  work.is_solved = report.is_solved();
  return report;
}

}  // namespace sinew::inline v1
