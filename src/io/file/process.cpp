#include "io/file/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <system_error>

extern char** environ;

namespace sinew::inline v1 {
namespace {

/// One stream of a child, read here.
struct Stream {
  std::array<int, 2> ends{-1, -1};
  std::string* text;
  std::size_t most;  ///< bytes kept; the rest is read so that the child does not block

  bool open() { return pipe2(ends.data(), O_CLOEXEC) == 0; }
  void close_end(std::size_t which) {
    if (ends[which] >= 0) close(ends[which]);
    ends[which] = -1;
  }
  /// Takes what is there; at its end the stream is closed.
  void read_some() {
    std::array<char, 4096> buffer;
    const ssize_t count = read(ends[0], buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) return;
    if (count <= 0) return close_end(0);
    if (text->size() < most) text->append(buffer.data(), static_cast<std::size_t>(count));
  }
};

/// A text that a child reads, in memory: no file of it is anywhere, and no pipe fills up.
struct Input {
  int file = -1, reason = 0;

  explicit Input(std::string_view text) {
    if (text.empty()) return;
    file = memfd_create("input", MFD_CLOEXEC);
    while (file >= 0 && !text.empty()) {
      const ssize_t done = write(file, text.data(), text.size());
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) break;
      text.remove_prefix(static_cast<std::size_t>(done));
    }
    if (file < 0 || !text.empty() || lseek(file, 0, SEEK_SET) != 0) reason = errno;
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
  ~Input() {
    if (file >= 0) close(file);
  }
};

/// Until both streams end; both at once, so that neither fills up and stops the child.
void read_all(Stream& output, Stream& messages) {
  while (output.ends[0] >= 0 || messages.ends[0] >= 0) {
    std::array<pollfd, 2> waiting{pollfd{output.ends[0], POLLIN, 0}, pollfd{messages.ends[0], POLLIN, 0}};
    if (poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) return;
    if (waiting[0].revents != 0) output.read_some();
    if (waiting[1].revents != 0) messages.read_some();
  }
}

}  // namespace

bool ProcessResult::is_missing() const {
  return spawn_error == ENOENT || spawn_error == EACCES || spawn_error == ENOTDIR;
}

bool ProcessResult::succeeded() const {
  return spawn_error == 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string ProcessResult::complaint() const {
  if (spawn_error != 0) return std::generic_category().message(spawn_error);
  std::string said = messages.substr(0, messages.find_last_not_of(" \n") + 1);
  std::replace(said.begin(), said.end(), '\n', ' ');
  return said;
}

ProcessResult run_process(std::vector<std::string> arguments, const std::filesystem::path& folder,
                          std::string_view input) {
  ProcessResult result;
  const Input given(input);
  if (given.reason != 0) {
    result.spawn_error = given.reason;
    return result;
  }
  Stream output{{-1, -1}, &result.output, std::numeric_limits<std::size_t>::max()},
      messages{{-1, -1}, &result.messages, 4000};
  if (!output.open() || !messages.open()) {
    result.spawn_error = errno;
    output.close_end(0);
    output.close_end(1);
    return result;
  }
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (given.file >= 0)
    posix_spawn_file_actions_adddup2(&actions, given.file, STDIN_FILENO);
  else
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages.ends[1], STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  result.spawn_error = posix_spawnp(&child, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  output.close_end(1);
  messages.close_end(1);
  if (result.spawn_error == 0) {
    read_all(output, messages);
    pid_t ended;
    while ((ended = waitpid(child, &result.status, 0)) < 0 && errno == EINTR) {
    }
    if (ended < 0)
      result.spawn_error = errno;  // whoever started us ignores its children: how it ended is lost
  }
  output.close_end(0);
  messages.close_end(0);
  return result;
}

}  // namespace sinew::inline v1
