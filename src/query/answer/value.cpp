#include "query/answer/value.hpp"
#include "solve/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/same_name.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::size_t usual_members = 12, usual_additions = 2, usual_items = 6;
constexpr std::size_t usual_size = 1024;  ///< of the text of an answer

/// All eight digits of a number below 1e8, as they are written: of pairs, each pair by itself, at once.
[[gnu::always_inline]] inline std::uint64_t eight_digits(std::uint32_t value) {
  constexpr std::uint64_t zeros = 0x3030303030303030;
  const std::uint64_t fours = value / 10000 | static_cast<std::uint64_t>(value % 10000) << 32;
  const std::uint64_t hundreds =
      (fours * 10486 >> 20) & 0x0000007f0000007f;  // 10486/2^20 is just above 1/100
  const std::uint64_t pairs = hundreds | (fours - 100 * hundreds) << 16;
  const std::uint64_t tens = (pairs * 103 >> 10) & 0x000f000f000f000f;  // 103/2^10 above 1/10
  std::uint64_t digits = zeros | tens | (pairs - 10 * tens) << 8;       // the first of them lowest
  if constexpr (std::endian::native == std::endian::big) {
    std::uint64_t turned = 0;
    for (; digits > 0; digits >>= 8) turned = turned << 8 | (digits & 0xff);
    return turned;
  }
  return digits;
}

constexpr int most_digits = 17;  ///< of what reads back to the same double
constexpr auto powers_of_ten = [] {
  std::array<std::uint64_t, most_digits + 1> powers{1};
  for (std::size_t k = 1; k < powers.size(); ++k) powers[k] = 10 * powers[k - 1];
  return powers;
}();

/// @param value above 0 and below 1e17
int count_digits(std::uint64_t value) {
  const int about = static_cast<int>(std::bit_width(value)) * 1233 >> 12;  // log10 of 2 is 0.301
  return about + (value >= powers_of_ten[static_cast<std::size_t>(about)] ? 1 : 0);
}

__extension__ using Digits = unsigned __int128;  ///< sixteen of them

constexpr std::size_t room_of_number =
    48;  ///< of which a third is for what is copied in one piece, past the end

/// The shortest digits that read back to the same double, with a point: a reader tells it from a whole
/// number. Exponents are written from 1e16 on and below 1e-4. As fmt writes {}, in a third of the time:
/// answers are numbers for the most part.
/// @param to has room_of_number
/// @return past the last of them
char* write_number(char* to, double value) {
  const auto put_text = [&](std::string_view text) {
    std::memcpy(to, text.data(), text.size());
    to += text.size();
  };
  if (!std::isfinite(value)) {
    put_text("null");
    return to;
  }
  *to = '-';
  to += std::signbit(value);
  if (value == 0) {
    put_text("0.0");
    return to;
  }
  const auto decimal = fmt::detail::dragonbox::to_decimal(std::abs(value));
  const int count = count_digits(decimal.significand);
  const int power = decimal.exponent + count - 1;  // of the first digit
  // as many digits as there can be, zeros at the end: they are written in pieces of one size
  const std::uint64_t all =
      decimal.significand * powers_of_ten[static_cast<std::size_t>(most_digits - count)];
  const auto upper = static_cast<std::uint32_t>(all / powers_of_ten[8]);
  const std::uint32_t leading = upper / 100000000;
  const char first = static_cast<char>('0' + leading);
  const std::uint64_t high = eight_digits(upper - 100000000 * leading),
                      low = eight_digits(static_cast<std::uint32_t>(all % powers_of_ten[8]));
  const auto put_rest = [&](char* at) {
    std::memcpy(at, &high, sizeof high);
    std::memcpy(at + sizeof high, &low, sizeof low);
  };
  if (power < -4 || power >= 16) {
    to[0] = first, to[1] = '.';
    put_rest(to + 2);
    to += count > 1 ? count + 1 : 1;
    *to++ = 'e', *to++ = power < 0 ? '-' : '+';
    if (std::abs(power) < 10) *to++ = '0';
    const fmt::format_int exponent(std::abs(power));
    put_text({exponent.data(), exponent.size()});
    return to;
  }
  if (power <=
      0) {  // with as many zeros in front: without a branch, since signs of powers are anybody's guess
    const int zeros = -power;
    std::memcpy(to, "0.000000", 8);
    to[zeros + (zeros > 0 ? 1 : 0)] = first;
    to[1] = '.';
    put_rest(to + zeros + 2);
    return to + std::max(zeros + count + 1, 3);
  }
  to[0] = first;
  put_rest(to + 1);
  if constexpr (std::endian::native ==
                std::endian::little) {  // not read where it was just written: that waits
    const auto after = (static_cast<Digits>(low) << 64 | high) >> (8 * power);
    std::memcpy(to + power + 2, &after, sizeof after);
  } else {
    std::memmove(to + power + 2, to + power + 1, most_digits - 1);
  }
  to[power + 1] = '.';
  return to + std::max(count + 1, power + 3);
}

