/// @file actuation.hpp
/// What moves the tendons of a serial robot or an arm, as files say it.
#pragma once
#include <optional>

#include "sinew/io/reader.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// `{lead, counts, gear}`.
TendonMotor read_motor(Reader& motor);

/// `{stiffness, outside}`.
TendonStretch read_stretch(Reader& stretch);

/// Tolerance of a tendon where a file gives none [m]: a steel tendon as long as the robot stretches by 0.03 %
/// at 60 MPa, and no encoder tells less than its step. With 0 a rounded number would be slack.
double usual_tolerance(double robot_length, const std::optional<TendonMotor>& motor);

}  // namespace sinew::inline v1
