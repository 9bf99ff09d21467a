// This unit maps Septentrio's numbers of satellites and signals to leonav's types. Source:
// mosaic-X5 Reference Guide, "Satellite ID and GLONASS Frequency Number" and "Signal Type".
#pragma once
#include <cstdint>
#include <optional>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// Returns the satellite of a number ("SVID", "PRN"); nullopt for those of systems that leonav does
// not use (GLONASS, SBAS, QZSS, NavIC, L-band) and for numbers that no satellite has.
std::optional<SatelliteId> satellite_from_sbf(std::uint8_t number);

// A signal with its system.
struct SbfSignal {
  System system = System::kGps;
  SignalCode code;
};

// Returns the signal of a number, with its RINEX 3.04 code; nullopt for reserved numbers and other
// systems. `e6_is_b`: Galileo's E6 is tracked by its data component, which MeasEpoch says in a flag
// of its own.
std::optional<SbfSignal> signal_from_sbf(std::uint32_t number, bool e6_is_b);

// The field of 5 bits that names a signal says by 31 that the number is in an extension, less 32.
inline constexpr std::uint32_t kExtendedSignal = 31;
constexpr std::uint32_t sbf_signal_number(std::uint32_t low, std::uint32_t extension) {
  return low == kExtendedSignal ? extension + 32 : low;
}

}  // namespace leonav
