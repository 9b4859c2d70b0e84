#include "verbs.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace sinew::cli {
namespace {

const std::array table{
    Verb{
        "forward",
        "ROBOT",
        "pose of the platform from the inputs",
        options_of(Ask::forward, {"along", "samples", "tilt", "trace"}, {"limit", "json", "quiet", "help"}),
        {"inputs", "configuration", "changes", "tensions"},
        "Newton's method from the start; --all finds the other assembly modes too. Exit code 3 where the\n"
        "legs do not close, 4 where the iterations ran out. A platform on rods comes to rest under a load:\n"
        "  sinew forward 3pfs-g2 --inputs \"0.44 m, 0.42 m, 0.41 m\" --wrench \"1 N, -0.5 N, -5 N, 0, 0, 0\" "
        "--want stiffness\n"
        "  sinew forward 3pfs-g2 --inputs \"0.44 m, 0.42 m, 0.41 m\" --until \"0, 0, -1 N, 0, 0, 0\" --limit "
        "200\n"
        "There --all finds equilibria, stable or not. One that does not hold by itself is shown, and the "
        "exit\n"
        "code is 3. A serial robot takes its configuration, or the changes of its tendons:\n"
        "  sinew forward nottingham-tpcj --configuration \"10 deg, 5 deg; 0, -10 deg\"\n"
        "An arm that bears loads takes tensions or changes:\n"
        "  sinew forward two-segment --tensions \"4, 0, 0; 0, 2, 0\" --wrench \"0.1, 0, 0, 0, 0, 0\"",
        "sinew forward 3-rfr --inputs \"0.19 m, 190 mm, 0.188\"",
        run_question},
    Verb{
        "inverse",
        "ROBOT",
        "inputs from the pose of the platform",
        options_of(Ask::inverse, {"along", "limit", "samples", "tilt"}, {"json", "quiet", "help"}),
        {"pose", "independent", "position", "direction"},
        "Of several solutions the one that bends least is taken, positive where both signs do; with --start "
        "the "
        "one\n"
        "nearest to those inputs. In space: sinew inverse 6-ufs --pose \"0, 0, 180 mm, 0, 10 deg, 0\"\n"
        "A platform that hinges hold in planes: sinew inverse 3prs --independent \"0.54 m, 0.1, 0.05\"\n"
        "One on rods: sinew inverse 3pfs-g2 --independent \"0.39 m, 0.1, 0.05\" --wrench \"0, 0, -5 N, 0, 0, "
        "0\"\n"
        "A pose on six rods can be held on several branches: --start names the lengths to begin near, --all "
        "finds\nothers. "
        "The tip of a serial robot: sinew inverse nottingham-tpcj --position \"60 mm, 20 mm, 120 mm\" "
        "--direction \"1, "
        "0, 1\"",
        "sinew inverse 3-rfr --pose \"10 mm, -5 mm, 10 deg\" --bending \"+,-,+\"",
        run_question},
    Verb{"statics",
         "ROBOT",
         "a tendon-driven robot under a load, its links pseudo-rigid chains; the load on rods, sensed",
         options_of(Ask::statics, {"inverse", "samples", "tilt"}, {"limit", "json", "quiet", "help"}),
         {"set-at", "tensions", "lengths", "pose", "axial-forces", "changes"},
         "Tendons are set at a pose, or their tensions or lengths given; or --pose is held under the load, "
         "and "
         "their\ntensions answered. Beside the equilibrium: whether it is stable, the paper's linear model, "
         "and "
         "links that\nbend evenly. A tendon that would have to push is slack, exit code 3. How much a robot "
         "bears:\n  sinew statics 3-rfr --set-at \"10 mm, 0, 20 deg\" --until \"0, 0, 1 mN m\" --limit 100\n"
         "What acts on a platform of six rods, from load cells at their guides:\n  sinew statics hexapod "
         "--inputs "
         "\"410 mm, 410 mm, 405 mm, 405 mm, 405 mm, 405 mm\"\n    --axial-forces \"0.1 N, -0.2 N, 0, 0, 0.1 "
         "N, 0\" "
         "--deviation \"10 mN\"",
         "sinew statics 3-rfr --set-at \"10 mm, 0, 20 deg\" --wrench \"30 mN, -20 mN, 0.5 mN m\"",
         run_question},
    Verb{"analyse",
         "ROBOT",
         "velocity equations, sensitivities and singularities at a configuration",
         options_of(Ask::velocity, {"along", "limit", "samples", "tilt"}, {"json", "quiet", "help"}),
         {"pose", "independent", "inputs", "configuration", "changes", "tensions"},
         "Give a pose, or inputs, or both. J·(platform velocity) = K·(input rates) is printed in SI as in "
         "the paper,\n"
         "U = J⁻¹K in mm and degrees. A singular configuration is shown, and the exit code is 3. Of a robot "
         "on "
         "rods\n"
         "J is the platform's stiffness at fixed lengths, K the force that an input exerts on a platform at "
         "rest.",
         "sinew analyse 3-rfr --pose \"10 mm, -5 mm, 10 deg\" --twist \"5 mm/s, 0, 2 deg/s\"",
         run_question},
    Verb{"diagram",
         "ROBOT",
         "what the tendons of one section of a serial robot leave it free to do",
         options_of(Ask::diagram, {"tilt", "max-iterations", "theta-is"},
                    {"output", "width", "font", "force", "json", "quiet", "help"}),
         {"changes"},
         "Exact: the tendons agree on one bend. Indeterminate: some are slack, the section can be anywhere "
         "in the "
         "polygon.\nInconsistent: they are too short for any bend. Unreachable: they agree beyond the "
         "envelope only. "
         "Changes are\nthose of the section, or of all sections up to it. What drives with exact lengths "
         "says --model "
         "pcc.\nWith -o the diagram is drawn.",
         "sinew diagram nottingham-tpcj --section 0 --changes \"-1.1 mm, 2 mm, -0.5 mm\"",
         run_diagram},
    Verb{
        "track",
        "ROBOT",
        "inputs along a path of the platform; an arm along a path of tensions",
        options_of(Ask::track,
                   {"inputs", "pose", "independent", "set-at", "tensions", "lengths", "range", "backward",
                    "branches"},
                   {"output", "json", "quiet", "help"}),
        {"from", "poses", "points"},
        "The path is straight, or that of a .csv file with the columns x[m], y[m], phi[rad] (in space x[m], "
        "y[m], "
        "z[m],\nrx[rad], ry[rad], rz[rad]), as --output writes them. The legs keep the branch they begin on. "
        "Where the path\ncannot be followed to its end the poses reached are shown, and the exit code is 3. "
        "On rods each pose is held from the one\nbefore, in equilibrium under --wrench: sinew track 3pfs-g2 "
        "--from "
        "\"0.39 m, 0, 0\" --to \"0.4 m, 0.1, 0\".\n"
        "An arm is followed along --points FILE.csv with columns like sections[0].tendons[0].tension[N] or\n"
        ".change[m], and fx[N] to mz[N m] for the wrench at its tip; friction of its tendons is remembered\n"
        "along the way.",
        "sinew track 3-rfr --from \"0, 0, 0\" --to \"10 mm, 5 mm, 20 deg\" --samples 11",
        run_track},
    Verb{
        "branches",
        "ROBOT",
        "the curve of equilibria of a loaded robot along inputs, a load or a pose, through folds",
        options_of(
            Ask::track,
            {"from", "poses", "angles", "objective", "rk4-steps", "branches", "points", "steps", "following",
             "distributed", "distributed-following", "loads", "order", "elements", "accuracy"},
            {"hold", "to-inputs", "to-tensions", "to-lengths", "to-wrench", "all", "output", "width", "font",
             "force", "json", "quiet", "help"}),
        {"to-inputs", "to-tensions", "to-lengths", "to-wrench", "to"},
        "The curve begins at the inputs, pose or independent coordinates given, and is followed by its arc\n"
        "length: where the load or the inputs cannot go further, a fold, it turns back, on another branch.\n"
        "Bifurcations are found as well; with --all the curves that leave them are followed. Shown are the\n"
        "special points and all equilibria met with the inputs and the load led to, stable or not. -o\n"
        "FILE.csv has all points, an .svg, .png or .pdf the diagram. Where a pose is led to, the inputs\n"
        "that hold it are followed: sinew branches hexapod --pose \"0, 0, 400 mm, 0, 0, 0\" --to \"50 mm,\n"
        "77 mm, 490 mm, 20 deg, -12 deg, -11 deg\". On pseudo-rigid chains it begins where tendons are set:\n"
        "sinew branches 3-rfr --model prb --set-at \"10 mm, 0, 20 deg\" --to-wrench \"0, 0, 10 mN m\".\n"
        "Exit code 3 where the curve does not come to 1.",
        "sinew branches 3pfs-g2 --independent \"0.4 m, 0.05, 0\" --to-wrench \"0, 0, -100 N, 0, 0, 0\" "
        "--range "
        "\"0, 2\"",
        run_branches},
    Verb{
        "map",
        "ROBOT",
        "singularities over a grid of poses: a table, or a heat map",
        {"x", "y", "z", "phi", "rx", "ry", "rz", "bending", "elbow", "curvature", "output", "width", "font",
         "force", "set", "quiet", "help"},
        {},
        "An axis is one value or FROM : TO : COUNT. For each pose, the first axis running fastest, the table "
        "tells\n"
        "whether it is reachable, det J, 1/condition as it stands and homogenised, how many legs are at a "
        "type I,\n"
        "and whether it is a type II: CSV in SI and radians, on stdout or in -o FILE.csv. An .svg, .png or "
        ".pdf is\n"
        "a heat map of the homogenised one over two axes; a third one has a panel for each value.",
        "sinew map 3-rfr --x \"-60 mm : 60 mm : 13\" --y \"-60 mm : 60 mm : 13\" --phi \"30 deg\" -o map.csv",
        run_map},
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
    Verb{"sweep",
         "[STUDY]",
         "one query at many samples, on all cores or a cluster, into a file of results",
         {"output", "resume", "force", "threads", "isa", "compress", "set", "list", "json", "quiet", "help"},
         {},
         "A study file names the robot, the query, the axes that vary (a grid, random or listed samples), "
         "what\n"
         "is kept of the answers, and what is made of it: reductions over axes, fits (docs/studies.md); "
         "--list\n"
         "without a study lists those that come with sinew. -o\n"
         "FILE.h5 or FILE.csv, default the study's name; HDF5 is what Python, MATLAB and Julia read. "
         "Finished\n"
         "chunks are in FILE.log until the end: after a crash or Ctrl-C --resume goes on. On a cluster:\n"
         "mpirun -n 64 sinew sweep STUDY. The data are the same for any number of threads or ranks. Exit "
         "code\n"
         "4 where it was stopped; samples without a solution do not stop it, they have their status.",
         "sinew sweep 3-rfr-workspace -o workspace.h5",
         run_sweep},
    Verb{"check",
         "ROBOT|STUDY",
         "read a robot or study file and say what it means, or everything that is wrong with it",
         {"set", "json", "quiet", "help"},
         {},
         "Values that are allowed but unlikely are warned of on stderr. --json gives the answer to describe. "
         "Of a study\nthe samples and columns are said that sinew sweep would give.",
         "sinew check 3-rfr",
         run_check},
    Verb{
        "export",
        "ROBOT",
        "a robot in the languages of what drives it",
        {"to", "model", "output", "set", "quiet", "help"},
        {"to"},
        "c-header: the integer, Q15.16 and float tables of a serial robot, with limits, counts of its motors "
        "and\na hash, for the kernel headers of sinew on a small controller, which drives them by LSK, or "
        "with --model pcc "
        "exactly.\nIt goes to stdout without -o.\n"
        "verilog: the integer table of LSK as a core for an FPGA, forward and inverse with states of "
        "tendons,\nand a testbench: two files into the folder of -o, or here.",
        "sinew export nottingham-tpcj --to c-header -o robot_table.h",
        run_export},
    Verb{
        "serve",
        "[ROBOT]",
        "queries over HTTP, on this machine or with a token from others",
        {"set", "scene", "plan", "host", "port", "frame", "demo", "device", "baud", "record", "stage-motor",
         "quiet", "help"},
        {},
        "Prints the address and answers there until Ctrl-C. The calls are in docs/server.md. Nothing is read "
        "but\n"
        "the robot, the scene and the plans that are named, and recordings of devices; nothing is written "
        "but\n"
        "these; no request leaves this machine.\n"
        "--set changes the robot that the page opens with, that of a device, too, not those of plans:\n"
        "  sinew serve 3-rfr --set \"legs[0].link.length=180 mm\"\n"
        "--scene engine/scene.yaml --plan plan.csv opens a plan of sinew plan: the way in, step by step, in "
        "its\n"
        "scene, with its check.\n"
        "--demo, or --device /dev/ttyACM0, opens the operator's panel for a serial robot with that firmware; "
        "what it\n"
        "does is recorded while it is armed. It is no emergency stop.",
        "sinew serve 3-rfr",
        run_serve},
    Verb{"list",
         "[robots|studies|figures]",
         "what comes with sinew, a line each",
         {"json", "quiet", "help"},
         {},
         "Robots are for every verb, studies for sinew sweep, figures and tables of the papers for sinew "
         "reproduce.",
         "sinew list robots",
         run_list},
    Verb{"new",
         "[KIND]",
         "a commented robot or study file to start from, on stdout",
         {"help"},
         {},
         "Without a kind the kinds are listed. Every file works as it is; change it and check it.",
         "sinew new 3-RFR > mine.yaml",
         run_new},
    Verb{"identify",
         "ROBOT ROWS",
         "stiffness, angles, offsets and more of an arm from measured rows",
         {"fit", "model", "hold-out", "noise", "map", "output", "errors", "set", "json", "quiet", "help"},
         {},
         "ROWS is a .csv file: by how much each motor draws its tendon in, sections[0].tendons[0][mm] and so "
         "on, "
         "and\nwhere a marker then is, x[mm], y[mm], z[mm]; where known time[s], and block, a number that "
         "rows of "
         "one\nmotion share. The robot is an arm with elastic tendons; its file says where the fit begins "
         "(docs/identify.md).\n-o writes the fitted arm as a file of its own. --fit names what may change, "
         "and who "
         "has one of its own:\n"
         "  sinew identify ftdcr-v4 rows.csv --fit sections.bending,tendons.offset,compliance,marker,lag\n"
         "  bending, bending.x, bending.y, torsion, curvature       of all sections, or sections.\n"
         "  compliance, pretension, toe, offset, gain               of all tendons, or tendons., or "
         "sections.\n"
         "  angle, radius                                           the same, or passages.\n"
         "  lag, play, gravity, mass, tip_mass, marker, base, tilt  of the arm; marker.x, tilt.z and so on "
         "alone\n"
         "Exit code 4 where it was stopped or the steps ran out: the best so far is shown and written.",
         "sinew identify ftdcr-v4 rows.csv -o fitted.yaml",
         run_identify},
    Verb{
        "plan",
        "SCENE",
        "a way in through clutter for a serial robot, checked by FCL",
        {"output", "seed", "threads", "time-limit", "check", "json", "quiet", "help"},
        {},
        "A scene file names the robot, where its base is and moves, the solids around, and where the tip is "
        "to\n"
        "get (docs/scenes.md); sinew new scene prints one. -o FILE.h5 or FILE.csv, default the scene's name\n"
        "with .plan.h5: a row a step, between which everything moves straight. Exit code 3 where no way was\n"
        "found, with what is in the way.",
        "sinew new scene > wall.yaml && sinew plan wall.yaml -o plan.csv",
        run_plan},
    Verb{
        "drive",
        "ROBOT",
        "when a serial robot on a stage is where, along a plan: bends, tendons, motor counts",
        {"along", "limits", "rate", "reverse", "model", "stage-motor", "set", "output", "json", "quiet",
         "help"},
        {"along"},
        "The quickest motion from rest to rest through all postures within limits of speed and acceleration. "
        "By the\nending of -o a table, .csv or .h5, or for ROS a JointTrajectory, .yaml; default the plan's "
        "name with .drive.csv.\nTendon changes are exact and by LSK; counts, where motors are named, are "
        "those of --model lsk (default) or pcc.\nDefaults: stage 5 mm/s and 25 mm/s^2, bends 0.5 rad/s and "
        "2 rad/s^2, tendons 10 mm/s and 50 mm/s^2.",
        "sinew drive nottingham-tpcj --along plan.csv --limits \"stage_speed=10 mm/s\" -o drive.csv",
        run_drive},
    Verb{"scene",
         "compressor",
         "a scene to plan in, with its meshes: a stand-in for the compressor of an engine",
         {"output", "seed", "set", "list", "quiet", "help"},
         {},
         "Writes DIR/scene.yaml and an STL file of each solid into -o DIR, default compressor. --seed N "
         "draws\n"
         "another one. --set NAME=VALUE changes a dimension; --list names them all.",
         "sinew scene compressor -o engine --set port_diameter=\"10 mm\"",
         run_scene},
    Verb{"reproduce",
         "[PAPER[/ITEM]]",
         "figures and tables of the papers, and what others measured or computed: ours beside theirs",
         {"output", "width", "font", "force", "list", "json", "quiet", "help"},
         {},
         "Without an argument all of them.",
         "sinew reproduce --list",
         run_reproduce},
    Verb{"plot",
         "RESULT|ROBOT|SCENE",
         "a figure of a table of results, of a robot, or of a way in",
         {"output",        "along",     "as",          "title",
          "width",         "font",      "x",           "y",
          "value",         "at",        "colour",      "log-y",
          "log-value",     "view",      "pose",        "independent",
          "bending",       "elbow",     "curvature",   "inputs",
          "configuration", "changes",   "tensions",    "start",
          "wrench",        "following", "distributed", "distributed-following",
          "loads",         "gravity",   "theta-is",    "model",
          "section",       "measured",  "tolerance",   "envelope",
          "limit",         "set",       "force",       "all-statuses",
          "quiet",         "help"},
         {"output"},
         "RESULT is an .h5 or .csv file of sweep, track or map; lengths are drawn in mm, angles in deg. "
         "Lines, or "
         "points,\nare drawn over --x. A map shows --value over the grid that --x and --y form, contours "
         "write "
         "its values on\nlines; of a table that is a full grid a map is the default, and --at says where "
         "further axes are cut:\n"
         "  sinew plot map.csv --as contour --value determinant --at \"phi=30 deg\" -o map.svg\n"
         "  sinew plot map.csv --as points --x x --y determinant --colour inverse_condition -o points.png\n"
         "A robot is drawn at a pose or at inputs, default its home; from its sides: a spatial one from the "
         "front\nand from above, a serial one from the front and from the side; or in space; or as the "
         "diagram "
         "of one section:\n"
         "  sinew plot hexapod --as 3d -o hexapod.svg\n"
         "  sinew plot nottingham-tpcj --section 0 --changes \"-1.1 mm, 2 mm, -0.5 mm\" -o section.svg\n"
         "An arm is drawn under its tendons and loads, tendons in the colours of their tensions, and its "
         "curvature along it:\n"
         "  sinew plot two-segment --tensions \"4 N, 0, 0; 0, 2 N, 0\" --wrench \"0.1 N, 0, 0, 0, 0, 0\" -o "
         "arm.svg\n"
         "A scene with --along PLAN is drawn with the robot in four phases of its way, or with --as line as "
         "clearance and bends:\n"
         "  sinew plot wall.yaml --along plan.csv -o way.svg\n"
         "The figure is an .svg, .png or .pdf; the gnuplot script beside it is there to be edited, and draws "
         "it again.",
         "sinew plot 3-rfr --pose \"10 mm, -5 mm, 10 deg\" -o fig.svg",
         run_plot},
    Verb{"completion",
         "bash|zsh|fish",
         "a script that completes this command's lines",
         {"help"},
         {},
         "An installed sinew has them in place. By hand:\n"
         "  sinew completion zsh > ~/.zfunc/_sinew       with fpath+=~/.zfunc before compinit in ~/.zshrc\n"
         "  sinew completion fish > ~/.config/fish/completions/sinew.fish",
         "sinew completion bash > sinew.bash",
         run_completion},
    Verb{"help",
         "[VERB|units|fields]",
         "this text, that of a verb, the units that numbers may carry, or the fields of questions",
         {"man", "json", "help"},
         {},
         "All of it as one page: sinew help --man | man -l -",
         "sinew help units",
         run_help},
};

}  // namespace

std::span<const Verb> verbs() { return table; }

const Verb* find_verb(std::string_view name) {
  const auto found = std::ranges::find(table, name, &Verb::name);
  return found == table.end() ? nullptr : &*found;
}

}  // namespace sinew::cli
