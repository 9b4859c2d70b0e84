/// @file node.hpp
/// What a YAML file or a JSON query says, as one plain tree: kinds, texts as written, and places for
/// messages. The tree knows nothing of robots; it is read through io/reader.hpp.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

struct Member;

/// One value of a document. Only the fields of its kind mean something.
struct Node {
  /// What a value is.
  enum class Kind { null, boolean, number, string, list, map };

  Kind kind = Kind::null;
  bool boolean = false;
  double number = 0;            ///< of a number, as written, without unit
  std::string text;             ///< a scalar as it was written (without its quotes)
  std::vector<Node> items;      ///< of a list
  std::vector<Member> members;  ///< of a map, in the order of the file
  int line = 0;                 ///< from 1; 0 where unknown: in JSON, and after `set`
  int column = 0;               ///< from 1, in bytes; 0 where unknown

  /// The value under `key`, or null (also where this is no map).
  SINEW_API const Node* find(std::string_view key) const;
  SINEW_API Node* find(std::string_view key);
};

/// A key of a map and its value.
struct Member {
  std::string key;
  int line = 0;  ///< of the key
  int column = 0;
  Node value;
};

/// A tree and where it came from.
struct Document {
  std::string source;  ///< file name, or what the text is called in messages
  Node root;
};

/// @name Making nodes without a place
/// @{

/// A scalar: true or false, a number in SI, or text such as `180 mm`.
SINEW_API Node make_node(bool value);
SINEW_API Node make_node(double value);
SINEW_API Node make_node(std::string_view text);
inline Node make_node(const char* text) {
  return make_node(std::string_view(text));
}  // else it would be a bool
/// @}

/// The node at a path like `legs[0].link.length`; null if there is none. The empty path is `root` itself.
SINEW_API const Node* at(const Node& root, std::string_view path);
SINEW_API Node* at(Node& root, std::string_view path);

/// `path.key`, or `key` at the root.
SINEW_API std::string joined(std::string_view path, std::string_view key);
/// `path[index]`.
SINEW_API std::string joined(std::string_view path, std::size_t index);

/// `file.yaml:14:11`; the source alone where the line is unknown.
SINEW_API std::string place(const Document& document, int line, int column);
inline std::string place(const Document& document, const Node& node) {
  return place(document, node.line, node.column);
}

/// The path of the node under `root` that stands at the place of `node`. A node that `merged` took from the
/// defaults is so found under its own name, `defaults.link.length`. Empty optional: the place is unknown.
SINEW_API std::optional<std::string> path_of(const Node& root, const Node& node);

/// `own` over `defaults`: maps are merged key by key, anything else of `own` replaces. Every node keeps its
/// place. An explicit null of `own` also wins: so a file takes a default away.
SINEW_API Node merged(const Node& defaults, const Node& own);

/// Puts `value` at `path`. All of the path must exist, only the last key of a map may be new
/// (`unknown_path`).
SINEW_API Expected<void> set(Node& root, std::string_view path, Node value);

/// `a list`, `a map`, `text`, ...: for messages.
SINEW_API std::string_view noun(Node::Kind kind);

/// On one line, cut to about `limit` bytes but not within a character: for messages.
SINEW_API std::string one_line(std::string_view text, std::size_t limit);
/// In double quotes, on one line, at most 60 bytes: for messages.
SINEW_API std::string in_quotes(std::string_view text);

/// The candidate that `word` may be a slip of (a few letters wrong, doubled, missing or swapped); else empty.
SINEW_API std::string_view closest(std::string_view word, std::span<const std::string_view> candidates);

/// Builds a tree from the events of a parser, with the limits that keep a hostile document harmless.
/// Every function answers whether to go on; what was wrong is in `errors`.
class NodeBuilder {
 public:
  static constexpr std::size_t depth_limit = 64;      ///< most lists and maps within each other
  static constexpr std::size_t node_limit = 200'000;  ///< most nodes of a document

  /// @param source what errors call the text
  explicit NodeBuilder(std::string source) { document_.source = std::move(source); }

  /// A list or a map begins, at its place in the text.
  SINEW_API bool open(Node::Kind list_or_map, int line = 0, int column = 0);
  /// The innermost list or map ends.
  SINEW_API bool close();
  /// A key of the innermost map, whose value comes next. Codes: `duplicate_key`.
  SINEW_API bool key(std::string_view key, int line = 0, int column = 0);
  /// A value that is neither list nor map.
  SINEW_API bool scalar(Node&& node);
  /// Notes an error at a place; always false.
  SINEW_API bool stop(std::string_view code, int line, int column, std::string_view message);

  /// Inside a map, before a key.
  bool wants_key() const {
    return !open_.empty() && open_.back().node->kind == Node::Kind::map && !open_.back().has_key;
  }
  /// Place of the key whose value comes next; {0, 0} outside a map.
  std::pair<int, int> key_place() const;
  /// What was wrong so far.
  const Errors& errors() const { return errors_; }
  /// The document, or everything that was wrong. The builder is empty afterwards.
  SINEW_API Expected<Document> finish();

 private:
  /// A list or map that is open, where it stands in the document: what holds it does not move until it is
  /// closed.
  struct Level {
    Node* node;
    bool has_key = false;  // the last member's value is to come
    std::unique_ptr<std::unordered_map<std::string, int>> lines =
        {};  // of the first `indexed`, of many members
    std::size_t indexed = 0;

    std::optional<int> line_of(std::string_view key);  // where the key was given before, if it was
  };
  bool count(int line, int column);
  Node& slot();  // where the next value goes
  std::string path() const;

  std::vector<Level> open_;
  Document document_;
  Errors errors_;
  std::size_t nodes_ = 0;
};

}  // namespace sinew::inline v1
