#include "io/robots/actuation.hpp"
#include "io/document/reader.hpp"
#include "io/robots/serial_file.hpp"

#include <algorithm>

namespace sinew::inline v1 {

TendonMotor read_motor(Reader& motor) {
  constexpr Range ratio{.low = 0, .high = 1e9, .low_excluded = true};
  TendonMotor m;
  m.lead = motor.required("lead", "way of the screw in one turn").quantity(Dimension::length, Range::size());
  m.counts = motor.required("counts", "of the encoder in one turn").number(ratio);
  if (const auto gear = motor.optional("gear")) m.gear = gear->number(ratio);
  motor.close();
  return m;
}

TendonStretch read_stretch(Reader& stretch) {
  TendonStretch s;
  s.stiffness = stretch.required("stiffness", "EA of a tendon").quantity(Dimension::force, Range::positive());
  if (const auto outside = stretch.optional("outside"))
    s.outside = outside->quantity(Dimension::length, {.low = 0, .high = Range::size().high});
  stretch.close();
  return s;
}

double usual_tolerance(double robot_length, const std::optional<TendonMotor>& motor) {
  constexpr double strain = 3e-4;
  return std::max(strain * robot_length, motor ? 1 / motor->counts_per_length() : 0);
}

}  // namespace sinew::inline v1
