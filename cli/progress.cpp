#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "terminal.hpp"

namespace sinew::cli {
namespace {

constexpr double seconds_between_lines = 10;
constexpr std::size_t bar_width = 24;

}  // namespace

std::string short_number(double value) {
  constexpr std::pair<double, const char*> sizes[] = {{1e12, " T"}, {1e9, " G"}, {1e6, " M"}, {1e3, " k"}};
  for (const auto& [size, letter] : sizes)
    if (value >= size) return fmt::format("{:.3g}{}", value / size, letter);
  return fmt::format("{:.3g}", value);
}

std::string short_time(double seconds) {
  const auto whole = static_cast<long long>(std::clamp(seconds, 0.0, 1e9) + 0.5);
  const long long h = whole / 3600, m = whole / 60 % 60, s = whole % 60;
  return h > 0 ? fmt::format("{}:{:02}:{:02}", h, m, s) : fmt::format("{}:{:02}", m, s);
}

ProgressLine::ProgressLine(bool quiet, std::string_view unit)
    : unit_(unit),
      is_quiet_(quiet),
      is_terminal_(isatty(STDERR_FILENO) != 0),
      next_line_(seconds_between_lines) {}

ProgressLine::~ProgressLine() {
  if (is_shown_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::show(std::size_t done, std::size_t total, std::size_t new_ones, double seconds) {
  if (is_quiet_ || (!is_terminal_ && seconds < next_line_)) return;
  const double part = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1;
  const double rate = seconds > 0 ? static_cast<double>(new_ones) / seconds : 0;
  const std::string left = rate > 0 ? short_time(static_cast<double>(total - done) / rate) + " left" : "";
  const std::string text =
      fmt::format("{:3.0f} %  {} of {} {}  {}/s  {}", 100 * part, short_number(static_cast<double>(done)),
                  short_number(static_cast<double>(total)), unit_, short_number(rate), left);
  if (is_terminal_) {
    const auto full = static_cast<std::size_t>(part * static_cast<double>(bar_width));
    fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(full, '='), std::string(bar_width - full, ' '), text);
    std::fflush(stderr);
    is_shown_ = true;
  } else {
    message(text);
    next_line_ = seconds + seconds_between_lines;
  }
}

}  // namespace sinew::cli
