/// @file assert.hpp
/// Preconditions of a caller in C++ (bad data from outside is an Error, not an assertion).
#pragma once
#include <cassert>

/// What a caller in C++ has to see to; checked where NDEBUG is not defined.
#define SINEW_EXPECTS(condition) assert(condition)
