// From measured carriers to a range that the model with an ambiguity fits.
#pragma once
#include "core/gnss/carrier_arcs.h"
#include "core/gnss/code_correction.h"

namespace leonav {

// Carrier of one signal, or (`second` given) of the ionosphere-free pair, less what lies between it
// and the geometric range, as code_measurement() does for codes. `status` has the carriers in
// metres and the arc. A single carrier keeps what the model leaves of the ionosphere, which drifts:
// its `wander` says how fast.
Measurement carrier_measurement(const DelayContext& context, const SignalObservation& first,
                                const SignalObservation* second, const CarrierStatus& status,
                                const SatelliteInView& satellite);

}  // namespace leonav
