// This unit names the satellites and signals that PPP-B2b messages speak of by number.
#pragma once
#include <cstdint>
#include <optional>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

inline constexpr std::uint32_t kB2bSlots = 174;  // in a mask: the numbers 1 to 174

// Returns the satellite of a slot: 1 to 63 BeiDou, 64 to 100 GPS, 101 to 137 Galileo. nullopt for
// GLONASS (138 to 174), which leonav does not use, and for reserved numbers. Source:
// BDS-SIS-ICD-PPP-B2b-1.0, table 6-4.
std::optional<SatelliteId> satellite_from_b2b(std::uint32_t slot);

// Returns the signal of a mode of tracking (0 to 15); nullopt where it is reserved. B2b's in-phase
// part is RINEX 7D, its quadrature 7P. Source: BDS-SIS-ICD-PPP-B2b-1.0, table 6-8.
std::optional<SignalCode> signal_from_b2b(System system, std::uint32_t mode);

}  // namespace leonav
