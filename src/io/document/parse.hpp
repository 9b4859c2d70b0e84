/// @file parse.hpp
/// YAML files and JSON queries into the same tree. Everything odd is refused with its place: duplicate keys,
/// anchors, tags, a second document, depth and size beyond any sensible input.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"

namespace sinew::inline v1 {

/// Largest document [bytes].
inline constexpr std::size_t document_size_limit = 4 * 1024 * 1024;

/// One YAML document. Codes: `yaml_syntax`, `yaml_unsupported`, `duplicate_key`, `empty_document`,
/// `not_utf8`, `too_large`, `too_deep`.
Expected<Document> parse_yaml(std::string_view text, std::string source);

/// One JSON text; its nodes have no lines. Codes: `json_syntax`, `duplicate_key`, `not_a_number` (a number
/// too large for a double), `not_utf8`, `too_large`, `too_deep`.
Expected<Document> parse_json(std::string_view text, std::string source);

/// A text file, or as much of it as tells that it is too large. Codes: `file_missing`, `file_unreadable`.
Expected<std::string> read_text(const std::string& path);

/// A YAML file. Codes: those of `parse_yaml`, `file_missing`, `file_unreadable`.
Expected<Document> read_file(const std::string& path);

/// A scalar as YAML reads it without quotes: null, true, false, a number, or text. For values on a command
/// line.
Node plain_scalar(std::string_view text);

/// The node where another stood, so that messages name that place.
Node placed(Node node, const Node& like);

/// Byte at which the text stops being UTF-8 text without control characters; its size if it does not.
std::size_t utf8_size(std::string_view text);

/// Line and column, from 1, of a byte of a text.
struct Position {
  int line = 1;
  int column = 1;
};
Position position_of(std::string_view text, std::size_t byte);

}  // namespace sinew::inline v1
