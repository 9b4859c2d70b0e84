#include "io/document/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "io/document/quantity.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What a value outside the range must do: `it must be positive`.
std::string rule(const Range& range, Dimension dimension, double value) {
  if (std::isnan(value)) return "it must be a number";
  // a bound far away is the lesser news
  if (range.low > 0 && value <= 0) return "it must be positive";
  if (range.low == 0 && value < 0)
    return range.low_excluded ? "it must be positive" : "it must not be negative";
  const auto low = [&] { return human(range.low, dimension); };
  const auto high = [&] { return human(range.high, dimension); };
  if (range.high == infinity) {
    if (range.low == 0) return range.low_excluded ? "it must be positive" : "it must not be negative";
    return fmt::format("it must be {} {}", range.low_excluded ? "more than" : "at least", low());
  }
  if (range.low == -infinity)
    return fmt::format("it must be {} {}", range.high_excluded ? "less than" : "at most", high());
  if (!range.low_excluded && !range.high_excluded)
    return fmt::format("it must be from {} to {}", low(), high());
  return fmt::format("it must be {} {} and {} {}", range.low_excluded ? "more than" : "at least", low(),
                     range.high_excluded ? "less than" : "at most", high());
}

/// A value of the range with which reading can go on.
double harmless(const Range& range) {
  for (double value : {1.0, 0.0, range.low, range.high, (range.low + range.high) / 2})
    if (std::isfinite(value) && range.contains(value)) return value;
  for (double value : {std::nextafter(range.low, infinity), std::nextafter(range.high, -infinity)})
    if (range.contains(value)) return value;
  return 1;
}

int harmless_integer(const Range& range) {
  const double value = harmless(range);
  const double whole = range.contains(std::floor(value)) ? std::floor(value) : std::ceil(value);
  return static_cast<int>(std::clamp(whole, -1e9, 1e9));
}

/// Line and column of a `where` of this source; {0, 0} if it has none.
std::pair<int, int> position(std::string_view where, std::string_view source) {
  std::pair<int, int> result{0, 0};
  if (!where.starts_with(source)) return result;
  where.remove_prefix(source.size());
  if (!where.starts_with(':')) return result;
  const char* end = where.data() + where.size();
  const auto line = std::from_chars(where.data() + 1, end, result.first);
  if (line.ec != std::errc() || line.ptr == end) return {0, 0};
  std::from_chars(line.ptr + 1, end, result.second);
  return result;
}

/// `= -3 mm`, `= "long"`, `is a list`.
std::string found(const Node& node, bool is_quoted) {
  using enum Node::Kind;
  if (node.kind == null || node.kind == list || node.kind == map)
    return fmt::format("is {}", noun(node.kind));
  std::string text = in_quotes(node.text);
  if (node.kind != string || !is_quoted) text = text.substr(1, text.size() - 2);
  return "= " + text;
}

}  // namespace

std::string Reader::place() const {
  if (!node_) return where(0, 0, path_);
  return where(node_->line, node_->column, node_->line > 0 ? path_ : name(*node_, path_));
}

Reader Reader::required(std::string_view key, std::string_view meaning) {
  know(key);
  const std::string path = joined(path_, key);
  if (!expect(Node::Kind::map, "a map of keys")) return {document_, sink_, nullptr, path};
  const Node* value = node_->find(key);
  if (value && value->kind != Node::Kind::null) return {document_, sink_, value, path};
  // as for optional keys: null is no value
  const std::string in = name(*node_, path_);
  report("missing_key", value && value->line > 0 ? where(value->line, value->column, path) : place(),
         fmt::format("missing key {}{}{}.", in_quotes(key), in.empty() ? "" : " in " + in,
                     meaning.empty() ? "" : fmt::format(" ({})", meaning)));
  return {document_, sink_, nullptr, path};
}

std::optional<Reader> Reader::optional(std::string_view key) {
  const Node* value = given(key);
  if (!value) return {};
  return Reader(document_, sink_, value, joined(path_, key));
}

void Reader::know(std::string_view key) {
  constexpr std::size_t of_document = 32, of_map = 4;  // usual numbers of keys
  if (known_.empty()) known_.reserve(path_.empty() ? of_document : of_map);
  known_.push_back(key);
}

bool Reader::has(std::string_view key) { return given(key) != nullptr; }

