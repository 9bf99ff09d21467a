// An odometer's increments in order of time, on their way to the epochs they go with.
#pragma once
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/ins/odometer.h"
#include "core/navigator/outputs.h"
#include "core/navigator/time_base_watch.h"

namespace leonav {

// Increments must be finite, in range and increasing, and not more than kMaxAheadNs ahead of the
// IMU; a run of consistent ones behind is a counter that was started anew. Those that end by an
// epoch go with it, also when they come up to kMaxLatencyNs after it: then with the next one. What
// comes later still is counted and dropped. Allocates when constructed, not after.
class OdometerQueue {
 public:
  static constexpr std::int64_t kMaxIntervalNs = 1'000'000'000;
  static constexpr std::int64_t kMaxLatencyNs = 400'000'000;
  static constexpr std::int64_t kMaxAheadNs = 2'000'000'000;
  static constexpr double kMaxSpeed = 150.0;  // m/s
  static constexpr int kRunToRestart = 5;

  // `used`: somebody takes them; else they are judged and go nowhere.
  explicit OdometerQueue(bool used) : used_(used), waiting_(kMaxOdometerBlock) {}

  // `imu_time`, `last_epoch`: as far as both have come; may be unset. kNone: accepted.
  InputFault add(const OdometerIncrement& increment, GpsTime imu_time, GpsTime last_epoch);
  // Those that end by `time`, behind what is in the block.
  void hand_over(GpsTime time, OdometerBlock* block);
  void clear();
  GpsTime last_time() const { return last_; }   // of those accepted; may be unset
  std::uint64_t late() const { return late_; }  // accepted, and dropped

 private:
  InputFault place(const OdometerIncrement& increment, GpsTime last_epoch);

  bool used_;
  boost::circular_buffer<OdometerIncrement> waiting_;
  TimeBaseWatch watch_{kRunToRestart, kMaxIntervalNs};
  GpsTime last_;
  std::uint64_t late_ = 0;
};

}  // namespace leonav
