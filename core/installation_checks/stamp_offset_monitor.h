// StampOffsetMonitor finds IMU and GNSS stamps that are in different time scales, by their order of
// arrival.
#pragma once
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/installation_checks/convention.h"

namespace leonav {

// Interprets an offset of the IMU's stamps minus the GNSS epochs', s: leap seconds, or another
// offset.
ConventionFinding stamp_finding(double imu_less_gnss_s);

// StampOffsetMonitor compares the newest stamps of both inputs. Inputs of a running system arrive
// within 5 s of their time; a larger offset that stays the same for several epochs lies in the
// stamps.
class StampOffsetMonitor {
 public:
  // Adds the stamp, as received, of a sample that is plausible by itself.
  void add_imu(GpsTime stamp) {
    imu_ = stamp;
    ++samples_;
  }
  // Adds the stamp of an epoch that is plausible by itself; returns a finding, and again each
  // minute while it lasts.
  ConventionFinding add_epoch(GpsTime stamp);

 private:
  GpsTime imu_;  // of the last sample
  GpsTime last_epoch_;
  std::uint64_t samples_ = 0, samples_at_epoch_ = 0;
  double offset_s_ = 0.0, since_s_ = 0.0;
  double due_s_ = 0.0;  // since_s_ at which it is reported
  int epochs_ = 0;      // successive epochs with this offset
};

}  // namespace leonav
