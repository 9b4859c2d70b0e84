/// @file progress.hpp
/// How far long work is: a bar on a terminal, a line now and then elsewhere.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace sinew::cli {

class ProgressLine {
 public:
  /// @param unit of the rate: `samples`
  ProgressLine(bool quiet, std::string_view unit);
  ~ProgressLine();  ///< leaves the terminal's line empty
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param done of `total`, @param new_ones of them in `seconds`, which the rate is made of
  void show(std::size_t done, std::size_t total, std::size_t new_ones, double seconds);

 private:
  std::string unit_;
  bool is_quiet_, is_terminal_, is_shown_ = false;
  double next_line_;
};

/// `1.23 M`, `980`, `12.3 k`.
std::string short_number(double value);
/// `1:02:03`, `0:07`.
std::string short_time(double seconds);

}  // namespace sinew::cli
