/// @file yaml_text.hpp
/// A document written as YAML, for people to read on in: it is read back as the same tree. Comments are lost.
#pragma once
#include <string>

#include "sinew/io/node.hpp"

namespace sinew::inline v1 {

/// A value on one line: `0.18`, `180 mm`, `[0, 0.1, {x: 1}]`.
std::string yaml_line(const Node& node);
/// A whole document. Lists and maps that are short stand on one line.
std::string yaml_text(const Node& root);

}  // namespace sinew::inline v1
