// From measured carriers to a range that the model with an ambiguity fits.
#pragma once
#include "core/gnss/carrier_arcs.h"
#include "core/gnss/code_correction.h"

namespace leonav {

// Carrier of one signal, or (`second` given) of the ionosphere-free pair, less what lies between it
// and the geometric range, as code_measurement() does for codes. `status` has the carriers in
// metres and the arc. A single carrier keeps what the model leaves of the ionosphere, which drifts:
// its `wander` says how fast. Tells `satellite` what antennas were applied.
Measurement carrier_measurement(const DelayContext& context, const SignalObservation& first,
                                const SignalObservation* second, const CarrierStatus& status,
                                SatelliteInView* satellite);

// How much `to` makes a carrier longer against its range than `from` would at `time`: the step of
// an arc's constant where one set of broadcast elements takes over from another. m.
double orbit_step_m(const Ephemeris& from, const Ephemeris& to, GpsTime time,
                    const Eigen::Vector3d& p_a_e);

// 1 sigma of what a carrier's change over `dt` seconds holds besides noise and motion: the
// satellite's clock, and on one frequency the ionosphere.
double change_sigma_m(const CycleSlipConfig& config, const SatelliteInView& satellite,
                      const Measurement& carrier, double dt);

}  // namespace leonav
