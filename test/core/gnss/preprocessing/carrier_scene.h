// A receiver that tracks GPS and Galileo on three frequencies, codes and carriers free of noise.
#pragma once
#include "support/sky/simulated_carrier.h"

namespace leonav::test {

inline constexpr double kStep_s = 30.0;  // between its epochs

struct CarrierScene {
  SimulatedSky sky;
  SimulatedReceiver receiver;
  SimulatedCarriers carriers{0.0, 0.0, 1};

  CarrierScene() {
    sky.add(gps_walker());
    sky.add(galileo_walker());
    receiver.signals = {{{'1', 'C'}, 45.0}, {{'2', 'W'}, 42.0}, {{'5', 'Q'}, 44.0}};
  }
  // Of an antenna that points north.
  Eigen::Matrix3d C_en() const {
    return rotation_ecef_to_ned(to_geodetic(receiver.p_e)).transpose();
  }
  RawEpoch at(double t, const Eigen::Matrix3d& C_er) {
    RawEpoch raw = simulate_epoch(sky, receiver, t);
    carriers.fill(sky, receiver, t, C_er, &raw);
    return raw;
  }
};

}  // namespace leonav::test
