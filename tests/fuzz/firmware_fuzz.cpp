// The firmware's line. Lines are sent as they are; of one that begins with `~` the rest is a frame's body,
// whose checksum is put to it, with `#` for the hash of the table and `@` for the next number of the session;
// of one that begins with `}` a binary one. So mutations of bodies pass the checksum.
#include <algorithm>
#include <span>
#include <sstream>

#include "../firmware/desk.hpp"
#include "check.hpp"
#include "driver.hpp"

namespace {

using namespace sinew::firmware;
using sinew::fuzz::die;

constexpr std::string_view words[] = {"~H 0 #",
                                      "~A @ #",
                                      "~S @ #",
                                      "~D @ #",
                                      "~P @ # 0 0 0 0 0 0 0 0 0 0",
                                      "}H@#",
                                      "}A@#",
                                      "}S@#",
                                      "}P@#",
                                      std::string_view("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 22),
                                      "\n",
                                      "\r\n",
                                      " ",
                                      "-",
                                      "0",
                                      "65536",
                                      "4294967295",
                                      "4294967296",
                                      "-2147483648",
                                      "*00000000",
                                      "~",
                                      "@",
                                      "#",
                                      std::string_view("\0", 1)};

std::string as_sent(std::string line, std::uint32_t next) {
  const bool is_binary = line.starts_with('}');
  if (!line.starts_with('~') && !is_binary) return line;
  line.erase(0, 1);
  const auto put = [&](char mark, const std::string& text) {
    for (std::size_t at = 0; (at = line.find(mark, at)) != std::string::npos && line.size() < 2000;
         at += text.size())
      line.replace(at, 1, text);
  };
  put('@', is_binary ? little_endian(next, 4) : std::to_string(next));
  put('#', is_binary ? little_endian(table_hash, 4) : hex(table_hash));
  return is_binary ? binary_framed(line) : framed(line);
}

/// Every line that ends gets one whole reply, and setpoints change only by what was accepted.
void check(const std::string& reply, bool has_moved, bool was_armed) {
  if (std::ranges::count(reply, '\n') != 1 || reply.back() != '\n') die("not one reply", reply);
  const Answer answer = read_any_answer(reply.substr(0, reply.size() - 1));
  if (!answer.is_whole) die("a reply whose checksum does not hold", reply);
  if (answer.verb != '!' && answer.verb != 'H' && answer.verb != 'A' && answer.verb != 'P' &&
      answer.verb != 'S' && answer.verb != 'D')
    die("a reply of no verb", reply);
  if (answer.verb == '!' && (answer.code < 1 || answer.code > static_cast<int>(Error::no_session)))
    die("an unknown error", reply);
  if (has_moved && answer.verb != 'P') die("a motion that nobody asked for", reply);
  if (has_moved && !was_armed) die("a motion of drives that are not armed", reply);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Desk desk;
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  std::uint32_t next = 0x10000;  // the first of an erased EEPROM's first session
  for (std::string line; std::getline(stream, line);) {
    const bool was_armed = desk.session.state() == State::armed;
    const auto before = desk.board.positions;
    const std::string reply = desk.ask_raw(as_sent(line, next) + '\n');
    check(reply, desk.board.positions != before, was_armed);
    const Answer answer = read_any_answer(reply.substr(0, reply.size() - 1));
    if (answer.verb != '!' && answer.verb != 'H') ++next;
    desk.wait(static_cast<int>(line.size() % 60));
  }
  return 0;
}

SINEW_FUZZ_MAIN("firmware", words)
