/// @file desk.hpp
/// The firmware's protocol on a desk: a board without hardware.
#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>

#include "frames.hpp"
#include "protocol/session.h"

namespace sinew::firmware {

struct DeskBoard {
  static std::array<Uint8, 16> erased() {
    std::array<Uint8, 16> bytes;
    bytes.fill(0xFF);
    return bytes;
  }
  void send(char c) { sent += c; }
  Uint16 milliseconds() const { return now; }
  void enable(bool on) { enabled = on; }
  void exchange(const Counts& out, Counts& in) {
    ++exchanges;
    std::copy(std::begin(out), std::end(out), setpoints.begin());
    std::copy(positions.begin(), positions.end(), in);
    if (enabled) positions = setpoints;
  }
  Uint8 eeprom_read(Uint16 address) const { return eeprom.at(address); }
  void eeprom_write(Uint16 address, Uint8 byte) {
    if (writes_until_power_fails-- == 0) throw std::runtime_error("power failed");
    eeprom.at(address) = address == worn ? 0x5A : byte;
  }

  std::string sent;
  Uint16 now = 0;
  bool enabled = false;
  int exchanges = 0;
  std::array<std::int32_t, drive_count> setpoints{}, positions{};
  std::array<Uint8, 16> eeprom = erased();
  int writes_until_power_fails = -1;
  int worn = -1;  ///< a cell that keeps nothing
};

struct Desk {
  explicit Desk(const std::array<Uint8, 16>* eeprom = nullptr) {
    if (eeprom) board.eeprom = *eeprom;
    session.start('p');
  }

  /// All that is answered.
  std::string ask_raw(std::string_view bytes) {
    board.sent.clear();
    for (const char c : bytes) session.take(c);
    return board.sent;
  }
  /// The one reply to a line.
  Answer ask(const std::string& line) {
    const std::string replies = ask_raw(line + '\n');
    if (std::ranges::count(replies, '\n') != 1 || replies.back() != '\n') return {};
    return read_answer(replies.substr(0, replies.size() - 1));
  }
  Answer ask(char verb, std::span<const int> numbers = {}) { return ask(request(verb, ++last, numbers)); }
  void wait(int milliseconds) {
    for (; milliseconds > 0; --milliseconds, session.watch()) ++board.now;
  }

  DeskBoard board;
  Session<DeskBoard> session{board};
  std::uint32_t last = 0xFFFF;  ///< the number before the first of an erased EEPROM's first session
};

}  // namespace sinew::firmware
