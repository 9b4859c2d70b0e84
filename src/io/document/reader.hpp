/// @file reader.hpp
/// The one typed reader of robot files, study files and queries: a place in a document. It does not stop at
/// what is wrong: it notes the error, goes on with a harmless value, and in the end the sink holds all errors
/// of the input, in the order of the file. A caller looks at the sink once, before it uses what was read.
///
///     Errors errors;
///     Reader robot(document, errors);
///     Reader link = robot.required("link");
///     const double length = link.required("length").quantity(Dimension::length, Range::positive());
///     const std::string type = link.required("type").choice({"arc", "rod"});
///     link.close();  // any other key is a slip
///     if (!errors.empty()) return tl::unexpected(errors);
#pragma once
#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/units.hpp"

namespace sinew::inline v1 {

/// Document, sink and nodes must outlive the reader. It moves, but is not copied: it remembers which keys
/// were asked.
class Reader {
 public:
  /// Errors beyond this many are not collected; the last one says so.
  static constexpr std::size_t error_limit = 100;

  /// At the root of a document.
  Reader(const Document& document, Errors& sink) : Reader(&document, &sink, &document.root, "") {}
  Reader(Document&& document, Errors& sink) = delete;
  Reader(Reader&&) noexcept = default;
  Reader& operator=(Reader&&) noexcept = default;

  /// The same place with another node, such as `merged(defaults, own)`.
  Reader over(const Node& node) const { return {document_, sink_, &node, path_}; }
  Reader over(Node&& node) const = delete;

  /// @name Where it stands
  /// @{
  const std::string& path() const { return path_; }  ///< `legs[0].link`
  std::string place() const;  ///< `file.yaml:14:11`; the path where the line is unknown
  /// The node; null where a required key is missing: every read then answers its fallback and stays silent.
  const Node* node() const { return node_; }
  /// Whether it is of this kind.
  bool is(Node::Kind kind) const { return node_ && node_->kind == kind; }
  /// @}

  /// @name Down into a map or a list
  /// Keys are literals, or outlive the reader: it remembers them.
  /// @{

  /// The value of a key; `missing_key` if there is none. `meaning` says what it would be: `backbone length`.
  Reader required(std::string_view key, std::string_view meaning = {});
  /// The value of a key, if there is one that is not null.
  std::optional<Reader> optional(std::string_view key);
  /// Whether the key is there and not null; asking makes the key a known one.
  bool has(std::string_view key);
  std::vector<std::pair<std::string, Reader>> members()
      const;  ///< of a map with free keys; it needs no `close`
  /// The entries of a list, none of what is no list. `wrong_length` where they are not as many as `size`
  /// says.
  std::vector<Reader> items(std::optional<std::size_t> size = {}) const;
  /// Notes every key nobody asked for as `unknown_key`. Call it when the map is read.
  void close();
  /// @}

  /// @name Values
  /// @{

  /// A number in SI: a bare one is taken for SI, a text has a unit, whose dimension is checked
  /// (`wrong_dimension`, `out_of_range`, ...).
  double quantity(Dimension dimension, Range range = {}) const;
  /// A number without unit.
  double number(Range range = {}) const { return quantity(Dimension::number, range); }
  int integer(Range range = {}) const;  ///< a whole number
  std::string text() const;             ///< a text
  bool boolean() const;                 ///< true or false
  /// One of the words; the first of them after an error.
  std::string choice(std::initializer_list<std::string_view> words) const {
    return std::string(words.begin()[choice_index({words.begin(), words.size()})]);
  }
  /// The index of the word that is there; 0 after an error.
  std::size_t choice_index(std::span<const std::string_view> words) const;
  /// One of `{{"arc", Law::arc}, {"rod", Law::rod}}`.
  template <class T>
  T choice_of(std::initializer_list<std::pair<std::string_view, T>> words) const {
    std::vector<std::string_view> names;
    for (const auto& word : words) names.push_back(word.first);
    return words.begin()[choice_index(names)].second;
  }
  /// A list of quantities in SI; it has the asked size also after an error.
  std::vector<double> quantities(Dimension dimension, Range range = {},
                                 std::optional<std::size_t> size = {}) const;
  /// The same, in SI, of a size that is known when it is compiled.
  template <std::size_t size>
  std::array<double, size> array(Dimension dimension, Range range = {}) const {
    std::array<double, size> result{};
    const std::vector<double> values = quantities(dimension, range, size);
    for (std::size_t i = 0; i < size; ++i) result[i] = values[i];
    return result;
  }
  /// @}

  /// @name What only the caller can see
  /// @{

  /// Notes `path: message`.
  void fail(std::string_view code, std::string_view message) const;
  /// Notes `path = value as written; rule`.
  void refuse(std::string_view code, std::string_view rule) const;
  /// @}

 private:
  Reader(const Document* document, Errors* sink, const Node* node, std::string path)
      : document_(document),
        sink_(sink),
        node_(node),
        path_(std::move(path)) {}
  bool is_full() const { return sink_->size() > error_limit; }
  std::optional<double> value(Dimension dimension, const Range& range) const;
  bool expect(Node::Kind kind, std::string_view advice) const;
  void expect_size(std::size_t size) const;
  void know(std::string_view key);
  const Node* given(std::string_view key);  // null where it is not, or null
  void unsuitable(std::string_view advice) const;
  void unknown(const Member& member) const;
  std::string name(const Node& node, const std::string& path) const;
  std::string root_name() const;
  std::string where(int line, int column, const std::string& path) const;
  void report(std::string_view code, std::string where, std::string message) const;

  const Document* document_;
  Errors* sink_;
  const Node* node_;
  std::string path_;
  std::vector<std::string_view> known_;  // keys asked for
};

/// Fills the fields of a parameter struct that names them once:
///
///     template <class Self, class Visit> static void fields(Self& self, Visit&& visit) {
///       visit("length", self.length, Dimension::length, Range::positive(), "backbone length");
///     }
///     Arc::fields(arc, FieldReader(reader));
///
/// A plain field is required, a `std::optional` one may be absent (it then keeps what it holds).
class FieldReader {
 public:
  /// Of the fields of this map.
  explicit FieldReader(Reader& map) : map_(&map) {}

  void operator()(std::string_view key, double& field, Dimension dimension, Range range = {},
                  std::string_view meaning = {}) const {
    field = map_->required(key, meaning).quantity(dimension, range);
  }
  void operator()(std::string_view key, std::optional<double>& field, Dimension dimension, Range range = {},
                  std::string_view = {}) const {
    if (const auto value = map_->optional(key)) field = value->quantity(dimension, range);
  }
  void operator()(std::string_view key, int& field, Dimension = Dimension::count, Range range = {},
                  std::string_view meaning = {}) const {
    field = map_->required(key, meaning).integer(range);
  }
  void operator()(std::string_view key, std::optional<int>& field, Dimension = Dimension::count,
                  Range range = {}, std::string_view = {}) const {
    if (const auto value = map_->optional(key)) field = value->integer(range);
  }

 private:
  Reader* map_;
};

}  // namespace sinew::inline v1
