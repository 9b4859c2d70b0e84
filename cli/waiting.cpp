#include "waiting.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

#include "terminal.hpp"

namespace sinew::cli {
namespace {

using namespace std::chrono_literals;
constexpr auto first_line = 300ms;  ///< most questions are answered before
constexpr auto next_line = 100ms;

}  // namespace

Waiting::Waiting(bool is_quiet) {
  if (is_quiet || isatty(STDERR_FILENO) == 0) return;
  sigset_t all, before;  // so that a signal is handled by the thread that solves, not by this one
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { show(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Waiting::~Waiting() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Waiting::say(const std::string& what) {
  const std::lock_guard lock(mutex_);
  what_ = what;
}

void Waiting::show() {
  const auto begin = std::chrono::steady_clock::now();
  const auto is_over = [this] { return is_over_; };
  std::unique_lock lock(mutex_);
  if (changed_.wait_for(lock, first_line, is_over)) return;
  do {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    fmt::print(
        stderr, "\r{:.1f} s  {}\033[K", elapsed.count(),
        interrupted() ? std::string("stopping; Ctrl-C again ends it at once") : what_ + "; Ctrl-C stops it");
    std::fflush(stderr);
  } while (!changed_.wait_for(lock, next_line, is_over));
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace sinew::cli