/// JSON at the end of a text. Room is made for many characters at once, and what there is too much of it cut
/// off at the end: answers are short pieces for the most part, which a text takes one by one.
class JsonWriter {
 public:
  explicit JsonWriter(std::string& text) : text_(text), to_(text.data() + text.size()), end_(to_) {}
  JsonWriter(const JsonWriter&) = delete;
  JsonWriter& operator=(const JsonWriter&) = delete;
  ~JsonWriter() { text_.resize(size()); }

  void put(std::string_view plain) {
    make_room(plain.size());
    put_in_room(plain);
  }

  template <class Whole>
  void whole(Whole value) {
    const fmt::format_int digits(value);
    put({digits.data(), digits.size()});
  }

  void number(double value) {
    make_room(room_of_number);
    to_ = write_number(to_, value);
  }

  void numbers(std::span<const double> values) {
    make_room(2 + (1 + room_of_number) * values.size());
    parts_in_room('[', values.size(), ']', [&](std::size_t i) { to_ = write_number(to_, values[i]); });
  }

  void text(std::string_view value) {
    const auto is_plain = [](char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; };
    if (!std::ranges::all_of(value, is_plain))
      return put(nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    make_room(value.size() + 2);
    *to_++ = '"';
    put_in_room(value);
    *to_++ = '"';
  }

  /// A name within a map, which is plain.
  void name(std::string_view value) {
    make_room(value.size() + 3);
    *to_++ = '"';
    put_in_room(value);
    *to_++ = '"', *to_++ = ':';
  }

  /// @param write(i) writes one of `count` parts
  template <class Write>
  void parts(char open, std::size_t count, char close, const Write& write) {
    make_room(2);
    parts_in_room(open, count, close, [&](std::size_t i) {
      write(i);
      make_room(2);  // for what comes after it
    });
  }

 private:
  std::size_t size() const { return static_cast<std::size_t>(to_ - text_.data()); }

  void make_room(std::size_t more) {
    if (static_cast<std::size_t>(end_ - to_) < more) grow(more);
  }
  void grow(std::size_t more) {
    const std::size_t used = size();
    text_.resize(std::max({std::min(text_.capacity(), usual_size), 2 * text_.size(), used + more}));
    to_ = text_.data() + used;
    end_ = text_.data() + text_.size();
  }

  void put_in_room(std::string_view plain) {
    copy_name(to_, plain);
    to_ += plain.size();
  }

  template <class Write>
  void parts_in_room(char open, std::size_t count, char close, const Write& write) {
    *to_++ = open;
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) *to_++ = ',';
      write(i);
    }
    *to_++ = close;
  }

  std::string& text_;
  char *to_, *end_;
};

}  // namespace

Value::Block::Block(std::span<const double> numbers, std::size_t columns)
    : count_(numbers.size()),
      columns_(columns) {
  if (count_ > few) is_.many = new double[count_];
  std::ranges::copy(numbers, data());
}

Value::Block& Value::Block::operator=(const Block& other) {
  if (this != &other) *this = Block(other);
  return *this;
}

Value::Block& Value::Block::operator=(Block&& other) noexcept {
  std::swap(is_, other.is_);
  std::swap(count_, other.count_);
  std::swap(columns_, other.columns_);
  return *this;
}

