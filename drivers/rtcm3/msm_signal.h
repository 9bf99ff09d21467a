// This unit names the signals of the multiple signal messages.
#pragma once
#include <cstdint>
#include <optional>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// Returns the RINEX code of a bit of the signal mask (1 to 32), or nullopt for a reserved one.
// Source: RTCM 10403.3, tables 3.5-91 (GPS), 3.5-99 (Galileo), 3.5-108 (BeiDou); BeiDou's B2a, B2b
// and B1C as in 10403.4. B1I is band 2, as everywhere here.
std::optional<SignalCode> signal_from_msm(System system, std::uint8_t signal_id);

}  // namespace leonav
