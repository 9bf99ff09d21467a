// This unit maps the u-blox numbers of systems and signals to leonav's types.
#pragma once
#include <cstdint>
#include <optional>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// Returns the system of a gnssId, or nullopt for those that leonav does not use (SBAS, IMES, QZSS,
// GLONASS, NavIC).
std::optional<System> system_from_ubx(std::uint8_t gnss_id);

// Returns the RINEX 3.04 code of a sigId. u-blox tracks one component of each signal (data or
// pilot) and identifies it, so the code names that component: GPS L2CL is "2L", not "2X" as
// RTKLIB's convbin writes. Source: UBX-22008968 section 1.5.4; sigId 4, 7-10 of Galileo and BeiDou
// from the X20 edition.
std::optional<SignalCode> signal_from_ubx(System system, std::uint8_t signal_id);

}  // namespace leonav
