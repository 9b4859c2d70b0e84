#include "io/figure/figure_text.hpp"

#include <algorithm>
#include <cctype>

namespace sinew::inline v1 {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_latin(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Bytes of the character there.
std::size_t length_at(std::string_view text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  const std::size_t length = byte < 0x80 ? 1 : byte < 0xe0 ? 2 : byte < 0xf0 ? 3 : 4;
  return std::min(length, text.size() - at);
}

bool is_greek(std::string_view text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  return byte == 0xce || byte == 0xcf;
}

/// Whether a letter begins there.
bool is_letter(std::string_view text, std::size_t at) { return is_latin(text[at]) || is_greek(text, at); }

/// Where the run of letters and digits from there ends.
std::size_t word_end(std::string_view text, std::size_t at) {
  while (at < text.size() && (is_digit(text[at]) || is_letter(text, at))) at += length_at(text, at);
  return at;
}

/// Where the whole number from there ends; there, where none is.
std::size_t number_end(std::string_view text, std::size_t at) {
  std::size_t end = at;
  if (text.substr(end).starts_with("−"))
    end += 3;
  else if (end < text.size() && text[end] == '-')
    ++end;
  const std::size_t begin = end;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end > begin ? end : at;
}

/// A hyphen before a number is a minus.
std::string with_minus(std::string_view number) {
  return number.starts_with('-') ? "−" + std::string(number.substr(1)) : std::string(number);
}

}  // namespace

Text::Text(std::string_view literal, Style style) {
  if (!literal.empty()) parts_.push_back({std::string(literal), style});
}

Text& Text::operator+=(const Text& more) {
  const std::vector<Part> added = more.parts_;  // it may be this one
  for (const Part& part : added) {
    if (!parts_.empty() && parts_.back().style == part.style)
      parts_.back().text += part.text;
    else
      parts_.push_back(part);
  }
  return *this;
}

std::string Text::plain() const {
  std::string all;
  for (const Part& part : parts_) all += part.text;
  return all;
}

Text formula(std::string_view text) {
  Text result;
  for (std::size_t at = 0; at < text.size();) {
    const bool is_mark = text[at] == '_' || text[at] == '^';
    std::size_t end = at + length_at(text, at);
    if (is_mark) {
      const std::size_t last = text[at] == '_' ? word_end(text, at + 1) : number_end(text, at + 1);
      if (last > at + 1) {
        const std::string inside = with_minus(text.substr(at + 1, last - at - 1));
        result += Text(inside, text[at] == '_' ? Text::Style::subscript : Text::Style::superscript);
        at = last;
        continue;
      }
    } else if (is_digit(text[at]) || is_letter(text, at)) {
      const std::size_t first = end;
      end = word_end(text, at);
      const bool is_ending = at > 0 && text[at - 1] == '\'';  // of "paper's"
      if (end == first && is_letter(text, at) && !is_ending) {
        result += Text(text.substr(at, end - at), Text::Style::italic);
        at = end;
        continue;
      }
    }
    result += Text(text.substr(at, end - at));
    at = end;
  }
  return result;
}

Text unit_text(std::string_view unit) {
  Text result;
  for (std::size_t at = 0; at < unit.size();) {
    const bool is_inside = at > 0 && (is_latin(unit[at - 1]) || is_digit(unit[at - 1]));
    std::size_t end = at + length_at(unit, at);
    if (unit[at] == '^' && is_inside && number_end(unit, at + 1) > at + 1) {
      end = number_end(unit, at + 1);
      result += Text(with_minus(unit.substr(at + 1, end - at - 1)), Text::Style::superscript);
    } else if (is_latin(unit[at])) {
      end = word_end(unit, at);
      const std::string_view word = unit.substr(at, end - at);
      result += Text(word == "deg" ? "°" : word);
    } else {
      result += Text(unit.substr(at, end - at));
    }
    at = end;
  }
  return result;
}

Text with_unit(const Text& label, std::string_view unit) {
  if (unit.empty()) return label;
  return label + (label.empty() ? "(" : " (") + unit_text(unit) + ")";
}

}  // namespace sinew::inline v1
