#include "queries.hpp"

namespace sinew::server {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::size_t end_of_quotes(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at)
    if (text[at] == '\\') ++at;
  return at;
}

std::vector<std::string_view> elements_of(std::string_view inside, std::size_t most) {
  std::vector<std::string_view> elements;
  std::size_t begin = 0, depth = 0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const char c = inside[i];
    if (c == '"') i = end_of_quotes(inside, i);
    if (i >= inside.size()) return {};
    if (c == '{' || c == '[') ++depth;
    if ((c == '}' || c == ']') && depth-- == 0) return {};
    if (c == ',' && depth == 0) {
      elements.push_back(trimmed(inside.substr(begin, i - begin)));
      begin = i + 1;
      if (elements.size() > most) return elements;
    }
  }
  if (depth != 0) return {};
  const std::string_view last = trimmed(inside.substr(begin));
  if (!last.empty() || !elements.empty()) elements.push_back(last);
  return elements;
}

std::vector<std::string_view> queries_of(std::string_view body, std::size_t most) {
  body = trimmed(body);
  if (body.starts_with('{')) return {body};
  if (!body.starts_with('[') || !body.ends_with(']') || body.size() < 2) return {};
  return elements_of(body.substr(1, body.size() - 2), most);
}

}  // namespace sinew::server
