// One satellite as the receiver observes it, epoch by epoch.
#pragma once
#include "core/gnss/observation.h"
#include "tools/sim/faults/fault_script.h"
#include "tools/sim/signals/epoch_instant.h"
#include "tools/sim/signals/multipath.h"
#include "tools/sim/signals/tracking.h"

namespace leonav::sim {

// What all observers of a receiver share; outlives them.
struct ObserverWorld {
  const Scenario& scenario;
  const Atmosphere& atmosphere;
  const ReceiverClock& clock;
  const Surroundings& surroundings;
  const Multipath& multipath;
  const FaultScript& faults;
};

class SatelliteObserver {
 public:
  SatelliteObserver(const ObserverWorld& world, const TrueSatellite& satellite);

  // Appends what is tracked. Epochs in order of time. Throws std::runtime_error if `raw` is full.
  void observe(const EpochInstant& now, RawEpoch* raw);
  void reset() { tracking_.reset(); }

 private:
  struct Geometry {
    SignalPath path;
    double rate_m_s = 0.0, tecu_rate = 0.0;
    LookAngles direction_rates;
    Reception reception;
  };
  bool is_above_mask(const EpochInstant& now) const;
  Geometry geometry(const EpochInstant& now) const;
  Arrival arrival(const EpochInstant& now, const Geometry& geometry, const Pull& pull) const;
  void turn(const EpochInstant& now, const SignalPath& path);
  void measure(const EpochInstant& now, const Geometry& geometry, const Arrival& arrival,
               const Pull& pull, std::size_t s, RawEpoch* raw);

  const ObserverWorld& world_;
  const TrueSatellite& satellite_;
  Tracking tracking_;
  double wind_up_ = 0.0, wind_up_rate_ = 0.0;  // cycles, and a second
  MultipathAge age_;
};

}  // namespace leonav::sim
