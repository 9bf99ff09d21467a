// This unit chooses the carriers of a satellite that are tracked.
#pragma once
#include <span>

#include "core/gnss/preprocessing/signal_selection.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// The two signals whose carriers form an arc.
struct CarrierPairCodes {
  SignalCode first, second;
};

// The carriers of one satellite at one epoch.
struct CarrierChoice {
  const SignalObservation* first = nullptr;   // nullptr: none at this epoch
  const SignalObservation* second = nullptr;  // nullptr: one frequency
};

// Chooses the carriers of the signals whose codes are used, or of another signal on their bands
// that has a carrier. A satellite with a pair of codes gives a pair of carriers or none, since a
// single one has another ambiguity. For the same reason the tracked pair (`tracked`, or nullptr) is
// kept: its carriers are taken whether their codes are present or not, and none while one of them
// is missing or below the C/N0 mask.
CarrierChoice choose_carriers(std::span<const SignalObservation> observations,
                              const SelectedSignals& signals, double cn0_mask_dbhz,
                              const CarrierPairCodes* tracked);

}  // namespace leonav
