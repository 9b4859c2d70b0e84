#include "verbs.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace sinew::cli {
namespace {

constexpr std::array options{
    Option{"inputs", "\"A, B, ...\"", "the inputs in leg order: lengths of tendon 1"},
    Option{"pose", "\"X, Y, PHI\"", "pose of the platform"},
    Option{"start", "\"X, Y, PHI\"", "pose where the search begins; default the robot's home"},
    Option{"bending", "\"+,-,+\"", "sign of each leg's curvature"},
    Option{"curvature", "\"A, B, ...\"", "a curvature for each leg; the nearest solution is taken"},
    Option{"twist", "\"VX, VY, W\"",
           "velocity of the platform and its turning rate; answers the rates of the inputs"},
    Option{"all", "", "every solution, not only the one wanted"},
    Option{"max-iterations", "N", "most iterations of the solver; default 100"},
    Option{"model", "NAME", "model of the links: cc (constant curvature)"},
    Option{"set", "PATH=VALUE", "change the robot, e.g. \"legs[0].link.length=180 mm\"; may be repeated", 0,
           true},
    Option{"output", "FILE", "where to write: a folder for reproduce (default: out), a figure for plot", 'o'},
    Option{"list", "", "only list what there is"},
    Option{"x", "COLUMN", "column along x; default the first"},
    Option{"y", "COLUMN,COLUMN", "columns to draw; default all the others"},
    Option{"log-y", "", "logarithmic y axis"},
    Option{"title", "TEXT", "title of the figure"},
    Option{"json", "", "the answer as one line of JSON, SI and radians"},
    Option{"quiet", "", "only data on stdout and errors on stderr", 'q'},
    Option{"help", "", "this text", 'h'},
};

const std::array table{
    Verb{"forward",
         "ROBOT",
         "pose of the platform from the inputs",
         {"inputs", "start", "max-iterations", "model", "set", "json", "quiet", "help"},
         {"inputs"},
         "Newton's method from the start. Exit code 3 where the legs do not close, 4 where the iterations "
         "ran out.",
         "sinew forward 3-rfr --inputs \"0.19 m, 190 mm, 0.188\"",
         run_question},
    Verb{"inverse",
         "ROBOT",
         "inputs from the pose of the platform",
         {"pose", "bending", "curvature", "all", "model", "set", "json", "quiet", "help"},
         {"pose"},
         "Of several solutions the one that bends least is taken, positive where both signs do.",
         "sinew inverse 3-rfr --pose \"10 mm, -5 mm, 10 deg\" --bending \"+,-,+\"",
         run_question},
    Verb{"analyse",
         "ROBOT",
         "velocity equations, sensitivities and singularities at a configuration",
         {"pose", "bending", "curvature", "inputs", "start", "twist", "max-iterations", "model", "set",
          "json", "quiet", "help"},
         {"pose", "inputs"},
         "Give a pose, or inputs, or both. J·(platform velocity) = K·(input rates) is printed in SI as in "
         "the paper,\n"
         "U = J⁻¹K in mm and degrees. A singular configuration is shown, and the exit code is 3.",
         "sinew analyse 3-rfr --pose \"10 mm, -5 mm, 10 deg\" --twist \"5 mm/s, 0, 2 deg/s\"",
         run_question},
    Verb{"query",
         "ROBOT",
         "many queries in one process: JSON lines from stdin, JSON lines to stdout",
         {"quiet", "help"},
         {},
         "Answers come in order, each at once. A line that is no good query is answered with an error, and "
         "the\n"
         "stream goes on; blank lines are skipped; a line may have 1 MiB. Exit code 0 when stdin has ended,\n"
         "whatever the answers say, 4 after a signal.",
         "echo '{\"query\": \"inverse\", \"pose\": {\"x\": 0.01, \"y\": 0, \"phi\": 0}}' | sinew query 3-rfr",
         run_query},
    Verb{"check",
         "ROBOT",
         "read a robot file and say what it means, or everything that is wrong with it",
         {"json", "quiet", "help"},
         {},
         "Values that are allowed but unlikely are warned of on stderr. --json gives the answer to describe.",
         "sinew check 3-rfr",
         run_check},
    Verb{"reproduce",
         "[PAPER[/ITEM]]",
         "figures and tables of the papers: ours beside theirs",
         {"output", "list", "json", "quiet", "help"},
         {},
         "Without an argument all of them.",
         "sinew reproduce --list",
         run_reproduce},
    Verb{"plot",
         "RESULT|ROBOT",
         "a figure of a table of results, or of a robot",
         {"output", "x", "y", "log-y", "title", "pose", "bending", "curvature", "inputs", "start", "model",
          "set", "quiet", "help"},
         {"output"},
         "RESULT is a .csv file with headings like x[m]. A robot is drawn at a pose or at inputs, default "
         "its home.\n"
         "The figure is an .svg, .png or .pdf; the gnuplot script beside it draws it again.",
         "sinew plot 3-rfr --pose \"10 mm, -5 mm, 10 deg\" -o fig.svg",
         run_plot},
    Verb{"completion",
         "bash",
         "a script that completes this command's lines",
         {"help"},
         {},
         "",
         "sinew completion bash > sinew.bash",
         run_completion},
    Verb{"help",
         "[VERB|units]",
         "this text, that of a verb, or the units that numbers may carry",
         {"help"},
         {},
         "",
         "sinew help units",
         run_help},
};

}  // namespace

std::span<const Verb> verbs() { return table; }

const Verb* find_verb(std::string_view name) {
  const auto found = std::ranges::find(table, name, &Verb::name);
  return found == table.end() ? nullptr : &*found;
}

const Option& option(std::string_view name) {
  const auto found = std::ranges::find(options, name, &Option::name);
  if (found == options.end()) throw std::logic_error("an option without a description: " + std::string(name));
  return *found;
}

}  // namespace sinew::cli
