/// @file message.hpp
/// Numbers in the messages of reports, written without the heap.
#pragma once
#include <array>
#include <charconv>
#include <cstddef>
#include <span>
#include <string_view>

#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// A length given in metres as people read it, "12.5 mm", written into `buffer` without the heap.
std::string_view format_mm(double metres, std::span<char> buffer) noexcept;

/// Appends a length given in metres, "12.5 mm".
template <std::size_t Capacity>
void append_mm(FixedText<Capacity>& text, double metres) {
  std::array<char, 32> buffer;
  text.append(format_mm(metres, buffer));
}

/// An angle given in radians as people read it, "12.5 deg", written into `buffer` without the heap.
std::string_view format_degrees(double radians, std::span<char> buffer) noexcept;

/// Appends an angle given in radians, "12.5 deg".
template <std::size_t Capacity>
void append_degrees(FixedText<Capacity>& text, double radians) {
  std::array<char, 32> buffer;
  text.append(format_degrees(radians, buffer));
}

/// Appends a whole number.
template <std::size_t Capacity>
void append_number(FixedText<Capacity>& text, int number) {
  std::array<char, 12> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  text.append({buffer.data(), static_cast<std::size_t>(end - buffer.data())});
}

}  // namespace sinew::inline v1
