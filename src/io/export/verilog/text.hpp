/// @file text.hpp
/// Text with <words>, and numbers as Verilog writes them.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace sinew::inline v1::verilog {

using Words = std::map<std::string, std::string, std::less<>>;

/// Every <word> replaced, those of inserted text, too. What is no word stays: `<=`, `a < b`.
inline std::string filled(std::string_view text, const Words& words) {
  std::string result;
  while (!text.empty()) {
    const std::size_t open = text.find('<'), close = text.find('>', open);
    const auto word = close == text.npos ? words.end() : words.find(text.substr(open + 1, close - open - 1));
    if (word == words.end()) {
      const std::size_t end = open == text.npos ? text.size() : open + 1;
      result += text.substr(0, end);
      text.remove_prefix(end);
    } else {
      result += text.substr(0, open);
      result += filled(word->second, words);
      text.remove_prefix(close + 1);
    }
  }
  return result;
}

inline Words words_of(std::initializer_list<std::pair<const char*, int>> numbers) {
  Words words;
  for (const auto& [word, number] : numbers) words[word] = fmt::format("{}", number);
  return words;
}

inline std::string signed_text(std::int64_t value) {
  return fmt::format("{}16'sd{}", value < 0 ? "-" : "", value < 0 ? -value : value);
}

}  // namespace sinew::inline v1::verilog
