/// @file device_board.hpp
/// The real firmware of the panel on a simulated controller, with drives whose tendons are springs, and the
/// server's panel at its UART. Time is that of the controller.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "device_desk.hpp"
#include "paths.hpp"
#include "protocol/crc16.h"
#include "simulator/controller.hpp"

namespace sinew::server::device {

/// Servo drives on SPI that measure tension: set-points in, counts and tensions out, each with a checksum.
class SpringDrives {
 public:
  static constexpr std::size_t tendons = 15, drives = 16;

  explicit SpringDrives(firmware::Controller& controller) : controller_(controller) {
    controller.spi = [this](std::uint8_t byte) { return exchange(byte); };
    controller.watch_port_b(0, [this](bool is_high) { is_high ? latch() : select(); });
  }
  bool are_enabled() const { return controller_.is_high('L', 0); }

  std::vector<std::int32_t> positions = std::vector<std::int32_t>(drives);
  std::vector<double> tension = std::vector<double>(tendons, 0.5);  ///< [N]
  bool is_stuck = false;                                            ///< they follow nothing
  long changes = 0;                                                 ///< times that a position changed

 private:
  void select() {
    answer_.clear();
    received_.clear();
    for (const std::int32_t position : positions) put(static_cast<std::uint32_t>(position), 4);
    for (const double newtons : tension)
      put(static_cast<std::uint32_t>(std::lround(std::clamp(newtons, 0.0, 255.0) * 256)), 2);
    const std::uint16_t sum = sum_of(answer_);
    put(has_refused_ ? static_cast<std::uint16_t>(~sum) : sum, 2);
  }
  void put(std::uint32_t value, int size) {
    for (int k = size - 1; k >= 0; --k) answer_ += static_cast<char>(value >> (8 * k) & 0xFF);
  }
  static std::uint16_t sum_of(const std::string& bytes) {
    firmware::Crc16 sum;
    for (const char c : bytes) sum.add(static_cast<std::uint8_t>(c));
    return static_cast<std::uint16_t>(sum.high() << 8 | sum.low());
  }
  std::uint8_t exchange(std::uint8_t byte) {
    received_ += static_cast<char>(byte);
    return received_.size() <= answer_.size() ? static_cast<std::uint8_t>(answer_[received_.size() - 1]) : 0;
  }
  void latch() {
    if (received_.empty()) return;
    const std::string bytes = std::exchange(received_, {});
    has_refused_ =
        bytes.size() != answer_.size() || sum_of(bytes.substr(0, bytes.size() - 2)) !=
                                              (static_cast<std::uint8_t>(bytes[bytes.size() - 2]) << 8 |
                                               static_cast<std::uint8_t>(bytes.back()));
    if (has_refused_ || !are_enabled() || is_stuck) return;
    for (std::size_t i = 0; i < drives; ++i) {
      std::uint32_t word = 0;
      for (std::size_t k = 0; k < 4; ++k) word = word << 8 | static_cast<std::uint8_t>(bytes[4 * i + k]);
      const auto to = static_cast<std::int32_t>(word);
      changes += to != positions[i];
      positions[i] = to;
    }
  }

  firmware::Controller& controller_;
  std::string answer_, received_;
  bool has_refused_ = false;
};

/// The UART, without a port between.
class UartWire : public Wire {
 public:
  UartWire(firmware::Controller& controller, const bool& is_plugged)
      : controller_(controller),
        is_plugged_(is_plugged) {}
  std::string read() override {
    std::string bytes = controller_.received();
    return is_plugged_ ? bytes : "";
  }
  void write(std::string_view bytes) override {
    if (is_plugged_) controller_.send(bytes);
  }
  bool is_gone() const override { return !is_plugged_; }
  void wait(double) override {}

 private:
  firmware::Controller& controller_;
  const bool& is_plugged_;
};

/// @tparam Drives made of a controller
template <class Drives>
struct BoardOf {
  explicit BoardOf(const std::string& motor = "{lead: 2 mm, counts: 4096}")
      : controller(std::string(test::firmware_folder) + "/sinew-firmware-panel.elf"),
        drives(controller),
        link([this]() -> std::unique_ptr<Wire> {
          if (!is_plugged) return nullptr;
          return std::make_unique<UartWire>(controller, is_plugged);
        }),
        panel(test_arm(motor), Judge(Session::open(arm_document(motor)).value(), test_arm(motor)), link,
              recording,
              {[] { return "10:41:07"; }, another_name("board"), [] { return "2026-01-02 10:41:07"; }}) {}
  ~BoardOf() {
    std::error_code ignored;
    std::filesystem::remove_all(place, ignored);
  }

  double now() const { return static_cast<double>(controller.cycle()) / controller.frequency(); }
  void run(double seconds) {
    for (const double end = now() + seconds; now() < end;) {
      controller.run(controller.cycles(1e-3));
      if (recording.is_opening()) recording.wait(std::chrono::seconds(5));
      if (is_host_alive) panel.tick(now());
      if (seen) seen();
    }
  }
  /// Zeros where the drives are, past the panel.
  bool set_zeros() {
    const auto ask = [&](char verb, const std::string& payload) {
      for (int i = 0; i < 200 && !link.is_free(); ++i) step();
      link.ask(verb, payload, now());
      for (int i = 0; i < 200; ++i)
        for (const LinkEvent& event : step())
          if (event.kind == LinkEvent::Kind::answer && event.verb == verb)
            return event.error == WireError::none;
      return false;
    };
    bool is_good = ask('A', "");
    for (std::size_t i = 0; i < SpringDrives::drives; ++i)
      is_good = ask('Z', zero_payload(i, drives.positions[i])) && is_good;
    return ask('D', "") && is_good;
  }
  std::vector<LinkEvent> step() {
    controller.run(controller.cycles(1e-3));
    return link.poll(now());
  }

  firmware::Controller controller;
  Drives drives;
  bool is_plugged = true, is_host_alive = true;
  std::function<void()> seen;  ///< after each millisecond
  std::filesystem::path place = another_place();
  Recording recording{place};
  ControllerLink link;
  Panel panel;
};
using Board = BoardOf<SpringDrives>;

}  // namespace sinew::server::device
