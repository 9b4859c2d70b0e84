#include "analysis/identify/quantities.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::inline v1::identification {
namespace {

constexpr double ln(double x) {  // of the few numbers below, by its series
  double y = 0, t = (x - 1) / (x + 1), power = t;
  for (int k = 1; k < 200; k += 2, power *= t * t) y += 2 * power / k;
  return y;
}
constexpr double degrees = std::numbers::pi / 180;

constexpr QuantityWords quantities[] = {
    {ArmQuantity::bending, "bending", "N m^2", Owner::section, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::bending_x, "bending.x", "N m^2", Owner::section, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::bending_y, "bending.y", "N m^2", Owner::section, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::torsion, "torsion", "N m^2", Owner::section, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::curvature_x, "curvature.x", "1/m", Owner::section, false, -3, 3, 0.5},
    {ArmQuantity::curvature_y, "curvature.y", "1/m", Owner::section, false, -3, 3, 0.5},
    {ArmQuantity::angle, "angle", "rad", Owner::passage, false, -25 * degrees, 25 * degrees, 5 * degrees},
    {ArmQuantity::radius, "radius", "m", Owner::passage, true, ln(0.75), ln(1.33), ln(1.05)},
    {ArmQuantity::compliance, "compliance", "m/N", Owner::tendon, true, ln(0.01), ln(100), ln(3)},
    {ArmQuantity::pretension, "pretension", "N", Owner::tendon, false, 0, 50, 2},
    {ArmQuantity::toe, "toe", "m", Owner::tendon, false, 0, 6e-3, 2e-3},
    {ArmQuantity::offset, "offset", "m", Owner::tendon, false, -8e-3, 8e-3, 4e-3},
    {ArmQuantity::gain, "gain", "", Owner::tendon, true, ln(0.8), ln(1.25), ln(1.02)},
    {ArmQuantity::lag, "lag", "s", Owner::arm, false, 0, 1, 0.1},
    {ArmQuantity::play, "play", "m", Owner::arm, false, 0, 2e-3, 2e-4},
    {ArmQuantity::gravity_x, "gravity.x", "m/s^2", Owner::arm, false, -9.81, 9.81, 5},
    {ArmQuantity::gravity_y, "gravity.y", "m/s^2", Owner::arm, false, -9.81, 9.81, 5},
    {ArmQuantity::gravity_z, "gravity.z", "m/s^2", Owner::arm, false, -9.81, 9.81, 5},
    {ArmQuantity::mass, "mass", "", Owner::arm, true, ln(0.1), ln(10), ln(2)},
    {ArmQuantity::tip_mass, "tip_mass", "kg", Owner::arm, false, 0, 0.05, 0.005},
    {ArmQuantity::marker_x, "marker.x", "m", Owner::arm, false, -0.03, 0.03, 0.005},
    {ArmQuantity::marker_y, "marker.y", "m", Owner::arm, false, -0.03, 0.03, 0.005},
    {ArmQuantity::marker_z, "marker.z", "m", Owner::arm, false, -0.03, 0.03, 0.005},
    {ArmQuantity::base_x, "base.x", "m", Owner::arm, false, -0.05, 0.05, 0.01},
    {ArmQuantity::base_y, "base.y", "m", Owner::arm, false, -0.05, 0.05, 0.01},
    {ArmQuantity::base_z, "base.z", "m", Owner::arm, false, -0.05, 0.05, 0.01},
    {ArmQuantity::tilt_x, "tilt.x", "rad", Owner::arm, false, -20 * degrees, 20 * degrees, 5 * degrees},
    {ArmQuantity::tilt_y, "tilt.y", "rad", Owner::arm, false, -20 * degrees, 20 * degrees, 5 * degrees},
    {ArmQuantity::tilt_z, "tilt.z", "rad", Owner::arm, false, -20 * degrees, 20 * degrees, 5 * degrees},
};

/// Calls with each number of a quantity.
template <class Visit>
void numbers_of(MeasuredArm& arm, ArmQuantity quantity, int tendon, int section, Visit visit) {
  Arm& body = arm.arm;
  const auto ends = [&](double CrossSection::*member) {
    visit(body.sections[at(section)].start.*member);
    visit(body.sections[at(section)].end.*member);
  };
  const auto k = static_cast<int>(quantity);
  switch (quantity) {
    case ArmQuantity::bending:
      ends(&CrossSection::bending_x);
      [[fallthrough]];
    case ArmQuantity::bending_y:
      return ends(&CrossSection::bending_y);
    case ArmQuantity::bending_x:
      return ends(&CrossSection::bending_x);
    case ArmQuantity::torsion:
      return ends(&CrossSection::torsion);
    case ArmQuantity::curvature_x:
      return visit(body.sections[at(section)].curvature[0]);
    case ArmQuantity::curvature_y:
      return visit(body.sections[at(section)].curvature[1]);
    case ArmQuantity::angle: {
      TendonRoute& route = body.tendons[at(tendon)].routes[at(section)];
      visit(route.start_angle);
      return visit(route.end_angle);
    }
    case ArmQuantity::radius: {
      TendonRoute& route = body.tendons[at(tendon)].routes[at(section)];
      visit(route.start_radius);
      return visit(route.end_radius);
    }
    case ArmQuantity::compliance:
      return visit(body.tendons[at(tendon)].compliance);
    case ArmQuantity::pretension:
      return visit(body.tendons[at(tendon)].pretension);
    case ArmQuantity::toe:
      return visit(arm.drive.toe[at(tendon)]);
    case ArmQuantity::offset:
      return visit(arm.drive.offset[at(tendon)]);
    case ArmQuantity::gain:
      return visit(arm.drive.gain[at(tendon)]);
    case ArmQuantity::lag:
      return visit(arm.drive.lag);
    case ArmQuantity::play:
      return visit(arm.drive.play);
    case ArmQuantity::mass:
      for (ArmSection& part : body.sections) {
        visit(part.start.mass);
        visit(part.end.mass);
        visit(part.discs.mass);
      }
      return;
    case ArmQuantity::tip_mass:
      return visit(body.tip_mass);
    case ArmQuantity::gravity_x:
    case ArmQuantity::gravity_y:
    case ArmQuantity::gravity_z:
      return visit(body.gravity[at(k - static_cast<int>(ArmQuantity::gravity_x))]);
    case ArmQuantity::marker_x:
    case ArmQuantity::marker_y:
    case ArmQuantity::marker_z:
      return visit(arm.marker.place[at(k - static_cast<int>(ArmQuantity::marker_x))]);
    case ArmQuantity::base_x:
    case ArmQuantity::base_y:
    case ArmQuantity::base_z:
      return visit(arm.marker.base[at(k - static_cast<int>(ArmQuantity::base_x))]);
    case ArmQuantity::tilt_x:
    case ArmQuantity::tilt_y:
    case ArmQuantity::tilt_z:
      return visit(arm.marker.tilt[at(k - static_cast<int>(ArmQuantity::tilt_x))]);
  }
}

}  // namespace

