/// @file terminal.hpp
/// A pseudo-terminal: what opens its link finds a serial port there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sinew::firmware {

class Terminal {
 public:
  /// Makes the link, in the place of an old one; throws std::runtime_error where that cannot be done.
  explicit Terminal(std::filesystem::path link);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// What has come since the last call.
  std::string read();
  /// What does not fit because nobody reads is lost, as on a serial line.
  void write(std::string_view bytes);

 private:
  std::filesystem::path link_;
  int here_ = -1;
  int there_ = -1;  ///< kept open: else reading fails whenever no host has it open
};

}  // namespace sinew::firmware
