#include "kinematics/rods/sense.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/rods/verdict.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int count = 6;

/// The platform's pose by the axial forces, at fixed lengths.
class Sensor {
 public:
  explicit Sensor(RodGroup& system) : system_(system) {}

  /// Largest of the rods' own errors and of what is missing in force, over EI/L².
  double error(const std::array<double, 6>& wanted) {
    system_.evaluate();
    double worst = system_.limb_error();
    for (int k = 0; k < count; ++k) {
      const double length = system_.length(k), unit = system_.stiffness(k) / (length * length);
      const double missing = std::abs(system_.effort(k) - wanted[at(k)]) / unit;
      worst = std::max(worst, missing) + missing * 0;
    }
    return worst;
  }

  /// ∂axial/∂(p, r φ), r the platform's radius, at the point last evaluated.
  std::array<double, 36> rows() {
    system_.linearise();  // the platform's own stiffness is not asked for
    std::array<double, 36> rows;
    for (int k = 0; k < count; ++k) {
      const Vec<double, 6> row = system_.effort_jacobian(k);
      for (int c = 0; c < 6; ++c) rows[at(6 * k + c)] = row[c] / (c < 3 ? 1 : system_.radius());
    }
    return rows;
  }

  /// Newton's step, no further than a linearisation can be trusted.
  bool step(const std::array<double, 6>& wanted) {
    const std::array<double, 36> matrix = rows();
    std::array<double, 6> missing, moved;
    for (int k = 0; k < count; ++k) missing[at(k)] = wanted[at(k)] - system_.closing_effort(k);
    if (!solve(MatrixView(matrix.data(), 6, 6), MatrixView(missing.data(), 6, 1), moved)) return false;
    Vec<double, 6> twist;
    for (int c = 0; c < 6; ++c) twist[c] = moved[at(c)] / (c < 3 ? 1 : system_.radius());
    if (!(std::hypot(twist.head<3>().norm(), system_.radius() * twist.tail<3>().norm()) <
          0.3 * system_.length(0)))
      return false;
    system_.move(twist);
    return true;
  }

 private:
  RodGroup& system_;
};

/// ∂wrench/∂axial = ∂wrench/∂twist (∂axial/∂twist)⁻¹. False where the forces do not fix the pose.
bool differentiate(RodGroup& system, RodSensing& sensing) {
  Sensor sensor(system);
  const std::array<double, 36> rows = sensor.rows();
  std::array<double, 36> inverse, identity{};
  for (std::size_t k = 0; k < 6; ++k) identity[7 * k] = 1;
  if (!solve(MatrixView(rows.data(), 6, 6), MatrixView(identity.data(), 6, 6), inverse)) return false;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      double sum = 0;
      for (int k = 0; k < 6; ++k)
        sum += system.stiffness()(r, k) * inverse[at(6 * k + c)] / (k < 3 ? 1 : system.radius());
      sensing.rows[at(6 * r + c)] = sum;
    }
  return true;
}

}  // namespace

Report sense_rods(RodWork& work, RodSensing& sensing) {
  RodGroup& system = *work.system;
  work.knows_feeding = false;
  Report report;
  Sensor sensor(system);
  std::array<double, 6> from, wanted;
  sensor.error(sensing.axial);
  for (int k = 0; k < count; ++k) from[at(k)] = system.effort(k);
  ParameterPath end;
  follow_parameter(end, {{1, 1e-4, work.stop}, 0, sensing.max_iterations}, [&](double next, double taken) {
    for (std::size_t k = 0; k < wanted.size(); ++k) wanted[k] = std::lerp(from[k], sensing.axial[k], next);
    system.save(work.spare);
    if (contract([&] { return sensor.error(wanted); }, [&] { return sensor.step(wanted); }, rod_tolerance,
                 rod_rounding, end.iterations, report.residual))
      return ParameterStep{ParameterStep::reached, 2 * taken};
    system.restore(work.spare);
    return ParameterStep{ParameterStep::failed, taken / 4};
  });
  report.iterations = end.iterations;
  work.is_solved = false;
  if (!end.arrived) {
    if (note_stop(work.stop, report)) return report;
    report.status = end.ran_out ? Status::iteration_limit : Status::singular;
    report.message.append(end.ran_out
                              ? "the way to these forces takes more steps than max_iterations; raise it"
                              : "no wrench near the unloaded platform makes the rods pull so; check signs "
                                "(pull > 0) and lengths");
    return report;
  }
  while (!system.is_finest() && system.truncation() > sensing.truncation) {
    system.refine();
    if (contract([&] { return sensor.error(sensing.axial); }, [&] { return sensor.step(sensing.axial); },
                 rod_tolerance, rod_rounding, report.iterations, report.residual))
      continue;
    report.status = Status::stalled;
    report.message.append("the rods bend too sharply to be resolved");
    return report;
  }
  if (!differentiate(system, sensing)) {
    report.status = Status::singular;
    report.message.append(
        "here the rods' axial forces do not tell the wrench: some motion changes none of them");
    return report;
  }
  system.set_wrench(system.wrench() - system.wrench_residual());
  system.evaluate();
  system.linearise();
  return report;
}

}  // namespace sinew::inline v1
