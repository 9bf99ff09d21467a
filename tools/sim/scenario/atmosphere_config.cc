#include "tools/sim/scenario/atmosphere_config.h"

namespace leonav::sim {

void read_atmosphere(ConfigReader& group, AtmosphereConfig* atmosphere) {
  group.number("wet_offset_m", {-0.5, 0.5}, &atmosphere->wet_offset_m);
  group.number("wet_walk_m_per_sqrt_h", {0.0, 1.0}, &atmosphere->wet_walk_m_per_sqrt_s, 1.0 / 60.0);
  group.number("tecu", {0.0, 500.0}, &atmosphere->tecu);
  group.number("tec_gradient_per_km", {-0.1, 0.1}, &atmosphere->tec_gradient_per_km);
}

}  // namespace leonav::sim
