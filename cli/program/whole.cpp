/// What a verb does that this program has not got: it becomes the one that has. docs/adr/0011.
#include <fmt/format.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

/// Same process, same words: signals, ranks and pipes do not notice.
int become_whole(const Arguments& arguments) {
  std::error_code ignored;
  const std::filesystem::path whole =
      (std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / SINEW_WHOLE)
          .lexically_normal();
  const int reason = become(whole);
  refuse(arguments.verb,
         {{"program_missing", whole.string(),
           fmt::format("cannot be started: {}; the second program of sinew, for studies, figures of tables "
                       "and the server, belongs there: install sinew again, whole",
                       std::strerror(reason))}});
  return internal_error;
}

}  // namespace

int run_sweep(const Arguments& arguments) { return become_whole(arguments); }
int run_serve(const Arguments& arguments) { return become_whole(arguments); }
int run_reproduce(const Arguments& arguments) { return become_whole(arguments); }
int run_plot(const Arguments& arguments) { return become_whole(arguments); }
int run_completion(const Arguments& arguments) { return become_whole(arguments); }
int run_list(const Arguments& arguments) { return become_whole(arguments); }
int check_study(const Arguments& arguments) { return become_whole(arguments); }
int check_scene(const Arguments& arguments) { return become_whole(arguments); }
int run_plan(const Arguments& arguments) { return become_whole(arguments); }
int run_drive(const Arguments& arguments) { return become_whole(arguments); }
int run_scene(const Arguments& arguments) { return become_whole(arguments); }
int new_study(const Arguments& arguments) { return become_whole(arguments); }

}  // namespace sinew::cli
