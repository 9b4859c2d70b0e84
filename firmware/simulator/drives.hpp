/// @file drives.hpp
/// Servo drives on the controller's SPI, played: they take setpoints when LATCH rises, follow them while
/// ENABLE is high, and tell where they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "simulator/controller.hpp"

namespace sinew::firmware {

class Drives {
 public:
  Drives(Controller& controller, std::size_t count)
      : setpoints(count),
        positions(count),
        strain(count),
        sampled_(count),
        controller_(controller),
        sent_(4 * count) {
    controller.spi = [this](std::uint8_t byte) { return exchange(byte); };
    controller.watch_port_b(latch_bit, [this](bool high) { high ? latch() : select(); });
  }
  Drives(const Drives&) = delete;
  Drives& operator=(const Drives&) = delete;

  static constexpr int latch_bit = 0, enable_bit = 0;  ///< of ports B and L
  bool are_enabled() const { return controller_.is_high('L', enable_bit); }

  std::vector<std::int32_t> setpoints;  ///< the last that were latched
  std::vector<std::int32_t> positions;  ///< where they are
  /// What the encoders show beyond where the drives shall be: a tendon pulled out or run slack.
  std::vector<std::int32_t> strain;
  bool samples_at_latch = false;      ///< what they answer is of the end of the exchange before
  std::size_t latched = 0, torn = 0;  ///< exchanges that were whole, and that were not

 private:
  void select() { bytes_ = 0; }

  std::uint8_t exchange(std::uint8_t byte) {
    if (bytes_ == sent_.size()) return ++torn, 0;
    sent_[bytes_] = byte;
    const std::size_t drive = bytes_ / 4;
    const auto measured =
        static_cast<std::uint32_t>(samples_at_latch ? sampled_[drive] : positions[drive] + strain[drive]);
    const auto answer = static_cast<std::uint8_t>(measured >> (24 - 8 * (bytes_ % 4)));
    ++bytes_;
    return answer;
  }

  void latch() {
    for (std::size_t i = 0; i < sampled_.size(); ++i) sampled_[i] = positions[i] + strain[i];
    if (bytes_ == 0) return;
    if (bytes_ != sent_.size()) {
      ++torn;
      return;
    }
    for (std::size_t i = 0; i < setpoints.size(); ++i) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 4; ++k) word = word << 8 | sent_[4 * i + k];
      setpoints[i] = static_cast<std::int32_t>(word);
      if (are_enabled()) positions[i] = setpoints[i];
    }
    bytes_ = 0;
    ++latched;
  }

  std::vector<std::int32_t> sampled_;
  Controller& controller_;
  std::vector<std::uint8_t> sent_;
  std::size_t bytes_ = 0;
};

}  // namespace sinew::firmware