void Value::Block::insert(std::size_t at, double number) {
  std::vector<double> more(numbers().begin(), numbers().end());
  more.insert(more.begin() + static_cast<std::ptrdiff_t>(at), number);
  *this = Block(more, columns_);
}

// Not inline: they need what is in a map to be complete, which needs a value to be.
Value::Value(const Value& other) : kind_(other.kind_) {
  switch (kind_) {
    case Kind::text:
      std::construct_at(&is_.text, other.is_.text);
      break;
    case Kind::written:
      std::construct_at(&is_.written, other.is_.written);
      break;
    case Kind::block:
      std::construct_at(&is_.block, other.is_.block);
      break;
    case Kind::list:
      std::construct_at(&is_.list, other.is_.list);
      break;
    case Kind::map:
      std::construct_at(&is_.map, other.is_.map);
      break;
    default:
      is_.plain = other.is_.plain;
  }
}

void Value::take_content(Value& other) noexcept {
  switch (kind_) {
    case Kind::text:
      std::construct_at(&is_.text, std::move(other.is_.text));
      break;
    case Kind::written:
      std::construct_at(&is_.written, std::move(other.is_.written));
      break;
    case Kind::block:
      std::construct_at(&is_.block, std::move(other.is_.block));
      break;
    case Kind::list:
      std::construct_at(&is_.list, std::move(other.is_.list));
      break;
    case Kind::map:
      std::construct_at(&is_.map, std::move(other.is_.map));
      break;
    default:
      break;
  }
}

void Value::end_content() noexcept {
  switch (kind_) {
    case Kind::text:
      return std::destroy_at(&is_.text);
    case Kind::written:
      return std::destroy_at(&is_.written);
    case Kind::block:
      return std::destroy_at(&is_.block);
    case Kind::list:
      return std::destroy_at(&is_.list);
    case Kind::map:
      return std::destroy_at(&is_.map);
    default:
      return;
  }
}

Value::Map& Value::begin_map(std::size_t room) {
  kind_ = Kind::map;
  std::construct_at(&is_.map);
  is_.map.reserve(room);
  return is_.map;
}

Value::Value(std::string value) : kind_(Kind::text) { std::construct_at(&is_.text, std::move(value)); }
Value::Value(std::string_view value) : kind_(Kind::text) { std::construct_at(&is_.text, value); }
Value::Value(const char* value) : Value(std::string_view(value)) {}
Value::Value(Written value) : kind_(Kind::written) { std::construct_at(&is_.written, std::move(value)); }
Value::Value(List value) : kind_(Kind::list) { std::construct_at(&is_.list, std::move(value)); }
Value::Value(Block value) : kind_(Kind::block) { std::construct_at(&is_.block, std::move(value)); }
Value::Value(std::span<const int> whole_numbers) : Value(List(whole_numbers.begin(), whole_numbers.end())) {}
Value::Value(std::initializer_list<double> numbers)
    : Value(std::span<const double>(numbers.begin(), numbers.size()), 0) {}
Value::Value(std::span<const double> numbers, std::size_t columns) : kind_(Kind::block) {
  std::construct_at(&is_.block, numbers, columns);
}

Value Value::list() { return {List()}; }
Value Value::list(std::initializer_list<Value> items) { return {List(items)}; }

const bool* Value::boolean() const { return kind_ == Kind::boolean ? &is_.plain.boolean : nullptr; }
const std::string* Value::text() const { return kind_ == Kind::text ? &is_.text : nullptr; }
const Value::List* Value::items() const { return kind_ == Kind::list ? &is_.list : nullptr; }
const Value::Block* Value::block() const { return kind_ == Kind::block ? &is_.block : nullptr; }
const Value::Map* Value::members() const { return kind_ == Kind::map ? &is_.map : nullptr; }
Value& Value::back() { return own(is_.list, Kind::list).back(); }
Value& Value::operator[](std::size_t i) { return own(is_.list, Kind::list)[i]; }

Value Value::map() {
  Value value;
  value.begin_map(usual_members);
  return value;
}

