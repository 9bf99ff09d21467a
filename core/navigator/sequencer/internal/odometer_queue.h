// The OdometerQueue keeps odometer increments in order of time until the epoch that they go with.
#pragma once
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/inertial/strapdown/odometer.h"
#include "core/navigator/interface/input_fault.h"
#include "core/navigator/sequencer/internal/time_step_monitor.h"

namespace leonav {

// Increments must be finite, in range and increasing, and not more than kMaxAheadNs ahead of the
// IMU. A run of consistent ones behind is a counter that was restarted. An increment goes with the
// first epoch not earlier than its end. One that comes up to kMaxLatencyNs after that epoch was
// issued goes with the next; a later one is counted and dropped. Allocates when constructed, not
// after.
class OdometerQueue {
 public:
  static constexpr std::int64_t kMaxIntervalNs = 1'000'000'000;
  static constexpr std::int64_t kMaxLatencyNs = 400'000'000;
  static constexpr std::int64_t kMaxAheadNs = 2'000'000'000;
  static constexpr double kMaxSpeed = 150.0;  // m/s
  static constexpr int kRunToRestart = 5;

  // `used`: increments are queued; else they are only checked.
  explicit OdometerQueue(bool used) : used_(used), waiting_(kMaxOdometerBlock) {}

  // `imu_time`: of the newest sample, `last_epoch`: of the last issued; may be unset. kNone:
  // accepted.
  InputFault add(const OdometerIncrement& increment, GpsTime imu_time, GpsTime last_epoch);
  // Moves those that end by `time` to the end of the block.
  void move_to_block(GpsTime time, OdometerBlock* block);
  void clear();
  GpsTime last_time() const { return last_; }   // of the last one accepted; may be unset
  std::uint64_t late() const { return late_; }  // accepted, and dropped

 private:
  InputFault place(const OdometerIncrement& increment, GpsTime last_epoch);

  bool used_;
  boost::circular_buffer<OdometerIncrement> waiting_;
  TimeStepMonitor time_monitor_{kRunToRestart, kMaxIntervalNs};
  GpsTime last_;
  std::uint64_t late_ = 0;
};

}  // namespace leonav
