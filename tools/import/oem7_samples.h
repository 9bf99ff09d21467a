// The Oem7Samples are what the counts of a SPAN system's inertial sensor become, in a log as on the
// wire.
#pragma once
#include <optional>
#include <string>

#include "drivers/oem7/raw_imu.h"
#include "tools/connect/stamps/imu_sampler.h"

namespace leonav {

class Oem7Samples {
 public:
  // The increments cover the time since those before; see ImuSampler for gaps and for what is left
  // out.
  std::optional<ImuSample> take(const RawImuIncrements& increments);
  const ImuSamplerCounters& counters() const { return sampler_.counters(); }

 private:
  ImuSampler sampler_;
};

// Returns why a sensor gives no samples although its messages come, with the remedy, where the
// reason is its scale; empty otherwise.
std::string problem_of_scale(const RawImuCounters& counters);

}  // namespace leonav
