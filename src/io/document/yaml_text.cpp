#include "io/document/yaml_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/document/parse.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::size_t longest_line = 100;  // of lists and maps on one line

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// Whether it may stand without quotes, in lists and maps on one line, too. Text beyond ASCII may not: where
/// yaml-cpp takes a byte of it for a space is not asked.
bool is_plain(std::string_view text) {
  if (text.empty() || text.ends_with(' ')) return false;
  const char first = text.front();
  const bool is_signed = first == '-' || first == '+';  // one that stands for itself is no text
  const char next = text.size() > 1 ? text[1] : ' ';
  if (!is_letter_or_digit(first) && !(is_signed && next == '.') &&
      !((is_signed || first == '.') && is_letter_or_digit(next)))
    return false;
  constexpr std::string_view others = " _.+-/*^()";
  return std::ranges::all_of(
      text, [&](char c) { return is_letter_or_digit(c) || others.find(c) != std::string_view::npos; });
}

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    else
      result += c;
  }
  return result + '"';
}

std::string text_line(std::string_view text) {
  return is_plain(text) && plain_scalar(text).kind == Node::Kind::string ? std::string(text) : quoted(text);
}

std::string number_line(const Node& node) {
  const Node again = plain_scalar(node.text);
  const bool is_as_written =
      is_plain(node.text) && again.kind == Node::Kind::number && again.number == node.number;
  return is_as_written ? node.text : fmt::format("{}", node.number);
}

/// On one line, where it is short enough to stand there.
bool is_short(const Node& node, const std::string& line, std::size_t indent) {
  return (node.items.empty() && node.members.empty()) || indent + line.size() <= longest_line;
}

/// Its lines, each after so many spaces.
void put_lines(const Node& node, std::size_t indent, std::string& text) {
  const auto put = [&](std::string_view begin, const Node& value) {
    const std::string line = yaml_line(value);
    text += std::string(indent, ' ').append(begin);
    if (is_short(value, line, indent + begin.size() + 1)) {
      text += ' ' + line + '\n';
    } else if (begin == "-") {  // the first line of what stands in a list is behind its dash
      const std::size_t at = text.size();
      put_lines(value, indent + 2, text);
      text.erase(at, indent + 1);
    } else {
      text += '\n';
      put_lines(value, indent + 2, text);
    }
  };
  for (const Node& item : node.items) put("-", item);
  for (const Member& member : node.members) put(text_line(member.key) + ':', member.value);
}

}  // namespace

std::string yaml_line(const Node& node) {
  using Kind = Node::Kind;
  std::string line;
  const auto add = [&](const std::string& part) { line += (line.empty() ? "" : ", ") + part; };
  switch (node.kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return node.boolean ? "true" : "false";
    case Kind::number:
      return number_line(node);
    case Kind::string:
      return text_line(node.text);
    case Kind::list:
      for (const Node& item : node.items) add(yaml_line(item));
      return '[' + line + ']';
    case Kind::map:
      for (const Member& member : node.members) add(text_line(member.key) + ": " + yaml_line(member.value));
      return '{' + line + '}';
  }
  return line;
}

std::string yaml_text(const Node& root) {
  std::string text;
  if (root.items.empty() && root.members.empty()) return yaml_line(root) + '\n';
  put_lines(root, 0, text);
  return text;
}

}  // namespace sinew::inline v1
