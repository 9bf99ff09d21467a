#include "core/inertial/strapdown/imu.h"

namespace leonav {

ImuSplit split(const ImuSample& sample, GpsTime cut) {
  ImuSplit parts{sample, sample};
  parts.before.time = cut;
  parts.before.interval_ns = cut.nanoseconds() - sample.start().nanoseconds();
  parts.after.interval_ns = sample.interval_ns - parts.before.interval_ns;
  const double share =
      static_cast<double>(parts.before.interval_ns) / static_cast<double>(sample.interval_ns);
  parts.before.delta_theta_b = share * sample.delta_theta_b;
  parts.before.delta_velocity_b = share * sample.delta_velocity_b;
  parts.after.delta_theta_b = sample.delta_theta_b - parts.before.delta_theta_b;
  parts.after.delta_velocity_b = sample.delta_velocity_b - parts.before.delta_velocity_b;
  return parts;
}

}  // namespace leonav
