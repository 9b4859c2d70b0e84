/// @file assert.hpp
/// Preconditions of a caller in C++ (bad data from outside is an Error, not an assertion).
#pragma once
#include <cassert>

#define SINEW_EXPECTS(condition) assert(condition)
