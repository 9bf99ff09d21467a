// C/N0 of every signal, and the noise that comes with it.
#pragma once
#include "core/gnss/satellite.h"
#include "tools/sim/scenario/receiver_config.h"

namespace leonav::sim {

// dB below the zenith by antenna and path: horizon_loss_db at the horizon, steeply less above it.
double elevation_loss_db(const Cn0Config& config, double elevation);

// dB-Hz of signal 0 or 1 of a system in the zenith.
double zenith_cn0_dbhz(const Cn0Config& config, System system, std::size_t signal);

// Noise of code, carrier and Doppler against that in the zenith: thermal noise of all three loops
// goes by the square root of the inverse C/N0 (Kaplan and Hegarty, Understanding GPS/GNSS, 3rd ed.,
// 8.9; the squaring loss below 25 dB-Hz is not modelled).
double noise_factor(double loss_db);

}  // namespace leonav::sim
