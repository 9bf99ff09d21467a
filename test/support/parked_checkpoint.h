// What a vehicle left that was parked.
#pragma once
#include "core/earth/ellipsoid.h"
#include "core/navigator/interface/checkpoint.h"

namespace leonav::test {

inline Checkpoint parked() {
  Checkpoint checkpoint;
  checkpoint.time = GpsTime::from_week_and_tow(2300, 345678.25);
  checkpoint.standing = true;
  checkpoint.antenna_p_e = to_ecef({0.69, 0.14, 300.0});
  checkpoint.antenna_sigma = 2.5;
  checkpoint.heading = -1.25;
  checkpoint.heading_sigma = 0.02;
  checkpoint.gyro_bias_b = {1e-4, -2e-4, 3e-4};
  checkpoint.gyro_bias_sigma = 5e-5;
  checkpoint.code_sigma_factor = 3.5;
  checkpoint.doppler_sigma_factor = 1.25;
  return checkpoint;
}

}  // namespace leonav::test
