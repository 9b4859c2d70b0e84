/// @file scratch.hpp
/// A folder of its own among the temporary files, which goes with it.
#pragma once
#include <filesystem>
#include <string_view>
#include <utility>

#include "sinew/base/error.hpp"

namespace sinew::server {

class Scratch {
 public:
  /// Removes besides what programs left that were ended before they could. Code: `file_unwritable`.
  static Expected<Scratch> make();

  const std::filesystem::path& path() const { return path_; }

  Scratch(Scratch&& other) noexcept : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}
  Scratch& operator=(Scratch&&) = delete;
  ~Scratch();

 private:
  Scratch(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}

  std::filesystem::path path_;
  int lock_;  // while the folder is in use; the system takes it back from a program that ends in any way
};

}  // namespace sinew::server
