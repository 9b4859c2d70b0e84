/// @file study_folder.hpp
/// Where tests of reproduced figures write, and a shell without programs.
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace sinew::test {

/// A folder of its own that goes with it.
struct Folder {
  std::filesystem::path path;
  Folder() {
    static int count = 0;
    path = std::filesystem::temp_directory_path() /
           ("sinew_study_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path);
  }
  Folder(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path); }
};

/// PATH with nothing on it, until the end of the scope.
struct EmptyPath {
  std::string before = std::getenv("PATH");
  EmptyPath() { setenv("PATH", "/nothing-here", 1); }
  ~EmptyPath() { setenv("PATH", before.c_str(), 1); }
};

inline std::string bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace sinew::test
