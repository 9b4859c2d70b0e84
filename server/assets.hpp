/// @file assets.hpp
/// The page's files, as they stand in the program.
#pragma once
#include <span>
#include <string_view>

namespace sinew::server {

struct Asset {
  std::string_view path;  ///< `/app.js`
  std::string_view type;  ///< its media type
  std::string_view bytes;
  std::string_view gzip;  ///< the same, compressed; empty: not kept
};

/// The viewer's files. Without the viewer one page that says how to get it.
std::span<const Asset> assets();

}  // namespace sinew::server
