#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/document/parse.hpp"
#include "io/document/plain_json.hpp"
#include "io/document/quantity.hpp"

namespace sinew::inline v1 {
namespace {

/// Events of nlohmann's parser into the builder. It calls every function by name; false ends it.
class JsonEvents {
 public:
  JsonEvents(NodeBuilder& builder, std::string_view text) : builder_(builder), text_(text) {}

  bool null() { return builder_.scalar({}); }
  bool boolean(bool value) { return builder_.scalar(make_node(value)); }
  bool number_integer(std::int64_t value) {
    return number(static_cast<double>(value), std::to_string(value));
  }
  bool number_unsigned(std::uint64_t value) {
    return number(static_cast<double>(value), std::to_string(value));
  }
  bool number_float(double value, const std::string& written) { return number(value, written); }
  bool string(const std::string& value) { return builder_.scalar(make_node(std::string_view(value))); }
  bool binary(const nlohmann::json::binary_t&) { return false; }  // of binary formats only
  bool start_object(std::size_t) { return builder_.open(Node::Kind::map); }
  bool end_object() { return builder_.close(); }
  bool start_array(std::size_t) { return builder_.open(Node::Kind::list); }
  bool end_array() { return builder_.close(); }
  bool key(const std::string& key) { return builder_.key(key); }

  bool parse_error(std::size_t byte, const std::string& last, const nlohmann::json::exception& error) {
    constexpr int number_overflow = 406;  // https://json.nlohmann.me/home/exceptions
    if (error.id == number_overflow)
      return builder_.stop("not_a_number", 0, 0, fmt::format("{} is too large for a number.", last));
    const auto [line, column] = position_of(text_, byte == 0 ? 0 : byte - 1);  // `byte` counts the bytes read
    return builder_.stop(
        "json_syntax", 0, 0,
        fmt::format("this is not JSON, at line {}, column {}: {}.", line, column, reason(error.what())));
  }

 private:
  bool number(double value, std::string written) {
    Node node;
    node.kind = Node::Kind::number;
    node.number = value;
    node.text = std::move(written);
    return builder_.scalar(std::move(node));
  }
  /// Of "[json.exception...] parse error at ...: syntax error while parsing ... - REASON; last read: ..." the
  /// reason.
  static std::string reason(std::string_view what) {
    const std::size_t begin = what.find(" - ");
    if (begin == std::string_view::npos) return "it cannot be read";
    std::string_view result = what.substr(begin + 3);
    std::string rest;
    if (const std::size_t last = result.find("; last read: "); last != std::string_view::npos) {
      const std::size_t end = result.rfind("'; expected ");
      if (end != std::string_view::npos && end > last) rest = result.substr(end + 1);
      result = result.substr(0, last);
    }
    return std::string(result) + rest;
  }

  NodeBuilder& builder_;
  std::string_view text_;
};

}  // namespace

Expected<Document> parse_json(std::string_view text, std::string source) {
  if (text.size() <= document_size_limit) {
    NodeBuilder plain(source);
    if (PlainJson(text, plain).read()) return plain.finish();
  }
  NodeBuilder builder(std::move(source));
  if (text.size() > document_size_limit) {
    builder.stop("too_large", 0, 0, fmt::format("larger than {} MiB.", document_size_limit >> 20));
  } else if (const std::size_t good = utf8_size(text); good < text.size()) {
    const auto [line, column] = position_of(text, good);
    builder.stop("not_utf8", 0, 0,
                 fmt::format("this is not plain UTF-8 text, at line {}, column {}.", line, column));
  } else {
    JsonEvents handler(builder, text);
    nlohmann::json::sax_parse(text.begin(), text.end(), &handler);
  }
  return builder.finish();
}

}  // namespace sinew::inline v1
