/// @file instruction_sets.hpp
/// The instruction sets that lanes are compiled for, to be measured beside each other.
#pragma once
#include <hwy/targets.h>

#include <cstdint>

namespace sinew::bench {

struct InstructionSet {
  const char* name;
  std::int64_t target;

  bool is_there() const { return (hwy::SupportedTargets() & target) != 0; }
};
inline constexpr InstructionSet instruction_sets[] = {
    {"AVX-512", HWY_AVX3}, {"AVX2", HWY_AVX2}, {"SSSE3", HWY_SSSE3}};

}  // namespace sinew::bench
