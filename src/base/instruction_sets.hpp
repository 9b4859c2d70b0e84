/// @file instruction_sets.hpp
/// The instruction sets that lanes are compiled for. Comes before Highway's headers.
#pragma once

// SSSE3 is what every x86-64 of the last fifteen years has; what lies between is not worth its compile time.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL | SINEW_ALSO_DISABLED_TARGETS)

// Where a processor has none of these, one number at a time: emulated lanes of two take clang minutes. With
// GCC 12 Highway does so by itself.
#define HWY_BROKEN_EMU128 1

// Instrumented, each set takes a minute to compile: one of narrow lanes and one of wide lanes is left.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SINEW_ALSO_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3)
#else
#define SINEW_ALSO_DISABLED_TARGETS 0
#endif
