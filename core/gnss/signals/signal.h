// This unit names signals by their RINEX 3 code (band and attribute: "1C", "2W", "5Q", "2I") and
// gives their carrier frequencies.
#pragma once
#include <compare>
#include <optional>
#include <string>
#include <string_view>

#include "core/gnss/signals/satellite.h"

namespace leonav {

inline constexpr double kSpeedOfLight = 299'792'458.0;  // m/s

// A signal's RINEX code without the kind of observation.
struct SignalCode {
  char band = 0;       // '1'..'9'
  char attribute = 0;  // 'A'..'Z'
  friend constexpr auto operator<=>(const SignalCode&, const SignalCode&) = default;
  constexpr bool is_set() const { return band != 0; }
};

std::optional<SignalCode> signal_from_string(std::string_view code);  // "1C"
std::string to_string(SignalCode code);

// Returns the carrier frequency in Hz of a system whose interface document fixes it, or 0 for a
// band that the system does not have. BeiDou bands are those of RINEX 3.04: 2 = B1I 1561.098 MHz, 1
// = B1C 1575.42, 5 = B2a 1176.45, 7 = B2I/B2b 1207.14, 6 = B3I 1268.52. LEO satellites have no
// fixed carriers, hence 0: ask BandPlan (band_plan.h) where they may occur.
double frequency_hz(System system, char band);
// Returns the wavelength in m of such a carrier, or 0.
double wavelength_m(System system, char band);

}  // namespace leonav
