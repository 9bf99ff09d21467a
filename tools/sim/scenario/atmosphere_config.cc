#include "tools/sim/scenario/atmosphere_config.h"
#include "core/base/angle.h"

namespace leonav::sim {
void read_atmosphere(ConfigReader& group, AtmosphereConfig* a) {
  constexpr Bounds kGradient_mm = {-20.0, 20.0}, kGradient_tecu = {-100.0, 100.0};
  group.number("wet_offset_m", {-0.5, 0.5}, &a->wet_offset_m);
  group.number("wet_walk_m_per_sqrt_h", {0.0, 1.0}, &a->wet_walk_m_per_sqrt_s, 1.0 / 60.0);
  group.number("wet_gradient_north_mm", kGradient_mm, &a->wet_gradient_north_m, 1e-3);
  group.number("wet_gradient_east_mm", kGradient_mm, &a->wet_gradient_east_m, 1e-3);
  group.number("tecu", {0.0, 500.0}, &a->tecu);
  group.number("night_share", {0.0, 1.0}, &a->night_share);
  group.number("gradient_north_tecu_per_100km", kGradient_tecu, &a->gradient_north_tecu_per_km,
               0.01);
  group.number("gradient_east_tecu_per_100km", kGradient_tecu, &a->gradient_east_tecu_per_km, 0.01);
  group.number("wave_tecu", {0.0, 50.0}, &a->wave_tecu);
  group.number("wave_length_km", {10.0, 5000.0}, &a->wave_length_m, 1e3);
  group.number("wave_period_s", {60.0, 86'400.0}, &a->wave_period_s);
  group.number("wave_azimuth_deg", {-360.0, 360.0}, &a->wave_azimuth, kDegree);
  group.number("scintillation_tecu", {0.0, 5.0}, &a->scintillation_tecu);
  group.number("scintillation_db", {0.0, 20.0}, &a->scintillation_db);
  group.number("scintillation_time_s", {0.2, 100.0}, &a->scintillation_time_s);
}

void remove_unmodelled(AtmosphereConfig* a) {
  a->wet_gradient_north_m = a->wet_gradient_east_m = 0.0;
  a->scintillation_tecu = a->scintillation_db = 0.0;
}

}  // namespace leonav::sim
