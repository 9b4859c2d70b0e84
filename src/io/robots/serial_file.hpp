/// @file serial_file.hpp
/// Files of serial robots (`kind: serial`): a list of sections, or one section and how often it comes.
/// Format: docs/robot-files.md
#pragma once
#include <string>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// Whether a document says `kind: serial`.
bool is_serial(const Document& document);

/// The serial robot a document describes.
Expected<SerialRobot> read_serial_robot(const Document& document);

/// The motor a document describes: `lead`, `counts`, `gear`, as under the key `motor` of a robot.
Expected<TendonMotor> read_motor(const Document& document);

/// The same document with `sections: {count, ...}` written out as a list; unchanged if it is one.
Expected<Document> expanded_sections(const Document& document);

}  // namespace sinew::inline v1
