/// @file same_name.hpp
/// Names of fields, compared and copied: short pieces for the most part, for which a call of the library is
/// dearer than its work.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace sinew::inline v1 {

/// Calls `use(half, first, second)` with where the halves of a piece of 4 to 16 bytes begin, which may
/// overlap, and with a number of their size.
template <class Use>
[[gnu::always_inline]] inline auto in_halves(std::size_t size, const Use& use) {
  return size >= 8 ? use(std::uint64_t{}, std::size_t{0}, size - 8)
                   : use(std::uint32_t{}, std::size_t{0}, size - 4);
}
inline bool has_halves(std::size_t size) { return size >= 4 && size <= 16; }

/// As memcpy.
inline void copy_name(char* to, std::string_view name) {
  if (has_halves(name.size()))
    in_halves(name.size(), [&](auto half, std::size_t first, std::size_t second) {
      auto rest = half;
      std::memcpy(&half, name.data() + first, sizeof half);
      std::memcpy(&rest, name.data() + second, sizeof rest);
      std::memcpy(to + first, &half, sizeof half);
      std::memcpy(to + second, &rest, sizeof rest);
    });
  else if (name.size() < 4)
    for (std::size_t i = 0; i < name.size(); ++i) to[i] = name[i];
  else
    std::memcpy(to, name.data(), name.size());
}

/// Most of those that differ do in their length or their first letter.
inline bool is_same_name(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  if (a.empty()) return true;
  if (a.front() != b.front()) return false;
  if (!has_halves(a.size())) return a == b;
  return in_halves(a.size(), [&](auto half, std::size_t first, std::size_t second) {
    const auto read = [&](std::string_view name, std::size_t at) {
      std::memcpy(&half, name.data() + at, sizeof half);
      return half;
    };
    return read(a, first) == read(b, first) && read(a, second) == read(b, second);
  });
}

}  // namespace sinew::inline v1
