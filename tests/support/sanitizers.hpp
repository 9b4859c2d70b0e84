/// @file sanitizers.hpp
/// What the library and its tests are built with.
#pragma once

namespace sinew::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool addresses_are_checked = true;  ///< by AddressSanitizer
#else
inline constexpr bool addresses_are_checked = false;
#endif

#ifdef __SANITIZE_THREAD__
inline constexpr bool is_instrumented =
    true;  ///< by AddressSanitizer or ThreadSanitizer, and several times slower
#else
inline constexpr bool is_instrumented = addresses_are_checked;
#endif

#ifdef NDEBUG
inline constexpr bool is_asserted = false;
#else
inline constexpr bool is_asserted = true;  ///< ends where it meets what its callers are not to do
#endif

}  // namespace sinew::test
