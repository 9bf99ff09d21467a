// This unit corrects measured carriers to the range of the model with an ambiguity.
#pragma once
#include "core/gnss/cycle_slips/carrier_arcs.h"
#include "core/gnss/preprocessing/internal/code_correction.h"

namespace leonav {

// Corrects the carrier of one signal or, with `second`, of the ionosphere-free pair, for all delays
// between it and the geometric range, as code_measurement() does for codes. `status` has the
// carriers in metres and the arc. A single carrier keeps the error of the ionosphere model, which
// drifts; its `random_walk` contains that. The antenna correction applied is stored in `satellite`.
Measurement carrier_measurement(const DelayContext& context, const SignalObservation& first,
                                const SignalObservation* second, const CarrierStatus& status,
                                SatelliteInView* satellite);

// Returns by how much (m) `to` makes a carrier longer against its range than `from` at `time`: the
// step of an arc's constant where one set of broadcast elements replaces another.
double orbit_step_m(const Ephemeris& from, const Ephemeris& to, GpsTime time,
                    const Eigen::Vector3d& p_a_e);

// Returns 1 sigma (m) of a carrier's change over `dt` seconds beside noise and motion: the
// satellite's clock, on one frequency the ionosphere, and for a LEO satellite the error of a
// broadcast orbit, over which the line of sight from `p_a_e` (ECEF, m) turns.
double change_sigma_m(const CycleSlipConfig& config, const BandPlan& bands,
                      const SatelliteInView& satellite, const Measurement& carrier,
                      const Eigen::Vector3d& p_a_e, double dt);

}  // namespace leonav
