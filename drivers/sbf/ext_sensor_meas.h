// This unit reads ExtSensorMeas (4050), measurements of an inertial sensor in or at the receiver.
// Source: AsteRx SBi3 Pro+ Reference Guide, ExtSensorMeas.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/gps_time.h"

namespace leonav {

// Angular rate and specific force at `time`, in the axes that the receiver gives them in: x
// forward, y right, z down, where the sensor is mounted as its marks show. At rest the specific
// force is about -9.8 m/s^2 along down.
struct ExtSensorRates {
  using Vector = std::array<double, 3>;
  GpsTime time;
  Vector angular_rate_rad_s{};
  Vector specific_force_m_s2{};
};

// Counts of blocks.
struct ExtSensorCounters {
  std::uint64_t samples = 0;
  std::uint64_t bad_length = 0;
  std::uint64_t without_time = 0;    // the receiver did not know the time
  std::uint64_t without_motion = 0;  // not both angular rate and acceleration of one sensor
  std::uint64_t bad_value = 0;       // not finite, or marked as not available
};

// A block holds the measurements of one instant, each in a sub-block of its own: acceleration,
// angular rate, and others, which are not used.
class ExtSensorReader {
 public:
  std::optional<ExtSensorRates> read(GpsTime time, std::span<const std::uint8_t> payload);
  const ExtSensorCounters& counters() const { return counters_; }

 private:
  ExtSensorCounters counters_;
};

}  // namespace leonav
