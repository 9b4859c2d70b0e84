#include "shooting_rod/rod_bvp.hpp"

#include <algorithm>
#include <cmath>

#include "math/inverse_sinc.hpp"
#include "math/linalg.hpp"
#include "shooting_rod/tip_gaps.hpp"
#include "sinew/base/numbers.hpp"
#include "solve/continuation.hpp"
#include "solve/message.hpp"
#include "solve/newton.hpp"

namespace sinew::inline v1 {
namespace {

using Turn = SO3<double>;
using Point = Vec3<double>;
constexpr double path_tolerance = 1e-6;  // of the length, on the way
constexpr double shortest_step = 1e-4;
constexpr int max_solves = 100;

/// Any unit vector at right angles.
Point beside(const Point& v) {
  Eigen::Index least = 0;
  v.cwiseAbs().minCoeff(&least);
  return cross(v, Point(Point::Unit(least))).normalized();
}

/// The least turn from one unit vector to another.
Point turn_between(const Point& from, const Point& to) {
  const Point axis = cross(from, to);
  const double sine = axis.norm(), angle = std::atan2(sine, dot(from, to));
  if (sine > 1e-12) return axis * (angle / sine);
  return dot(from, to) > 0 ? axis : Point(beside(from) * angle);
}

Point z_axis(const Turn& R) { return R.rotate(Point(0, 0, 1)); }

/// The equations of one rod between two ends, for Newton's method. Unknowns: force at the base in EI/L²,
/// base axes; moment there in EI/L, in the section's axes, where the last is the axial rotation instead if it
/// matters.
struct HoldProblem {
  static constexpr int unknowns = 6;
  using Point = Vec<double, 6>;

  SpatialRod rod;
  SE3<double> base, tip;
  double length = 0, stiffness = 0;
  RodEnds ends;
  Vec3<double> tip_moment{0, 0, 0};  // wanted of a ball, in EI/L: not 0 on the way
  bool seeks_axial_rotation = false;
  int steps = 0;

  double force_unit() const { return stiffness / (length * length); }
  double moment_unit() const { return stiffness / length; }

  RodState<double> base_state(const Point& x) const {
    const double axial_rotation = seeks_axial_rotation ? x[5] : 0, torque = seeks_axial_rotation ? 0 : x[5];
    const Turn R = base.R.compose(Turn::exp({0, 0, axial_rotation}));
    return {base.p, R, Vec3<double>(x.head<3>() * force_unit()),
            R.rotate(Vec3<double>(x[3], x[4], torque)) * moment_unit()};
  }

  Point unknowns_of(const RodState<double>& state, double axial_rotation) const {
    Point x;
    x.head<3>() = state.n / force_unit();
    x.tail<3>() = state.R.rotate_back(state.m) / moment_unit();
    if (seeks_axial_rotation) x[5] = axial_rotation;
    return x;
  }

  /// What an unknown changes at the base, as columns of RodTangent.
  Mat<double, 8, 6> base_columns(const RodState<double>& state) const {
    Mat<double, 8, 6> columns = Mat<double, 8, 6>::Zero();
    columns.topLeftCorner<3, 3>() = Mat<double, 3, 3>::Identity() * force_unit();
    columns.block<3, 3>(RodTangent::moment, 3) = state.R.matrix() * moment_unit();
    if (seeks_axial_rotation) {  // the moment goes with the frame
      columns.block<3, 1>(RodTangent::moment, 5) = cross(state.tangent(), state.m);
      columns(RodTangent::axial_rotation, 5) = 1;
    }
    return columns;
  }

  TipGaps gaps() const { return {ends.tip, tip, length, moment_unit(), tip_moment}; }

