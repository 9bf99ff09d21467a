// Samples that no IMU can have measured, refused one after the other: what mistake makes such.
#pragma once
#include "core/conventions/convention.h"
#include "core/ins/imu.h"

namespace leonav {

class RefusedImuWatch {
 public:
  void add_accepted() { run_ = run_ > 0 ? run_ - 1 : 0; }
  // A finite sample with a positive interval that was refused for its rates or forces. A finding,
  // once, when a second's worth more was refused than accepted.
  ConventionFinding add_refused(const ImuSample& sample);

 private:
  ConventionFinding judge() const;

  int run_ = 0;
  double seconds_ = 0.0, interval_s_ = 0.0;
  double speed_ = 0.0, angle_ = 0.0;  // sums of |increments|, m/s, rad
  bool told_ = false;
};

}  // namespace leonav
