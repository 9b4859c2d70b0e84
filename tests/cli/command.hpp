/// @file command.hpp
/// Runs the real command and hands back what a shell would see.
#pragma once
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "paths.hpp"

namespace sinew::test {

struct Outcome {
  int exit = -1;  ///< 128 + signal where one ended it
  std::string out, err;
};

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// A folder of this test alone, empty; removed at the end.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "sinew-test-XXXXXX").string();
    if (!mkdtemp(name.data())) std::abort();
    path_ = name;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Runs a program in a folder. Its output goes through files, so that no pipe fills up.
inline Outcome run_program(std::vector<std::string> words, const std::filesystem::path& folder,
                           const std::filesystem::path& input = "/dev/null") {
  const Scratch scratch;
  const std::string out = scratch.path() / "out", err = scratch.path() / "err";
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int files[] = {open(input.c_str(), O_RDONLY), open(out.c_str(), O_WRONLY | O_CREAT, 0600),
                         open(err.c_str(), O_WRONLY | O_CREAT, 0600)};
    for (int i = 0; i < 3; ++i)
      if (files[i] < 0 || dup2(files[i], i) < 0) _exit(126);
    if (chdir(folder.c_str()) != 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(out), read_text(err)};
}

inline Outcome run_command(std::vector<std::string> arguments, const std::filesystem::path& folder,
                           const std::filesystem::path& input = "/dev/null") {
  arguments.insert(arguments.begin(), command_path);
  return run_program(std::move(arguments), folder, input);
}

/// A line for /bin/sh, with the command on PATH.
inline Outcome run_shell(const std::string& line, const std::filesystem::path& folder) {
  const std::string bin = std::filesystem::path(command_path).parent_path();
  return run_program({"/bin/sh", "-c", "PATH='" + bin + "':$PATH; " + line}, folder);
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace sinew::test
