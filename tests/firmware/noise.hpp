/// @file noise.hpp
/// Lines that must all be refused: noise, damaged frames, and frames that are whole but stale, of another
/// session or table, beyond limits, or not what their verb takes.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <random>
#include <set>

#include "frames.hpp"

namespace sinew::firmware {

/// How many lines a test of noise sends: as many as it usually does, or more where SINEW_FIRMWARE_LINES asks
/// for it.
inline int lines_of(int usual) {
  const char* more = std::getenv("SINEW_FIRMWARE_LINES");
  return more ? std::max(usual, std::atoi(more)) : usual;
}

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}

  int below(int end) { return std::uniform_int_distribution<>(0, end - 1)(random_); }

  /// The text with that many of its bits changed: different ones, for one that is changed twice is as it was.
  std::string with_flips(std::string text, int bits) {
    std::set<int> flipped;
    while (static_cast<int>(flipped.size()) < bits) flipped.insert(below(8 * static_cast<int>(text.size())));
    for (const int bit : flipped) {
      char& byte = text[static_cast<std::size_t>(bit / 8)];
      byte = static_cast<char>(byte ^ 1 << bit % 8);
    }
    return text;
  }

  /// Within the limits.
  std::vector<int> pose() {
    std::vector<int> numbers(bend_count);
    const int limit = robot::limits.limit[0];
    for (int& bend : numbers) bend = below(2 * limit + 1) - limit;
    if (stage_count > 0) numbers.push_back(below(stage_limit + 1));
    return numbers;
  }

  /// Text for the line, mostly one line, always ending in a newline.
  /// @param last the last number that was accepted, and all frames that were
  std::string line(std::uint32_t last, const std::vector<std::string>& accepted) {
    const std::string fresh = request('P', last + 1 + static_cast<std::uint32_t>(below(3)), pose());
    switch (below(12)) {
      case 0:
        return noise(below(2) ? 40 : 250) + '\n';
      case 1:
        return fresh.substr(0, static_cast<std::size_t>(below(static_cast<int>(fresh.size())))) + '\n';
      case 2:
        return fresh.substr(0, fresh.size() - 8) + hex(static_cast<std::uint32_t>(random_())) + '\n';
      case 3:
        return flipped(fresh, 1);
      case 4:
        return flipped(fresh, 2);
      case 5:
        return edited(fresh);
      case 6:
        return accepted.empty() ? "\n" : accepted[pick(accepted.size())] + '\n';
      case 7:
        return request("APSD"[below(4)], last - static_cast<std::uint32_t>(below(50)), pose()) + '\n';
      case 8:
        return request('P', last + 1 + 65536 * static_cast<std::uint32_t>(1 + below(9)), pose()) + '\n';
      case 9:
        return request('P', last + 1, pose(), table_hash ^ 1u << below(32)) + '\n';
      case 10:
        return fresh + fresh + '\n';
      default:
        return wrong_numbers(last + 1) + '\n';
    }
  }

  /// The same of binary frames, and of both among each other.
  std::string binary(std::uint32_t last, const std::vector<std::string>& accepted) {
    const std::uint32_t next = last + 1 + static_cast<std::uint32_t>(below(3));
    const std::string fresh = binary_pose(next, pose(), below(2) ? 0 : below(65536));
    const std::size_t inside = 1 + pick(fresh.size() - 1);
    switch (below(17)) {
      case 0:
        return noise(below(2) ? 60 : 300) + '\n';
      case 1:
        return fresh.substr(0, pick(fresh.size())) + '\n';
      case 2:
        return fresh.substr(inside) + '\n';
      case 3:
        return flipped(fresh, 1);
      case 4:
        return flipped(fresh, 2 + below(6));
      case 5:
        return edited(fresh);
      case 6:
        return accepted.empty() ? "\n" : accepted[pick(accepted.size())] + '\n';
      case 7:
        return binary_request("APSD"[below(4)], last - static_cast<std::uint32_t>(below(50)),
                              below(2) ? pose_payload(pose()) : "") +
               '\n';
      case 8:
        return binary_pose(next + 65536 * static_cast<std::uint32_t>(1 + below(9)), pose()) + '\n';
      case 9:
        return binary_request('P', next, pose_payload(pose()), table_hash ^ 1u << below(32)) + '\n';
      case 10:
        return fresh + fresh + '\n';
      case 11:  // a newline within
        return fresh.substr(0, inside) + '\n' + fresh.substr(inside) + '\n';
      case 12:  // ASCII within
        return fresh.substr(0, inside) + request('P', next, pose()) + '\n' + fresh.substr(inside) + '\n';
      case 13:  // and around
        return request('P', next, pose()).insert(inside, fresh) + '\n';
      case 14:
        return std::string(pick(5), '\n') + static_cast<char>(below(2) ? 0xFF : 0x81) + noise(200) + '\n';
      case 15:  // two frames with another order of their halves
        return fresh.substr(inside) + fresh.substr(0, inside) + '\n';
      default:
        return binary_wrong(next) + '\n';
    }
  }

 private:
  std::size_t pick(std::size_t size) { return static_cast<std::size_t>(below(static_cast<int>(size))); }

  std::string noise(int most) {
    std::string text(pick(static_cast<std::size_t>(most)), ' ');
    const bool printable = below(2) == 0;
    for (char& c : text) {
      c = static_cast<char>(printable ? ' ' + below(95) : below(256));
      if (c == '\n') c = '\r';
    }
    return text;
  }

  /// Its bits and its newline's, some of which have changed; a newline follows in any case.
  std::string flipped(const std::string& frame, int bits) {
    const std::string line = with_flips(frame + '\n', bits);
    // A frame that is whole but for its newline goes on into the next line.
    return line.back() == '\n' ? line : line + "?\n";
  }

  /// Whole and fresh, but not to be obeyed.
  std::string binary_wrong(std::uint32_t sequence) {
    std::vector<int> numbers = pose();
    const std::string payload = pose_payload(numbers);
    switch (below(5)) {
      case 0:
        numbers[pick(bend_count)] = robot::limits.limit[0] + 1 + below(1000);
        return binary_pose(sequence, numbers);
      case 1:
        return binary_request('P', sequence, payload.substr(0, pick(payload.size())));
      case 2:
        return binary_request('P', sequence, payload + 'x' + noise(200));
      case 3:
        return binary_request("ASDH"[below(4)], sequence, payload);
      default: {
        const char verb = static_cast<char>(below(256));
        return binary_request(std::strchr("HAPSD", verb) ? '!' : verb, sequence, below(2) ? payload : "");
      }
    }
  }

  /// A character lost, doubled, exchanged with its neighbour, or another one.
  std::string edited(std::string frame) {
    const std::string whole = frame;
    const std::size_t at = pick(frame.size() - 1);
    switch (below(4)) {
      case 0:
        frame.erase(at, 1);
        break;
      case 1:
        frame.insert(at, 1, frame[at]);
        break;
      case 2:
        std::swap(frame[at], frame[at + 1]);
        break;
      default:
        frame[at] = static_cast<char>(' ' + below(95));
    }
    return (frame == whole ? frame + ' ' : frame) + '\n';
  }

  /// Whole and fresh, but not to be obeyed.
  std::string wrong_numbers(std::uint32_t sequence) {
    std::vector<int> bends = pose();
    switch (below(6)) {
      case 0:
        bends[pick(bend_count)] = robot::limits.limit[0] + 1 + below(1000);
        break;
      case 1:
        bends[pick(bend_count)] = -32769 - below(100000);
        break;
      case 2:
        bends.pop_back();
        break;
      case 3:
        bends.push_back(0);
        break;
      case 4:
        return request("ASDH"[below(4)], sequence, bends);
      default:
        return request(static_cast<char>("XpQ*"[below(4)]), sequence, bends);
    }
    return request('P', sequence, bends);
  }

  std::mt19937 random_;
};

}  // namespace sinew::firmware
