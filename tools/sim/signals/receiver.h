// Receiver produces a receiver's epochs: every tracked satellite with code, carrier, Doppler and
// C/N0.
#pragma once
#include <vector>

#include "core/gnss/signals/observation.h"
#include "tools/sim/signals/satellite_observer.h"

namespace leonav::sim {

// Receiver simulates epoch after epoch.
class Receiver {
 public:
  // All arguments must outlive this object. Throws as Surroundings does.
  Receiver(const Scenario& scenario, const SplineMotion& motion, const TrueSky& sky,
           const FaultScript& faults);
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  // Returns the epoch that the receiver's clock stamps `t_tag` seconds from the start, in order of
  // time.
  RawEpoch epoch(double t_tag);
  // Returns the epoch at a reading of some other clock.
  RawEpoch epoch(double t_tag, const ClockReading& clock);
  // Restarts the receiver: all tracks are lost.
  void reset();

 private:
  AntennaInstant antenna(double t, const Eigen::Vector3d& tide_e) const;

  const Scenario& scenario_;
  const SplineMotion& motion_;
  Atmosphere atmosphere_;
  ReceiverClock clock_;
  Surroundings surroundings_;
  Multipath multipath_;
  ObserverWorld world_;
  std::vector<SatelliteObserver> observers_;  // by satellite of the sky
};

}  // namespace leonav::sim
