#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <istream>
#include <streambuf>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::string_view unclosed_quote = "a quote is opened and never closed.";

/// Thrown through yaml-cpp to end it early; the reason is in the builder.
struct Stop {};

/// Events of yaml-cpp into the builder; its marks count from 0.
class YamlEvents : public YAML::EventHandler {
 public:
  YamlEvents(NodeBuilder& builder, std::string_view text) : builder_(builder), text_(text) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ == 0) return;
    refuse(mark,
           "the one document has ended, but the file goes on here; look for a stray \"---\", quote or "
           "bracket, or "
           "for a wrong indentation.");
  }
  void OnDocumentEnd() override {}
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "aliases (*name) are not read here; write the value out.");
  }
  void OnAnchor(const YAML::Mark& mark, const std::string&) override {
    refuse(mark, "anchors (&name) are not read here; write the value out where it is used.");
  }
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    if (builder_.wants_key()) refuse(mark, "a key is empty; write key: value.");
    Node node = placed(mark);
    // an omitted value is marked at whatever follows it, perhaps lines below
    if (const auto [line, column] = builder_.key_place(); line > 0 && node.line != line) {
      node.line = line;
      node.column = column;
    }
    go(builder_.scalar(std::move(node)));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    check(mark, tag);
    check_quotes(mark);
    if (builder_.wants_key()) return go(builder_.key(value, mark.line + 1, mark.column + 1));
    Node node = tag == "?" ? plain_scalar(value) : make_node(std::string_view(value));  // "!": quotes
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    go(builder_.scalar(std::move(node)));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, Node::Kind::list);
  }
  void OnSequenceEnd() override { go(builder_.close()); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, Node::Kind::map);
  }
  void OnMapEnd() override { go(builder_.close()); }

 private:
  static void go(bool on) {
    if (!on) throw Stop{};
  }
  static Node placed(const YAML::Mark& mark) {
    Node node;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }
  void refuse(const YAML::Mark& mark, std::string_view message) {
    go(builder_.stop("yaml_unsupported", mark.line + 1, mark.column + 1, message));
  }
  void check(const YAML::Mark& mark, const std::string& tag) {
    const bool is_untagged =
        tag.empty() || tag == "?" || (tag == "!" && at(mark) != '!');  // "!": in quotes, or | or >
    if (!is_untagged)
      refuse(mark, fmt::format("tags ({}) are not read here; write the plain value.", in_quotes(tag)));
  }
  /// yaml-cpp 0.7 takes a quote that nobody closes for text to the end of the file.
  void check_quotes(const YAML::Mark& mark) {
    const char quote = at(mark);
    if (quote != '"' && quote != '\'') return;
    std::size_t i = static_cast<std::size_t>(mark.pos) + 1;
    const auto is_escape = [&] { return quote == '"' ? text_[i] == '\\' : text_.substr(i, 2) == "''"; };
    while (i < text_.size() && (is_escape() || text_[i] != quote)) i += is_escape() ? 2U : 1U;
    if (i >= text_.size()) go(builder_.stop("yaml_syntax", mark.line + 1, mark.column + 1, unclosed_quote));
  }
  /// What stands at a mark (yaml-cpp counts bytes).
  char at(const YAML::Mark& mark) const {
    const auto byte = static_cast<std::size_t>(mark.pos);
    return byte < text_.size() ? text_[byte] : '\0';
  }
  void open(const YAML::Mark& mark, const std::string& tag, Node::Kind kind) {
    check(mark, tag);
    if (builder_.wants_key())
      refuse(mark, fmt::format("{} stands where a key must be; is a bracket not closed?", noun(kind)));
    go(builder_.open(kind, mark.line + 1, mark.column + 1));
  }

  NodeBuilder& builder_;
  std::string_view text_;
  int documents_ = 0;
};

bool is_indented_by_tab(std::string_view text, int line) {
  for (; line > 0; --line) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return false;
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find_first_not_of(" \t")).find('\t') != std::string_view::npos;
}

/// What yaml-cpp says, and what it means for the one who wrote the file.
std::string explained(const YAML::Exception& error, std::string_view text) {
  if (is_indented_by_tab(text, error.mark.line)) return "a tab indents this line; indent with spaces.";
  struct Hint {
    std::string_view contains;
    std::string_view words;
  };
  static constexpr std::array hints{
      Hint{"illegal map value",
           "a \":\" where no value can be; put text that holds \": \" in quotes, and check the indentation."},
      Hint{"end of map flow not found", "a \"{\" is not closed by \"}\", or a comma is missing."},
      Hint{"end of sequence flow not found", "a \"[\" is not closed by \"]\", or a comma is missing."},
      Hint{"illegal flow end", "a closing \"]\" or \"}\" without its opening one."},
      Hint{"end of map not found",
           "this line does not fit the map above it; check its indentation and its \":\"."},
      Hint{"end of sequence not found",
           "this line does not fit the list above it; check its indentation and its \"-\"."},
      Hint{"illegal EOF in scalar", unclosed_quote},
      Hint{"illegal document indicator in scalar", unclosed_quote},
      Hint{"illegal block entry", "a \"- \" where no list item can be; check the indentation."},
      Hint{"illegal map key", "a \"? \" where no key can be; put the text in quotes."},
      Hint{"unknown token",
           "a character that cannot start a value (such as @, %, ` or a tab); put the text in quotes."},
      Hint{"unknown escape character",
           "a \"\\\" in double quotes starts an escape; double it or use single quotes."},
  };
  for (const Hint& hint : hints)
    if (error.msg.find(hint.contains) != std::string::npos) return std::string(hint.words);
  return fmt::format("this is not YAML: {}.", error.msg);
}

