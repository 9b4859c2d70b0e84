/// Verbs of a program that was built without planning.
#include <fmt/format.h>

#include "study_items.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

constexpr std::string_view why =
    "this sinew was built without planning: install FCL and assimp (Debian's libfcl-dev and libassimp-dev) "
    "and "
    "build it again";

int refuse_plan(std::string_view verb) { return refuse(verb, {{"not_built", "", std::string(why)}}); }

}  // namespace

int check_scene(const Arguments&) { return refuse_plan("check"); }
int run_scene(const Arguments&) { return refuse_plan("scene"); }
Expected<ItemResult> insertion_result() { return failure("not_built", insertion_item.id, why); }
int plot_insertion(const Arguments&) { return refuse_plan("plot"); }
int run_plan(const Arguments&) { return refuse_plan("plan"); }

}  // namespace sinew::cli
