/// @file drives.hpp
/// Servo drives on the controller's SPI, played: they take setpoints when LATCH rises, if the checksum holds,
/// follow them while ENABLE is high, and tell where they are and, if they measure it, how strongly they pull.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "protocol/crc16.h"
#include "simulator/controller.hpp"

namespace sinew::firmware {

class Drives {
 public:
  /// @param measuring the first so many measure tension
  Drives(Controller& controller, std::size_t count, std::size_t measuring = 0)
      : setpoints(count),
        positions(count),
        strain(count),
        tensions(measuring),
        sampled_(count),
        controller_(controller),
        received_(4 * count + 2 * measuring + 2),
        answer_(received_.size()) {
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
  std::vector<std::uint16_t> tensions;  ///< [1/256 N], where they are measured
  bool follow_at_once = true;           ///< else somebody else moves them
  bool samples_at_latch = false;        ///< what they answer is of the end of the exchange before
  /// What the wire makes of each byte to them and from them.
  std::function<std::uint8_t(std::uint8_t)> to_drives, from_drives;
  std::size_t latched = 0;  ///< exchanges that were taken,
  std::size_t torn = 0;     ///< that had too few bytes or too many,
  std::size_t refused = 0;  ///< and whose checksum was wrong

 private:
  void select() {
    bytes_ = 0;
    Crc16 sum;
    std::size_t at = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const auto count =
          static_cast<std::uint32_t>(samples_at_latch ? sampled_[i] : positions[i] + strain[i]);
      for (int shift = 24; shift >= 0; shift -= 8)
        sum.add(answer_[at++] = static_cast<Uint8>(count >> shift));
    }
    for (const std::uint16_t tension : tensions)
      for (const int shift : {8, 0}) sum.add(answer_[at++] = static_cast<Uint8>(tension >> shift));
    // Drives that have refused the last exchange say so by the complement.
    const std::uint8_t mask = has_refused_ ? 0xFF : 0;
    answer_[at++] = sum.high() ^ mask;
    answer_[at] = sum.low() ^ mask;
  }

  std::uint8_t exchange(std::uint8_t byte) {
    if (bytes_ == received_.size()) return ++torn, 0;
    received_[bytes_] = to_drives ? to_drives(byte) : byte;
    const std::uint8_t answer = answer_[bytes_++];
    return from_drives ? from_drives(answer) : answer;
  }

  bool is_whole() const {
    Crc16 sum;
    for (std::size_t i = 0; i + 2 < received_.size(); ++i) sum.add(received_[i]);
    return received_[received_.size() - 2] == sum.high() && received_.back() == sum.low();
  }

  void latch() {
    for (std::size_t i = 0; i < sampled_.size(); ++i) sampled_[i] = positions[i] + strain[i];
    if (bytes_ == 0) return;
    const bool is_torn = bytes_ != received_.size();
    bytes_ = 0;
    has_refused_ = is_torn || !is_whole();
    if (has_refused_) {
      ++(is_torn ? torn : refused);
      return;
    }
    for (std::size_t i = 0; i < setpoints.size(); ++i) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 4; ++k) word = word << 8 | received_[4 * i + k];
      setpoints[i] = static_cast<std::int32_t>(word);
      if (follow_at_once && are_enabled()) positions[i] = setpoints[i];
    }
    ++latched;
  }

  std::vector<std::int32_t> sampled_;
  Controller& controller_;
  std::vector<std::uint8_t> received_, answer_;
  std::size_t bytes_ = 0;
  bool has_refused_ = false;
};

}  // namespace sinew::firmware
