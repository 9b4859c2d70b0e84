#include "sinew/io/node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "base/same_name.hpp"
#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"

namespace sinew::inline v1 {
namespace {

/// A key, or an index into a list where the key is empty.
struct Step {
  std::string_view key;
  std::size_t index = 0;
  std::size_t end = 0;  // of the path up to and with this step
};

std::optional<Step> index_step(std::string_view path, std::size_t begin) {
  const std::size_t end = path.find(']', begin);
  if (end == std::string_view::npos) return {};
  Step step;
  step.end = end + 1;
  const auto [stop, error] = std::from_chars(path.data() + begin + 1, path.data() + end, step.index);
  if (error != std::errc() || stop != path.data() + end) return {};
  return step;
}

std::optional<std::vector<Step>> steps_of(std::string_view path) {
  std::vector<Step> steps;
  std::size_t position = 0;
  while (position < path.size()) {
    if (path[position] == '[') {
      const auto step = index_step(path, position);
      if (!step) return {};
      steps.push_back(*step);
    } else {
      if (!steps.empty()) {
        if (path[position] != '.') return {};
        ++position;
      }
      const std::size_t end = std::min(path.find_first_of(".[", position), path.size());
      if (end == position) return {};
      steps.push_back({path.substr(position, end - position), 0, end});
    }
    position = steps.back().end;
  }
  return steps;
}

const Node* follow(const Node& node, const Step& step) {
  if (!step.key.empty()) return node.find(step.key);
  return node.kind == Node::Kind::list && step.index < node.items.size() ? &node.items[step.index] : nullptr;
}

/// Why a step leads nowhere from `node`, which is called `name`: what is there instead.
std::string what_is_there(const Node& node, std::string_view name, const Step& step) {
  if (step.key.empty()) {
    if (node.kind != Node::Kind::list) return fmt::format("{} is {}, not a list", name, noun(node.kind));
    if (node.items.empty()) return fmt::format("{} is an empty list", name);
    return fmt::format("{} has {} items, [0] to [{}]", name, node.items.size(), node.items.size() - 1);
  }
  if (node.kind != Node::Kind::map) return fmt::format("{} is {}, not a map", name, noun(node.kind));
  if (node.members.empty()) return fmt::format("{} has no key {}; it is empty", name, in_quotes(step.key));
  std::vector<std::string_view> keys;
  for (const Member& member : node.members) keys.push_back(member.key);
  const std::string_view hint = closest(step.key, keys);
  return fmt::format("{} has no key {}{}; there are: {}", name, in_quotes(step.key),
                     hint.empty() ? "" : fmt::format(" (did you mean {}?)", in_quotes(hint)),
                     fmt::join(keys, ", "));
}

bool find_place(const Node& root, const Node& node, std::string& path) {
  if (root.line == node.line && root.column == node.column && root.kind == node.kind) return true;
  const std::string here = path;
  for (std::size_t i = 0; i < root.items.size(); ++i) {
    path = joined(here, i);
    if (find_place(root.items[i], node, path)) return true;
  }
  for (const Member& member : root.members) {
    path = joined(here, member.key);
    if (find_place(member.value, node, path)) return true;
  }
  return false;
}

/// Edits from one word to the other; a swap of neighbours is one edit (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

std::string lowered(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

}  // namespace

const Node* Node::find(std::string_view key) const {
  const auto found =
      std::ranges::find_if(members, [&](const Member& member) { return is_same_name(member.key, key); });
  return found == members.end() ? nullptr : &found->value;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

Node make_node(bool value) {
  Node node;
  node.kind = Node::Kind::boolean;
  node.boolean = value;
  node.text = value ? "true" : "false";
  return node;
}

Node make_node(double value) {
  Node node;
  node.kind = Node::Kind::number;
  node.number = value;
  node.text = si_text(value);
  return node;
}

Node make_node(std::string_view text) {
  Node node;
  node.kind = Node::Kind::string;
  node.text = text;
  return node;
}

const Node* at(const Node& root, std::string_view path) {
  const auto steps = steps_of(path);
  if (!steps) return nullptr;
  const Node* node = &root;
  for (const Step& step : *steps)
    if (!(node = follow(*node, step))) return nullptr;
  return node;
}

Node* at(Node& root, std::string_view path) { return const_cast<Node*>(at(std::as_const(root), path)); }

std::string joined(std::string_view path, std::string_view key) {
  if (path.empty()) return std::string(key);
  std::string whole(path.size() + 1 + key.size(), '.');
  path.copy(whole.data(), path.size());
  key.copy(whole.data() + path.size() + 1, key.size());
  return whole;
}

std::string joined(std::string_view path, std::size_t index) {
  std::string whole(path);
  whole += '[';
  whole += std::to_string(index);
  return whole += ']';
}

std::string place(const Document& document, int line, int column) {
  return line > 0 ? fmt::format("{}:{}:{}", document.source, line, column) : document.source;
}

std::optional<std::string> path_of(const Node& root, const Node& node) {
  std::string path;
  if (node.line == 0 || !find_place(root, node, path)) return {};
  return path;
}

Node merged(const Node& defaults, const Node& own) {
  if (defaults.kind != Node::Kind::map || own.kind != Node::Kind::map) return own;
  Node result = own;
  for (const Member& member : defaults.members) {
    if (Node* mine = result.find(member.key))
      *mine = merged(member.value, *mine);
    else
      result.members.push_back(member);
  }
  return result;
}

Expected<void> set(Node& root, std::string_view path, Node value) {
  const auto steps = steps_of(path);
  if (!steps || steps->empty())
    return failure("unknown_path", path,
                   in_quotes(path) + " is not a path; write it like legs[0].link.length.");
  Node* node = &root;
  std::string name = "the document";
  for (const Step& step : *steps) {
    Node* next = const_cast<Node*>(follow(*node, step));
    const bool is_last = step.end == path.size();
    if (!next && is_last && !step.key.empty() && node->kind == Node::Kind::map) {
      node->members.push_back({std::string(step.key), 0, 0, std::move(value)});
      return {};
    }
    if (!next) {
      return failure("unknown_path", path,
                     fmt::format("cannot set {}: {}.", path, what_is_there(*node, name, step)));
    }
    node = next;
    name = path.substr(0, step.end);
  }
  *node = std::move(value);
  return {};
}

std::string_view noun(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::null:
      return "empty";
    case Node::Kind::boolean:
      return "true or false";
    case Node::Kind::number:
      return "a number";
    case Node::Kind::string:
      return "text";
    case Node::Kind::list:
      return "a list";
    case Node::Kind::map:
      return "a map";
  }
  return "";
}

std::string one_line(std::string_view text, std::size_t limit) {
  std::size_t size = text.size();
  if (size > limit)  // a follower of UTF-8 is 10xxxxxx
    for (size = limit; size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80;) --size;
  std::string result(text.substr(0, size));
  std::ranges::replace_if(
      result, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
  return visible(size < text.size() ? result + "..." : result);
}

std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", one_line(text, 60)); }

std::string_view closest(std::string_view word, std::span<const std::string_view> candidates) {
  constexpr std::size_t longest = 64;
  if (word.empty() || word.size() > longest) return {};
  const std::string lower = lowered(word);
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(1, (word.size() + 1) / 3) + 1;
  for (std::string_view candidate : candidates) {
    if (candidate.size() > longest) continue;
    const std::size_t edits = distance(lower, lowered(candidate));
    // "x" is one edit from "y", but nobody means it
    if (edits < best_distance && edits < std::max(word.size(), candidate.size())) {
      best = candidate;
      best_distance = edits;
    }
  }
  return best;
}

Node placed(Node node, const Node& like) {
  node.line = like.line;
  node.column = like.column;
  return node;
}

bool NodeBuilder::open(Node::Kind list_or_map, int line, int column) {
  if (!count(line, column)) return false;
  if (open_.size() >= depth_limit)
    return stop("too_deep", line, column, fmt::format("more than {} levels of lists and maps.", depth_limit));
  Node& node = slot();
  node.kind = list_or_map;
  node.line = line;
  node.column = column;
  constexpr std::size_t usual = 4;  // of queries: a list of coordinates, a map of few fields
  if (list_or_map == Node::Kind::list)
    node.items.reserve(usual);
  else
    node.members.reserve(usual);
  if (open_.empty()) open_.reserve(usual);
  open_.push_back({&node});
  return true;
}

bool NodeBuilder::close() {
  open_.pop_back();
  return true;
}

bool NodeBuilder::key(std::string_view key, int line, int column) {
  Level& level = open_.back();
  if (const std::optional<int> first = level.line_of(key)) {
    const std::string map = path();
    stop("duplicate_key", line, column,
         fmt::format("{} is given twice{}{}; keep one.", in_quotes(key), map.empty() ? "" : " in " + map,
                     line > 0 ? fmt::format("; it was first given at line {}", *first) : ""));
    if (errors_.size() >= 100) return false;  // nobody mends more at once
  }
  Member& member = level.node->members.emplace_back();
  member.key = key;
  member.line = line;
  member.column = column;
  level.has_key = true;
  return true;
}

bool NodeBuilder::scalar(Node&& node) {
  if (!count(node.line, node.column)) return false;
  slot() = std::move(node);
  return true;
}

bool NodeBuilder::stop(std::string_view code, int line, int column, std::string_view message) {
  errors_.push_back({std::string(code), place(document_, line, column), one_line(message, 1000)});
  return false;
}

std::optional<int> NodeBuilder::Level::line_of(std::string_view key) {
  constexpr std::size_t few = 24;  // a search of more would be quadratic
  const auto& members = node->members;
  if (members.size() <= few) {
    const auto found =
        std::ranges::find_if(members, [&](const Member& member) { return is_same_name(member.key, key); });
    return found == members.end() ? std::nullopt : std::optional(found->line);
  }
  if (!lines) lines = std::make_unique<std::unordered_map<std::string, int>>();
  for (; indexed < members.size(); ++indexed) lines->try_emplace(members[indexed].key, members[indexed].line);
  const auto found = lines->find(std::string(key));
  return found == lines->end() ? std::nullopt : std::optional(found->second);
}

std::pair<int, int> NodeBuilder::key_place() const {
  if (open_.empty() || !open_.back().has_key) return {0, 0};
  const Member& last = open_.back().node->members.back();
  return {last.line, last.column};
}

Expected<Document> NodeBuilder::finish() {
  open_.clear();
  if (!errors_.empty()) return tl::unexpected<Errors>(std::move(errors_));
  return std::move(document_);
}

bool NodeBuilder::count(int line, int column) {
  if (++nodes_ <= node_limit) return true;
  return stop("too_large", line, column, fmt::format("more than {} values in one document.", node_limit));
}

Node& NodeBuilder::slot() {
  if (open_.empty()) return document_.root;
  Level& level = open_.back();
  if (level.node->kind == Node::Kind::list) return level.node->items.emplace_back();
  level.has_key = false;
  return level.node->members.back().value;
}

std::string NodeBuilder::path() const {
  std::string path;
  for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
    const Node& node = *open_[i].node;
    path = node.kind == Node::Kind::list ? joined(path, node.items.size() - 1)
                                         : joined(path, node.members.back().key);
  }
  return path;
}

}  // namespace sinew::inline v1