/// Reads memory where it lies; YAML::Parser wants a stream.
struct View : std::streambuf {
  explicit View(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // streambuf has no const get area; nothing writes
    setg(begin, begin, begin + text.size());
  }
};

/// Where more brackets are open than any document has levels, in whatever they stand; past the end if
/// nowhere. yaml-cpp keeps a line of them, 250 bytes each, before it tells of the first.
std::size_t too_many_open(std::string_view text) {
  constexpr std::size_t most = 10'000;
  std::size_t open = 0, at = 0;
  for (; at < text.size() && open < most; ++at) {
    if (text[at] == '[' || text[at] == '{') ++open;
    if ((text[at] == ']' || text[at] == '}') && open > 0) --open;
  }
  return open < most ? text.size() : at;
}

void parse_into(NodeBuilder& builder, std::string_view text) {
  View view(text);
  std::istream stream(&view);
  YamlEvents handler(builder, text);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(handler)) {
    }
  } catch (const Stop&) {
  } catch (const YAML::Exception& error) {
    const bool is_placed = !error.mark.is_null();
    builder.stop("yaml_syntax", is_placed ? error.mark.line + 1 : 1, is_placed ? error.mark.column + 1 : 1,
                 explained(error, text));
  }
}

std::size_t utf8_step(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
  const unsigned first = byte(0);
  if (first < 0x20)
    return first == '\t' || first == '\n' || first == '\r' ? 1 : 0;  // 4 would end a file for yaml-cpp
  if (first < 0x80) return 1;
  if (first < 0xC2) return 0;  // a follower, or overlong
  if (first < 0xE0) return follows(1) ? 2 : 0;
  if (first < 0xF0) {
    const bool is_bad =
        (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F);  // overlong, surrogate
    return follows(1) && follows(2) && !is_bad ? 3 : 0;
  }
  const bool is_bad = (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F) || first > 0xF4;
  return follows(1) && follows(2) && follows(3) && !is_bad ? 4 : 0;
}

}  // namespace

Node plain_scalar(std::string_view text) {
  if (text.empty() || text == "~" || text == "null") return {};
  if (text == "true" || text == "false") return make_node(text == "true");
  Node node = make_node(text);
  if (const auto number = parse_number(text)) {
    node.kind = Node::Kind::number;
    node.number = *number;
  }
  return node;
}

std::size_t utf8_size(std::string_view text) {
  std::size_t size = 0;
  while (size < text.size()) {
    const std::size_t step = utf8_step(text.substr(size));
    if (step == 0) break;
    size += step;
  }
  return size;
}

Position position_of(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte);
  const auto lines = std::ranges::count(before, '\n');
  const std::size_t start = before.rfind('\n');  // npos + 1 is 0
  return {static_cast<int>(lines) + 1, static_cast<int>(before.size() - (start + 1)) + 1};
}

Expected<Document> parse_yaml(std::string_view text, std::string source) {
  NodeBuilder builder(source);
  if (text.size() > document_size_limit) {
    builder.stop("too_large", 0, 0, fmt::format("larger than {} MiB.", document_size_limit >> 20));
  } else if (const std::size_t good = utf8_size(text); good < text.size()) {
    const auto [line, column] = position_of(text, good);
    builder.stop("not_utf8", line, column,
                 "this is not plain text; save the file as UTF-8, without control characters.");
  } else if (const std::size_t deep = too_many_open(text); deep < text.size()) {
    const auto [line, column] = position_of(text, deep);
    builder.stop("too_deep", line, column,
                 fmt::format("more than {} levels of lists and maps.", NodeBuilder::depth_limit));
  } else {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // some editors write it; it is no column
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    parse_into(builder, text);
  }
  Expected<Document> document = builder.finish();
  if (document && document->root.kind == Node::Kind::null)
    return failure("empty_document", source, "there is nothing in it.");
  return document;
}

Expected<std::string> read_text(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    return failure("file_missing", path, "there is no such file; check the path.");
  if (fs::is_directory(status)) return failure("file_unreadable", path, "this is a folder; give a file.");
  if (!fs::is_regular_file(status))
    return failure("file_unreadable", path, "this is not a file that can be read.");
  std::ifstream stream(path, std::ios::binary);
  std::string text(document_size_limit + 1, '\0');  // one more than allowed tells that there is more
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream && !stream.eof())
    return failure("file_unreadable", path, "the file cannot be read; check its permissions.");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

Expected<Document> read_file(const std::string& path) {
  const auto text = read_text(path);
  return text ? parse_yaml(*text, path) : tl::unexpected(text.error());
}

}  // namespace sinew::inline v1
