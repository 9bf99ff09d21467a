// FaultScript gives the effect of the scripted faults at an instant. A fault changes nothing else:
// every random number of a run belongs to its satellite and instant (random_streams.h).
#pragma once
#include <vector>

#include "core/gnss/signals/satellite.h"
#include "core/inertial/strapdown/imu.h"
#include "tools/sim/scenario/faults_config.h"

namespace leonav::sim {

// The effect of faults on all measurements of one satellite.
struct Pull {
  double range_m = 0.0, rate_m_s = 0.0;
  unsigned breaks = 0;  // breaks of its carriers so far, by spoofing that ended
};

// FaultScript evaluates the faults of a scenario.
class FaultScript {
 public:
  explicit FaultScript(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  // `t` is in s from the start: the epoch's stamp, the IMU sample's end, the product's time.
  bool is_out(SatelliteId satellite, double elevation, double t) const;
  Pull pull(SatelliteId satellite, double t) const;
  bool is_receiver_off(double t) const;
  bool is_imu_missing(double t) const;
  ImuSample saturated(const ImuSample& sample, double t) const;
  double delay_s(Stream stream, double t) const;
  bool is_duplicate(Stream stream, double t) const;
  // Error of the provided orbit: along, cross, radial, m.
  Eigen::Vector3d orbit_error_m(SatelliteId satellite, double t) const;
  bool has(FaultKind kind) const;

 private:
  std::vector<Fault> faults_;
};

}  // namespace leonav::sim
