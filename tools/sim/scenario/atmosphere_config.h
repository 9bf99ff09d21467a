// AtmosphereConfig configures the troposphere and ionosphere of a scenario.
#pragma once

#include "daemon/config/config_reader.h"

namespace leonav::sim {

// Settings; the defaults are those of group `atmosphere`.
struct AtmosphereConfig {
  // Relative to a standard atmosphere.
  double wet_offset_m = 0.05;           // at zenith, at the start
  double wet_walk_m_per_sqrt_s = 5e-5;  // its random walk
  double wet_gradient_north_m = 0.0005, wet_gradient_east_m = -0.0003;

  double tecu = 20.0;         // vertical, over the origin at 14 h local solar time
  double night_share = 0.25;  // share that remains at 2 h
  double gradient_north_tecu_per_km = -0.005, gradient_east_tecu_per_km = 0.0;
  // A travelling ionospheric disturbance: a plane wave over the shell.
  double wave_tecu = 0.0, wave_length_m = 200e3, wave_period_s = 1200.0;
  double wave_azimuth = 3.141592653589793;  // rad, direction of propagation
  // Scintillation, independent for each satellite.
  double scintillation_tecu = 0.0, scintillation_db = 0.0, scintillation_time_s = 2.0;
};

void read_atmosphere(ConfigReader& group, AtmosphereConfig* atmosphere);

// Leaves only what a navigator models: the wet delay over the place, the ionosphere's first order.
void remove_unmodelled(AtmosphereConfig* atmosphere);

}  // namespace leonav::sim
