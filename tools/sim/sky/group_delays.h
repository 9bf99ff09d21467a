// How much later each signal leaves a satellite than its clock says.
#pragma once
#include "core/gnss/ephemeris.h"
#include "core/gnss/signal.h"

namespace leonav::sim {

// What a satellite's hardware does, as its message tells it (Ephemeris::group_delay_s), m.
using BroadcastDelays = std::array<double, 2>;

// To ADD to the pseudorange, m. The true clocks refer to the pair of each system's precise products
// (GPS L1/L2, Galileo E1/E5a, BeiDou B1I/B3I), so that this pair's ionosphere-free code has none.
// IS-GPS-200 20.3.3.3.3.2, Galileo OS-SIS-ICD 5.1.5, BDS-SIS-ICD-B1I 5.2.4.10. Signals whose delay
// no message tells have that of the nearest carrier that one tells; LEO satellites have none.
double signal_delay_m(System system, const BroadcastDelays& delays, char band);

// By how much the clock of a broadcast message is behind the true one, m: the delay of the signal,
// or pair, which that clock refers to.
double broadcast_reference_m(NavigationMessage message, const BroadcastDelays& delays);

}  // namespace leonav::sim
