// SatelliteObserver produces the observations of one satellite, epoch by epoch.
#pragma once
#include <memory>

#include "core/gnss/signals/observation.h"
#include "tools/sim/faults/fault_script.h"
#include "tools/sim/signals/epoch_instant.h"
#include "tools/sim/signals/multipath.h"
#include "tools/sim/signals/tracking.h"
#include "tools/sim/street/street_errors.h"

namespace leonav::sim {

// The models that all observers of a receiver share; they outlive the observers.
struct ObserverWorld {
  const Scenario& scenario;
  const Atmosphere& atmosphere;
  const ReceiverClock& clock;
  const Surroundings& surroundings;
  const Multipath& multipath;
  const FaultScript& faults;
};

// SatelliteObserver tracks the signals of one satellite.
class SatelliteObserver {
 public:
  SatelliteObserver(const ObserverWorld& world, const TrueSatellite& satellite);

  // Appends what is tracked; epochs in order of time. Throws std::runtime_error if `raw` is full.
  void observe(const EpochInstant& now, RawEpoch* raw);
  void reset() { tracking_.reset(); }

 private:
  struct Geometry {
    SignalPath path;
    double rate_m_s = 0.0, tecu_rate = 0.0;
    LookAngles direction_rates;
    Reception reception;
    StreetEffect street;
  };
  bool is_above_mask(const EpochInstant& now) const;
  Geometry geometry(const EpochInstant& now);
  Arrival arrival(const EpochInstant& now, const Geometry& geometry, const Pull& pull) const;
  void turn(const EpochInstant& now, const SignalPath& path);
  void measure(const EpochInstant& now, const Geometry& geometry, const Arrival& arrival,
               const Pull& pull, std::size_t s, RawEpoch* raw);

  const ObserverWorld& world_;
  const TrueSatellite& satellite_;
  Tracking tracking_;
  double wind_up_ = 0.0, wind_up_rate_ = 0.0;  // cycles, and cycles per second
  MultipathAge age_;
  std::unique_ptr<StreetErrors> street_;  // null: by places alone
};

}  // namespace leonav::sim
