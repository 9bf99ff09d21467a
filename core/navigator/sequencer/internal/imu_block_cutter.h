// The ImuBlockCutter keeps the IMU samples since the last epoch and cuts them exactly at the next.
#pragma once
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/inertial/strapdown/imu.h"

namespace leonav {

// Allocates when constructed, not after.
class ImuBlockCutter {
 public:
  ImuBlockCutter() : samples_(kMaxImuBlock) {}

  // Must not be full. Only the part of the sample after `last_epoch` is kept.
  void append(const ImuSample& sample, GpsTime last_epoch);
  bool empty() const { return samples_.empty(); }
  bool full() const { return samples_.full(); }
  GpsTime newest_start() const { return samples_.back().start(); }  // must not be empty
  // Where a full block is cut: `wait_ns` before its end, so that there is room for an epoch on its
  // way, but not in its first quarter.
  GpsTime cut_of_full_block(std::int64_t wait_ns) const;

  // Moves the samples before `time` to the end of `block`; one across it is split.
  void move_to_block(GpsTime time, ImuBlock* block);
  void clear() { samples_.clear(); }

 private:
  boost::circular_buffer<ImuSample> samples_;
};

}  // namespace leonav