const Node* Reader::given(std::string_view key) {
  know(key);
  if (!expect(Node::Kind::map, "a map of keys")) return nullptr;
  const Node* value = node_->find(key);
  return value && value->kind != Node::Kind::null ? value : nullptr;
}

std::vector<std::pair<std::string, Reader>> Reader::members() const {
  std::vector<std::pair<std::string, Reader>> result;
  if (!expect(Node::Kind::map, "a map of keys")) return result;
  for (const Member& member : node_->members)
    result.emplace_back(member.key, Reader(document_, sink_, &member.value, joined(path_, member.key)));
  return result;
}

std::vector<Reader> Reader::items(std::optional<std::size_t> size) const {
  std::vector<Reader> result;
  if (!is(Node::Kind::list)) {
    expect(Node::Kind::list, size ? fmt::format("a list of {} values", *size) : "a list");
    return result;
  }
  if (size) expect_size(*size);
  result.reserve(node_->items.size());
  for (std::size_t i = 0; i < node_->items.size(); ++i)
    result.push_back({document_, sink_, &node_->items[i], joined(path_, i)});
  return result;
}

void Reader::expect_size(std::size_t size) const {
  if (node_->items.size() == size) return;
  report("wrong_length", place(),
         fmt::format("{} has {} value{}; it must have {}.", name(*node_, path_), node_->items.size(),
                     node_->items.size() == 1 ? "" : "s", size));
}

void Reader::close() {
  if (!expect(Node::Kind::map, "a map of keys")) return;
  for (const Member& member : node_->members) {
    const bool takes_away = member.value.kind == Node::Kind::null;  // a default that does not fit here
    if (!takes_away && !is_full() && std::ranges::find(known_, member.key) == known_.end()) unknown(member);
  }
}

double Reader::quantity(Dimension dimension, Range range) const {
  return value(dimension, range).value_or(harmless(range));
}

int Reader::integer(Range range) const {
  constexpr double lowest = std::numeric_limits<int>::min(), highest = std::numeric_limits<int>::max();
  const auto whole = value(Dimension::count, range);
  if (!whole) return harmless_integer(range);
  if (*whole >= lowest && *whole <= highest) return static_cast<int>(*whole);
  refuse("out_of_range", rule(Range::between(lowest, highest), Dimension::count, lowest) + ".");
  return harmless_integer(range);
}

std::string Reader::text() const {
  if (!expect(Node::Kind::string, "text, in quotes if it looks like a number")) return {};
  return node_->text;
}

bool Reader::boolean() const { return expect(Node::Kind::boolean, "true or false") && node_->boolean; }

std::size_t Reader::choice_index(std::span<const std::string_view> words) const {
  if (!node_) return 0;
  const bool is_scalar = !node_->text.empty() || node_->kind == Node::Kind::string;
  const auto word = std::ranges::find(words, std::string_view(node_->text));  // 5 or true may be a word, too
  if (is_scalar && word != words.end()) return static_cast<std::size_t>(word - words.begin());
  const std::string allowed = fmt::format("{}", fmt::join(words, ", "));
  if (!is_scalar) {
    unsuitable("one of " + allowed);
    return 0;
  }
  const std::string_view hint = closest(node_->text, words);
  report("unknown_choice", place(),
         fmt::format("{} {} is unknown{} Known here: {}.", name(*node_, path_), found(*node_, true),
                     hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)), allowed));
  return 0;
}

std::vector<double> Reader::quantities(Dimension dimension, Range range,
                                       std::optional<std::size_t> size) const {
  std::vector<double> result;
  if (is(Node::Kind::list)) {
    if (size) expect_size(*size);
    result.reserve(node_->items.size());
    for (std::size_t i = 0; i < node_->items.size(); ++i) {
      const Node& item = node_->items[i];
      const bool is_plain = item.kind == Node::Kind::number && dimension != Dimension::count &&
                            range.contains(item.number);  // most are: spares the path
      result.push_back(is_plain
                           ? item.number
                           : Reader(document_, sink_, &item, joined(path_, i)).quantity(dimension, range));
    }
  } else {
    const std::string list = size ? fmt::format("a list of {} values", *size) : "a list of values";
    expect(Node::Kind::list, fmt::format("{}, each {}", list, advice(dimension)));
  }
  if (size) result.resize(*size, harmless(range));
  return result;
}

