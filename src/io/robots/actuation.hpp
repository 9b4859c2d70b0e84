/// @file actuation.hpp
/// What moves tendons and joints, as files say it.
#pragma once
#include <optional>

#include "io/document/reader.hpp"
#include "io/robots/serial_file.hpp"
#include "sinew/robot/serial.hpp"
#include "tendon/theta_is.hpp"

namespace sinew::inline v1 {

/// `{lead, counts, gear}`.
TendonMotor read_motor(Reader& motor);

/// `{stiffness, outside}`.
TendonStretch read_stretch(Reader& stretch);

/// `tangent` or `chord`.
ThetaIs read_theta_is(const Reader& word);

/// Tolerance of a tendon where a file gives none [m]: a steel tendon as long as the robot stretches by 0.03 %
/// at 60 MPa, and no encoder tells less than its step. With 0 a rounded number would be slack.
double usual_tolerance(double robot_length, const std::optional<TendonMotor>& motor);

}  // namespace sinew::inline v1
