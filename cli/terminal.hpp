/// @file terminal.hpp
/// What the command shares with the shell: exit codes, stdout, stderr and signals. stdout is data, stderr is
/// messages.
#pragma once
#include <string>
#include <string_view>

#include "sinew/base/error.hpp"

namespace sinew::cli {

enum Exit : int {
  solved = 0,
  internal_error = 1,
  bad_input = 2,
  no_solution = 3,  ///< or one that does not hold by itself
  stopped = 4,      ///< by a limit, by a signal, or because nobody reads stdout any more
};

/// Thrown where stdout takes no more; `code` is an errno.
struct OutputLost {
  int code;
};

void print(std::string_view text);    ///< to stdout, and on its way at once
void message(std::string_view text);  ///< a line on stderr
/// Each error on its line of stderr; those without a place of a file are put to the verb. Exit code
/// `bad_input`.
int refuse(std::string_view verb, const Errors& errors);

/// Starts this command again with a word in an environment variable, unless it is there already.
void restart_with(const char* variable, const std::string& word);

/// Ctrl-C and SIGTERM end the command with `stopped`; a closed pipe is an error of writing, not a signal.
void watch_signals();
/// From now on the first signal only makes `interrupted` true, so that a line is not cut in two.
void finish_what_is_begun();
bool interrupted();

}  // namespace sinew::cli
