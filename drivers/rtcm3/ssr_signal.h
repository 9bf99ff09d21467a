// This unit names the signals of SSR bias messages.
#pragma once
#include <cstdint>
#include <optional>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// Returns the RINEX code of a signal and tracking mode identifier (DF380, DF382, DF467, IDF024), or
// nullopt for a reserved one. RTCM and IGS agree where both define one. Source: RTCM
// 10403.3, 3.5.12; IGS SSR v1.00, table of IDF024.
std::optional<SignalCode> signal_from_ssr(System system, std::uint32_t identifier);

}  // namespace leonav
