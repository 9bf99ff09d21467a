// This unit reads the accuracy index of SSR messages.
#pragma once
#include <cstdint>
#include <optional>

namespace leonav {

// Returns the user range accuracy, 1 sigma in m, of an index of class and value (3 bits each):
//   3^class (1 + value/4) - 1 mm.
// nullopt for 0, which says nothing, and for 63, which says that it is larger than 5.4665 m.
// Source: RTCM 10403.3, DF389; IGS SSR v1.00, IDF034.
std::optional<double> ssr_accuracy_m(std::uint8_t index);

// The index by which a service tells that a satellite is not to be relied on.
inline constexpr std::uint8_t kWorstSsrAccuracy = 63;

}  // namespace leonav
