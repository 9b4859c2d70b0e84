/// @file simulated.hpp
/// The demonstration's device: sinew-simulate as a child, with the firmware of the panel, on a
/// pseudo-terminal.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "sinew/base/error.hpp"

namespace sinew::server::device {

class Simulated {
 public:
  /// Errors: `not_built` where the program or the firmware is not there, `failed` where it does not start.
  /// @param robot text of the robot's file, whose arm is simulated
  static Expected<std::unique_ptr<Simulated>> start(const std::string& robot);
  ~Simulated();
  Simulated(const Simulated&) = delete;
  Simulated& operator=(const Simulated&) = delete;

  /// The pseudo-terminal.
  std::string port() const { return (folder_ / "device").string(); }
  /// A line for its stdin, as `cut 3 1`. What it has against it; empty: nothing.
  std::string tell(const std::string& line);
  pid_t process() const { return process_; }

 private:
  Simulated() = default;
  Expected<void> run(const std::filesystem::path& program, const std::filesystem::path& firmware);
  Expected<void> await_ready(int output);

  std::filesystem::path folder_;
  pid_t process_ = -1;
  int input_ = -1, output_ = -1;
  std::mutex mutex_;  // of a line and its answer
};

}  // namespace sinew::server::device
