/// @file limb_state.hpp
/// A state of limbs to return to: bytes that only the group that wrote them reads.
#pragma once
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace sinew::inline v1 {

/// A copy onto another state of the same robot does not allocate.
class LimbState {
 public:
  /// Begins anew; memory stays. @param most bytes of any state of these limbs: room for all
  void clear(std::size_t most = 0) {
    if (bytes_.size() < most) bytes_.resize(most);
    size_ = 0;
  }
  template <class T>
  void put(std::span<const T> values) {
    static_assert(is_plain<T>);
    const std::size_t begin = size_;
    size_ += values.size_bytes();
    if (size_ > bytes_.size()) bytes_.resize(size_);
    std::memcpy(bytes_.data() + begin, values.data(), values.size_bytes());
  }
  template <class T>
  void put(const T& value) {
    put(std::span<const T>(&value, 1));
  }

  /// What was put last of all.
  template <class T>
  void get_last(std::span<T> values) const {
    std::memcpy(values.data(), bytes_.data() + size_ - values.size_bytes(), values.size_bytes());
  }

  /// Reads what was put, in that order.
  class Reader {
   public:
    explicit Reader(const LimbState& from) : next_(from.bytes_.data()) {}
    template <class T>
    void get(std::span<T> values) {
      static_assert(is_plain<T>);
      std::memcpy(static_cast<void*>(values.data()), next_, values.size_bytes());
      next_ += values.size_bytes();
    }
    template <class T>
    void get(T& value) {
      get(std::span<T>(&value, 1));
    }
    template <class T>
    T next() {
      T value;
      get(value);
      return value;
    }

   private:
    const std::byte* next_;
  };

 private:
  /// Numbers without owner: a fixed matrix of Eigen's is one, though it copies by a function of its own.
  template <class T>
  static constexpr bool is_plain = std::is_trivially_destructible_v<T>;

  std::vector<std::byte> bytes_;
  std::size_t size_ = 0;  ///< of what was put
};

}  // namespace sinew::inline v1
