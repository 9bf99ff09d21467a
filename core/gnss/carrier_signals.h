// Which carriers of a satellite are followed.
#pragma once
#include <span>

#include "core/gnss/observation.h"
#include "core/gnss/signal_selection.h"

namespace leonav {

// The two signals whose carriers make up an arc.
struct CarrierPairCodes {
  SignalCode first, second;
};

struct CarrierChoice {
  const SignalObservation* first = nullptr;   // nullptr: none at this epoch
  const SignalObservation* second = nullptr;  // nullptr: one frequency
};

// Carriers of the signals whose codes are used, or of another signal on their bands that has one. A
// satellite with a pair of codes gives a pair of carriers or none: one alone would be another
// ambiguity. For the same reason a pair that is being followed (`followed`, or nullptr) is kept to:
// its carriers are taken whether their codes are there or not, and while one of them is missing or
// below the C/N0 mask, none.
CarrierChoice choose_carriers(std::span<const SignalObservation> observations,
                              const SelectedSignals& signals, double cn0_mask_dbhz,
                              const CarrierPairCodes* followed);

}  // namespace leonav
