/// diagram: what the tendons of one section leave it free to do; a table, or a figure.
#include <fmt/format.h>

#include "figure/diagram_figure.hpp"
#include "figure_file.hpp"
#include "question.hpp"
#include "terminal.hpp"

namespace sinew::cli {

int run_diagram(const Arguments& arguments) {
  auto robot = open(arguments);
  if (!robot) return refuse_question(arguments, robot.error());
  const auto answer = put("diagram", arguments, *robot);
  if (!answer) return refuse_question(arguments, answer.error());
  if (arguments.has("json")) print(answer->line() + '\n');
  if (const Errors errors = answer->errors(); !errors.empty()) return refuse(arguments.verb, errors);
  if (!answer->converged())
    message(fmt::format("diagram {}: {}: {}", answer->text("robot"), answer->text("status"),
                        in_options(answer->text("message"))),
            Style::bad);
  else if (const std::string said = answer->text("message"); !said.empty())
    message(fmt::format("diagram {}: {}", answer->text("robot"), in_options(said)));
  if (!answer->find("class")) return exit_code(*answer);
  const std::size_t section = section_of(arguments);
  if (const std::string* file = arguments.text("output"))
    if (const int written = write_figure_file(arguments, diagram_figure(*answer, *robot, section), *file))
      return written;
  if (!arguments.has("json") && !arguments.has("output")) print(show_diagram(*answer, *robot, section));
  return exit_code(*answer);
}

}  // namespace sinew::cli