void Reader::fail(std::string_view code, std::string_view message) const {
  const std::string here = node_ ? name(*node_, path_) : path_;
  report(code, place(), here.empty() ? std::string(message) : fmt::format("{}: {}", here, message));
}

void Reader::refuse(std::string_view code, std::string_view rule_text) const {
  if (!node_) return;
  const std::string here = name(*node_, path_);
  report(code, place(),
         fmt::format("{} {}; {}", here.empty() ? root_name() : here, found(*node_, false), rule_text));
}

/// The number here; nothing after an error.
std::optional<double> Reader::value(Dimension dimension, const Range& range) const {
  if (!node_) return {};
  double result = node_->number;
  if (node_->kind == Node::Kind::string) {
    const Expected<double> parsed = parse_quantity(node_->text, dimension);
    if (!parsed) {
      const Error& error = parsed.error().front();
      report(error.code, place(), fmt::format("{} = {}", name(*node_, path_), error.message));
      return {};
    }
    result = *parsed;
  } else if (node_->kind != Node::Kind::number) {
    unsuitable(advice(dimension));
    return {};
  }
  if (dimension == Dimension::count && result != std::floor(result)) {
    refuse("not_whole", fmt::format("give {}.", advice(dimension)));
    return {};
  }
  if (range.contains(result)) return result;
  refuse("out_of_range", rule(range, dimension, result) + ".");
  return {};
}

/// Whether the node is of this kind; otherwise notes what is needed.
bool Reader::expect(Node::Kind kind, std::string_view advice_text) const {
  if (!node_) return false;
  if (node_->kind == kind) return true;
  unsuitable(advice_text);
  return false;
}

void Reader::unsuitable(std::string_view advice_text) const {
  const std::string here = name(*node_, path_);
  report("wrong_type", place(),
         fmt::format("{} {}; give {}.", here.empty() ? root_name() : here, found(*node_, true), advice_text));
}

void Reader::unknown(const Member& member) const {
  // a slip in the defaults is one slip, and named where it stands
  const std::string path = name(member.value, joined(path_, member.key));
  const std::size_t parent = path.size() - std::min(path.size(), member.key.size() + 1);
  const std::string in = path.substr(0, parent);
  std::vector<std::string_view> known;
  for (const std::string_view key : known_)
    if (std::ranges::find(known, key) == known.end()) known.push_back(key);
  const std::string_view hint = closest(member.key, known);
  report(
      "unknown_key", where(member.line, member.column, path),
      fmt::format("unknown key {}{}{} Known here: {}.", in_quotes(member.key), in.empty() ? "" : " in " + in,
                  hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)),
                  fmt::join(known, ", ")));
}

/// The path for messages. A node merged in from the defaults is called by its own path, so that its error,
/// found again in every leg, is the same error.
std::string Reader::name(const Node& node, const std::string& path) const {
  if (is_full()) return path;  // nothing is noted any more: spare the search
  const Node* here = at(document_->root, path);
  const bool is_at_path = here && here->line == node.line && here->column == node.column;
  return is_at_path ? path : path_of(document_->root, node).value_or(path);
}

std::string Reader::root_name() const {  // a file says where it stands, a query has no lines
  return document_->root.line > 0 ? "the document" : document_->source;
}

std::string Reader::where(int line, int column, const std::string& path) const {
  return line > 0 || path.empty() ? sinew::place(*document_, line, column) : one_line(path, 300);
}

void Reader::report(std::string_view code, std::string where_text, std::string message) const {
  message = one_line(message, 2000);
  const auto is_same = [&](const Error& error) {
    return error.where == where_text && error.message == message;
  };
  if (is_full() || std::ranges::any_of(*sink_, is_same)) return;
  if (sink_->size() == error_limit) {
    sink_->push_back(
        {"too_many_errors", document_->source, "there are more errors than these; mend these first."});
    return;
  }
  const auto here = position(where_text, document_->source);
  auto after = sink_->end();
  if (here.first > 0)
    while (after != sink_->begin() && position(std::prev(after)->where, document_->source) > here) --after;
  sink_->insert(after, {std::string(code), std::move(where_text), std::move(message)});
}

}  // namespace sinew::inline v1
