/// @file terminal.hpp
/// What the command shares with the shell: exit codes, stdout, stderr and signals. stdout is data, stderr is
/// messages.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "sinew/base/error.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::cli {

enum Exit : int {
  solved = 0,
  internal_error = 1,
  bad_input = 2,
  no_solution = 3,  ///< or one that does not hold by itself
  stopped = 4,      ///< by a limit, by a signal, or because the answer cannot be written
};

/// How a terminal that has colours shows a text; files and pipes never see it.
enum class Style {
  heading,  ///< bold
  good,     ///< green
  bad,      ///< red
  doubtful  ///< yellow
};
/// `text` in a style, for `print` and `message`. As it is where neither stdout nor stderr is a terminal with
/// colours: NO_COLOR in the environment, or TERM=dumb, says that it has none.
std::string styled(std::string_view text, Style style);

/// Characters in a line of the terminal that stdout is: what COLUMNS says, or the terminal. 0 where it is
/// none: a line may have any length.
std::size_t line_width();

/// Thrown where stdout takes no more; `code` is an errno.
struct OutputLost {
  int code;
};

/// @name Texts of files reach no terminal raw: control characters are spelled out, see sinew/io/visible.hpp
/// @{
void print(std::string_view text);  ///< to stdout, and on its way at once
/// A line on stderr; `warning:` at its beginning, or all of it in the style that is given.
void message(std::string_view text, std::optional<Style> style = {});
/// Each error on its line of stderr; those without a place of a file are put to the verb. Exit code
/// `bad_input`, of a file that cannot be written `stopped`.
int refuse(std::string_view verb, const Errors& errors);
/// @}

/// Goes on as another program, with the words of this one. Comes back only where it cannot: the errno.
int become(const std::filesystem::path& program);
/// Starts this command again with a word in an environment variable, unless it is there already.
void restart_with(const char* variable, const std::string& word);

/// Ctrl-C and SIGTERM end the command with `stopped`; a closed pipe is an error of writing, not a signal.
void watch_signals();
/// From now on the first signal only makes `interrupted` true, so that a line is not cut in two.
void finish_what_is_begun();
bool interrupted();
/// Asked to stop by that first signal: what solves then ends soon, with the best it has.
StopToken stop_token();

}  // namespace sinew::cli
