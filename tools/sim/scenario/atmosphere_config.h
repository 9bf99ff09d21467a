// The troposphere and ionosphere of a scenario.
#pragma once

#include "daemon/config/config_reader.h"

namespace leonav::sim {

struct AtmosphereConfig {
  double wet_walk_m_per_sqrt_s = 5e-5;
  double wet_offset_m = 0.05;
  double tecu = 20.0;  // vertical, at the origin
  double tec_gradient_per_km = 0.01;
};

void read_atmosphere(ConfigReader& group, AtmosphereConfig* atmosphere);

}  // namespace leonav::sim
