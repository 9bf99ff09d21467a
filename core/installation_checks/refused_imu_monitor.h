// RefusedImuMonitor finds the mistake behind samples that were refused because no IMU can have
// measured them.
#pragma once
#include "core/inertial/strapdown/imu.h"
#include "core/installation_checks/convention.h"

namespace leonav {

// RefusedImuMonitor counts refused against accepted samples.
class RefusedImuMonitor {
 public:
  // Counts an accepted sample.
  void add_accepted() { run_ = run_ > 0 ? run_ - 1 : 0; }
  // Counts a refused sample: finite, with a positive interval, refused for its rates or forces.
  // Returns a finding when at least 100 more samples were refused than accepted, and again each
  // minute of such samples.
  ConventionFinding add_refused(const ImuSample& sample);

 private:
  ConventionFinding evaluate() const;

  int run_ = 0;
  double seconds_ = 0.0, interval_s_ = 0.0;
  double speed_ = 0.0, angle_ = 0.0;  // sums of |increments|, m/s, rad
  double due_s_ = 0.0;                // seconds_ at which it is reported
};

}  // namespace leonav