Value::Value(const MatrixView& matrix)
    : Value(std::span<const double>(matrix.data(), static_cast<std::size_t>(matrix.size())),
            static_cast<std::size_t>(matrix.cols())) {}

Value::Value(std::initializer_list<Entry> entries) {
  Map& members = begin_map(entries.size() + usual_additions);
  for (const Entry& entry : entries) members.emplace_back(entry.key.name(), std::move(entry.value));
}

std::optional<double> Value::number() const {
  if (kind_ == Kind::number) return is_.plain.number;
  if (kind_ == Kind::whole) return static_cast<double>(is_.plain.whole);
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
  return own(is_.map, Kind::map).emplace_back(key.name()).value;
}

Value& Value::add(Key key) { return own(is_.map, Kind::map).emplace_back(key.name()).value; }

Value* Value::find(std::string_view name) {
  if (kind_ != Kind::map) return nullptr;
  const auto found =
      std::ranges::find_if(is_.map, [&](const Member& member) { return is_same_name(member.name, name); });
  return found == is_.map.end() ? nullptr : &found->value;
}

std::string_view Value::text_at(std::string_view name) const {
  const Value* found = find(name);
  return found && found->text() ? std::string_view(*found->text()) : std::string_view();
}

void Value::erase(std::string_view name) {
  std::erase_if(own(is_.map, Kind::map), [&](const Member& member) { return member.name == name; });
}

void Value::merge(Value&& other) {
  Map& members = own(is_.map, Kind::map);
  for (Member& member : other.own(other.is_.map, Kind::map)) {
    if (Value* found = find(member.name))
      *found = std::move(member.value);
    else
      members.push_back(std::move(member));
  }
}

void Value::push_back(Value value) {
  if (is_null()) *this = list();
  if (kind_ == Kind::block) return is_.block.insert(is_.block.numbers().size(), value.number().value());
  List& list = own(is_.list, Kind::list);
  if (list.empty()) list.reserve(usual_items);
  list.push_back(std::move(value));
}

void Value::push_front(double number) { own(is_.block, Kind::block).insert(0, number); }

std::string Value::json() const {
  std::string text;
  text.reserve(usual_size);
  append_json(text);
  return text;
}

namespace {

struct WriteJson {
  JsonWriter& json;

  void write(const Value& value) const { value.visit(*this); }

  void operator()(std::nullptr_t) const { json.put("null"); }
  void operator()(bool value) const { json.put(value ? "true" : "false"); }
  void operator()(std::int64_t value) const { json.whole(value); }
  void operator()(double value) const { json.number(value); }
  void operator()(const std::string& value) const { json.text(value); }
  void operator()(const Value::Written& value) const { json.put(value.text); }
  void operator()(const Value::Block& block) const {
    if (block.columns() == 0) return json.numbers(block.numbers());
    json.parts('[', block.size(), ']', [&](std::size_t i) { json.numbers(block.row(i)); });
  }
  void operator()(const Value::List& list) const {
    json.parts('[', list.size(), ']', [&](std::size_t i) { write(list[i]); });
  }
  void operator()(const Value::Map& map) const {
    json.parts('{', map.size(), '}', [&](std::size_t i) {
      json.name(map[i].name);
      write(map[i].value);
    });
  }
};

}  // namespace

void Value::append_json(std::string& text) const {
  JsonWriter json(text);
  WriteJson{json}.write(*this);
}

namespace {

Node number_node(double value) {
  Node node;
  if (!std::isfinite(value)) return node;
  node.kind = Node::Kind::number;
  node.number = value;
  std::array<char, room_of_number> room;
  node.text.assign(room.data(), write_number(room.data(), value));
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
    Node operator()(std::nullptr_t) const { return {}; }
    Node operator()(bool value) const { return make_node(value); }
    Node operator()(std::int64_t value) const {
      Node node = make_node(static_cast<double>(value));
      node.text.clear();
      const fmt::format_int digits(value);
      node.text.append(digits.data(), digits.size());
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
      if (block.columns() == 0) return numbers_node(block.numbers());
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
  return visit(Make{});
}

}  // namespace sinew::inline v1
