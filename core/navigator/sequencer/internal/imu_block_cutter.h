// ImuBlockCutter keeps the IMU samples since the last epoch and cuts them exactly at the next.
#pragma once
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/inertial/strapdown/imu.h"

namespace leonav {

// ImuBlockCutter allocates when constructed, not after.
class ImuBlockCutter {
 public:
  ImuBlockCutter() : samples_(kMaxImuBlock) {}

  // Appends the part of the sample after `last_epoch`. Precondition: not full.
  void append(const ImuSample& sample, GpsTime last_epoch);
  bool empty() const { return samples_.empty(); }
  bool full() const { return samples_.full(); }
  // Returns the start of the newest sample. Precondition: not empty.
  GpsTime newest_start() const { return samples_.back().start(); }
  // Returns the time at which a full block is cut: `wait_ns` before its end, so that an epoch that
  // is still on its way finds its samples, but not within the first quarter.
  GpsTime cut_of_full_block(std::int64_t wait_ns) const;

  // Moves the samples before `time` to the end of `block`; a sample across `time` is split.
  void move_to_block(GpsTime time, ImuBlock* block);
  void clear() { samples_.clear(); }

 private:
  boost::circular_buffer<ImuSample> samples_;
};

}  // namespace leonav
