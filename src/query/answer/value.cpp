#include "query/answer/value.hpp"
#include "solve/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace sinew::inline v1 {
namespace {

constexpr std::size_t usual_members = 12;

template <class Whole>
void append_whole(std::string& text, Whole value) {
  const fmt::format_int digits(value);
  text.append(digits.data(), digits.size());
}

/// The shortest digits that read back to the same double, with a point: a reader tells it from a whole
/// number. Exponents are written from 1e16 on and below 1e-4. As fmt writes {}, in half the time: answers are
/// numbers for the most part.
void append_number(std::string& text, double value) {
  if (!std::isfinite(value)) {
    text += "null";
    return;
  }
  if (value == 0) {
    text += std::signbit(value) ? "-0.0" : "0.0";
    return;
  }
  const auto decimal = fmt::detail::dragonbox::to_decimal(std::abs(value));
  const fmt::format_int significand(decimal.significand);
  const char* digits = significand.data();
  const int count = static_cast<int>(significand.size());
  const int power = decimal.exponent + count - 1;  // of the first digit
  std::array<char, 40> room;
  char* to = room.data();
  const auto put = [&](const char* from, int size) { to = std::copy_n(from, size, to); };
  const auto put_zeros = [&](int size) { to = std::fill_n(to, size, '0'); };
  if (value < 0) *to++ = '-';
  if (power < -4 || power >= 16) {
    *to++ = digits[0];
    if (count > 1) *to++ = '.';
    put(digits + 1, count - 1);
    *to++ = 'e', *to++ = power < 0 ? '-' : '+';
    if (std::abs(power) < 10) *to++ = '0';
    const fmt::format_int exponent(std::abs(power));
    put(exponent.data(), static_cast<int>(exponent.size()));
  } else if (power < 0) {
    *to++ = '0', *to++ = '.';
    put_zeros(-power - 1);
    put(digits, count);
  } else {
    const int before = std::min(power + 1, count);
    put(digits, before);
    put_zeros(power + 1 - before);
    *to++ = '.';
    put(digits + before, count - before);
    if (before == count) *to++ = '0';
  }
  text.append(room.data(), static_cast<std::size_t>(to - room.data()));
}

void append_text(std::string& text, std::string_view value) {
  const auto is_plain = [](char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; };
  if (std::ranges::all_of(value, is_plain)) {
    text += '"';
    text += value;
    text += '"';
  } else {
    text += nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
}

/// @param write(i) writes one of `count` parts
template <class Write>
void append_parts(std::string& text, char open, std::size_t count, char close, const Write& write) {
  text += open;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text += ',';
    write(i);
  }
  text += close;
}

void append_numbers(std::string& text, std::span<const double> numbers) {
  append_parts(text, '[', numbers.size(), ']', [&](std::size_t i) { append_number(text, numbers[i]); });
}

}  // namespace

// Not inline: they need what is in a map to be complete, which needs a value to be.
Value::Value() = default;
Value::Value(const Value&) = default;
Value::Value(Value&&) noexcept = default;
Value& Value::operator=(const Value&) = default;
Value& Value::operator=(Value&&) noexcept = default;
Value::~Value() = default;
Value::Value(bool value) : is_(value) {}
Value::Value(double value) : is_(value) {}
Value::Value(std::string value) : is_(std::move(value)) {}
Value::Value(std::string_view value) : is_(std::string(value)) {}
Value::Value(const char* value) : is_(std::string(value)) {}
Value::Value(Written value) : is_(std::move(value)) {}
Value::Value(List value) : is_(std::move(value)) {}
Value::Value(Block value) : is_(std::move(value)) {}
Value::Value(std::span<const int> whole_numbers) : is_(List(whole_numbers.begin(), whole_numbers.end())) {}
Value::Value(std::initializer_list<double> numbers) : is_(Block{numbers}) {}
Value::Value(std::span<const double> numbers, std::size_t columns)
    : is_(Block{{numbers.begin(), numbers.end()}, columns}) {}

Value Value::whole(std::int64_t value) {
  Value made;
  made.is_ = value;
  return made;
}

Value Value::list() { return {List()}; }
Value Value::list(std::initializer_list<Value> items) { return {List(items)}; }

bool Value::is_null() const { return std::holds_alternative<std::monostate>(is_); }
const bool* Value::boolean() const { return std::get_if<bool>(&is_); }
const std::string* Value::text() const { return std::get_if<std::string>(&is_); }
const Value::List* Value::items() const { return std::get_if<List>(&is_); }
const Value::Block* Value::block() const { return std::get_if<Block>(&is_); }
const Value::Map* Value::members() const { return std::get_if<Map>(&is_); }
Value& Value::back() { return std::get<List>(is_).back(); }
Value& Value::operator[](std::size_t i) { return std::get<List>(is_)[i]; }

Value Value::map() {
  Value value;
  value.is_.emplace<Map>().reserve(usual_members);
  return value;
}

Value::Value(const MatrixView& matrix)
    : is_(Block{{matrix.data(), matrix.data() + matrix.size()}, static_cast<std::size_t>(matrix.cols())}) {}

