/// @file controller.hpp
/// A simulated ATmega2560 with a program: bytes on UART0, a peer on SPI, pins, EEPROM, and time in cycles.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

struct avr_t;
struct avr_irq_t;

namespace sinew::firmware {

class Controller {
 public:
  static constexpr std::uint32_t default_frequency = 16'000'000;

  /// Throws std::runtime_error if the file is no program.
  explicit Controller(const std::filesystem::path& elf, std::uint32_t frequency = default_frequency);
  ~Controller();
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  /// One instruction, or asleep until something happens. False once the program has stopped for good.
  bool step();
  /// So many cycles, or until it stops.
  bool run(std::uint64_t cycles);
  bool has_crashed() const;
  std::uint64_t cycle() const;
  /// Cycles of them in which it slept.
  std::uint64_t asleep() const { return asleep_; }
  std::uint32_t frequency() const { return frequency_; }
  std::uint64_t cycles(double seconds) const { return static_cast<std::uint64_t>(seconds * frequency_); }

  /// Of ten bits on the line at the rate that the program has set [s].
  double byte_time() const;
  /// For the UART: each byte goes out as soon as the receiver has room, and takes its time on the line.
  void send(std::string_view bytes) { outgoing_.insert(outgoing_.end(), bytes.begin(), bytes.end()); }
  bool all_sent() const { return outgoing_.empty(); }
  /// What came from the UART since the last call.
  std::string received() { return std::exchange(incoming_, {}); }
  /// Of each byte that the program gives to the UART, when it does.
  std::function<void(std::uint8_t)> on_sent;
  /// Of each byte on its way to the controller; what it gives is sent instead. Below 0: a framing error.
  std::function<int(std::uint8_t)> line;

  /// Whether a pin is driven high, e.g. ('L', 0).
  bool is_high(char port, int bit) const;
  /// What answers each byte on SPI.
  std::function<std::uint8_t(std::uint8_t)> spi;
  /// Called when that pin of port B is written.
  void watch_port_b(int bit, std::function<void(bool high)> changed);

  std::span<std::uint8_t> eeprom();
  /// As by the reset pin: EEPROM and flash stay.
  void reset();
  /// From now on it does nothing but the instruction at which it is, as after a fault. Interrupts go on.
  void hang();
  /// Puts the instruction back.
  void mend();

 private:
  void feed();
  void connect();

  std::uint32_t frequency_;
  std::uint64_t asleep_ = 0;
  avr_t* avr_ = nullptr;
  avr_irq_t* uart_input_ = nullptr;
  avr_irq_t* spi_input_ = nullptr;
  bool has_room_ = true;
  std::deque<char> outgoing_;
  std::string incoming_;
  std::function<void(bool)> port_b_changed_;
  std::uint32_t hung_at_ = 0;
  std::uint16_t hung_instruction_ = 0;
  bool is_hung_ = false;
};

}  // namespace sinew::firmware
