/// @file limb_state.hpp
/// A state of limbs to return to: bytes that only the group that wrote them reads.
#pragma once
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace sinew::inline v0 {

/// A copy onto another state of the same robot does not allocate.
class LimbState {
 public:
  /// Begins anew; memory stays.
  void clear() { bytes_.clear(); }
  template <class T>
  void put(std::span<const T> values) {
    static_assert(is_plain<T>);
    const auto* from = reinterpret_cast<const std::byte*>(values.data());
    bytes_.insert(bytes_.end(), from, from + values.size_bytes());
  }
  template <class T>
  void put(const T& value) {
    put(std::span<const T>(&value, 1));
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

   private:
    const std::byte* next_;
  };

 private:
  /// Numbers without owner: a fixed matrix of Eigen's is one, though it copies by a function of its own.
  template <class T>
  static constexpr bool is_plain = std::is_trivially_destructible_v<T>;

  std::vector<std::byte> bytes_;
};

}  // namespace sinew::inline v0
