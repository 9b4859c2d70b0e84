/// @file request.hpp
/// Options of a command line into the query that asks the same, and an answer back into a tree.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/query/session.hpp"
#include "verbs.hpp"

namespace sinew::cli {

/// The query that the options of a verb stand for (`--pose "10 mm, 0, 5 deg"`, `--set path=value`, ...), as
/// JSON.
Expected<std::string> request(std::string_view query, const Arguments& arguments);

/// A text in quotes, as JSON has it.
std::string json_text(std::string_view text);
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
/// What the robot has, with what `--set` changed.
Answer describe(Session& session, const Arguments& arguments);

/// Exit code of an answer's status.
int exit_code(const Answer& answer);

/// Numbers of a list.
std::vector<double> numbers(const Node* list);

}  // namespace sinew::cli
