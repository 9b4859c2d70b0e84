/// @file answer.hpp
/// Answers of a session as trees, and texts as JSON has them.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/query/session.hpp"

namespace sinew::cli {

/// A text in quotes, as JSON has it.
std::string json_text(std::string_view text);
/// A tree on one line, as JSON has it.
std::string as_json(const Node& node);
/// `{"error": ...}` in one line, as `Session::answer` would put it.
std::string json_error(const Errors& errors);

/// An answer, read.
struct Answer {
  std::string line;  ///< as it came
  Document tree;

  const Node& root() const { return tree.root; }
  const Node* find(std::string_view path) const { return at(tree.root, path); }
  std::string text(std::string_view path) const;
  std::optional<double> number(std::string_view path) const;
  bool converged() const { return text("status") == "converged"; }
  /// The answer's error, if it is one, in words of the command line: `--pose` for `pose`.
  Errors errors() const;
};
Answer ask(Session& session, const std::string& query);

/// Exit code of an answer's status.
int exit_code(const Answer& answer);

/// Numbers of a list.
std::vector<double> numbers(const Node* list);
/// The number at a path; 0 where there is none.
double number(const Node& map, std::string_view path);

}  // namespace sinew::cli
