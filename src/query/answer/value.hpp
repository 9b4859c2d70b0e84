/// @file value.hpp
/// An answer: a tree of maps, lists, texts and blocks of numbers. A block lies in one piece, a list of
/// numbers or the rows of a matrix, so that it can be read as a column and written quickly.
#pragma once
#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "math/linalg.hpp"
#include "sinew/io/node.hpp"

namespace sinew::inline v1 {

class Value {
 public:
  /// A name within a map: a literal, which outlives every answer.
  class Key {
   public:
    template <std::size_t size>
    consteval Key(const char (&literal)[size])
        : name_(literal, size - 1) {}  // implicit: keys are written as texts
    std::string_view name() const { return name_; }

   private:
    std::string_view name_;
  };
  struct Member;
  struct Entry;
  using List = std::vector<Value>;
  using Map = std::vector<Member>;
  /// Numbers row by row; `columns` of a plain list is 0. Few, as of a point or a quaternion, lie in the block
  /// itself: most of an answer's are few.
  class Block {
   public:
    Block() = default;
    explicit Block(std::span<const double> numbers, std::size_t columns = 0);
    Block(const Block& other) : Block(other.numbers(), other.columns_) {}
    Block(Block&& other) noexcept
        : is_(other.is_),
          count_(std::exchange(other.count_, 0)),
          columns_(other.columns_) {}
    Block& operator=(const Block& other);
    Block& operator=(Block&& other) noexcept;
    ~Block() {
      if (count_ > few) delete[] is_.many;
    }

    std::span<const double> numbers() const { return {count_ > few ? is_.many : is_.own.data(), count_}; }
    std::size_t columns() const { return columns_; }
    std::size_t size() const { return columns_ > 0 ? count_ / columns_ : count_; }
    std::span<const double> row(std::size_t i) const { return numbers().subspan(i * columns_, columns_); }
    void insert(std::size_t at, double number);

   private:
    static constexpr std::size_t few = 4;

    double* data() { return count_ > few ? is_.many : is_.own.data(); }

    union {
      std::array<double, few> own;
      double* many;
    } is_ = {};
    std::size_t count_ = 0, columns_ = 0;
  };

  /// A number kept as it was written, for `id`.
  struct Written {
    std::string text;
  };

  /// @name Of what it is made from
  /// @{
  Value() = default;
  static Value map();
  static Value list();
  static Value list(std::initializer_list<Value> items);
  Value(bool value) : kind_(Kind::boolean) { is_.plain.boolean = value; }
  Value(double value) : kind_(Kind::number) { is_.plain.number = value; }
  template <class Whole>
  requires std::is_integral_v<Whole> &&(!std::is_same_v<Whole, bool>)Value(Whole value)
      : Value(whole(static_cast<std::int64_t>(value))) {}
  Value(std::string value);
  Value(std::string_view value);
  Value(const char* value);
  Value(Written value);
  Value(List value);
  Value(Block value);
  template <class Numbers>  // a span, vector or array of doubles
  requires std::convertible_to<const Numbers&, std::span<const double>> Value(const Numbers& numbers)
      : Value(std::span<const double>(numbers), 0) {}
  Value(std::span<const int> whole_numbers);
  Value(std::initializer_list<double> numbers);
  Value(const MatrixView& matrix);
  Value(std::span<const double> numbers, std::size_t columns);  ///< row by row
  template <int size, int options>
  Value(const Eigen::Matrix<double, size, 1, options>& vector)
      : Value(std::span<const double>(vector.data(), static_cast<std::size_t>(size)), 0) {}
  Value(std::initializer_list<Entry> members);

  Value(const Value& other);
  Value(Value&& other) noexcept { take(other); }
  Value& operator=(const Value& other) { return *this = Value(other); }
  Value& operator=(Value&& other) noexcept {
    if (this == &other) return *this;
    clear();
    take(other);
    return *this;
  }
  ~Value() { clear(); }
  /// @}

