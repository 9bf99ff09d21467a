// This unit gives the C/N0 of every signal and the noise at that C/N0.
#pragma once
#include "core/gnss/signals/satellite.h"
#include "tools/sim/scenario/receiver_config.h"

namespace leonav::sim {

// Returns the loss of antenna and path relative to the zenith, dB: horizon_loss_db at the horizon,
// and steeply less above.
double elevation_loss_db(const Cn0Config& config, double elevation);

// Returns the C/N0 of signal 0 or 1 of a system in the zenith, dB-Hz.
double zenith_cn0_dbhz(const Cn0Config& config, System system, std::size_t signal);

// Returns the noise of code, carrier and Doppler relative to that in the zenith.
//
// Thermal noise of all three loops is proportional to the square root of the inverse C/N0 (Kaplan
// and Hegarty, Understanding GPS/GNSS, 3rd ed., 8.9; the squaring loss below 25 dB-Hz is not
// modelled).
double noise_factor(double loss_db);

}  // namespace leonav::sim
