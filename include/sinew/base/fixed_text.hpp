/// @file fixed_text.hpp
/// A short text of fixed capacity: a solver in a hot loop can say why it failed without touching the heap.
#pragma once
#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <span>
#include <string_view>

#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// At most so many bytes of UTF-8 text, without the heap; what does not fit is cut off.
template <std::size_t Capacity>
class FixedText {
 public:
  using value_type = char;

  FixedText() = default;
  /// As much of the text as fits.
  FixedText(std::string_view text) { append(text); }  // NOLINT(google-explicit-constructor): a text is a text

  /// Only what there is, mostly nothing, is copied: every answer of a solver carries a text.
  FixedText(const FixedText& other) : size_(other.size_) { copy(other); }
  FixedText& operator=(const FixedText& other) {
    size_ = other.size_;
    copy(other);
    return *this;
  }

  /// Appends what fits; the rest is cut off.
  void append(std::string_view text) {
    for (const char c : text) push_back(c);
  }
  /// One more byte, if it fits; fmt can so write through a back inserter.
  void push_back(char c) {
    if (size_ < Capacity) text_[size_++] = c;
  }

  bool empty() const { return size_ == 0; }  ///< without text
  /// The text; not ended by 0. It holds as long as this.
  std::string_view view() const { return {text_.data(), size_}; }

 private:
  void copy(const FixedText& other) {
    if (this != &other) std::copy_n(other.text_.begin(), size_, text_.begin());
  }

  std::size_t size_ = 0;
  std::array<char, Capacity> text_;  // not initialised: only the first size_ characters are ever read
};

/// A length given in metres as people read it, "12.5 mm", written into `buffer` without the heap.
SINEW_API std::string_view format_mm(double metres, std::span<char> buffer) noexcept;

/// Appends a length given in metres, "12.5 mm".
template <std::size_t Capacity>
void append_mm(FixedText<Capacity>& text, double metres) {
  std::array<char, 32> buffer;
  text.append(format_mm(metres, buffer));
}

/// An angle given in radians as people read it, "12.5 deg", written into `buffer` without the heap.
SINEW_API std::string_view format_degrees(double radians, std::span<char> buffer) noexcept;

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
