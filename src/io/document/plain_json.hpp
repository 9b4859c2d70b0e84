/// @file plain_json.hpp
/// JSON as programs write it, read in one pass: most questions are. What is odd in any way (escapes, text
/// beyond ASCII, numbers of many digits, slips) is left to the parser that has messages for it.
#pragma once
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include "sinew/io/node.hpp"

namespace sinew::inline v1 {

/// Reads a text into a builder, node for node as parse_json does.
class PlainJson {
 public:
  PlainJson(std::string_view text, NodeBuilder& builder)
      : at_(text.data()),
        end_(text.data() + text.size()),
        builder_(builder) {}

  /// Whether the whole text was plain. Where it was not, the builder holds what came before.
  bool read() {
    if (!value()) return false;
    skip();
    return at_ == end_;
  }

 private:
  void skip() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r')) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }
  bool take_word(std::string_view word) {
    if (!std::string_view(at_, static_cast<std::size_t>(end_ - at_)).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  bool value() {
    skip();
    if (at_ == end_) return false;
    switch (*at_) {
      case '{':
        return map();
      case '[':
        return list();
      case '"': {
        std::string_view read;
        return text(read) && builder_.scalar(make_node(read));
      }
      case 't':
        return take_word("true") && builder_.scalar(make_node(true));
      case 'f':
        return take_word("false") && builder_.scalar(make_node(false));
      case 'n':
        return take_word("null") && builder_.scalar({});
      default:
        return number();
    }
  }

  bool map() {  // no deeper than the builder allows
    ++at_;
    if (!builder_.open(Node::Kind::map)) return false;
    if (take('}')) return builder_.close();
    do {
      std::string_view key;
      skip();
      if (!text(key) || !builder_.key(key) || !take(':') || !value()) return false;
    } while (take(','));
    return take('}') && builder_.close();
  }

  bool list() {
    ++at_;
    if (!builder_.open(Node::Kind::list)) return false;
    if (take(']')) return builder_.close();
    do
      if (!value()) return false;
    while (take(','));
    return take(']') && builder_.close();
  }

  /// Between quotes, without escapes and of printable ASCII.
  bool text(std::string_view& read) {
    if (at_ == end_ || *at_ != '"') return false;
    const char* begin = ++at_;
    while (at_ != end_ && *at_ >= 0x20 && *at_ < 0x7f && *at_ != '"' && *at_ != '\\') ++at_;
    if (at_ == end_ || *at_ != '"') return false;
    read = {begin, static_cast<std::size_t>(at_ - begin)};
    ++at_;
    return true;
  }

  /// @param value the digits so far, which these go on
  /// @return how many these are
  std::size_t digits(std::uint64_t& value) {
    const char* begin = at_;
    while (at_ != end_ && *at_ >= '0' && *at_ <= '9')
      value = 10 * value + static_cast<unsigned>(*at_++ - '0');
    return static_cast<std::size_t>(at_ - begin);
  }

  /// Whole numbers of up to 15 digits, which a double holds; others where they are no overflow.
  bool number() {
    const char* begin = at_;
    const bool is_negative = *at_ == '-';
    if (is_negative) ++at_;
    const char* first = at_;
    std::uint64_t all = 0, exponent = 0;
    const std::size_t before = digits(all);
    std::size_t after = 0;
    if (before == 0 || (before > 1 && *first == '0')) return false;
    bool is_whole = true, has_exponent = false;
    if (at_ != end_ && *at_ == '.') {
      ++at_;
      is_whole = false;
      if ((after = digits(all)) == 0) return false;
    }
    if (at_ != end_ && (*at_ == 'e' || *at_ == 'E')) {
      ++at_;
      is_whole = false;
      has_exponent = true;
      if (at_ != end_ && (*at_ == '+' || *at_ == '-')) ++at_;
      if (digits(exponent) == 0) return false;
    }
    if (is_whole && (before > most_digits || (is_negative && *first == '0'))) return false;
    Node node;
    node.kind = Node::Kind::number;
    if (before + after <= most_digits && !has_exponent) {
      // both are held by a double, so that their quotient is rounded once: it is the nearest
      node.number = static_cast<double>(all) / powers_of_ten[after];
      if (is_negative) node.number = -node.number;
    } else {
      const auto [stop, error] = std::from_chars(begin, at_, node.number);
      if (error != std::errc() || stop != at_) return false;
    }
    node.text.assign(begin, at_);
    return builder_.scalar(std::move(node));
  }

  static constexpr std::size_t most_digits = 15;  ///< that a double holds, whatever they are
  static constexpr std::array<double, most_digits + 1> powers_of_ten = {
      1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

  const char *at_, *end_;
  NodeBuilder& builder_;
};

}  // namespace sinew::inline v1
