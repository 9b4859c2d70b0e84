/// @file process.hpp
/// Other programs, run without a shell: gnuplot, a cross compiler, a simulator.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::inline v1 {

/// What a program came to.
struct ProcessResult {
  int spawn_error = 0;   ///< errno of the start; 0: it started
  int status = 0;        ///< of waitpid
  std::string output;    ///< its stdout
  std::string messages;  ///< the beginning of its stderr

  bool is_missing() const;  ///< there is no such program
  bool succeeded() const;   ///< it started and ended with exit status 0
  /// Why it did not, on one line.
  std::string complaint() const;
};

/// Runs a program, by name or path, in a folder, and waits for its end.
/// @param input what it reads on stdin
ProcessResult run_process(std::vector<std::string> arguments, const std::filesystem::path& folder,
                          std::string_view input = {});

}  // namespace sinew::inline v1
