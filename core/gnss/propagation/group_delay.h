// This unit models satellite group delays (TGD, BGD) of single signals and of ionosphere-free
// pairs.
#pragma once
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// Delay by which this signal leaves the satellite later than the clock's reference signal, so that
//   corrected pseudorange = pseudorange + c * SatelliteState::clock_s - delay_m.
struct GroupDelay {
  double delay_m = 0.0;
  double sigma_m = 0.0;  // 1 sigma of delay_m; large where the message does not contain the delay
};

// Computes the delay relative to a broadcast clock, of the signal `first` alone or, with `second`,
// of the ionosphere-free combination (f1^2 P1 - f2^2 P2) / (f1^2 - f2^2). A band that the system
// does not have, or twice the same band, gives zero with kUnknownGroupDelaySigma. The clock of a
// LEO satellite is that of each of its signals, so that none has a delay.
GroupDelay group_delay(const Ephemeris& ephemeris, SignalCode first, SignalCode second = {});

// Computes the delay relative to a precise clock, which refers to the ionosphere-free pair of its
// product (GPS L1P/L2P, Galileo E1/E5a, BeiDou B1I/B3I, LEO: none, zero). `broadcast` gives the
// delays within the pair and may be nullptr: then only that pair itself is known.
GroupDelay precise_group_delay(System system, const Ephemeris* broadcast, SignalCode first,
                               SignalCode second = {});

inline constexpr double kUnknownGroupDelaySigma = 5.0;  // m

}  // namespace leonav
