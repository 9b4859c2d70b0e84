#include "solve/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace sinew::inline v1 {

std::string_view format_mm(double metres, std::span<char> buffer) noexcept {
  const auto end = fmt::format_to_n(buffer.data(), buffer.size(), "{:.6g} mm", 1000 * metres);
  return {buffer.data(), std::min(end.size, buffer.size())};
}

std::string_view format_degrees(double radians, std::span<char> buffer) noexcept {
  const auto end =
      fmt::format_to_n(buffer.data(), buffer.size(), "{:.6g} deg", radians * 180 / std::numbers::pi);
  return {buffer.data(), std::min(end.size, buffer.size())};
}

}  // namespace sinew::inline v1
