/// forward, inverse, statics, analyse: one query, a table for people or the answer as it is.
#include "question.hpp"

#include <fmt/format.h>

#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

/// What the question itself asks, without wants that have tables of their own.
std::string show_configuration(const Answer& answer, const OpenRobot& robot) {
  if (is_serial(robot)) return show_serial(answer, robot);
  if (is_arm(robot)) return show_arm(answer, robot);
  if (stands_on_arms(robot)) return show_arm_legs(answer, robot);
  const std::string query = answer.text("query");
  if (is_on_chains(answer)) return show_chains(answer, robot);
  if (answer.find("wrench_sensitivity")) return show_sensed(answer);
  const bool is_forward = query == "forward";
  std::string text = is_forward ? "" : show_inputs("value", numbers(answer.find("inputs")), robot);
  if (is_forward || is_on_rods(answer)) text += (text.empty() ? "" : "\n") + show_pose(*answer.find("pose"));
  text += '\n' + show_legs(*answer.find("legs"));
  if (is_on_rods(answer)) {
    text += '\n' + show_equilibrium(answer, robot);
    if (answer.find("solutions")) text += '\n' + show_equilibria(answer, robot);
  } else if (const Node* solutions = answer.find("solutions"))
    text += '\n' + (is_forward ? show_assembly_modes(answer) : show_working_modes(*solutions, robot));
  return text;
}

std::string show(const Answer& answer, const OpenRobot& robot) {
  const bool has_platform = !is_serial(robot) && !is_arm(robot) && !stands_on_arms(robot);
  if (answer.text("query") == "velocity" && has_platform) return show_velocity(answer, robot);
  std::string text = show_configuration(answer, robot);
  if (answer.find("J") && has_platform) text += '\n' + show_velocity(answer, robot);
  return text;
}

/// Why there is no solution, or what the solution leaves out.
void explain(const Answer& answer, std::string_view verb) {
  const std::string status = answer.text("status"), message_text = answer.text("message");
  // it begins with the field that the robot has nothing for
  const std::string said = in_options(status == "unsupported" ? as_option(message_text) : message_text);
  const auto style = answer.converged()     ? std::optional<Style>()
                     : status == "unstable" ? Style::doubtful
                                            : Style::bad;
  message(fmt::format("{} {}: {}{}", verb, answer.text("robot"), status, said.empty() ? "" : ": " + said),
          style);
}

}  // namespace

int refuse_question(const Arguments& arguments, const Errors& errors) {
  if (arguments.has("json")) print(json_error(errors) + '\n');
  return refuse(arguments.verb, errors);
}

int conclude(const Answer& answer, const Arguments& arguments, const std::string& shown) {
  if (arguments.has("json")) print(answer.line() + '\n');
  if (const Errors errors = answer.errors(); !errors.empty()) return refuse(arguments.verb, errors);
  if (!arguments.has("json") && !shown.empty())
    print(shown + (answer.converged() && !arguments.has("quiet") ? show_report(answer) : ""));
  if (!answer.converged() || !answer.text("message").empty()) explain(answer, arguments.verb);
  return exit_code(answer);
}

Expected<Answer> put(std::string_view query, const Arguments& arguments, OpenRobot& robot) {
  const auto asked = request(query, arguments, robot);
  if (!asked) return tl::unexpected(asked.error());
  return ask(robot, *asked);
}

int run_question(const Arguments& arguments) {
  auto robot = open(arguments);
  if (arguments.verb == "statics" && robot && is_serial(*robot)) robot = open_with_platform(arguments);
  if (!robot) return refuse_question(arguments, robot.error());
  const auto answer = put(arguments.verb == "analyse" ? "velocity" : arguments.verb, arguments, *robot);
  if (!answer) return refuse_question(arguments, answer.error());
  const bool can_show = answer->converged() || answer->text("status") == "unstable" || answer->find("J") ||
                        answer->find("configuration") || answer->find("tip") ||
                        answer->find("wrench_sensitivity") || is_on_chains(*answer);
  return conclude(*answer, arguments, can_show ? show(*answer, *robot) : "");
}

}  // namespace sinew::cli
