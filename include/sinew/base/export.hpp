/// @file export.hpp
/// Version, symbol visibility and the inline namespace every public name lives in.
#pragma once

#define SINEW_VERSION_MAJOR 0         ///< grows where what was there changes
#define SINEW_VERSION_MINOR 1         ///< grows where something is added
#define SINEW_VERSION_PATCH 0         ///< grows where something is mended
#define SINEW_VERSION_STRING "0.1.0"  ///< of these headers

/// @def SINEW_API
/// Marks what libsinew.so exports: all that installed headers declare, and nothing else.
#ifdef __GNUC__
#define SINEW_API __attribute__((visibility("default")))
#else
#define SINEW_API
#endif

/// Mechanics of continuum robots. The inline namespace carries the ABI version: two incompatible sinews in
/// one program do not link silently.
namespace sinew::inline v1 {

/// Version of the library that is linked (the macros above give that of the headers).
SINEW_API const char* version() noexcept;

}  // namespace sinew::inline v1
