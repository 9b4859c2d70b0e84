/// Verbs of a program that was built without planning.
#include <fmt/format.h>

#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

int refuse_plan(std::string_view verb) {
  return refuse(verb,
                {{"not_built", "",
                  "this sinew was built without planning: install FCL and assimp (Debian's libfcl-dev and "
                  "libassimp-dev) and build it again"}});
}

}  // namespace

int check_scene(const Arguments&) { return refuse_plan("check"); }
int run_scene(const Arguments&) { return refuse_plan("scene"); }
int run_plan(const Arguments&) { return refuse_plan("plan"); }

}  // namespace sinew::cli
