/// @file head.hpp
/// The head of a request, read strictly. Where a request ends is decided here alone: whatever could be read
/// in two ways (two lengths, a coding, a bare line feed) is refused, so that no part of a body is ever taken
/// for a request.
#pragma once
#include <cstddef>
#include <string_view>
#include <tl/expected.hpp>

#include "server/reply.hpp"

namespace sinew::server {

/// [bytes] of a request line and all header lines.
inline constexpr std::size_t max_head = std::size_t{16} << 10U;

struct Head {
  std::size_t body = 0;  ///< [bytes] that follow
  std::string_view
      range;  ///< the line that asks for parts, which nobody gets: a thousand may be asked for at once
};

/// @param text up to the empty line, which is its end
tl::expected<Head, Reply> read_head(std::string_view text);

}  // namespace sinew::server