Value::Value(std::initializer_list<Entry> entries) {
  Map& members = is_.emplace<Map>();
  members.reserve(entries.size());
  for (const Entry& entry : entries) members.push_back({entry.key.name(), std::move(entry.value)});
}

std::optional<double> Value::number() const {
  if (const auto* number = std::get_if<double>(&is_)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&is_)) return static_cast<double>(*whole);
  return {};
}

std::size_t Value::size() const {
  if (const Block* numbers = block()) return numbers->size();
  if (const List* list = items()) return list->size();
  if (const Map* map = members()) return map->size();
  return 0;
}

Value& Value::operator[](Key key) {
  if (is_null()) *this = map();
  if (Value* found = find(key.name())) return *found;
  Map& members = std::get<Map>(is_);
  members.push_back({key.name(), {}});
  return members.back().value;
}

Value* Value::find(std::string_view name) {
  Map* members = std::get_if<Map>(&is_);
  if (!members) return nullptr;
  const auto found = std::ranges::find(*members, name, &Member::name);
  return found == members->end() ? nullptr : &found->value;
}

std::string_view Value::text_at(std::string_view name) const {
  const Value* found = find(name);
  return found && found->text() ? std::string_view(*found->text()) : std::string_view();
}

void Value::erase(std::string_view name) {
  std::erase_if(std::get<Map>(is_), [&](const Member& member) { return member.name == name; });
}

void Value::merge(Value&& other) {
  Map& members = std::get<Map>(is_);
  for (Member& member : std::get<Map>(other.is_)) {
    if (Value* found = find(member.name))
      *found = std::move(member.value);
    else
      members.push_back(std::move(member));
  }
}

void Value::push_back(Value value) {
  if (is_null()) *this = list();
  if (Block* numbers = std::get_if<Block>(&is_))
    numbers->numbers.push_back(value.number().value());
  else
    std::get<List>(is_).push_back(std::move(value));
}

void Value::push_front(double number) {
  auto& numbers = std::get<Block>(is_).numbers;
  numbers.insert(numbers.begin(), number);
}

std::string Value::json() const {
  std::string text;
  text.reserve(1024);
  append_json(text);
  return text;
}

void Value::append_json(std::string& text) const {
  struct Append {
    std::string& text;

    void operator()(std::monostate) const { text += "null"; }
    void operator()(bool value) const { text += value ? "true" : "false"; }
    void operator()(std::int64_t value) const { append_whole(text, value); }
    void operator()(double value) const { append_number(text, value); }
    void operator()(const std::string& value) const { append_text(text, value); }
    void operator()(const Written& value) const { text += value.text; }
    void operator()(const Block& block) const {
      if (block.columns == 0) return append_numbers(text, block.numbers);
      append_parts(text, '[', block.size(), ']', [&](std::size_t i) { append_numbers(text, block.row(i)); });
    }
    void operator()(const List& list) const {
      append_parts(text, '[', list.size(), ']', [&](std::size_t i) { list[i].append_json(text); });
    }
    void operator()(const Map& map) const {
      append_parts(text, '{', map.size(), '}', [&](std::size_t i) {
        text += '"';
        text += map[i].name;
        text += "\":";
        map[i].value.append_json(text);
      });
    }
  };
  std::visit(Append{text}, is_);
}

namespace {

Node number_node(double value) {
  Node node;
  if (!std::isfinite(value)) return node;
  node.kind = Node::Kind::number;
  node.number = value;
  append_number(node.text, value);
  return node;
}

template <class Make>
Node list_node(std::size_t count, const Make& make) {
  Node node;
  node.kind = Node::Kind::list;
  node.items.reserve(count);
  for (std::size_t i = 0; i < count; ++i) node.items.push_back(make(i));
  return node;
}

Node numbers_node(std::span<const double> numbers) {
  return list_node(numbers.size(), [&](std::size_t i) { return number_node(numbers[i]); });
}

}  // namespace

Node Value::node() const {
  struct Make {
    Node operator()(std::monostate) const { return {}; }
    Node operator()(bool value) const { return make_node(value); }
    Node operator()(std::int64_t value) const {
      Node node = make_node(static_cast<double>(value));
      node.text.clear();
      append_whole(node.text, value);
      return node;
    }
    Node operator()(double value) const { return number_node(value); }
    Node operator()(const std::string& value) const { return make_node(std::string_view(value)); }
    Node operator()(const Written& value) const {
      Node node = make_node(0.0);
      node.text = value.text;
      return node;
    }
    Node operator()(const Block& block) const {
      if (block.columns == 0) return numbers_node(block.numbers);
      return list_node(block.size(), [&](std::size_t i) { return numbers_node(block.row(i)); });
    }
    Node operator()(const List& list) const {
      return list_node(list.size(), [&](std::size_t i) { return list[i].node(); });
    }
    Node operator()(const Map& map) const {
      Node node;
      node.kind = Node::Kind::map;
      node.members.reserve(map.size());
      for (const Member& member : map)
        node.members.push_back({.key = std::string(member.name), .value = member.value.node()});
      return node;
    }
  };
  return std::visit(Make{}, is_);
}

}  // namespace sinew::inline v1
