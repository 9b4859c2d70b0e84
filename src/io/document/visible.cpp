#include "io/document/visible.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <iterator>

#include "io/document/parse.hpp"

namespace sinew::inline v1 {
namespace {

/// A character of UTF-8 of two bytes or more, which is known to be whole.
unsigned code_point(std::string_view character) {
  const auto lead = static_cast<unsigned char>(character.front());
  unsigned code = lead & (character.size() == 2 ? 0x1FU : character.size() == 3 ? 0x0FU : 0x07U);
  for (const char c : character.substr(1)) code = code << 6U | (static_cast<unsigned char>(c) & 0x3FU);
  return code;
}

bool steers(unsigned code) {
  return (code >= 0x80 && code < 0xA0) || code == 0x061C || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

/// So many characters at the beginning are of ASCII and none controls anything: a multiple of eight, as many
/// as are looked at in one.
std::size_t plain_beginning(std::string_view text) {
  constexpr std::uint64_t each = 0x0101010101010101U, high = 0x80 * each;
  std::size_t count = 0;
  for (std::uint64_t eight = 0; count + sizeof(eight) <= text.size(); count += sizeof(eight)) {
    std::memcpy(&eight, text.data() + count, sizeof(eight));
    const std::uint64_t below_space = eight - 0x20 * each,
                        above_tilde = eight + each;  // in a byte's high bit
    if (((eight | below_space | above_tilde) & high) != 0) break;
  }
  return count;
}

std::string spelled(std::string_view text, bool is_line) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t plain = plain_beginning(text.substr(i));
    result.append(text, i, plain);
    i += plain;
    if (i == text.size()) break;
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80) {
      const bool stays = (byte >= 0x20 && byte != 0x7F) || (!is_line && (byte == '\n' || byte == '\t'));
      if (stays)
        result += text[i];
      else if (byte == '\n' || byte == '\t')
        result += byte == '\n' ? "\\n" : "\\t";
      else
        fmt::format_to(std::back_inserter(result), "\\u{:04x}", unsigned{byte});
      ++i;
      continue;
    }
    const std::string_view character = text.substr(i, byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4);
    const bool is_whole = utf8_size(character) == character.size() && character.size() > 1;
    if (!is_whole)
      fmt::format_to(std::back_inserter(result), "\\x{:02x}", unsigned{byte});
    else if (const unsigned code = code_point(character); steers(code))
      fmt::format_to(std::back_inserter(result), "\\u{:04x}", code);
    else
      result += character;
    i += is_whole ? character.size() : 1;
  }
  return result;
}

}  // namespace

std::string visible(std::string_view text) { return spelled(text, false); }

std::string visible_line(std::string_view text) { return spelled(text, true); }

}  // namespace sinew::inline v1
