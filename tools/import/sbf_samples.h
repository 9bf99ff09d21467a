// The SbfSamples are what the measurements of an inertial sensor at a Septentrio receiver become,
// in a log as on the wire.
#pragma once
#include <optional>

#include "drivers/sbf/ext_sensor_meas.h"
#include "tools/connect/stamps/imu_sampler.h"

namespace leonav {

class SbfSamples {
 public:
  // The rates count over the time since those before; see ImuSampler for gaps and for what is left
  // out.
  std::optional<ImuSample> take(const ExtSensorRates& rates);
  const ImuSamplerCounters& counters() const { return sampler_.counters(); }

 private:
  ImuSampler sampler_;
};

}  // namespace leonav