  bool linearise(const Point& x, Linearised<6>& system) const {
    const RodState<double> state = base_state(x);
    const RodTangent tangent = integrate_tangent(rod, length, state, {steps, 0});
    if (tangent.tip.status != Status::converged) return false;
    const Mat<double, 12, 6> rate = tangent.rate * base_columns(state);
    system.residual = gaps().gap(tangent.tip.state);
    system.jacobian = gaps().rows<6>(tangent.tip.state, rate);
    system.error = length * system.residual.lpNorm<Eigen::Infinity>();
    return system.jacobian.allFinite();
  }
  Point moved(const Point& x, const Point& step) const { return x + step; }
  /// A rod in higher and higher modes also meets the ends: no more than a fraction of a mode a step.
  double shortened(const Point& step) const {
    const double turn = seeks_axial_rotation ? 4 * std::abs(step[5]) : std::abs(step[5]);
    return 1 / std::max({1.0, step.head<3>().norm() / 20, step.segment<2>(3).norm() / 4, turn / 4});
  }
};

/// The exactly known rod that has the wanted chord: an arc of an even, straight, unloaded rod; where the
/// chord is longer than the rod, the stretched rod.
struct ArcStart {
  Turn base, tip;
  Point force{0, 0, 0}, moment{0, 0, 0};
};

/// @param side 0: the arc whose ends have least to turn; 1: its mirror image; 2, 3: at right angles to both
ArcStart arc_start(const HoldProblem& problem, int side) {
  const Point way = problem.tip.p - problem.base.p;
  const double chord = way.norm(), ratio = chord / problem.length;
  const Point t0 = z_axis(problem.base.R), t1 = z_axis(problem.tip.R);
  const Point along = chord > 1e-9 * problem.length ? Point(way / chord) : t0;
  ArcStart start;
  Point first = along, last = along;
  if (ratio < 1) {
    Point away = problem.ends.tip == RodEnds::Tip::ball ? t0 : Point(t0 - t1);
    away -= along * dot(along, away);
    if (away.norm() < 1e-6) away = t0 - along * dot(along, t0);
    if (away.norm() < 1e-6) away = beside(along);
    away.normalize();
    if (side >= 2) away = cross(along, away);
    if (side % 2 == 1) away = -away;
    const double half = inverse_sinc(ratio);
    first = std::cos(half) * along + std::sin(half) * away;
    last = std::cos(half) * along - std::sin(half) * away;
    const Point axis = cross(away, along);
    start.moment = axis * (2 * half);  // in EI/L
    start.base = Turn::exp(turn_between(t0, first)).compose(problem.base.R);
    start.tip = Turn::exp(Point(axis * (2 * half))).compose(start.base);
  } else {
    start.base = Turn::exp(turn_between(t0, along)).compose(problem.base.R);
    start.tip = start.base;
    const double compliance = problem.rod.extension_compliance;
    if (compliance > 0) start.force = along * ((ratio - 1) / compliance);
  }
  return start;
}

/// Steps that the tolerance asks for at x; the estimated error of those taken.
int steps_at(const HoldProblem& problem, const Vec<double, 6>& x, double tolerance, double& error) {
  const RodTip tip = integrate(problem.rod, problem.length, problem.base_state(x), {0, tolerance});
  error = tip.error;
  return std::max(tip.steps, 2);
}

/// On the way a few will do; but a taut rod that came out longer or shorter would be another task.
int path_steps(const HoldProblem& problem, const Vec<double, 6>& x) {
  const double slack = 1 - (problem.tip.p - problem.base.p).norm() / problem.length;
  double error = 0;
  return std::max(8, steps_at(problem, x, std::clamp(0.003 * std::abs(slack), 1e-9, 1e-5), error));
}

/// Follows the equilibrium from the arc to the rod as it is.
class Way {
 public:
  Way(const HoldProblem& goal, int side, const HoldOptions& options)
      : goal_(goal),
        options_(options),
        arc_(arc_start(goal, side)),
        base_turn_(arc_.base.compose(goal.base.R.inverse()).log()) {
    tip_turn_ = goal.ends.tip == RodEnds::Tip::clamp ? arc_.tip.compose(goal.tip.R.inverse()).log()
                                                     : turn_between(z_axis(goal.tip.R), z_axis(arc_.tip));
  }

