/// @file secret.hpp
#pragma once
#include <string>

namespace sinew::server {

/// 128 bits that nobody can guess, as 32 hexadecimal digits.
std::string make_secret();

}  // namespace sinew::server
