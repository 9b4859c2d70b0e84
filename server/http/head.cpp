#include "head.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace sinew::server {
namespace {

using Refused = tl::unexpected<Reply>;

Refused bad(std::string_view where, std::string_view message) {
  return Refused(refused(400, "bad_request", where, message));
}

bool is_name(char c) {
  constexpr std::string_view others = "!#$%&'*+-.^_`|~";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         others.find(c) != std::string_view::npos;
}

bool is_control(char c) { return (c >= '\0' && c < ' ' && c != '\t') || c == '\x7f'; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is(std::string_view name, std::string_view known) { return std::ranges::equal(name, known, {}, lower); }

tl::expected<void, Reply> check_first(std::string_view line) {
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return bad("request", "write METHOD /PATH HTTP/1.1");
  const std::string_view method = line.substr(0, first), path = line.substr(first + 1, last - first - 1),
                         version = line.substr(last + 1);
  const bool is_plain = std::ranges::all_of(path, [](char c) { return c > ' ' && c < '\x7f'; });
  if (method.empty() || !std::ranges::all_of(method, is_name) || !path.starts_with('/') || !is_plain)
    return bad("request", "write METHOD /PATH HTTP/1.1, the path without blanks");
  if (version != "HTTP/1.1" && version != "HTTP/1.0")
    return Refused(refused(505, "not_available", "request", "HTTP/1.1 is spoken here"));
  return {};
}

/// Headers on which something hangs: they come once.
constexpr std::array single{"host",           "origin",       "cookie",         "authorization",
                            "content-length", "content-type", "expect",         "content-encoding",
                            "connection",     "range",        "accept-encoding"};

class Lines {
 public:
  tl::expected<void, Reply> add(std::string_view line) {
    const std::size_t colon = line.find(':');
    const std::string_view name = line.substr(0, colon);
    if (colon == std::string_view::npos || name.empty() || !std::ranges::all_of(name, is_name))
      return bad("header", "write a header as NAME: VALUE, on one line");
    std::string_view value = line.substr(colon + 1);
    while (!value.empty() && (value.front() == ' ' || value.front() == '\t')) value.remove_prefix(1);
    while (!value.empty() && (value.back() == ' ' || value.back() == '\t')) value.remove_suffix(1);
    for (std::size_t i = 0; i < single.size(); ++i)
      if (is(name, single[i]) && std::exchange(seen_[i], true))
        return bad(single[i], "give this header once");
    if (is(name, "transfer-encoding"))
      return Refused(refused(411, "length_required", "Transfer-Encoding",
                             "give the body at once, with its Content-Length"));
    if (is(name, "range")) head.range = line;
    return is(name, "content-length") ? read_length(value) : tl::expected<void, Reply>();
  }

  Head head;

 private:
  tl::expected<void, Reply> read_length(std::string_view value) {
    const char* end = value.data() + value.size();
    const bool is_number = !value.empty() && value.front() >= '0' && value.front() <= '9';  // no sign
    const auto read = std::from_chars(value.data(), end, head.body);
    if (is_number && read.ec == std::errc() && read.ptr == end) return {};
    return bad("Content-Length", "give the number of bytes of the body");
  }

  std::array<bool, single.size()> seen_{};
};

}  // namespace

tl::expected<Head, Reply> read_head(std::string_view text) {
  Lines lines;
  bool is_first = true;
  for (std::size_t end; (end = text.find("\r\n")) != std::string_view::npos; text.remove_prefix(end + 2)) {
    const std::string_view line = text.substr(0, end);
    if (std::ranges::any_of(line, is_control)) return bad("header", "it has a control character");
    if (line.empty() && !is_first) return lines.head;
    const auto read = std::exchange(is_first, false) ? check_first(line) : lines.add(line);
    if (!read) return tl::unexpected(read.error());
  }
  return bad("header", "the empty line after it is missing");
}

}  // namespace sinew::server
