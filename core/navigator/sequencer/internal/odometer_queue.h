// OdometerQueue keeps odometer increments in order of time until the epoch that they go with.
#pragma once
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/inertial/strapdown/odometer.h"
#include "core/navigator/interface/input_fault.h"
#include "core/navigator/sequencer/internal/time_step_monitor.h"

namespace leonav {

// Increments must be finite, in range and increasing, and not more than kMaxAheadNs ahead of the
// IMU. A run of consistent ones with earlier stamps means that the counter was restarted. An
// increment goes with the first epoch not earlier than its end. If that epoch was issued already,
// it goes with the next one, but an increment that ends more than kMaxLatencyNs before the last
// issued epoch is counted and dropped. Allocates when constructed, not after.
class OdometerQueue {
 public:
  static constexpr std::int64_t kMaxIntervalNs = 1'000'000'000;
  static constexpr std::int64_t kMaxLatencyNs = 400'000'000;
  static constexpr std::int64_t kMaxAheadNs = 2'000'000'000;
  static constexpr double kMaxSpeed = 150.0;  // m/s
  static constexpr int kRunToRestart = 5;     // increments that must agree on an earlier time

  // `used` states whether increments are queued; otherwise they are only checked.
  explicit OdometerQueue(bool used) : used_(used), waiting_(kMaxOdometerBlock) {}

  // Adds an increment and returns its fault; kNone: it is accepted. `imu_time` is the time of the
  // newest IMU sample, `last_epoch` that of the last issued epoch; both may be unset.
  InputFault add(const OdometerIncrement& increment, GpsTime imu_time, GpsTime last_epoch);
  // Moves the increments that end by `time` to the end of the block.
  void move_to_block(GpsTime time, OdometerBlock* block);
  void clear();
  // Returns the end of the last accepted increment; may be unset.
  GpsTime last_time() const { return last_; }
  // Returns how many increments were accepted but dropped as late.
  std::uint64_t late() const { return late_; }

 private:
  InputFault place(const OdometerIncrement& increment, GpsTime last_epoch);

  bool used_;
  boost::circular_buffer<OdometerIncrement> waiting_;
  TimeStepMonitor time_monitor_{kRunToRestart, kMaxIntervalNs};
  GpsTime last_;
  std::uint64_t late_ = 0;
};

}  // namespace leonav
