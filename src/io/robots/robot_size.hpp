/// @file robot_size.hpp
#pragma once
#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"

namespace sinew::inline v1 {

/// Whether a document is no larger than that of a robot can be. Code: `too_large`.
Expected<void> check_size(const Document& document);

}  // namespace sinew::inline v1