std::span<const QuantityWords> all_quantities() { return quantities; }
const QuantityWords& words_of(ArmQuantity quantity) { return quantities[static_cast<int>(quantity)]; }

MeasuredArm completed(MeasuredArm arm) {
  arm.drive.gain.resize(arm.arm.tendons.size(), 1.0);
  arm.drive.toe.resize(arm.arm.tendons.size(), 0.0);
  arm.drive.offset.resize(arm.arm.tendons.size(), 0.0);
  return arm;
}

bool is_of_masses(const FitParameter& parameter) {
  return parameter.fields.front().quantity == ArmQuantity::mass;
}

double value_of(const MeasuredArm& arm, const FitParameter& parameter) {
  if (is_of_masses(parameter)) return 1;
  MeasuredArm copy = arm;
  double value = 0;
  bool found = false;
  each(copy, parameter.fields.front(), [&](int tendon, int section) {
    numbers_of(copy, parameter.fields.front().quantity, tendon, section, [&](double& x) {
      if (!found) value = x;
      found = true;
    });
  });
  return value;
}

double first_coordinate(const MeasuredArm& start, const FitParameter& parameter) {
  MeasuredArm copy = start;
  bool has_zero = false;
  for (const ArmField& field : parameter.fields)
    if (field.quantity == ArmQuantity::toe)
      each(start, field, [&](int tendon, int section) {
        numbers_of(copy, field.quantity, tendon, section,
                   [&](double& toe) { has_zero = has_zero || toe == 0; });
      });
  constexpr double usual_toe = 2e-3;  // [m]
  return has_zero ? std::min(usual_toe, parameter.upper) : 0;
}

MeasuredArm changed(const MeasuredArm& start, const std::vector<FitParameter>& parameters,
                    const Eigen::VectorXd& x) {
  MeasuredArm arm = start;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double c = x[static_cast<Eigen::Index>(p)], factor = std::exp(c);
    for (const ArmField& field : parameters[p].fields)
      each(start, field, [&](int tendon, int section) {
        numbers_of(arm, field.quantity, tendon, section,
                   [&](double& number) { number = parameters[p].is_factor ? number * factor : number + c; });
      });
  }
  return arm;
}

}  // namespace sinew::inline v1::identification
