// This unit gives the group delays of the satellites' signals relative to their clocks.
#pragma once
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/signals/signal.h"

namespace leonav::sim {

// Hardware delays of a satellite as its message gives them (Ephemeris::group_delay_s), m.
using BroadcastDelays = std::array<double, 2>;

// Returns the delay to ADD to the pseudorange, m.
//
// The true clocks refer to the pair of each system's precise products (GPS L1/L2, Galileo E1/E5a,
// BeiDou B1I/B3I), so that the ionosphere-free code of this pair has no delay. IS-GPS-200
// 20.3.3.3.3.2, Galileo OS-SIS-ICD 5.1.5, BDS-SIS-ICD-B1I 5.2.4.10. A signal whose delay no message
// gives has that of the nearest carrier that has one; LEO satellites have none.
double signal_delay_m(System system, const BroadcastDelays& delays, char band);

// Returns how much the clock of a broadcast message is behind the true one, m: the delay of the
// signal, or pair, that this clock refers to.
double broadcast_reference_m(NavigationMessage message, const BroadcastDelays& delays);

}  // namespace leonav::sim