  /// The problem at λ in 0 … 1.
  HoldProblem at(double lambda) const {
    HoldProblem problem = goal_;
    const double left = 1 - lambda;
    problem.base.R = Turn::exp(Point(base_turn_ * left)).compose(goal_.base.R);
    problem.tip.R = Turn::exp(Point(tip_turn_ * left)).compose(goal_.tip.R);
    problem.tip_moment = arc_.moment * left;
    problem.rod.load *= lambda;
    problem.rod.precurvature *= lambda;
    for (int i = 0; i < 2; ++i)
      problem.rod.bending_stiffness[i] = lambda * goal_.rod.bending_stiffness[i] + left * goal_.stiffness;
    return problem;
  }

  /// False where the path is lost; x is then that of the last point on it.
  bool follow(Vec<double, 6>& x, int& iterations) {
    RodState<double> state{goal_.base.p, arc_.base, arc_.force, Point(arc_.moment * goal_.moment_unit())};
    x = at(0).unknowns_of(state, 0);
    Vec<double, 6> before = x;
    double last = 0;
    ParameterPath end;
    follow_parameter(end, {{0.2, shortest_step}, 0, max_solves}, [&](double next, double taken) {
      ++end.iterations;
      Vec<double, 6> ahead = x;
      if (last > 0) ahead += (x - before) * (taken / last);
      const Vec<double, 6> predicted = ahead;
      HoldProblem problem = at(next);
      if (options_.steps == 0) problem.steps = path_steps(problem, x);
      const Report report =
          newton(problem, ahead, {path_tolerance * goal_.length, std::min(12, options_.max_iterations)});
      iterations += report.iterations;
      const double miss = (ahead - predicted).norm();
      if (!(report.ok() && miss < 1 + 0.3 * x.norm()))
        return ParameterStep{ParameterStep::failed, 0.4 * taken};
      before = x;
      x = ahead;
      last = taken;
      return ParameterStep{ParameterStep::reached, report.iterations <= 4 ? 1.7 * taken : taken};
    });
    return end.arrived;
  }

