/// @file draw.hpp
/// Random numbers of a seed.
#pragma once
#include <cstdint>

namespace sinew::inline v1 {

/// Numbers in [0, 1) by splitmix64: the same with every standard library, and on every thread.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}
  double between(double low, double high) {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return low + (high - low) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace sinew::inline v1
