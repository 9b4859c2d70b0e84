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
  Uint8 room() {
    if (room_left >= 255) return 255;
    if (room_left < 10) return ++now, room_left += 100, 0;  // the line needs its time
    return static_cast<Uint8>(room_left);
  }
  void put(Uint8 byte) {
    if (room_left-- == 0) throw std::logic_error("a byte for which there was no room");
    sent += static_cast<char>(byte);
  }
  void put(const Uint8* bytes, Uint8 size) {
    for (; size > 0; --size) put(*bytes++);
  }
  void flush() {}
  Uint16 milliseconds() const { return now; }
  void enable(bool on) {
    enabled = on;
    if (enabled && follows) positions = setpoints;
  }
  bool exchange(const Counts& out) {
    ++exchanges;
    answer = positions;
    if (damaged_exchanges > 0) return --damaged_exchanges, false;
    const bool is_whole = !has_refused;
    has_refused = refused_exchange > 0 && --refused_exchange == 0;
    if (has_refused) return is_whole;
    std::copy(std::begin(out), std::end(out), setpoints.begin());
    if (enabled && follows) positions = setpoints;
    if (keeps_path) path.push_back(setpoints);
    return is_whole;
  }
  Int32 measured(Uint8 drive) const { return answer.at(drive); }
  Uint16 tension(Uint8 tendon) const { return tensions.at(tendon); }
  bool is_eeprom_ready() const { return true; }
  Uint8 eeprom_read(Uint16 address) const { return eeprom.at(address); }
  void eeprom_write(Uint16 address, Uint8 byte) {
    if (writes_until_power_fails-- == 0) throw std::runtime_error("power failed");
    eeprom.at(address) = address == worn ? 0x5A : byte;
  }

  std::string sent;
  Uint16 now = 0;
  bool enabled = false;
  bool follows = true;      ///< the drives their setpoints, at once
  int room_left = 1 << 30;  ///< on the line; where little is left, room comes by and by
  int exchanges = 0, damaged_exchanges = 0;
  int refused_exchange = 0;  ///< the how manieth the drives do not take, and say so in the one after it
  bool has_refused = false;
  std::array<std::int32_t, drive_count> setpoints{}, positions{}, answer{};
  std::array<Uint16, tendon_drives> tensions{};  ///< [1/256 N]
  bool keeps_path = false;
  std::vector<std::array<std::int32_t, drive_count>> path;  ///< setpoints of all exchanges
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
    for (const char c : bytes) {
      const auto byte = static_cast<Uint8>(c);
      if (session.collect(&byte, 1) != 1) throw std::logic_error("a byte that was not taken");
      session.answer();
    }
    return board.sent;
  }
  /// The one reply to a line.
  Answer ask(const std::string& line) {
    const std::string replies = ask_raw(line + '\n');
    if (std::ranges::count(replies, '\n') != 1 || replies.back() != '\n') return {};
    return read_answer(replies.substr(0, replies.size() - 1));
  }
  /// The one reply to a frame of bytes, whose payload is kept.
  Answer ask_binary(const std::string& frame) {
    const std::string replies = ask_raw(frame + '\n');
    if (std::ranges::count(replies, '\n') != 1 || replies.back() != '\n') return {};
    return read_binary_answer(replies.substr(0, replies.size() - 1), payload);
  }
  Answer ask_binary(char verb, const std::string& sent = {}) {
    return ask_binary(binary_request(verb, ++last, sent));
  }
  Answer ask(char verb, std::span<const int> numbers = {}) { return ask(request(verb, ++last, numbers)); }
  void wait(int milliseconds) {
    for (; milliseconds > 0; --milliseconds, session.watch()) ++board.now;
  }

  DeskBoard board;
  Session<DeskBoard> session{board};
  std::string payload;
  std::uint32_t last = 0xFFFF;  ///< the number before the first of an erased EEPROM's first session
};

}  // namespace sinew::firmware
