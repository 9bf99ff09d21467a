// The UbxSamples are what the readings of a u-blox receiver's inertial sensor become in a file,
// which has no arrivals.
#pragma once
#include <cstdint>
#include <optional>

#include "core/inertial/strapdown/imu.h"
#include "drivers/ubx/esf_reading.h"
#include "tools/connect/stamps/gps_clock.h"
#include "tools/connect/stamps/imu_sampler.h"
#include "tools/connect/stamps/imu_stamper.h"

namespace leonav {

// Returns the reading as the stamper takes it, in the sensor's axes.
ImuReading imu_reading(const EsfReading& reading, std::int64_t arrival_ns);

// Readings are stamped as leonav-connect stamps them, by the line through arrivals. For arrivals
// stands the order in the file: an epoch was written between the inertial messages before and
// behind it, and is taken to be in the middle of them. The line is therefore off by less than half
// of the time between two such messages.
class UbxSamples {
 public:
  // `gnss_latency_s`: an epoch is written so long after its time.
  explicit UbxSamples(double gnss_latency_s)
      : gps_(TimeReference::kGnss, gnss_latency_s), stamper_(&gps_, {}) {}

  void on_epoch(GpsTime time);
  // nullopt: not known yet (the first seconds), or left out and counted.
  std::optional<ImuSample> take(const EsfReading& reading);

  const ImuSamplerCounters& counters() const { return sampler_.counters(); }
  std::uint64_t before_tie() const { return before_tie_; }  // readings without a stamp yet
  std::uint64_t contradictions() const { return stamper_.contradictions(); }
  // By how much stamps may be off: half of the mean time between the inertial messages before and
  // behind an epoch.
  double uncertainty_s() const;

 private:
  GpsClock gps_;
  ImuStamper stamper_;
  ImuSampler sampler_;
  GpsTime last_epoch_;
  std::optional<std::int64_t> last_sent_ns_;       // of the last message
  std::optional<std::int64_t> sent_before_ns_;     // of the last one before the epoch
  std::optional<std::int64_t> clock_at_epoch_ns_;  // the sensor's, in the middle of its neighbours
  double apart_s_ = 0.0;                           // sum over epochs, of the neighbours
  std::uint64_t epochs_ = 0;
  std::uint64_t before_tie_ = 0;
};

}  // namespace leonav
