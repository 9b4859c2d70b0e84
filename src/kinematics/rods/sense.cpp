#include "kinematics/rods/sense.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/rods/verdict.hpp"

namespace sinew::inline v1 {
namespace {

EffortSensor<Spatial>::Measured measured_of(const RodGroup& system, const RodSensing& sensing) {
  EffortSensor<Spatial>::Measured measured;
  for (int k = 0; k < 6; ++k) {
    const double length = system.length(k);
    measured[at(k)] = {k, sensing.axial[at(k)], system.stiffness(k) / (length * length)};
  }
  return measured;
}

}  // namespace

Report sense_rods(RodWork& work, RodSensing& sensing) {
  RodGroup& system = *work.system;
  work.is_solved = work.knows_feeding = false;
  EffortSensor<Spatial> sensor(system, measured_of(system, sensing));
  const auto error = [&] {
    system.evaluate();
    return sensor.error();
  };
  const auto step = [&] {
    system.linearise();  // the platform's own stiffness is not asked for
    const auto twist = sensor.step();
    if (!twist || !(std::hypot(twist->head<3>().norm(), system.radius() * twist->tail<3>().norm()) <
                    0.3 * system.length(0)))
      return false;  // no further than a linearisation can be trusted
    system.move(*twist);
    return true;
  };
  Report report =
      sensor.find(work.spare, {{1, 1e-4, work.stop}, 0, sensing.max_iterations}, sensing.truncation,
                  Status::singular, [&](int& iterations, double& residual) {
                    return contract(error, step, rod_tolerance, rod_rounding, iterations, residual);
                  });
  if (!report.ok()) return report;
  system.linearise();
  const auto rows = sensor.sensitivity();
  if (!rows) {
    EffortSensor<Spatial>::say_undetermined(report);
    return report;
  }
  sensing.rows = *rows;
  system.set_wrench(system.wrench() - system.wrench_residual());
  system.evaluate();
  system.linearise();
  return report;
}

}  // namespace sinew::inline v1
