/// @file robot_file.hpp
/// Robot files. A file lists legs (base, link, closure, platform point, what is actuated, what is tied); a
/// named architecture is a short form that expands to such a list before anything is read. Format:
/// docs/robot-files.md
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/robot/robot.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// The document of a robot file, or of a robot that is part of the library (`3-rfr`; see
/// `builtin_robot_names`).
SINEW_API Expected<Document> read_robot_file(const std::string& path_or_name);

/// Its text, as it is in the file or in the library.
SINEW_API Expected<std::string> read_robot_text(const std::string& path_or_name);

/// Names of the robots that are part of the library: those of robots/*.yaml.
SINEW_API std::vector<std::string_view> builtin_robot_names();

/// Text of a commented robot file to start from, `four-legged`: one of examples/robots/*.yaml, without
/// `.yaml`. Empty if there is none of that name.
SINEW_API std::string_view robot_template(std::string_view name);
/// Names of the robot files to start from.
SINEW_API std::vector<std::string_view> robot_template_names();

/// Text of a commented scene file to start from: examples/scenes/wall.yaml. Format: docs/scenes.md
SINEW_API std::string_view scene_template();

/// The robot in a file, or the one of that name; or every error of the file at once, each with its line and
/// column.
///
///     auto robot = sinew::load("robots/3-rfr.yaml").value();
SINEW_API Expected<Robot> load(const std::string& path_or_name);

/// The sections of a serial robot in a file, or of the one of that name (`nottingham-tpcj`).
SINEW_API Expected<SerialRobot> load_serial(const std::string& path_or_name);

/// The robot a document describes.
SINEW_API Expected<Robot> read_robot(const Document& document);

/// The same document with a named architecture written out as a list of legs; unchanged if it lists them.
SINEW_API Expected<Document> expanded(const Document& document);

/// The document with the value at `path` (`legs[0].link.length`, `platform.radius`) replaced.
SINEW_API Expected<Document> with(const Document& document, const std::string& path, Node value);

/// The same with several, `{path: value}`. What legs or sections share comes first: a setting of one of them
/// then wins, whatever their order.
SINEW_API Expected<Document> with(const Document& document, std::span<const Member> settings);

/// The text of a file that reads as this arm: numbers in SI with all their digits, backbones by their
/// stiffness, every tendon by itself. Codes: `not_available` where a file cannot say it, and those of
/// `read_arm` where it is no arm.
/// @param comments lines at the top, without the `#`
SINEW_API Expected<std::string> arm_text(const Arm& arm, std::span<const std::string> comments = {});

}  // namespace sinew::inline v1
