#include "sinew/io/figure.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "sinew/io/table.hpp"

extern char** environ;

namespace sinew::inline v0 {
namespace {

namespace fs = std::filesystem;

/// What a child process came to.
struct Outcome {
  int spawn_error = 0;   ///< errno of the start, 0 where it started
  int status = 0;        ///< of waitpid
  std::string messages;  ///< its stderr
};

std::string read_all(int descriptor) {
  constexpr std::size_t most = 4000;  // bytes kept; the rest is read so that the child does not block
  std::string text;
  std::array<char, 512> buffer;
  for (ssize_t count; (count = read(descriptor, buffer.data(), buffer.size())) != 0;) {
    if (count < 0 && errno != EINTR) break;
    if (count > 0 && text.size() < most) text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return text;
}

/// Runs `gnuplot -d script` in a folder, without a shell. -d: nobody's ~/.gnuplot changes the figure.
Outcome run(std::string gnuplot, const fs::path& folder, std::string script) {
  Outcome outcome;
  std::array<int, 2> pipe_ends;
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return {.spawn_error = errno, .status = 0, .messages = {}};
  std::string defaults = "-d";
  std::array<char*, 4> arguments{gnuplot.data(), defaults.data(), script.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  outcome.spawn_error = posix_spawnp(&child, gnuplot.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);
  if (outcome.spawn_error == 0) {
    outcome.messages = read_all(pipe_ends[0]);
    while (waitpid(child, &outcome.status, 0) < 0 && errno == EINTR) {
    }
  }
  close(pipe_ends[0]);
  return outcome;
}

Expected<void> draw(const fs::path& script, const std::string& gnuplot) {
  const fs::path folder = script.has_parent_path() ? script.parent_path() : fs::path(".");
  const Outcome outcome = run(gnuplot, folder, "./" + script.filename().string());
  if (outcome.spawn_error == ENOENT || outcome.spawn_error == EACCES || outcome.spawn_error == ENOTDIR)
    return failure(
        "gnuplot_missing", script.string(),
        "gnuplot is not installed: apt-get install gnuplot-nox (the script is written; run it with gnuplot "
        "to draw the figure)");
  if (outcome.spawn_error != 0)
    return failure("gnuplot_failed", script.string(),
                   "gnuplot cannot be started: " + std::generic_category().message(outcome.spawn_error));
  if (!WIFEXITED(outcome.status) || WEXITSTATUS(outcome.status) != 0) {
    std::string said = outcome.messages.substr(0, outcome.messages.find_last_not_of(" \n") + 1);
    std::replace(said.begin(), said.end(), '\n', ' ');
    return failure("gnuplot_failed", script.string(), "gnuplot could not draw it: " + said);
  }
  return {};
}

/// Cairo writes the time into a PDF; overwritten in place, so that nothing moves and the same figure is the
/// same file.
Expected<void> remove_date(const fs::path& pdf) {
  std::ifstream file(pdf, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  constexpr std::string_view mark = "/CreationDate (D:", epoch = "19700101000000";
  const std::size_t place = bytes.find(mark);
  if (place == std::string::npos || place + mark.size() + epoch.size() > bytes.size()) return {};
  bytes.replace(place + mark.size(), epoch.size(), epoch);
  return write_text(bytes, pdf);
}

}  // namespace

Expected<std::vector<fs::path>> write_figure(const Figure& figure, const fs::path& stem,
                                             const FigureOptions& options) {
  const auto file = [&](std::string_view ending) { return fs::path(stem) += fmt::format(".{}", ending); };
  std::vector<fs::path> files{file("gp")};
  const std::string name = stem.filename().string();
  if (auto written = write_text(gnuplot_script(figure, name, options), files.front()); !written)
    return tl::unexpected(std::move(written.error()));
  if (auto drawn = draw(files.front(), options.gnuplot); !drawn)
    return tl::unexpected(std::move(drawn.error()));
  for (const FigureFormat format : options.formats) {
    files.push_back(file(extension(format)));
    if (format != FigureFormat::pdf) continue;
    if (auto done = remove_date(files.back()); !done) return tl::unexpected(std::move(done.error()));
  }
  return files;
}

}  // namespace sinew::inline v0
