// IMU and GNSS stamped by different times: seen as they come in.
#pragma once
#include <cstdint>

#include "core/conventions/convention.h"
#include "core/time/gps_time.h"

namespace leonav {

// What an offset of the IMU's stamps against the GNSS epochs' looks like, s.
ConventionFinding stamp_finding(double imu_less_gnss_s);

// Inputs of a running system come in within some seconds of their time. An offset beyond that, the
// same for epoch after epoch, is of the stamps.
class StampOffsetWatch {
 public:
  // Stamps as received, of samples and epochs that are sane by themselves.
  void add_imu(GpsTime stamp) {
    imu_ = stamp;
    ++samples_;
  }
  ConventionFinding add_epoch(GpsTime stamp);

 private:
  GpsTime imu_;  // the last sample's
  GpsTime last_epoch_;
  std::uint64_t samples_ = 0, samples_at_epoch_ = 0;
  double offset_s_ = 0.0, since_s_ = 0.0;
  int epochs_ = 0;  // in a row with this offset
  bool told_ = false;
};

}  // namespace leonav
