/// @file uniform.hpp
/// A number drawn between two bounds.
#pragma once
#include <random>

namespace sinew::test {

inline double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

}  // namespace sinew::test
