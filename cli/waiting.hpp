/// @file waiting.hpp
/// A sign of life while a question is solved: on a terminal, after a moment, a line that counts the seconds.
#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace sinew::cli {

/// Shows the line as long as it lives, and leaves the terminal as it was. Nothing where stderr is no
/// terminal.
class Waiting {
 public:
  explicit Waiting(bool is_quiet);
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

  /// What is being done, instead of "solving"; from any thread.
  void say(const std::string& what);

 private:
  void show();

  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_over_ = false;
  std::string what_ = "solving";
  std::thread thread_;  ///< last: it reads the others
};

}  // namespace sinew::cli
