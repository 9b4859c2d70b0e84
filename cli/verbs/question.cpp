/// forward, inverse, analyse: one query, a table for people or the answer as it is.
#include <fmt/format.h>

#include "show.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

int refuse_question(const Arguments& arguments, const Errors& errors) {
  if (arguments.has("json")) print(json_error(errors) + '\n');
  return refuse(arguments.verb, errors);
}

std::string show(const Answer& answer, Session& session, const Arguments& arguments) {
  const InputNames names = input_names(describe(session, arguments));
  if (answer.text("query") == "velocity") return show_velocity(answer, names);
  std::string text = answer.text("query") == "forward"
                         ? show_pose(*answer.find("pose"))
                         : show_inputs("value", numbers(answer.find("inputs")), names);
  text += '\n' + show_legs(*answer.find("legs"));
  if (const Node* solutions = answer.find("solutions")) text += '\n' + show_modes(*solutions, names);
  return text;
}

/// Why there is no solution, or what the solution leaves out.
void explain(const Answer& answer, std::string_view verb) {
  const std::string said = answer.text("message");
  message(fmt::format("{} {}: {}{}", verb, answer.text("robot"), answer.text("status"),
                      said.empty() ? "" : ": " + said));
}

}  // namespace

int run_question(const Arguments& arguments) {
  const auto query = request(arguments.verb == "analyse" ? "velocity" : arguments.verb, arguments);
  if (!query) return refuse_question(arguments, query.error());
  auto session = Session::open(arguments.operand());
  if (!session) return refuse_question(arguments, session.error());
  const Answer answer = ask(*session, *query);
  if (const Errors errors = answer.errors(); !errors.empty()) {
    if (arguments.has("json")) print(answer.line + '\n');
    return refuse(arguments.verb, errors);
  }
  const bool can_show = answer.converged() || answer.find("J");
  if (arguments.has("json"))
    print(answer.line + '\n');
  else if (can_show)
    print(show(answer, *session, arguments) +
          (answer.converged() && !arguments.has("quiet") ? show_report(answer) : ""));
  if (!answer.converged() || !answer.text("message").empty()) explain(answer, arguments.verb);
  return exit_code(answer);
}

}  // namespace sinew::cli