  /// @name What it is
  /// @{
  bool is_null() const { return kind_ == Kind::null; }
  const bool* boolean() const;
  const std::string* text() const;
  const List* items() const;
  const Block* block() const;
  const Map* members() const;
  std::optional<double> number() const;  ///< also of a whole number
  bool is_list() const { return items() || block(); }
  /// Of a list or a map.
  std::size_t size() const;
  /// @}

  /// @name Maps
  /// @{
  Value& operator[](Key key);  ///< added where it is missing; a null becomes a map
  Value& add(Key key);         ///< at the end of a map that has no such member
  Value* find(std::string_view name);
  const Value* find(std::string_view name) const { return const_cast<Value*>(this)->find(name); }
  bool contains(std::string_view name) const { return find(name) != nullptr; }
  std::string_view text_at(std::string_view name) const;  ///< empty where there is no such text
  void erase(std::string_view name);
  void merge(Value&& other);  ///< all members of another map, which replace those of their names
  /// @}

  /// @name Lists
  /// @{
  /// A null becomes a list; a block of numbers takes a number.
  void push_back(Value value);
  Value& back();
  Value& operator[](std::size_t i);
  void push_front(double number);  ///< of a block
  /// @}

  /// On one line, as JSON has it. A number reads back to the same double; one that is none is null.
  std::string json() const;
  void append_json(std::string& text) const;
  /// The tree that reading that gives.
  Node node() const;
  /// Calls `use` with what it is.
  template <class Use>
  decltype(auto) visit(Use&& use) const;

 private:
  /// What lies in the value itself comes first: it is copied, and there is nothing to give back. Of a tree of
  /// numbers these are most, and a move or an end of each is then seen without a call.
  enum class Kind : unsigned char { null, boolean, whole, number, text, written, block, list, map };
  union Plain {
    bool boolean;
    std::int64_t whole = 0;
    double number;
  };
  union Content {
    Content() : plain() {}
    ~Content() {}
    Plain plain;
    std::string text;
    Written written;
    Block block;
    List list;
    Map map;
  };

  static Value whole(std::int64_t value) {
    Value made;
    made.kind_ = Kind::whole;
    made.is_.plain.whole = value;
    return made;
  }
  bool is_plain() const { return kind_ < Kind::text; }
  /// Of a null.
  void take(Value& other) noexcept {
    kind_ = other.kind_;
    if (is_plain())
      is_.plain = other.is_.plain;
    else
      take_content(other);
  }
  void clear() noexcept {
    if (!is_plain()) end_content();
    kind_ = Kind::null;
  }
  void take_content(Value& other) noexcept;
  void end_content() noexcept;
  Map& begin_map(std::size_t room);
  /// The content, which must be of that kind.
  template <class Of>
  Of& own(Of& content, Kind kind) const {
    if (kind_ != kind) throw std::logic_error("an answer is not of this kind");
    return content;
  }

  Kind kind_ = Kind::null;
  Content is_;
};

struct Value::Member {
  std::string_view name;
  Value value = {};
  explicit Member(std::string_view key) : name(key) {}
  Member(std::string_view key, Value&& of) : name(key), value(std::move(of)) {}
};

template <class Use>
decltype(auto) Value::visit(Use&& use) const {
  switch (kind_) {
    case Kind::null:
      break;
    case Kind::boolean:
      return use(is_.plain.boolean);
    case Kind::whole:
      return use(is_.plain.whole);
    case Kind::number:
      return use(is_.plain.number);
    case Kind::text:
      return use(is_.text);
    case Kind::written:
      return use(is_.written);
    case Kind::block:
      return use(is_.block);
    case Kind::list:
      return use(is_.list);
    case Kind::map:
      return use(is_.map);
  }
  return use(nullptr);
}

/// What a map is written with: `{{"x", 1.0}, {"y", 2.0}}`.
struct Value::Entry {
  Key key;
  mutable Value value;  ///< moved into the map, which an initializer list forbids otherwise
  template <class T>
  Entry(Key name, T&& of) : key(name),
                            value(std::forward<T>(of)) {}
  Entry(Key name, std::initializer_list<double> numbers) : key(name), value(numbers) {}
  Entry(Key name, std::initializer_list<Entry> members) : key(name), value(members) {}
};

}  // namespace sinew::inline v1
