// This unit decodes a stream of VectorNav binary messages to inertial measurements with their
// times.
//
// Source: VN-200 and VN-300 user manuals (UM004, UM005), chapter "User Configurable Binary Output
// Messages", groups common, time and IMU.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/base/gps_time.h"
#include "drivers/vectornav/vectornav_framer.h"

namespace leonav {

// What one message holds of time and motion. Axes are the sensor's own: forward, right, down as
// marked on its housing. A field that is absent, or that the sensor marks as not valid, is empty.
struct VectornavMeasurement {
  using Vector = std::array<double, 3>;
  // Integrals over the `interval_s` that ends at the message's time, in the sensor's axes,
  // corrected for coning and sculling.
  struct Increments {
    double interval_s = 0.0;
    Vector delta_theta_rad{};
    Vector delta_velocity_m_s{};
  };
  // Angular rate and specific force at the message's time.
  struct Rates {
    Vector angular_rate_rad_s{};
    Vector specific_force_m_s2{};
  };

  std::optional<GpsTime> gps_time;              // TimeGps, or GpsWeek and GpsTow
  std::optional<GpsTime> utc_time;              // TimeUtc as GPS time, to its millisecond
  std::optional<std::uint64_t> startup_ns;      // TimeStartup: the sensor's clock since its start
  std::optional<std::uint64_t> since_pulse_ns;  // TimeSyncIn: since the last pulse on its input
  std::optional<std::uint32_t> pulses;          // SyncInCnt
  std::optional<Increments> increments;
  std::optional<Rates> rates;  // without the sensor's own bias correction where both are there
};

// The handler gets the measurements in the order of the stream.
class VectornavHandler {
 public:
  virtual ~VectornavHandler() = default;
  virtual void on_measurement(const VectornavMeasurement& measurement) = 0;
};

// Counts of all parts of the decoder.
struct VectornavCounters {
  VectornavFramerCounters framer;
  std::uint64_t measurements = 0;    // with increments or rates
  std::uint64_t without_motion = 0;  // framed, but without increments and without rates
  std::uint64_t bad_values = 0;  // increments or rates not finite or beyond any sensor: left out
};

// The decoder streams: chunks of any size, bounded memory.
class VectornavDecoder {
 public:
  void feed(std::span<const std::uint8_t> bytes, VectornavHandler* handler);
  // Ends the stream and decodes the bytes that a false sync near the end still holds back.
  void finish(VectornavHandler* handler);
  VectornavCounters counters() const;

 private:
  void drain(VectornavHandler* handler);

  VectornavFramer framer_;
  VectornavCounters counters_;
};

}  // namespace leonav
