/// @file homing.hpp
/// Zeros of the tendons, one after the other: it is paid out until it hangs, taken in until it pulls, let go
/// again a little and taken in slowly, and where it began to pull is zero. Then it stays there, just taut.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "arm.hpp"

namespace sinew::server::device {

class Homing {
 public:
  Homing(const Arm& arm, const Hello& hello) : arm_(arm), hello_(hello) {}

  /// What to do now: a set-point for one drive, or a zero.
  struct Step {
    std::size_t drive = 0;
    std::int32_t count = 0;
    bool is_zero = false;  ///< where the drive is now is that count
  };
  /// @param fast [m] that a tendon may go until the next step
  /// @param setpoints of the drives
  std::optional<Step> next(const DriveState& state, const std::vector<std::int32_t>& setpoints, double fast);
  /// The zero was taken.
  void zero_is_set();

  bool is_done() const { return done_ >= hello_.drives(); }
  std::size_t done() const { return done_; }  ///< drives
  std::string_view step() const;
  /// Why it cannot go on; empty: it can.
  const char* failure() const { return failure_; }

 private:
  enum class Phase { pay_out, take_in, back_off, feel, zero, settle };
  void begin_tendon();
  std::optional<Step> move(double way, const std::vector<std::int32_t>& setpoints);
  std::optional<Step> feel(const DriveState& state, const std::vector<std::int32_t>& setpoints, double fast);
  std::int32_t zero_count() const;

  const Arm& arm_;
  Hello hello_;
  Phase phase_ = Phase::pay_out;
  std::size_t done_ = 0;
  double gone_ = 0;  ///< [m] in this phase
  struct Sample {
    double count, tension;
  };
  std::vector<Sample> samples_;
  const char* failure_ = "";
};

}  // namespace sinew::server::device
