// Whether the tests run under the address sanitizer, several times slower.
#pragma once

namespace sardf {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool is_sanitized = true;
#elif defined(__has_feature)
inline constexpr bool is_sanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool is_sanitized = false;
#endif

/// Seconds within which long work stops when it is cancelled.
inline constexpr double at_once = is_sanitized ? 1 : 0.1;

}  // namespace sardf
