/// @file answer.hpp
/// Answers of a session as trees, and texts as JSON has them.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/session.hpp"

namespace sinew::cli {

/// A text in quotes, as JSON has it.
std::string json_text(std::string_view text);
/// A tree on one line, as JSON has it, numbers as they were written.
std::string as_json(const Node& node);
/// @name Trees of their parts
/// @{
Node map_of(std::vector<Member> members);
Node list_of(std::vector<Node> items);
/// @}
/// `{"error": ...}` in one line, as `Session::answer` would put it.
std::string json_error(const Errors& errors);

/// An answer, read.
struct Answer {
  Document tree;

  /// As `sinew query` prints it, without a line break.
  std::string line() const { return as_json(tree.root); }

  const Node& root() const { return tree.root; }
  const Node* find(std::string_view path) const { return at(tree.root, path); }
  std::string text(std::string_view path) const;
  std::optional<double> number(std::string_view path) const;
  bool converged() const { return text("status") == "converged"; }
  /// The answer's error, if it is one, in words of the command line: `--pose` for `pose`.
  Errors errors() const;
};
/// A place of a query in words of the command line: `--pose.x` for `pose.x`, `--limit` for `until.limit`.
std::string as_option(std::string_view where);
/// The same of the places within a message.
std::string in_options(std::string_view message);

/// Puts a question. Ctrl-C stops the solve; on a terminal a line on stderr says that it goes on, unless
/// `is_quiet`.
Answer ask(Session& session, const Document& query, bool is_quiet);

/// Exit code of an answer's status.
int exit_code(const Answer& answer);

/// Numbers of a list.
std::vector<double> numbers(const Node* list);
/// The number at a path; 0 where there is none.
double number(const Node& map, std::string_view path);

}  // namespace sinew::cli
