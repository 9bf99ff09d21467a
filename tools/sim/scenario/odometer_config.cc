#include "tools/sim/scenario/odometer_config.h"

namespace leonav::sim {

void read_odometer(ConfigReader& group, OdometerConfig* odometer) {
  constexpr double kPercent = 0.01;
  group.number("rate_hz", {0.0, 100.0}, &odometer->rate_hz);
  if (odometer->rate_hz > 0.0 && odometer->rate_hz < 1.0)
    group.report("rate_hz", "must be 0 (none) or at least 1: an increment lasts a second at most");
  group.number("latency_s", {0.0, 1.0}, &odometer->latency_s);
  group.number("scale_error_percent", {-50.0, 50.0}, &odometer->scale_error, kPercent);
  group.number("resolution_m", {1e-4, 10.0}, &odometer->resolution_m);
  group.boolean("signed", &odometer->signed_pulses);
  group.number("slip_percent_per_m_s2", {-50.0, 50.0}, &odometer->slip_per_acceleration, kPercent);
  group.number("lock_braking_m_s2", {0.1, 1000.0}, &odometer->lock_braking_m_s2);
  group.vector("point_b_m", {-100.0, 100.0}, &odometer->point_b);
}

}  // namespace leonav::sim