 private:
  const HoldProblem& goal_;
  const HoldOptions& options_;
  ArcStart arc_;
  Point base_turn_, tip_turn_;
};

/// Stiffness and feed by the implicit function theorem; false where the equations are singular.
bool differentiate(const HoldProblem& problem, const RodTangent& tangent, RodBvpSolution& held) {
  const Mat<double, 12, 6> rate = tangent.rate * problem.base_columns(held.base);
  const Mat<double, 12, 1> fed = tangent.rate.col(RodTangent::length);
  const TipGaps gaps = problem.gaps();
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> jacobian = gaps.rows<6>(tangent.tip.state, rate);
  Eigen::Matrix<double, 6, 7, Eigen::RowMajor> right, steps;
  right << -gaps.by_tip(tangent.tip.state), -gaps.rows<1>(tangent.tip.state, fed);
  const bool regular = solve(MatrixView(jacobian.data(), 6, 6), MatrixView(right.data(), 6, 7),
                             {steps.data(), static_cast<std::size_t>(steps.size())});
  if (!regular) return false;
  const Mat<double, 6, 7> wrench = rate.bottomRows<6>() * steps;
  held.stiffness = wrench.leftCols<6>();
  held.feed = wrench.col(6) + fed.tail<6>();
  if (problem.ends.tip == RodEnds::Tip::ball) {
    held.stiffness.bottomRows<3>().setZero();
    held.stiffness.rightCols<3>().setZero();
    held.feed.tail<3>().setZero();
  }
  return true;
}

/// Newton's method to the last digits, and as many steps of integration as these ask for.
bool polish(HoldProblem& problem, Vec<double, 6>& x, const HoldOptions& options, RodBvpSolution& held) {
  for (int round = 0; round < 4; ++round) {
    const NewtonOptions newton_options{0.1 * options.tolerance * problem.length, options.max_iterations};
    const Report report = newton(problem, x, newton_options);
    held.report.status = report.status;
    held.report.residual = report.residual;
    held.report.iterations += report.iterations;
    if (!report.ok() || report.residual > options.tolerance * problem.length) return false;
    const int wanted = steps_at(problem, x, options.tolerance, held.error);
    if (options.steps > 0 || wanted <= problem.steps) return true;
    problem.steps = wanted;
  }
  return true;
}

HoldProblem stated(const SpatialRod& rod, const SE3<double>& base, double length, const RodEnds& ends,
                   const SE3<double>& tip, const HoldOptions& options) {
  HoldProblem problem;
  problem.rod = rod;
  problem.base = base;
  problem.tip = tip;
  problem.length = length;
  problem.stiffness = std::sqrt(rod.bending_stiffness[0]) * std::sqrt(rod.bending_stiffness[1]);
  problem.ends = ends;
  const bool matters = ends.tip == RodEnds::Tip::clamp || !rod.is_isotropic();
  problem.seeks_axial_rotation = ends.base == RodEnds::Base::spins && matters;
  problem.steps = options.steps;
  return problem;
}

bool is_frame(const SE3<double>& x) {
  return x.p.allFinite() && std::abs(x.R.w * x.R.w + x.R.v.squaredNorm() - 1) < 1e-6;
}

/// Whether there is anything to solve; otherwise the report says why not.
bool is_answerable(const SpatialRod& rod, const SE3<double>& base, double length, const SE3<double>& tip,
                   Report& report) {
  report.status = Status::left_domain;
  if (!rod.is_valid()) {
    report.message.append("the rod's stiffnesses must be positive, its compliances not negative, all finite");
  } else if (!(std::isfinite(length) && length > 0)) {
    report.message.append("the rod's length must be positive");
  } else if (!is_frame(base) || !is_frame(tip)) {
    report.message.append("base and tip must be frames of finite numbers");
  } else {
    const double excess = (tip.p - base.p).norm() - length;
    if (!rod.is_kirchhoff() || excess <= 1e-12 * length) return true;
    report.status = Status::unreachable;
    report.residual = excess;
    report.message.append("the tip is farther away than the rod is long, by ");
    append_mm(report.message, excess);
  }
  return false;
}

RodBvpSolution unanswered() {
  RodBvpSolution held;
  held.stiffness.setConstant(not_a_number);
  held.feed.setConstant(not_a_number);
  return held;
}

/// Where the ends do not say how the base frame spins: from an equilibrium with its axial rotation held, on
/// to where the base has to hold no torque, downhill: dE/dψ = −m(0)·t(0). x is that of the problem with
/// axial rotation afterwards.
bool turn_downhill(const HoldProblem& problem, bool fixed_steps, Vec<double, 6>& x, int& iterations) {
  HoldProblem held = problem;
  held.seeks_axial_rotation = false;
  const double side = std::copysign(1.0, x[5]);
  double axial_rotation = 0;
  int solves = 0;
  const auto has_budget = [&] { return solves++ < max_solves; };
  const StepsEnd end =
      take_steps({0.2, shortest_step}, has_budget, [&](double step) -> std::optional<double> {
        held.base.R = problem.base.R.compose(Turn::exp({0, 0, axial_rotation + side * step}));
        Vec<double, 6> ahead = x;
        if (!fixed_steps) held.steps = path_steps(held, x);
        const Report report = newton(held, ahead, {path_tolerance * problem.length, 10});
        iterations += report.iterations;
        if (!(report.ok() && (ahead - x).norm() < 1 + 0.3 * x.norm())) return 0.4 * step;
        const bool passed = ahead[5] * x[5] <= 0;
        const double share = passed ? x[5] / (x[5] - ahead[5]) : 1;
        x += share * (ahead - x);
        axial_rotation += share * side * step;
        return passed ? std::nullopt : std::optional(step);
      });
  if (end != StepsEnd::done) return false;
  x[5] = axial_rotation;
  return x.allFinite();
}

/// From one arc to the equilibrium, to the last digits.
bool from_arc(HoldProblem& problem, int side, Vec<double, 6>& x, const HoldOptions& options,
              RodBvpSolution& held) {
  HoldProblem first = problem;
  const bool turns_free = problem.seeks_axial_rotation && problem.ends.tip != RodEnds::Tip::clamp;
  if (turns_free) first.seeks_axial_rotation = false;
  Way way(first, side, options);
  if (!way.follow(x, held.report.iterations)) return false;
  if (turns_free && !turn_downhill(problem, options.steps > 0, x, held.report.iterations)) return false;
  if (options.steps == 0) problem.steps = steps_at(problem, x, options.tolerance, held.error);
  return polish(problem, x, options, held);
}

/// Of four arcs the first that leads to a stable equilibrium; otherwise the first that leads to any.
bool from_arcs(HoldProblem& problem, Vec<double, 6>& x, const HoldOptions& options, RodBvpSolution& held) {
  bool found = false;
  for (int side = 0; side < 4; ++side) {
    HoldProblem attempt = problem;
    attempt.steps = options.steps;
    RodBvpSolution answer = held;
    Vec<double, 6> end = x;
    const bool arrived = from_arc(attempt, side, end, options, answer);
    held.report.iterations = answer.report.iterations;
    const RodState<double> base = attempt.base_state(end);
    const bool stable = arrived && unstable_directions(problem.rod, problem.length, base, problem.ends) == 0;
    if (stable || !found) {
      problem.steps = attempt.steps;
      x = end;
      held = answer;
    }
    if (stable) return true;
    found = found || arrived;
  }
  return found;
}

/// The numbers of the last iterate, whatever it is worth.
void conclude(HoldProblem& problem, const Vec<double, 6>& x, bool found, RodBvpSolution& held) {
  if (problem.steps == 0) problem.steps = path_steps(problem, x);  // nothing was found
  held.base = problem.base_state(x);
  held.axial_rotation = problem.seeks_axial_rotation ? x[5] : 0;
  const RodTangent tangent = integrate_tangent(problem.rod, problem.length, held.base, {problem.steps, 0});
  held.tip = tangent.tip.state;
  held.energy = tangent.tip.energy;
  held.steps = tangent.tip.steps;
  if (found && !differentiate(problem, tangent, held)) {
    held.report.status = Status::singular;
    held.report.message.append("the ends do not determine the forces: the rod is straight, or about to jump");
  }
  if (!found) {
    held.report.residual = problem.length * problem.gaps().gap(held.tip).lpNorm<Eigen::Infinity>();
    held.report.status = Status::stalled;
    held.report.message.append("no equilibrium was found with these ends");
  }
}

}  // namespace

RodBvpSolution solve_rod_bvp(const SpatialRod& rod, const SE3<double>& base, double length,
                             const RodEnds& ends, const SE3<double>& tip, const HoldOptions& options) {
  RodBvpSolution held = unanswered();
  if (!is_answerable(rod, base, length, tip, held.report)) return held;
  HoldProblem problem = stated(rod, base, length, ends, tip, options);
  Vec<double, 6> x = Vec<double, 6>::Zero();
  const bool found = from_arcs(problem, x, options, held);
  conclude(problem, x, found, held);
  return held;
}

RodBvpSolution solve_rod_bvp(const SpatialRod& rod, const SE3<double>& base, double length,
                             const RodEnds& ends, const SE3<double>& tip, const RodStart& start,
                             const HoldOptions& options) {
  RodBvpSolution held = unanswered();
  if (!is_answerable(rod, base, length, tip, held.report)) return held;
  HoldProblem problem = stated(rod, base, length, ends, tip, options);
  const Turn R = base.R.compose(Turn::exp({0, 0, problem.seeks_axial_rotation ? start.axial_rotation : 0}));
  Vec<double, 6> x = problem.unknowns_of({base.p, R, start.force, start.moment}, start.axial_rotation);
  bool found = x.allFinite();
  if (found && options.steps == 0) {  // coarsely first
    problem.steps = path_steps(problem, x);
    held.report.iterations = newton(problem, x, {path_tolerance * length, options.max_iterations}).iterations;
    problem.steps = steps_at(problem, x, options.tolerance, held.error);
  }
  if (found) found = polish(problem, x, options, held);
  if (!found) found = from_arcs(problem, x, options, held);
  conclude(problem, x, found, held);
  return held;
}

}  // namespace sinew::inline v1
