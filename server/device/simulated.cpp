#include "simulated.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <utility>
#include <vector>

extern char** environ;

namespace sinew::server::device {
namespace {

namespace fs = std::filesystem;

constexpr int start_patience = 10'000, answer_patience = 50;  // [ms]

/// Beside the command, or where an installed one keeps it; of `libexec/sinew/sinew` too.
fs::path find_beside(const std::string& name) {
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const fs::path up = beside.parent_path(), top = up.parent_path();
  for (const fs::path& folder :
       {beside, up / "bin", top / "bin", up / "share/sinew/firmware", top / "share/sinew/firmware"})
    if (fs::exists(folder / name, ignored)) return folder / name;
  return {};
}

fs::path make_folder() {
  std::error_code ignored;
  std::string name = (fs::temp_directory_path(ignored) / "sinew-demo-XXXXXX").string();
  return mkdtemp(name.data()) ? fs::path(name) : fs::path();
}

}  // namespace

Expected<std::unique_ptr<Simulated>> Simulated::start(const std::string& robot) {
  const fs::path program = find_beside("sinew-simulate"), firmware = find_beside("sinew-firmware-panel.elf");
  if (program.empty() || firmware.empty())
    return failure("not_built", "--demo",
                   fmt::format("{} is not beside the command: install avr-g++ and simavr (Debian's gcc-avr, "
                               "avr-libc and libsimavr-dev) and build sinew again",
                               program.empty() ? "sinew-simulate" : "sinew-firmware-panel.elf"));
  std::unique_ptr<Simulated> simulated(new Simulated);
  simulated->folder_ = make_folder();
  if (simulated->folder_.empty()) return failure("failed", "--demo", "no temporary folder can be made");
  std::ofstream(simulated->folder_ / "robot.yaml") << robot;
  if (auto run = simulated->run(program, firmware); !run) return tl::unexpected(run.error());
  return simulated;
}

Expected<void> Simulated::run(const fs::path& program, const fs::path& firmware) {
  int in[2], out[2];  // a socket in the place of a pipe: writing to one that is closed raises no signal
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) != 0)
    return failure("failed", "--demo", std::strerror(errno));
  if (pipe2(out, O_CLOEXEC) != 0) {
    close(in[0]);
    close(in[1]);
    return failure("failed", "--demo", std::strerror(errno));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  std::vector<std::string> words{program.string(), firmware.string(), "--pty",
                                 port(),           "--arm",           (folder_ / "robot.yaml").string()};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int why = posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(in[0]);
  close(out[1]);
  input_ = in[1];
  output_ = out[0];
  if (why != 0) {
    process_ = -1;
    return failure("failed", "--demo", fmt::format("{}: {}", program.string(), std::strerror(why)));
  }
  return await_ready(output_);
}

Expected<void> Simulated::await_ready(int output) {
  std::string said;
  std::array<char, 256> bytes;
  pollfd news{output, POLLIN, 0};
  while (said.find('\n') == std::string::npos && poll(&news, 1, start_patience) > 0) {
    const ssize_t count = read(output, bytes.data(), bytes.size());
    if (count <= 0) break;
    said.append(bytes.data(), static_cast<std::size_t>(count));
  }
  fcntl(output, F_SETFL, O_NONBLOCK);
  if (said.starts_with("ready")) return {};
  return failure("failed", "--demo", "sinew-simulate did not start; what it said is above");
}

std::string Simulated::tell(const std::string& line) {
  const std::lock_guard lock(mutex_);
  const std::string text = line + '\n';
  if (send(input_, text.data(), text.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(text.size()))
    return "the simulated device has ended";
  std::string said;
  std::array<char, 4096> bytes;
  pollfd news{output_, POLLIN, 0};
  while (said.find('\n') == std::string::npos && poll(&news, 1, answer_patience) > 0) {
    const ssize_t count = read(output_, bytes.data(), bytes.size());
    if (count <= 0) return "the simulated device has ended";
    said.append(bytes.data(), static_cast<std::size_t>(count));
  }
  said = said.substr(0, said.find('\n'));
  return said.starts_with("?") ? said.substr(std::min<std::size_t>(2, said.size())) : "";
}

Simulated::~Simulated() {
  if (input_ >= 0) close(input_);  // by which it ends
  if (output_ >= 0) close(output_);
  if (process_ > 0) {
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

}  // namespace sinew::server::device
